//! The house: who is heard while it is open, closed, or while its glass is cleaned; and what the simulation makes of it.

use std::sync::Arc;

use soffio_config::CLEANING_S;
use soffio_config::{Chord, Day, Modifiers, Opening};
use soffio_exhibit::{self as exhibit, Exhibit};
use soffio_kiosk::step::controls::Controls;
use soffio_kiosk::step::stage::Stage;
use soffio_kiosk::venue::state::{OverlayCapture, SignalContext, VenueState};
use soffio_kiosk::visitor::gesture::Press;
use soffio_kiosk::visitor::input::{Key, Keys, Phase, Request, Signal, Visitor};
use soffio_simulation::{Microphone, Settings};
use soffio_soundscape::breath::Breath;

const RATE: u32 = 48_000;

/// The site's chords.
struct Chords([Chord; 4]);

impl Chords {
    fn new() -> Self {
        Self(["S", "O", "M", "N"].map(|key| Chord::new(Modifiers::CTRL_ALT, key)))
    }

    fn keys(&self) -> Keys<'_> {
        let [staff, open, mute, night] = &self.0;
        Keys { staff, open, mute, night, blow: "Space", read: "R", menu: false }
    }
}

fn key(name: &str, chord: bool) -> Signal {
    let modifiers = if chord { Modifiers::CTRL_ALT } else { Modifiers::default() };
    Signal::Key(Key { name: name.into(), pressed: true, repeat: false, modifiers })
}

/// Everything a hand can do.
fn signals() -> Vec<Signal> {
    let touch = |phase| Signal::Touch { finger: 1, at: [0.3, 0.4], phase };
    let plain = ["Space", "Enter", "Tab", "L", "Equal", "ArrowLeft", "PageDown", "Escape"].map(|name| key(name, false));
    let chords = ["S", "O", "M", "N"].map(|name| key(name, true));
    [Signal::Pointer([0.1, 0.1]), Signal::Pointer([0.8, 0.2]), Signal::Button(true), Signal::Button(false)]
        .into_iter()
        .chain([Phase::Down, Phase::Move, Phase::Up].map(touch))
        .chain(plain)
        .chain(chords)
        .collect()
}

/// A house that the hours have closed.
fn closed() -> VenueState {
    let mut house = VenueState::default();
    let sunday = Day { year: 2026, month: 1, day: 4, weekday: 6 };
    let opening = Opening { hours: vec!["Mon 10:00-11:00".parse().expect("hours")], holidays: Vec::new() };
    house.update_schedule(&opening, sunday, sunday, "10:30".parse().expect("a time"));
    assert!(!house.is_open());
    house
}

#[test]
fn while_the_glass_is_cleaned_no_input_does_anything_and_then_all_do_again() {
    let (chords, mut house) = (Chords::new(), VenueState::default());
    house.start_cleaning(100.0, CLEANING_S);
    let mut visitor = Visitor::default();
    for time in [100.0, 130.0, 100.0 + CLEANING_S - 0.01] {
        for signal in signals() {
            for above in [OverlayCapture::default(), OverlayCapture { keys: true, pointer: true }] {
                let requested = house.signal(
                    time,
                    &mut visitor,
                    &signal,
                    SignalContext { keys: chords.keys(), captured: above },
                    true,
                );
                assert_eq!(requested, None, "{signal:?} at {time} s");
            }
        }
        assert!(visitor.presses().next().is_none() && !visitor.holds_key() && visitor.aim().is_none());
        assert_eq!((visitor.stick(), visitor.activity()), ([0.0; 2], 0));
        assert!(
            !house.accepts_input(time)
                && house.cleaning_left(time).is_some_and(|left| (0.0..=CLEANING_S).contains(&left))
        );
    }
    let after = 100.0 + CLEANING_S + 0.01;
    assert!(house.accepts_input(after) && house.cleaning_left(after).is_none());
    let own = SignalContext { keys: chords.keys(), captured: OverlayCapture::default() };
    assert_eq!(house.signal(after, &mut visitor, &key("S", true), own, false), Some(Request::ToggleStaff));
    house.signal(after, &mut visitor, &key("Space", false), own, false);
    assert!(visitor.holds_key());
}

#[test]
fn a_closed_house_hears_the_staffs_chords_only_and_is_opened_early_by_one() {
    let (chords, mut house) = (Chords::new(), closed());
    let mut visitor = Visitor::default();
    let own = SignalContext { keys: chords.keys(), captured: OverlayCapture::default() };
    let requested: Vec<Request> =
        signals().iter().filter_map(|signal| house.signal(1.0, &mut visitor, signal, own, true)).collect();
    assert_eq!(requested, [Request::ToggleStaff, Request::Open, Request::Mute, Request::Night]);
    assert!(visitor.presses().next().is_none() && !visitor.holds_key() && visitor.aim().is_none());
    house.open_early();
    assert!(house.is_open() && house.is_early() && house.accepts_input(1.0));
    // The hours begin and end: it is closed again by itself.
    let monday = Day { year: 2026, month: 1, day: 5, weekday: 0 };
    let opening = Opening { hours: vec!["Mon 10:00-11:00".parse().expect("hours")], holidays: Vec::new() };
    for (time, open, early) in [("09:59", true, true), ("10:00", true, false), ("11:00", false, false)] {
        house.update_schedule(&opening, monday, monday, time.parse().expect("a time"));
        assert_eq!((house.is_open(), house.is_early()), (open, early), "{time}");
    }
    house.open_early();
    house.open_early();
    assert!(!house.is_open(), "the second press closes it again");
}

#[test]
fn under_the_panel_keys_are_the_panels_and_what_comes_up_is_let_go() {
    let (chords, house) = (Chords::new(), VenueState::default());
    let mut visitor = Visitor::default();
    let open = SignalContext { keys: chords.keys(), captured: OverlayCapture::default() };
    let under = SignalContext { keys: chords.keys(), captured: OverlayCapture { keys: true, pointer: true } };
    house.signal(0.0, &mut visitor, &Signal::Touch { finger: 4, at: [0.5; 2], phase: Phase::Down }, open, false);
    assert_eq!(visitor.presses().count(), 1);
    house.signal(0.0, &mut visitor, &Signal::Touch { finger: 4, at: [0.5; 2], phase: Phase::Up }, under, false);
    assert_eq!(visitor.presses().count(), 0);
    let before = visitor.activity();
    assert_eq!(house.signal(0.0, &mut visitor, &key("L", false), under, false), None);
    house.signal(0.0, &mut visitor, &Signal::Touch { finger: 5, at: [0.5; 2], phase: Phase::Down }, under, false);
    assert_eq!(visitor.presses().count(), 0);
    assert_eq!(visitor.activity(), before + 2, "staff are there: the panel stays open");
    assert_eq!(house.signal(0.0, &mut visitor, &key("S", true), under, false), Some(Request::ToggleStaff));
}

fn steel_fish() -> Arc<Exhibit> {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("exhibits/steel-fish");
    Arc::new(exhibit::load(&folder).expect("the shipped exhibit is valid"))
}

#[test]
fn nothing_blows_takes_or_begins_while_nobody_is_heard() {
    let breath = Breath::default().recorded(RATE, 7);
    let controls = Controls {
        aspect: 16.0 / 9.0,
        hold: true,
        strength: 1.0,
        presses: vec![Press { id: 1, at: [0.3, 0.4] }],
        inert: true,
        ..Controls::default()
    };
    let still = Controls { inert: true, aspect: controls.aspect, ..Controls::default() };
    // Attract mode would begin after half a second.
    let mut moved = Stage::new(steel_fish(), Settings::default(), None, Some(0.5));
    let mut left = Stage::new(steel_fish(), Settings::default(), None, Some(0.5));
    for (step, block) in breath.chunks_exact(RATE as usize / 240).enumerate() {
        let microphone = Microphone { samples: block, second: None, sample_rate: RATE, reference: &[] };
        moved.step(&controls, Some(microphone));
        left.step(&still, None);
        assert_eq!(moved.state_hash(), left.state_hash(), "step {step}");
        assert_eq!(moved.snapshot().breath.speed, 0.0, "step {step}");
        assert!(!moved.attracts(), "step {step}");
    }
    // Heard again, the same hold blows.
    let heard = Controls { inert: false, ..controls };
    (0..60).for_each(|_| moved.step(&heard, None));
    assert!(moved.snapshot().breath.speed > 1.0);
}

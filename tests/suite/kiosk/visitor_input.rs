//! Keys, pointer and fingers of a visitor, and the chords of staff.

use std::sync::LazyLock;

use soffio_config::{Chord, Modifiers};
use soffio_kiosk::visitor::input::{Key, Keys, Phase, Request, Signal, Visitor};

fn chord() -> Chord {
    "Ctrl+Alt+S".parse().expect("a chord")
}

fn key(name: &str, pressed: bool) -> Signal {
    Signal::Key(Key { name: name.into(), pressed, ..Key::default() })
}

/// The keys of a site, with a staff chord and a key to blow of its own.
fn keys<'a>(staff: &'a Chord, blow: &'a str) -> Keys<'a> {
    static OTHERS: LazyLock<[Chord; 3]> =
        LazyLock::new(|| ["M", "N", "O"].map(|key| Chord::new(Modifiers::CTRL_ALT, key)));
    Keys { staff, mute: &OTHERS[0], night: &OTHERS[1], open: &OTHERS[2], blow, read: "R", menu: false }
}

fn send(visitor: &mut Visitor, signal: Signal) -> Option<Request> {
    visitor.signal(&signal, keys(&chord(), "Space"), false)
}

/// Is anything held that may blow?
fn holds(visitor: &Visitor) -> bool {
    visitor.holds_key() || visitor.presses().next().is_some()
}

#[test]
fn plus_and_minus_turn_the_volume_and_two_chords_are_the_staffs() {
    let mut visitor = Visitor::default();
    for (name, requested) in [
        ("Equal", Some(Request::Louder(1))),
        ("NumpadAdd", Some(Request::Louder(1))),
        ("AudioVolumeUp", Some(Request::Louder(1))),
        ("Minus", Some(Request::Louder(-1))),
        ("NumpadSubtract", Some(Request::Louder(-1))),
        ("M", None),
        ("N", None),
    ] {
        assert_eq!(send(&mut visitor, key(name, true)), requested, "{name}");
        assert_eq!(send(&mut visitor, key(name, false)), None, "{name}");
    }
    for (name, requested) in
        [("M", Request::Mute), ("N", Request::Night), ("O", Request::Open), ("S", Request::ToggleStaff)]
    {
        let key = Key { name: name.into(), pressed: true, modifiers: Modifiers::CTRL_ALT, ..Key::default() };
        assert_eq!(send(&mut visitor, Signal::Key(key)), Some(requested), "{name}");
    }
    assert!(!holds(&visitor));
}

#[test]
fn a_pointer_aims_once_it_has_moved() {
    let mut visitor = Visitor::default();
    send(&mut visitor, Signal::Pointer([0.5, 0.5]));
    send(&mut visitor, Signal::Pointer([0.505, 0.5]));
    assert_eq!((visitor.aim(), visitor.activity()), (None, 0), "a pointer that lies there is nobody");
    send(&mut visitor, Signal::Pointer([0.6, 0.4]));
    assert_eq!((visitor.aim(), visitor.activity()), (Some([0.6, 0.4]), 1));
    send(&mut visitor, Signal::Pointer([1.4, -0.1]));
    assert_eq!(visitor.aim(), Some([1.0, 0.0]), "it aims inside the picture");
    visitor.leave();
    send(&mut visitor, Signal::Pointer([1.4, -0.1]));
    assert_eq!(visitor.aim(), None, "the next visitor starts from the centre");
}

#[test]
fn button_finger_and_space_bar_blow_while_they_are_held() {
    let finger = |phase| Signal::Touch { finger: 3, at: [0.2, 0.7], phase };
    for (down, up) in [
        (Signal::Button(true), Signal::Button(false)),
        (finger(Phase::Down), finger(Phase::Up)),
        (key("Space", true), key("Space", false)),
    ] {
        let mut visitor = Visitor::default();
        send(&mut visitor, down.clone());
        assert!(holds(&visitor), "{down:?}");
        send(&mut visitor, up);
        assert!(!holds(&visitor), "{down:?}");
        send(&mut visitor, down);
        send(&mut visitor, Signal::FocusLost);
        assert!(!holds(&visitor), "a window that loses the focus hears no release");
    }
}

#[test]
fn a_switch_of_the_sites_choice_blows_and_arrows_aim() {
    let mut visitor = Visitor::default();
    let chord = chord();
    let mut press = |name: &str, down: bool| {
        visitor.signal(&key(name, down), keys(&chord, "F9"), false);
        (holds(&visitor), visitor.stick())
    };
    assert_eq!(press("Space", true), (false, [0.0, 0.0]));
    assert_eq!(press("F9", true), (true, [0.0, 0.0]));
    assert_eq!(press("ArrowUp", true), (true, [0.0, -1.0]));
    assert_eq!(press("ArrowRight", true), (true, [1.0, -1.0]));
    assert_eq!(press("ArrowLeft", true), (true, [0.0, -1.0]), "left and right at once is neither");
    press("ArrowRight", false);
    assert_eq!(press("F9", false), (false, [-1.0, -1.0]));
    send(&mut visitor, Signal::FocusLost);
    assert_eq!(visitor.stick(), [0.0, 0.0], "a window that loses the focus hears no release");
}

#[test]
fn the_first_finger_aims_and_a_second_changes_nothing() {
    let mut visitor = Visitor::default();
    let touch = |finger, x, phase| Signal::Touch { finger, at: [x, 0.5], phase };
    send(&mut visitor, touch(1, 0.9, Phase::Move));
    assert!(!holds(&visitor), "a finger that pressed a button and slides off it does not blow");
    send(&mut visitor, touch(1, 0.2, Phase::Down));
    send(&mut visitor, touch(2, 0.8, Phase::Down));
    send(&mut visitor, touch(2, 0.9, Phase::Up));
    assert!(holds(&visitor));
    assert_eq!(visitor.aim(), Some([0.2, 0.5]));
    send(&mut visitor, touch(1, 0.3, Phase::Move));
    send(&mut visitor, touch(1, 0.3, Phase::Up));
    assert!(!holds(&visitor));
    assert_eq!(visitor.aim(), Some([0.3, 0.5]), "the aim stays where the finger left it");
}

#[test]
fn no_key_of_a_visitor_closes_the_kiosk() {
    let mut visitor = Visitor::default();
    let names = ["Escape", "F4", "Q", "W", "Tab", "Delete", "C", "F11", "Enter", "S"];
    for name in names {
        for held in 0..7 {
            let (ctrl, alt, shift) = (held & 1 > 0, held & 2 > 0, held & 4 > 0);
            let key =
                Key { name: name.into(), pressed: true, repeat: false, modifiers: Modifiers { ctrl, alt, shift } };
            let requested = send(&mut visitor, Signal::Key(key));
            let staff = name == "S" && ctrl && alt && !shift;
            let page = name == "Tab" && !ctrl && !alt;
            let may = if staff { Some(Request::ToggleStaff) } else { page.then_some(Request::Menu) };
            assert_eq!(requested, may, "{name} {held:03b}");
        }
    }
    assert_eq!(
        visitor.signal(&key("Escape", true), keys(&chord(), "Space"), true),
        Some(Request::Close),
        "on a desk it may"
    );
}

#[test]
fn on_the_page_keys_choose_and_nothing_blows() {
    let chord = chord();
    let keys = Keys { menu: true, ..keys(&chord, "Space") };
    let mut visitor = Visitor::default();
    for (name, requested) in [
        ("ArrowLeft", Request::MoveFocus([-1, 0])),
        ("ArrowDown", Request::MoveFocus([0, 1])),
        ("Enter", Request::PressFocused),
        ("Space", Request::PressFocused),
        ("Tab", Request::Menu),
        ("PageDown", Request::Page(1)),
    ] {
        assert_eq!(visitor.signal(&key(name, true), keys, false), Some(requested), "{name}");
        assert!(!holds(&visitor) && visitor.stick() == [0.0; 2], "{name}");
    }
}

#[test]
fn the_language_key_asks_once_and_all_keys_count_as_input() {
    let mut visitor = Visitor::default();
    assert_eq!(send(&mut visitor, key("L", true)), Some(Request::NextLanguage));
    let repeat = Signal::Key(Key { name: "L".into(), pressed: true, repeat: true, ..Key::default() });
    assert_eq!(send(&mut visitor, repeat), None);
    assert_eq!(send(&mut visitor, key("B", true)), None);
    assert_eq!(visitor.activity(), 3);
}

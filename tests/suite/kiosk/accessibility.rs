//! What visitors with other needs find: a breath that nobody has to hold, less motion, a swipe beside the sculpture; and
//! that the next visitor finds the site's own again.

use std::path::Path;
use std::sync::{Arc, LazyLock};

use soffio_config::{Chord, Config, Modifiers};
use soffio_exhibit::{self as exhibit, Exhibit};
use soffio_kiosk::step::controls::Controls;
use soffio_kiosk::step::stage::Stage;
use soffio_kiosk::visitor::accessibility::AccessibilitySettings;
use soffio_kiosk::visitor::gesture::{Lift, Press};
use soffio_kiosk::visitor::input::{Key, Keys, Phase, Request, Signal, Visitor};
use soffio_simulation::{Settings, Simulation};

const ASPECT: f64 = 16.0 / 9.0;

fn load(id: &str) -> Arc<Exhibit> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("exhibits").join(id);
    Arc::new(exhibit::load(&folder).unwrap_or_else(|report| panic!("{report}")))
}

/// Nobody does anything.
fn still() -> Controls {
    Controls { aspect: ASPECT, ..Controls::default() }
}

/// A place on the work that can be taken by the hand, and one beside it at the same height.
fn places(exhibit: &Arc<Exhibit>) -> ([f64; 2], [f64; 2]) {
    let mut simulation = Simulation::new(exhibit.clone(), Settings::default());
    let view = simulation.view(ASPECT);
    let seen: Vec<[f64; 2]> =
        simulation.bodies().iter().filter_map(|body| view.project(body.position, ASPECT)).collect();
    let on = seen.into_iter().find(|at| simulation.hit_test(*at, ASPECT)).expect("something can be taken");
    assert!(!simulation.hit_test([0.03, 0.9], ASPECT), "the corner is free");
    (on, [0.03, 0.9])
}

fn send(visitor: &mut Visitor, signal: Signal) -> Option<Request> {
    static CHORDS: LazyLock<[Chord; 4]> =
        LazyLock::new(|| ["S", "M", "N", "O"].map(|key| Chord::new(Modifiers::CTRL_ALT, key)));
    let [staff, mute, night, open] = &*CHORDS;
    visitor.signal(&signal, Keys { staff, mute, night, open, blow: "Space", read: "R", menu: false }, false)
}

fn key(name: &str, pressed: bool, repeat: bool) -> Signal {
    Signal::Key(Key { name: name.into(), pressed, repeat, ..Key::default() })
}

/// Controls of a visitor who presses once.
fn controls(visitor: &Visitor) -> Controls {
    Controls {
        aim: visitor.aim(),
        presses: visitor.presses().collect(),
        hold: visitor.holds_key(),
        keyed: visitor.keyed(),
        activity: visitor.activity(),
        press_once: true,
        ..still()
    }
}

/// Runs a number of steps with the visitor's present actions; each event is reported once.
fn run(stage: &mut Stage, visitor: &mut Visitor, steps: usize) {
    for _ in 0..steps {
        visitor.lifts().into_iter().for_each(|lift| stage.lift(lift));
        stage.step(&controls(visitor), None);
    }
}

#[test]
fn one_short_press_by_finger_button_or_key_blows_and_another_one_ends_it() {
    let touch = |phase| Signal::Touch { finger: 3, at: [0.03, 0.9], phase };
    for (down, up) in [
        (touch(Phase::Down), touch(Phase::Up)),
        (Signal::Button(true), Signal::Button(false)),
        (key("Space", true, false), key("Space", false, false)),
    ] {
        let mut stage = Stage::new(load("steel-fish"), Settings::default(), None, None);
        let mut visitor = Visitor::default();
        send(&mut visitor, Signal::Pointer([0.5, 0.5]));
        send(&mut visitor, Signal::Pointer([0.03, 0.9]));
        run(&mut stage, &mut visitor, 10);
        assert!(!stage.holds());
        // So short that both lie between two steps.
        send(&mut visitor, down.clone());
        send(&mut visitor, up.clone());
        run(&mut stage, &mut visitor, 480);
        assert!(stage.holds() && stage.snapshot().breath.speed > 5.0, "{down:?}: it blows for two seconds by itself");
        // As a finger that takes its time; a key repeats meanwhile.
        send(&mut visitor, down.clone());
        run(&mut stage, &mut visitor, 120);
        if let Signal::Key(_) = down {
            send(&mut visitor, key("Space", true, true));
        }
        run(&mut stage, &mut visitor, 20);
        send(&mut visitor, up);
        run(&mut stage, &mut visitor, 240);
        assert!(!stage.holds() && stage.snapshot().breath.speed == 0.0, "{down:?}: {}", stage.snapshot().breath.speed);
    }
}

#[test]
fn a_breath_that_nobody_holds_goes_where_the_visitor_points_and_ends_when_he_leaves() {
    let mut stage = Stage::new(load("steel-fish"), Settings::default(), None, Some(3.0));
    let mut visitor = Visitor::default();
    for x in [0.5, 0.2] {
        send(&mut visitor, Signal::Pointer([x, 0.5]));
    }
    send(&mut visitor, key("Space", true, false));
    send(&mut visitor, key("Space", false, false));
    run(&mut stage, &mut visitor, 240);
    let left = stage.snapshot().breath.ring.center;
    send(&mut visitor, Signal::Pointer([0.8, 0.5]));
    run(&mut stage, &mut visitor, 240);
    assert!(stage.holds() && stage.snapshot().breath.ring.center.distance(left) > 0.05, "it is steered");
    // A held switch would keep the visitor here for ever; this one does not.
    run(&mut stage, &mut visitor, 3 * 240);
    assert!(stage.attracts() && !stage.holds());
    // The page ends it too: no press counts while it is open.
    let mut stage = Stage::new(load("steel-fish"), Settings::default(), None, None);
    let latched = Controls { keyed: 1, press_once: true, ..still() };
    stage.step(&latched, None);
    assert!(stage.holds());
    stage.step(&Controls { press_once: false, ..latched }, None);
    assert!(!stage.holds());
}

#[test]
fn a_swipe_beside_the_work_leads_on_and_a_pull_at_it_does_not() {
    let fish = load("steel-fish");
    let (on, beside) = places(&fish);
    // Pulled or swiped to the right by 0.3 of the picture's width, 0.53 heights, within 0.2 s.
    for (from, turned) in [(on, 0), (beside, -1)] {
        let mut stage = Stage::new(fish.clone(), Settings::default(), None, None);
        let mut hands = 0;
        for step in 0..48 {
            let at = [from[0] + 0.3 * f64::from(step) / 48.0, from[1]];
            stage.step(&Controls { presses: vec![Press { id: 1, at }], ..still() }, None);
            hands = hands.max(stage.snapshot().diagnostics.grabs);
        }
        let at = [from[0] + 0.3, from[1]];
        stage.lift(Lift { id: 1, from, at });
        stage.step(&still(), None);
        assert_eq!(stage.swipes(), turned, "from {from:?}");
        assert_eq!(hands, usize::from(turned == 0), "from {from:?}");
    }
    // Press and hold beside it, then steer to the other side: a breath, not a swipe.
    let mut stage = Stage::new(fish, Settings::default(), None, None);
    for step in 0..240 {
        let at = [beside[0] + 0.5 * f64::from(step) / 240.0, beside[1]];
        stage.step(&Controls { presses: vec![Press { id: 1, at }], ..still() }, None);
    }
    assert!(stage.snapshot().breath.speed > 5.0);
    let at = [beside[0] + 0.5, beside[1]];
    stage.lift(Lift { id: 1, from: beside, at });
    stage.step(&still(), None);
    assert_eq!(stage.swipes(), 0);
}

#[test]
fn fingers_tell_where_they_came_down_and_what_is_let_go_is_no_press() {
    let touch = |finger, x, phase| Signal::Touch { finger, at: [x, 0.5], phase };
    let mut visitor = Visitor::default();
    send(&mut visitor, touch(1, 0.2, Phase::Down));
    send(&mut visitor, touch(2, 0.9, Phase::Down));
    send(&mut visitor, touch(1, 0.4, Phase::Move));
    send(&mut visitor, touch(1, 0.5, Phase::Up));
    assert_eq!(visitor.lifts(), [Lift { id: 1, from: [0.2, 0.5], at: [0.5, 0.5] }]);
    assert!(visitor.lifts().is_empty(), "it is told once");
    assert_eq!(visitor.presses().count(), 1);
    send(&mut visitor, Signal::FocusLost);
    assert!(visitor.lifts().is_empty() && visitor.presses().count() == 0, "a lost window is nobody's press");
    send(&mut visitor, touch(7, 0.2, Phase::Up));
    assert!(visitor.lifts().is_empty(), "what came down on a button comes up beside it");
}

#[test]
fn with_less_motion_a_work_is_there_at_once_and_attract_mode_is_gentler() {
    let (fish, chimes) = (load("steel-fish"), load("wind-chimes"));
    let away = |stage: &Stage| {
        let home = chimes.bodies.iter().map(|body| body.pose.position);
        let far = stage.snapshot().poses.iter().zip(home).map(|(pose, home)| pose.position.distance(home));
        far.fold(0.0, f64::max)
    };
    for (calm, least, most) in [(false, 0.1, f64::INFINITY), (true, 0.0, 0.01)] {
        let mut stage = Stage::new(fish.clone(), Settings::default(), None, None);
        let controls = Controls { reduced_motion: calm, ..still() };
        stage.step(&controls, None);
        stage.swap(chimes.clone(), None);
        stage.step(&controls, None);
        assert!((least..=most).contains(&away(&stage)), "calm: {calm}, {} m away", away(&stage));
    }
    // Chosen while parts still fly: they are there at the next step.
    let mut stage = Stage::new(fish.clone(), Settings::default(), None, None);
    stage.step(&still(), None);
    stage.swap(chimes.clone(), None);
    (0..60).for_each(|_| stage.step(&still(), None));
    assert!(away(&stage) > 0.05);
    stage.step(&Controls { reduced_motion: true, ..still() }, None);
    assert!(away(&stage) < 0.01, "{} m away", away(&stage));

    // The same script, at half the speed; once the work moves, each breath holds back by how fast it does.
    let speeds = |calm: bool| -> Vec<f64> {
        let mut stage = Stage::new(fish.clone(), Settings::default(), None, Some(0.1));
        let controls = Controls { reduced_motion: calm, ..still() };
        let mut speed = |_| {
            stage.step(&controls, None);
            stage.snapshot().breath.speed
        };
        (0..20 * 240).map(&mut speed).collect()
    };
    let fastest = |speeds: &[f64]| speeds.iter().copied().fold(0.0, f64::max);
    let (usual, gentle) = (speeds(false), speeds(true));
    let begins = usual.iter().position(|speed| *speed > 0.0).expect("the script blows");
    // So soon nothing has moved yet.
    let first = begins..begins + 12;
    let (swells, softly) = (fastest(&usual[first.clone()]), fastest(&gentle[first]));
    assert!(swells > 0.05 && (softly / swells - 0.5).abs() < 0.01, "{softly} of {swells} m/s");
    let (hardest, softest) = (fastest(&usual), fastest(&gentle));
    assert!(hardest > 0.4 && softest < 0.7 * hardest, "{softest} of {hardest} m/s");
}

#[test]
fn the_site_says_what_everybody_finds() {
    let config = |text: &str| Config::parse(text, Path::new("kiosk.toml")).expect("a good configuration");
    assert_eq!(AccessibilitySettings::of(&config("").visit), AccessibilitySettings::default());
    let accessibility = AccessibilitySettings::of(&config("[visit]\npress_once = true\nreduced_motion = true\n").visit);
    assert!(accessibility.press_once && accessibility.reduced_motion);
    let mut visitor = Visitor::default();
    assert_eq!(send(&mut visitor, key("R", true, false)), Some(Request::ReadAloud), "a key reads aloud");
}

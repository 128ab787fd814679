//! Attract mode: when it begins and ends, and how its script runs.

use std::sync::Arc;

use soffio_exhibit::{Attract as Script, AttractAction, AttractStep};
use soffio_kiosk::attract::script::AttractMode;
use soffio_simulation::Command;
use soffio_soundscape::breath::Breath;

/// A script of one second: a text, then half a second of a breath that nobody could take for one.
fn script() -> Script {
    let samples: Arc<[f32]> = vec![0.0; 24_000].into();
    let blow = AttractAction::Blow { samples, sample_rate: 48_000, aim: Some([0.25, 0.75]) };
    Script {
        steps: vec![
            AttractStep { at: 0.0, action: AttractAction::Show("invite".into()) },
            AttractStep { at: 0.25, action: blow },
            AttractStep { at: 0.9, action: AttractAction::Reset },
        ],
        duration: 1.0,
    }
}

#[test]
fn attract_mode_begins_after_the_idle_time_and_ends_at_the_first_input() {
    let mut attract = AttractMode::new(script(), 2.0);
    for step in 1..480 {
        assert!(!attract.step(false, 0.0).active, "step {step}");
    }
    assert!(attract.step(false, 0.0).active, "two seconds are 480 steps");
    assert_eq!(attract.text(), Some("invite"));
    let cue = attract.step(true, 0.0);
    assert!(!cue.active && !attract.is_active());
    assert_eq!(cue.commands, [Command::Blow(None), Command::Settle], "the breath is the visitor's again, and the work");
    assert_eq!(attract.text(), None);
    assert!(attract.step(true, 0.0).commands.is_empty());
    for step in 1..480 {
        assert!(!attract.step(false, 0.0).active, "the idle time starts again, step {step}");
    }
    assert!(attract.step(false, 0.0).active);
}

#[test]
fn the_attract_script_runs_in_time_and_repeats() {
    let mut attract = AttractMode::new(script(), 1.0 / 240.0);
    for round in 0..2 {
        for step in 0..240 {
            let cue = attract.step(false, 0.0);
            let place = format!("round {round}, step {step}");
            assert!(cue.active, "{place}");
            assert_eq!(cue.aim, (step >= 60).then_some([0.25, 0.75]), "{place}");
            assert_eq!(cue.commands.contains(&Command::Reset), step == 216, "{place}");
            // 24 000 samples at 48 kHz are 120 steps; the step after them ends the breath.
            let blows = cue.commands.iter().any(|command| matches!(command, Command::Blow(Some(_))));
            assert_eq!(blows, step == 0 || (60..=180).contains(&step), "{place}");
        }
    }
}

#[test]
fn what_the_attract_script_has_set_swinging_is_calmed_a_second_later() {
    let mut attract = AttractMode::new(Script { duration: 4.0, ..script() }, 1.0 / 240.0);
    let calmed = (0..960).filter(|_| attract.step(false, 0.0).commands.contains(&Command::Settle)).count();
    assert_eq!(calmed, 1);
    // The breath ends at step 180 of each round.
    let calmed: Vec<u64> = (0..960).filter(|_| attract.step(false, 0.0).commands.contains(&Command::Settle)).collect();
    assert_eq!(calmed, [420]);
}

#[test]
fn the_attract_scripts_breath_grows_softer_the_faster_the_work_moves_than_before_it() {
    const ROUNDING: f64 = 1e-9;
    // The fastest breath of a round, of a work that moves so fast (m/s) before and during it.
    let samples: Arc<[f32]> = Breath::default().recorded(48_000, 7).into();
    let blow = AttractAction::Blow { samples, sample_rate: 48_000, aim: None };
    let script = Script { steps: vec![AttractStep { at: 0.25, action: blow }], duration: 8.0 };
    let fastest = |before: f64, during: f64| {
        let mut attract = AttractMode::new(script.clone(), 1.0 / 240.0);
        let cues = (0..1440).flat_map(|step| attract.step(false, if step <= 60 { before } else { during }).commands);
        let speeds = cues.filter_map(|command| if let Command::Blow(speed) = command { speed } else { None });
        speeds.fold(0.0_f64, f64::max)
    };
    let [calm, swings, swung_before] = [fastest(0.0, 0.0), fastest(0.0, 0.09), fastest(0.09, 0.09)];
    assert!(calm > 0.0 && (4.0 * swings / calm - 1.0).abs() < ROUNDING, "{calm} and {swings} m/s");
    assert!((swung_before / calm - 1.0).abs() < ROUNDING, "a clock swings anyhow: {swung_before} m/s");
}

#[test]
fn an_empty_script_still_waits_for_visitors() {
    let mut attract = AttractMode::new(Script::default(), 0.0);
    assert!(attract.step(false, 0.0).active && attract.step(false, 0.0).active);
    assert!(!attract.step(true, 0.0).active);
}

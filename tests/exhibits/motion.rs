//! The kinds of motion of an exhibit, and the change from one to another: no jump, no click, no fault, no memory.

use assert_no_alloc::assert_no_alloc;
use soffio_math::amplitude_to_db;
use soffio_simulation::{Command, MotionMode, SAMPLE_RATE, SAMPLES_PER_STEP, Settings, Simulation, StepInput};
use soffio_sound::{SoundCommand, Synth};

use crate::tally::Tally;
use crate::{load, note};

const DT: f64 = 1.0 / 240.0;
const MODES: [MotionMode; 3] = [MotionMode::Dynamic, MotionMode::Procedural, MotionMode::PositionBased];
/// A breath that moves everything, m/s at the lips.
const BREATH: f64 = 12.0;

pub static QUIET_CHANGES: Tally = Tally::new("changes of motion without a hit", 30);
pub static HEARD_CHANGES: Tally = Tally::new("changes of motion that are heard", 50);

/// A step with a breath from the first to the third second.
fn step(simulation: &mut Simulation, mode: MotionMode, blows: bool) {
    let speed = match simulation.steps() {
        240 if blows => Some(Command::Blow(Some(BREATH))),
        720 if blows => Some(Command::Blow(None)),
        _ => None,
    };
    simulation.step(&StepInput { mode: Some(mode), commands: speed.as_slice(), ..StepInput::default() });
}

pub fn a_change_of_motion_moves_nothing_by_itself(id: &str) {
    /// Beyond where its velocity takes it, m and degrees.
    const JUMP: f64 = 1e-3;
    const TURN: f64 = 0.5;
    const ORDER: [MotionMode; 4] =
        [MotionMode::Dynamic, MotionMode::PositionBased, MotionMode::Dynamic, MotionMode::Procedural];
    /// Steps from change to change: none into places while an exhibit draws itself onto another axis.
    const PERIOD: usize = 100;
    let mut simulation = Simulation::new(load(id), Settings::default());
    let (mut quiet, mut worst) = (0, (0.0_f64, 0.0_f64));
    // Distance of the last step from the direction of the velocity; procedural motion jumps by itself.
    let mut former = (0.0_f64, 0.0_f64);
    for index in 0..1440 {
        let mode = ORDER[index / PERIOD % 4];
        let before = simulation.bodies().to_vec();
        step(&mut simulation, mode, false);
        let mut leap = (0.0_f64, 0.0_f64);
        for (from, to) in before.iter().zip(simulation.bodies()) {
            let mut ahead = *from;
            ahead.displace(DT * from.velocity, DT * from.angular_velocity);
            let turn = 2.0 * (ahead.rotation.conjugate() * to.rotation).xyz().length().min(1.0).asin().to_degrees();
            leap = (leap.0.max(ahead.position.distance(to.position)), leap.1.max(turn));
        }
        // The classical procedural rule makes large rotations in any step, so also in its first one. The joints do not
        // account for the velocity that it leaves behind.
        let smooth =
            mode != MotionMode::Procedural && ORDER[index.saturating_sub(1) / PERIOD % 4] != MotionMode::Procedural;
        if index % PERIOD == 0 && index > 0 && smooth && simulation.events().is_empty() {
            quiet += 1;
            let more = (leap.0 - 2.0 * former.0, leap.1 - 2.0 * former.1);
            worst = (worst.0.max(more.0), worst.1.max(more.1));
            let what = format!("{id}, step {index}, to {mode:?}");
            assert!(more.0 < JUMP && more.1 < TURN, "{what}: {leap:?} (m, degrees) after {former:?}");
        }
        former = leap;
    }
    note!("{id}: {quiet} changes, {:.1e} m, {:.1e}° at most", worst.0, worst.1);
    QUIET_CHANGES.add(quiet);
}

/// The roughest place of a piece of sound: the largest second difference of the left channel.
fn roughest(piece: &[f32]) -> f64 {
    piece.chunks(2).map(|frame| f64::from(frame[0])).collect::<Vec<_>>().windows(3).fold(0.0, |most, w| {
        let bend: f64 = w[2] - 2.0 * w[1] + w[0];
        most.max(bend.abs())
    })
}

pub fn a_change_of_motion_is_not_heard_as_a_click(id: &str) {
    /// Clicks below this level are inaudible beside an impact, dB of full scale.
    const CLICK_DB: f64 = -80.0;
    /// Noise of wind and scraping has its own peaks: those of 20 ms beside those of half a second before.
    const ROUGHER: f64 = 2.0;
    /// Steps from change to change, heard after one, and before one.
    const PERIOD: usize = 151;
    const AFTER: usize = 5;
    const BEFORE: usize = 120;
    let exhibit = load(id);
    let mut simulation = Simulation::new(exhibit.clone(), Settings::default());
    let mut synth = Synth::new(SAMPLE_RATE, &exhibit.instruments, 1).expect("the exhibit's timbres");
    synth.set_dry(true);
    let mut sound: Vec<Vec<f32>> = Vec::new();
    let mut hit: Vec<bool> = Vec::new();
    for index in 0..1440 {
        step(&mut simulation, MODES[index / PERIOD % 3], true);
        hit.push(simulation.sounds().iter().any(|sound| matches!(sound, SoundCommand::Strike(_))));
        // Timbres that motion plays click by themselves: links that touch, teeth that pass.
        let plays = |sound: &&SoundCommand| !matches!(sound, SoundCommand::Motion(_));
        simulation.sounds().iter().filter(plays).for_each(|sound| synth.command(*sound));
        let mut block = vec![0.0; 2 * SAMPLES_PER_STEP as usize];
        synth.render(&mut block);
        sound.push(block);
    }
    let (mut changes, mut worst) = (0, 0.0_f64);
    for at in (PERIOD..1440 - AFTER).step_by(PERIOD) {
        if hit[at - 1..at + AFTER].contains(&true) {
            continue;
        }
        let after = roughest(&sound[at - 1..at + AFTER].concat());
        let before = roughest(&sound[at - BEFORE..at - 1].concat());
        let what = format!("{id}, step {at}, to {:?}", MODES[at / PERIOD % 3]);
        let loud = format!("{:.1} dB after {:.1} dB", amplitude_to_db(after), amplitude_to_db(before));
        assert!(after < ROUGHER * before || amplitude_to_db(after) < CLICK_DB, "{what}: {loud}");
        worst = worst.max(after / before.max(1e-9));
        changes += usize::from(amplitude_to_db(before) > CLICK_DB);
    }
    note!("{id}: {changes} changes while it sounds, {worst:.2} as rough at most");
    HEARD_CHANGES.add(changes);
}

pub fn the_mode_is_an_input_so_a_replay_repeats_it(id: &str) {
    let exhibit = load(id);
    let run = |period: usize| {
        let mut simulation = Simulation::new(exhibit.clone(), Settings::default());
        (0..480).for_each(|index| step(&mut simulation, MODES[index / period % 3], true));
        simulation.state_hash()
    };
    let first = run(50);
    assert_eq!(first, run(50), "{id}");
    if exhibit.refusal().is_some() {
        assert_eq!(first, run(70), "{id} moves by dynamics, whatever is asked");
    } else {
        assert_ne!(first, run(70), "{id}: another order of modes gives the same state");
    }
}

/// Steps that a figure has made after which nothing may ask for memory: a breath has moved it, the lists have been used.
const WARM: usize = 240;

/// The allocator that watches is that of `main.rs`; it acts in debug builds.
pub fn position_based_motion_does_not_fault_and_asks_for_no_memory(id: &str) {
    moved_by_places(id, 5);
}

pub fn position_based_motion_of_twenty_seconds_does_not_fault(id: &str) {
    moved_by_places(id, 20);
}

fn moved_by_places(id: &str, seconds: usize) {
    for mode in &MODES[1..] {
        let mut simulation = Simulation::new(load(id), Settings::default());
        let mut farthest: f64 = 0.0;
        for index in 0..240 * seconds {
            if index < WARM {
                step(&mut simulation, *mode, true);
            } else {
                assert_no_alloc(|| step(&mut simulation, *mode, true));
            }
            farthest = farthest.max(simulation.joint_error());
        }
        note!("{id} {mode:?}: joints {farthest:.1e} m, energy {:.3e} J", simulation.energy());
        assert_eq!(simulation.snapshot().diagnostics.faults, 0, "{id} {mode:?}");
    }
}

//! What nobody blows at comes to rest in the gallery, and only there.

use std::sync::Arc;

use soffio_exhibit::{self as exhibit, Exhibit, IdleDampingSpec};
use soffio_math::exp;
use soffio_simulation::{Command, Profile, STEPS_PER_SECOND, Settings, Simulation, StepInput};

const CALM: IdleDampingSpec = IdleDampingSpec { after: 1.0, time: 4.0 };
/// It grows so much firmer within so long, s.
const FIRMER: f64 = 8.0;
const GROWTH: f64 = 5.0;
/// Air and pivot brake a swing too, and its energy is not the same all the way of one swing.
const OTHERWISE: f64 = 0.15;

fn pendulum(calm: Option<IdleDampingSpec>) -> Arc<Exhibit> {
    let folder = exhibit::resolve("pendulum").unwrap_or_else(|report| panic!("{report}"));
    let exhibit = exhibit::load(&folder).unwrap_or_else(|report| panic!("{report}"));
    Arc::new(Exhibit { idle_damping: calm, ..exhibit })
}

fn blown_for_a_second(exhibit: &Arc<Exhibit>, profile: Profile) -> Simulation {
    let mut simulation = Simulation::new(exhibit.clone(), Settings { profile, ..Settings::default() });
    for _ in 0..STEPS_PER_SECOND {
        simulation.step(&StepInput { commands: &[Command::Blow(Some(12.0))], ..StepInput::default() });
    }
    simulation.step(&StepInput { commands: &[Command::Blow(None)], ..StepInput::default() });
    simulation
}

fn wait(simulation: &mut Simulation, seconds: f64) {
    for _ in 0..(seconds * STEPS_PER_SECOND as f64).round() as u64 {
        simulation.step(&StepInput::default());
    }
}

/// Energy where it hangs at rest, J.
fn lowest() -> f64 {
    let settings = Settings { wind: false, ..Settings::default() };
    let mut simulation = Simulation::new(pendulum(Some(IdleDampingSpec { after: 0.0, time: 0.3 })), settings);
    wait(&mut simulation, 20.0);
    simulation.energy()
}

#[test]
fn a_swing_fades_as_it_is_asked_to_once_nobody_blows() {
    let [mut free, mut calmed] = [None, Some(CALM)].map(|calm| blown_for_a_second(&pendulum(calm), Profile::Gallery));
    // Not yet, and then over a second.
    let waiting = 0.9 * CALM.after;
    for simulation in [&mut calmed, &mut free] {
        wait(simulation, waiting);
    }
    assert_eq!(calmed.state_hash(), free.state_hash());
    const LONG: f64 = 2.0;
    let lowest = lowest();
    let mut energies = |seconds: f64| {
        [&mut calmed, &mut free].map(|simulation| {
            wait(simulation, seconds);
            simulation.energy() - lowest
        })
    };
    let [before, free_before] = energies(1.2);
    let [after, free_after] = energies(LONG);
    let faded = (after / before) / (free_after / free_before);
    // ∫ r dt from where the calm has come over to the end, r = (1 + (K − 1) t/G)/τ.
    let (from, to) = (waiting + 1.2 - CALM.after, waiting + 1.2 + LONG - CALM.after);
    let expected = exp(-(LONG + (FIRMER - 1.0) * 0.5 * (to * to - from * from) / GROWTH) / CALM.time);
    println!("energy {before:.2e} to {after:.2e} J; remaining fraction {faded:.4}, expected {expected:.4}");
    assert!((faded / expected - 1.0).abs() < OTHERWISE, "{faded} of {expected}");
}

#[test]
fn the_true_profile_knows_no_calm() {
    let [with, without] = [Some(CALM), None].map(|calm| {
        let mut simulation = blown_for_a_second(&pendulum(calm), Profile::Physical);
        wait(&mut simulation, 4.0);
        simulation.state_hash()
    });
    assert_eq!(with, without);
}

#[test]
fn the_next_breath_ends_it() {
    let mut simulation = blown_for_a_second(&pendulum(Some(CALM)), Profile::Gallery);
    let mut never = blown_for_a_second(&pendulum(None), Profile::Gallery);
    for simulation in [&mut simulation, &mut never] {
        // A breath that hardly moves anything, again and again.
        for step in 0..4 * STEPS_PER_SECOND {
            let commands = [Command::Blow((step % STEPS_PER_SECOND == 0).then_some(0.2))];
            simulation.step(&StepInput { commands: &commands, ..StepInput::default() });
        }
    }
    assert_eq!(simulation.state_hash(), never.state_hash());
}

#[test]
fn what_a_visitor_finds_swinging_is_still_before_they_blow() {
    /// From walking up to blowing, s.
    const SOON: f64 = 1.5;
    let calm = IdleDampingSpec { after: 1.0, time: 2.5 };
    let lowest = lowest();
    let [called, left] = [true, false].map(|called| {
        let mut simulation = blown_for_a_second(&pendulum(Some(calm)), Profile::Gallery);
        let commands: &[Command] = if called { &[Command::Settle] } else { &[] };
        simulation.step(&StepInput { commands, ..StepInput::default() });
        wait(&mut simulation, SOON);
        simulation.energy() - lowest
    });
    println!("called {called:.2e} J, left {left:.2e} J");
    // The rate is 1/0.5 s after 0.3 s: exp(−(1.5 − 0.15)/0.5) = 0.067; pivot and air take the rest.
    assert!(called < 0.1 * left && called > 0.0, "{called} of {left}");
    // A breath ends it: nothing is held back.
    let mut both = [true, false].map(|called| {
        let mut simulation = blown_for_a_second(&pendulum(Some(calm)), Profile::Gallery);
        let blow = Command::Blow(Some(9.0));
        let commands: &[Command] = if called { &[Command::Settle, blow] } else { &[blow] };
        simulation.step(&StepInput { commands, ..StepInput::default() });
        simulation
    });
    both.iter_mut().for_each(|simulation| wait(simulation, SOON));
    assert_eq!(both[0].state_hash(), both[1].state_hash());
}

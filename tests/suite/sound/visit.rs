//! What a visitor hears: in a visit of 20 s with three breaths every exhibit sounds by more than the hiss of the breath, and air that
//! moves by itself is heard.

use std::path::Path;
use std::sync::Arc;

use soffio_exhibit::{self as exhibit, Exhibit};
use soffio_math::amplitude_to_db;
use soffio_simulation::{Command, Settings, Simulation, StepInput};
use soffio_sound::{InstrumentSpec, SoundCommand, Synth};

use super::{RATE, render, rms};

/// Length of the visit, s.
const VISIT: usize = 20;
/// Beginnings of the breaths, s, their length, s, and their speed at the lips, m/s: that of a normal breath.
const BREATHS: [f64; 3] = [1.0, 7.0, 13.0];
const LASTS: f64 = 1.5;
const SPEED: f64 = 8.0;
/// Samples of both sides in a twentieth of a second, the shortest time in which a level is heard.
const FRAME: usize = 2 * 2400;
/// Level over noise at which a sound stands out, dB.
const STANDS_OUT: f64 = 6.0;
/// Level below which nothing is heard in a gallery at the loudness that levels are set for, dBFS: 40 dB below the programme.
const AUDIBLE: f64 = -63.0;
/// An onset is at least twice as loud as the frame before.
const ONSET: f64 = 2.0;

fn load(id: &str) -> Exhibit {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("exhibits").join(id);
    exhibit::load(&folder).unwrap_or_else(|report| panic!("{}", report.to_text()))
}

/// All sounds of a visit, in the order of their times. Without breaths, of as long a time without a visitor.
fn visit(exhibit: &Exhibit, breaths: &[f64]) -> Vec<SoundCommand> {
    let mut simulation = Simulation::new(Arc::new(exhibit.clone()), Settings::default());
    let mut commands = Vec::new();
    for step in 0..VISIT * 240 {
        let t = step as f64 / 240.0;
        let blows = breaths.iter().any(|start| (*start..start + LASTS).contains(&t));
        let blow = [Command::Blow(Some(if blows { SPEED } else { 0.0 }))];
        simulation.step(&StepInput { commands: &blow, ..StepInput::default() });
        commands.extend_from_slice(simulation.sounds());
    }
    commands.sort_by_key(SoundCommand::sample);
    commands
}

/// The sound of a visit with these instruments alone, as the loudspeaker has it.
fn sound(exhibit: &Exhibit, commands: &[SoundCommand], wanted: impl Fn(&InstrumentSpec) -> bool) -> Vec<f32> {
    let gain = |spec: &InstrumentSpec| if wanted(spec) { spec.gain } else { 0.0 };
    let specs: Vec<_> =
        exhibit.instruments.iter().map(|spec| InstrumentSpec { gain: gain(spec), ..spec.clone() }).collect();
    let mut synth = Synth::new(RATE, &specs, 1).expect("checked");
    let mut out = Vec::with_capacity(2 * VISIT * RATE as usize);
    let mut pending = commands.iter().peekable();
    while out.len() < 2 * VISIT * RATE as usize {
        while let Some(command) = pending.next_if(|command| command.sample() < synth.position() + 200) {
            synth.command(*command);
        }
        out.extend(render(&mut synth, 200));
    }
    out
}

fn hisses(spec: &InstrumentSpec) -> bool {
    spec.timbre == "wind-room"
}

#[test]
fn every_exhibit_is_heard_by_more_than_the_hiss_of_a_breath() {
    let mut silent = Vec::new();
    for id in exhibit::ids() {
        let exhibit = load(&id);
        let commands = visit(&exhibit, &BREATHS);
        let all = sound(&exhibit, &commands, |_| true);
        let rings = sound(&exhibit, &commands, |spec| !hisses(spec));
        // What the mix has beside them is the hiss as it is heard: it ducks.
        let hiss: Vec<f32> = all.iter().zip(&rings).map(|(all, rings)| all - rings).collect();
        let levels = |sound: &[f32]| sound.chunks_exact(FRAME).map(rms).collect::<Vec<_>>();
        let (rings, hiss) = (levels(&rings), levels(&hiss));
        let onset = |i: &usize| rings[*i] > ONSET * rings[i - 1] && amplitude_to_db(rings[*i]) > AUDIBLE;
        let over = (1..rings.len()).filter(onset).map(|i| amplitude_to_db(rings[i] / hiss[i].max(1e-6)));
        let best = over.clone().fold(f64::NEG_INFINITY, f64::max);
        println!("{id}: {} onsets, the best {best:.0} dB over the hiss", over.count());
        if best < STANDS_OUT {
            silent.push(id);
        }
    }
    assert!(silent.is_empty(), "nothing but hiss: {silent:?}");
}

#[test]
fn the_windy_corner_is_heard_without_a_breath_and_follows_its_gusts() {
    let corner = load("windy-corner");
    let commands = visit(&corner, &[]);
    let hiss = sound(&corner, &commands, hisses);
    let levels: Vec<f64> = hiss.chunks_exact(FRAME).map(rms).collect();
    let mut sorted = levels.clone();
    sorted.sort_by(f64::total_cmp);
    let median = amplitude_to_db(sorted[sorted.len() / 2]);
    println!("median {median:.1} dBFS");
    assert!(median > AUDIBLE, "{median} dBFS");
    // The wind of each frame beside its level: stronger wind is louder.
    let mut winds = vec![0.0f64; levels.len()];
    for command in &commands {
        if let SoundCommand::Wind(wind) = command {
            let frame = (2 * wind.sample as usize / FRAME).min(levels.len() - 1);
            winds[frame..].fill(f64::from(wind.speed));
        }
    }
    let pairs: Vec<(f64, f64)> =
        winds.iter().copied().zip(levels.iter().map(|l| amplitude_to_db(*l))).skip(5).collect();
    let n = pairs.len() as f64;
    let mean = |of: fn(&(f64, f64)) -> f64| pairs.iter().map(of).sum::<f64>() / n;
    let (wind, level) = (mean(|p| p.0), mean(|p| p.1));
    let sum = |of: &dyn Fn(f64, f64) -> f64| pairs.iter().map(|p| of(p.0 - wind, p.1 - level)).sum::<f64>();
    let correlation = sum(&|w, l| w * l) / (sum(&|w, _| w * w) * sum(&|_, l| l * l)).sqrt();
    println!("wind {wind:.2} m/s, correlation of speed and level {correlation:.2}");
    assert!(correlation > 0.5, "{correlation}");
}

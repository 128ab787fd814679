//! Training examples: scenes of the generator as the detector's front end measures them, with their targets.
//!
//! A frame is a breath where its air is fast enough at the capsule and its sound stands out from everything else, and no breath where there
//! is no air. Between the two it is unknown, and the frame does not count.

use super::generator::Scene;
use super::parallel::parallel;
use super::{boosting, generator};
use soffio_detector::features::{COUNT, Inputs};
use soffio_detector::frontend::Frontend;
use soffio_detector::spectrum::FRAME_S;
use soffio_math::ln;
use soffio_math::noise::hash_words;

/// Slowest air at the capsule that the detector is asked to hear, m/s.
const SLOWEST_AIR_M_S: f32 = 0.35;
/// Least level of a breath over all other sound in its best octave, dB.
const LEAST_OVER_DB: f32 = 3.0;
/// Least rise of a band over its floor, dB: what gates and noise suppression take away, nobody can hear.
const LEAST_RISE_DB: f64 = 6.0;
/// Time after a breath that does not count, s: the analysis window and the room still hold it.
const AFTER_S: f64 = 0.1;
/// Time after which a detector notices a breath and stops learning the echo, s.
const NOTICED_S: f64 = 0.12;

/// Every how many frames becomes an example, of breath and of other sounds: neighbours say nearly the same.
const EVERY: (usize, usize) = (3, 9);
/// Scenes that the bins are measured on.
const BINNED: u64 = 40;

/// Channels that a scene is measured with. The first one is nearer to the jet's axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Channels {
    /// The first alone.
    One,
    /// Both; `swapped`: the second one comes first.
    Two {
        /// The second one comes first.
        swapped: bool,
    },
}

/// One frame with its targets.
#[derive(Clone, Debug)]
pub struct Example {
    /// Inputs of the model.
    pub inputs: Inputs,
    /// Level of the loudest band, dB of full scale.
    pub level: f32,
    /// It is a breath.
    pub breath: bool,
    /// Natural logarithm of the air's speed at the capsule, m/s.
    pub log_air: f32,
}

/// Frames of a scene that count, one in three of breath and one in nine of others.
pub fn of_scene(scene: &Scene, capsules: Channels) -> Vec<Example> {
    let frontend = Frontend::new(scene.rate);
    let mut frontend = if capsules == Channels::One { frontend } else { frontend.of_two_capsules() };
    let (mut examples, mut frames) = (Vec::new(), 0);
    let (mut breathing_s, mut since_s) = (0.0, f64::INFINITY);
    let per_ms = scene.rate as usize / 1000;
    let (first, second) = match capsules {
        Channels::One => (&scene.capsules[0], None),
        Channels::Two { swapped: false } => (&scene.capsules[0], Some(&scene.capsules[1])),
        Channels::Two { swapped: true } => (&scene.capsules[1], Some(&scene.capsules[0])),
    };
    for (i, left) in first.iter().enumerate() {
        let right = second.map(|samples| samples[i]);
        let played = scene.played.get(i).copied().unwrap_or(0.0);
        let learn_echo = breathing_s < NOTICED_S;
        let Some(frame) = frontend.push(*left, right, played, learn_echo) else { continue };
        let ms = (i / per_ms).min(scene.air.len() - 1);
        let (air, over_db) = (scene.air[ms], scene.over_db[ms]);
        let breath = air >= SLOWEST_AIR_M_S && over_db >= LEAST_OVER_DB;
        breathing_s = if breath { breathing_s + FRAME_S } else { 0.0 };
        since_s = if air > 0.0 { 0.0 } else { since_s + FRAME_S };
        let Some(measured) = frame.measured else { continue };
        let counts = if breath { measured.rise_db >= LEAST_RISE_DB } else { since_s > AFTER_S };
        frames += 1;
        let every = if breath { EVERY.0 } else { EVERY.1 };
        if counts && frames % every == 0 && !frontend.features.floor.is_settling() {
            let level = measured.levels.iter().copied().fold(f64::NEG_INFINITY, f64::max) as f32;
            examples.push(Example {
                inputs: measured.inputs,
                level,
                breath,
                log_air: ln(f64::from(air.max(0.1))) as f32,
            });
        }
    }
    examples
}

/// Examples of many scenes: bins of the inputs, and levels and speeds beside them.
#[derive(Clone, Debug)]
pub struct Collection {
    /// Inputs and whether each is a breath.
    pub breaths: boosting::Examples,
    /// Edges of the bins of each input.
    pub edges: Vec<Vec<f32>>,
    /// Level of the loudest band of each example, dB of full scale.
    pub levels: Vec<f32>,
    /// Natural logarithm of the air's speed of each example, m/s.
    pub log_air: Vec<f32>,
}

/// Examples of the first scenes of a seed, each through one capsule and through two.
pub fn of_seed(seed: u64, scenes: u64) -> Collection {
    let of = |index: u64| {
        let scene = generator::scene(seed, index);
        let swapped = hash_words(&[seed, index]).is_multiple_of(2);
        [Channels::One, Channels::Two { swapped }].map(|capsules| of_scene(&scene, capsules)).concat()
    };
    let sample = parallel(scenes.min(BINNED) as usize, |i| of(i as u64)).concat();
    let edges = parallel(COUNT, |input| boosting::edges(sample.iter().map(|example| example.inputs[input]).collect()));
    let rows = parallel(scenes as usize, |i| {
        let row = |example: Example| {
            let bins: [u8; COUNT] = std::array::from_fn(|k| boosting::bin(&edges[k], example.inputs[k]));
            (bins, example.level, example.breath, example.log_air)
        };
        of(i as u64).into_iter().map(row).collect::<Vec<_>>()
    });
    let rows: Vec<_> = rows.concat();
    Collection {
        breaths: boosting::Examples {
            columns: (0..COUNT).map(|k| rows.iter().map(|row| row.0[k]).collect()).collect(),
            targets: rows.iter().map(|row| f32::from(u8::from(row.2))).collect(),
            weights: rows.iter().map(|row| if row.2 { 1.0 } else { EVERY.1 as f32 / EVERY.0 as f32 }).collect(),
        },
        edges,
        levels: rows.iter().map(|row| row.1).collect(),
        log_air: rows.iter().map(|row| row.3).collect(),
    }
}

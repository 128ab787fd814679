//! Training examples: scenes of the generator as the detector's front end measures them, with their targets.
//!
//! A frame is a breath where its air is fast enough at the capsule and its sound stands out from everything else, and no breath where there
//! is no air. Between the two it is unknown, and the frame does not count.

use super::generator::{self, Scene};
use super::gradient::Example;
use soffio_detector::bands::BANDS;
use soffio_detector::features;
use soffio_detector::frontend::Frontend;
use soffio_detector::spectrum::FRAME_S;
use soffio_math::ln;
use soffio_math::noise::{Random, hash_words};

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

/// Largest half of the colour of a band: 2.4 dB of the shape's 30 dB, twice.
const COLOUR: f64 = 0.08;

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

/// Examples of a scene.
pub fn of_scene(scene: &Scene, capsules: Channels) -> Vec<Example> {
    let mut frontend = Frontend::new(scene.rate);
    let mut examples = Vec::with_capacity((scene.air.len() as f64 * 0.001 / FRAME_S) as usize);
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
        examples.push(Example {
            inputs: measured.inputs,
            levels: measured.levels.map(|level| level as f32),
            target: f32::from(u8::from(breath)),
            weight: if counts && !frontend.features.floor.is_settling() { 1.0 } else { 0.0 },
            log_air: ln(f64::from(air.max(0.1))) as f32,
            first: examples.is_empty(),
        });
    }
    examples
}

/// Colours the shape of a scene's spectra, as microphones do in ways that nobody lists.
fn colour(examples: &mut [Example], random: &mut Random) {
    let offsets: [f32; BANDS] = std::array::from_fn(|_| (COLOUR * (random.signed() + random.signed())) as f32);
    for shape in examples.iter_mut().map(|example| &mut example.inputs[features::SHAPE]) {
        shape.iter_mut().zip(offsets).for_each(|(x, offset)| *x = (*x + offset).clamp(-1.0, 0.0));
    }
}

/// Examples of a range of scenes, each through one capsule and through two.
pub fn of_seed(seed: u64, scenes: std::ops::Range<u64>) -> Vec<Vec<Example>> {
    let count = (scenes.end - scenes.start) as usize;
    let both = super::parallel::parallel(count, |i| {
        let scene = generator::scene(seed, scenes.start + i as u64);
        let swapped = hash_words(&[seed, scenes.start + i as u64]).is_multiple_of(2);
        let mut random = Random::new(hash_words(&[seed, scenes.start + i as u64, 3]));
        [Channels::One, Channels::Two { swapped }].map(|capsules| {
            let mut examples = of_scene(&scene, capsules);
            colour(&mut examples, &mut random);
            examples
        })
    });
    both.into_iter().flatten().collect()
}

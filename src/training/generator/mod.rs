//! Labelled scenes that the breath detector is trained on: physics of breaths, air, sounds, rooms and microphones.
//!
//! # What a breath is at a microphone
//!
//! A breath leaves the lips at U₀, becomes a turbulent jet (`jet`), and needs 0.1 to 0.9 s to the capsule. There its
//! eddies press on the port as they are carried past (`turbulence`). So the signal is a noise with a corner that
//! follows the local speed of the air, f_c = 0.75 U/(2π L) with L ≈ 0.085 x. At 50 cm it is below 60 Hz. The pressure is
//! ∝ U², so it falls by 22 dB from 10 to 36 cm. Two capsules hear the same slow gusts and different small eddies.
//! The lips' hiss is a sound: it is there before the air, and both capsules hear it alike (`breath`).
//!
//! # What is no breath
//!
//! Draughts and wind are air too, with other scales and courses (`draught`). Near speech blows on the capsule with its
//! consonants (`people`). Hands, knocks and slams shake it (`objects`). There are machines and weather
//! (`machines`), music (`music`) and the kiosk's own sound (`recipe`), in a room (`stage`).
//!
//! # Levels
//!
//! All sources are in pascal at the capsules, so their ratios are those of nature. A device follows (`microphone`).
//!
//! # Targets
//!
//! `air` is the mean speed without turbulence. `over_db` compares the air's pressure alone, without the hiss, with all
//! the rest (`labels`). The first capsule is never farther from the jet's axis than the second, so both hold for one
//! capsule and for two. Training on two capsules should swap them at random.
//!
//! It shares no code with the generator of the validation scenes. Each scene depends on its seed and index alone.

mod breath;
mod draught;
mod filter;
mod jet;
mod labels;
mod machines;
mod microphone;
mod music;
mod noise;
mod objects;
mod people;
mod recipe;
mod stage;
mod turbulence;
mod voice;

#[cfg(test)]
mod checks;

use soffio_math::noise::{Random, hash_words};

use noise::{Draw, RATE, Shape};
use stage::{Stage, pascal};

/// A labelled scene.
#[derive(Clone, Debug)]
pub struct Scene {
    /// Sample rate, Hz.
    pub rate: u32,
    /// Samples of both capsules, full scale 1. A scene for one capsule uses the first.
    pub capsules: Vec<Vec<f32>>,
    /// What the kiosk plays, full scale 1; empty without a loudspeaker.
    pub played: Vec<f32>,
    /// Mean speed of the breath's air at the nearer capsule, m/s, one value a millisecond. It is 0 without a breath;
    /// draughts and consonants do not count.
    pub air: Vec<f32>,
    /// Level of the breath's air in the microphone's signal over everything else, dB, one value a millisecond: of the
    /// best octave between 27 and 3400 Hz, a mean over about 100 ms. It is −100 without a breath.
    pub over_db: Vec<f32>,
    /// Breaths, by their time at the lips.
    pub breaths: Vec<BreathLabel>,
    /// Recipe.
    pub kind: &'static str,
}

/// One breath.
#[derive(Clone, Debug, PartialEq)]
pub struct BreathLabel {
    /// First and last time at the lips, s.
    pub lips: (f64, f64),
    /// First and last time of air of 0.2 m/s or more at the first capsule, s; both 0 if it never arrives.
    pub capsule: (f64, f64),
    /// Fastest speed at the lips, m/s.
    pub lips_speed: f64,
    /// Fastest mean speed at the first capsule, m/s.
    pub peak_air: f64,
    /// From the lips to the first capsule, m.
    pub distance: f64,
    /// Between the mean axis of the jet and the first capsule, degrees.
    pub angle_deg: f64,
    /// How it was blown.
    pub manner: &'static str,
}

/// The scene of this seed and index, 40 to 120 s long.
pub fn scene(seed: u64, index: u64) -> Scene {
    let mut random = Random::new(hash_words(&[seed, index, 0x5cee]));
    let random = &mut random;
    let seconds = random.log_range(40.0, 120.0).floor();
    let kind = recipe::kind(random);
    let (room, port, device) = (stage::draw_room(random), recipe::port(random), microphone::draw(random));
    let mut stage = Stage::new(seconds, random.word(), room, port);
    recipe::background(&mut stage, random, kind, seconds);
    let played = if random.chance(0.25) { recipe::kiosk_output(&mut stage, random, seconds) } else { Vec::new() };
    let mut breaths = Vec::new();
    let with_breaths = random.chance(0.55);
    let share = random.range(0.35, 0.9);
    let mut t = random.range(0.5, 4.0);
    while t < seconds - 2.0 {
        if with_breaths && random.chance(share) {
            if random.chance(0.3) {
                let at = (t + random.range(-2.0, 1.5)).max(0.0);
                recipe::event(&mut stage, random, kind, at);
            }
            let start = t;
            t += recipe::breaths(&mut stage, random, start, &mut breaths);
            if random.chance(0.08) {
                // Another visitor joins in.
                let at = start + random.range(0.1, 2.0);
                t = t.max(at + recipe::breaths(&mut stage, random, at, &mut breaths));
            }
        } else {
            t += recipe::event(&mut stage, random, kind, t);
        }
        t += random.log_range(0.6, 20.0);
    }
    breaths.sort_by(|a, b| a.lips.0.total_cmp(&b.lips.0));
    let (capsules, over_db) = record(&mut stage, random, &device);
    Scene { rate: RATE as u32, capsules, played, air: stage.air, over_db, breaths, kind }
}

/// What the device makes of the stage: its samples, and the breaths' level over the rest.
fn record(stage: &mut Stage, random: &mut Random, device: &microphone::Microphone) -> (Vec<Vec<f32>>, Vec<f32>) {
    stage.reverberate(random);
    // Self-noise rises a little towards low frequencies.
    let hiss = Shape::new(RATE, |f| (1.0 + 60.0 / f).sqrt());
    let own = pascal(device.noise);
    for capsule in 0..2 {
        let noise = stage.workshop.noise(random, stage.length, &hiss);
        stage::add(&mut stage.other[capsule], 0.0, &noise, own);
    }
    let mut capsules = std::mem::take(&mut stage.other).to_vec();
    let [mut first, second] = std::mem::take(&mut stage.breath);
    let sum = |a: &mut [f32], b: &[f32]| a.iter_mut().zip(b).for_each(|(a, b)| *a += b);
    // Of the second capsule the parts stay together.
    sum(&mut capsules[1], &second);
    device.filter(0, &mut capsules[0]);
    device.filter(1, &mut capsules[1]);
    device.filter(0, &mut first);
    let over = labels::over_db(&mut stage.workshop, &first, &capsules[0], stage.air.len());
    sum(&mut capsules[0], &first);
    if random.chance(0.08) {
        machines::faults(random, &mut capsules);
    }
    device.finish(random, &mut capsules);
    (capsules, over)
}

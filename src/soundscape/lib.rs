//! Synthetic sounds of breaths, draughts and museums at a microphone, with labels. They examine the breath detector and fill the
//! rehearsed day.
//!
//! ```text
//! jet → eddies ─┐
//! lips ─────────┴→ breath ──────────┐
//! eddies → draught ─────────────────┼→ scenes::Stage (Pa) → microphone → Take
//! voices noises → rooms → Scenario ─┤
//! kiosk_sound → rooms ──────────────┘
//! ```
//!
//! All sound is pressure in pascals until the microphone. A breath is a jet whose eddies pass the capsules ([`breath`]). A
//! [`scenes::Scenario`] draws voices and rooms from a seed. A [`scenes::Stage`] adds breaths to a room, and each microphone makes a
//! [`Take`] of it.
//!
//! It never reads a file, a device or a clock, and never runs in the kiosk. The same seed gives the same samples.
//!
//! ```
//! use soffio_soundscape::breath::Breath;
//!
//! let breath = Breath { speed: 9.0, distance: 0.2, ..Breath::default() };
//! let samples = breath.recorded(16_000, 1);
//! assert!(samples.iter().all(|x| x.abs() <= 1.0));
//!
//! let label = breath.label(0.0, &breath.speeds(1));
//! assert!(label.lips < label.arrival && label.arrival < label.end);
//! assert!(label.peak_speed < 9.0, "the jet slows down: {} m/s", label.peak_speed);
//! ```

pub mod breath;
pub mod draught;
pub mod eddies;
pub mod filters;
pub mod jet;
pub mod kiosk_sound;
pub mod level;
pub mod lips;
pub mod microphone;
pub mod noises;
pub mod parallel;
mod people;
pub mod rooms;
pub mod scenes;
pub mod statistics;
pub mod test_sounds;
pub mod voices;

use people::Manner;

/// First seed of the scenarios of rehearsals.
pub const FIRST_VALIDATION_SEED: u64 = 1_000_000;

/// Sample rate of scenes, Hz.
pub const RATE: u32 = 16_000;

/// Label of one breath in a take.
#[derive(Clone, Debug, PartialEq)]
pub struct BreathLabel {
    /// Manner.
    pub manner: Manner,
    /// Beginning of the flow at the lips, s.
    pub lips: f64,
    /// First time with a mean speed of 0.35 m/s at a capsule (half of the peak, for a weaker breath), s.
    pub arrival: f64,
    /// Last time with that speed, s.
    pub end: f64,
    /// Distance from the lips to the capsules, m.
    pub distance: f64,
    /// Peak of the mean speed at a capsule, m/s.
    pub peak_speed: f64,
    /// Level over the room in the best octave band from 31 to 3400 Hz after the high-pass, from arrival to end, dB.
    pub level_db: f64,
    /// Mean speed at the capsule with the faster air, m/s, one value a millisecond.
    pub speeds: Vec<f64>,
    /// Time of the first of these values, s.
    pub speeds_from: f64,
}

impl BreathLabel {
    /// Mean speed at a time, s: m/s.
    pub fn speed_at(&self, time: f64) -> f64 {
        let step = ((time - self.speeds_from) * jet::STEPS_A_SECOND).round();
        if step < 0.0 { 0.0 } else { self.speeds.get(step as usize).copied().unwrap_or(0.0) }
    }
}

/// A sound in a scene, before any room.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Event {
    /// Beginning, s.
    pub at: f64,
    /// End, s.
    pub until: f64,
    /// Kind of sound, in words.
    pub what: &'static str,
}

/// A labelled sound.
#[derive(Clone, Debug)]
pub struct Take {
    /// Breaths in the take.
    pub breaths: Vec<BreathLabel>,
    /// The (first) capsule, full scale ±1.
    pub left: Vec<f32>,
    /// The second capsule.
    pub right: Option<Vec<f32>>,
    /// Output of the kiosk's loudspeaker over the same time; empty without any.
    pub played: Vec<f32>,
    /// Other sounds of the scene.
    pub events: Vec<Event>,
    /// Sample rate, Hz.
    pub sample_rate: u32,
}

impl Take {
    /// Duration, s.
    pub fn duration(&self) -> f64 {
        self.left.len() as f64 / f64::from(self.sample_rate)
    }

    /// The same take at another sample rate, Hz.
    pub fn at_rate(&self, rate: u32) -> Self {
        let convert = |samples: &Vec<f32>| microphone::resampled(samples, self.sample_rate, rate);
        Self {
            left: convert(&self.left),
            right: self.right.as_ref().map(convert),
            played: convert(&self.played),
            sample_rate: rate,
            ..self.clone()
        }
    }
}

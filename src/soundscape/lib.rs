//! Synthetic soundscapes: labelled sounds that train and validate the blow detector. Nothing here runs in the kiosk.
//!
//! ```text
//! voices noises kiosk_sound → scenes (rooms) ┐
//!                            recordings ─────┴→ Take → train → src/detector/table.rs
//!                                                    → score → table with 95 % bounds
//! ```
//!
//! A [`Take`] is a sound with its labels: the time and strength of each breath, and the other sounds. A [`scenes::Scenario`] draws
//! takes from a seed: voices, noises, rooms, one or two capsules, the kiosk's own sound. Scenarios with seeds from
//! [`FIRST_VALIDATION_SEED`] on are never used for training, so they can validate.
//!
//! It never reads a file, a device or a clock, and never runs in the kiosk. The same seed gives the same samples.
//!
//! ```
//! use soffio_soundscape::scenes::{Condition, Hearing, Scenario};
//! use soffio_soundscape::{FIRST_VALIDATION_SEED, Kind};
//!
//! let one = Hearing { gain_db: 0.0, stereo: false };
//! // A child's breath, straight at the microphone, from 10 cm.
//! let take = Scenario::new(FIRST_VALIDATION_SEED + 1).take(Condition::Cell(0.1, 0.0, true), 0, one);
//! assert_eq!(take.kind, Kind::Blow);
//! assert!(take.breaths.iter().all(|breath| breath.onset < breath.offset));
//! assert!(take.left.iter().all(|x| x.abs() <= 1.0));
//! assert!(take.right.is_none(), "one capsule");
//! ```

pub mod kiosk_sound;
pub mod noises;
pub mod parallel;
pub mod rooms;
pub mod scenes;
pub mod statistics;
pub mod voices;

/// First seed of the scenarios that are reserved for validation: they are never used for training.
pub const FIRST_VALIDATION_SEED: u64 = 1_000_000;

/// Sample rate of all synthetic sound, Hz.
pub const RATE: u32 = 16_000;

/// Class of a take, for its score.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A breath.
    Blow,
    /// Noise without breath.
    Noise,
    /// Knocks, claps, pops, doors: they must never trigger.
    Impulse,
    /// Neither is known.
    Ambiguous,
}

/// One breath in a take.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Breath {
    /// Beginning of the air, s.
    pub onset: f64,
    /// End of the air, s.
    pub offset: f64,
    /// Peak speed at the lips, m/s; 0 where it is unknown.
    pub strength: f64,
    /// Level over a noise that was mixed in, dB.
    pub snr_db: Option<f64>,
    /// It hardly rises above the noise anywhere, so it cannot be detected.
    pub faint: bool,
}

/// A sound in a synthetic scene, before any room.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Event {
    /// Beginning, s.
    pub at: f64,
    /// End, s.
    pub until: f64,
    /// Kind of sound, in words.
    pub what: &'static str,
    /// It reaches the microphone through the table, not through the room.
    pub on_table: bool,
    /// RMS or peak, relative to full scale.
    pub gain: f64,
}

/// A labelled sound.
#[derive(Clone, Debug)]
pub struct Take {
    /// Name of the file or scene.
    pub name: String,
    /// Group: takes of one group share a speaker, a room or a recording. Training and validation never share a group.
    pub group: String,
    /// Label, in a word.
    pub label: String,
    /// Class of the take, for its score.
    pub kind: Kind,
    /// Breaths in the take.
    pub breaths: Vec<Breath>,
    /// Position on a ladder of intensities.
    pub level: Option<f64>,
    /// The (first) capsule, full scale ±1.
    pub left: Vec<f32>,
    /// The second capsule.
    pub right: Option<Vec<f32>>,
    /// Output of the kiosk's loudspeaker over the same time; empty without any.
    pub played: Vec<f32>,
    /// Other sounds of a synthetic scene.
    pub events: Vec<Event>,
    /// Sample rate, Hz.
    pub sample_rate: u32,
}

impl Take {
    /// Duration, s.
    pub fn duration(&self) -> f64 {
        self.left.len() as f64 / f64::from(self.sample_rate)
    }

    /// The same take with another gain, dB, clipped at full scale.
    pub fn with_gain(&self, db: f64) -> Self {
        let gain = soffio_math::db_to_amplitude(db) as f32;
        let scaled = |samples: &Vec<f32>| samples.iter().map(|x| (x * gain).clamp(-1.0, 1.0)).collect();
        Self { left: scaled(&self.left), right: self.right.as_ref().map(scaled), ..self.clone() }
    }
}

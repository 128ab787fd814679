//! The ear's school: labelled sounds, training and marks of the blow detector. Nothing here runs in the kiosk.
//!
//! ```text
//! voices noises own → scenes (rooms) ┐
//!                    recordings ─────┴→ Take → train → src/wind/blow/table.rs
//!                                            → score → table with 95 % bounds
//! ```
//!
//! A [`Take`] is a sound with its labels: when somebody blows, how strongly, and what else is to be heard. [`scenes::World`]
//! draws takes from a seed: voices, noises, rooms, one microphone or two, the kiosk's own sound. Worlds from [`EXAM`] on are
//! never learnt from, so they can be used to test.
//!
//! It never reads a file, a device or a clock, and never runs in the kiosk. The same seed gives the same samples.
//!
//! ```
//! use soffio_soundscape::scenes::{Condition, Hearing, World};
//! use soffio_soundscape::{EXAM, Kind};
//!
//! let one = Hearing { gain_db: 0.0, stereo: false };
//! // A child's breath, straight at the microphone, from 10 cm.
//! let take = World::new(EXAM + 1).take(Condition::Cell(0.1, 0.0, true), 0, one);
//! assert_eq!(take.kind, Kind::Blow);
//! assert!(take.breaths.iter().all(|breath| breath.onset < breath.offset));
//! assert!(take.left.iter().all(|x| x.abs() <= 1.0));
//! assert!(take.right.is_none(), "one capsule");
//! ```

pub mod noises;
pub mod own;
pub mod parallel;
pub mod rooms;
pub mod scenes;
pub mod statistics;
pub mod voices;

/// Seeds of worlds from here on are never learnt from.
pub const EXAM: u64 = 1_000_000;

/// Sample rate of everything that is made, Hz.
pub const RATE: u32 = 16_000;

/// What a take is, to whoever marks it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Somebody blows.
    Blow,
    /// Nobody does.
    Noise,
    /// Knocks, claps, pops, doors: none may ever trigger.
    Impulse,
    /// Nobody knows.
    Ambiguous,
}

/// One breath in a take.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Breath {
    /// When the air starts, s.
    pub onset: f64,
    /// When it has stopped, s.
    pub offset: f64,
    /// Speed at the lips at its height, m/s; 0 where nobody knows.
    pub strength: f64,
    /// How far it is above a noise that was mixed in, dB.
    pub snr_db: Option<f64>,
    /// It hardly rises above the noise anywhere: nobody could hear it.
    pub faint: bool,
}

/// A sound in a made scene, before any room.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Event {
    /// From when, s.
    pub at: f64,
    /// Until when, s.
    pub until: f64,
    /// What it is.
    pub what: &'static str,
    /// It comes through the table, not through the room.
    pub on_table: bool,
    /// Full scale of its RMS or peak.
    pub gain: f64,
}

/// A labelled sound.
#[derive(Clone, Debug)]
pub struct Take {
    /// File or scene.
    pub name: String,
    /// Takes of one group share a speaker, a room or a recording: training and test never share a group.
    pub group: String,
    /// What it is, in a word.
    pub label: String,
    /// What it is, to whoever marks it.
    pub kind: Kind,
    /// The breaths in it.
    pub breaths: Vec<Breath>,
    /// Place on a ladder of intensities.
    pub level: Option<f64>,
    /// The (first) capsule, full scale ±1.
    pub left: Vec<f32>,
    /// The second capsule.
    pub right: Option<Vec<f32>>,
    /// What the kiosk played meanwhile; empty if nothing.
    pub played: Vec<f32>,
    /// What is in a made scene beside breath.
    pub events: Vec<Event>,
    /// Hz.
    pub sample_rate: u32,
}

impl Take {
    /// Length, s.
    pub fn duration(&self) -> f64 {
        self.left.len() as f64 / f64::from(self.sample_rate)
    }

    /// The same, louder or quieter, cut at full scale.
    pub fn with_gain(&self, db: f64) -> Self {
        let gain = soffio_math::from_decibels(db) as f32;
        let scaled = |samples: &Vec<f32>| samples.iter().map(|x| (x * gain).clamp(-1.0, 1.0)).collect();
        Self { left: scaled(&self.left), right: self.right.as_ref().map(scaled), ..self.clone() }
    }
}

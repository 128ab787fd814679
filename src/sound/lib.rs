//! Physically based sound synthesis: modal synthesis, noise and surfaces, driven by the motion. The crate knows no bodies of
//! the simulation; `simulation::sonify` translates.
//!
//! Time is a sample index at the synth's rate. Commands are small and fit a ring buffer; nothing allocates after
//! [`Synth::new`].
//!
//! ```text
//! timbre (preset files) ─→ instrument ─→ graph of operators ─┬─→ voices ──────────┐
//! modes (of all sources) ─↗  excitation (Hertz, radiation)   └─→ bodies ──────────┴─→ mix ─→ master ─→ out
//!                                                    modal (banks of partials) ──↗
//! ```
//!
//! The crate reads no clock, device or file: timbres are compiled in, or parsed from a text of the caller. It plays no recorded
//! samples; all sound is computed from modes, noise and excitation. The output never exceeds the limiter's ceiling.
//!
//! The main types are [`Synth`] (renders stereo frames), [`SoundCommand`] (strikes, slides, damping, wind, motion), [`InstrumentSpec`]
//! (timbre, body and material), [`Preset`] (a timbre), and [`Reverb`] (reverberation).
//!
//! ```
//! use soffio_sound::{InstrumentSpec, SoundBody, SoundCommand, SoundMaterial, Strike, Synth};
//!
//! // A steel disc of 12 cm and half a millimetre.
//! let area = 0.0113;
//! let body = SoundBody { half_extents: [0.06; 2], thickness: 5e-4, area, mass: area * 5e-4 * 7850.0 };
//! let material = SoundMaterial { youngs_modulus: 2e11, poisson: 0.3, density: 7850.0, loss_factor: 6e-4 };
//! let spec = InstrumentSpec { timbre: "plate".into(), own: None, body, material, surface: None, gain: 1.0, max_voices: 8 };
//! let mut synth = Synth::new(48_000, &[spec], 1).expect("a shipped timbre");
//! let strike = Strike { sample: 0, instrument: 0, impulse: 1e-3, speed: 0.3, mass: 0.003, position: [0.8, 0.1], pan: 0.0, distance: 0.7 };
//! synth.command(SoundCommand::Strike(strike));
//! let mut frames = vec![0.0_f32; 2 * 4800]; // a tenth of a second, left and right in turn
//! synth.render(&mut frames);
//! assert!(frames.iter().any(|x| x.abs() > 1e-4));
//! ```
//!
//! `cargo run -p soffio-sound --example chime` rings a chime tube and prints its peak and its decay.

mod bounds;
mod controls;
mod ducking;
mod excitation;
mod graph;
mod gusts;
mod instrument;
mod level;
mod limiter;
mod loudness;
mod master;
pub mod modal;
pub mod modes;
mod night_mode;
mod repetition;
mod reverb;
mod shared;
mod sounding_body;
mod synth;
pub mod timbre;
mod true_peak;
mod voice;
mod volume;

use std::sync::Arc;

pub use gusts::multifractal;
pub use instrument::partials;
pub use level::{AWeighting, Exposure, weighted_level};
pub use limiter::{CEILING, ONSET_CEILING};
pub use loudness::LoudnessMeter;
pub use modes::{Mode, PlateMode, free_plate_modes};
pub use reverb::{BANDS, MAX_T60_RATIO, Reverb, ReverbSpec, T60_RANGE};
pub use synth::{FADING_VOICES, MAX_COMMANDS, MAX_VOICES, MOST_PARTIALS, Synth};
pub use timbre::{Preset, TimbreError};
pub use true_peak::peak;
pub use volume::{PROGRAMME, Volume, VolumeSettings};

/// Command to the synth, of fixed size for a wait-free ring buffer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SoundCommand {
    /// A body is struck.
    Strike(Strike),
    /// A resting contact damps a body, or ends.
    Damp(Damp),
    /// A contact slides over a body, or ends; the synth interpolates between commands.
    Slide(Slide),
    /// The air at an instrument in one simulation step; the synth interpolates between commands.
    Wind(WindSound),
    /// The motion of an instrument's body in one simulation step; the synth interpolates between commands.
    Motion(MotionSound),
    /// Fades out everything (change or reset of an exhibit).
    Silence {
        /// When.
        sample: u64,
    },
}

impl SoundCommand {
    /// Sample at which it is executed.
    pub fn sample(&self) -> u64 {
        match self {
            Self::Strike(strike) => strike.sample,
            Self::Damp(touch) => touch.sample,
            Self::Slide(slide) => slide.sample,
            Self::Wind(wind) => wind.sample,
            Self::Motion(motion) => motion.sample,
            Self::Silence { sample } => *sample,
        }
    }

    /// The same command at another sample.
    pub fn at(mut self, time: u64) -> Self {
        match &mut self {
            Self::Strike(strike) => strike.sample = time,
            Self::Damp(touch) => touch.sample = time,
            Self::Slide(slide) => slide.sample = time,
            Self::Wind(wind) => wind.sample = time,
            Self::Motion(motion) => motion.sample = time,
            Self::Silence { sample } => *sample = time,
        }
        self
    }
}

/// One impact on one sounding body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Strike {
    /// When the contact begins.
    pub sample: u64,
    /// Index into the exhibit's instruments.
    pub instrument: u16,
    /// Impulse of the hit, N s.
    pub impulse: f32,
    /// Approach speed, m/s.
    pub speed: f32,
    /// Effective mass of the impact, kg (Hertz contact time).
    pub mass: f32,
    /// Where on the body: coordinates along its two largest half extents, −1…1 each.
    pub position: [f32; 2],
    /// −1 left … 1 right.
    pub pan: f32,
    /// From the listener, m.
    pub distance: f32,
}

/// Damping of a body by a resting contact: a hand on a chime, a clapper that stays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Damp {
    /// When it begins or changes.
    pub sample: u64,
    /// Index into the exhibit's instruments.
    pub instrument: u16,
    /// As in [`Strike`].
    pub position: [f32; 2],
    /// R of an equivalent dashpot, N s/m; 0 when the contact ends.
    pub resistance: f32,
}

/// One sliding contact on a sounding body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Slide {
    /// When.
    pub sample: u64,
    /// Index into the exhibit's instruments.
    pub instrument: u16,
    /// Speed of the surfaces over each other, m/s.
    pub speed: f32,
    /// Normal force, N; 0 when the contact ends.
    pub force: f32,
    /// As in [`Strike`].
    pub position: [f32; 2],
    /// −1 left … 1 right.
    pub pan: f32,
    /// From the listener, m.
    pub distance: f32,
}

/// The air at an instrument that sounds in wind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WindSound {
    /// When.
    pub sample: u64,
    /// Index into the exhibit's instruments.
    pub instrument: u16,
    /// Speed of the air over the surfaces, m/s, gusts included.
    pub speed: f32,
    /// Relative gust, about ±1, from the turbulence that acts on the surfaces.
    pub gust: f32,
    /// Direction of the flow seen from above: 0 away from the visitor, positive to the right, rad.
    pub direction: f32,
    /// −1 left … 1 right.
    pub pan: f32,
    /// From the listener, m.
    pub distance: f32,
}

impl Default for WindSound {
    /// Calm air, 1 m away.
    fn default() -> Self {
        Self { sample: 0, instrument: 0, speed: 0.0, gust: 0.0, direction: 0.0, pan: 0.0, distance: 1.0 }
    }
}

/// The motion of an instrument's body, for timbres whose numbers follow it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotionSound {
    /// When.
    pub sample: u64,
    /// Index into the exhibit's instruments.
    pub instrument: u16,
    /// The motion.
    pub motion: BodyMotion,
    /// −1 left … 1 right.
    pub pan: f32,
    /// From the listener, m.
    pub distance: f32,
}

/// What a timbre can follow of a body that moves.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BodyMotion {
    /// Speed of its centre of mass, m/s.
    pub speed: f32,
    /// Its angular speed, rad/s.
    pub spin: f32,
    /// Force of the joint that the sound names, N.
    pub joint_force: f32,
    /// Pull of the spring or cord that the sound names, N.
    pub tension: f32,
    /// Way of the centre of mass since the start of the exhibit, m.
    pub way: f32,
    /// Height of the centre of mass above its start, m.
    pub height: f32,
    /// The sound's own `parameter`, in its own unit.
    pub parameter: f32,
}

/// Material of a sounding body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SoundMaterial {
    /// Young's modulus, Pa.
    pub youngs_modulus: f64,
    /// Poisson's ratio.
    pub poisson: f64,
    /// Density, kg/m³.
    pub density: f64,
    /// Loss factor η of the installed body: T60 = 2.2/(η f).
    pub loss_factor: f64,
}

/// Dimensions of a sounding body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SoundBody {
    /// The two largest half extents of the body, m, the larger first.
    pub half_extents: [f64; 2],
    /// Sheet thickness, m.
    pub thickness: f64,
    /// Area of one face, m².
    pub area: f64,
    /// Mass, kg.
    pub mass: f64,
}

/// Closed line profile of a surface along which a contact slides.
#[derive(Clone, Debug, PartialEq)]
pub struct SurfaceLine {
    /// Brightness or height; only differences matter.
    pub values: Vec<f32>,
    /// Distance of two values, m.
    pub spacing: f64,
}

/// The picture on a body, over both of its largest half extents, read where a contact is.
#[derive(Clone, Debug, PartialEq)]
pub struct SurfaceRelief {
    /// Brightness or height, row by row; the first row and the first value of each lie at −1. Only differences matter.
    pub values: Vec<f32>,
    /// Values of a row.
    pub width: usize,
}

/// The surface of a body for contacts that slide over it.
#[derive(Clone, Debug, PartialEq)]
pub enum SoundSurface {
    /// The same line over and over, at the speed of the slide, wherever the contact is.
    Line(SurfaceLine),
    /// The picture at the place of the contact.
    Relief(Arc<SurfaceRelief>),
}

/// A sounding body of an exhibit, ready to be compiled by the synth.
#[derive(Clone, Debug, PartialEq)]
pub struct InstrumentSpec {
    /// Name of the timbre preset (`audio/timbres/<timbre>.toml`).
    pub timbre: String,
    /// The preset itself where it is the exhibit's own; `None` for a shipped one.
    pub own: Option<Arc<Preset>>,
    /// Its dimensions.
    pub body: SoundBody,
    /// Its material.
    pub material: SoundMaterial,
    /// Its surface, for timbres that are scraped.
    pub surface: Option<SoundSurface>,
    /// Linear gain.
    pub gain: f64,
    /// Most simultaneous voices of impacts on this body; its modes have no bound.
    pub max_voices: usize,
}

impl InstrumentSpec {
    /// Its timbre: the exhibit's own, or the shipped one of this name.
    ///
    /// # Errors
    /// There is no shipped timbre of this name.
    pub fn preset(&self) -> Result<Arc<Preset>, TimbreError> {
        self.own.clone().map_or_else(|| Preset::shipped(&self.timbre).map(Arc::new), Ok)
    }

    /// Whether the timbre fits the body: it is compiled as the synth will.
    ///
    /// # Errors
    /// What does not fit.
    pub fn check(&self) -> Result<(), TimbreError> {
        instrument::Instrument::compile(self, &mut shared::Shared::default()).map(drop)
    }
}

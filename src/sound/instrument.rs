//! A compiled instrument: the graph of its timbre, and its partials with all that does not depend on an impact.

use fearless_simd::Level;

use super::excitation::{Contact, Radiator};
use super::graph::Graph;
use super::modal::{Bank, Partial};
use super::modes::{Mode, Place, modes};
use super::shared::Shared;
use super::timbre::{Inputs, Number, Player, Preset, TimbreError};
use super::{InstrumentSpec, Strike, timbre};
use soffio_math::noise::Random;
use soffio_math::{exp, ln};

/// Least mass of a body, kg: a milligram. It keeps contact times and levels finite.
const MIN_MASS: f64 = 1e-6;

/// A compiled instrument.
pub(super) struct Instrument {
    /// Its nodes.
    pub graph: Graph,
    /// What plays it.
    pub player: Player,
    /// Linear gain.
    pub gain: f64,
    /// Most voices of impacts at once.
    pub max_voices: usize,
    /// It has partials that only hits drive.
    rings: bool,
    radiator: Radiator,
    modal: Option<Modal>,
}

/// How the point of a driving force moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum DriveMove {
    /// At once.
    Jump,
    /// Over the next block.
    Glide,
}

/// The modal part of an instrument.
struct Modal {
    contact: Contact,
    /// Cents.
    detune: f64,
    gain: Number,
    /// Where the driving force acts, −1…1; without it, where the inputs say.
    drive_at: Option<f64>,
    /// In the order of their decay, so that those of one group end together.
    modes: Vec<Mode>,
    /// Exponent of the outline on which plates' shapes are defined.
    outline: f64,
    /// kg.
    mass: f64,
}

impl Instrument {
    /// `shared` is that of the synth.
    ///
    /// # Errors
    /// There is no such preset, or it does not fit the body.
    pub fn compile(spec: &InstrumentSpec, shared: &mut Shared) -> Result<Self, TimbreError> {
        Self::from_preset(&*spec.preset()?, spec, shared)
    }

    /// # Errors
    /// The preset does not fit the body.
    pub fn from_preset(preset: &Preset, spec: &InstrumentSpec, shared: &mut Shared) -> Result<Self, TimbreError> {
        let radiator = Radiator::new(&spec.body, &spec.material);
        Ok(Self {
            graph: Graph::compile(preset, spec, shared)?,
            player: preset.player(),
            gain: spec.gain,
            max_voices: spec.max_voices.max(1),
            rings: preset.rings(),
            radiator,
            modal: preset
                .modal()
                .map(|(key, node)| Modal::compile(&preset.name, key, node, spec, shared))
                .transpose()?,
        })
    }

    /// Whether impacts play it.
    pub fn is_hit(&self) -> bool {
        self.player == Player::Hit
    }

    /// Whether it is noise of the wind: wind plays it, and nothing of it rings.
    pub fn is_hiss(&self) -> bool {
        self.player == Player::Wind && self.modal.is_none()
    }

    /// Whether anything of it sounds when the body is struck, whatever else plays it.
    pub fn is_struck(&self) -> bool {
        self.is_hit() || self.rings
    }

    /// Hertz contact time, s; 1 ms where nothing rings.
    pub fn contact_time(&self, mass: f64, speed: f64) -> f64 {
        self.modal.as_ref().map_or(1e-3, |modal| modal.contact.time(mass, speed))
    }

    /// Inputs of the graph for an impact.
    pub fn inputs(&self, strike: &Strike) -> Inputs {
        let (mass, speed) = (f64::from(strike.mass), f64::from(strike.speed));
        let rigid_pressure = self.radiator.rigid_pressure(f64::from(strike.impulse));
        Inputs {
            impulse: f64::from(strike.impulse),
            speed,
            mass,
            contact_time: self.contact_time(mass, speed),
            rigid_pressure: if rigid_pressure.is_finite() { rigid_pressure } else { 0.0 },
            position: strike.position.map(|p| f64::from(p).clamp(-1.0, 1.0)),
            distance: f64::from(strike.distance),
            ..Inputs::default()
        }
    }

    /// The bank of a body that plays this instrument; `None` when nothing of it rings. Bodies of different seeds are
    /// out of tune with each other by the timbre's `detune`.
    pub fn bank(&self, seed: u64, sample_rate: f64) -> Option<Bank> {
        let modal = self.modal.as_ref()?;
        let mut random = Random::new(seed);
        let detuned = |mode: &Mode| Partial {
            // Cents: 2^(d/1200).
            frequency: mode.frequency * exp(modal.detune * random.signed() * ln(2.0) / 1200.0),
            decay: mode.decay,
        };
        let partials: Vec<Partial> = modal.modes.iter().map(detuned).collect();
        Some(Bank::new(&partials, sample_rate, Level::new()))
    }

    /// A hit on a bank of [`Self::bank`]; the rest as [`Bank::strike`]. Real-time: bounded by the number of partials.
    pub fn strike(&self, bank: &mut Bank, inputs: &Inputs, since: usize, look_ahead: &mut [f32]) -> Option<usize> {
        let modal = self.modal.as_ref()?;
        let place = Place::new(inputs.position, modal.outline);
        let level = inputs.impulse * modal.gain.at(inputs);
        let amplitude = |i: usize| level * modal.modes[i].amplitude * modal.modes[i].shape.at(&place);
        bank.strike(amplitude, inputs.contact_time, since, look_ahead)
    }

    /// Damps the bank by a contact of `resistance` R, N s/m: a dashpot adds the decay c = R φ²/2 to each partial.
    pub fn damp(&self, bank: &mut Bank, position: [f64; 2], resistance: f64) {
        let Some(modal) = &self.modal else { return };
        let place = Place::new(position, modal.outline);
        bank.damp(|i| {
            let shape = modal.modes[i].shape.per_root_mass(&place, modal.mass);
            0.5 * resistance * shape * shape
        });
    }

    /// Moves the point where a force in N acts on the body.
    pub fn set_drive_point(&self, bank: &mut Bank, inputs: &Inputs, step: DriveMove, sample_rate: f64) {
        let Some(modal) = &self.modal else { return };
        let position = modal.drive_at.map_or(inputs.position, |at| [at, 0.0]);
        let place = Place::new(position, modal.outline);
        // A force of 1 N gives an impulse of 1/fs per sample.
        let level = modal.gain.at(inputs) / sample_rate;
        let gain = |i: usize| level * modal.modes[i].amplitude * modal.modes[i].shape.at(&place);
        match step {
            DriveMove::Jump => bank.set_drive_point(gain),
            DriveMove::Glide => bank.glide_drive_point(gain),
        }
    }
}

/// The partials of a timbre on a body, in ascending order; none where nothing rings.
///
/// # Errors
/// The preset does not fit the body.
pub fn partials(preset: &Preset, spec: &InstrumentSpec) -> Result<Vec<Mode>, TimbreError> {
    let modes_and_outline = preset
        .modal()
        .map(|(key, node)| Modal::modes(&preset.name, key, node, spec, &mut Shared::default()))
        .transpose()?;
    Ok(modes_and_outline.map(|(modes, _)| modes).unwrap_or_default())
}

impl Modal {
    fn compile(
        name: &str,
        key: &str,
        node: &timbre::Modal,
        spec: &InstrumentSpec,
        shared: &mut Shared,
    ) -> Result<Self, TimbreError> {
        let (mut modes, outline) = Self::modes(name, key, node, spec, shared)?;
        modes.sort_by(|a, b| a.decay.total_cmp(&b.decay));
        let contact = Contact::new(node.contact_radius, node.surface_modulus, &spec.material);
        let mass = spec.body.mass.max(MIN_MASS);
        Ok(Self { contact, detune: node.detune, gain: node.gain, drive_at: node.drive_at, modes, outline, mass })
    }

    fn modes(
        name: &str,
        key: &str,
        node: &timbre::Modal,
        spec: &InstrumentSpec,
        shared: &mut Shared,
    ) -> Result<(Vec<Mode>, f64), TimbreError> {
        modes(node, spec, shared)
            .map_err(|(field, problem)| TimbreError::new(name, format!("node.{key}.{field}"), problem))
    }
}

//! A sounding body, compiled: its timbre as a graph, its partials with everything about them that no hit can change.

use super::bank::Bank;
use super::excitation::{Contact, Radiator, half_sine_spectrum};
use super::graph::Graph;
use super::modes::{Mode, Place, modes};
use super::timbre::{Inputs, Number, Player, Preset, TimbreError};
use super::{InstrumentSpec, Strike, timbre};
use crate::math::{exp, ln};
use crate::noise::Random;

/// A compiled instrument.
pub(super) struct Instrument {
    pub graph: Graph,
    /// What plays it.
    pub player: Player,
    pub gain: f64,
    pub max_voices: usize,
    radiator: Radiator,
    modal: Option<Modal>,
}

/// The ringing part of an instrument.
struct Modal {
    contact: Contact,
    /// Cents.
    detune: f64,
    gain: Number,
    modes: Vec<Mode>,
    /// Exponent of the outline on which plates' shapes are defined.
    outline: f64,
}

impl Instrument {
    pub fn compile(spec: &InstrumentSpec) -> Result<Self, TimbreError> {
        Self::from_preset(&Preset::shipped(&spec.timbre)?, spec)
    }

    pub fn from_preset(preset: &Preset, spec: &InstrumentSpec) -> Result<Self, TimbreError> {
        let radiator = Radiator::new(&spec.body, &spec.material);
        Ok(Self {
            graph: Graph::compile(preset, spec)?,
            player: preset.player(),
            gain: spec.gain,
            max_voices: spec.max_voices.max(1),
            radiator,
            modal: preset.modal().map(|(key, node)| Modal::compile(&preset.name, key, node, spec)).transpose()?,
        })
    }

    /// Whether hits play it, one by one.
    pub fn is_hit(&self) -> bool {
        self.player == Player::Hit
    }

    /// Hertz contact time, s; 1 ms where nothing rings.
    pub fn contact_time(&self, mass: f64, speed: f64) -> f64 {
        self.modal.as_ref().map_or(1e-3, |modal| modal.contact.time(mass, speed))
    }

    /// What a hit tells the graph.
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
            ..Inputs::default()
        }
    }

    /// Sets the bank ringing. Real-time: bounded by the number of partials.
    pub fn excite(&self, bank: &mut Bank, inputs: &Inputs, seed: u64, sample_rate: f64) {
        bank.clear();
        let Some(modal) = &self.modal else { return };
        let mut random = Random::new(seed);
        let place = Place::new(inputs.position, modal.outline);
        let driven = self.graph.drives();
        let level = if driven { 1.0 } else { inputs.impulse } * modal.gain.at(inputs);
        for mode in &modal.modes {
            let amplitude = level * mode.amplitude * mode.shape.at(&place);
            // Cents: 2^(d/1200).
            let detuned = mode.frequency * exp(modal.detune * random.signed() * ln(2.0) / 1200.0);
            if driven {
                bank.add_driven(detuned, mode.decay, amplitude, sample_rate);
            } else {
                let spectrum = half_sine_spectrum(mode.frequency * inputs.contact_time);
                bank.add(detuned, mode.decay, amplitude * spectrum, sample_rate);
            }
        }
    }
}

/// The partials of a timbre on a body; none where nothing rings.
pub fn partials(preset: &Preset, spec: &InstrumentSpec) -> Result<Vec<Mode>, TimbreError> {
    let modal = preset.modal().map(|(key, node)| Modal::compile(&preset.name, key, node, spec)).transpose()?;
    Ok(modal.map(|modal| modal.modes).unwrap_or_default())
}

impl Modal {
    fn compile(name: &str, key: &str, node: &timbre::Modal, spec: &InstrumentSpec) -> Result<Self, TimbreError> {
        let (modes, outline) = modes(node, spec)
            .map_err(|(field, problem)| TimbreError::new(name, format!("node.{key}.{field}"), problem))?;
        let contact = Contact::new(node.contact_radius, node.surface_modulus, &spec.material);
        Ok(Self { contact, detune: node.detune, gain: node.gain, modes, outline })
    }
}

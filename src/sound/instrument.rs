//! A sounding body, compiled: its timbre as a graph, its partials with everything about them that no hit can change.

use super::bank::Bank;
use super::excitation::{Contact, Radiator, half_sine_spectrum};
use super::graph::Graph;
use super::plate::{PlateMode, free_plate_modes, legendre, onto_plate, outline_exponent};
use super::timbre::{Inputs, ModalSource, Node, Number, Preset, TimbreError};
use super::{InstrumentSpec, Strike};
use crate::math::{PI, exp, ln};
use crate::noise::Random;

/// T60 · c: a fall by 60 dB is e^(−6.908).
const T60_DECAYS: f64 = 6.907_755_278_982_137;

/// A compiled instrument.
pub(super) struct Instrument {
    pub graph: Graph,
    /// The wind plays it all the time.
    pub continuous: bool,
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
    partials: Vec<Partial>,
    /// Shapes of the partials, when the place of the hit is heard; as many as partials.
    shapes: Vec<PlateMode>,
    /// Exponent of the outline on which the shapes are defined.
    outline: f64,
}

struct Partial {
    /// Hz.
    frequency: f64,
    /// 1/s.
    decay: f64,
    /// Full scale at 1 m, per N s (and per 1/√kg of shape where there are shapes).
    amplitude: f64,
}

impl Instrument {
    pub fn compile(spec: &InstrumentSpec) -> Result<Self, TimbreError> {
        Self::from_preset(&Preset::shipped(&spec.timbre)?, spec)
    }

    pub fn from_preset(preset: &Preset, spec: &InstrumentSpec) -> Result<Self, TimbreError> {
        let radiator = Radiator::new(&spec.body, &spec.material);
        let modal = preset.node.iter().find_map(|(key, node)| Modal::compile(&preset.name, key, node, spec, &radiator));
        Ok(Self {
            graph: Graph::compile(preset)?,
            continuous: preset.continuous(),
            gain: spec.gain,
            max_voices: spec.max_voices.max(1),
            radiator,
            modal: modal.transpose()?,
        })
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
        let [x, y] = onto_plate(modal.outline, inputs.position).map(legendre);
        let level = inputs.impulse * modal.gain.at(inputs);
        for (i, partial) in modal.partials.iter().enumerate() {
            let shape = modal.shapes.get(i).map_or(1.0, |mode| mode.shape(&x, &y));
            let spectrum = half_sine_spectrum(partial.frequency * inputs.contact_time);
            // Cents: 2^(d/1200).
            let detuned = partial.frequency * exp(modal.detune * random.signed() * ln(2.0) / 1200.0);
            bank.add(detuned, partial.decay, level * partial.amplitude * shape * spectrum, sample_rate);
        }
    }
}

impl Modal {
    fn compile(
        name: &str,
        key: &str,
        node: &Node,
        spec: &InstrumentSpec,
        radiator: &Radiator,
    ) -> Option<Result<Self, TimbreError>> {
        let Node::Modal {
            from,
            partials: most,
            support_loss,
            contact_radius,
            surface_modulus,
            detune,
            fundamental,
            table,
            gain,
        } = node
        else {
            return None;
        };
        let (partials, shapes) = match from {
            ModalSource::Plate => {
                let mut modes = free_plate_modes(&spec.body, &spec.material);
                if modes.is_empty() {
                    let problem = format!(
                        "no plate of half extents {:?} m, thickness {} m, area {} m², mass {} kg can ring; all must be above 0",
                        spec.body.half_extents, spec.body.thickness, spec.body.area, spec.body.mass
                    );
                    return Some(Err(TimbreError::new(name, format!("node.{key}"), problem)));
                }
                modes.truncate(*most);
                let partial = |mode: &PlateMode| Partial {
                    frequency: mode.frequency,
                    // T60 = 2.2/(η f) is c = π η f.
                    decay: PI * spec.material.loss_factor * mode.frequency
                        + support_loss
                        + radiator.loss(mode.frequency),
                    amplitude: radiator.amplitude(mode.frequency),
                };
                (modes.iter().map(partial).collect(), modes)
            }
            ModalSource::Table => {
                let fundamental = fundamental.unwrap_or_default();
                let partials = table.iter().take(*most).map(|p| Partial {
                    frequency: fundamental * p.ratio,
                    decay: T60_DECAYS / p.t60 + support_loss,
                    amplitude: p.gain,
                });
                (partials.collect(), Vec::new())
            }
        };
        let contact = Contact::new(*contact_radius, *surface_modulus, &spec.material);
        let outline = outline_exponent(&spec.body);
        Some(Ok(Self { contact, detune: *detune, gain: *gain, partials, shapes, outline }))
    }
}

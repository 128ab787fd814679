//! A sounding body, compiled: its timbre as a graph, its partials with everything about them that no hit can change.

use fearless_simd::Level;

use super::excitation::{Contact, Radiator};
use super::graph::Graph;
use super::modal::{Bank, Partial, Place, Shape};
use super::plate::{free_plate_modes, outline_exponent};
use super::timbre::{Inputs, ModalSource, Node, Number, Preset, TimbreError};
use super::{InstrumentSpec, Strike};
use crate::math::{PI, exp, ln};
use crate::noise::Random;

/// T60 · c: a fall by 60 dB is e^(−6.908).
const T60_DECAYS: f64 = 6.907_755_278_982_137;
/// Nothing that is struck is lighter, kg.
const LIGHTEST: f64 = 1e-6;

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
    /// In the order of their decay, so that those of one group end together.
    modes: Vec<Mode>,
    /// Exponent of the outline on which the shapes are defined.
    outline: f64,
}

/// A partial, where it is moved, and how loud it is then.
struct Mode {
    partial: Partial,
    shape: Shape,
    /// Full scale at 1 m, per N s and per 1/√kg of shape.
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

    /// The bank of a body that plays this instrument; `None` when nothing of it rings. Bodies of different seeds are
    /// out of tune with each other by the timbre's `detune`.
    pub fn bank(&self, seed: u64, sample_rate: f64) -> Option<Bank> {
        let modal = self.modal.as_ref()?;
        let mut random = Random::new(seed);
        let detuned = |mode: &Mode| Partial {
            // Cents: 2^(d/1200).
            frequency: mode.partial.frequency * exp(modal.detune * random.signed() * ln(2.0) / 1200.0),
            ..mode.partial
        };
        let partials: Vec<Partial> = modal.modes.iter().map(detuned).collect();
        Some(Bank::new(&partials, sample_rate, Level::new()))
    }

    /// A hit on a bank of [`Self::bank`]; the rest as [`Bank::strike`]. Real-time: bounded by the number of partials.
    pub fn strike(&self, bank: &mut Bank, inputs: &Inputs, since: usize, ahead: &mut [f32]) -> Option<usize> {
        let modal = self.modal.as_ref()?;
        let place = Place::new(inputs.position, modal.outline);
        let level = inputs.impulse * modal.gain.at(inputs);
        let amplitude = |i: usize| level * modal.modes[i].amplitude * modal.modes[i].shape.at(&place);
        bank.strike(amplitude, inputs.contact_time, since, ahead)
    }

    /// Something of `resistance` N s/m rests on the body: a dashpot takes c = R φ²/2 from each partial.
    pub fn touch(&self, bank: &mut Bank, position: [f64; 2], resistance: f64) {
        let Some(modal) = &self.modal else { return };
        let place = Place::new(position, modal.outline);
        bank.touch(|i| {
            let shape = modal.modes[i].shape.at(&place);
            0.5 * resistance * shape * shape
        });
    }

    /// Where a force in N acts on the body from now on.
    pub fn push_at(&self, bank: &mut Bank, inputs: &Inputs, sample_rate: f64) {
        let Some(modal) = &self.modal else { return };
        let place = Place::new(inputs.position, modal.outline);
        // A force of 1 N gives an impulse of 1/fs per sample.
        let level = modal.gain.at(inputs) / sample_rate;
        bank.push_at(|i| level * modal.modes[i].amplitude * modal.modes[i].shape.at(&place));
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
            r#in: _,
        } = node
        else {
            return None;
        };
        let mut modes: Vec<Mode> = match from {
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
                let ringing = modes.into_iter().map(|mode| Mode {
                    partial: Partial {
                        frequency: mode.frequency,
                        // T60 = 2.2/(η f) is c = π η f.
                        decay: PI * spec.material.loss_factor * mode.frequency
                            + support_loss
                            + radiator.loss(mode.frequency),
                    },
                    amplitude: radiator.amplitude(mode.frequency),
                    shape: Shape::Plate(mode),
                });
                ringing.collect()
            }
            ModalSource::Table => {
                let fundamental = fundamental.unwrap_or_default();
                let mass = spec.body.mass.max(LIGHTEST);
                let ringing = table.iter().take(*most).map(|p| Mode {
                    partial: Partial { frequency: fundamental * p.ratio, decay: T60_DECAYS / p.t60 + support_loss },
                    // The gains of a table are those of the place where it is struck.
                    amplitude: p.gain * mass.sqrt(),
                    shape: Shape::Even(mass),
                });
                ringing.collect()
            }
        };
        modes.sort_by(|a, b| a.partial.decay.total_cmp(&b.partial.decay));
        let contact = Contact::new(*contact_radius, *surface_modulus, &spec.material);
        let outline = outline_exponent(&spec.body);
        Some(Ok(Self { contact, detune: *detune, gain: *gain, modes, outline }))
    }
}

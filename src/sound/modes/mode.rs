//! One mode, and the body that it is of.

use super::super::timbre::MaterialOverride;
use super::super::{InstrumentSpec, SoundBody, SoundMaterial};
use super::shape::Shape;
use soffio_math::PI;

/// One partial of a body.
#[derive(Clone, Debug)]
pub struct Mode {
    /// Frequency, Hz.
    pub frequency: f64,
    /// c, 1/s.
    pub decay: f64,
    /// Full scale at 1 m, per N s and per unit of shape.
    pub amplitude: f64,
    /// Where it moves.
    pub shape: Shape,
}

/// What is wrong with a body or a source: the key below the node, and the words.
pub(crate) type ModeError = (&'static str, String);

/// The body with what the preset says instead of the exhibit.
#[derive(Clone, Copy, Debug)]
pub(super) struct Matter {
    /// Constants of the material.
    pub material: SoundMaterial,
    /// G, Pa.
    pub shear_modulus: f64,
    /// Dimensions and mass of the body.
    pub body: SoundBody,
    /// m³.
    pub volume: f64,
}

impl Matter {
    /// The instrument's own body and material, with the constants that the preset gives instead.
    pub fn new(spec: &InstrumentSpec, given: &MaterialOverride) -> Self {
        let own = spec.material;
        let material = SoundMaterial {
            youngs_modulus: given.youngs_modulus.unwrap_or(own.youngs_modulus),
            poisson: given.poisson.unwrap_or(own.poisson),
            density: given.density.unwrap_or(own.density),
            loss_factor: given.loss_factor.unwrap_or(own.loss_factor),
        };
        let volume = spec.body.mass / own.density;
        let shear = material.youngs_modulus / (2.0 * (1.0 + material.poisson));
        let mut body = spec.body;
        if given.density.is_some() {
            body.mass = volume * material.density;
        }
        Self { material, shear_modulus: given.shear_modulus.unwrap_or(shear), body, volume }
    }

    /// c of the material, 1/s.
    pub fn loss(&self, frequency: f64) -> f64 {
        PI * self.material.loss_factor * frequency
    }
}

//! How strongly each partial moves where.

use super::beam::BeamMode;
use super::plate::{Legendre, PlateMode, legendre, onto_plate};
use soffio_math::{PI, cos, sin, sincos};

/// A place on a body, made ready for all shapes of it.
pub struct Place {
    /// Values of the Legendre polynomials at the two coordinates.
    legendre: [Legendre; 2],
    /// Coordinates along the two largest half extents, −1…1.
    position: [f64; 2],
    /// cos and sin of the direction from which a round body is hit.
    direction: [f64; 2],
}

impl Place {
    /// A place from its coordinates along the two largest half extents, −1…1 each, on an outline of the exponent
    /// `outline`. Across a round body the second is the sine of the direction.
    pub fn new(position: [f64; 2], outline: f64) -> Self {
        let [x, y] = position.map(|p| p.clamp(-1.0, 1.0));
        Self {
            legendre: onto_plate(outline, [x, y]).map(legendre),
            position: [x, y],
            direction: [(1.0 - y * y).sqrt(), y],
        }
    }
}

/// Shape φ of one partial.
#[derive(Clone, Debug)]
pub enum Shape {
    /// Everywhere 1: a partial whose shape is not known.
    Even,
    /// A plate's, 1/√kg.
    Plate(PlateMode),
    /// A free beam's or tube's, 1/√kg, and the angle of the plane in which it moves; `None`: that of the hit.
    Beam(BeamMode, Option<f64>),
    /// Half waves between two ends, √2 sin(nπx): a string's.
    String(usize),
    /// A circular membrane's: J_m(j r) times a norm, r the distance from the centre over the radius.
    Membrane {
        /// m.
        order: i32,
        /// j.
        zero: f64,
        /// The norm.
        over: f64,
    },
    /// √2 cos of a wave over the body: as many half waves along and across, and a phase. For shapes drawn by chance.
    Wave([f64; 2], f64),
}

impl Shape {
    /// φ at a place of a body of this mass (kg), mass-normalised whatever the shape, 1/√kg: what a touch there damps by.
    pub(crate) fn per_root_mass(&self, place: &Place, mass: f64) -> f64 {
        match self {
            Self::Plate(_) | Self::Beam(..) => self.at(place),
            Self::Even | Self::String(_) | Self::Membrane { .. } | Self::Wave(..) => self.at(place) / mass.sqrt(),
        }
    }

    /// φ at a place.
    pub(crate) fn at(&self, place: &Place) -> f64 {
        let [x, y] = place.position;
        match self {
            Self::Even => 1.0,
            Self::Plate(mode) => mode.shape(&place.legendre[0], &place.legendre[1]),
            Self::Beam(mode, plane) => {
                let turned = plane.map_or(1.0, |angle| {
                    let (s, c) = sincos(angle);
                    c * place.direction[0] + s * place.direction[1]
                });
                turned * mode.shape(0.5 * x)
            }
            Self::String(n) => std::f64::consts::SQRT_2 * sin(PI * *n as f64 * 0.5 * (x + 1.0)),
            Self::Membrane { order, zero, over } => over * libm::jn(*order, zero * (x * x + y * y).sqrt().min(1.0)),
            Self::Wave([kx, ky], phase) => std::f64::consts::SQRT_2 * cos(0.5 * PI * (kx * x + ky * y) + phase),
        }
    }
}

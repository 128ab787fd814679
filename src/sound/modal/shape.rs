//! How strongly each partial moves where: mode shapes φ, mass-normalised (∫ φ² dm = 1, so 1/√kg).
//!
//! An impulse J at x gives mode n the velocity J φ_n(x); a dashpot of resistance R there damps it by c = R φ_n(x)²/2. So
//! the same shapes say what a hit sets ringing, what a hand stills, and what the string that it hangs by takes away.
//!
//! **Free beam or tube** of length L (Euler-Bernoulli; Rayleigh, "Theory of Sound", §171), of mean square 1 and 2 at
//! its ends:
//!
//! ```text
//! φ(x) = cosh βx + cos βx − σ (sinh βx + sin βx)      σ = (cosh βL − cos βL) / (sinh βL − sin βL)      cos βL cosh βL = 1
//!      = cos βx − σ sin βx + (1 + σ)/2 e^(−βx) + q e^(−β(L−x))
//! q = (cos βL − sin βL − e^(−βL)) / (1 − e^(−2βL) − 2 e^(−βL) sin βL)
//! ```
//!
//! The second form has no difference of large numbers. Divide by √m for a beam of mass m.
//!
//! **Polarisation**: a tube is never quite round, so each bending mode is two, in planes at right angles and a little
//! apart in pitch. A hit from the direction θ gives them the cosine and the sine of its angle to the planes.

use super::super::plate::{Legendre, PlateMode, legendre, onto_plate};
use crate::math::{PI, cos, exp, sincos};

/// A place on a body, made ready for all shapes of it.
pub struct Place {
    /// Values of the Legendre polynomials at the two coordinates.
    pub(in crate::sound) legendre: [Legendre; 2],
    /// Along a beam, 0…1.
    along: f64,
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
            along: 0.5 * (x + 1.0),
            direction: [(1.0 - y * y).sqrt(), y],
        }
    }
}

/// Shape of one partial.
#[derive(Clone, Debug)]
pub enum Shape {
    /// Everywhere the same: a partial whose shape is not known, of a body of this mass, kg.
    Even(f64),
    /// A plate's.
    Plate(PlateMode),
    /// A free beam's or tube's.
    Beam(Beam),
}

impl Shape {
    /// φ, 1/√kg.
    pub fn at(&self, place: &Place) -> f64 {
        match self {
            Self::Even(mass) => 1.0 / mass.sqrt(),
            Self::Plate(mode) => mode.shape(&place.legendre[0], &place.legendre[1]),
            Self::Beam(beam) => beam.at(place.along, place.direction),
        }
    }
}

/// One bending mode of a free beam or tube.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Beam {
    /// βL.
    root: f64,
    sigma: f64,
    q: f64,
    /// 1/√m.
    scale: f64,
    /// cos and sin of the plane's direction; `None`: it moves in the plane in which it is hit.
    plane: Option<[f64; 2]>,
}

impl Beam {
    /// Bending mode n = 1, 2, … of a beam of mass `mass` kg; `plane` is the angle of the plane in which it moves, rad.
    pub fn new(n: usize, mass: f64, plane: Option<f64>) -> Self {
        let root = free_free_root(n);
        let (s, c) = sincos(root);
        let far = exp(-root);
        // σ with both parts times 2 e^(−βL).
        let below = 1.0 - far * far - 2.0 * far * s;
        Self {
            root,
            sigma: (1.0 + far * far - 2.0 * far * c) / below,
            q: (c - s - far) / below,
            scale: 1.0 / mass.sqrt(),
            plane: plane.map(|angle| {
                let (s, c) = sincos(angle);
                [c, s]
            }),
        }
    }

    /// φ at `x` = 0…1 along it, hit from the direction of this cosine and sine, 1/√kg.
    pub fn at(&self, x: f64, direction: [f64; 2]) -> f64 {
        let (s, c) = sincos(self.root * x);
        let near = 0.5 * (1.0 + self.sigma) * exp(-self.root * x);
        let far = self.q * exp(-self.root * (1.0 - x));
        let turned = self.plane.map_or(1.0, |plane| plane[0] * direction[0] + plane[1] * direction[1]);
        self.scale * turned * (c - self.sigma * s + near + far)
    }
}

/// The root βL of cos βL cosh βL = 1, n = 1, 2, …: 4.730, 7.853, 10.996, … by Newton's method on cos x − 1/cosh x.
pub fn free_free_root(n: usize) -> f64 {
    let mut x = (n as f64 + 0.5) * PI;
    for _ in 0..6 {
        let e = exp(-x);
        let sech = 2.0 * e / (1.0 + e * e);
        let tanh = (1.0 - e * e) / (1.0 + e * e);
        let (s, _) = sincos(x);
        x -= (cos(x) - sech) / (sech * tanh - s);
    }
    x
}

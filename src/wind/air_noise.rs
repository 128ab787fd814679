//! How loud the air is that flows over a surface.
//!
//! Unsteady forces of a flow on a surface radiate as dipoles, whose sound power grows with the sixth power of the speed (Curle,
//! Proc. R. Soc. A 231, 1955). With the areas A and the relative winds v of the patches,
//!
//! ```text
//! P = Σ A |v|⁶        x = Σ A |v|⁶ x_i / P        U = (P / Σ A)^(1/6)
//! ```
//!
//! are its strength, its place, and the even wind over all surfaces that would be as loud. Fans, draughts, turbulence, breath and
//! the surface's own motion all count, since v is the wind that the drag has.

use soffio_math::{DVec3, pow};

/// Sums over the patches of surfaces.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct AirNoise {
    /// P, m² (m/s)⁶.
    pub power: f64,
    /// Σ A |v|⁶ x, world.
    pub moment: DVec3,
    /// Σ A |v|⁶ v, world: the direction of the flow.
    pub flow: DVec3,
}

impl AirNoise {
    /// Of both.
    pub fn plus(self, other: Self) -> Self {
        Self { power: self.power + other.power, moment: self.moment + other.moment, flow: self.flow + other.flow }
    }

    /// U over surfaces of this area in m², m/s.
    pub fn speed(&self, area: f64) -> f64 {
        if self.power > 0.0 && area > 0.0 { pow(self.power / area, 1.0 / 6.0) } else { 0.0 }
    }

    /// x, world, m; `None` in calm air.
    pub fn place(&self) -> Option<DVec3> {
        (self.power > 0.0).then(|| self.moment / self.power)
    }
}

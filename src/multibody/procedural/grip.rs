//! Hands on bodies, and how an adjustment to them ended.

use soffio_geometry::bodies::RigidBody;
use soffio_math::DVec3;

/// Grips at one time at most.
pub const MOST_GRIPS: usize = 4;
/// Joints and grips nearer than this are where they belong, m or rad.
pub const REACHED: f64 = 1e-7;

/// A hand on a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grip {
    /// Index of the body.
    pub body: usize,
    /// Point that is held, node frame, m.
    pub point: DVec3,
    /// Where it is to be at the step's end, world, m.
    pub place: DVec3,
}

impl Grip {
    /// World place of the point that is held, m.
    pub fn point_of(&self, bodies: &[RigidBody]) -> DVec3 {
        bodies[self.body].pose().point(self.point)
    }

    /// How far it is from its place, m.
    pub fn missed(&self, bodies: &[RigidBody]) -> f64 {
        self.point_of(bodies).distance(self.place)
    }
}

/// How an adjustment ended.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Reach {
    /// Passes (rounds of passes by the source's method).
    pub passes: u32,
    /// How far the worst joint is open, m or rad.
    pub residual: f64,
    /// How far the farthest grip is from its place, m.
    pub missed: f64,
}

impl Reach {
    /// Was everything met that was asked?
    pub fn reached(&self) -> bool {
        self.residual <= REACHED && self.missed <= REACHED
    }
}

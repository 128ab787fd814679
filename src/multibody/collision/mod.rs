//! Where bodies touch: convex colliders, the pairs that can meet, when they do, and at which points.

mod advance;
mod broad;
mod manifold;
mod nearby;
mod pairs;
mod proximity;
pub mod reach;
mod shape;

pub use advance::{Sweep, TOUCH, TimeOfImpact, time_of_impact};
pub use broad::BroadPhase;
pub use manifold::Corners;
pub use pairs::{Excluded, Exclusion, Pair, Pairs, Reason, pairs};
pub use proximity::proximity;
pub use reach::Reach;
pub use shape::{Collider, Shape};

use soffio_math::DVec3;

/// How two colliders lie to each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Proximity {
    /// Distance of the two surfaces, m; negative where they overlap.
    pub gap: f64,
    /// Unit, from the second to the first.
    pub normal: DVec3,
    /// Between the two surfaces, world, m.
    pub point: DVec3,
}

/// Most points of a [`Manifold`]: enough to hold a face on a face.
pub const MANIFOLD_POINTS: usize = 4;

/// One point of a manifold.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ManifoldPoint {
    /// World, midway between the two surfaces, m.
    pub point: DVec3,
    /// Distance of the two surfaces along the manifold's normal there, m; negative where they overlap.
    pub gap: f64,
}

/// Where two colliders that lie on each other touch.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Manifold {
    /// Unit, from the second to the first.
    pub normal: DVec3,
    /// The points; those from `count` on mean nothing.
    pub points: [ManifoldPoint; MANIFOLD_POINTS],
    /// How many there are: one at least.
    pub count: usize,
}

impl Manifold {
    /// The points there are, in an order that stays while the features that touch stay.
    pub fn points(&self) -> &[ManifoldPoint] {
        &self.points[..self.count]
    }
}

//! Where bodies touch: convex colliders, the pairs that can meet, and the time at which they do.

mod advance;
mod pairs;

pub use advance::{Sweep, TOUCH, TimeOfImpact, time_of_impact};
pub use pairs::{Pair, pairs};

use crate::geometry::convex::{self, Closest};
use crate::math::{DVec3, Pose};

/// A convex collision shape: the Minkowski sum of a convex core and a ball.
///
/// Spheres have a point for a core, capsules and wires a segment, sheet metal a flat polygon with half its
/// thickness as the radius: one distance routine serves them all, and thin plates keep a well-defined normal.
#[derive(Clone, Debug)]
pub struct Collider {
    /// Index of the moving body it belongs to; `None` stands still.
    pub body: Option<usize>,
    /// Corners of the core in the body's node frame (world frame where `body` is `None`), m.
    pub core: Vec<DVec3>,
    /// Radius of the ball, m.
    pub radius: f64,
    /// Index of the material.
    pub material: usize,
    /// Name of the glTF node, for messages and events.
    pub node: String,
}

impl Collider {
    /// Middle of the core and the farthest corner from it: a ball around the core (m, node frame).
    pub fn bounds(&self) -> (DVec3, f64) {
        let center = self.core.iter().sum::<DVec3>() / self.core.len() as f64;
        (center, self.core.iter().fold(0.0, |r: f64, p| r.max(p.distance(center))))
    }
}

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

/// World corners of two cores, kept so that nothing allocates in the step.
#[derive(Clone, Debug, Default)]
pub struct Corners {
    a: Vec<DVec3>,
    b: Vec<DVec3>,
}

impl Corners {
    /// Room for the largest of these colliders.
    pub fn new(colliders: &[Collider]) -> Self {
        let most = colliders.iter().map(|c| c.core.len()).max().unwrap_or(0);
        Self { a: Vec::with_capacity(most), b: Vec::with_capacity(most) }
    }

    /// Proximity of two colliders with their bodies at these poses.
    pub fn proximity(&mut self, a: &Collider, pose_a: &Pose, b: &Collider, pose_b: &Pose) -> Proximity {
        self.a.clear();
        self.a.extend(a.core.iter().map(|&p| pose_a.point(p)));
        self.b.clear();
        self.b.extend(b.core.iter().map(|&p| pose_b.point(p)));
        let Closest { distance, a: near_a, b: near_b } = convex::closest(&self.a, &self.b);
        // Cores that overlap have no nearest points: part them along their middles.
        let normal = if distance > 0.0 {
            (near_a - near_b) / distance
        } else {
            let middle = |corners: &[DVec3]| corners.iter().sum::<DVec3>() / corners.len() as f64;
            (middle(&self.a) - middle(&self.b)).try_normalize().unwrap_or(DVec3::Y)
        };
        let point = 0.5 * ((near_a - a.radius * normal) + (near_b + b.radius * normal));
        Proximity { gap: distance - a.radius - b.radius, normal, point }
    }

    /// Up to four points of contact of two colliders with their bodies at these poses.
    pub fn manifold(&mut self, a: &Collider, pose_a: &Pose, b: &Collider, pose_b: &Pose) -> Manifold {
        let Proximity { gap, normal, point } = self.proximity(a, pose_a, b, pose_b);
        let mut manifold = Manifold { normal, count: 1, ..Manifold::default() };
        manifold.points[0] = ManifoldPoint { point, gap };
        manifold
    }
}

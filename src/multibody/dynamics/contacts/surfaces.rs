//! The collision surfaces of an articulation and the narrow phase of its pairs.

use super::contact::{Contact, ContactKind};
use super::contact_problem::ContactProblem;
use super::impact::SurfacePair;
use super::jacobian_row::point_rows;
use super::nearby_pairs::SweptPair;
use super::tyre::full_slip_speed;
use crate::collision::{CONTACT_MARGIN, Collider, ColliderPair, Manifold, ManifoldBuilder};
use soffio_geometry::bodies::RigidBody;
use soffio_math::{DVec3, Pose};

/// Bisections for the time at which a body returns: to a thousandth of a millisecond.
const BISECTIONS: usize = 12;

/// All colliders of an articulation, and which of them can touch.
#[derive(Clone, Debug)]
pub(super) struct Surfaces {
    /// All colliders.
    pub colliders: Vec<Collider>,
    /// Largest distance of each collider's core from its body's centre of mass, m; 0 of the world.
    pub bounding_radii: Vec<f64>,
    /// Ball around each collider's core: centre in the node frame, and radius, m.
    balls: Vec<(DVec3, f64)>,
    /// The pairs of colliders that can touch.
    pub pairs: Vec<SurfacePair>,
    /// Builds manifolds from corners.
    pub corners: ManifoldBuilder,
}

/// Where two surfaces are in contact.
#[derive(Clone, Copy, Debug)]
pub(super) struct PointGeometry {
    /// World point of the contact, m.
    pub point: DVec3,
    /// Unit, from the second collider to the first.
    pub normal: DVec3,
    /// Distance, m; negative where they overlap.
    pub gap: f64,
}

impl Surfaces {
    /// The surfaces of these colliders of `bodies`; `pairs` are the pairs of colliders that can touch.
    pub fn new(colliders: &[Collider], pairs: Vec<SurfacePair>, bodies: &[RigidBody]) -> Self {
        let radius = |c: &Collider| c.body.map_or(0.0, |b| c.shape.bounding_radius(bodies[b].properties.center));
        Self {
            balls: colliders.iter().map(Collider::bounds).collect(),
            bounding_radii: colliders.iter().map(radius).collect(),
            corners: ManifoldBuilder::new(colliders),
            colliders: colliders.to_vec(),
            pairs,
        }
    }

    /// The contact manifold of a pair at the bodies' present poses.
    pub fn manifold(&mut self, pair: usize, bodies: &[RigidBody]) -> Manifold {
        let ColliderPair { a, b } = self.pairs[pair].pair;
        let (pose_a, pose_b) = (self.pose(a, bodies), self.pose(b, bodies));
        self.corners.manifold(&self.colliders[a], &pose_a, &self.colliders[b], &pose_b)
    }

    /// World pose of a collider's node.
    pub fn pose(&self, collider: usize, bodies: &[RigidBody]) -> Pose {
        self.colliders[collider].body.map_or(Pose::IDENTITY, |body| bodies[body].pose())
    }

    /// The two bodies of a pair; `None` is the world.
    pub fn bodies_of(&self, pair: usize) -> [Option<usize>; 2] {
        let ColliderPair { a, b } = self.pairs[pair].pair;
        [self.colliders[a].body, self.colliders[b].body]
    }

    /// Adds a contact point of a pair to a problem.
    pub fn push_point(&self, problem: &mut ContactProblem, pair: usize, at: PointGeometry, bodies: &[RigidBody]) {
        let PointGeometry { point, normal, gap } = at;
        let SurfacePair { friction, full_slip, .. } = self.pairs[pair];
        let full_slip = full_slip_speed(full_slip, self.bodies_of(pair), point, normal, bodies);
        let kind = ContactKind::Point { pair, friction, full_slip };
        let rows = point_rows(point, normal, self.bodies_of(pair), bodies);
        problem.push(Contact::new(kind, point, normal, gap), &rows);
    }

    /// Velocity of a pair's first body relative to its second at a world point, m/s.
    pub fn velocity_at(&self, pair: usize, point: DVec3, bodies: &[RigidBody]) -> DVec3 {
        let at = |body: Option<usize>| body.map_or(DVec3::ZERO, |i| bodies[i].velocity_at(point));
        let [a, b] = self.bodies_of(pair);
        at(a) - at(b)
    }

    /// Whether the bounding balls of a pair overlap at the bodies' present poses.
    pub fn may_touch(&self, pair: usize, bodies: &[RigidBody]) -> bool {
        let ColliderPair { a, b } = self.pairs[pair].pair;
        let place = |c: usize| self.pose(c, bodies).point(self.balls[c].0);
        let far = self.balls[a].1
            + self.balls[b].1
            + self.colliders[a].shape.radius
            + self.colliders[b].shape.radius
            + CONTACT_MARGIN;
        place(a).distance_squared(place(b)) <= far * far
    }

    /// The fraction of a substep after which a pair that opens at its beginning has closed again, if it overlaps at the end.
    pub fn return_time(&self, pair: usize, SweptPair { sweeps, .. }: &SweptPair) -> Option<f64> {
        let ColliderPair { a, b } = self.pairs[pair].pair;
        let (collider_a, collider_b) = (&self.colliders[a], &self.colliders[b]);
        let ([sweep_a, sweep_b], corners) = (sweeps, &self.corners);
        let gap = |s: f64| corners.proximity(collider_a, &sweep_a.pose(s), collider_b, &sweep_b.pose(s)).gap;
        let end = gap(1.0);
        if end >= 0.0 || end >= gap(0.0) {
            return None;
        }
        let (mut open, mut closed) = (0.0, 1.0);
        for _ in 0..BISECTIONS {
            let middle = 0.5 * (open + closed);
            if gap(middle) > 0.0 { open = middle } else { closed = middle }
        }
        Some(open)
    }
}

//! The surfaces of a figure, and how its pairs lie to each other.

use super::contact::{Contact, Source};
use super::contact_problem::ContactProblem;
use super::impact::SurfacePair;
use super::jacobian_row::point_rows;
use crate::collision::{Collider, Corners, Manifold, Pair, Sweep, TOUCH};
use soffio_geometry::bodies::RigidBody;
use soffio_math::{DVec3, Pose};

/// Halvings that find when a thrown body comes back: to a thousandth of a millisecond.
const HALVINGS: usize = 12;

/// All surfaces of a figure, and which of them can touch.
#[derive(Clone, Debug)]
pub(super) struct Surfaces {
    pub colliders: Vec<Collider>,
    /// Farthest point of each collider's core from its body's centre of mass (none moves what stands still), and ball around it in the node frame.
    pub reach: Vec<f64>,
    balls: Vec<(DVec3, f64)>,
    pub pairs: Vec<SurfacePair>,
    pub corners: Corners,
}

impl Surfaces {
    /// Those of a figure's colliders, with the pairs that can meet.
    pub fn new(colliders: &[Collider], pairs: Vec<SurfacePair>, bodies: &[RigidBody]) -> Self {
        let reach = |c: &Collider| c.body.map_or(0.0, |b| c.shape.reach(bodies[b].properties.center));
        Self {
            balls: colliders.iter().map(Collider::bounds).collect(),
            reach: colliders.iter().map(reach).collect(),
            corners: Corners::new(colliders),
            colliders: colliders.to_vec(),
            pairs,
        }
    }

    /// Where a pair touches at the bodies' present poses.
    pub fn manifold(&mut self, pair: usize, bodies: &[RigidBody]) -> Manifold {
        let Pair { a, b } = self.pairs[pair].pair;
        let (pose_a, pose_b) = (self.pose(a, bodies), self.pose(b, bodies));
        self.corners.manifold(&self.colliders[a], &pose_a, &self.colliders[b], &pose_b)
    }

    pub fn pose(&self, collider: usize, bodies: &[RigidBody]) -> Pose {
        self.colliders[collider].body.map_or(Pose::IDENTITY, |body| bodies[body].pose())
    }

    /// The two bodies of a pair.
    pub fn bodies_of(&self, pair: usize) -> [Option<usize>; 2] {
        let Pair { a, b } = self.pairs[pair].pair;
        [self.colliders[a].body, self.colliders[b].body]
    }

    /// Adds a point of a pair to a problem.
    pub fn push_point(
        &self,
        problem: &mut ContactProblem,
        pair: usize,
        (point, normal, gap): (DVec3, DVec3, f64),
        bodies: &[RigidBody],
    ) {
        let [a, b] = self.bodies_of(pair);
        let contact = Contact::new(Source::Pair(pair), point, normal, gap, self.pairs[pair].friction);
        problem.push(contact, &point_rows(point, normal, [a, b], bodies));
    }

    /// Relative velocity of a pair's bodies at a point, first minus second, m/s.
    pub fn velocity_at(&self, pair: usize, point: DVec3, bodies: &[RigidBody]) -> DVec3 {
        let at = |body: Option<usize>| body.map_or(DVec3::ZERO, |i| bodies[i].velocity_at(point));
        let [a, b] = self.bodies_of(pair);
        at(a) - at(b)
    }

    /// Can the balls around two colliders touch where their bodies are?
    pub fn may_touch(&self, pair: usize, bodies: &[RigidBody]) -> bool {
        let Pair { a, b } = self.pairs[pair].pair;
        let place = |c: usize| self.pose(c, bodies).point(self.balls[c].0);
        let far =
            self.balls[a].1 + self.balls[b].1 + self.colliders[a].shape.radius + self.colliders[b].shape.radius + TOUCH;
        place(a).distance_squared(place(b)) <= far * far
    }

    /// When a pair that opens at the beginning has closed again, if it has sunk in by the end.
    pub fn comes_back(&self, a: usize, b: usize, sweep_a: &Sweep, sweep_b: &Sweep) -> Option<f64> {
        let (collider_a, collider_b) = (&self.colliders[a], &self.colliders[b]);
        let corners = &self.corners;
        let gap = |s: f64| corners.proximity(collider_a, &sweep_a.pose(s), collider_b, &sweep_b.pose(s)).gap;
        let end = gap(1.0);
        if end >= 0.0 || end >= gap(0.0) {
            return None;
        }
        let (mut open, mut closed) = (0.0, 1.0);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (open + closed);
            if gap(middle) > 0.0 { open = middle } else { closed = middle }
        }
        Some(open)
    }
}

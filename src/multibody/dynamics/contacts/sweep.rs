//! The first hit of a substep: swept boxes (the broad phase), then conservative advancement.
//!
//! What touches at the beginning and opens there is not hit; if it has sunk in by the end it was thrown and came back
//! within the substep, and the time at which it did is found by bisection.

use super::Contacts;
use super::problem::Source;
use crate::collision::{Pair, Sweep, TOUCH, TimeOfImpact, time_of_impact};
use soffio_geometry::bodies::RigidBody;

/// Halvings that find when a thrown body comes back: to a thousandth of a millisecond.
const HALVINGS: usize = 12;

/// The first hit of a substep.
#[derive(Clone, Copy, Debug)]
pub(in crate::dynamics) struct Hit {
    /// Share of the substep.
    pub s: f64,
    pub(super) source: Source,
}

impl Contacts {
    /// The first hit of anything that is apart, between two states of the bodies.
    pub(in crate::dynamics) fn first_impact(&mut self, before: &[RigidBody], after: &[RigidBody]) -> Option<Hit> {
        self.find_near(before, after);
        let mut first: Option<Hit> = None;
        for near in 0..self.near.len() {
            self.meet(self.near[near], before, after, &mut first);
        }
        for bound in 0..self.limits.count() {
            if self.limits.resting(bound) || self.limits.sleeps(bound) {
                continue;
            }
            if let Some(s) = self.limits.crossing(bound, before, after, &self.sweeps) {
                if self.impacts_left == 0 {
                    self.set_bound_resting(bound, true);
                } else if first.is_none_or(|f| s < f.s) {
                    first = Some(Hit { s, source: Source::Bound(bound) });
                }
            }
        }
        first
    }

    /// Finds the pairs whose boxes overlap on the way between two states of the bodies.
    pub(super) fn find_near(&mut self, before: &[RigidBody], after: &[RigidBody]) {
        for (((sweep, b), a), asleep) in self.sweeps.iter_mut().zip(before).zip(after).zip(&self.asleep) {
            if !asleep {
                *sweep = Sweep::new(b, a);
            }
        }
        self.broad.candidates(&self.sweeps, &mut self.near);
        #[cfg(test)]
        if self.all {
            self.near.clear();
            self.near.extend(0..self.pairs.len());
        }
    }

    /// The earliest hit so far, or an earlier one of this pair.
    fn meet(&mut self, pair: usize, before: &[RigidBody], after: &[RigidBody], first: &mut Option<Hit>) {
        if self.resting[pair] {
            return;
        }
        let Pair { a, b } = self.pairs[pair].pair;
        let ((sweep_a, sweep_b), toi) = self.sweep_pair(pair);
        let Some(TimeOfImpact { mut s, proximity }) = toi else { return };
        let states = if s > 0.0 { after } else { before };
        if self.velocity_at(pair, proximity.point, states).dot(proximity.normal) >= 0.0 {
            let Some(back) = self.comes_back(a, b, &sweep_a, &sweep_b) else { return };
            s = back;
        }
        if self.impacts_left == 0 {
            self.set_resting(pair, true);
        } else if first.is_none_or(|f| s < f.s) {
            *first = Some(Hit { s, source: Source::Pair(pair) });
        }
    }

    /// The ways of a pair's colliders, and when they meet on them.
    pub(super) fn sweep_pair(&mut self, pair: usize) -> ((Sweep, Sweep), Option<TimeOfImpact>) {
        let Pair { a, b } = self.pairs[pair].pair;
        self.measured += 1;
        let (sweep_a, sweep_b) = (self.sweep(a), self.sweep(b));
        let toi = time_of_impact(
            &mut self.corners,
            (&self.colliders[a], &sweep_a, self.reach[a]),
            (&self.colliders[b], &sweep_b, self.reach[b]),
        );
        ((sweep_a, sweep_b), toi)
    }

    /// When a pair that opens at the beginning has closed again, if it has sunk in by the end.
    fn comes_back(&mut self, a: usize, b: usize, sweep_a: &Sweep, sweep_b: &Sweep) -> Option<f64> {
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

    pub(super) fn sweep(&self, collider: usize) -> Sweep {
        self.colliders[collider].body.map_or(Sweep::STILL, |body| self.sweeps[body])
    }

    /// Can the balls around two colliders touch where their bodies are?
    pub(super) fn may_touch(&self, pair: usize, bodies: &[RigidBody]) -> bool {
        let Pair { a, b } = self.pairs[pair].pair;
        let place = |c: usize| self.pose(c, bodies).point(self.balls[c].0);
        let far =
            self.balls[a].1 + self.balls[b].1 + self.colliders[a].shape.radius + self.colliders[b].shape.radius + TOUCH;
        place(a).distance_squared(place(b)) <= far * far
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::collision::{Collider, Reach, Shape, pairs};
    use crate::dynamics::forces::Damping;
    use crate::dynamics::{Dynamics, Figure, Integrator, Resistance, Settings, Solver, SurfacePair};
    use soffio_geometry::bodies::MassProperties;
    use soffio_math::noise::Random;
    use soffio_math::{DMat3, DQuat, DVec3, Pose, rotation};

    /// Plates and balls thrown at each other above a floor.
    fn crowd(count: usize) -> Dynamics {
        let mut random = Random::new(11);
        let mut any = || DVec3::new(random.signed(), random.signed(), random.signed());
        let (mut bodies, mut colliders) = (Vec::new(), Vec::new());
        for i in 0..count {
            let properties =
                MassProperties { mass: 0.05, center: DVec3::ZERO, inertia: DMat3::from_diagonal(DVec3::splat(2e-5)) };
            let place = Pose { rotation: DQuat::IDENTITY, position: 0.4 * any() + DVec3::Y * 0.45 };
            let mut body = RigidBody::at_rest(properties, place);
            body.rotation = rotation(any());
            (body.velocity, body.angular_velocity) = (2.0 * any(), 5.0 * any());
            bodies.push(body);
            let flat = Shape::cuboid(Pose::IDENTITY, DVec3::new(0.03, 5e-4, 0.03), 5e-4);
            let shape = if i % 2 == 0 { flat } else { Shape::sphere(DVec3::ZERO, 0.02) };
            colliders.push(Collider { body: Some(i), shape, material: 0, node: String::new() });
        }
        let floor = Shape::plane(DVec3::ZERO, DVec3::Y);
        colliders.push(Collider { body: None, shape: floor, material: 0, node: String::new() });
        let surface = |pair| SurfacePair { pair, restitution: 0.4, friction: 0.3, resistance: Resistance::default() };
        let figure = Figure {
            damping: vec![Damping::default(); bodies.len()],
            bodies,
            constraints: &[],
            limits: &[],
            springs: &[],
            drives: &[],
            pairs: pairs(&colliders, &[], &Reach::default()).meet.into_iter().map(surface).collect(),
            colliders: &colliders,
        };
        let settings = Settings {
            gravity: DVec3::Y * -9.81,
            friction: true,
            stabilization_time: 0.04,
            integrator: Integrator::RungeKutta,
            solver: Solver::Sparse,
        };
        Dynamics::new(figure, settings)
    }

    #[test]
    fn only_near_pairs_are_measured_and_nothing_changes_by_it() {
        let (mut near, mut all) = (crowd(24), crowd(24));
        all.contacts.all = true;
        let (mut few, mut many, mut hits) = (0, 0, [Vec::new(), Vec::new()]);
        for step in 0..120 {
            for (dynamics, hits) in [&mut near, &mut all].into_iter().zip(&mut hits) {
                dynamics.step(1.0 / 240.0, &[[0.0; 6]; 24], hits);
            }
            (few, many) = (few + near.measured_pairs(), many + all.measured_pairs());
            for (one, other) in near.bodies.iter().zip(&all.bodies) {
                let bits = |b: &RigidBody| {
                    [b.position, b.velocity, b.angular_velocity].map(|v| v.to_array().map(f64::to_bits))
                };
                assert_eq!(bits(one), bits(other), "step {step}");
            }
        }
        assert_eq!(hits[0], hits[1]);
        assert!(hits[0].len() > 20, "{} hits", hits[0].len());
        assert!(few * 4 < many, "{few} of {many} pairs");
    }
}

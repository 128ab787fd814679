//! The first hit of a substep: swept boxes (the broad phase), then conservative advancement.
//!
//! What touches at the beginning and opens there is not hit; if it has sunk in by the end it was thrown and came back
//! within the substep, and the time at which it did is found by bisection.

use super::contact::Source;
use super::state::Contacts;
use crate::collision::{Pair, TimeOfImpact};
use soffio_geometry::bodies::RigidBody;

/// The first hit of a substep.
#[derive(Clone, Copy, Debug)]
pub(in crate::dynamics) struct EarliestImpact {
    /// Share of the substep.
    pub s: f64,
    pub(super) source: Source,
}

impl Contacts {
    /// The first hit of anything that is apart, between two states of the bodies.
    pub(in crate::dynamics) fn first_impact(
        &mut self,
        before: &[RigidBody],
        after: &[RigidBody],
    ) -> Option<EarliestImpact> {
        self.near.find(before, after, &self.sleeping.bodies);
        let mut first: Option<EarliestImpact> = None;
        for near in 0..self.near.list.len() {
            self.meet(self.near.list[near], before, after, &mut first);
        }
        for bound in 0..self.limits.count() {
            if self.limits.resting(bound) || self.limits.sleeps(bound) {
                continue;
            }
            if let Some(s) = self.limits.crossing(bound, before, after, &self.near.sweeps) {
                if self.impacts_left == 0 {
                    self.resting.set_bound(bound, true, &mut self.limits);
                } else if first.is_none_or(|f| s < f.s) {
                    first = Some(EarliestImpact { s, source: Source::Bound(bound) });
                }
            }
        }
        first
    }

    /// The earliest hit so far, or an earlier one of this pair.
    fn meet(&mut self, pair: usize, before: &[RigidBody], after: &[RigidBody], first: &mut Option<EarliestImpact>) {
        let Some(TimeOfImpact { s, .. }) = self.meets(pair, before, after) else { return };
        if self.impacts_left == 0 {
            self.resting.set(pair, true);
        } else if first.is_none_or(|f| s < f.s) {
            *first = Some(EarliestImpact { s, source: Source::Pair(pair) });
        }
    }

    /// When and where a pair that does not rest meets on the way between two states.
    pub(super) fn meets(&mut self, pair: usize, before: &[RigidBody], after: &[RigidBody]) -> Option<TimeOfImpact> {
        if self.resting.pairs[pair] {
            return None;
        }
        let Pair { a, b } = self.surfaces.pairs[pair].pair;
        let ((sweep_a, sweep_b), toi) = self.near.sweep_pair(&mut self.surfaces, pair);
        let mut toi = toi?;
        let states = if toi.s > 0.0 { after } else { before };
        if self.surfaces.velocity_at(pair, toi.proximity.point, states).dot(toi.proximity.normal) >= 0.0 {
            toi.s = self.surfaces.comes_back(a, b, &sweep_a, &sweep_b)?;
        }
        Some(toi)
    }
}

#[cfg(test)]
mod tests {
    use crate::collision::{Collider, Reach, Shape, pairs};
    use crate::dynamics::forces::Damping;
    use crate::dynamics::{Articulation, Dynamics, Integrator, RollingResistance, Settings, Solver, SurfacePair};
    use soffio_geometry::bodies::{MassProperties, RigidBody};
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
        let surface =
            |pair| SurfacePair { pair, restitution: 0.4, friction: 0.3, resistance: RollingResistance::default() };
        let figure = Articulation {
            damping: vec![Damping::default(); bodies.len()],
            bodies,
            constraints: &[],
            limits: &[],
            springs: &[],
            kinematic_bodies: &[],
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
        all.contacts.near.all = Some(all.contacts.surfaces.pairs.len());
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

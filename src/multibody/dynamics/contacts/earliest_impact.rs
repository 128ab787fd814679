//! The earliest impact of a substep, by continuous collision detection: swept boxes, then conservative advancement.
//!
//! A pair in contact at the substep's beginning that opens there has no impact. If it overlaps at the end, it was thrown and
//! returned within the substep; bisection finds that time.

use super::contact::ContactSource;
use super::state::Contacts;
use crate::collision::TimeOfImpact;
use soffio_geometry::bodies::RigidBody;

/// The earliest impact of a substep.
#[derive(Clone, Copy, Debug)]
pub(in crate::dynamics) struct EarliestImpact {
    /// Fraction of the substep after which it happens.
    pub s: f64,
    pub(super) source: ContactSource,
}

impl Contacts {
    /// The earliest impact between two states of the bodies, of pairs and bounds that do not rest.
    pub(in crate::dynamics) fn earliest_impact(
        &mut self,
        before: &[RigidBody],
        after: &[RigidBody],
    ) -> Option<EarliestImpact> {
        self.nearby.find(before, after, &self.sleeping.bodies);
        let mut earliest: Option<EarliestImpact> = None;
        for index in 0..self.nearby.list.len() {
            let pair = self.nearby.list[index];
            if let Some(TimeOfImpact { s, .. }) = self.time_of_impact(pair, before, after) {
                self.take_earlier(EarliestImpact { s, source: ContactSource::Surfaces(pair) }, &mut earliest);
            }
        }
        for bound in 0..self.limits.count() {
            if self.limits.is_resting(bound) || self.limits.is_asleep(bound) {
                continue;
            }
            if let Some(s) = self.limits.crossing(bound, before, after, &self.nearby.sweeps) {
                self.take_earlier(EarliestImpact { s, source: ContactSource::Limit(bound) }, &mut earliest);
            }
        }
        earliest
    }

    /// Takes an impact if it is the earliest so far. When the step has no impacts left it becomes a resting contact instead.
    fn take_earlier(&mut self, impact: EarliestImpact, earliest: &mut Option<EarliestImpact>) {
        if self.impacts_left == 0 {
            self.resting.set(impact.source, true, &mut self.limits);
        } else if earliest.is_none_or(|other| impact.s < other.s) {
            *earliest = Some(impact);
        }
    }

    /// When and where a pair that does not rest comes into contact between two states.
    pub(super) fn time_of_impact(
        &mut self,
        pair: usize,
        before: &[RigidBody],
        after: &[RigidBody],
    ) -> Option<TimeOfImpact> {
        if self.resting.is_resting[pair] {
            return None;
        }
        let swept = self.nearby.sweep_pair(&mut self.surfaces, pair);
        let mut impact = swept.impact?;
        let states = if impact.s > 0.0 { after } else { before };
        if self.surfaces.velocity_at(pair, impact.proximity.point, states).dot(impact.proximity.normal) >= 0.0 {
            impact.s = self.surfaces.return_time(pair, &swept)?;
        }
        Some(impact)
    }
}

#[cfg(test)]
mod tests {
    use crate::collision::{Collider, ReachableVolumes, Shape, pairs};
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
        let surface = |pair| SurfacePair {
            pair,
            restitution: 0.4,
            friction: 0.3,
            full_slip: 0.0,
            resistance: RollingResistance::default(),
        };
        let articulation = Articulation {
            damping: vec![Damping::default(); bodies.len()],
            bodies,
            constraints: &[],
            limits: &[],
            springs: &[],
            kinematic_bodies: &[],
            pairs: pairs(&colliders, &[], &ReachableVolumes::default()).meet.into_iter().map(surface).collect(),
            colliders: &colliders,
        };
        let settings = Settings {
            gravity: DVec3::Y * -9.81,
            friction: true,
            stabilization_time: 0.04,
            integrator: Integrator::RungeKutta,
            solver: Solver::Sparse,
        };
        Dynamics::new(articulation, settings)
    }

    #[test]
    fn only_near_pairs_are_measured_and_nothing_changes_by_it() {
        let (mut near, mut all) = (crowd(24), crowd(24));
        all.contacts.nearby.all = Some(all.contacts.surfaces.pairs.len());
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

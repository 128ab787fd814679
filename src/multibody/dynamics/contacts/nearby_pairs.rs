//! Broad phase of contact: pairs of colliders whose swept boxes overlap.

use super::surfaces::Surfaces;
use crate::collision::{BroadPhase, Collider, ColliderPair, MovingCollider, Sweep, TimeOfImpact, time_of_impact};
use soffio_geometry::bodies::RigidBody;

/// The pairs of an articulation's colliders that are near each other.
#[derive(Clone, Debug)]
pub(super) struct NearbyPairs {
    broad: BroadPhase,
    /// Pairs whose boxes overlap, ascending: over the present substep, or at the bodies' state of an impact.
    pub list: Vec<usize>,
    /// Motion of each body over the substep.
    pub sweeps: Vec<Sweep>,
    /// Number of pairs measured in the present step.
    pub measured: usize,
    /// Takes all of so many pairs as near.
    #[cfg(test)]
    pub all: Option<usize>,
}

/// The motions of a pair's two colliders, and their first contact.
pub(super) struct SweptPair {
    /// Motions of the two colliders over the substep.
    pub sweeps: [Sweep; 2],
    /// Their first contact; `None` where they do not meet.
    pub impact: Option<TimeOfImpact>,
}

impl NearbyPairs {
    /// The broad phase of these pairs, for so many bodies.
    pub fn new(colliders: &[Collider], pairs: &[ColliderPair], bodies: usize) -> Self {
        Self {
            broad: BroadPhase::new(colliders, pairs),
            list: Vec::with_capacity(pairs.len()),
            sweeps: vec![Sweep::STATIC; bodies],
            measured: 0,
            #[cfg(test)]
            all: None,
        }
    }

    /// Sets which bodies sleep; pairs among them are left out.
    pub fn set_asleep(&mut self, asleep: &[bool], bodies: &[RigidBody]) {
        for (body, sweep) in self.sweeps.iter_mut().enumerate().filter(|(body, _)| asleep[*body]) {
            *sweep = Sweep::new(&bodies[body], &bodies[body]);
        }
        self.broad.let_sleep(asleep);
    }

    /// Finds the pairs whose boxes overlap between two states of the bodies.
    pub fn find(&mut self, before: &[RigidBody], after: &[RigidBody], asleep: &[bool]) {
        for (((sweep, b), a), asleep) in self.sweeps.iter_mut().zip(before).zip(after).zip(asleep) {
            if !asleep {
                *sweep = Sweep::new(b, a);
            }
        }
        self.broad.candidates(&self.sweeps, &mut self.list);
        #[cfg(test)]
        if let Some(pairs) = self.all {
            self.list.clear();
            self.list.extend(0..pairs);
        }
    }

    /// The motions of a pair's colliders, and when they come into contact.
    pub fn sweep_pair(&mut self, surfaces: &mut Surfaces, pair: usize) -> SweptPair {
        let ColliderPair { a, b } = surfaces.pairs[pair].pair;
        self.measured += 1;
        let (sweep_a, sweep_b) = (self.sweep(surfaces, a), self.sweep(surfaces, b));
        let impact = time_of_impact(
            &surfaces.corners,
            MovingCollider {
                collider: &surfaces.colliders[a],
                sweep: &sweep_a,
                bounding_radius: surfaces.bounding_radii[a],
            },
            MovingCollider {
                collider: &surfaces.colliders[b],
                sweep: &sweep_b,
                bounding_radius: surfaces.bounding_radii[b],
            },
        );
        SweptPair { sweeps: [sweep_a, sweep_b], impact }
    }

    /// The motion of a collider.
    pub fn sweep(&self, surfaces: &Surfaces, collider: usize) -> Sweep {
        surfaces.colliders[collider].body.map_or(Sweep::STATIC, |body| self.sweeps[body])
    }
}

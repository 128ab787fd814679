//! What is near what: pairs whose boxes overlap on a way of the bodies.

use super::surfaces::Surfaces;
use crate::collision::{BroadPhase, Collider, Pair, Sweep, TimeOfImpact, time_of_impact};
use soffio_geometry::bodies::RigidBody;

/// The broad phase of a figure.
#[derive(Clone, Debug)]
pub(super) struct NearbyPairs {
    broad: BroadPhase,
    /// Pairs whose boxes overlap, ascending: over the present substep, or where bodies are at a hit.
    pub list: Vec<usize>,
    /// Ways of the bodies.
    pub sweeps: Vec<Sweep>,
    /// How many pairs were measured in the present step.
    pub measured: usize,
    /// Looks at all of so many pairs, near or not.
    #[cfg(test)]
    pub all: Option<usize>,
}

impl NearbyPairs {
    /// Of these pairs of colliders, for so many bodies.
    pub fn new(colliders: &[Collider], pairs: &[Pair], bodies: usize) -> Self {
        Self {
            broad: BroadPhase::new(colliders, pairs),
            list: Vec::with_capacity(pairs.len()),
            sweeps: vec![Sweep::STILL; bodies],
            measured: 0,
            #[cfg(test)]
            all: None,
        }
    }

    /// Leaves out what is among bodies that sleep, where they are.
    pub fn let_sleep(&mut self, asleep: &[bool], bodies: &[RigidBody]) {
        for (body, sweep) in self.sweeps.iter_mut().enumerate().filter(|(body, _)| asleep[*body]) {
            *sweep = Sweep::new(&bodies[body], &bodies[body]);
        }
        self.broad.let_sleep(asleep);
    }

    /// Finds the pairs whose boxes overlap on the way between two states of the bodies.
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

    /// The ways of a pair's colliders, and when they meet on them.
    pub fn sweep_pair(&mut self, surfaces: &mut Surfaces, pair: usize) -> ((Sweep, Sweep), Option<TimeOfImpact>) {
        let Pair { a, b } = surfaces.pairs[pair].pair;
        self.measured += 1;
        let (sweep_a, sweep_b) = (self.sweep(surfaces, a), self.sweep(surfaces, b));
        let toi = time_of_impact(
            &mut surfaces.corners,
            (&surfaces.colliders[a], &sweep_a, surfaces.reach[a]),
            (&surfaces.colliders[b], &sweep_b, surfaces.reach[b]),
        );
        ((sweep_a, sweep_b), toi)
    }

    /// The way of a collider.
    pub fn sweep(&self, surfaces: &Surfaces, collider: usize) -> Sweep {
        surfaces.colliders[collider].body.map_or(Sweep::STILL, |body| self.sweeps[body])
    }
}

//! Contacts of what sleeps (`dynamics/sleep.rs`): left out, the forces there kept, until somebody comes.

use super::contact::Source;
use super::earliest_impact::EarliestImpact;
use super::state::Contacts;
use crate::collision::{Manifold, TOUCH};
use soffio_geometry::bodies::RigidBody;

impl Contacts {
    /// Leaves out what touches among bodies that sleep, and takes up again what no longer does.
    pub(in crate::dynamics) fn let_sleep(&mut self, asleep: &[bool], bodies: &[RigidBody]) {
        self.sleeping.bodies.copy_from_slice(asleep);
        self.near.let_sleep(asleep, bodies);
        self.limits.let_sleep(asleep);
        self.forces.let_sleep(asleep);
        let bounds = (0..self.limits.count()).filter(|&bound| self.limits.resting(bound) && self.limits.sleeps(bound));
        let pairs = self.resting.at_rest.iter().filter(|&&pair| self.sleeping.sleep(self.surfaces.bodies_of(pair)));
        self.sleeping.at_rest = bounds.count() + pairs.count();
    }

    /// The two bodies of everything that lies on each other.
    pub(in crate::dynamics) fn resting_pairs_bodies(&self) -> impl Iterator<Item = [Option<usize>; 2]> {
        self.resting.at_rest.iter().map(|&pair| self.surfaces.bodies_of(pair))
    }

    /// A body that sleeps while something leans on it that does not.
    pub(in crate::dynamics) fn disturbed_sleeper(&self) -> Option<usize> {
        self.resting.at_rest.iter().find_map(|&pair| self.sleeping.one_of(self.surfaces.bodies_of(pair)))
    }

    /// A body that sleeps and is about to feel a hit: it is hit itself, or touches what moves.
    pub(in crate::dynamics) fn sleeper_near_impact(
        &mut self,
        hit: &EarliestImpact,
        bodies: &[RigidBody],
    ) -> Option<usize> {
        self.near.find(bodies, bodies, &self.sleeping.bodies);
        for near in 0..self.near.list.len() {
            let pair = self.near.list[near];
            let Some(sleeper) = self.sleeping.one_of(self.surfaces.bodies_of(pair)) else { continue };
            let contacts = |manifold: Manifold| manifold.points().iter().any(|at| at.gap <= TOUCH);
            if hit.source == Source::Pair(pair)
                || (self.surfaces.may_touch(pair, bodies) && contacts(self.surfaces.manifold(pair, bodies)))
            {
                return Some(sleeper);
            }
        }
        None
    }

    /// Enters work that is no contact's: what a body had left when it was put to rest, J.
    pub(in crate::dynamics) fn record_loss(&mut self, energy: f64) {
        self.work.total -= energy;
    }
}

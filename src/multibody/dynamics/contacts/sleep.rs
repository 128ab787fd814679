//! Contacts of sleeping bodies (`dynamics/sleep.rs`): left out with their forces kept, until something disturbs them.

use super::contact::ContactSource;
use super::earliest_impact::EarliestImpact;
use super::state::Contacts;
use crate::collision::{CONTACT_MARGIN, Manifold};
use soffio_geometry::bodies::RigidBody;

impl Contacts {
    /// Sets which bodies sleep: contacts among them are left out, those of bodies that woke act again.
    pub(in crate::dynamics) fn set_asleep(&mut self, asleep: &[bool], bodies: &[RigidBody]) {
        self.sleeping.bodies.copy_from_slice(asleep);
        self.nearby.set_asleep(asleep, bodies);
        self.limits.set_asleep(asleep);
        self.forces.set_asleep(asleep);
        let rests_asleep = |bound: &usize| self.limits.is_resting(*bound) && self.limits.is_asleep(*bound);
        let bounds = (0..self.limits.count()).filter(rests_asleep);
        let pairs = self.resting.pairs.iter().filter(|&&pair| self.sleeping.both(self.surfaces.bodies_of(pair)));
        self.sleeping.resting = bounds.count() + pairs.count();
    }

    /// The two bodies of every resting pair.
    pub(in crate::dynamics) fn resting_bodies(&self) -> impl Iterator<Item = [Option<usize>; 2]> {
        self.resting.pairs.iter().map(|&pair| self.surfaces.bodies_of(pair))
    }

    /// A sleeping body in resting contact with one that is awake.
    pub(in crate::dynamics) fn disturbed_sleeper(&self) -> Option<usize> {
        self.resting.pairs.iter().find_map(|&pair| self.sleeping.one_of(self.surfaces.bodies_of(pair)))
    }

    /// A sleeping body that takes part in an impact or is in contact with a body that is awake.
    pub(in crate::dynamics) fn sleeper_near_impact(
        &mut self,
        impact: &EarliestImpact,
        bodies: &[RigidBody],
    ) -> Option<usize> {
        self.nearby.find(bodies, bodies, &self.sleeping.bodies);
        for index in 0..self.nearby.list.len() {
            let pair = self.nearby.list[index];
            let Some(sleeper) = self.sleeping.one_of(self.surfaces.bodies_of(pair)) else { continue };
            let is_closed = |manifold: Manifold| manifold.points().iter().any(|at| at.gap <= CONTACT_MARGIN);
            if impact.source == ContactSource::Surfaces(pair)
                || (self.surfaces.may_touch(pair, bodies) && is_closed(self.surfaces.manifold(pair, bodies)))
            {
                return Some(sleeper);
            }
        }
        None
    }

    /// Records energy (J) that a body lost when it was put to sleep.
    pub(in crate::dynamics) fn record_loss(&mut self, energy: f64) {
        self.work.total -= energy;
    }
}

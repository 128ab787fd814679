//! Who falls asleep and who wakes (`sleep.rs`), and what all others are told of it.

use super::contacts::EarliestImpact;
use super::equations::Evaluated;
use super::step::Dynamics;
use soffio_math::DVec3;

impl Dynamics {
    /// Does a body sleep: at rest, and left out until something touches or pushes it?
    pub fn is_asleep(&self, body: usize) -> bool {
        self.sleep.asleep()[body]
    }

    /// Lets fall asleep what has rested for long enough, `dt` seconds later; what it still had of speed is gone.
    pub(super) fn fall_asleep(&mut self, dt: f64) {
        let Self { sleep, contacts, equations, bodies, .. } = self;
        sleep.watch(dt, bodies, &equations.wrenches.given);
        let waits = equations.system.gathers() || contacts.clutches().slipping().next().is_some();
        if waits || !sleep.fall(contacts.resting_pairs_bodies()) {
            return;
        }
        for (index, body) in bodies.iter_mut().enumerate().filter(|(index, _)| sleep.asleep()[*index]) {
            contacts.record_loss(body.kinetic_energy());
            (body.velocity, body.angular_velocity) = (DVec3::ZERO, DVec3::ZERO);
            self.before[index] = *body;
            self.integration.put_to_rest(index, body.properties.mass);
        }
        self.publish_sleep();
    }

    /// Wakes what is pushed otherwise than when it fell asleep, or no longer where it did.
    pub(super) fn wake_pushed_bodies(&mut self) {
        while let Some(body) = self.sleep.roused(&self.bodies, &self.before, &self.equations.wrenches.given) {
            self.wake(body);
        }
    }

    /// Wakes a body with its island.
    pub(super) fn wake(&mut self, body: usize) {
        if self.sleep.wake(body, self.contacts.resting_pairs_bodies()) {
            self.publish_sleep();
        }
    }

    pub(super) fn wake_all(&mut self) {
        if self.sleep.wake_all() {
            self.publish_sleep();
        }
    }

    /// Wakes all that a hit will be felt by.
    pub(super) fn wake_for(&mut self, hit: &EarliestImpact) {
        while self.sleep.any()
            && let Some(body) = self.contacts.sleeper_near_impact(hit, &self.bodies)
        {
            self.wake(body);
        }
    }

    fn publish_sleep(&mut self) {
        let asleep = self.sleep.asleep();
        self.equations.system.let_sleep(asleep, &self.bodies);
        self.equations.springs.let_sleep(asleep);
        self.contacts.let_sleep(asleep, &self.bodies);
        self.integration.interrupt();
        self.equations.evaluated = Evaluated::Nothing;
    }
}

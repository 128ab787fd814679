//! Falling asleep and waking (`sleep.rs`), and its effect on joints, springs and contacts.

use super::contacts::EarliestImpact;
use super::equations::Evaluated;
use super::sleep::Extent;
use super::step::Dynamics;
use soffio_math::DVec3;

impl Dynamics {
    /// Whether a body sleeps: it is at rest, and left out until something touches or pushes it.
    pub fn is_asleep(&self, body: usize) -> bool {
        self.sleep.asleep()[body]
    }

    /// Puts islands, or all bodies together, to sleep that have been at rest long enough, after a step of `dt` seconds. Their
    /// velocities become zero.
    pub(super) fn fall_asleep(&mut self, dt: f64, extent: Extent) {
        let Self { sleep, contacts, equations, bodies, .. } = self;
        sleep.record(dt, bodies, &equations.wrenches.given);
        let changing = equations.system.is_stabilising() || contacts.clutches().slipping().next().is_some();
        if changing || !sleep.fall_asleep(extent, contacts.resting_bodies()) {
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

    /// Wakes bodies whose external wrench or state has changed since they fell asleep.
    pub(super) fn wake_pushed_bodies(&mut self) {
        while let Some(body) = self.sleep.disturbed(&self.bodies, &self.before, &self.equations.wrenches.given) {
            self.wake(body);
        }
    }

    /// Wakes a body with its island.
    pub(super) fn wake(&mut self, body: usize) {
        if self.sleep.wake(body, self.contacts.resting_bodies()) {
            self.publish_sleep();
        }
    }

    /// Wakes all bodies.
    pub(super) fn wake_all(&mut self) {
        if self.sleep.wake_all() {
            self.publish_sleep();
        }
    }

    /// Wakes all bodies that an impact acts on.
    pub(super) fn wake_for(&mut self, impact: &EarliestImpact) {
        while self.sleep.any()
            && let Some(body) = self.contacts.sleeper_near_impact(impact, &self.bodies)
        {
            self.wake(body);
        }
    }

    /// Passes on which bodies sleep to joints, springs and contacts.
    fn publish_sleep(&mut self) {
        let asleep = self.sleep.asleep();
        self.equations.system.let_sleep(asleep, &self.bodies);
        self.equations.springs.set_asleep(asleep);
        self.contacts.set_asleep(asleep, &self.bodies);
        self.integration.interrupt();
        self.equations.evaluated = Evaluated::Nothing;
    }
}

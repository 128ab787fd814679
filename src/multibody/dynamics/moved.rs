//! A figure that something else than the laws moves for a step: what such a mover needs, and what is put in order around
//! it. Windows, triggers, springs, turns and bad numbers go on as in a step of the laws, so that either kind of step may
//! follow the other.

use super::{Drive, Dynamics, Impact, Known};
use crate::articulation::System;
use crate::dynamics::Contacts;
use soffio_geometry::bodies::RigidBody;
use soffio_math::DVec3;
use soffio_math::lanes::One;
use soffio_math::spatial::Vec6;

use super::State;

/// A figure at the beginning of a step, in a mover's hands.
pub struct Moved<'a> {
    /// To be left where the step ends, with their velocities.
    pub bodies: &'a mut [RigidBody],
    /// The joints; shares are those of the step's middle.
    pub system: &'a mut System,
    /// What can touch, and the limits.
    pub contacts: &'a mut Contacts,
    /// Bodies that follow a given motion.
    pub drives: &'a [Drive],
    /// From outside and from springs, N and N m about each centre of mass.
    pub wrenches: &'a [Vec6],
    /// World acceleration, m/s².
    pub gravity: DVec3,
    /// Time constant in which what is open is drawn together, s.
    pub stabilization_time: f64,
    /// When the step ends, seconds since reset.
    pub until: f64,
    /// Did the share of any constraint change since the last step?
    pub changed: bool,
    /// What the mover has to tell.
    pub impacts: &'a mut Vec<Impact>,
}

impl Dynamics {
    /// A step of `dt` seconds by another mover, under wrenches from outside (N and N m about each centre of mass). Hits
    /// are appended to `impacts`. Returns the bodies that had to be restored from bad numbers.
    pub fn step_by(
        &mut self,
        dt: f64,
        external: &[Vec6],
        impacts: &mut Vec<Impact>,
        mover: impl FnOnce(Moved),
    ) -> usize {
        self.fault = None;
        self.wake_all();
        let bad = self.restore_bad_bodies();
        self.sane = false;
        for (before, body) in self.before_step.iter_mut().zip(&self.bodies) {
            *before = State::of(One(0), |_| body);
        }
        self.dt = dt;
        self.contacts.begin_step(self.time);
        self.begin_happenings();
        self.substeps = 1;
        let middle = self.time + 0.5 * dt;
        let changed = self.system.activity.set_shares(middle) | self.springs.activity.set_shares(middle);
        self.external.copy_from_slice(external);
        self.springs.push(&self.bodies, self.time, &mut self.external);
        let already = impacts.len();
        if let Some(plain) = &mut self.plain {
            plain.exchange_run(&mut self.system);
        }
        mover(Moved {
            bodies: &mut self.bodies,
            system: self.plain.as_deref_mut().unwrap_or(&mut self.system),
            contacts: &mut self.contacts,
            drives: &self.drives,
            wrenches: &self.external,
            gravity: self.settings.gravity,
            stabilization_time: self.settings.stabilization_time,
            until: self.time + dt,
            changed,
            impacts,
        });
        if let Some(plain) = &mut self.plain {
            plain.exchange_run(&mut self.system);
        }
        self.springs.break_overloaded(&self.bodies, self.time + dt);
        let lost = self.end_step(dt, already, impacts);
        // The laws start anew from here.
        self.system.begin_trains(&self.bodies);
        self.contacts.forget(&self.bodies);
        self.loads.fill(0.0);
        self.run.end();
        (self.fourth_step, self.stride) = (None, f64::INFINITY);
        self.known = Known::Nothing;
        bad + lost
    }

    /// Fires what waited for the step's hits, lets time go on and puts back what broke down: so many bodies.
    pub(super) fn end_step(&mut self, dt: f64, already: usize, impacts: &mut Vec<Impact>) -> usize {
        for impact in &impacts[already..] {
            for body in impact.bodies.into_iter().flatten() {
                self.system.activity.hit(body, impact.impulse, self.time + impact.time);
                self.springs.activity.hit(body, impact.impulse, self.time + impact.time);
            }
        }
        self.time += dt;
        let lost = self.restore_bad_bodies();
        if lost > 0 {
            // What went wrong did not happen.
            impacts.truncate(already);
        }
        self.system.count_turns(&self.bodies);
        self.springs.count_turns(&self.bodies);
        lost
    }
}

//! A figure that something else than the laws moves for a step: what such a mover needs, and what is put in order around
//! it. Windows, triggers, springs, turns and bad numbers go on as in a step of the laws, so that either kind of step may
//! follow the other.

use super::contacts::{Contacts, Impact};
use super::kinematic::KinematicBody;
use super::step::Dynamics;
use crate::articulation::System;
use soffio_geometry::bodies::RigidBody;
use soffio_math::DVec3;
use soffio_math::spatial::Vec6;

/// A figure at the beginning of a step, in a mover's hands.
pub struct PositionStep<'a> {
    /// To be left where the step ends, with their velocities.
    pub bodies: &'a mut [RigidBody],
    /// The joints; shares are those of the step's middle.
    pub system: &'a mut System,
    /// What can touch, and the limits.
    pub contacts: &'a mut Contacts,
    /// Bodies that follow a given motion.
    pub kinematic_bodies: &'a [KinematicBody],
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
    /// are appended to `impacts`. Returns the first body with bad numbers, before or after, because of which the figure was put
    /// back.
    pub fn position_step(
        &mut self,
        dt: f64,
        external: &[Vec6],
        impacts: &mut Vec<Impact>,
        mover: impl FnOnce(PositionStep),
    ) -> Option<usize> {
        self.wake_all();
        let bad = self.recover_bad_bodies();
        self.begin_step(dt);
        self.substeps = 1;
        let middle = self.time + 0.5 * dt;
        let equations = &mut self.equations;
        let changed = equations.system.activity.set_shares(middle) | equations.springs.activity.set_shares(middle);
        equations.wrenches.total.copy_from_slice(external);
        equations.springs.push(&self.bodies, self.time, &mut equations.wrenches.total);
        let already = impacts.len();
        if let Some(without_trains) = &mut equations.without_trains {
            without_trains.exchange_run(&mut equations.system);
        }
        mover(PositionStep {
            bodies: &mut self.bodies,
            system: equations.without_trains.as_deref_mut().unwrap_or(&mut equations.system),
            contacts: &mut self.contacts,
            kinematic_bodies: &equations.kinematic_bodies,
            wrenches: &equations.wrenches.total,
            gravity: self.settings.gravity,
            stabilization_time: self.settings.stabilization_time,
            until: self.time + dt,
            changed,
            impacts,
        });
        if let Some(without_trains) = &mut equations.without_trains {
            without_trains.exchange_run(&mut equations.system);
        }
        equations.springs.break_overloaded(&self.bodies, self.time + dt);
        let lost = self.end_step(dt, already, impacts);
        self.restart();
        bad.or(lost)
    }
}

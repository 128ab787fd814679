//! Position-based steps: steps that a position-based mover integrates instead of constrained dynamics.
//!
//! Activation windows, triggers, springs, full turns and recovery work as in a step of constrained dynamics, so either kind of step
//! may follow the other. So does sleep, of all bodies together: while one is awake, a mover moves them all.

use super::contacts::{Contacts, Impact};
use super::kinematic::KinematicBody;
use super::sleep::Extent;
use super::step::Dynamics;
use crate::articulation::System;
use soffio_geometry::bodies::RigidBody;
use soffio_math::DVec3;
use soffio_math::spatial::Vec6;

/// An articulation at the beginning of a position-based step.
pub struct PositionStep<'a> {
    /// The bodies; the mover sets their poses and velocities at the end of the step.
    pub bodies: &'a mut [RigidBody],
    /// The joints, with their activation in the middle of the step.
    pub system: &'a mut System,
    /// State of contacts and joint limits.
    pub contacts: &'a mut Contacts,
    /// Kinematic bodies, which the mover moves too.
    pub kinematic_bodies: &'a [KinematicBody],
    /// External wrenches and those of springs, N and N m about each centre of mass.
    pub wrenches: &'a [Vec6],
    /// World acceleration, m/s².
    pub gravity: DVec3,
    /// Time constant in which open joints close, s.
    pub stabilization_time: f64,
    /// End of the step, seconds since reset.
    pub end_time: f64,
    /// The activation of some constraint has changed since the last step.
    pub activation_changed: bool,
    /// The mover appends its impacts.
    pub impacts: &'a mut Vec<Impact>,
}

impl Dynamics {
    /// Advances by `dt` seconds by a position-based mover, under external wrenches (N and N m about each centre of mass). Appends the
    /// impacts to `impacts`. Where all bodies sleep, the mover does not run, unless `led`: then it moves bodies by more than forces,
    /// as a hand does. Returns the first body with invalid numbers, before or after, because of which all bodies were put back.
    pub fn position_step(
        &mut self,
        dt: f64,
        external: &[Vec6],
        led: bool,
        impacts: &mut Vec<Impact>,
        mover: impl FnOnce(PositionStep),
    ) -> Option<usize> {
        let invalid = self.recover();
        self.equations.wrenches.given.copy_from_slice(external);
        self.wake_pushed_bodies();
        self.begin_step(dt);
        let middle = self.time + 0.5 * dt;
        let equations = &mut self.equations;
        let activation_changed = equations.system.activity.update_activations(middle)
            | equations.springs.activity.update_activations(middle);
        if self.sleep.all() && !led && !activation_changed {
            return invalid.or(self.end_step(dt, impacts.len(), impacts));
        }
        if self.sleep.any() {
            self.wake_all();
        }
        self.substeps = 1;
        let equations = &mut self.equations;
        equations.wrenches.total.copy_from_slice(external);
        equations.springs.add_forces(&self.bodies, self.time, &mut equations.wrenches.total);
        let already = impacts.len();
        if let Some(without_trains) = &mut equations.without_trains {
            without_trains.swap_history(&mut equations.system);
        }
        mover(PositionStep {
            bodies: &mut self.bodies,
            system: equations.without_trains.as_deref_mut().unwrap_or(&mut equations.system),
            contacts: &mut self.contacts,
            kinematic_bodies: &equations.kinematic_bodies,
            wrenches: &equations.wrenches.total,
            gravity: self.settings.gravity,
            stabilization_time: self.settings.stabilization_time,
            end_time: self.time + dt,
            activation_changed,
            impacts,
        });
        if let Some(without_trains) = &mut equations.without_trains {
            without_trains.swap_history(&mut equations.system);
        }
        equations.springs.break_overloaded(&self.bodies, self.time + dt);
        let lost = self.end_step(dt, already, impacts);
        self.restart();
        self.fall_asleep(dt, Extent::All);
        invalid.or(lost)
    }
}

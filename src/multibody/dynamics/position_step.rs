//! Position-based steps: steps that a position-based mover integrates instead of constrained dynamics.
//!
//! Activation windows, triggers, springs, full turns and recovery work as in a step of constrained dynamics, so either kind of step
//! may follow the other.

use super::contacts::{Contacts, Impact};
use super::kinematic::KinematicBody;
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
    /// impacts to `impacts`. Returns the first body with invalid numbers, before or after, because of which all bodies were put back.
    pub fn position_step(
        &mut self,
        dt: f64,
        external: &[Vec6],
        impacts: &mut Vec<Impact>,
        mover: impl FnOnce(PositionStep),
    ) -> Option<usize> {
        self.wake_all();
        let invalid = self.recover();
        self.begin_step(dt);
        self.substeps = 1;
        let middle = self.time + 0.5 * dt;
        let equations = &mut self.equations;
        let activation_changed = equations.system.activity.update_activations(middle)
            | equations.springs.activity.update_activations(middle);
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
        invalid.or(lost)
    }
}

//! What a figure tells of its last step and of where it stands.

use super::contacts::{ContactReport, Contacts};
use super::forces::{self, Damping};
use super::kinematic::KinematicBody;
use super::step::Dynamics;
use crate::articulation::{Break, System};

impl Dynamics {
    /// Constraints that broke in the last step.
    pub fn breaks(&self) -> &[Break] {
        &self.equations.system.activity.breaks
    }

    /// Springs that broke in the last step.
    pub fn spring_breaks(&self) -> &[Break] {
        &self.equations.springs.activity.breaks
    }

    /// Constraints whose triggers fired in the last step, and when (seconds since reset).
    pub fn fired(&self) -> &[(usize, f64)] {
        &self.equations.system.activity.fired
    }

    /// The same of springs.
    pub fn springs_fired(&self) -> &[(usize, f64)] {
        &self.equations.springs.activity.fired
    }

    /// Seconds since reset.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// Damping of a body.
    pub fn damping(&self, body: usize) -> Damping {
        self.equations.damping(body)
    }

    /// Bodies that follow a given motion.
    pub fn kinematic_bodies(&self) -> &[KinematicBody] {
        &self.equations.kinematic_bodies
    }

    /// What can touch, and the limits.
    pub fn contacts(&self) -> &Contacts {
        &self.contacts
    }

    /// The joints' system, for reports.
    pub fn system(&self) -> &System {
        &self.equations.system
    }

    /// The same row by row: what a mover by places is given.
    pub fn system_without_trains(&self) -> &System {
        self.equations.without_trains.as_deref().unwrap_or(&self.equations.system)
    }

    /// Largest distance between the two points of any joint now, m.
    pub fn joint_error(&self) -> f64 {
        self.equations.system.largest_gap(&self.bodies)
    }

    /// The force that the joint of each constraint carried when it was last asked, in the last substep, all lengths between its
    /// two bodies together, N; `None` for what no joint holds, such as couplings. Of joints of trains it is 0: nobody asks.
    pub fn joint_loads(&self) -> Vec<Option<f64>> {
        let mut loads = vec![None; self.equations.system.constraints().len()];
        for (joint, load) in self.equations.system.joints().iter().zip(self.loads.all()) {
            joint.constraints.iter().for_each(|&constraint| loads[constraint] = Some(*load));
        }
        loads
    }

    /// Kinetic and potential energy, J.
    pub fn energy(&self) -> f64 {
        forces::energy(&self.bodies, self.settings.gravity) + self.equations.springs.energy(&self.bodies, self.time)
    }

    /// Work of all hits, resting contacts and limits since the start, J: what friction and bounce lost, negative.
    pub fn contact_work(&self) -> f64 {
        self.contacts.work()
    }

    /// Surfaces that press on each other at the end of the last step.
    pub fn contact_reports(&self) -> impl Iterator<Item = ContactReport> + '_ {
        self.contacts.contact_reports(&self.bodies)
    }

    /// Pairs of colliders that the last step measured: those whose swept boxes overlapped, once a substep each.
    pub fn measured_pairs(&self) -> usize {
        self.contacts.measured()
    }

    /// Substeps of the last step.
    pub fn substeps(&self) -> u32 {
        self.substeps
    }

    /// Operations of the last step, about: the same on every machine (`budget.rs`).
    pub fn operations(&self) -> u64 {
        self.budget.spent()
    }
}

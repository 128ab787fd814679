//! Queries of the present state and of the last step.

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

    /// Constraints whose triggers fired in the last step, each with the time, seconds since reset.
    pub fn fired(&self) -> &[(usize, f64)] {
        &self.equations.system.activity.fired
    }

    /// Springs whose triggers fired in the last step, each with the time, seconds since reset.
    pub fn springs_fired(&self) -> &[(usize, f64)] {
        &self.equations.springs.activity.fired
    }

    /// Seconds since reset.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// Damping rates of a body.
    pub fn damping(&self, body: usize) -> Damping {
        self.equations.damping(body)
    }

    /// Bodies whose motion is given.
    pub fn kinematic_bodies(&self) -> &[KinematicBody] {
        &self.equations.kinematic_bodies
    }

    /// Surfaces, limits and clutches.
    pub fn contacts(&self) -> &Contacts {
        &self.contacts
    }

    /// The joints' system.
    pub fn system(&self) -> &System {
        &self.equations.system
    }

    /// The joints' system with trains as single joints, as position-based motion uses it.
    pub fn system_without_trains(&self) -> &System {
        self.equations.without_trains.as_deref().unwrap_or(&self.equations.system)
    }

    /// Largest distance between the two points of any joint, m.
    pub fn joint_error(&self) -> f64 {
        self.equations.system.largest_gap(&self.bodies)
    }

    /// Force of the joint of each constraint when last evaluated in the last substep, N: all constraints between the same two
    /// bodies have one joint. `None` for couplings; 0 for joints of trains.
    pub fn joint_loads(&self) -> Vec<Option<f64>> {
        let mut loads = vec![None; self.equations.system.constraints().len()];
        for (joint, load) in self.equations.system.joints().iter().zip(self.loads.all()) {
            joint.constraints.iter().for_each(|&constraint| loads[constraint] = Some(*load));
        }
        loads
    }

    /// Force of the joint of a constraint when last evaluated, N, as [`Self::joint_loads`] has it; 0 for couplings and trains.
    pub fn joint_load(&self, constraint: usize) -> f64 {
        let joints = self.equations.system.joints().iter().zip(self.loads.all());
        joints.filter(|(joint, _)| joint.constraints.contains(&constraint)).map(|(_, load)| *load).sum()
    }

    /// Pull of a spring, N, or its torque, N m: positive where it shortens.
    pub fn spring_pull(&self, spring: usize) -> f64 {
        self.equations.springs.pull(spring, &self.bodies, self.time)
    }

    /// Kinetic and potential energy, springs included, J.
    pub fn energy(&self) -> f64 {
        forces::mechanical_energy(&self.bodies, self.settings.gravity)
            + self.equations.springs.energy(&self.bodies, self.time)
    }

    /// Work of all impacts, resting contacts and limits since the start, J; losses make it negative.
    pub fn contact_work(&self) -> f64 {
        self.contacts.work()
    }

    /// Contact points with a force at the end of the last step.
    pub fn contact_reports(&self) -> impl Iterator<Item = ContactReport> + '_ {
        self.contacts.contact_reports(&self.bodies)
    }

    /// Number of pairs of colliders whose distance the narrow phase computed in the last step. A pair counts once in each
    /// substep that measures it.
    pub fn measured_pairs(&self) -> usize {
        self.contacts.measured()
    }

    /// Number of substeps of the last step.
    pub fn substeps(&self) -> u32 {
        self.substeps
    }

    /// Operations of the last step, about; the same on every machine (`work_budget.rs`).
    pub fn operations(&self) -> u64 {
        self.budget.spent()
    }
}

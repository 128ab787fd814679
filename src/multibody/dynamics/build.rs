//! A figure at its start.

use super::contacts::Contacts;
use super::equations::Equations;
use super::forces::{Damping, Springs};
use super::integrate::Integration;
use super::joint_loads::JointLoads;
use super::recovery::Recovery;
use super::settings::{Articulation, Integrator, Settings, Solver};
use super::sleep::Sleep;
use super::step::Dynamics;
use super::work_budget::WorkBudget;
use crate::articulation::System;

/// Figures of at most this many bodies, without anything to hit, are integrated precisely where nothing else is asked:
/// it costs a microsecond or two.
const FEW: usize = 8;

impl Dynamics {
    /// A figure at its start.
    pub fn new(figure: Articulation, settings: Settings) -> Self {
        let n = figure.bodies.len();
        let mut is_kinematic = vec![false; n];
        for drive in figure.kinematic_bodies {
            is_kinematic[drive.body] = true;
        }
        let mut bodies = figure.bodies;
        for drive in figure.kinematic_bodies {
            drive.motion.at(0.0).place(&mut bodies[drive.body]);
        }
        let mut system = System::new(&bodies, &is_kinematic, figure.constraints, settings.solver);
        let without_trains = system
            .has_trains()
            .then(|| Box::new(System::without_trains(&bodies, &is_kinematic, figure.constraints, settings.solver)));
        system.evaluate(&bodies);
        let joints = (system.states().len(), settings.stabilization_time);
        let mut contacts = Contacts::new(
            figure.colliders,
            figure.pairs,
            (figure.limits, figure.constraints),
            (&bodies, &is_kinematic),
            joints,
        );
        contacts.find_resting_contacts(&bodies);
        let precise = match settings.integrator {
            Integrator::Auto => n <= FEW && contacts.is_empty(),
            Integrator::Precise => true,
            Integrator::Fast | Integrator::RungeKutta => false,
        };
        // The other methods are there to be measured by.
        let sleeps = !precise && settings.integrator != Integrator::Fast && settings.solver == Solver::Sparse;
        let ties = (figure.constraints, figure.limits, figure.springs);
        let damping = if settings.friction { figure.damping } else { vec![Damping::default(); n] };
        let springs = Springs::new(figure.springs, &bodies);
        let laws = (settings.gravity, settings.stabilization_time);
        Self {
            loads: JointLoads::new(&system, &bodies, figure.constraints, settings.friction),
            integration: Integration::new(settings.integrator, precise, n, system.quads().members().len()),
            equations: Equations::new((system, without_trains), springs, figure.kinematic_bodies, &damping, laws),
            contacts,
            budget: WorkBudget::default(),
            sleep: Sleep::new(&bodies, &is_kinematic, ties, sleeps),
            before: bodies.clone(),
            recovery: Recovery::new(n),
            settings,
            time: 0.0,
            breath: [0.0; 2],
            substeps: 0,
            bodies,
        }
    }
}

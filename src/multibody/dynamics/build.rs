//! Construction of [`Dynamics`].

use super::contacts::{ContactSetup, Contacts, Stabilization};
use super::equations::{EquationSetup, Equations};
use super::forces::{Damping, Springs};
use super::integrate::Integration;
use super::joint_loads::JointLoads;
use super::recovery::Recovery;
use super::settings::{Articulation, Integrator, Settings, Solver};
use super::sleep::{Connections, Sleep};
use super::step::{BreathSpeed, Dynamics};
use super::work_budget::WorkBudget;
use crate::articulation::System;

/// [`Integrator::Auto`] integrates articulations of at most this many bodies by Gauss–Legendre's method, if they have no contacts:
/// that costs a microsecond or two.
const FEW: usize = 8;

impl Dynamics {
    /// An articulation in its start state.
    pub fn new(articulation: Articulation, settings: Settings) -> Self {
        let n = articulation.bodies.len();
        let mut is_kinematic = vec![false; n];
        for kinematic in articulation.kinematic_bodies {
            is_kinematic[kinematic.body] = true;
        }
        let mut bodies = articulation.bodies;
        for kinematic in articulation.kinematic_bodies {
            kinematic.motion.at(0.0).place(&mut bodies[kinematic.body]);
        }
        let mut system = System::new(&bodies, &is_kinematic, articulation.constraints, settings.solver);
        let without_trains = system.has_trains().then(|| {
            Box::new(System::without_trains(&bodies, &is_kinematic, articulation.constraints, settings.solver))
        });
        system.evaluate(&bodies);
        let mut contacts = Contacts::new(ContactSetup {
            colliders: articulation.colliders,
            pairs: articulation.pairs,
            limits: articulation.limits,
            constraints: articulation.constraints,
            bodies: &bodies,
            is_kinematic: &is_kinematic,
            stabilization: Stabilization { rows: system.states().len(), time: settings.stabilization_time },
        });
        contacts.find_resting_contacts(&bodies);
        let precise = match settings.integrator {
            Integrator::Auto => n <= FEW && contacts.is_empty(),
            Integrator::Precise => true,
            Integrator::Fast | Integrator::RungeKutta => false,
        };
        // The other methods are references for tests.
        let may_sleep = !precise && settings.integrator != Integrator::Fast && settings.solver == Solver::Sparse;
        let connections = Connections {
            constraints: articulation.constraints,
            limits: articulation.limits,
            springs: articulation.springs,
        };
        let damping = if settings.friction { articulation.damping } else { vec![Damping::default(); n] };
        let springs = Springs::new(articulation.springs, &bodies);
        let lane_blocks = system.lane_blocks().block_bodies().len();
        Self {
            loads: JointLoads::new(&system, &bodies, articulation.constraints, settings.friction),
            integration: Integration::new(settings.integrator, precise, n, lane_blocks),
            equations: Equations::new(EquationSetup {
                system,
                without_trains,
                springs,
                kinematic_bodies: articulation.kinematic_bodies,
                damping: &damping,
                gravity: settings.gravity,
                stabilization_time: settings.stabilization_time,
            }),
            contacts,
            budget: WorkBudget::default(),
            sleep: Sleep::new(&bodies, &is_kinematic, connections, may_sleep),
            before: bodies.clone(),
            recovery: Recovery::new(n),
            settings,
            time: 0.0,
            breath: BreathSpeed::default(),
            substeps: 0,
            bodies,
        }
    }
}

//! Procedural motion: the source's rule against hand calculation, whole mechanisms against an exact solve, drags, limits,
//! touch, and the change from one kind of motion to the other.

mod chains;
mod contact_response;
mod grabs;
mod mechanisms;
mod swings;
mod two_body_rule;

use soffio_geometry::bodies::RigidBody;
use soffio_math::DVec3;
use soffio_multibody::articulation::{Constraint, Limit};
use soffio_multibody::collision::{Collider, ReachableVolumes, pairs};
use soffio_multibody::dynamics::forces::Damping;
use soffio_multibody::dynamics::{
    Articulation, Dynamics, Integrator, KinematicBody, RollingResistance, Settings as DynamicsSettings, Solver,
    SurfacePair,
};
use soffio_multibody::procedural::{GrabTarget, PositionSolver, Procedural, Settings};

use crate::motion::World;

pub const METHODS: [PositionSolver; 2] = [PositionSolver::Relaxation, PositionSolver::TreeSolve];

/// A mechanism in a mover's hands.
pub struct Hand {
    pub dynamics: Dynamics,
    pub procedural: Procedural,
    pub impacts: Vec<soffio_multibody::dynamics::Impact>,
}

/// What a mechanism is made of beside a world's bodies, joints and drives.
#[derive(Default)]
pub struct Extras {
    pub limits: Vec<Limit>,
    pub colliders: Vec<Collider>,
    pub restitution: f64,
    pub friction: f64,
    pub resistance: RollingResistance,
}

impl Hand {
    pub fn new(world: &World, method: PositionSolver) -> Self {
        Self::with(world, &Extras::default(), Settings { method, ..Settings::default() })
    }

    pub fn with(world: &World, extras: &Extras, settings: Settings) -> Self {
        let dynamics = dynamics_of(world, extras);
        let procedural = Procedural::new(&dynamics, settings);
        Self { dynamics, procedural, impacts: Vec::new() }
    }

    pub fn step(&mut self, dt: f64, grabs: &[GrabTarget]) {
        let no_wrench = vec![[0.0; 6]; self.dynamics.bodies.len()];
        let bad = self.procedural.step(&mut self.dynamics, dt, &no_wrench, grabs, &mut self.impacts);
        assert_eq!(bad, None, "bad numbers");
    }

    pub fn bodies(&self) -> &[RigidBody] {
        &self.dynamics.bodies
    }
}

/// The same mechanism under constrained dynamics.
pub fn dynamics_of(world: &World, extras: &Extras) -> Dynamics {
    let (constraints, kinematic_bodies): (&[Constraint], &[KinematicBody]) =
        (&world.constraints, &world.kinematic_bodies);
    let Extras { restitution, friction, resistance, .. } = *extras;
    let surface = |pair| SurfacePair { pair, restitution, friction, full_slip: 0.0, resistance };
    let articulation = Articulation {
        bodies: world.bodies.clone(),
        damping: vec![world.damping; world.bodies.len()],
        constraints,
        limits: &extras.limits,
        springs: &world.springs,
        kinematic_bodies,
        pairs: pairs(&extras.colliders, &[], &ReachableVolumes::default()).meet.into_iter().map(surface).collect(),
        colliders: &extras.colliders,
    };
    Dynamics::new(
        articulation,
        DynamicsSettings {
            gravity: world.gravity,
            friction: world.damping != Damping::default(),
            stabilization_time: 0.04,
            integrator: Integrator::RungeKutta,
            solver: Solver::Sparse,
        },
    )
}

/// A chain of rods that hangs from the origin (or floats), each `length` long, of these masses.
pub fn chain(masses: &[f64], length: f64, anchored: bool) -> World {
    let down = |k: usize| DVec3::NEG_Y * (length * k as f64);
    let bodies = masses.iter().enumerate().map(|(k, &mass)| crate::motion::rod(mass, down(k), down(k + 1))).collect();
    let mut world = World::new(bodies);
    if anchored {
        world.pin("nail", 0, None, DVec3::ZERO);
    }
    for k in 1..masses.len() {
        world.pin(&format!("joint-{k}"), k, Some(k - 1), down(k));
    }
    world
}

/// A hand on the end of a rod of [`chain`], at a place.
pub fn end_of(world: &World, body: usize, length: f64, place: DVec3) -> GrabTarget {
    let end = DVec3::NEG_Y * (length * (body + 1) as f64);
    GrabTarget { body, point: world.bodies[body].pose().inverse_point(end), target: place }
}

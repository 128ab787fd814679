//! Constrained equations of motion: accelerations by Lagrange multipliers, and projection of the joints.
//!
//! The state of the bodies is that of the lane blocks of the joints' tree; `bodies` are written where they are needed.

use super::KinematicBody;
use super::forces::{Damping, Springs, Wrenches};
use super::lane_kernels::{AddVelocityChange, ApplyForces, WriteBack, run_kernel};
use crate::articulation::{Constraint, ConstraintKind, System};
use soffio_geometry::bodies::RigidBody;
use soffio_math::lanes::Four;
use soffio_math::spatial::{Vec6, angular, linear};
use soffio_math::{DVec3, Function, Interpolation};

/// Joints open by more than this are projected twice, m or rad: Newton's error is the square of it.
const COARSE: f64 = 1e-7;

/// How much of the joints' system is evaluated at the present state; each includes those before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Evaluated {
    /// Nothing: bodies have moved or joints have changed.
    Nothing,
    /// Rows and factor; not the accelerations, because forces have changed.
    Factor,
    /// The accelerations too.
    Accelerations,
}

/// Which factor of the joints a projection uses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum FactorUse {
    /// A new one, at the present state.
    Refactor,
    /// The last one, of a state that is close to the present one.
    Reuse,
}

/// How the joints are closed.
#[derive(Clone, Copy, Debug)]
pub(super) struct JointClosing {
    /// Which factor the solutions use.
    pub factor: FactorUse,
    /// Are the joints closed in velocity too?
    pub velocities: bool,
}

/// What the equations of motion are made of.
pub(super) struct EquationSetup<'a> {
    /// The joints, evaluated at the start.
    pub system: System,
    /// The same joints with each gear as a row of its own, for position-based motion; `None` where there are no gear trains.
    pub without_trains: Option<Box<System>>,
    /// The springs.
    pub springs: Springs,
    /// Bodies whose motion is given.
    pub kinematic_bodies: &'a [KinematicBody],
    /// Damping of each body.
    pub damping: &'a [Damping],
    /// World acceleration, m/s².
    pub gravity: DVec3,
    /// 1/ω₀ of the stabiliser, s.
    pub stabilization_time: f64,
}

/// The equations of motion of an articulation.
#[derive(Clone)]
pub(super) struct Equations {
    /// The joints.
    pub system: System,
    /// The same joints with each gear as a row of its own, for position-based motion; `None` where there are no gear trains.
    pub without_trains: Option<Box<System>>,
    /// The springs.
    pub springs: Springs,
    /// Bodies whose motion is given.
    pub kinematic_bodies: Vec<KinematicBody>,
    /// Each kinematic body and its acceleration at the time last evaluated.
    kinematic_accelerations: Vec<(usize, Vec6)>,
    /// Linear and angular damping rates by lane blocks, 1/s.
    damping: Vec<[Four; 2]>,
    /// External wrenches of the present step.
    pub wrenches: Wrenches,
    /// Functions of constraints whose rate jumps.
    jumping: Vec<Function>,
    /// World acceleration, m/s².
    gravity: DVec3,
    /// 1/ω₀ of the stabiliser, s.
    stabilization_time: f64,
    /// At which state the rows were evaluated last.
    pub evaluated: Evaluated,
}

/// The function of time in a constraint.
fn function(constraint: &Constraint) -> Option<&Function> {
    match &constraint.kind {
        ConstraintKind::PointOnPlane { offset, .. } => Some(offset),
        ConstraintKind::Orientation { angle, .. } => Some(angle),
        _ => None,
    }
}

/// Does its rate ever jump?
fn jumps(function: &&Function) -> bool {
    matches!(function, Function::Keys { interpolation: Interpolation::Linear, .. })
}

impl Equations {
    /// The equations of motion without external wrenches.
    pub fn new(setup: EquationSetup) -> Self {
        let EquationSetup { system, without_trains, springs, kinematic_bodies, damping, gravity, stabilization_time } =
            setup;
        let of_bodies = |bodies: [usize; soffio_math::lanes::WIDTH]| {
            let damping = bodies.map(|body| damping[body]);
            [Four(damping.map(|rate| rate.linear)), Four(damping.map(|rate| rate.angular))]
        };
        Self {
            damping: system
                .lane_blocks()
                .block_bodies()
                .iter()
                .map(|block_bodies| of_bodies(block_bodies.bodies))
                .collect(),
            kinematic_accelerations: kinematic_bodies.iter().map(|kinematic| (kinematic.body, [0.0; 6])).collect(),
            wrenches: Wrenches::new(damping.len()),
            jumping: system.constraints().iter().filter_map(function).filter(jumps).cloned().collect(),
            system,
            without_trains,
            springs,
            kinematic_bodies: kinematic_bodies.to_vec(),
            gravity,
            stabilization_time,
            evaluated: Evaluated::Nothing,
        }
    }

    /// Damping rates of a body.
    pub fn damping(&self, body: usize) -> Damping {
        let place = self.system.lane_blocks().body_lane(body);
        let [linear, angular] = self.damping[place.lane_block].each_ref().map(|rate| rate.0[place.lane]);
        Damping { linear, angular }
    }

    /// Finds the accelerations at the present state, in the system's `a`, unless they are known.
    pub fn ensure_accelerations(&mut self, bodies: &mut [RigidBody], t: f64) {
        if self.evaluated == Evaluated::Accelerations {
            return;
        }
        self.place_kinematic_bodies(bodies, t);
        if self.evaluated == Evaluated::Nothing {
            self.system.evaluate_without_trains(bodies);
            self.system.classify_rows();
            self.system.factor();
        }
        self.solve_forces(bodies, t);
        self.evaluated = Evaluated::Accelerations;
    }

    /// Finds the accelerations at the lane blocks' present state, with new rows and a new factor.
    pub fn accelerate(&mut self, bodies: &mut [RigidBody], t: f64) {
        self.place_kinematic_bodies(bodies, t);
        self.write_back_if_needed(bodies);
        self.system.evaluate_motion(bodies);
        self.system.factor();
        self.solve_forces(bodies, t);
    }

    /// Finds the accelerations by the present rows and factor.
    pub fn solve_forces(&mut self, bodies: &[RigidBody], t: f64) {
        let kernel = ApplyForces { external: &self.wrenches.total, damping: &self.damping, gravity: self.gravity };
        run_kernel(&mut self.system, kernel);
        self.springs.add_forces(bodies, t, &mut self.system.b);
        for (body, a) in &self.kinematic_accelerations {
            self.system.a[*body] = *a;
        }
        self.system.solve_acceleration(bodies, 1.0 / self.stabilization_time);
    }

    /// First time after `t` (s) at which the velocity of a driver, or the rate of a constraint's function, jumps.
    pub fn next_jump(&self, t: f64) -> f64 {
        let drivers = self.kinematic_bodies.iter().map(|kinematic| kinematic.motion.next_jump(t));
        drivers.chain(self.jumping.iter().map(|function| function.next_jump(t))).fold(f64::INFINITY, f64::min)
    }

    /// Gives the bodies on a driver whose velocity jumps at the time `t` their new velocity: the impulse of least kinetic energy.
    pub fn jump(&mut self, bodies: &mut [RigidBody], t: f64) {
        self.place_kinematic_bodies(bodies, t);
        self.system.evaluate_without_trains(bodies);
        self.system.classify_rows();
        self.system.factor();
        self.system.solve_velocity(bodies);
        self.system.apply_velocity(bodies);
        self.evaluated = Evaluated::Nothing;
    }

    /// Moves kinematic bodies to their states at the time `t`.
    pub fn place_kinematic_bodies(&mut self, bodies: &mut [RigidBody], t: f64) {
        self.system.activity.set_time(t);
        for (kinematic, (body, a)) in self.kinematic_bodies.iter().zip(&mut self.kinematic_accelerations) {
            *a = kinematic.motion.at(t).place(&mut bodies[*body]);
            self.system.lane_blocks_mut().load_body(*body, &bodies[*body]);
        }
    }

    /// Advances bodies and lane blocks by semi-implicit Euler over `h`, by the last accelerations.
    pub fn step_euler(&mut self, bodies: &mut [RigidBody], h: f64) {
        for (body, a) in bodies.iter_mut().zip(&self.system.a) {
            body.velocity += h * linear(a);
            body.angular_velocity += h * angular(a);
            let (displacement, rotation) = (h * body.velocity, h * body.angular_velocity);
            body.displace(displacement, rotation);
        }
        self.system.lane_blocks_mut().load(bodies);
    }

    /// Closes the joints in position and velocity; leaves the system factored there.
    pub fn project(&mut self, bodies: &mut [RigidBody]) {
        self.system.lane_blocks_mut().load(bodies);
        self.close_joints(bodies, JointClosing { factor: FactorUse::Refactor, velocities: true });
        self.evaluated = Evaluated::Factor;
    }

    /// Takes over the state of bodies whose joints are closed, and whose factor is reused.
    pub fn take_over_state(&mut self, bodies: &mut [RigidBody]) {
        self.system.lane_blocks_mut().load(bodies);
        self.evaluate_lane_blocks(bodies);
        self.system.classify_rows();
        self.evaluated = Evaluated::Factor;
    }

    /// Closes the joints at the lane blocks' new state, at the time `t`, and writes the bodies.
    pub fn close_joints_at(&mut self, bodies: &mut [RigidBody], t: f64, closing: JointClosing) {
        self.place_kinematic_bodies(bodies, t);
        self.close_joints(bodies, closing);
    }

    /// Closes the joints at the lane blocks' state, and writes the bodies.
    fn close_joints(&mut self, bodies: &mut [RigidBody], JointClosing { factor, velocities }: JointClosing) {
        self.evaluate_lane_blocks(bodies);
        if factor == FactorUse::Refactor {
            self.system.factor();
        }
        if self.system.states().is_empty() {
            run_kernel(&mut self.system, WriteBack { bodies });
            return;
        }
        self.system.classify_rows();
        let apart = self.system.largest_error_without_trains();
        self.system.solve_displacement();
        self.system.close_lane_blocks();
        if apart > COARSE {
            // Newton's error is the square of the gap.
            self.system.lane_blocks_mut().update_frames();
            self.evaluate_lane_blocks(bodies);
            self.system.factor();
            self.system.solve_displacement();
            self.system.close_lane_blocks();
        }
        if velocities {
            self.system.solve_velocity_lane_blocks(bodies);
            run_kernel(&mut self.system, AddVelocityChange { bodies });
        } else {
            run_kernel(&mut self.system, WriteBack { bodies });
        }
    }

    /// Evaluates the rows at the lane blocks' present state.
    fn evaluate_lane_blocks(&mut self, bodies: &mut [RigidBody]) {
        self.write_back_if_needed(bodies);
        self.system.evaluate_lane_blocks(bodies);
    }

    /// Writes the bodies from the lane blocks, where rows or springs read them.
    fn write_back_if_needed(&mut self, bodies: &mut [RigidBody]) {
        if self.system.reads_bodies() || !self.springs.is_empty() {
            run_kernel(&mut self.system, WriteBack { bodies });
        }
    }

    /// Applies pivot friction over `dt` seconds under these joint loads (N), the joints held.
    pub fn apply_pivot_friction(&mut self, bodies: &mut [RigidBody], loads: &[f64], dt: f64) {
        self.system.evaluate(bodies);
        self.system.add_friction(bodies, loads, dt);
        self.system.factor();
        self.system.solve_velocity(bodies);
        self.system.apply_velocity(bodies);
        self.evaluated = Evaluated::Nothing;
    }

    /// Factors the joints at the bodies' present poses, for impulses.
    pub fn prepare_impulses(&mut self, bodies: &[RigidBody]) {
        self.system.evaluate_without_trains(bodies);
        self.system.factor();
        self.evaluated = Evaluated::Nothing;
    }
}

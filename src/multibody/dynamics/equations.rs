//! The equations of motion of a figure: what accelerations its bodies have at a state, and what closes their joints there.
//!
//! A state is that of the bodies in the quads of the tree; `bodies` follow where they are asked for.

use super::KinematicBody;
use super::forces::{Damping, Springs, Wrenches};
use super::lane_kernels::{AddVelocityChange, ApplyForces, WriteBack, run_kernel};
use crate::articulation::System;
use soffio_geometry::bodies::RigidBody;
use soffio_math::DVec3;
use soffio_math::lanes::Four;
use soffio_math::spatial::{Vec6, angular, linear, vec6};

/// Joints farther apart than this before projection are projected twice, m or rad: the second time from the square of it.
const COARSE: f64 = 1e-7;

/// How much of a figure's system belongs to the present state: each the more after the one before.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Evaluated {
    /// Nothing: bodies have moved, or joints have changed.
    Nothing,
    /// Rows and factor, as a projection or a substep's end leaves them; not the accelerations, since forces have changed.
    Factor,
    /// The accelerations too.
    Accelerations,
}

/// The equations of motion of a figure.
#[derive(Clone)]
pub(super) struct Equations {
    /// The joints.
    pub system: System,
    /// The same joints without trains, for movers by places.
    pub without_trains: Option<Box<System>>,
    pub springs: Springs,
    pub kinematic_bodies: Vec<KinematicBody>,
    /// Body and acceleration of each drive at the time last asked for.
    kinematic_accelerations: Vec<(usize, Vec6)>,
    /// Rates of damping by quads, linear and angular, 1/s.
    damping: Vec<[Four; 2]>,
    pub wrenches: Wrenches,
    /// World acceleration, m/s².
    gravity: DVec3,
    /// 1/ω₀ of the stabiliser, s.
    stabilization_time: f64,
    /// What of the system belongs to the present state.
    pub evaluated: Evaluated,
}

impl Equations {
    /// Those of joints that have been evaluated at the figure's start, under no wrenches yet.
    pub fn new(
        (system, without_trains): (System, Option<Box<System>>),
        springs: Springs,
        kinematic_bodies: &[KinematicBody],
        damping: &[Damping],
        (gravity, stabilization_time): (DVec3, f64),
    ) -> Self {
        let of_bodies = |bodies: [usize; soffio_math::lanes::WIDTH]| {
            let damping = bodies.map(|body| damping[body]);
            [Four(damping.map(|rate| rate.linear)), Four(damping.map(|rate| rate.angular))]
        };
        Self {
            damping: system.quads().members().iter().map(|members| of_bodies(members.bodies)).collect(),
            kinematic_accelerations: kinematic_bodies.iter().map(|drive| (drive.body, [0.0; 6])).collect(),
            wrenches: Wrenches::new(damping.len()),
            system,
            without_trains,
            springs,
            kinematic_bodies: kinematic_bodies.to_vec(),
            gravity,
            stabilization_time,
            evaluated: Evaluated::Nothing,
        }
    }

    /// Damping of a body.
    pub fn damping(&self, body: usize) -> Damping {
        let slot = self.system.quads().slot(body);
        let [linear, angular] = self.damping[slot.quad].each_ref().map(|rate| rate.0[slot.lane]);
        Damping { linear, angular }
    }

    /// Accelerations of the present state into the system's `a`, as far as they are not there already.
    pub fn ensure_accelerations(&mut self, bodies: &mut [RigidBody], t: f64) {
        if self.evaluated == Evaluated::Accelerations {
            return;
        }
        self.place_kinematic_bodies(bodies, t);
        if self.evaluated == Evaluated::Nothing {
            self.system.evaluate_lean(bodies);
            self.system.look_for_gaps();
            self.system.factor();
        }
        self.solve_forces(bodies, t);
        self.evaluated = Evaluated::Accelerations;
    }

    /// Accelerations at the quads' present state, rows and factor made anew.
    pub fn accelerate(&mut self, bodies: &mut [RigidBody], t: f64) {
        self.place_kinematic_bodies(bodies, t);
        self.write_back_if_needed(bodies);
        self.system.evaluate_motion(bodies);
        self.system.factor();
        self.solve_forces(bodies, t);
    }

    /// Accelerations by the rows and the factor at hand.
    pub fn solve_forces(&mut self, bodies: &[RigidBody], t: f64) {
        let push = ApplyForces { external: &self.wrenches.total, damping: &self.damping, gravity: self.gravity };
        run_kernel(&mut self.system, push);
        self.springs.push(bodies, t, &mut self.system.b);
        for (body, a) in &self.kinematic_accelerations {
            self.system.a[*body] = *a;
        }
        self.system.solve_acceleration(bodies, 1.0 / self.stabilization_time);
    }

    /// Puts driven bodies where they belong at the time `t`.
    pub fn place_kinematic_bodies(&mut self, bodies: &mut [RigidBody], t: f64) {
        self.system.activity.set_time(t);
        for (drive, (body, a)) in self.kinematic_bodies.iter().zip(&mut self.kinematic_accelerations) {
            let (acceleration, turn) = drive.motion.at(t).place(&mut bodies[*body]);
            self.system.quads_mut().look_at(*body, &bodies[*body]);
            *a = vec6(acceleration, turn);
        }
    }

    /// Moves bodies and quads by semi-implicit Euler over `h`, by the accelerations found last.
    pub fn step_euler(&mut self, bodies: &mut [RigidBody], h: f64) {
        for (body, a) in bodies.iter_mut().zip(&self.system.a) {
            body.velocity += h * linear(a);
            body.angular_velocity += h * angular(a);
            let (way, turn) = (h * body.velocity, h * body.angular_velocity);
            body.displace(way, turn);
        }
        self.system.quads_mut().look(bodies);
    }

    /// Closes the joints of the bodies in place and speed; leaves the system factored there.
    pub fn project(&mut self, bodies: &mut [RigidBody]) {
        self.system.quads_mut().look(bodies);
        self.close_joints(bodies, true, true);
        self.evaluated = Evaluated::Factor;
    }

    /// Takes over the velocities of bodies whose joints are closed, and factored there.
    pub fn take_over_state(&mut self, bodies: &mut [RigidBody]) {
        self.system.quads_mut().look(bodies);
        self.evaluate_quads(bodies);
        self.system.look_for_gaps();
        self.evaluated = Evaluated::Factor;
    }

    /// Closes the joints at the quads' new state, at the time `t`; in speed where nothing does so afterwards. Not `anew`, the
    /// factor is that of a state which differs by less than a step's error.
    pub fn close(&mut self, bodies: &mut [RigidBody], t: f64, (anew, in_speed): (bool, bool)) {
        self.place_kinematic_bodies(bodies, t);
        self.close_joints(bodies, anew, in_speed);
    }

    /// The same as [`Equations::project`] where the quads are, factored `anew` and `in_speed` too if asked; the bodies follow.
    fn close_joints(&mut self, bodies: &mut [RigidBody], anew: bool, in_speed: bool) {
        self.evaluate_quads(bodies);
        if anew {
            self.system.factor();
        }
        if self.system.states().is_empty() {
            run_kernel(&mut self.system, WriteBack { bodies });
            return;
        }
        self.system.look_for_gaps();
        let apart = self.system.largest_lean_error();
        self.system.solve_displacement();
        self.system.close_quads();
        if apart > COARSE {
            // Newton's error is the square of what was there.
            self.system.quads_mut().turn();
            self.evaluate_quads(bodies);
            self.system.factor();
            self.system.solve_displacement();
            self.system.close_quads();
        }
        if in_speed {
            self.system.solve_velocity_quads(bodies);
            run_kernel(&mut self.system, AddVelocityChange { bodies });
        } else {
            run_kernel(&mut self.system, WriteBack { bodies });
        }
    }

    /// Evaluates the rows at the quads' present state.
    fn evaluate_quads(&mut self, bodies: &mut [RigidBody]) {
        self.write_back_if_needed(bodies);
        self.system.evaluate_quads(bodies);
    }

    fn write_back_if_needed(&mut self, bodies: &mut [RigidBody]) {
        if self.system.asks_bodies() || !self.springs.is_empty() {
            run_kernel(&mut self.system, WriteBack { bodies });
        }
    }

    /// Lets pivot friction act for `dt` seconds under these loads of the joints (N), the joints held.
    pub fn apply_pivot_friction(&mut self, bodies: &mut [RigidBody], loads: &[f64], dt: f64) {
        self.system.evaluate(bodies);
        self.system.add_friction(bodies, loads, dt);
        self.system.factor();
        self.system.solve_velocity(bodies);
        self.system.apply_velocity(bodies);
        self.evaluated = Evaluated::Nothing;
    }

    /// Factors the joints at the present poses, for impulses.
    pub fn prepare_impulses(&mut self, bodies: &[RigidBody]) {
        self.system.evaluate_lean(bodies);
        self.system.factor();
        self.evaluated = Evaluated::Nothing;
    }
}

//! What a figure is made of, and by what rules it moves.

pub use crate::articulation::Method as Solver;
use crate::articulation::{Constraint, Limit, Spring};
use crate::collision::Collider;
use soffio_geometry::bodies::RigidBody;
use soffio_math::DVec3;

use super::contacts::SurfacePair;
use super::forces::Damping;
use super::kinematic::KinematicBody;

/// How time is advanced.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Integrator {
    /// Precise where that costs next to nothing (few bodies, no contact), else Adams' method of fourth order where motion is smooth,
    /// else Runge–Kutta.
    #[default]
    Auto,
    /// Semi-implicit Euler with projection: one solve a step, first order.
    Fast,
    /// The classical fourth-order Runge–Kutta method with projection.
    RungeKutta,
    /// The Gauss–Legendre method of sixth order: energy stays bounded over days.
    Precise,
}

/// What is constant over a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// World acceleration, m/s².
    pub gravity: DVec3,
    /// Pivot friction, damping and losses at impacts; off for tests of conservation.
    pub friction: bool,
    /// 1/ω₀ of the stabiliser, s.
    pub stabilization_time: f64,
    /// How time is advanced.
    pub integrator: Integrator,
    /// Which linear solver finds the multipliers.
    pub solver: Solver,
}

/// Everything a figure needs to move.
pub struct Articulation<'a> {
    /// Bodies in their start state.
    pub bodies: Vec<RigidBody>,
    /// Damping per body.
    pub damping: Vec<Damping>,
    /// Joints.
    pub constraints: &'a [Constraint],
    /// What stays within bounds.
    pub limits: &'a [Limit],
    /// Springs.
    pub springs: &'a [Spring],
    /// Bodies that follow a given motion.
    pub kinematic_bodies: &'a [KinematicBody],
    /// Collision shapes, materials resolved per pair.
    pub colliders: &'a [Collider],
    /// Pairs that can meet and what their surfaces do.
    pub pairs: Vec<SurfacePair>,
}

//! Description of an articulation, and settings of its motion.

pub use crate::articulation::LinearSolver as Solver;
use crate::articulation::{Constraint, Limit, Spring};
use crate::collision::Collider;
use soffio_geometry::bodies::RigidBody;
use soffio_math::DVec3;

use super::contacts::SurfacePair;
use super::forces::Damping;
use super::kinematic::KinematicBody;

/// Numerical integrator.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Integrator {
    /// Gauss–Legendre for a few bodies without contacts, else Adams–Bashforth–Moulton (fourth order) where motion is smooth, else
    /// Runge–Kutta.
    #[default]
    Auto,
    /// Semi-implicit Euler with projection: first order, one solve a step.
    Fast,
    /// Classical Runge–Kutta with projection: fourth order.
    RungeKutta,
    /// Gauss–Legendre with three stages: sixth order; the energy error stays bounded over days.
    Precise,
}

/// Settings that are constant over a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// World acceleration, m/s².
    pub gravity: DVec3,
    /// Pivot friction and damping act; off for tests of conservation.
    pub friction: bool,
    /// 1/ω₀ of the stabiliser, s.
    pub stabilization_time: f64,
    /// Numerical integrator.
    pub integrator: Integrator,
    /// Linear solver of the multipliers.
    pub solver: Solver,
}

/// An articulation: bodies with their joints, limits, springs and surfaces.
pub struct Articulation<'a> {
    /// Bodies in their start state; all indices of bodies refer to this list.
    pub bodies: Vec<RigidBody>,
    /// Damping of each body.
    pub damping: Vec<Damping>,
    /// Constraints: joints, couplings and clutches.
    pub constraints: &'a [Constraint],
    /// Joint limits.
    pub limits: &'a [Limit],
    /// Springs.
    pub springs: &'a [Spring],
    /// Bodies whose motion is given.
    pub kinematic_bodies: &'a [KinematicBody],
    /// Collision shapes.
    pub colliders: &'a [Collider],
    /// Pairs of colliders that can touch, with their coefficients.
    pub pairs: Vec<SurfacePair>,
}

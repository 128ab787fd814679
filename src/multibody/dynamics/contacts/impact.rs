//! What surfaces do to each other, and what a contact did.

use super::contact::RollingResistance;
use crate::collision::Pair;
use soffio_math::DVec3;

/// A pair of colliders and what their surfaces do to each other.
#[derive(Clone, Copy, Debug)]
pub struct SurfacePair {
    /// The colliders.
    pub pair: Pair,
    /// Energetic coefficient of restitution.
    pub restitution: f64,
    /// Coulomb coefficient while sliding.
    pub friction: f64,
    /// Against rolling and spinning on each other.
    pub resistance: RollingResistance,
}

/// What a contact did.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ImpactKind {
    /// A hit that bounces.
    Impact,
    /// The beginning of rest.
    RestingContact,
    /// A limit reached its bound.
    Stop,
}

/// One hit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impact {
    /// Seconds after the beginning of the step.
    pub time: f64,
    /// What it did.
    pub kind: ImpactKind,
    /// The two bodies; `None` is the world.
    pub bodies: [Option<usize>; 2],
    /// Indices of the two colliders; `None` at a limit.
    pub colliders: Option<[usize; 2]>,
    /// World, m.
    pub point: DVec3,
    /// Unit, from the second collider to the first.
    pub normal: DVec3,
    /// N s (N m s at a limit of an angle).
    pub impulse: f64,
    /// Approach speed along the normal, m/s (rad/s at a limit of an angle).
    pub speed: f64,
    /// Effective mass along the normal, joints included, kg (kg m² at a limit of an angle); 0 without a push.
    pub mass: f64,
}

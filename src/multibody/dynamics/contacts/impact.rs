//! Surface pairs and impact events.

use super::contact::RollingResistance;
use crate::collision::ColliderPair;
use soffio_math::DVec3;

/// A pair of colliders that can touch, with the coefficients of their contact.
#[derive(Clone, Copy, Debug)]
pub struct SurfacePair {
    /// Indices of the two colliders.
    pub pair: ColliderPair,
    /// Energetic coefficient of restitution, 0 … 1.
    pub restitution: f64,
    /// Coulomb coefficient of friction.
    pub friction: f64,
    /// Of a tyre: slip over rolling speed from which it slides entirely; 0 where Coulomb's law holds.
    pub full_slip: f64,
    /// Resistance to rolling and spinning.
    pub resistance: RollingResistance,
}

/// The kind of an impact event.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ImpactKind {
    /// An impact that bounces.
    Impact,
    /// The beginning of a resting contact.
    RestingContact,
    /// A joint reached its limit.
    Stop,
}

/// An impact event.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impact {
    /// Seconds after the beginning of the step.
    pub time: f64,
    /// Whether it bounces, begins resting contact, or is at a limit.
    pub kind: ImpactKind,
    /// The two bodies; `None` is the world.
    pub bodies: [Option<usize>; 2],
    /// Indices of the two colliders; `None` at a limit.
    pub colliders: Option<[usize; 2]>,
    /// World point of the impact, m.
    pub point: DVec3,
    /// Unit, from the second collider to the first; zero at a limit.
    pub normal: DVec3,
    /// Magnitude of the impulse, N s (N m s at a limit of an angle).
    pub impulse: f64,
    /// Approach speed along the normal, m/s (rad/s at a limit of an angle).
    pub speed: f64,
    /// Effective mass along the normal, joints included, kg (kg m² at a limit of an angle); 0 without a push.
    pub mass: f64,
}

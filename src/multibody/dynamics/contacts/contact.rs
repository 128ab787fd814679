//! Touches: the points, bounds, couples and clutches that a contact problem solves for.

use super::contact_law::EffectiveInverseMass;
use soffio_math::{DMat3, DVec3};

/// Share of the largest velocities that an impulse makes which is rounding.
pub(super) const ROUNDING: f64 = 1e-13;
/// What is added to K, as a share of its trace, so that it has an inverse where nothing more gives way.
pub(super) const PROXIMAL: f64 = 1e-12;
/// A touch whose effective inverse mass is below this (1/kg) is held by joints and cannot move.
pub(super) const LOCKED: f64 = 1e-9;

/// ω₁: a clutch that slips so fast carries twice its torque, rad/s.
pub(super) const GREASE: f64 = 0.5;

/// What a touch belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Source {
    /// A pair of colliders.
    Pair(usize),
    /// A bound of a limit; beyond all of these, a clutch that slips.
    Bound(usize),
}

/// A touching point or a reached bound.
#[derive(Clone, Copy, Debug)]
pub(super) struct Contact {
    pub source: Source,
    /// World point, m.
    pub point: DVec3,
    /// Unit, from the second collider to the first.
    pub normal: DVec3,
    /// Distance, m; or what is left to the bound, rad or m.
    pub gap: f64,
    /// Coulomb coefficient; a bound has none.
    pub friction: f64,
    /// Least normal velocity t, m/s.
    pub least: f64,
    /// Impulse that has acted already, (n, t, b), N s.
    pub before: DVec3,
    /// Impulse, (n, t, b), N s.
    pub impulse: DVec3,
    /// Impulse that the rounds begin from.
    pub begin: DVec3,
    /// Of a couple: what it resists, and its point.
    pub twist: Option<Twist>,
    /// Of a clutch: what it may carry.
    pub grip: Option<Grip>,
    /// Where the force that it began from acted.
    pub follows: Option<DVec3>,
    /// Its rows in the problem: `first` up to `first + rows`.
    pub first: usize,
    pub rows: usize,
    /// Its parts among the coordinates, from the first to the one after the last.
    pub(super) parts: (usize, usize),
    /// What it answers to its own impulse.
    pub answer: EffectiveInverseMass,
}

impl Contact {
    /// A touch without impulse.
    pub fn new(source: Source, point: DVec3, normal: DVec3, gap: f64, friction: f64) -> Self {
        Self {
            source,
            point,
            normal,
            gap,
            friction,
            least: 0.0,
            before: DVec3::ZERO,
            impulse: DVec3::ZERO,
            begin: DVec3::ZERO,
            twist: None,
            grip: None,
            follows: None,
            first: 0,
            rows: 0,
            parts: (0, 0),
            answer: EffectiveInverseMass::default(),
        }
    }

    /// Is it a point or a bound, which pushes and never pulls?
    pub fn pushes(&self) -> bool {
        self.twist.is_none() && self.grip.is_none()
    }

    /// Effective inverse mass block (n, t, b), 1/kg.
    pub fn k(&self) -> &DMat3 {
        &self.answer.k
    }
}

/// Resistance of two surfaces to turning on each other, by the force that presses them together.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RollingResistance {
    /// b: couple against rolling, at most, over the normal force, m.
    pub rolling: f64,
    /// d: couple against spin about the normal, at most, over the normal force, m.
    pub spinning: f64,
}

impl RollingResistance {
    /// Do the surfaces turn freely on each other?
    pub fn is_none(&self) -> bool {
        *self == Self::default()
    }
}

/// The couple of a point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Twist {
    /// Index of the point's own touch.
    pub of: usize,
    pub resistance: RollingResistance,
}

/// What a clutch that slips may carry.
#[derive(Clone, Copy, Debug)]
pub(super) struct Grip {
    pub clutch: usize,
    /// τ h, N m s.
    pub most: f64,
    /// Would it carry too much if it took hold?
    pub slips: bool,
}

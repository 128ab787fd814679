//! Touches: the points, bounds, couples and clutches that a contact problem solves for.

use soffio_math::{DMat3, DVec3};

/// Share of the largest velocities that an impulse makes which is rounding.
pub(super) const ROUNDING: f64 = 1e-13;
/// ε of the proximal step.
pub(super) const PROXIMAL: f64 = 1e-12;
/// A touch whose effective inverse mass is below this (1/kg) is held by joints and cannot move.
pub(super) const LOCKED: f64 = 1e-9;

/// ω₁: a clutch that slips so fast carries twice its torque, rad/s.
const GREASE: f64 = 0.5;

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
pub(super) struct Touch {
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
    /// Diagonal block of W, inverse of the proximal block, largest tangential stiffness.
    pub(super) k: DMat3,
    pub(super) step: DMat3,
    pub(super) tangential: f64,
    /// Change that a leap asks for.
    pub(super) leap: DVec3,
}

impl Touch {
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
            k: DMat3::ZERO,
            step: DMat3::ZERO,
            tangential: 0.0,
            leap: DVec3::ZERO,
        }
    }

    /// Is it a point or a bound, which pushes and never pulls?
    pub fn pushes(&self) -> bool {
        self.twist.is_none() && self.grip.is_none()
    }

    /// Effective inverse mass block (n, t, b), 1/kg.
    pub fn k(&self) -> &DMat3 {
        &self.k
    }
}

/// Resistance of two surfaces to turning on each other, by the force that presses them together.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Resistance {
    /// b: couple against rolling, at most, over the normal force, m.
    pub rolling: f64,
    /// d: couple against spin about the normal, at most, over the normal force, m.
    pub spinning: f64,
}

impl Resistance {
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
    pub resistance: Resistance,
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

impl Grip {
    /// x of what slips, nothing of what holds.
    pub fn yields(&self) -> f64 {
        if self.slips { GREASE / self.most } else { 0.0 }
    }
}

/// One unknown of a leap: how its touch's impulse changes with it, and which of its velocities it is to correct.
#[derive(Clone, Copy, Debug)]
pub(super) struct Active {
    pub touch: usize,
    pub along: DVec3,
    pub test: DVec3,
}

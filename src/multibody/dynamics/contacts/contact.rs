//! Contacts: the elements that the contact problem finds impulses for.
//!
//! There are four kinds ([`ContactKind`]): a contact point between two surfaces, a bound of a joint limit, the rolling and
//! drilling resistance of a contact point, and a slipping clutch. A fifth takes back a force whose contact is gone.
//!
//! Vectors of a contact are in its frame (n, t, b): the normal, then the two tangents of `math::tangents`. A limit and a
//! clutch have one number, in x.

use super::contact_law::EffectiveInverseMass;
use soffio_math::DVec3;
use std::ops::Range;

/// An impulse that makes less than this share of the largest velocity is rounding.
pub(super) const ROUNDING: f64 = 1e-13;
/// Added to K as a share of its trace, so that K has an inverse where joints hold a direction.
pub(super) const PROXIMAL: f64 = 1e-12;
/// A contact with a smaller effective inverse mass than this (1/kg) is held by joints and cannot move.
pub(super) const LOCKED: f64 = 1e-9;
/// ω₁: a clutch that slips at this angular velocity carries twice its torque, rad/s.
pub(super) const VISCOUS_SLIP: f64 = 0.5;

/// A range of indices: from `start` to the one before `end`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct IndexRange {
    /// First index.
    pub start: usize,
    /// Index after the last one.
    pub end: usize,
}

impl IndexRange {
    /// How many indices there are.
    pub fn len(self) -> usize {
        self.end - self.start
    }

    /// The same as a range of the standard library.
    pub fn range(self) -> Range<usize> {
        self.start..self.end
    }
}

/// What can come into contact: surfaces, or a joint and the bound of its limit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ContactSource {
    /// The surfaces of a pair of colliders, by its index.
    Surfaces(usize),
    /// A bound of a limit, by its index.
    Limit(usize),
}

/// What a contact force belongs to from one substep to the next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ForceSource {
    /// A contact point of this pair of colliders.
    Point(usize),
    /// The rolling resistance of a contact point of this pair.
    Rolling(usize),
    /// This bound of a limit.
    Limit(usize),
    /// This clutch, slipping.
    Clutch(usize),
}

/// The kinds of contacts, each with what it alone has.
#[derive(Clone, Copy, Debug)]
pub(super) enum ContactKind {
    /// A point between two surfaces: three rows.
    Point {
        /// Index of the pair of colliders.
        pair: usize,
        /// Coulomb coefficient.
        friction: f64,
        /// Of a tyre that rolls: slip velocity from which it slides entirely, m/s; else 0.
        full_slip: f64,
    },
    /// A bound of a joint limit: one row.
    Limit {
        /// Index of the bound.
        bound: usize,
    },
    /// Rolling resistance and drilling friction of a contact point: three rows.
    Rolling {
        /// Index of the pair of colliders.
        pair: usize,
        /// Index of the point's own contact, which comes before this one.
        point: usize,
        /// Most couple for a normal force.
        resistance: RollingResistance,
    },
    /// A clutch that slips, or could stick again: one row.
    Clutch {
        /// Index of the clutch.
        clutch: usize,
        /// τ h: the most that it may carry, N m s.
        max_impulse: f64,
        /// It slips; else it is tried as sticking.
        slips: bool,
    },
    /// A force of the last substep whose contact is gone: one row along that force, which the solver unloads.
    Removed {
        /// What the force belonged to.
        source: ForceSource,
    },
}

/// One contact of the problem.
#[derive(Clone, Copy, Debug)]
pub(super) struct Contact {
    /// Kind of the contact, and its law.
    pub kind: ContactKind,
    /// World point of the contact, m.
    pub point: DVec3,
    /// Unit normal, from the second collider to the first; zero where the kind has none.
    pub normal: DVec3,
    /// Distance of the surfaces, m, or from the bound, rad or m; infinite where the kind has none.
    pub gap: f64,
    /// Least allowed velocity along the first row, m/s.
    pub min_velocity: f64,
    /// Coefficient of restitution, of an impact.
    pub restitution: f64,
    /// Impulse that has already acted on the bodies, N s: only the difference from `impulse` is applied.
    pub applied: DVec3,
    /// Impulse of this solution, N s.
    pub impulse: DVec3,
    /// Impulse that the solver starts from, N s.
    pub initial: DVec3,
    /// World point at which this contact's force acted in the step before, m; `None` for a new contact.
    pub previous_point: Option<DVec3>,
    /// Its rows in the problem.
    pub rows: IndexRange,
    /// Its blocks in the reduced coordinates.
    pub blocks: IndexRange,
    /// Response to its own impulse.
    pub inverse_mass: EffectiveInverseMass,
}

impl Contact {
    /// A contact without impulse.
    pub fn new(kind: ContactKind, point: DVec3, normal: DVec3, gap: f64) -> Self {
        Self {
            kind,
            point,
            normal,
            gap,
            min_velocity: 0.0,
            restitution: 0.0,
            applied: DVec3::ZERO,
            impulse: DVec3::ZERO,
            initial: DVec3::ZERO,
            previous_point: None,
            rows: IndexRange::default(),
            blocks: IndexRange::default(),
            inverse_mass: EffectiveInverseMass::default(),
        }
    }

    /// A contact without a gap: bodies are never moved out of it.
    pub fn without_gap(kind: ContactKind, point: DVec3, normal: DVec3) -> Self {
        Self::new(kind, point, normal, f64::INFINITY)
    }

    /// The surfaces or bound of a point or limit; `None` for the other kinds.
    pub fn source(&self) -> Option<ContactSource> {
        match self.kind {
            ContactKind::Point { pair, .. } => Some(ContactSource::Surfaces(pair)),
            ContactKind::Limit { bound } => Some(ContactSource::Limit(bound)),
            _ => None,
        }
    }

    /// What its force belongs to from one substep to the next.
    pub fn force_source(&self) -> ForceSource {
        match self.kind {
            ContactKind::Point { pair, .. } => ForceSource::Point(pair),
            ContactKind::Limit { bound } => ForceSource::Limit(bound),
            ContactKind::Rolling { pair, .. } => ForceSource::Rolling(pair),
            ContactKind::Clutch { clutch, .. } => ForceSource::Clutch(clutch),
            ContactKind::Removed { source } => source,
        }
    }

    /// The pair of colliders, of a contact point.
    pub fn point_pair(&self) -> Option<usize> {
        match self.kind {
            ContactKind::Point { pair, .. } => Some(pair),
            _ => None,
        }
    }

    /// The contact whose normal impulse bounds this one, of a rolling resistance.
    pub fn bounding_point(&self) -> Option<usize> {
        match self.kind {
            ContactKind::Rolling { point, .. } => Some(point),
            _ => None,
        }
    }
}

/// Resistance of two surfaces to rolling and spinning on each other, in proportion to the normal force.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RollingResistance {
    /// b: largest couple against rolling over the normal force, m.
    pub rolling: f64,
    /// d: largest couple against spin about the normal over the normal force, m.
    pub spinning: f64,
}

impl RollingResistance {
    /// Whether the surfaces roll and spin freely.
    pub fn is_none(&self) -> bool {
        *self == Self::default()
    }
}

//! Time of impact by conservative advancement (B. Mirtich, Impulse-based Dynamic Simulation, 1996).
//!
//! Over a short time each body moves its centre along a line and turns about it. While a pair is `gap` apart along
//! the unit normal n, the gap along n closes no faster than
//!
//! ```text
//! −(Δx_a − Δx_b)·n + θ_a R_a + θ_b R_b        (per whole interval)
//! ```
//!
//! with Δx the centres' displacements, θ the rotations and R the farthest point of a collider's core from its centre (its ball turns
//! into itself). Advancing by gap / (that bound) therefore never passes through, however thin the plates or fast the
//! motion. A plane has no farthest point, but only its part near the other body counts: its R is how far the
//! other can be from the plane's centre. At rest it adds nothing, and the bound is exact but for the other's turn.

use super::manifold::ManifoldBuilder;
use super::proximity::Proximity;
use super::shape::Collider;
use soffio_geometry::bodies::RigidBody;
use soffio_math::{DMat3, DQuat, DVec3, Pose, asin};

/// Surfaces nearer than this touch, m. A hundredth of the thinnest sheet in use.
pub const CONTACT_MARGIN: f64 = 2e-6;
/// Rounds of advancement; each closes most of the gap that is left. A grazing pair that needs more is reported
/// where it stands, which is always before contact.
const MAX_ITERATIONS: usize = 48;
/// The normalised lerp turns up to this much faster in its middle than on average (turns up to 1 rad).
const NLERP_RATE: f64 = 1.1;

/// A body's motion over an interval, or its standing still.
#[derive(Clone, Copy, Debug)]
pub struct Sweep {
    /// Centre of mass at the start and its way, m.
    start: DVec3,
    displacement: DVec3,
    from: DQuat,
    to: DQuat,
    /// Centre of mass in the node frame, m.
    center: DVec3,
    /// Bound of the turn, rad.
    rotation_bound: f64,
}

/// Half a box's diagonal, and its farthest corner from the centre of mass at most, m.
#[derive(Clone, Copy, Debug)]
pub(super) struct BoxSize {
    /// Half of the box's diagonal, m.
    pub half: f64,
    /// Largest distance of a corner from the body's centre of mass, m.
    pub bounding_radius: f64,
}

impl Sweep {
    /// A static body.
    pub const STATIC: Self = Self {
        start: DVec3::ZERO,
        displacement: DVec3::ZERO,
        from: DQuat::IDENTITY,
        to: DQuat::IDENTITY,
        center: DVec3::ZERO,
        rotation_bound: 0.0,
    };

    /// From one state of a body to a later one.
    pub fn new(before: &RigidBody, after: &RigidBody) -> Self {
        let to = if before.rotation.dot(after.rotation) < 0.0 { -after.rotation } else { after.rotation };
        let chord = (to - before.rotation).length();
        Self {
            start: before.position,
            displacement: after.position - before.position,
            from: before.rotation,
            to,
            center: before.properties.center,
            rotation_bound: NLERP_RATE * 4.0 * asin((0.5 * chord).min(1.0)),
        }
    }

    /// Node pose at the share `s` of the interval.
    pub fn pose(&self, s: f64) -> Pose {
        let rotation = (self.from * (1.0 - s) + self.to * s).normalize();
        Pose { rotation, position: self.start + s * self.displacement - rotation * self.center }
    }

    /// Poses at the two ends, with their axes.
    pub(super) fn ends(&self) -> [(Pose, DMat3); 2] {
        let at = |center: DVec3, rotation: DQuat| {
            let axes = DMat3::from_quat(rotation);
            (Pose { rotation, position: center - axes * self.center }, axes)
        };
        [at(self.start, self.from), at(self.start + self.displacement, self.to)]
    }

    /// Farthest that a point of a box (node frame, m) strays from the straight way between its two ends: twice the
    /// height of its arc over the chord, as it may be before or behind by as much.
    pub(super) fn arc_deviation(&self, middle: DVec3, half: DVec3) -> f64 {
        0.25 * self.rotation_bound * self.rotation_bound * (middle.distance(self.center) + half.length())
    }

    /// The size of a box of the node frame, which is the same on every way of its body.
    pub(super) fn size(&self, middle: DVec3, half: DVec3) -> BoxSize {
        BoxSize { half: half.length(), bounding_radius: middle.distance(self.center) + half.length() }
    }

    /// Farthest that a point of such a box can be from where it was at the start, m, [`Sweep::arc_deviation`] included.
    pub(super) fn max_deviation(&self, size: &BoxSize) -> f64 {
        self.max_travel(size.bounding_radius) + 0.25 * self.rotation_bound * self.rotation_bound * size.bounding_radius
    }

    /// Where the centre of mass is at the start, m, and how the body is turned.
    pub(super) fn start_pose(&self) -> (DVec3, DQuat) {
        (self.start, self.from)
    }

    /// Farthest that a point at `reach` (m) from the centre of mass can get on this way from where it was at another place, m.
    pub(super) fn max_departure(&self, &(start, from): &(DVec3, DQuat), bounding_radius: f64) -> f64 {
        let chord = (self.from - from).length().min((self.from + from).length());
        (self.start - start).length()
            + 2.0 * chord * bounding_radius
            + self.max_deviation(&BoxSize { half: 0.0, bounding_radius })
    }

    /// Bound of the travel of a point at `bounding_radius` (m) from the centre of mass, m.
    pub fn max_travel(&self, bounding_radius: f64) -> f64 {
        self.displacement.length() + self.rotation_bound * bounding_radius
    }
}

/// When and how two colliders meet.
#[derive(Clone, Copy, Debug)]
pub struct TimeOfImpact {
    /// Share of the interval, 0…1.
    pub s: f64,
    /// How they lie then.
    pub proximity: Proximity,
}

/// A collider in motion.
#[derive(Clone, Copy, Debug)]
pub struct MovingCollider<'a> {
    /// The collider.
    pub collider: &'a Collider,
    /// Motion of its body.
    pub sweep: &'a Sweep,
    /// Farthest point of the collider's core from its body's centre of mass, m ([`Shape::bounding_radius`]); not read for
    /// a plane.
    ///
    /// [`Shape::bounding_radius`]: super::Shape::bounding_radius
    pub bounding_radius: f64,
}

/// Bound of the gap closed by rotation along any direction over the interval, m.
fn rotation_closing(a: &MovingCollider, b: &MovingCollider) -> f64 {
    let (sweep_a, sweep_b) = (a.sweep, b.sweep);
    // Points of a plane count as far out as the other gets, its ball included.
    let apart = || (sweep_a.start - sweep_b.start).length() + (sweep_a.displacement - sweep_b.displacement).length();
    let arm = |own: &MovingCollider, other: &MovingCollider| {
        if own.collider.shape.is_plane() {
            apart() + other.bounding_radius + other.collider.shape.radius
        } else {
            own.bounding_radius
        }
    };
    sweep_a.rotation_bound * arm(a, b) + sweep_b.rotation_bound * arm(b, a)
}

/// First time at which two moving colliders touch, if they do within the interval.
pub fn time_of_impact(builder: &ManifoldBuilder, a: MovingCollider, b: MovingCollider) -> Option<TimeOfImpact> {
    let rotation_closing = rotation_closing(&a, &b);
    let mut s = 0.0;
    for iteration in 0.. {
        let proximity = builder.proximity(a.collider, &a.sweep.pose(s), b.collider, &b.sweep.pose(s));
        if proximity.gap <= CONTACT_MARGIN || iteration == MAX_ITERATIONS {
            return Some(TimeOfImpact { s, proximity });
        }
        let closing = rotation_closing - (a.sweep.displacement - b.sweep.displacement).dot(proximity.normal);
        if closing <= 0.0 {
            return None;
        }
        // Aim inside the contact margin, so that iterations do not creep up to its edge.
        s += (proximity.gap - 0.5 * CONTACT_MARGIN) / closing;
        if s > 1.0 {
            return None;
        }
    }
    None
}

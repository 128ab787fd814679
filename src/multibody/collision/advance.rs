//! Time of impact by conservative advancement (B. Mirtich, Impulse-based Dynamic Simulation, 1996).
//!
//! Over a short time each body moves its centre along a line and turns about it. While a pair is `gap` apart along
//! the unit normal n, the gap along n closes no faster than
//!
//! ```text
//! −(Δx_a − Δx_b)·n + θ_a R_a + θ_b R_b        (per whole interval)
//! ```
//!
//! with Δx the centres' ways, θ the turns and R the farthest point of a collider's core from its centre (its ball turns
//! into itself). Advancing by gap / (that bound) therefore never passes through, however thin the plates or fast the
//! motion. A plane has no farthest point, but only what lies near the other body counts: for it R is how far the
//! other can be from the plane's centre. At rest it adds nothing, and the bound is exact but for the other's turn.

use super::manifold::Corners;
use super::proximity::Proximity;
use super::shape::Collider;
use soffio_geometry::bodies::RigidBody;
use soffio_math::{DMat3, DQuat, DVec3, Pose, asin};

/// Surfaces nearer than this touch, m. A hundredth of the thinnest sheet in use.
pub const TOUCH: f64 = 2e-6;
/// Rounds of advancement; each closes most of the gap that is left. A grazing pair that needs more is reported
/// where it stands, which is always before contact.
const ROUNDS: usize = 48;
/// The normalised lerp turns up to this much faster in its middle than on average (turns up to 1 rad).
const NLERP_RATE: f64 = 1.1;

/// A body's motion over an interval, or its standing still.
#[derive(Clone, Copy, Debug)]
pub struct Sweep {
    /// Centre of mass at the start and its way, m.
    start: DVec3,
    way: DVec3,
    from: DQuat,
    to: DQuat,
    /// Centre of mass in the node frame, m.
    center: DVec3,
    /// Bound of the turn, rad.
    turn: f64,
}

/// Half a box's diagonal, and its farthest corner from the centre of mass at most, m.
#[derive(Clone, Copy, Debug)]
pub(super) struct Size {
    pub half: f64,
    pub reach: f64,
}

impl Sweep {
    /// What stands still.
    pub const STILL: Self = Self {
        start: DVec3::ZERO,
        way: DVec3::ZERO,
        from: DQuat::IDENTITY,
        to: DQuat::IDENTITY,
        center: DVec3::ZERO,
        turn: 0.0,
    };

    /// From one state of a body to a later one.
    pub fn new(before: &RigidBody, after: &RigidBody) -> Self {
        let to = if before.rotation.dot(after.rotation) < 0.0 { -after.rotation } else { after.rotation };
        let chord = (to - before.rotation).length();
        Self {
            start: before.position,
            way: after.position - before.position,
            from: before.rotation,
            to,
            center: before.properties.center,
            turn: NLERP_RATE * 4.0 * asin((0.5 * chord).min(1.0)),
        }
    }

    /// Node pose at the share `s` of the interval.
    pub fn pose(&self, s: f64) -> Pose {
        let rotation = (self.from * (1.0 - s) + self.to * s).normalize();
        Pose { rotation, position: self.start + s * self.way - rotation * self.center }
    }

    /// Poses at the two ends, with their axes.
    pub(super) fn ends(&self) -> [(Pose, DMat3); 2] {
        let at = |center: DVec3, rotation: DQuat| {
            let axes = DMat3::from_quat(rotation);
            (Pose { rotation, position: center - axes * self.center }, axes)
        };
        [at(self.start, self.from), at(self.start + self.way, self.to)]
    }

    /// Farthest that a point of a box (node frame, m) strays from the straight way between its two ends: twice the
    /// height of its arc over the chord, as it may be before or behind by as much.
    pub(super) fn sag(&self, middle: DVec3, half: DVec3) -> f64 {
        0.25 * self.turn * self.turn * (middle.distance(self.center) + half.length())
    }

    /// The size of a box of the node frame, which is the same on every way of its body.
    pub(super) fn size(&self, middle: DVec3, half: DVec3) -> Size {
        Size { half: half.length(), reach: middle.distance(self.center) + half.length() }
    }

    /// Farthest that a point of such a box can be from where it was at the start, m, [`Sweep::sag`] included.
    pub(super) fn stray(&self, size: &Size) -> f64 {
        self.travel(size.reach) + 0.25 * self.turn * self.turn * size.reach
    }

    /// Where the centre of mass is at the start, m, and how the body is turned.
    pub(super) fn place(&self) -> (DVec3, DQuat) {
        (self.start, self.from)
    }

    /// Farthest that a point at `reach` (m) from the centre of mass can get on this way from where it was at another place, m.
    pub(super) fn gone_since(&self, &(start, from): &(DVec3, DQuat), reach: f64) -> f64 {
        let chord = (self.from - from).length().min((self.from + from).length());
        (self.start - start).length() + 2.0 * chord * reach + self.stray(&Size { half: 0.0, reach })
    }

    /// Farthest that a point at `reach` (m) from the centre of mass can travel, m.
    pub fn travel(&self, reach: f64) -> f64 {
        self.way.length() + self.turn * reach
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

/// Farthest that turning takes the surfaces of two colliders along any direction, m.
fn turning((a, sweep_a, reach_a): (&Collider, &Sweep, f64), (b, sweep_b, reach_b): (&Collider, &Sweep, f64)) -> f64 {
    // Points of a plane count as far out as the other gets, its ball included.
    let apart = || (sweep_a.start - sweep_b.start).length() + (sweep_a.way - sweep_b.way).length();
    let arm = |own: &Collider, reach: f64, other: &Collider, others: f64| {
        if own.shape.is_plane() { apart() + others + other.shape.radius } else { reach }
    };
    sweep_a.turn * arm(a, reach_a, b, reach_b) + sweep_b.turn * arm(b, reach_b, a, reach_a)
}

/// First time at which two moving colliders touch, if they do within the interval. `reach` is the farthest point of
/// each collider's core from its body's centre of mass, m (`Shape::reach`; for a plane it is not asked).
pub fn time_of_impact(
    corners: &mut Corners,
    (a, sweep_a, reach_a): (&Collider, &Sweep, f64),
    (b, sweep_b, reach_b): (&Collider, &Sweep, f64),
) -> Option<TimeOfImpact> {
    let turning = turning((a, sweep_a, reach_a), (b, sweep_b, reach_b));
    let mut s = 0.0;
    for round in 0.. {
        let proximity = corners.proximity(a, &sweep_a.pose(s), b, &sweep_b.pose(s));
        if proximity.gap <= TOUCH || round == ROUNDS {
            return Some(TimeOfImpact { s, proximity });
        }
        let closing = turning - (sweep_a.way - sweep_b.way).dot(proximity.normal);
        if closing <= 0.0 {
            return None;
        }
        // Aim inside the touching layer, so that rounds do not creep up to its edge.
        s += (proximity.gap - 0.5 * TOUCH) / closing;
        if s > 1.0 {
            return None;
        }
    }
    None
}

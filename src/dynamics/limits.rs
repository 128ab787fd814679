//! Limits: scalar bounds C ≥ 0 on the figure, reached like a contact and held like one.
//!
//! Each limit has one bound or two. A bound knows its value C (rad or m), its row J with Ċ = J v, and whether it
//! rests. With T, N axes of two bodies, p, q points, r, s their arms, e = (p − q)/|p − q|, φ a turn, w a way:
//!
//! ```text
//! tilt       C = max − ∠(T, N)            J = −(0, a), (0, a)             a = N×T/|N×T|: ∠ grows by a·(ω_T − ω_N)
//! range      C = φ − min, max − φ         J = ±(0, axis), ∓(0, axis)
//!            C = w − min, max − w         J = ±(d, r×d), ∓(d, (p − x_d)×d)
//! distance   C = |p − q| − min, max − …   J = ±(e, r×e), ∓(e, s×e)
//! ratchet    C = φ − floor                J as range;   floor = pitch ⌊φ_most/pitch⌋, or φ_most where pitch = 0
//! ```
//!
//! Angles about an axis are told apart from their full turns by following them: each substep turns by less than π.

use crate::articulation::block::vec6;
use crate::articulation::{Anchor, Axis, Limit, LimitKind, Measure};
use crate::bodies::RigidBody;
use crate::collision::{Sweep, TOUCH};
use crate::math::{DQuat, DVec3, PI, Pose, acos, atan2};

use super::contacts::Row;

/// Rounds of the search for the time at which a bound is reached: bisection to a millionth of a substep.
const HALVINGS: usize = 20;
/// Distances and tilts smaller than this have no direction, m and rad.
const NO_DIRECTION: f64 = 1e-9;

/// Which end of a limit a bound is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum End {
    Least,
    Most,
}

/// One bound and its state.
#[derive(Clone, Debug)]
struct Bound {
    limit: usize,
    end: End,
    resting: bool,
    since_hit: f64,
}

/// A measured turn or way.
#[derive(Clone, Debug)]
struct Gauge {
    /// Relative rotation at the start; a way's value there.
    start: DQuat,
    origin: f64,
    /// Value when last followed, and the greatest so far.
    value: f64,
    most: f64,
}

/// All limits of a figure.
#[derive(Clone, Debug)]
pub(super) struct Limits {
    limits: Vec<Limit>,
    gauges: Vec<Option<Gauge>>,
    bounds: Vec<Bound>,
}

/// Poses of the bodies at one time.
trait Poses {
    fn pose(&self, body: usize) -> Pose;
}

impl Poses for &[RigidBody] {
    fn pose(&self, body: usize) -> Pose {
        self[body].pose()
    }
}

impl Poses for (&[Sweep], f64) {
    fn pose(&self, body: usize) -> Pose {
        self.0[body].pose(self.1)
    }
}

fn place(anchor: &Anchor, poses: &impl Poses) -> DVec3 {
    anchor.body.map_or(anchor.point, |body| poses.pose(body).point(anchor.point))
}

fn direction(axis: &Axis, poses: &impl Poses) -> DVec3 {
    axis.body.map_or(axis.direction, |body| poses.pose(body).vector(axis.direction))
}

fn turn(body: Option<usize>, poses: &impl Poses) -> DQuat {
    body.map_or(DQuat::IDENTITY, |body| poses.pose(body).rotation)
}

/// Rotation of a measured body in the frame it is measured against.
fn relative(axis: &Axis, frame: Option<usize>, poses: &impl Poses) -> DQuat {
    turn(frame, poses).conjugate() * turn(axis.body, poses)
}

/// Way of a point along a direction, m, from the direction's own body.
fn way(point: &Anchor, along: &Axis, poses: &impl Poses) -> f64 {
    let origin = along.body.map_or(DVec3::ZERO, |body| poses.pose(body).position);
    (place(point, poses) - origin).dot(direction(along, poses))
}

impl Gauge {
    fn new(measure: &Measure, poses: &impl Poses) -> Self {
        let (start, origin) = match measure {
            Measure::Angle { axis, frame } => (relative(axis, *frame, poses), 0.0),
            Measure::Way { point, direction } => (DQuat::IDENTITY, way(point, direction, poses)),
        };
        Self { start, origin, value: 0.0, most: 0.0 }
    }

    /// The measure's value, nearest to the one last followed.
    fn read(&self, measure: &Measure, poses: &impl Poses) -> f64 {
        match measure {
            Measure::Angle { axis, frame } => {
                // q = q_start⁻¹ q turns about the body's own axis: half its angle from the parts along it.
                let q = self.start.conjugate() * relative(axis, *frame, poses);
                let along = DVec3::new(q.x, q.y, q.z).dot(axis.direction);
                let wrapped = 2.0 * atan2(along, q.w);
                let turns = ((self.value - wrapped) / (2.0 * PI)).round();
                wrapped + 2.0 * PI * turns
            }
            Measure::Way { point, direction } => way(point, direction, poses) - self.origin,
        }
    }
}

impl Limits {
    /// The limits of a figure that starts like this.
    pub fn new(limits: &[Limit], bodies: &[RigidBody]) -> Self {
        let mut bounds = Vec::new();
        for (limit, Limit { kind, .. }) in limits.iter().enumerate() {
            let (least, most) = match *kind {
                LimitKind::Tilt { .. } => (false, true),
                LimitKind::Range { min, max, .. } => (min.is_finite(), max.is_finite()),
                LimitKind::Distance { min, max, .. } => (min > 0.0, max.is_finite()),
                LimitKind::Ratchet { .. } => (true, false),
            };
            for (end, there) in [(End::Least, least), (End::Most, most)] {
                if there {
                    bounds.push(Bound { limit, end, resting: false, since_hit: f64::INFINITY });
                }
            }
        }
        let gauge = |limit: &Limit| match &limit.kind {
            LimitKind::Range { measure, .. } | LimitKind::Ratchet { measure, .. } => Some(Gauge::new(measure, &bodies)),
            _ => None,
        };
        Self { gauges: limits.iter().map(gauge).collect(), limits: limits.to_vec(), bounds }
    }

    /// How many bounds there are.
    pub fn count(&self) -> usize {
        self.bounds.len()
    }

    /// Begins a step of `dt` seconds.
    pub fn begin_step(&mut self, dt: f64) {
        self.bounds.iter_mut().for_each(|bound| bound.since_hit += dt);
    }

    /// Follows turns and ways, and lets pawls fall behind the teeth that have passed.
    pub fn follow(&mut self, bodies: &[RigidBody]) {
        for (limit, gauge) in self.limits.iter().zip(&mut self.gauges) {
            let (Some(gauge), LimitKind::Range { measure, .. } | LimitKind::Ratchet { measure, .. }) =
                (gauge, &limit.kind)
            else {
                continue;
            };
            gauge.value = gauge.read(measure, &bodies);
            gauge.most = gauge.most.max(gauge.value);
        }
    }

    /// Forgets all rest; turns are those nearest to the ones before.
    pub fn forget(&mut self, bodies: &[RigidBody]) {
        self.bounds.iter_mut().for_each(|bound| bound.resting = false);
        self.follow(bodies);
    }

    /// Does a bound rest?
    pub fn resting(&self, bound: usize) -> bool {
        self.bounds[bound].resting
    }

    /// Sets whether a bound rests.
    pub fn set_resting(&mut self, bound: usize, rests: bool) {
        self.bounds[bound].resting = rests;
    }

    /// Seconds since a bound was last hit.
    pub fn since_hit(&mut self, bound: usize) -> &mut f64 {
        &mut self.bounds[bound].since_hit
    }

    /// Coefficient of restitution of a bound.
    pub fn restitution(&self, bound: usize) -> f64 {
        self.limits[self.bounds[bound].limit].restitution
    }

    /// The two bodies of a bound.
    pub fn bodies(&self, bound: usize) -> [Option<usize>; 2] {
        match &self.limits[self.bounds[bound].limit].kind {
            LimitKind::Tilt { a, b, .. } => [a.body, b.body],
            LimitKind::Range { measure, .. } | LimitKind::Ratchet { measure, .. } => measure.bodies().into(),
            LimitKind::Distance { a, b, .. } => [a.body, b.body],
        }
    }

    /// What is left to a bound, rad or m; negative beyond it.
    pub fn gap(&self, bound: usize, bodies: &[RigidBody]) -> f64 {
        self.value(bound, &bodies)
    }

    fn value(&self, bound: usize, poses: &impl Poses) -> f64 {
        let Bound { limit, end, .. } = self.bounds[bound];
        let (value, min, max) = match &self.limits[limit].kind {
            LimitKind::Tilt { a, b, max } => {
                (acos(direction(a, poses).dot(direction(b, poses)).clamp(-1.0, 1.0)), 0.0, *max)
            }
            LimitKind::Range { measure, min, max } => (self.read(limit, measure, poses), *min, *max),
            LimitKind::Distance { a, b, min, max } => ((place(a, poses) - place(b, poses)).length(), *min, *max),
            LimitKind::Ratchet { measure, pitch } => {
                let value = self.read(limit, measure, poses);
                let most = self.gauges[limit].as_ref().map_or(0.0, |gauge| gauge.most).max(value);
                // A tooth counts as passed where it is reached, within rounding.
                let floor = if *pitch > 0.0 { pitch * (most / pitch + NO_DIRECTION).floor() } else { most };
                (value, floor, f64::INFINITY)
            }
        };
        match end {
            End::Least => value - min,
            End::Most => max - value,
        }
    }

    fn read(&self, limit: usize, measure: &Measure, poses: &impl Poses) -> f64 {
        self.gauges[limit].as_ref().map_or(0.0, |gauge| gauge.read(measure, poses))
    }

    /// What is left to a bound, its row, and where it acts.
    pub fn row(&self, bound: usize, bodies: &[RigidBody]) -> (f64, Row, DVec3) {
        let Bound { limit, end, .. } = self.bounds[bound];
        let sign = match end {
            End::Least => 1.0,
            End::Most => -1.0,
        };
        let turning = |[a, b]: [Option<usize>; 2], axis: DVec3| {
            let end = |body: Option<usize>, sign: f64| body.map(|body| (body, vec6(DVec3::ZERO, sign * axis)));
            Row { ends: [end(a, sign), end(b, -sign)] }
        };
        let sliding = |[a, b]: [Option<usize>; 2], at: [DVec3; 2], along: DVec3| {
            let end = |body: Option<usize>, at: DVec3, sign: f64| {
                body.map(|i| (i, vec6(sign * along, (at - bodies[i].position).cross(sign * along))))
            };
            Row { ends: [end(a, at[0], sign), end(b, at[1], -sign)] }
        };
        let two = self.bodies(bound);
        let middle = |body: Option<usize>| body.map_or(DVec3::ZERO, |i| bodies[i].position);
        let (row, point) = match &self.limits[limit].kind {
            LimitKind::Tilt { a, b, .. } => {
                let across = direction(b, &bodies).cross(direction(a, &bodies)).normalize_or_zero();
                (turning(two, across), middle(two[0]))
            }
            LimitKind::Distance { a, b, .. } => {
                let (p, q) = (place(a, &bodies), place(b, &bodies));
                (sliding(two, [p, q], (p - q).normalize_or_zero()), p)
            }
            LimitKind::Range { measure, .. } | LimitKind::Ratchet { measure, .. } => match measure {
                Measure::Angle { axis, .. } => (turning(two, direction(axis, &bodies)), middle(two[0])),
                Measure::Way { point, direction: along } => {
                    // The direction turns with its body, so that body's lever is the point's own.
                    let at = place(point, &bodies);
                    (sliding(two, [at, at], direction(along, &bodies)), at)
                }
            },
        };
        (self.value(bound, &bodies), row, point)
    }

    /// Is a bound reached, and passed at more than `speed`?
    pub fn approaches(&self, bound: usize, bodies: &[RigidBody], layer: f64, speed: f64) -> bool {
        self.value(bound, &bodies) <= layer && self.row(bound, bodies).1.rate(bodies) < -speed
    }

    /// The share of a substep at which a bound is reached.
    pub fn crossing(&self, bound: usize, before: &[RigidBody], after: &[RigidBody], sweeps: &[Sweep]) -> Option<f64> {
        let end = self.value(bound, &after);
        if end > 0.0 {
            return None;
        }
        let start = self.value(bound, &before);
        if start <= TOUCH {
            let rate = |bodies: &[RigidBody]| self.row(bound, bodies).1.rate(bodies);
            if rate(before) < 0.0 {
                return Some(0.0);
            }
            // Opens at first: reached again on the way only if it has come back.
            if end >= start || rate(after) >= 0.0 {
                return None;
            }
        }
        let (mut open, mut closed) = (0.0, 1.0);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (open + closed);
            if self.value(bound, &(sweeps, middle)) > 0.0 { open = middle } else { closed = middle }
        }
        Some(closed)
    }
}

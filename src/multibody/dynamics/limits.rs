//! Joint limits: unilateral constraints C ≥ 0 on an articulation, which act like contacts.
//!
//! Each limit has one bound or two. A bound has a value C (rad or m), a row J with Ċ = J v, and may be in resting contact.
//! With T, N axes of two bodies, p, q points, r, s their arms, e = (p − q)/|p − q|, φ an angle, w a displacement:
//!
//! ```text
//! tilt       C = max − ∠(T, N)            J = −(0, a), (0, a)             a = N×T/|N×T|: ∠ grows by a·(ω_T − ω_N)
//! range      C = φ − min, max − φ         J = ±(0, axis), ∓(0, axis)
//!            C = w − min, max − w         J = ±(d, r×d), ∓(d, (p − x_d)×d)
//! distance   C = |p − q| − min, max − …   J = ±(e, r×e), ∓(e, s×e)
//! ratchet    C = φ − floor                J as range;   floor = pitch ⌊φ_most/pitch⌋, or φ_most where pitch = 0
//! play       C = b/2 ± (c₁ q₁ + c₂ q₂)    J = ±(c₁ J₁ + c₂ J₂)            either flank of a tooth
//! ```
//!
//! Angles and displacements are those of couplings (`rows/coupling.rs`). Full turns are counted by following an angle, which
//! changes by less than π in each substep.

use crate::articulation::rows::coupling::{Gauge, Poses, world_direction, world_point};
use crate::articulation::{Limit, LimitKind, Measure};
use crate::collision::{CONTACT_MARGIN, Sweep};
use soffio_geometry::bodies::RigidBody;
use soffio_math::spatial::vec6;
use soffio_math::{DVec3, Pose, acos};

use super::contacts::JacobianRow;

/// A slower approach than this is rounding, m/s or rad/s.
const ROUNDING: f64 = 1e-15;
/// Bisections for the time at which a bound is reached: to a millionth of a substep.
const BISECTIONS: usize = 20;
/// A ratchet's tooth counts as passed within this fraction of a pitch: rounding.
const AT_TOOTH: f64 = 1e-9;

/// Which end of a limit's range a bound is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum End {
    Min,
    Max,
}

/// One bound and its state.
#[derive(Clone, Debug)]
struct Bound {
    limit: usize,
    end: End,
    is_resting: bool,
    /// Time of its last impact, s.
    last_impact: f64,
}

/// The state of an articulation at a bound.
#[derive(Clone, Copy, Debug)]
pub(super) struct BoundRow {
    /// C: distance from the bound, rad or m; negative beyond it.
    pub gap: f64,
    /// J, the derivative of the gap by the velocities.
    pub row: JacobianRow,
    /// World point where it acts, for events, m.
    pub point: DVec3,
}

/// All limits of an articulation.
#[derive(Clone, Debug)]
pub(super) struct Limits {
    limits: Vec<Limit>,
    gauges: Vec<[Option<Gauge>; 2]>,
    /// Greatest value of each ratchet so far, rad.
    greatest: Vec<f64>,
    /// Whether a body of each limit sleeps.
    asleep: Vec<bool>,
    bounds: Vec<Bound>,
}

impl Poses for (&[Sweep], f64) {
    fn pose(&self, body: usize) -> Pose {
        self.0[body].pose(self.1)
    }
}

impl Limits {
    /// The limits of bodies in their start state.
    pub fn new(limits: &[Limit], bodies: &[RigidBody]) -> Self {
        let mut bounds = Vec::new();
        for (limit, Limit { kind, .. }) in limits.iter().enumerate() {
            let (has_min, has_max) = match *kind {
                LimitKind::Tilt { .. } => (false, true),
                LimitKind::Range { min, max, .. } => (min.is_finite(), max.is_finite()),
                LimitKind::Distance { min, max, .. } => (min > 0.0, max.is_finite()),
                LimitKind::Ratchet { .. } => (true, false),
                LimitKind::Play { .. } => (true, true),
            };
            for (end, there) in [(End::Min, has_min), (End::Max, has_max)] {
                if there {
                    bounds.push(Bound { limit, end, is_resting: false, last_impact: f64::NEG_INFINITY });
                }
            }
        }
        let gauge = |measure| Some(Gauge::new(measure, bodies));
        let gauges = |limit: &Limit| match limit.kind {
            LimitKind::Range { measure, .. } | LimitKind::Ratchet { measure, .. } => [gauge(measure), None],
            LimitKind::Play { terms, .. } => terms.map(|term| gauge(term.measure)),
            LimitKind::Tilt { .. } | LimitKind::Distance { .. } => [None, None],
        };
        Self {
            gauges: limits.iter().map(gauges).collect(),
            greatest: vec![0.0; limits.len()],
            asleep: vec![false; limits.len()],
            limits: limits.to_vec(),
            bounds,
        }
    }

    /// Number of bounds.
    pub fn count(&self) -> usize {
        self.bounds.len()
    }

    /// Counts full turns up to this state, and lets pawls drop behind the teeth that have passed.
    pub fn follow(&mut self, bodies: &[RigidBody]) {
        let all = self.gauges.iter_mut().zip(&mut self.greatest).zip(&self.asleep);
        for ((gauges, greatest), _) in all.filter(|(_, asleep)| !**asleep) {
            gauges.iter_mut().flatten().for_each(|gauge| gauge.count(bodies));
            if let Some(first) = &gauges[0] {
                *greatest = greatest.max(first.total(bodies));
            }
        }
    }

    /// Ends all resting contact, for bodies that were moved; angles continue from the nearest ones.
    pub fn restart(&mut self, bodies: &[RigidBody]) {
        self.bounds.iter_mut().for_each(|bound| bound.is_resting = false);
        self.follow(bodies);
    }

    /// Sets which bodies sleep; their limits are left out.
    pub fn set_asleep(&mut self, asleep: &[bool]) {
        for (sleeps, limit) in self.asleep.iter_mut().zip(&self.limits) {
            *sleeps = asleep.iter().enumerate().any(|(body, asleep)| *asleep && limit.kind.acts_on(body));
        }
    }

    /// Whether a body of a bound sleeps.
    pub fn is_asleep(&self, bound: usize) -> bool {
        self.asleep[self.bounds[bound].limit]
    }

    /// Whether a bound is in resting contact.
    pub fn is_resting(&self, bound: usize) -> bool {
        self.bounds[bound].is_resting
    }

    /// Sets whether a bound is in resting contact.
    pub fn set_resting(&mut self, bound: usize, is_resting: bool) {
        self.bounds[bound].is_resting = is_resting;
    }

    /// Time of a bound's last impact, s.
    pub fn last_impact(&mut self, bound: usize) -> &mut f64 {
        &mut self.bounds[bound].last_impact
    }

    /// Coefficient of restitution of a bound.
    pub fn restitution(&self, bound: usize) -> f64 {
        self.limits[self.bounds[bound].limit].restitution
    }

    /// The two bodies of a bound; `None` is the world.
    pub fn bodies(&self, bound: usize) -> [Option<usize>; 2] {
        self.limits[self.bounds[bound].limit].kind.bodies()
    }

    /// Distance from a bound, rad or m; negative beyond it.
    pub fn gap(&self, bound: usize, bodies: &[RigidBody]) -> f64 {
        self.value(bound, bodies)
    }

    fn value(&self, bound: usize, poses: &(impl Poses + ?Sized)) -> f64 {
        let Bound { limit, end, .. } = self.bounds[bound];
        let (value, min, max) = match &self.limits[limit].kind {
            LimitKind::Tilt { a, b, max } => {
                let cosine =
                    world_direction(a.body, a.direction, poses).dot(world_direction(b.body, b.direction, poses));
                (acos(cosine.clamp(-1.0, 1.0)), 0.0, *max)
            }
            LimitKind::Range { min, max, .. } => (self.read(limit, 0, poses), *min, *max),
            LimitKind::Distance { a, b, min, max } => {
                ((world_point(a, poses) - world_point(b, poses)).length(), *min, *max)
            }
            LimitKind::Play { terms, play } => {
                let part = |k: usize| terms[k].coefficient * self.read(limit, k, poses);
                (part(0) + part(1), -0.5 * play, 0.5 * play)
            }
            LimitKind::Ratchet { pitch, .. } => {
                let value = self.read(limit, 0, poses);
                let greatest = self.greatest[limit].max(value);
                // A tooth counts as passed where it is reached, within rounding.
                let floor = if *pitch > 0.0 { pitch * (greatest / pitch + AT_TOOTH).floor() } else { greatest };
                (value, floor, f64::INFINITY)
            }
        };
        match end {
            End::Min => value - min,
            End::Max => max - value,
        }
    }

    fn read(&self, limit: usize, gauge: usize, poses: &(impl Poses + ?Sized)) -> f64 {
        self.gauges[limit][gauge].as_ref().map_or(0.0, |gauge| gauge.total(poses))
    }

    /// Gap, Jacobian row and point of the bound with this index, at the bodies' present state.
    pub fn row(&self, bound: usize, bodies: &[RigidBody]) -> BoundRow {
        let Bound { limit, end, .. } = self.bounds[bound];
        let sign = match end {
            End::Min => 1.0,
            End::Max => -1.0,
        };
        let two = self.bodies(bound);
        let middle = |body: Option<usize>| body.map_or(DVec3::ZERO, |i| bodies[i].position);
        let mut row = JacobianRow::default();
        let point = match &self.limits[limit].kind {
            LimitKind::Tilt { a, b, .. } => {
                let across =
                    world_direction(b.body, b.direction, bodies).cross(world_direction(a.body, a.direction, bodies));
                let block = vec6(DVec3::ZERO, across.normalize_or_zero());
                row.add(two[0], sign, &block);
                row.add(two[1], -sign, &block);
                middle(two[0])
            }
            LimitKind::Distance { a, b, .. } => {
                let (p, q) = (world_point(a, bodies), world_point(b, bodies));
                let along = (p - q).normalize_or_zero();
                let block = |body, at: DVec3| vec6(along, (at - middle(body)).cross(along));
                row.add(two[0], sign, &block(two[0], p));
                row.add(two[1], -sign, &block(two[1], q));
                p
            }
            LimitKind::Range { measure, .. } | LimitKind::Ratchet { measure, .. } => {
                self.add_gauge(limit, 0, sign, bodies, &mut row);
                match measure {
                    Measure::Angle { .. } => middle(two[0]),
                    Measure::Displacement { point, .. } => world_point(point, bodies),
                }
            }
            LimitKind::Play { terms, .. } => {
                for (k, term) in terms.iter().enumerate() {
                    self.add_gauge(limit, k, sign * term.coefficient, bodies, &mut row);
                }
                0.5 * (middle(two[0]) + middle(two[1]))
            }
        };
        BoundRow { gap: self.value(bound, bodies), row, point }
    }

    /// Adds `scale` times the row of a gauge.
    fn add_gauge(&self, limit: usize, gauge: usize, scale: f64, bodies: &[RigidBody], row: &mut JacobianRow) {
        let Some(gauge) = &self.gauges[limit][gauge] else { return };
        let ((on, against), (first, second)) = (gauge.blocks(bodies), gauge.bodies());
        row.add(first, scale, &on);
        row.add(second, scale, &against);
    }

    /// Whether a bound is within `layer` (rad or m) and approached faster than `speed`.
    pub fn approaches(&self, bound: usize, bodies: &[RigidBody], layer: f64, speed: f64) -> bool {
        self.value(bound, bodies) <= layer && self.row(bound, bodies).row.rate(bodies) < -speed
    }

    /// The fraction of a substep after which a bound is reached.
    pub fn crossing(&self, bound: usize, before: &[RigidBody], after: &[RigidBody], sweeps: &[Sweep]) -> Option<f64> {
        let end = self.value(bound, after);
        if end > 0.0 {
            return None;
        }
        let start = self.value(bound, before);
        if start <= CONTACT_MARGIN {
            let rate = |bodies: &[RigidBody]| self.row(bound, bodies).row.rate(bodies);
            if rate(before) < -ROUNDING {
                return Some(0.0);
            }
            // Opens at first: reached within the substep only if it returns.
            if end >= start || rate(after) >= -ROUNDING {
                return None;
            }
        }
        let (mut open, mut closed) = (0.0, 1.0);
        for _ in 0..BISECTIONS {
            let middle = 0.5 * (open + closed);
            if self.value(bound, &(sweeps, middle)) > 0.0 { open = middle } else { closed = middle }
        }
        Some(closed)
    }
}

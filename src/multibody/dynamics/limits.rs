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
//! play       C = b/2 ± (c₁ q₁ + c₂ q₂)    J = ±(c₁ J₁ + c₂ J₂)            either flank of a tooth
//! ```
//!
//! Turns and ways are those of couplings (`rows/coupling.rs`): angles about an axis are told apart from their full turns
//! by following them, and each substep turns by less than π.

use crate::articulation::rows::coupling::{Gauge, Poses, aim, place};
use crate::articulation::{Limit, LimitKind, Measure};
use crate::collision::{Sweep, TOUCH};
use soffio_geometry::bodies::RigidBody;
use soffio_math::spatial::vec6;
use soffio_math::{DVec3, Pose, acos};

use super::contacts::JacobianRow;

/// What approaches no faster than this does so by rounding, m/s or rad/s.
const ROUNDED: f64 = 1e-15;
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
    /// Time of its last hit, s.
    last_hit: f64,
}

/// All limits of a figure.
#[derive(Clone, Debug)]
pub(super) struct Limits {
    limits: Vec<Limit>,
    gauges: Vec<[Option<Gauge>; 2]>,
    /// Greatest value of each ratchet so far.
    most: Vec<f64>,
    /// Whether what each limit is between sleeps.
    asleep: Vec<bool>,
    bounds: Vec<Bound>,
}

impl Poses for (&[Sweep], f64) {
    fn pose(&self, body: usize) -> Pose {
        self.0[body].pose(self.1)
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
                LimitKind::Play { .. } => (true, true),
            };
            for (end, there) in [(End::Least, least), (End::Most, most)] {
                if there {
                    bounds.push(Bound { limit, end, resting: false, last_hit: f64::NEG_INFINITY });
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
            most: vec![0.0; limits.len()],
            asleep: vec![false; limits.len()],
            limits: limits.to_vec(),
            bounds,
        }
    }

    /// How many bounds there are.
    pub fn count(&self) -> usize {
        self.bounds.len()
    }

    /// Follows turns and ways, and lets pawls fall behind the teeth that have passed.
    pub fn follow(&mut self, bodies: &[RigidBody]) {
        let all = self.gauges.iter_mut().zip(&mut self.most).zip(&self.asleep);
        for ((gauges, most), _) in all.filter(|(_, asleep)| !**asleep) {
            gauges.iter_mut().flatten().for_each(|gauge| gauge.count(bodies));
            if let Some(first) = &gauges[0] {
                *most = most.max(first.total(bodies));
            }
        }
    }

    /// Forgets all rest; turns are those nearest to the ones before.
    pub fn forget(&mut self, bodies: &[RigidBody]) {
        self.bounds.iter_mut().for_each(|bound| bound.resting = false);
        self.follow(bodies);
    }

    /// Leaves out what is between bodies that sleep.
    pub fn let_sleep(&mut self, asleep: &[bool]) {
        for (sleeps, limit) in self.asleep.iter_mut().zip(&self.limits) {
            *sleeps = asleep.iter().enumerate().any(|(body, asleep)| *asleep && limit.kind.touches(body));
        }
    }

    /// Is a bound left out?
    pub fn sleeps(&self, bound: usize) -> bool {
        self.asleep[self.bounds[bound].limit]
    }

    /// Does a bound rest?
    pub fn resting(&self, bound: usize) -> bool {
        self.bounds[bound].resting
    }

    /// Sets whether a bound rests.
    pub fn set_resting(&mut self, bound: usize, rests: bool) {
        self.bounds[bound].resting = rests;
    }

    /// Time of a bound's last hit, s.
    pub fn last_hit(&mut self, bound: usize) -> &mut f64 {
        &mut self.bounds[bound].last_hit
    }

    /// Coefficient of restitution of a bound.
    pub fn restitution(&self, bound: usize) -> f64 {
        self.limits[self.bounds[bound].limit].restitution
    }

    /// The two bodies of a bound.
    pub fn bodies(&self, bound: usize) -> [Option<usize>; 2] {
        self.limits[self.bounds[bound].limit].kind.bodies()
    }

    /// What is left to a bound, rad or m; negative beyond it.
    pub fn gap(&self, bound: usize, bodies: &[RigidBody]) -> f64 {
        self.value(bound, bodies)
    }

    fn value(&self, bound: usize, poses: &(impl Poses + ?Sized)) -> f64 {
        let Bound { limit, end, .. } = self.bounds[bound];
        let (value, min, max) = match &self.limits[limit].kind {
            LimitKind::Tilt { a, b, max } => {
                let cosine = aim(a.body, a.direction, poses).dot(aim(b.body, b.direction, poses));
                (acos(cosine.clamp(-1.0, 1.0)), 0.0, *max)
            }
            LimitKind::Range { min, max, .. } => (self.read(limit, 0, poses), *min, *max),
            LimitKind::Distance { a, b, min, max } => ((place(a, poses) - place(b, poses)).length(), *min, *max),
            LimitKind::Play { terms, play } => {
                let part = |k: usize| terms[k].coefficient * self.read(limit, k, poses);
                (part(0) + part(1), -0.5 * play, 0.5 * play)
            }
            LimitKind::Ratchet { pitch, .. } => {
                let value = self.read(limit, 0, poses);
                let most = self.most[limit].max(value);
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

    fn read(&self, limit: usize, gauge: usize, poses: &(impl Poses + ?Sized)) -> f64 {
        self.gauges[limit][gauge].as_ref().map_or(0.0, |gauge| gauge.total(poses))
    }

    /// What is left to a bound, its row, and where it acts.
    pub fn row(&self, bound: usize, bodies: &[RigidBody]) -> (f64, JacobianRow, DVec3) {
        let Bound { limit, end, .. } = self.bounds[bound];
        let sign = match end {
            End::Least => 1.0,
            End::Most => -1.0,
        };
        let two = self.bodies(bound);
        let middle = |body: Option<usize>| body.map_or(DVec3::ZERO, |i| bodies[i].position);
        let mut row = JacobianRow::default();
        let point = match &self.limits[limit].kind {
            LimitKind::Tilt { a, b, .. } => {
                let across = aim(b.body, b.direction, bodies).cross(aim(a.body, a.direction, bodies));
                let block = vec6(DVec3::ZERO, across.normalize_or_zero());
                row.add(two[0], sign, &block);
                row.add(two[1], -sign, &block);
                middle(two[0])
            }
            LimitKind::Distance { a, b, .. } => {
                let (p, q) = (place(a, bodies), place(b, bodies));
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
                    Measure::Way { point, .. } => place(point, bodies),
                }
            }
            LimitKind::Play { terms, .. } => {
                for (k, term) in terms.iter().enumerate() {
                    self.add_gauge(limit, k, sign * term.coefficient, bodies, &mut row);
                }
                0.5 * (middle(two[0]) + middle(two[1]))
            }
        };
        (self.value(bound, bodies), row, point)
    }

    /// Adds `scale` times the row of a gauge.
    fn add_gauge(&self, limit: usize, gauge: usize, scale: f64, bodies: &[RigidBody], row: &mut JacobianRow) {
        let Some(gauge) = &self.gauges[limit][gauge] else { return };
        let ((on, against), (first, second)) = (gauge.blocks(bodies), gauge.bodies());
        row.add(first, scale, &on);
        row.add(second, scale, &against);
    }

    /// Is a bound reached, and passed at more than `speed`?
    pub fn approaches(&self, bound: usize, bodies: &[RigidBody], layer: f64, speed: f64) -> bool {
        self.value(bound, bodies) <= layer && self.row(bound, bodies).1.rate(bodies) < -speed
    }

    /// The share of a substep at which a bound is reached.
    pub fn crossing(&self, bound: usize, before: &[RigidBody], after: &[RigidBody], sweeps: &[Sweep]) -> Option<f64> {
        let end = self.value(bound, after);
        if end > 0.0 {
            return None;
        }
        let start = self.value(bound, before);
        if start <= TOUCH {
            let rate = |bodies: &[RigidBody]| self.row(bound, bodies).1.rate(bodies);
            if rate(before) < -ROUNDED {
                return Some(0.0);
            }
            // Opens at first: reached again on the way only if it has come back.
            if end >= start || rate(after) >= -ROUNDED {
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

//! Couplings (1 row): C = Σ c q − const, q the turns and ways of bodies. Gears, drums with cords, racks, screws.
//!
//! **Angle** of body i about its axis n (fixed in it) against the frame k that carries the axle:
//!
//! ```text
//! q = 2 atan2(d_v·n, d_w) + 2π · turns         d = q₀⁻¹ q, the relative rotation since the start, in the body's axes
//! q̇ = (ω_i − ω_k)·e          e = (n + m)/(1 + n·m)          J_i = (0, e), J_k = −(0, e)
//! J̇ẋ = (ω_i − ω_k)·ė         ė = (ṅ + ṁ − e (ṅ·m + n·ṁ))/(1 + n·m)          ṅ = ω_i×n, ṁ = ω_k×m
//! ```
//!
//! m is the direction in the frame from which n started. On an axle both are equal, e = n. Where the body also
//! swings, q is the twist of d about n, and e its gradient, so that a torsion spring on a ball joint conserves
//! energy. The value comes from the rotations themselves, so phases never drift. Whole revolutions are counted, and Σ
//! c (2π k) is summed from the counts: with tooth numbers for c the sum is exact over any time.
//!
//! **Displacement** of a point P along a direction u fixed in the frame k, from where P was at the start (S, fixed in
//! k): the point-on-plane row with normal u.
//!
//! Signs: two external gears turn oppositely, r₁ q₁ + r₂ q₂ = const with axes alike; an internal one has −r₂. A weight
//! on a drum: way − r q = const; compounded pulleys multiply the way.

use super::plane;
use super::{BodyStates, JacobianRow, at, negated};
use crate::articulation::{Anchor, Axis, Measure};
use soffio_geometry::bodies::RigidBody;
use soffio_math::Function;
use soffio_math::spatial::{Vec6, add_scaled, vec6};
use soffio_math::{DMat3, DQuat, DVec3, PI, Pose, atan2};

/// Below this 1 + n·m the body lies with its axis overturned, where the twist says nothing.
const OVERTURNED: f64 = 1e-6;
/// Product of two rotations (as unit quaternions) that are apart by 0.2 rad: cos 0.1. A turn of less is not counted, which is
/// far from the half turn that the nearest branch allows.
const COUNT_THRESHOLD: f64 = 0.995;

/// Where bodies are at one time.
pub trait Poses {
    /// Node frame of a body.
    fn pose(&self, body: usize) -> Pose;

    /// Its rotation alone.
    fn rotation(&self, body: usize) -> DQuat {
        self.pose(body).rotation
    }
}

impl Poses for [RigidBody] {
    fn pose(&self, body: usize) -> Pose {
        self[body].pose()
    }

    fn rotation(&self, body: usize) -> DQuat {
        self[body].rotation
    }
}

/// A measure with what it must remember of the start, and its count of turns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gauge {
    /// What is measured.
    pub measure: Measure,
    /// Relative rotation at the start (turns).
    start: DQuat,
    /// S: where the point was at the start, in the frame's node axes (ways).
    origin: Anchor,
    /// Whole turns counted so far.
    revolutions: i64,
    /// Wrapped angle at the last count, rad, and the relative rotation.
    last: f64,
    counted: DQuat,
}

/// A scalar coordinate and its derivatives.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Reading {
    /// Wrapped angle (rad, beside `turns`) or way (m).
    pub value: f64,
    /// Whole turns.
    pub revolutions: i64,
    /// J on the measured body.
    pub on: Vec6,
    /// J on the body it is measured against.
    pub against: Vec6,
    /// J̇ẋ.
    pub bias: f64,
}

impl Reading {
    /// Angle with its turns (rad), or the way (m).
    pub fn total(&self) -> f64 {
        self.value + 2.0 * PI * self.revolutions as f64
    }
}

impl Gauge {
    /// Reads zero at these bodies' state.
    pub fn new(measure: Measure, bodies: &[RigidBody]) -> Self {
        let mut gauge = Self {
            measure,
            start: DQuat::IDENTITY,
            origin: Anchor { body: None, point: DVec3::ZERO },
            revolutions: 0,
            last: 0.0,
            counted: DQuat::IDENTITY,
        };
        match &measure {
            Measure::Angle { axis, frame } => gauge.start = relative(axis.body, *frame, bodies),
            Measure::Displacement { point, direction } => {
                let p = world_point(point, bodies);
                let local = direction.body.map_or(p, |i| bodies[i].pose().inverse_point(p));
                gauge.origin = Anchor { body: direction.body, point: local };
            }
        }
        gauge
    }

    /// The bodies it touches.
    pub fn bodies(&self) -> (Option<usize>, Option<usize>) {
        self.measure.bodies()
    }

    /// Its value and row at a scene.
    pub fn read(&self, scene: &BodyStates) -> Reading {
        let (value, revolutions) = self.current_value(scene);
        Reading { value, revolutions, ..self.motion(scene) }
    }

    /// Its row alone.
    #[inline(always)]
    fn motion(&self, scene: &BodyStates) -> Reading {
        match &self.measure {
            Measure::Angle { axis, frame } => {
                let n = scene.direction(axis);
                let against = scene.spin(*frame);
                let m = frame.map_or(DMat3::IDENTITY, |i| scene.frames[i]) * (self.start * axis.direction);
                let (e, bias) = axis_gradient((n.n, n.spin), (m, against));
                let j = vec6(DVec3::ZERO, e);
                Reading { on: j, against: negated(j), bias, ..Reading::default() }
            }
            Measure::Displacement { point, direction } => {
                let row = plane::row(scene, point, &self.origin, direction.direction, &Function::Constant(0.0));
                Reading { on: row.a, against: row.b, bias: row.bias, ..Reading::default() }
            }
        }
    }

    /// Its value alone: wrapped angle and turns, or way.
    fn current_value(&self, scene: &BodyStates) -> (f64, i64) {
        match &self.measure {
            Measure::Angle { axis, frame } => self.angle(axis, *frame, scene.bodies),
            Measure::Displacement { point, direction } => {
                (plane::value(scene, point, &self.origin, direction.direction, &Function::Constant(0.0)), 0)
            }
        }
    }

    /// Its value alone where bodies are at these poses: angle with its turns (rad), or the way (m).
    pub fn total(&self, poses: &(impl Poses + ?Sized)) -> f64 {
        match &self.measure {
            Measure::Angle { axis, frame } => {
                let (value, revolutions) = self.angle(axis, *frame, poses);
                value + 2.0 * PI * revolutions as f64
            }
            Measure::Displacement { point, direction } => {
                let normal = world_direction(direction.body, direction.direction, poses);
                normal.dot(world_point(point, poses) - world_point(&self.origin, poses))
            }
        }
    }

    /// J on the measured body, and on the body it is measured against.
    pub fn blocks(&self, bodies: &[RigidBody]) -> (Vec6, Vec6) {
        match &self.measure {
            Measure::Angle { axis, frame } => {
                let n = world_direction(axis.body, axis.direction, bodies);
                let m = world_direction(*frame, self.start * axis.direction, bodies);
                let j = vec6(DVec3::ZERO, axis_gradient((n, DVec3::ZERO), (m, DVec3::ZERO)).0);
                (j, negated(j))
            }
            Measure::Displacement { point, direction } => {
                let normal = world_direction(direction.body, direction.direction, bodies);
                // The plane's body feels the force at the point itself.
                let p = world_point(point, bodies);
                let arm = |body: Option<usize>| p - body.map_or(p, |i| bodies[i].position);
                (at(normal, arm(point.body)), negated(at(normal, arm(direction.body))))
            }
        }
    }

    /// Counts turns up to this state; once a step or oftener. What has hardly turned since needs no new count.
    pub fn count(&mut self, bodies: &[RigidBody]) {
        if let Measure::Angle { axis, frame } = self.measure {
            let d = self.since_start(axis.body, frame, bodies);
            if d.dot(self.counted) < COUNT_THRESHOLD {
                (self.last, self.revolutions) = self.angle(&axis, frame, bodies);
                self.counted = d;
            }
        }
    }

    /// Sets the count of turns so that it reads nearest to `total`, rad.
    pub fn set_nearest_count(&mut self, bodies: &[RigidBody], total: f64) {
        self.count(bodies);
        self.revolutions = ((total - self.last) / (2.0 * PI)).round() as i64;
    }

    /// d.
    fn since_start(&self, body: Option<usize>, frame: Option<usize>, poses: &(impl Poses + ?Sized)) -> DQuat {
        self.start.conjugate() * relative(body, frame, poses)
    }

    /// Wrapped angle, and turns by the branch nearest to the last count: between two counts it grows by less than π.
    fn angle(&self, axis: &Axis, frame: Option<usize>, poses: &(impl Poses + ?Sized)) -> (f64, i64) {
        let d = self.since_start(axis.body, frame, poses);
        let sine = DVec3::new(d.x, d.y, d.z).dot(axis.direction);
        let raw = 2.0 * atan2(sine, d.w);
        let value = if raw > PI {
            raw - 2.0 * PI
        } else if raw <= -PI {
            raw + 2.0 * PI
        } else {
            raw
        };
        let step = value - self.last;
        (value, self.revolutions + i64::from(step < -PI) - i64::from(step > PI))
    }
}

/// Where a point is, world, m.
pub fn world_point(anchor: &Anchor, poses: &(impl Poses + ?Sized)) -> DVec3 {
    anchor.body.map_or(anchor.point, |body| poses.pose(body).point(anchor.point))
}

/// Where a body's direction points, world.
pub fn world_direction(body: Option<usize>, direction: DVec3, poses: &(impl Poses + ?Sized)) -> DVec3 {
    body.map_or(direction, |body| poses.rotation(body) * direction)
}

/// e and J̇ẋ of the file's head, for the directions n and m with the angular velocities of their bodies.
#[inline(always)]
fn axis_gradient((n, spin): (DVec3, DVec3), (m, against): (DVec3, DVec3)) -> (DVec3, f64) {
    let whole = 1.0 + n.dot(m);
    if whole < OVERTURNED {
        return (n, -against.dot(spin.cross(n)));
    }
    let e = (n + m) / whole;
    let (dn, dm) = (spin.cross(n), against.cross(m));
    let de = (dn + dm - e * (dn.dot(m) + n.dot(dm))) / whole;
    (e, de.dot(spin - against))
}

/// Rotation of a body in the axes of another.
fn relative(body: Option<usize>, frame: Option<usize>, poses: &(impl Poses + ?Sized)) -> DQuat {
    let own = body.map_or(DQuat::IDENTITY, |body| poses.rotation(body));
    frame.map_or(own, |frame| poses.rotation(frame).conjugate() * own)
}

/// A coupling's value.
pub fn value(scene: &BodyStates, terms: &[(Gauge, f64)]) -> f64 {
    let (mut sum, mut revolutions_sum) = (0.0, 0.0);
    for (gauge, coefficient) in terms {
        let (value, revolutions) = gauge.current_value(scene);
        sum += coefficient * value;
        revolutions_sum += coefficient * revolutions as f64;
    }
    sum + 2.0 * PI * revolutions_sum
}

/// A coupling's row: its value, and its blocks added to those of the bodies `parts` (every body that a term touches
/// has a slot there).
pub fn row(scene: &BodyStates, terms: &[(Gauge, f64)], parts: &mut [(usize, Vec6)]) -> JacobianRow {
    JacobianRow { value: value(scene, terms), ..motion(scene, terms, parts) }
}

/// The same without its value, which angles are dear to.
#[inline(always)]
pub fn motion(scene: &BodyStates, terms: &[(Gauge, f64)], parts: &mut [(usize, Vec6)]) -> JacobianRow {
    for (_, block) in parts.iter_mut() {
        *block = [0.0; 6];
    }
    let mut out = JacobianRow { length: true, ..JacobianRow::default() };
    for (gauge, coefficient) in terms {
        let reading = gauge.motion(scene);
        out.bias += coefficient * reading.bias;
        let (on, against) = gauge.bodies();
        for (body, block) in [(on, &reading.on), (against, &reading.against)] {
            let part = parts.iter_mut().find(|(index, _)| Some(*index) == body);
            if let Some((_, sum)) = part {
                add_scaled(sum, *coefficient, block);
            }
        }
    }
    out
}

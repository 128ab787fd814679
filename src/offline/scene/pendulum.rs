//! Period and amplitude of a simulated pendulum.
//!
//! ```text
//! θ = atan2(axis·(g × r), g·r), r from the hinge to the centre of mass, rad
//! ```
//!
//! The period is the mean over all zero crossings of θ, two a period. A crossing between two samples is found on the
//! straight line through them, and on the cubic through both angles and rates (Hermite).

use super::format::{JointKind, PhysicsScene};
use super::measure::{BodyState, larger};
use soffio_math::{DVec3, atan2};

/// Span at the end of a pendulum's run in which its amplitude is sampled, s.
const AMPLITUDE_SPAN: f64 = 4.0;
/// Bisections that reduce an interval of one step to the precision of f64.
const HALVINGS: usize = 60;

/// Zero crossings of a pendulum on a hinge to the world.
#[derive(Clone, Debug)]
pub(super) struct Pendulum {
    /// Index of the swinging body.
    pub body: usize,
    axis: DVec3,
    hinge: DVec3,
    gravity: DVec3,
    before: Sample,
    crossings: usize,
    /// First and last crossing by linear and by cubic interpolation, s.
    first: [f64; 2],
    last: [f64; 2],
    /// Sampled |θ| of the last seconds: (t, |θ|).
    recent: std::collections::VecDeque<(f64, f64)>,
}

#[derive(Clone, Copy, Debug)]
struct Sample {
    t: f64,
    angle: f64,
    rate: f64,
}

impl Pendulum {
    /// `None` where the first joint is not a hinge to the world.
    pub fn new(scene: &PhysicsScene) -> Option<Self> {
        let joint = scene.joints.first().filter(|j| j.kind == JointKind::Hinge && j.parent().is_none())?;
        let mut pendulum = Self {
            body: joint.b,
            axis: joint.axes()?.0,
            hinge: DVec3::from_array(joint.anchor_a),
            gravity: DVec3::from_array(scene.gravity).normalize(),
            before: Sample { t: 0.0, angle: 0.0, rate: 0.0 },
            crossings: 0,
            first: [0.0; 2],
            last: [0.0; 2],
            recent: std::collections::VecDeque::new(),
        };
        pendulum.before = pendulum.sample(0.0, &scene.bodies[joint.b].state());
        Some(pendulum)
    }

    fn sample(&self, t: f64, state: &BodyState) -> Sample {
        let r = state.position - self.hinge;
        let angle = atan2(self.axis.dot(self.gravity.cross(r)), self.gravity.dot(r));
        Sample { t, angle, rate: self.axis.dot(state.angular_velocity) }
    }

    /// Takes the state of the body at `t` seconds.
    pub fn follow(&mut self, t: f64, state: &BodyState) {
        let (a, b) = (self.before, self.sample(t, state));
        self.before = b;
        self.recent.push_back((t, b.angle.abs()));
        while self.recent.front().is_some_and(|&(then, _)| then < t - AMPLITUDE_SPAN) {
            self.recent.pop_front();
        }
        if (a.angle < 0.0) != (b.angle < 0.0) {
            let h = b.t - a.t;
            self.last = [a.t + h * a.angle / (a.angle - b.angle), a.t + h * hermite_root(&a, &b)];
            if self.crossings == 0 {
                self.first = self.last;
            }
            self.crossings += 1;
        }
    }

    /// Mean period by linear and by cubic interpolation, s.
    pub fn periods(&self) -> Option<[f64; 2]> {
        let halves = self.crossings.checked_sub(1).filter(|&n| n > 0)? as f64;
        Some(std::array::from_fn(|k| 2.0 * (self.last[k] - self.first[k]) / halves))
    }

    /// Largest angle of the last seconds, rad.
    pub fn amplitude(&self) -> f64 {
        self.recent.iter().map(|&(_, angle)| angle).fold(0.0, larger)
    }
}

/// Fraction of the step at which the Hermite cubic through both angles and rates is zero; the angles differ in sign.
fn hermite_root(a: &Sample, b: &Sample) -> f64 {
    let h = b.t - a.t;
    let cubic = |s: f64| {
        let r = 1.0 - s;
        r * r * (1.0 + 2.0 * s) * a.angle + s * s * (3.0 - 2.0 * s) * b.angle + s * r * h * (r * a.rate - s * b.rate)
    };
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if (cubic(middle) < 0.0) == (a.angle < 0.0) { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

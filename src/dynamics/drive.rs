//! Driven bodies: a body whose place is given as a function of time by key frames or a path.
//!
//! Joints to a driven body need its velocity and acceleration, so both come with the pose. Between two keys the node
//! goes along p(t) = p₀ + s (p₁ − p₀) and turns about one axis, R(t) = exp([s w]×) R₀ with w the rotation vector from
//! R₀ to R₁, so that
//!
//! ```text
//! ṗ = ṡ (p₁ − p₀)      p̈ = s̈ (p₁ − p₀)      ω = ṡ w      ω̇ = s̈ w
//! ```
//!
//! with s(t) as in `articulation::Function`.

use crate::articulation::{Function, Interpolation, Jet3};
use crate::bodies::RigidBody;
use crate::math::{DQuat, DVec3, Pose, rotation, rotation_vector};

/// A body that follows its motion whatever pulls at it.
#[derive(Clone, Debug, PartialEq)]
pub struct Drive {
    /// Index of the body.
    pub body: usize,
    /// Where it is when.
    pub motion: Motion,
}

/// Poses of a node at given times.
#[derive(Clone, Debug, PartialEq)]
pub struct Motion {
    /// (time s, world pose of the node), times rising, at least one.
    pub keys: Vec<(f64, Pose)>,
    /// What happens between two keys.
    pub interpolation: Interpolation,
    /// Begins anew after the last key.
    pub repeat: bool,
}

/// A driven node at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Instant {
    /// World pose of the node.
    pub pose: Pose,
    /// Velocity of its origin, m/s.
    pub velocity: DVec3,
    /// rad/s, world axes.
    pub angular_velocity: DVec3,
    /// Acceleration of its origin, m/s².
    pub acceleration: DVec3,
    /// rad/s², world axes.
    pub angular_acceleration: DVec3,
}

impl Motion {
    /// The node at `t` seconds after reset.
    pub fn at(&self, t: f64) -> Instant {
        let still = |pose| Instant {
            pose,
            velocity: DVec3::ZERO,
            angular_velocity: DVec3::ZERO,
            acceleration: DVec3::ZERO,
            angular_acceleration: DVec3::ZERO,
        };
        let Some((&(first, start), &(last, end))) = self.keys.first().zip(self.keys.last()) else {
            return still(Pose::IDENTITY);
        };
        let length = last - first;
        let t =
            if self.repeat && length > 0.0 { first + (t - first) - length * ((t - first) / length).floor() } else { t };
        if t < first {
            return still(start);
        }
        let after = self.keys.partition_point(|&(time, _)| time <= t);
        if after == self.keys.len() {
            return still(end);
        }
        let ((t0, from), (t1, to)) = (self.keys[after - 1], self.keys[after]);
        let share =
            Function::Keys { keys: vec![(t0, 0.0), (t1, 1.0)], interpolation: self.interpolation, repeat: false };
        let Jet3 { value, rate, acceleration } = share.at(t);
        let (way, turn) = (to.position - from.position, turn_between(from.rotation, to.rotation));
        Instant {
            pose: Pose {
                rotation: (rotation(value * turn) * from.rotation).normalize(),
                position: from.position + value * way,
            },
            velocity: rate * way,
            angular_velocity: rate * turn,
            acceleration: acceleration * way,
            angular_acceleration: acceleration * turn,
        }
    }
}

impl Instant {
    /// Puts a body there; answers the accelerations of its centre of mass (m/s²) and its rotation (rad/s²).
    pub fn carry(&self, body: &mut RigidBody) -> (DVec3, DVec3) {
        let arm = self.pose.rotation * body.properties.center;
        let (w, alpha) = (self.angular_velocity, self.angular_acceleration);
        body.rotation = self.pose.rotation;
        body.position = self.pose.position + arm;
        body.velocity = self.velocity + w.cross(arm);
        body.angular_velocity = w;
        (self.acceleration + alpha.cross(arm) + w.cross(w.cross(arm)), alpha)
    }
}

/// Rotation vector of the shorter way from one rotation to another, world axes, rad.
fn turn_between(from: DQuat, to: DQuat) -> DVec3 {
    let turn = to * from.conjugate();
    rotation_vector(if turn.w < 0.0 { -turn } else { turn })
}

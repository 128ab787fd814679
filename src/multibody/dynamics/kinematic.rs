//! Kinematic bodies: bodies whose pose is a given function of time, by key frames or a path.
//!
//! Joints to a kinematic body need its velocity and acceleration, so both come with the pose. Between two keys the node moves
//! along p(t) = p₀ + s (p₁ − p₀) and rotates about one axis, R(t) = exp([s w]×) R₀ with w the rotation vector from R₀ to R₁:
//!
//! ```text
//! ṗ = ṡ (p₁ − p₀)      p̈ = s̈ (p₁ − p₀)      ω = ṡ w      ω̇ = s̈ w
//! ```
//!
//! with s(t) as in [`soffio_math::Function`], where a step is a smooth way within the last [`STEP_S`] before its key. Where the velocity
//! jumps, at the keys of a straight way, substeps end ([`KeyframeMotion::next_jump`]) and the joints' projection gives the bodies
//! that hang on it their new velocity: an impulse. A *spline* is the quintic of that module in p and in the rotation vector
//! φ(t) from R₀, R(t) = `exp([φ]×)` R₀. With θ = |φ|, a = (1 − cos θ)/θ² and b = (θ − sin θ)/θ³
//!
//! ```text
//! ω = φ̇ + a φ×φ̇ + b φ×(φ×φ̇)
//! ω̇ = φ̈ + ȧ φ×φ̇ + a φ×φ̈ + ḃ φ×(φ×φ̇) + b (φ̇×(φ×φ̇) + φ×(φ×φ̈))
//! ```
//!
//! The inverse, φ̇ = ω − φ×ω/2 + c φ×(φ×ω) with c = (1 − θ (1 + cos θ)/(2 sin θ))/θ², gives φ̇ and φ̈ at the end of a
//! span from the ω and ω̇ of its key. Velocities and accelerations have no jumps.

use soffio_geometry::bodies::RigidBody;
use soffio_math::function::{Span, easing, knot, neighbours, next_key, quintic, span, span_from_key};
use soffio_math::spatial::{Vec6, vec6};
use soffio_math::{DQuat, DVec3, Pose, rotation, rotation_vector, sincos};
use soffio_math::{Interpolation, Jet3};

/// Time in which a driver with stepped keys moves to the next key, and arrives with it, s: what it carries cannot be in two places at once.
pub const STEP_S: f64 = 0.1;

/// A kinematic body: it follows its motion whatever forces act on it.
#[derive(Clone, Debug, PartialEq)]
pub struct KinematicBody {
    /// Index of the body.
    pub body: usize,
    /// The motion of its node.
    pub motion: KeyframeMotion,
}

/// Key-framed motion of a node.
#[derive(Clone, Debug, PartialEq)]
pub struct KeyframeMotion {
    /// (time in s, world pose of the node), in ascending times. Without any key the node stays at the origin.
    pub keys: Vec<(f64, Pose)>,
    /// Interpolation between two keys.
    pub interpolation: Interpolation,
    /// Repeats after the last key.
    pub repeat: bool,
}

/// State of a kinematic node at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KinematicState {
    /// World pose of the node.
    pub pose: Pose,
    /// Velocity of its origin, m/s.
    pub velocity: DVec3,
    /// Angular velocity, rad/s, world axes.
    pub angular_velocity: DVec3,
    /// Acceleration of its origin, m/s².
    pub acceleration: DVec3,
    /// rad/s², world axes.
    pub angular_acceleration: DVec3,
}

/// First and second derivatives at a key of a spline.
struct KeyDerivatives {
    /// m/s and m/s².
    linear: (DVec3, DVec3),
    /// rad/s and rad/s².
    angular: (DVec3, DVec3),
}

impl KeyframeMotion {
    /// State of the node at `t` seconds after reset.
    pub fn at(&self, t: f64) -> KinematicState {
        let at_rest = |pose| KinematicState {
            pose,
            velocity: DVec3::ZERO,
            angular_velocity: DVec3::ZERO,
            acceleration: DVec3::ZERO,
            angular_acceleration: DVec3::ZERO,
        };
        if self.keys.is_empty() {
            return at_rest(Pose::IDENTITY);
        }
        let time = |i: usize| self.keys[i].0;
        let found = match self.interpolation {
            Interpolation::Linear => span_from_key(self.keys.len(), time, self.repeat, t),
            _ => span(self.keys.len(), time, self.repeat, t),
        };
        let found = match found {
            Ok(found) => found,
            Err(key) => return at_rest(self.keys[key].1),
        };
        if self.interpolation == Interpolation::Spline {
            return self.spline(found);
        }
        let ((t0, from), (t1, to)) = (self.keys[found.key], self.keys[found.key + 1]);
        let Jet3 { value, rate, acceleration } = match self.interpolation {
            Interpolation::Step => {
                let moving = STEP_S.min(t1 - t0);
                easing(Interpolation::Smooth, moving, (found.since - (t1 - t0 - moving)).max(0.0))
            }
            interpolation => easing(interpolation, t1 - t0, found.since),
        };
        let displacement = to.position - from.position;
        let rotation_total = rotation_between(from.rotation, to.rotation);
        KinematicState {
            pose: Pose {
                rotation: (rotation(value * rotation_total) * from.rotation).normalize(),
                position: from.position + value * displacement,
            },
            velocity: rate * displacement,
            angular_velocity: rate * rotation_total,
            acceleration: acceleration * displacement,
            angular_acceleration: acceleration * rotation_total,
        }
    }

    /// First time after `t` (s) at which its velocity jumps; infinite where it never does again.
    pub fn next_jump(&self, t: f64) -> f64 {
        if self.interpolation != Interpolation::Linear || self.keys.is_empty() {
            return f64::INFINITY;
        }
        next_key(self.keys.len(), |i| self.keys[i].0, self.repeat, t)
    }

    fn spline(&self, Span { key, since }: Span) -> KinematicState {
        let ((t0, from), (t1, to)) = (self.keys[key], self.keys[key + 1]);
        let KeyDerivatives { linear: (v0, a0), angular: (w0, alpha0) } = self.derivatives(key);
        let KeyDerivatives { linear: (v1, a1), angular: (w1, alpha1) } = self.derivatives(key + 1);
        let h = t1 - t0;
        let (position, velocity, acceleration) = quintic((from.position, v0, a0), (to.position, v1, a1), h, since);
        let whole = rotation_between(from.rotation, to.rotation);
        let rate = unspin(whole, w1);
        // φ̈ at the end: ω̇ less the part of φ̇ alone.
        let curvature = unspin(whole, alpha1 - spin(whole, rate, DVec3::ZERO).1);
        let (phi, phi_rate, phi_curvature) = quintic((DVec3::ZERO, w0, alpha0), (whole, rate, curvature), h, since);
        let (angular_velocity, angular_acceleration) = spin(phi, phi_rate, phi_curvature);
        KinematicState {
            pose: Pose { rotation: (rotation(phi) * from.rotation).normalize(), position },
            velocity,
            angular_velocity,
            acceleration,
            angular_acceleration,
        }
    }

    /// Velocities and accelerations at a key.
    fn derivatives(&self, key: usize) -> KeyDerivatives {
        let Some((before, after)) = neighbours(key, self.keys.len(), self.repeat) else {
            return KeyDerivatives { linear: (DVec3::ZERO, DVec3::ZERO), angular: (DVec3::ZERO, DVec3::ZERO) };
        };
        let mean = |i: usize| {
            let ((t0, from), (t1, to)) = (self.keys[i], self.keys[i + 1]);
            let h = t1 - t0;
            (h, (to.position - from.position) / h, rotation_between(from.rotation, to.rotation) / h)
        };
        let ((h0, v0, w0), (h1, v1, w1)) = (mean(before), mean(after));
        KeyDerivatives { linear: knot(v0, v1, h0, h1), angular: knot(w0, w1, h0, h1) }
    }
}

impl KinematicState {
    /// Puts a body in this state. Returns its acceleration about the centre of mass, m/s² and rad/s².
    pub fn place(&self, body: &mut RigidBody) -> Vec6 {
        let arm = self.pose.rotation * body.properties.center;
        let (w, alpha) = (self.angular_velocity, self.angular_acceleration);
        body.rotation = self.pose.rotation;
        body.position = self.pose.position + arm;
        body.velocity = self.velocity + w.cross(arm);
        body.angular_velocity = w;
        vec6(self.acceleration + alpha.cross(arm) + w.cross(w.cross(arm)), alpha)
    }
}

/// Rotation vector of the shorter rotation between two orientations, world axes, rad.
fn rotation_between(from: DQuat, to: DQuat) -> DVec3 {
    let between = to * from.conjugate();
    rotation_vector(if between.w < 0.0 { -between } else { between })
}

/// Below this angle a, b and c are two terms of their series, rad.
const SMALL: f64 = 1e-2;

/// ω and ω̇ from the rotation vector φ and its two derivatives.
fn spin(phi: DVec3, rate: DVec3, curvature: DVec3) -> (DVec3, DVec3) {
    let theta2 = phi.length_squared();
    // a, b and their derivatives by θ over θ.
    let (a, b, da, db) = if theta2 < SMALL * SMALL {
        (0.5 - theta2 / 24.0, 1.0 / 6.0 - theta2 / 120.0, -1.0 / 12.0 + theta2 / 180.0, -1.0 / 60.0 + theta2 / 1260.0)
    } else {
        let theta = theta2.sqrt();
        let (s, c) = sincos(theta);
        let (a, b) = ((1.0 - c) / theta2, (theta - s) / (theta2 * theta));
        (a, b, (s / theta - 2.0 * a) / theta2, (a - 3.0 * b) / theta2)
    };
    let along = phi.dot(rate);
    let (once, twice) = (phi.cross(rate), phi.cross(phi.cross(rate)));
    let omega = rate + a * once + b * twice;
    let alpha = curvature
        + da * along * once
        + a * phi.cross(curvature)
        + db * along * twice
        + b * (rate.cross(once) + phi.cross(phi.cross(curvature)));
    (omega, alpha)
}

/// φ̇ from ω: the inverse of the part of [`spin`] that is linear in φ̇.
fn unspin(phi: DVec3, omega: DVec3) -> DVec3 {
    let theta2 = phi.length_squared();
    let c = if theta2 < SMALL * SMALL {
        1.0 / 12.0 + theta2 / 720.0
    } else {
        let theta = theta2.sqrt();
        let (s, c) = sincos(theta);
        // (1 + cos)/sin = sin/(1 − cos): the second has no pole where keys are 180° apart.
        (1.0 - 0.5 * theta * s / (1.0 - c)) / theta2
    };
    omega - 0.5 * phi.cross(omega) + c * phi.cross(phi.cross(omega))
}

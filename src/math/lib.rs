//! Vectors, poses and transcendentals: the one place the core takes its functions from.
//!
//! Invariant: every transcendental here is software (`libm`), so that the same input gives the same bits on any
//! platform, in debug and in release. `f64::sqrt` and the four operations are exact by IEEE 754 and used directly.
//! `f64::powi` is not: its rounding may differ between optimisation levels, so it is forbidden (clippy.toml).
//!
//! What the whole core shares: vectors and poses, spatial algebra for rigid bodies, lanes of four numbers (SIMD), keyed
//! functions of time, and seeded noise. It is the leftmost crate; all others may use it.
//!
//! It never reads a clock, a file, a device or the environment, and it has no global state.
//!
//! | module or type | holds |
//! |---|---|
//! | [`Pose`] | a rigid placement: rotation and position, m |
//! | [`rotation`], [`rotation_vector`], [`tangents`] | helpers for rotations and frames |
//! | [`amplitude_to_db`], [`db_to_amplitude`] | amplitude ratios in dB and back |
//! | [`StateHash`] | one word that tells two states apart, bit for bit |
//! | [`function`] | constants, key frames and harmonics over time, with derivatives |
//! | [`spatial`] | six-component velocities, forces and inertias (Featherstone's algebra) |
//! | [`lanes`] | four numbers at once, in the same order of operations at any instruction set |
//! | [`noise`] | a seeded generator, hashes, and gradient noise |
//!
//! ```
//! use soffio_math::noise::Random;
//! use soffio_math::{DVec3, PI, Pose, rotation};
//!
//! // A quarter turn about z, one metre up.
//! let pose = Pose { rotation: rotation(0.5 * PI * DVec3::Z), position: DVec3::Y };
//! assert!(pose.point(DVec3::X).distance(2.0 * DVec3::Y) < 1e-12);
//! assert!(pose.inverse_point(pose.point(DVec3::X)).distance(DVec3::X) < 1e-12);
//!
//! // The same seed gives the same numbers on any machine.
//! assert_eq!(Random::new(7).unit(), Random::new(7).unit());
//! assert!((soffio_math::amplitude_to_db(10.0) - 20.0).abs() < 1e-12);
//! ```

pub mod expression;
pub mod function;
pub mod lanes;
pub mod noise;
pub mod spatial;

pub use function::{Function, Interpolation, Jet3};

pub use glam::{DMat2, DMat3, DMat4, DQuat, DVec2, DVec3};
pub use libm::{acos, asin, atan2, cos, exp, log as ln, log10, pow, sin, sincos, sqrt, tanh};

/// π, at hand.
pub const PI: f64 = std::f64::consts::PI;

/// Rigid placement of a frame in the world: `world = rotation · local + position` (m).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Unit quaternion, local axes to world axes.
    pub rotation: DQuat,
    /// Origin of the frame in the world, m.
    pub position: DVec3,
}

impl Default for Pose {
    fn default() -> Self {
        Self::IDENTITY
    }
}

impl Pose {
    /// The world frame itself.
    pub const IDENTITY: Self = Self { rotation: DQuat::IDENTITY, position: DVec3::ZERO };

    /// World position of a point given in this frame.
    #[inline]
    pub fn point(&self, local: DVec3) -> DVec3 {
        self.rotation * local + self.position
    }

    /// World direction of a vector given in this frame.
    #[inline]
    pub fn vector(&self, local: DVec3) -> DVec3 {
        self.rotation * local
    }

    /// This frame's coordinates of a world point.
    #[inline]
    pub fn inverse_point(&self, world: DVec3) -> DVec3 {
        self.rotation.conjugate() * (world - self.position)
    }

    /// This frame's coordinates of a world vector.
    #[inline]
    pub fn inverse_vector(&self, world: DVec3) -> DVec3 {
        self.rotation.conjugate() * world
    }

    /// Pose between `self` (0) and `other` (1): straight line, shortest normalised quaternion path.
    #[inline]
    pub fn interpolate(&self, other: &Self, alpha: f64) -> Self {
        let sign = if self.rotation.dot(other.rotation) < 0.0 { -1.0 } else { 1.0 };
        let rotation = (self.rotation * (1.0 - alpha) + other.rotation * (sign * alpha)).normalize();
        Self { rotation, position: self.position.lerp(other.position, alpha) }
    }

    /// The pose as a 4×4 matrix, column vectors.
    #[inline]
    pub fn matrix(&self) -> DMat4 {
        DMat4::from_rotation_translation(self.rotation, self.position)
    }
}

/// Coefficients of sin(θ/2)/θ and of cos(θ/2) in powers of (θ/2)², from the first on: ±1/(2 (2n+1)!) and ±1/(2n)!.
const S: [f64; 5] = [-0.5 / 6.0, 0.5 / 120.0, -0.5 / 5040.0, 0.5 / 362_880.0, -0.5 / 39_916_800.0];
const C: [f64; 6] = [-1.0 / 2.0, 1.0 / 24.0, -1.0 / 720.0, 1.0 / 40_320.0, -1.0 / 3_628_800.0, 1.0 / 479_001_600.0];
/// (θ/2)² of a small turn.
const SMALL: f64 = 1e-3;

/// sin(θ/2)/θ and cos(θ/2) of a small turn by x = (θ/2)²: the terms left out are below 10⁻¹⁷.
#[inline(always)]
fn small_turn<T: lanes::Real>(x: T) -> (T, T) {
    let s = x.all(S[0]) + x * (x.all(S[1]) + x * x.all(S[2]));
    let c = x.all(C[0]) + x * (x.all(C[1]) + x * (x.all(C[2]) + x * x.all(C[3])));
    (x.all(0.5) + x * s, x.all(1.0) + x * c)
}

/// Rotation by the vector `w` (axis times angle, rad): the exponential map. Turns of a step, below half a radian, by
/// the Taylor series of sin(θ/2)/θ and cos(θ/2), which end below rounding there.
#[inline]
pub fn rotation(w: DVec3) -> DQuat {
    let x = 0.25 * w.length_squared();
    if x < SMALL {
        let (s, c) = small_turn(x);
        return DQuat::from_xyzw(s * w.x, s * w.y, s * w.z, c);
    }
    if x < 0.0625 {
        // Horner's scheme; products with constants, as a division costs as much as the rest.
        let s = 0.5 + x * (S[0] + x * (S[1] + x * (S[2] + x * (S[3] + x * S[4]))));
        let c = 1.0 + x * (C[0] + x * (C[1] + x * (C[2] + x * (C[3] + x * (C[4] + x * C[5])))));
        return DQuat::from_xyzw(s * w.x, s * w.y, s * w.z, c);
    }
    large_rotation(w)
}

fn large_rotation(w: DVec3) -> DQuat {
    let angle = w.length();
    let (s, c) = sincos(0.5 * angle);
    let s = s / angle;
    DQuat::from_xyzw(s * w.x, s * w.y, s * w.z, c).normalize()
}

/// Product of two quaternions, written out.
#[inline]
pub fn product(p: DQuat, q: DQuat) -> DQuat {
    DQuat::from_xyzw(
        p.w * q.x + p.x * q.w + (p.y * q.z - p.z * q.y),
        p.w * q.y + p.y * q.w + (p.z * q.x - p.x * q.z),
        p.w * q.z + p.z * q.w + (p.x * q.y - p.y * q.x),
        p.w * q.w - (p.x * q.x + p.y * q.y + p.z * q.z),
    )
}

/// A quaternion whose length differs from 1 by rounding, back at 1: one Newton step of 1/√x, exact to rounding.
#[inline]
pub fn renormalized(q: DQuat) -> DQuat {
    q * (1.5 - 0.5 * q.length_squared())
}

/// The inverse of [`rotation`]: axis times angle of a unit quaternion, rad, angle in 0 … 2π.
#[inline]
pub fn rotation_vector(q: DQuat) -> DVec3 {
    let v = DVec3::new(q.x, q.y, q.z);
    let s = v.length();
    // θ/sin(θ/2): two terms of its series below 1e-4.
    let scale = if s < 1e-4 { 2.0 + s * s / 3.0 } else { 2.0 * atan2(s, q.w) / s };
    v * scale
}

/// Matrix of the cross product: `skew(a) · b = a × b`.
#[inline]
pub fn skew(a: DVec3) -> DMat3 {
    DMat3::from_cols(DVec3::new(0.0, a.z, -a.y), DVec3::new(-a.z, 0.0, a.x), DVec3::new(a.y, -a.x, 0.0))
}

/// Outer product `a bᵀ`.
#[inline]
pub fn outer(a: DVec3, b: DVec3) -> DMat3 {
    DMat3::from_cols(a * b.x, a * b.y, a * b.z)
}

/// Two unit vectors that complete `n` (unit) to a right-handed frame (t, b, n), continuous but for one direction
/// (Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 2017).
#[inline]
pub fn tangents(n: DVec3) -> (DVec3, DVec3) {
    let sign = if n.z >= 0.0 { 1.0 } else { -1.0 };
    let a = -1.0 / (sign + n.z);
    let b = n.x * n.y * a;
    (DVec3::new(1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x), DVec3::new(b, sign + n.y * n.y * a, -n.y))
}

/// Decibels of an amplitude ratio; silence is −∞.
#[inline]
pub fn amplitude_to_db(amplitude: f64) -> f64 {
    20.0 * log10(amplitude)
}

/// Amplitude ratio of decibels.
#[inline]
pub fn db_to_amplitude(db: f64) -> f64 {
    pow(10.0, db / 20.0)
}

/// A 64-bit FNV-1a hash of numbers' bits: one word that says whether two runs are the same run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StateHash(pub u64);

impl Default for StateHash {
    fn default() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }
}

impl StateHash {
    /// Mixes in the bits of one number.
    #[inline]
    pub fn add(&mut self, value: f64) {
        for byte in value.to_bits().to_le_bytes() {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
    }

    /// Mixes in a vector.
    #[inline]
    pub fn add_vector(&mut self, v: DVec3) {
        self.add(v.x);
        self.add(v.y);
        self.add(v.z);
    }
}

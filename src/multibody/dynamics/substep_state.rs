//! Substep state: state and rate of bodies, for one or four of them at a time (Munthe-Kaas for rotations).
//!
//! The state of a body is (x, q, v, ω), with a and α from the joints' solve. Within a substep its rotation is q = exp(σ) q₀, and
//! the vector σ is integrated (H. Munthe-Kaas, "Runge–Kutta methods on Lie groups", 1998). A body that spins about a fixed axis,
//! as every wheel does, then turns by exactly the right angle:
//!
//! ```text
//! σ̇ = ω − ½ σ×ω + k σ×(σ×ω)          k = (1 − (θ/2) cot(θ/2))/θ² = 1/12 + θ²/720 + θ⁴/30240 + …,  θ = |σ|
//! ```

use crate::articulation::lane_blocks::State;
use soffio_math::lanes::{Four, Lanes, Quat, Real, V3};
use soffio_math::spatial::SpatialVector;
use soffio_math::spatial::Sym3;

/// Differences of accelerations that Adams' method extrapolates.
pub(super) const ORDER: usize = 3;
/// The same and that of the present step.
pub(super) const DIFFERENCES: usize = ORDER + 1;
/// Errors are relative to this velocity where motion is slower, m/s.
pub(super) const SLOWEST: f64 = 1e-3;

/// The state after `h` seconds at a constant rate, and σ.
#[inline(always)]
pub(super) fn advance<T: Real, L: Lanes<T = T>>(
    lanes: L,
    from: &State<T>,
    h: f64,
    rate: &Rate<T>,
) -> (State<T>, V3<T>) {
    let h = from.rotation.w.all(h);
    let sigma = rate.sigma * h;
    let state = State {
        position: from.position + rate.velocity * h,
        rotation: Quat::of_turn(lanes, sigma).times(from.rotation).renormalized(),
        velocity: from.velocity + rate.acceleration.linear * h,
        spin: from.spin + rate.acceleration.angular * h,
    };
    (state, sigma)
}

/// Rate of change of bodies' states.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Rate<T> {
    /// Velocity of the centre of mass, m/s.
    pub velocity: V3<T>,
    /// σ̇, rad/s.
    pub sigma: V3<T>,
    /// Linear and angular acceleration, m/s² and rad/s².
    pub acceleration: SpatialVector<T>,
}

impl<T: Real> Rate<T> {
    /// The rate of a body with these velocities and accelerations, rotated by `sigma` since the substep began.
    #[inline(always)]
    pub fn of(velocity: V3<T>, spin: V3<T>, sigma: V3<T>, acceleration: SpatialVector<T>) -> Self {
        let across = sigma.cross(spin);
        let x = sigma.dot(sigma);
        let k = x.all(1.0 / 12.0) + x * (x.all(1.0 / 720.0) + x / x.all(30240.0));
        let sigma_rate = spin - across * x.all(0.5) + sigma.cross(across) * k;
        Self { velocity, sigma: sigma_rate, acceleration }
    }

    /// Adds `weight` times another rate.
    #[inline(always)]
    pub fn add(&mut self, weight: f64, other: &Self) {
        let weight = self.velocity.x.all(weight);
        self.velocity += other.velocity * weight;
        self.sigma += other.sigma * weight;
        self.acceleration.linear += other.acceleration.linear * weight;
        self.acceleration.angular += other.acceleration.angular * weight;
    }
}

impl Rate<Four> {
    /// Reads the four lanes.
    #[inline(always)]
    pub fn get<L: Lanes>(&self, lanes: L) -> Rate<L::T> {
        Rate {
            velocity: self.velocity.get(lanes),
            sigma: self.sigma.get(lanes),
            acceleration: self.acceleration.get(lanes),
        }
    }

    /// Writes the four lanes.
    #[inline(always)]
    pub fn set<L: Lanes>(&mut self, lanes: L, rate: &Rate<L::T>) {
        self.velocity.put(lanes, rate.velocity);
        self.sigma.put(lanes, rate.sigma);
        self.acceleration.put(lanes, &rate.acceleration);
    }
}

/// States and rates of four bodies within a substep.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct SubstepState {
    /// State at its start.
    pub start: State<Four>,
    /// Weighted sum of the rates so far.
    pub mean: Rate<Four>,
    /// σ at the present stage, rad.
    pub sigma: V3<Four>,
    /// a at its start.
    pub start_acceleration: SpatialVector<Four>,
    /// Change of a within the last substeps (`adams.rs`).
    pub differences: [SpatialVector<Four>; DIFFERENCES],
    /// a of the last stage.
    pub last_acceleration: SpatialVector<Four>,
    /// (k₅ − k₄)/h³ of the substep before.
    pub previous_estimate: SpatialVector<Four>,
}

/// a − b.
#[inline(always)]
pub(super) fn difference<T: Real>(a: SpatialVector<T>, b: SpatialVector<T>) -> SpatialVector<T> {
    SpatialVector { linear: a.linear - b.linear, angular: a.angular - b.angular }
}

/// v·M v.
#[inline(always)]
pub(super) fn norm<T: Real>(mass: T, inertia: &Sym3<T>, v: &SpatialVector<T>) -> T {
    mass * v.linear.dot(v.linear) + v.angular.dot(inertia.mul(v.angular))
}

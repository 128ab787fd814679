//! State and rate of bodies, for one or four of them: how a state goes on.
//!
//! State of a body: (x, q, v, ω), with a and α from the joints' solve. Within a substep its rotation is written as
//! q = exp(σ) q₀ and the vector σ is integrated (Munthe-Kaas), so that a body spinning about a fixed axis, as every
//! wheel does, turns by exactly the angle it should:
//!
//! ```text
//! σ̇ = ω − ½ σ×ω + k σ×(σ×ω)          k = (1 − (θ/2) cot(θ/2))/θ² = 1/12 + θ²/720 + θ⁴/30240 + …,  θ = |σ|
//! ```

use crate::articulation::ball::Twist;
use crate::articulation::quads::State;
use soffio_math::lanes::{Four, Lanes, Quat, Real, V3};
use soffio_math::spatial::Sym3;

/// Differences of accelerations that Adams' method goes on from, and room for the one of the present step.
pub(super) const ENOUGH: usize = 3;
pub(super) const KEPT: usize = ENOUGH + 1;
/// Slower motion than this is followed no more closely than this one, m/s.
pub(super) const SLOWEST: f64 = 1e-3;

/// A state and `h` times a rate; also σ.
#[inline(always)]
pub(super) fn advance<T: Real, L: Lanes<T = T>>(
    lanes: L,
    from: &State<T>,
    h: f64,
    rate: &Rate<T>,
) -> (State<T>, V3<T>) {
    let h = from.rotation.w.all(h);
    let turn = rate.turn * h;
    let state = State {
        position: from.position + rate.velocity * h,
        rotation: Quat::of_turn(lanes, turn).times(from.rotation).renormalized(),
        velocity: from.velocity + rate.acceleration.linear * h,
        spin: from.spin + rate.acceleration.angular * h,
    };
    (state, turn)
}

/// Rate of change of a body's state.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Rate<T> {
    pub velocity: V3<T>,
    /// σ̇.
    pub turn: V3<T>,
    pub acceleration: Twist<T>,
}

impl<T: Real> Rate<T> {
    /// Of a body that goes like this and has turned by σ since the substep began.
    #[inline(always)]
    pub fn of(velocity: V3<T>, spin: V3<T>, sigma: V3<T>, acceleration: Twist<T>) -> Self {
        let across = sigma.cross(spin);
        let x = sigma.dot(sigma);
        let k = x.all(1.0 / 12.0) + x * (x.all(1.0 / 720.0) + x / x.all(30240.0));
        let turn = spin - across * x.all(0.5) + sigma.cross(across) * k;
        Self { velocity, turn, acceleration }
    }

    /// Adds this share of another.
    #[inline(always)]
    pub fn add(&mut self, weight: f64, other: &Self) {
        let weight = self.velocity.x.all(weight);
        self.velocity += other.velocity * weight;
        self.turn += other.turn * weight;
        self.acceleration.linear += other.acceleration.linear * weight;
        self.acceleration.angular += other.acceleration.angular * weight;
    }
}

impl Rate<Four> {
    /// Reads.
    #[inline(always)]
    pub fn get<L: Lanes>(&self, lanes: L) -> Rate<L::T> {
        Rate {
            velocity: self.velocity.get(lanes),
            turn: self.turn.get(lanes),
            acceleration: self.acceleration.get(lanes),
        }
    }

    /// Writes.
    #[inline(always)]
    pub fn set<L: Lanes>(&mut self, lanes: L, rate: &Rate<L::T>) {
        self.velocity.put(lanes, rate.velocity);
        self.turn.put(lanes, rate.turn);
        self.acceleration.put(lanes, &rate.acceleration);
    }
}

/// What four bodies go through in a substep.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct SubstepState {
    /// Where it began.
    pub start: State<Four>,
    /// Sum of the rates so far, by their weights.
    pub mean: Rate<Four>,
    /// σ at the present stage.
    pub turned: V3<Four>,
    /// a where the substep began, and by how much it has changed within the last ones (`adams.rs`).
    pub begun: Twist<Four>,
    pub differences: [Twist<Four>; KEPT],
    /// a of the last stage.
    pub last: Twist<Four>,
    /// (k₅ − k₄)/h³ of the substep before.
    pub fourth: Twist<Four>,
}

/// a − b.
#[inline(always)]
pub(super) fn less<T: Real>(a: Twist<T>, b: Twist<T>) -> Twist<T> {
    Twist { linear: a.linear - b.linear, angular: a.angular - b.angular }
}

/// v·M v.
#[inline(always)]
pub(super) fn norm<T: Real>(mass: T, inertia: &Sym3<T>, v: &Twist<T>) -> T {
    mass * v.linear.dot(v.linear) + v.angular.dot(inertia.mul(v.angular))
}

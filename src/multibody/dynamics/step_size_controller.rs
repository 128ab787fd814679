//! Step-size controller: accepts or rejects a substep by its error, and suggests the length of the next.
//!
//! Errors are relative to the velocities, in the norm of kinetic energy (`integrate.rs`), and grow as h⁵. There are two
//! tolerances for two kinds of motion. Whole steps may err by [`TOLERANCE_SMOOTH`]: swinging and spinning bodies err in phase more
//! than in energy, and a mobile keeps its energy to 10⁻⁷ over thousands of such steps. Motion that needs several substeps is
//! violent, a whip or an impact. Its errors grow, so each substep is held to [`TOLERANCE_VIOLENT`].

use soffio_math::pow;

/// Largest error of a substep that is a whole step.
const TOLERANCE_SMOOTH: f64 = 1e-6;
/// Largest error of a shorter substep.
const TOLERANCE_VIOLENT: f64 = 5e-9;
/// The suggested length as a fraction of the longest one allowed, so that few substeps are rejected.
const SAFETY_FACTOR: f64 = 0.9;
/// Smallest and largest factor from one length to the next.
const MIN_FACTOR: f64 = 0.2;
const MAX_FACTOR: f64 = 4.0;

/// The controller's decision on a substep.
#[derive(Clone, Copy, Debug)]
pub(super) struct StepSizeDecision {
    /// The substep stands; else it is to be repeated with a shorter length.
    pub accepted: bool,
    /// Longest next substep, s; infinite where the error does not bound it.
    pub suggested_step: f64,
}

/// Decides on a substep of `h` seconds with this relative error, within a step of `dt` seconds.
pub(super) fn decide(h: f64, dt: f64, error: f64) -> StepSizeDecision {
    if !error.is_finite() {
        return StepSizeDecision { accepted: false, suggested_step: MIN_FACTOR * h };
    }
    let whole = h > 0.999 * dt;
    if whole && error <= TOLERANCE_SMOOTH {
        return StepSizeDecision { accepted: true, suggested_step: f64::INFINITY };
    }
    let fitting = |tolerance: f64| h * (SAFETY_FACTOR * pow(tolerance / error.max(1e-300), 0.2));
    let longest = fitting(TOLERANCE_VIOLENT).clamp(MIN_FACTOR * h, MAX_FACTOR * h);
    // Back to whole steps only well within their tolerance.
    let suggested_step = if fitting(0.5 * TOLERANCE_SMOOTH) >= dt { f64::INFINITY } else { longest.min(0.5 * dt) };
    StepSizeDecision { accepted: !whole && error <= TOLERANCE_VIOLENT, suggested_step }
}

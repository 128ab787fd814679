//! How long a substep may be: what the error of the last one says of the next.
//!
//! Errors are shares of the velocities in the norm of the kinetic energy (`integrate.rs`) and grow as h⁵. Two bounds
//! serve two kinds of motion. A whole step is good up to [`TOLERANCE_SMOOTH`]: what swings and turns errs in phase more than in
//! energy, so that a mobile keeps its energy to 10⁻⁷ over thousands of such steps. What needs several substeps is
//! violent, a whip or a hit; its errors feed on themselves, so each is held to [`TOLERANCE_VIOLENT`].

use soffio_math::pow;

/// Largest error of a substep that is a whole step.
const TOLERANCE_SMOOTH: f64 = 1e-6;
/// Largest error of a shorter one.
const TOLERANCE_VIOLENT: f64 = 5e-9;
/// Aim this much shorter than the bound allows, that few substeps are done twice.
const SAFETY_FACTOR: f64 = 0.9;

/// Whether a substep of `h` stands with this error, in steps of `dt` seconds, and the longest that the next may be
/// (infinite: as long as anything else allows).
pub fn judge(h: f64, dt: f64, error: f64) -> (bool, f64) {
    if !error.is_finite() {
        return (false, 0.2 * h);
    }
    let whole = h > 0.999 * dt;
    if whole && error <= TOLERANCE_SMOOTH {
        return (true, f64::INFINITY);
    }
    // Back to whole steps only well inside their bound.
    let fits = |bound: f64| h * (SAFETY_FACTOR * pow(bound / error.max(1e-300), 0.2));
    let longest = fits(TOLERANCE_VIOLENT).clamp(0.2 * h, 4.0 * h);
    let next = if fits(0.5 * TOLERANCE_SMOOTH) >= dt { f64::INFINITY } else { longest.min(0.5 * dt) };
    (!whole && error <= TOLERANCE_VIOLENT, next)
}

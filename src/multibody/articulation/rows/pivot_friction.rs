//! Pivot friction (3 soft rows): J = (0, e) and −(0, e) with compliance Γ = 1/(h c).
//!
//! They give the impulse −h c ω_rel', a viscous torque taken at the *end* of the time h. With c = μ|λ|r / |ω_rel| its
//! size is Coulomb's μ|λ|r while the pivot turns, and the same rows hold it when it stops, at any step length.

use super::JacobianRow;
use soffio_math::DVec3;
use soffio_math::spatial::vec6;

/// Slowest rotation that friction distinguishes from rest, rad/s: below it a pivot creeps by at most this.
const STICTION_RATE: f64 = 1e-7;
/// Smallest friction coefficient c of a soft row, N m s: keeps an unloaded pivot's compliance finite.
const LEAST_VISCOSITY: f64 = 1e-15;

/// The three rows on the first and second body of a joint.
pub fn rows() -> [JacobianRow; 3] {
    DVec3::AXES.map(|e| JacobianRow {
        a: vec6(DVec3::ZERO, e),
        b: vec6(DVec3::ZERO, -e),
        value: 0.0,
        prescribed_rate: 0.0,
        bias: 0.0,
        length: false,
    })
}

/// Γ for a friction torque of at most `torque` (N m) at the relative rate `spin` (rad/s) over `h` seconds.
pub fn compliance(torque: f64, spin: f64, h: f64) -> f64 {
    let viscosity = (torque / spin.max(STICTION_RATE)).max(LEAST_VISCOSITY);
    1.0 / (h * viscosity)
}

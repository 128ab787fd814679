//! The impulse of one hit with friction: stick, slide and reversal, with energetic restitution.
//!
//! Contact frame: z the normal, u the relative velocity of the contact points (u_z < 0 approaches), K the effective
//! inverse mass of the contact (joints included), P the impulse: u = u₀ + K P. During the hit P_z grows and
//!
//! ```text
//! sliding:   dP/dP_z = (−μ u_T/|u_T|, 1)                       Coulomb
//! sticking:  dP/dP_z = (s, 1),  K_TT s = −K_Tz                 keeps u_T = 0; holds where |s| ≤ μ
//! ```
//!
//! (Mirtich 1996; sticking holds exactly where k̂₁₃² + k̂₂₃² ≤ μ² k̂₃₃² in the entries of K⁻¹.) Compression ends at
//! u_z = 0 after the work W_c = ∫ u_z dP_z < 0. Restitution ends when the work given back is −e² W_c (W. J. Stronge,
//! Rigid body collisions with friction, 1990), which is why friction can never create energy, whatever K.
//!
//! The path is followed in steps of P_z small enough that the slip direction turns little within one.

use crate::math::{DMat3, DVec2, DVec3};

/// Steps in which the slip, or the approach where that is larger, is followed through a hit.
const STEPS: f64 = 48.0;
/// Bound on all steps of one hit; a jammed hit needs several times [`STEPS`].
const MOST_STEPS: usize = 4000;
/// Slip below this share of the approach speed is no slip.
const STILL: f64 = 1e-9;

/// Impulse on the first body in the contact frame, N s.
///
/// `k` symmetric positive definite (1/kg), `u` relative velocity (m/s) with u.z < 0, friction coefficient `mu` ≥ 0,
/// energetic restitution `e` in 0…1.
pub fn impulse(k: &DMat3, u: DVec3, mu: f64, e: f64) -> DVec3 {
    let mut p = DVec3::ZERO;
    if u.z >= 0.0 {
        return p;
    }
    let least = -u.z;
    let still = -u.z * STILL;
    let mut v = u;
    let mut work = 0.0;
    let mut goal = f64::INFINITY;
    for _ in 0..MOST_STEPS {
        let slip = DVec2::new(v.x, v.y);
        let speed = slip.length();
        // The slip's direction turns with the slip's own size; the ends of both phases are found exactly.
        let step = speed.max(least) / (k.z_axis.z * STEPS);
        let direction = if speed > still { (-mu * slip / speed).extend(1.0) } else { stick(k, mu) };
        let dv = *k * direction * step;
        let mut share = 1.0;
        // Slip that comes to rest, or nearly: stop there and decide anew.
        let mut stops = false;
        if speed > still {
            let d = DVec2::new(dv.x, dv.y);
            let rest = -slip.dot(d) / d.length_squared().max(f64::MIN_POSITIVE);
            if rest > 0.0 && rest < share && (slip + rest * d).length() < 0.1 * speed {
                share = rest;
                stops = true;
            }
        }
        if goal.is_infinite() {
            if v.z + share * dv.z >= 0.0 {
                share = -v.z / dv.z;
                work += 0.5 * v.z * share * step;
                v += share * dv;
                p += share * step * direction;
                v.z = 0.0;
                goal = -e * e * work;
                work = 0.0;
                if goal <= 0.0 {
                    break;
                }
                continue;
            }
        } else {
            // Work of this step as a function of its share x: (v_z x + dv_z x²/2) step.
            let missing = (goal - work) / step;
            if (v.z + 0.5 * share * dv.z) * share >= missing {
                let root = (v.z * v.z + 2.0 * dv.z * missing).max(0.0).sqrt();
                let share = 2.0 * missing / (v.z + root);
                p += share * step * direction;
                break;
            }
        }
        work += (v.z + 0.5 * share * dv.z) * share * step;
        v += share * dv;
        p += share * step * direction;
        if stops {
            (v.x, v.y) = (0.0, 0.0);
        }
    }
    p
}

/// Direction of the impulse that keeps a contact from slipping, or the edge of the friction cone nearest to it.
fn stick(k: &DMat3, mu: f64) -> DVec3 {
    let (a, b, d) = (k.x_axis.x, k.x_axis.y, k.y_axis.y);
    let (x, y) = (-k.z_axis.x, -k.z_axis.y);
    let determinant = a * d - b * b;
    if determinant <= 0.0 {
        return DVec3::Z;
    }
    let s = DVec2::new(d * x - b * y, a * y - b * x) / determinant;
    let length = s.length();
    (if length <= mu { s } else { s * (mu / length) }).extend(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::skew;
    use crate::noise::Random;

    /// Rounding over a few thousand steps.
    const EXACT: f64 = 1e-9;

    /// K of a free body hit at a random place: E/m − [l]× I⁻¹ [l]×.
    fn random_k(random: &mut Random) -> DMat3 {
        let l = DVec3::new(random.signed(), random.signed(), random.signed());
        let i = DVec3::new(random.range(0.1, 2.0), random.range(0.1, 2.0), random.range(0.1, 2.0)).recip();
        DMat3::IDENTITY - skew(l) * DMat3::from_diagonal(i) * skew(l)
    }

    #[test]
    fn frictionless_hits_return_with_the_restitution() {
        for seed in 0..500 {
            let mut random = Random::new(seed);
            let k = random_k(&mut random);
            let u = DVec3::new(random.signed(), random.signed(), -random.unit() - 0.01);
            let e = random.unit();
            let after = u + k * impulse(&k, u, 0.0, e);
            assert!((after.z + e * u.z).abs() < EXACT, "seed {seed}: {} for {}", after.z, -e * u.z);
        }
    }

    #[test]
    fn energy_never_rises_and_the_cone_is_kept() {
        for seed in 0..20_000 {
            let mut random = Random::new(seed);
            let k = random_k(&mut random);
            let u = DVec3::new(3.0 * random.signed(), 3.0 * random.signed(), -random.unit() - 0.01);
            let (mu, e) = (1.5 * random.unit(), random.unit());
            let p = impulse(&k, u, mu, e);
            // ΔE = P·u + ½ P·K P.
            let change = p.dot(u) + 0.5 * p.dot(k * p);
            assert!(change <= EXACT, "seed {seed}: energy rose by {change}");
            let tangential = DVec2::new(p.x, p.y).length();
            assert!(tangential <= mu * p.z * (1.0 + EXACT), "seed {seed}: {tangential} against {}", mu * p.z);
            assert!((u + k * p).z >= -EXACT, "seed {seed}: still approaching");
        }
    }

    #[test]
    fn a_central_hit_with_much_friction_sticks() {
        let k = DMat3::from_diagonal(DVec3::new(3.5, 3.5, 1.0));
        let u = DVec3::new(0.2, -0.1, -1.0);
        let after = u + k * impulse(&k, u, 0.8, 0.5);
        assert!(DVec2::new(after.x, after.y).length() < EXACT, "{after}");
        assert!((after.z - 0.5).abs() < EXACT);
    }
}

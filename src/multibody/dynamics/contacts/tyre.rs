//! Friction of a tyre: it grows with the slip until the tyre slides entirely.
//!
//! The tread of a rolling tyre is a row of elastic bristles. Each sticks where it touches the ground first, is bent by the slip
//! as it passes through the contact, and slides from where its force exceeds μ times the pressure there. With a parabolic
//! pressure and the same stiffness along and across (brush model; Pacejka, "Tire and Vehicle Dynamics", 3rd edition, 3.2),
//!
//! ```text
//! |P_T| = μ P_n g(z)      g = 3 z − 3 z² + z³ = 1 − (1 − z)³ for z < 1, 1 from there on
//! z = s/s₁                s = |u_T|/V, of pure side slip the tangent of the slip angle
//! ```
//!
//! u_T is the slip velocity, V the speed at which the ground passes through the contact (ω r), and s₁ the slip from which the tyre
//! slides entirely. At small slip the side force is C tan α with the cornering stiffness C = 3 μ N/s₁. As z = |u_T|/c with
//! c = s₁ V, a step sees a friction law in u_T alone. c → 0 is Coulomb's law, so a tyre that stands or is braked has Coulomb's
//! friction.

use super::contact::LOCKED;
use super::contact_law::{EffectiveInverseMass, outer};
use soffio_geometry::bodies::RigidBody;
use soffio_math::{DMat2, DVec2, DVec3};

/// A tyre that rolls slower has Coulomb's friction, m/s: it moves by less than a tenth of a millimetre a second.
const STANDS: f64 = 1e-4;
/// Newton steps for the slip at most. From below they do not overshoot; where the tyre is about to slide, each gains a third.
const NEWTON_STEPS: usize = 32;
/// Where the slip is known to this share, rounding is left.
const ROUNDING: f64 = 1e-14;

/// c = s₁ V of a contact point between two bodies, m/s; 0 where Coulomb's law holds.
pub(super) fn full_slip_speed(
    full_slip: f64,
    [a, b]: [Option<usize>; 2],
    point: DVec3,
    normal: DVec3,
    bodies: &[RigidBody],
) -> f64 {
    if full_slip == 0.0 {
        return 0.0;
    }
    let rolling = |body: Option<usize>| {
        body.map_or(0.0, |i| {
            bodies[i].angular_velocity.cross(point - bodies[i].position).reject_from_normalized(normal).length()
        })
    };
    let speed = rolling(a).max(rolling(b));
    if speed > STANDS { full_slip * speed } else { 0.0 }
}

/// g(z).
fn saturation(z: f64) -> f64 {
    let left = (1.0 - z).max(0.0);
    1.0 - left * left * left
}

/// dg/dz.
fn saturation_slope(z: f64) -> f64 {
    let left = (1.0 - z).max(0.0);
    3.0 * left * left
}

/// The impulse that satisfies Signorini's law and the tyre's, normal first; `full` is c.
pub(super) fn relax(mass: &EffectiveInverseMass, (friction, full): (f64, f64), p: DVec3, u: DVec3) -> DVec3 {
    let normal = (p.x - u.x / mass.k.x_axis.x).max(0.0);
    let with_normal = u + mass.k.x_axis * (normal - p.x);
    let k = if mass.tangential > LOCKED { mass.tangential } else { 0.0 };
    // w: the slip without friction. Friction −g e leaves |u_T| = x with x + k μ N g(x/c) = |w|.
    let w = DVec2::new(with_normal.y, with_normal.z) - k * DVec2::new(p.y, p.z);
    let (speed, most) = (w.length(), friction * normal);
    let mut x = 0.0;
    for _ in 0..NEWTON_STEPS {
        let excess = speed - x - k * most * saturation(x / full);
        if excess <= ROUNDING * speed {
            break;
        }
        x += excess / (1.0 + k * most * saturation_slope(x / full) / full);
    }
    let force = -most * saturation(x / full) * w.normalize_or_zero();
    DVec3::new(normal, force.x, force.y)
}

/// Friction over the normal impulse at the slip `u_T`, and −∂P_T/∂u_T at the normal impulse N.
pub(super) fn branch((friction, full): (f64, f64), normal: f64, slip: DVec2) -> (DVec2, DMat2) {
    let (x, most) = (slip.length(), friction * normal);
    let z = x / full;
    let e = slip.normalize_or_zero();
    let (along, secant) =
        (most * saturation_slope(z) / full, if x > 0.0 { most * saturation(z) / x } else { 3.0 * most / full });
    (-friction * saturation(z) * e, DMat2::IDENTITY * secant + outer(e) * (along - secant))
}

#[cfg(test)]
mod tests {
    use super::*;
    use soffio_math::DMat3;
    use soffio_math::noise::Random;

    /// Friction coefficient and c, m/s.
    const LAW: (f64, f64) = (0.6, 0.2);

    #[test]
    fn a_relaxed_tyre_presses_and_its_friction_follows_the_slip() {
        /// Velocity and impulse that rounding may leave, m/s and N s of unit masses.
        const ROUNDING: f64 = 1e-12;
        let mass = EffectiveInverseMass { k: DMat3::IDENTITY, inverse: DMat3::IDENTITY, tangential: 1.0, arm: 1.0 };
        for seed in 0..2_000 {
            let mut random = Random::new(seed);
            let mut signed = || random.signed();
            let (p, u) = (DVec3::new(1.0, 0.2 * signed(), 0.2 * signed()), DVec3::new(signed(), signed(), signed()));
            let to = relax(&mass, LAW, p, u);
            let after = u + (to - p);
            let slip = DVec2::new(after.y, after.z);
            let expected = -LAW.0 * to.x * saturation(slip.length() / LAW.1) * slip.normalize_or_zero();
            assert!(to.x == 0.0 || after.x.abs() < ROUNDING, "seed {seed}: {after}");
            assert!((DVec2::new(to.y, to.z) - expected).length() < ROUNDING, "seed {seed}: {to} at {slip}");
        }
    }

    #[test]
    fn the_branch_has_the_derivative_that_it_returns() {
        const STEP: f64 = 1e-6;
        /// A central difference of a cubic, and rounding over the step, as a part of the slope.
        const DIFFERENCE: f64 = 1e-8;
        for seed in 0..500 {
            let mut random = Random::new(seed);
            let slip = 0.15 * DVec2::new(random.signed(), random.signed());
            let (_, derivative) = branch(LAW, 2.0, slip);
            for axis in [DVec2::X, DVec2::Y] {
                let at = |side: f64| 2.0 * branch(LAW, 2.0, slip + side * STEP * axis).0;
                let difference = (at(1.0) - at(-1.0)) / (2.0 * STEP);
                let error = (difference + derivative * axis).length();
                // The third derivative jumps where the tyre begins to slide, and without slip.
                let smooth = (slip.length() / LAW.1 - 1.0).abs() > 1e-4 && slip.length() > 1e-3;
                let slope = (derivative * axis).length();
                assert!(!smooth || error < DIFFERENCE * (1.0 + slope), "seed {seed}: {error} of {slope}");
            }
        }
    }
}

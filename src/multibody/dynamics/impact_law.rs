//! Frictional impact at one point (Routh, Mirtich, Stronge): stick, slide and reversal, with energetic restitution.
//!
//! Contact frame: z the normal, u the relative velocity of the contact points (u_z < 0 approaches), K the effective
//! inverse mass of the contact (joints included), P the impulse: u = u₀ + K P. During the impact P_z grows and
//!
//! ```text
//! sliding:   dP/dP_z = (−μ d, 1),  d = u_T/|u_T|               Coulomb
//! sticking:  dP/dP_z = (s, 1),     K_TT s = −K_Tz              keeps u_T = 0; holds where |s| ≤ μ
//! starting:  dP/dP_z = (−μ d, 1),  K_TT (−μ d) + K_Tz = η d, η > 0      slip that grows from zero where |s| > μ
//! ```
//!
//! (B. Mirtich, Impulse-based Dynamic Simulation, 1996.) With k̂ the entries of K⁻¹, s = (k̂₁₃, k̂₂₃)/k̂₃₃, so sticking
//! holds exactly where k̂₁₃² + k̂₂₃² ≤ μ² k̂₃₃². The form with K_TT is used because joints may make K singular. P_z is the
//! parameter throughout, because it grows for any K, while u_z may fall again during restitution.
//!
//! Compression ends at u_z = 0 after the work W_c = ∫ u_z dP_z < 0, restitution when it has returned the work −e² W_c
//! (W. J. Stronge, Rigid body collisions with friction, 1990). Then ΔE = (1 − e²) W_c + friction's work ≤ 0 for any K.
//!
//! # Exact where it can be
//!
//! Along a straight piece of the path u is linear in P_z and the work quadratic, so the ends of the piece (slip stops,
//! compression ends, restitution ends) are roots in closed form. Sticking and starting slip are straight to the end. Sliding
//! is straight where K keeps its direction (no friction, central impacts, plane motion). Else the slip turns, and chords that
//! turn little follow its path. Each has the slip's direction in its middle, so friction never does positive work. The cone is
//! convex, so the chords keep both bounds, of energy and of friction.

use soffio_math::{DMat3, DVec2, DVec3};

/// Largest angle by which slip turns along half a chord, rad.
const CHORD_ANGLE: f64 = 0.05;
/// Halvings of a chord until it turns by no more, and bisections for its direction.
const HALVINGS: usize = 40;
/// Pieces of one path; a slip that stops in a spiral takes some dozens.
const MAX_PIECES: usize = 4000;
/// Slip below this fraction of the approach speed, or of the initial slip, is zero.
const NO_SLIP: f64 = 1e-9;
/// No chord is shorter than this fraction of the impulse so far.
const MIN_CHORD: f64 = 1e-14;
/// A direction that changes by less than this is constant, rad.
const STRAIGHT: f64 = 1e-12;
/// In directions whose eigenvalue of K_TT is below this fraction of its trace, joints hold all slip.
const HELD_BY_JOINTS: f64 = 1e-9;

/// State of an impact on its path.
#[derive(Clone, Copy, Debug)]
struct Path {
    /// Impulse (N s) and velocity (m/s) so far.
    p: DVec3,
    u: DVec3,
    /// Normal work of the present phase, J; and that which restitution has to return, infinite during compression.
    work: f64,
    goal: f64,
    done: bool,
}

impl Path {
    /// P_z until the present phase ends, if u_z changes at this rate; infinite where it never ends.
    fn phase(&self, rate: f64) -> f64 {
        if self.goal.is_infinite() {
            return if rate > 0.0 { -self.u.z / rate } else { f64::INFINITY };
        }
        // u_z x + rate x²/2 is returned after x more.
        let missing = self.goal - self.work;
        let root = self.u.z * self.u.z + 2.0 * rate * missing;
        if missing <= 0.0 {
            0.0
        } else if root >= 0.0 && self.u.z + root.sqrt() > 0.0 {
            2.0 * missing / (self.u.z + root.sqrt())
        } else {
            f64::INFINITY
        }
    }

    /// Follows dP/dP_z = `along` until the impact ends, for at most `max` of P_z.
    fn follow(&mut self, k: &DMat3, along: DVec3, e: f64, max: f64) {
        let rate = *k * along;
        if max.is_infinite() && rate.z <= HELD_BY_JOINTS * k.z_axis.z {
            // Wedged: no motion is left.
            self.done = true;
        }
        let mut left = max;
        while left > 0.0 && !self.done {
            let end = self.phase(rate.z);
            let part = end.min(left);
            if !part.is_finite() {
                // The phase never ends: only by rounding.
                self.done = true;
                return;
            }
            self.work += (self.u.z + 0.5 * part * rate.z) * part;
            self.p += part * along;
            self.u += part * rate;
            left -= part;
            if end > part {
                return;
            }
            if self.goal.is_infinite() {
                (self.u.z, self.goal, self.work) = (0.0, -e * e * self.work, 0.0);
            } else {
                self.done = true;
            }
        }
    }
}

/// Impulse of an impact on the first body in the contact frame, N s; zero if u.z ≥ 0.
///
/// `k` is the effective inverse mass, symmetric positive semi-definite with k_zz > 0 (1/kg), `u` the relative velocity before
/// (m/s), `mu` ≥ 0 the friction coefficient and `e` in 0…1 the energetic restitution.
pub fn impulse(k: &DMat3, u: DVec3, mu: f64, e: f64) -> DVec3 {
    let mut path = Path { p: DVec3::ZERO, u, work: 0.0, goal: f64::INFINITY, done: u.z >= 0.0 };
    let no_slip = NO_SLIP * u.z.abs().max(u.truncate().length());
    for _ in 0..MAX_PIECES {
        if path.done {
            break;
        }
        let slip = path.u.truncate();
        let speed = slip.length();
        if mu == 0.0 || speed <= no_slip {
            break;
        }
        let Chord { direction, length } = chord(k, slip / speed, speed, mu, &path);
        path.follow(k, (-mu * direction).extend(1.0), e, length);
        if !path.done && path.u.truncate().length() <= 2.0 * no_slip {
            (path.u.x, path.u.y) = (0.0, 0.0);
        }
    }
    if !path.done {
        path.follow(k, from_rest(k, mu).along, e, f64::INFINITY);
    }
    path.p
}

/// A straight piece of a sliding path.
struct Chord {
    /// Direction of slip that friction opposes; a unit vector.
    direction: DVec2,
    /// Length in P_z, N s.
    length: f64,
}

/// The next piece of a slide. Its direction m is that of the slip in the middle of the chord, m ∥ u_T + ½ x K_T(−μ m, 1), found as a
/// root. Where joints make K stiff, slip turns to its final direction at once, and only an implicit rule follows it with
/// chords of reasonable length.
fn chord(k: &DMat3, d: DVec2, speed: f64, mu: f64, path: &Path) -> Chord {
    let rate = |d: DVec2| (*k * (-mu * d).extend(1.0)).truncate();
    let first = rate(d);
    let turning = d.perp_dot(first);
    let slows = -first.dot(d);
    let stops = if slows > 0.0 { speed / slows } else { f64::INFINITY };
    if turning.abs() <= STRAIGHT * first.length() {
        return Chord { direction: d, length: stops };
    }
    // A chord never halves the slip, nor leads into another phase.
    let mut long = (0.5 * stops).min(path.phase((*k * (-mu * d).extend(1.0)).z)).max(MIN_CHORD * path.p.z);
    if !long.is_finite() {
        long = speed / turning.abs();
    }
    let middle = |angle: f64| (d + d.perp() * (angle * turning.signum())).normalize_or(d);
    // Slip in the middle of the chord.
    let there = |m: DVec2, long: f64| d * speed + 0.5 * long * rate(m);
    let ahead = |m: DVec2, long: f64| m.perp_dot(there(m, long)) * turning.signum();
    for _ in 0..HALVINGS {
        let far = middle(CHORD_ANGLE);
        if ahead(far, long) <= 0.0 && far.dot(there(far, long)) > 0.5 * speed && there(far, 2.0 * long).dot(far) > 0.0 {
            break;
        }
        long *= 0.5;
    }
    let (mut low, mut high) = (0.0, CHORD_ANGLE);
    for _ in 0..HALVINGS {
        let half = 0.5 * (low + high);
        if ahead(middle(half), long) > 0.0 { low = half } else { high = half }
    }
    Chord { direction: middle(high), length: long }
}

/// How a contact without slip continues.
#[derive(Clone, Copy, Debug)]
pub struct ZeroSlip {
    /// dP/dP_z.
    pub along: DVec3,
    /// It sticks; else slip starts.
    pub sticks: bool,
}

/// Continuation of a contact whose slip has become zero, with the effective inverse mass `k` (1/kg) and the friction coefficient `mu`.
pub fn from_rest(k: &DMat3, mu: f64) -> ZeroSlip {
    let stick = sticking(k);
    if stick.length() <= mu {
        return ZeroSlip { along: stick.extend(1.0), sticks: true };
    }
    if mu == 0.0 {
        return ZeroSlip { along: DVec3::Z, sticks: false };
    }
    ZeroSlip { along: (-mu * starting_slip(k, mu, stick)).extend(1.0), sticks: false }
}

/// s with K_TT s = −K_Tz, the shortest where joints hold a direction.
fn sticking(k: &DMat3) -> DVec2 {
    let (a, b, d) = (k.x_axis.x, k.x_axis.y, k.y_axis.y);
    let (mean, half) = (0.5 * (a + d), 0.5 * (a - d));
    let radius = (half * half + b * b).sqrt();
    let wanted = -k.z_axis.truncate();
    // Eigenvector of the larger eigenvalue.
    let raw = if half >= 0.0 { DVec2::new(half + radius, b) } else { DVec2::new(b, radius - half) };
    let first = raw.normalize_or(DVec2::X);
    let along = |axis: DVec2, value: f64| {
        if value > HELD_BY_JOINTS * 2.0 * mean { axis * (axis.dot(wanted) / value) } else { DVec2::ZERO }
    };
    along(first, mean + radius) + along(first.perp(), mean - radius)
}

/// Direction d in which slip starts where friction cannot hold it: the root of d × (K_TT(−μ d) + K_Tz) along which slip grows.
/// There is just one (Mirtich 1996), on the side of −s.
fn starting_slip(k: &DMat3, mu: f64, stick: DVec2) -> DVec2 {
    let rate = |d: DVec2| (*k * (-mu * d).extend(1.0)).truncate();
    let mut best = -stick.normalize_or(DVec2::X);
    // Slip in any direction turns towards it: follow that in halving steps.
    let mut step = 0.5;
    for _ in 0..120 {
        let turning = best.perp_dot(rate(best));
        if turning == 0.0 {
            break;
        }
        let next = (best + best.perp() * (step * turning.signum())).normalize_or(best);
        let over = next.perp_dot(rate(next)).signum() != turning.signum();
        if over {
            step *= 0.5;
        } else {
            best = next;
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;
    use soffio_math::noise::Random;
    use soffio_math::skew;

    /// Rounding over a path.
    const EXACT: f64 = 1e-12;

    /// K of a free body with an impact at a random place: E/m − [l]× I⁻¹ [l]×.
    fn random_k(random: &mut Random) -> DMat3 {
        let l = DVec3::new(random.signed(), random.signed(), random.signed());
        let i = DVec3::new(random.range(0.1, 2.0), random.range(0.1, 2.0), random.range(0.1, 2.0)).recip();
        DMat3::IDENTITY - skew(l) * DMat3::from_diagonal(i) * skew(l)
    }

    fn random_u(random: &mut Random) -> DVec3 {
        DVec3::new(3.0 * random.signed(), 3.0 * random.signed(), -random.unit() - 0.01)
    }

    /// The same path by small steps of the second order: independent of chords and closed forms.
    fn by_steps(k: &DMat3, u: DVec3, mu: f64, e: f64) -> DVec3 {
        const STEPS: f64 = 20_000.0;
        let step = u.length() / (k.z_axis.z * STEPS);
        let along = |v: DVec3| {
            let slip = v.truncate();
            if slip.length() > 1e-3 * u.length() {
                (-mu * slip.normalize()).extend(1.0)
            } else {
                from_rest(k, mu).along
            }
        };
        let (mut v, mut p, mut work, mut goal) = (u, DVec3::ZERO, 0.0, f64::INFINITY);
        while work < goal {
            let middle = v + *k * along(v) * (0.5 * step);
            let d = along(middle);
            let next = v + *k * d * step;
            work += 0.5 * (v.z + next.z) * step;
            (v, p) = (next, p + d * step);
            if goal.is_infinite() && v.z >= 0.0 {
                (goal, work) = (-e * e * work, 0.0);
            }
        }
        p
    }

    #[test]
    fn frictionless_impacts_return_with_the_restitution() {
        for seed in 0..500 {
            let mut random = Random::new(seed);
            let k = random_k(&mut random);
            let u = random_u(&mut random);
            let e = random.unit();
            let after = u + k * impulse(&k, u, 0.0, e);
            assert!((after.z + e * u.z).abs() < EXACT, "seed {seed}: {} for {}", after.z, -e * u.z);
        }
    }

    #[test]
    fn energy_never_rises_and_the_cone_is_kept() {
        for seed in 0..100_000 {
            let mut random = Random::new(seed);
            let k = random_k(&mut random);
            let u = random_u(&mut random);
            let (mu, e) = (1.5 * random.unit(), random.unit());
            let p = impulse(&k, u, mu, e);
            // ΔE = P·u + ½ P·K P.
            let change = p.dot(u) + 0.5 * p.dot(k * p);
            assert!(change <= EXACT, "seed {seed}: energy rose by {change}");
            let tangential = p.truncate().length();
            assert!(tangential <= mu * p.z * (1.0 + EXACT), "seed {seed}: {tangential} against {}", mu * p.z);
            assert!((u + k * p).z >= -EXACT, "seed {seed}: still approaching");
        }
    }

    #[test]
    fn paths_agree_with_small_steps() {
        // Chords turn by a tenth of a radian: a per mille of the path; the steps lose as much where slip stops.
        const AGREES: f64 = 5e-3;
        for seed in 0..300 {
            let mut random = Random::new(seed);
            let k = random_k(&mut random);
            let u = random_u(&mut random);
            let (mu, e) = (1.2 * random.unit(), random.unit());
            let (p, slow) = (impulse(&k, u, mu, e), by_steps(&k, u, mu, e));
            assert!((p - slow).length() < AGREES * slow.length(), "seed {seed}: {p} against {slow}, mu {mu}, u {u}");
        }
    }

    #[test]
    fn a_contact_at_rest_sticks_where_the_inverse_says() {
        let mut slid = 0;
        for seed in 0..20_000 {
            let mut random = Random::new(seed);
            let k = random_k(&mut random);
            let mu = random.unit();
            let inverse = k.inverse();
            let wanted = inverse.z_axis.truncate().length() <= mu * inverse.z_axis.z;
            let ZeroSlip { along, sticks } = from_rest(&k, mu);
            assert_eq!(sticks, wanted, "seed {seed}");
            if !sticks {
                // Slip starts along a straight line, against friction.
                let (rate, d) = ((k * along).truncate(), -along.truncate() / mu);
                assert!(rate.dot(d) > 0.0 && d.perp_dot(rate).abs() < EXACT * rate.length(), "seed {seed}");
                slid += 1;
            }
        }
        assert!(slid > 1000);
    }

    #[test]
    fn a_central_impact_with_much_friction_sticks() {
        let k = DMat3::from_diagonal(DVec3::new(3.5, 3.5, 1.0));
        let u = DVec3::new(0.2, -0.1, -1.0);
        let after = u + k * impulse(&k, u, 0.8, 0.5);
        assert!(after.truncate().length() < EXACT, "{after}");
        assert!((after.z - 0.5).abs() < EXACT);
    }

    #[test]
    fn joints_that_hold_all_slip_leave_a_plain_bounce() {
        // One direction of motion in all: K = w wᵀ.
        let w = DVec3::new(0.6, 0.0, 0.8);
        let k = DMat3::from_cols(w * w.x, w * w.y, w * w.z);
        let u = -2.0 * w;
        let after = u + k * impulse(&k, u, 0.1, 0.5);
        assert!(after.z > 0.0 && after.z <= -0.5 * u.z + EXACT, "{after}");
    }
}

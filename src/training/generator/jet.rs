//! Mean air speed in the round turbulent jet of a mouth, for any envelope of the speed at the lips.
//!
//! # Steady jet
//!
//! From a round opening of the diameter d (m) with the speed U₀ (m/s), the mean speed at the distance x along the axis
//! and r across it is (Pope, Turbulent Flows, 2000, section 5.1; Hussein, Capp and George, J. Fluid Mech. 258, 1994)
//!
//! ```text
//! U(x, r) = U_c(x) exp(−ln 2 · (r/r_h)²),   U_c = 6 d U₀/x,   r_h = 0.094 x
//! ```
//!
//! so speed falls as 1/x, and the pressure of turbulence, which is ∝ U², by 22 dB from 10 to 36 cm. Within the
//! potential core, x < 6 d, the speed is U₀ and the half radius about that of the opening.
//!
//! # Starting and ending
//!
//! Let u(x, t) be the centre-line speed. Momentum per length is m ∝ x² u, as the cross-section is ∝ x². Its flux is
//! β u m, with a factor β for the profile. Momentum is conserved: ∂m/∂t + ∂(β u m)/∂x = 0. With φ = u x (m²/s) and
//! s = x²/2 (m²) this is Burgers' equation without viscosity, and at the lips φ₀ = 6 d U₀:
//!
//! ```text
//! ∂φ/∂t + ∂(β φ²)/∂s = 0,   φ(0, t) = φ₀(t)
//! ```
//!
//! Its shock is the front of the starting jet: ds/dt = β φ, thus x_f = √(2 β φ₀ t). Measured fronts go as
//! x_f = 3 (M/ρ)^¼ √t with the momentum flux M/ρ = U₀² π d²/4 (Hill and Ouellette, J. Fluids Eng. 121, 1999), thus
//! x_f² = 7.98 d U₀ t, and β = 0.66. After the end of the breath its fan is φ = s/(2 β (t − t_end)), the wave of
//! entrainment in an ending jet (Musculus, J. Fluid Mech. 638, 2009): the speed falls as x/(4 β (t − t_end)).
//!
//! The solution is that of Lax and Oleinik (Lax, Comm. Pure Appl. Math. 10, 1957). Of all times τ of emission, the air
//! at (s, t) is that which minimises
//!
//! ```text
//! W(τ) = −β ∫₀^τ φ₀² dτ' + s²/(4 β (t − τ)),   φ = s/(2 β (t − τ)) where W < 0, else 0: the front is yet to come
//! ```
//!
//! τ never goes back in time, so the search is short. Turbulent mixing smears the front by a share of the eddies'
//! time x/u.

use soffio_math::exp;

/// Spacing of speeds in time, s.
pub(super) const STEP: f64 = 0.002;
/// Samples of a step at [`super::noise::RATE`].
pub(super) const SAMPLES: usize = 32;
/// Decay of the centre line: U_c x = 6 d U₀ (Pope 2000: 5.8 to 6.1).
const DECAY: f64 = 6.0;
/// Half-velocity radius over distance (Pope 2000).
const SPREAD: f64 = 0.094;
/// Half-velocity radius at the lips over their diameter: the edge of the opening, a little rounded.
const CORE: f64 = 0.45;
/// β of the front (file's head).
const FRONT: f64 = 0.66;
/// Smearing of the front, as a share of x/u.
const MIXING: f64 = 0.2;
/// Slower air is still, m/s: currents of the room are as fast.
pub(super) const STILL: f64 = 0.1;
/// ln 2.
const LN_2: f64 = std::f64::consts::LN_2;

/// Half-velocity radius, m, at the distance `x`, m, from an opening of the diameter `d`, m.
pub(super) fn half_radius(x: f64, d: f64) -> f64 {
    ((SPREAD * x) * (SPREAD * x) + (CORE * d) * (CORE * d)).sqrt()
}

/// Share of the centre line's speed at `r`, m, from the axis of a jet of the half radius `half`, m.
pub(super) fn profile(r: f64, half: f64) -> f64 {
    exp(-LN_2 * (r / half) * (r / half))
}

/// Centre-line speed, m/s, of the steady jet.
pub(super) fn steady(lips: f64, d: f64, x: f64) -> f64 {
    let (x2, core) = (x * x, (DECAY * d) * (DECAY * d));
    // The fourth root of the sum of fourth powers joins the core and the decay.
    DECAY * d * lips / (x2 * x2 + core * core).sqrt().sqrt()
}

/// Centre-line speed, m/s, every [`STEP`], at `x`, m, of the jet whose speed at the lips is `lips`, m/s, every [`STEP`].
/// It begins with the lips' first value and ends when the air is still.
pub(super) fn centre_line(lips: &[f64], d: f64, x: f64) -> Vec<f64> {
    let s = 0.5 * x * x;
    // φ at x follows from that of the steady jet, so the core is as fast as the lips.
    let to_speed = steady(1.0, d, x) / (DECAY * d);
    let mut emitted = Vec::with_capacity(lips.len() + 1);
    let mut sum = 0.0;
    for u in lips {
        emitted.push(sum);
        let phi = DECAY * d * u;
        sum += FRONT * phi * phi * STEP;
    }
    emitted.push(sum);
    let longest = lips.len() + (x / (4.0 * FRONT * STILL) / STEP) as usize + 200;
    let travel: Vec<f64> = (0..=longest).map(|k| s * s / (4.0 * FRONT * STEP * (k.max(1)) as f64)).collect();
    let (mut out, mut tau) = (Vec::with_capacity(longest), 0);
    for t in 0..longest {
        let mut best = (f64::INFINITY, tau);
        for from in tau..emitted.len().min(t) {
            let w = travel[t - from] - emitted[from];
            if w < best.0 {
                best = (w, from);
            }
        }
        let phi = if best.0 < 0.0 {
            tau = best.1;
            // Between the speeds that left the lips around τ; the grid of τ alone would be too coarse near the lips.
            let around = [tau.saturating_sub(1), tau, tau + 1].map(|i| lips.get(i).map_or(0.0, |u| DECAY * d * u));
            let (low, high) = around.iter().fold((f64::INFINITY, 0.0_f64), |(l, h), x| (l.min(*x), h.max(*x)));
            (s / (2.0 * FRONT * STEP * (t - tau) as f64)).clamp(low, high)
        } else {
            0.0
        };
        out.push(to_speed * phi);
        if t > lips.len() && out[t] < STILL && out[t] > 0.0 {
            break;
        }
    }
    smear(&mut out, x);
    out
}

/// Two smoothings, one after the other, of the time [`MIXING`] x/u each.
fn smear(speed: &mut [f64], x: f64) {
    let fastest = speed.iter().copied().fold(STILL, f64::max);
    let share = STEP / (STEP + (MIXING * x / fastest).min(0.15));
    for _ in 0..2 {
        let mut state = 0.0;
        for u in speed.iter_mut() {
            state += share * (*u - state);
            *u = state;
        }
    }
}

//! Mean flow of a breath: a round turbulent jet that starts, lasts and stops.
//!
//! ```text
//! √J     = u₀ √A = ½√π u₀ D                      root of the momentum flux per density, m²/s
//! U_c    = min(u₀, B u₀ D / x),   B = 5.85       speed on the axis
//! U(r)   = U_c e^(−ln 2 · ϱ²),    ϱ = r / (S x)  S = 0.082 … 0.096: the angle of half the speed, 4.7° … 5.5°
//! u'(r)  = 0.27 U_c e^(−0.09 ϱ⁴)                 fluctuation: 0.25 U_c at ϱ = 1, and 0.1 U_c at ϱ = 1.8
//! γ(r)   = 1 / (1 + (ϱ / 1.85)⁸)                 share of the time in which the air is turbulent
//! t(x)   = x² / (F² √J),          F = 2.95       time from the lips to x; half of it for air of the release
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | u₀, D, A | speed at the lips; diameter and area of a round opening of the same area | m/s, m, m² |
//! | x, r | distance from the lips along the axis, and from the axis | m |
//!
//! The momentum of a jet is the same at each distance, so a change at the lips travels as a wave: each parcel keeps its J.
//! A parcel that is overtaken by a stronger one becomes part of it, which makes the front. When the flow at the lips stops, the
//! wave of the release runs twice as fast as the front, and the speed behind it falls as x / t.
//!
//! References: Wygnanski and Fiedler, J. Fluid Mech. 38 (1969); Hussein, Capp and George, J. Fluid Mech. 258 (1994), for
//! decay, width, fluctuation and intermittency. Witze, AIAA J. 21 (1983); Sangras, Kwon and Faeth, J. Heat Transfer 124
//! (2002), for the front. Musculus, J. Fluid Mech. 638 (2009), for the end.

use soffio_math::exp;

/// Steps of all speeds over time, a second: one value a millisecond.
pub const STEPS_A_SECOND: f64 = 1000.0;
/// B, decay of the speed on the axis (Hussein et al. 1994: 5.8; Wygnanski and Fiedler 1969: 5.9 within 50 diameters).
pub const DECAY: f64 = 5.85;
/// S, half-width over distance, narrowest and widest (Wygnanski and Fiedler 1969: 0.086; Hussein et al. 1994: 0.094).
pub const SPREAD: (f64, f64) = (0.082, 0.096);
/// F, of the front x = F (J^¼) t^½ (Sangras et al. 2002: 2.8 to 3.0).
pub const FRONT: f64 = 2.95;
/// Fluctuation on the axis over the mean speed there (Hussein et al. 1994: 0.28; Wygnanski and Fiedler 1969: 0.25 to 0.29).
pub const INTENSITY: f64 = 0.27;
/// Steepness of the fluctuation's profile, fitted to Wygnanski and Fiedler's figure 8.
const FLUCTUATION_FALL: f64 = 0.09;
/// ϱ at which the air is turbulent half of the time (Wygnanski and Fiedler 1969: r = 0.16 x).
const HALF_TURBULENT: f64 = 1.85;
/// √π / 2: root of the area over the diameter.
const ROOT_AREA: f64 = 0.886_227;
/// ln 2.
const LN_2: f64 = std::f64::consts::LN_2;
/// Wave of the release over wave of the front (Musculus 2009).
const RELEASE_WAVE: f64 = 2.0;
/// Length of the front over the distance: the vortices at the head of a starting jet are about a tenth of it long.
const FRONT_LENGTH: f64 = 0.12;
/// Speed below which a parcel is forgotten, m/s.
const STILL_M_S: f64 = 0.02;

/// A jet from an opening.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jet {
    /// D, diameter of a round opening of the same area, m.
    pub opening: f64,
    /// S, half-width over distance.
    pub spread: f64,
}

impl Jet {
    /// Speed on the axis at a distance (m), for a speed at the lips (m/s).
    pub fn axis_speed(&self, lips: f64, distance: f64) -> f64 {
        lips * (DECAY * self.opening / distance.max(1e-4)).min(1.0)
    }

    /// Time from the lips to a distance (m), s, of air with a speed at the lips (m/s).
    pub fn travel(&self, lips: f64, distance: f64) -> f64 {
        distance * distance / (FRONT * FRONT * ROOT_AREA * self.opening * lips.max(1e-6))
    }

    /// ϱ, distance from the axis (m) in half-widths at a distance from the lips (m).
    pub fn offset(&self, beside: f64, distance: f64) -> f64 {
        // Near the lips the jet is as wide as the opening.
        beside / (self.spread * distance).max(0.5 * self.opening)
    }

    /// Speed on the axis at a distance (m) for each step of the speed at the lips; `release` is the first step of the release.
    pub fn arriving(&self, lips: &[f64], release: usize, distance: f64) -> Vec<f64> {
        let mut out = vec![0.0; lips.len()];
        let parcel = |i: usize| {
            let wave = if i < release { 1.0 } else { RELEASE_WAVE };
            let late = self.travel(lips[i], distance) / wave * STEPS_A_SECOND;
            (lips[i] > STILL_M_S).then(|| (i as f64 + late, self.axis_speed(lips[i], distance)))
        };
        let mut last = None;
        for i in 0..lips.len() {
            let now = parcel(i);
            if let (Some((from, before)), Some((until, after))) = (last, now)
                && until > from
            {
                let first = (from.ceil() as usize).min(out.len());
                let end = (until.ceil() as usize).clamp(first, out.len());
                for (k, y) in out[first..end].iter_mut().enumerate() {
                    let part = ((first + k) as f64 - from) / (until - from);
                    *y = before + part * (after - before);
                }
            }
            last = now;
        }
        out
    }

    /// Blurs a speed over time, as the front at a distance is no jump but about a tenth of the distance long.
    pub fn blurred(&self, speed: &[f64], distance: f64) -> Vec<f64> {
        let peak = speed.iter().copied().fold(STILL_M_S, f64::max);
        let width = (FRONT_LENGTH * distance / peak * STEPS_A_SECOND).clamp(2.0, 100.0) as usize;
        // Two means in a row: a triangle.
        let mean = |values: Vec<f64>| {
            let mut sum = 0.0;
            let next = |i: usize| {
                sum += values[i];
                sum -= if i >= width { values[i - width] } else { 0.0 };
                (sum / width as f64).max(0.0)
            };
            (0..values.len()).map(next).collect::<Vec<f64>>()
        };
        mean(mean(speed.to_vec()))
    }
}

/// U(r) / U_c at ϱ.
pub fn mean_profile(offset: f64) -> f64 {
    exp(-LN_2 * offset * offset)
}

/// u'(r) / U_c at ϱ.
pub fn fluctuation_profile(offset: f64) -> f64 {
    let square = offset * offset;
    INTENSITY * exp(-FLUCTUATION_FALL * square * square)
}

/// γ, share of the time in which the air is turbulent at ϱ.
pub fn turbulent_share(offset: f64) -> f64 {
    let square = (offset / HALF_TURBULENT) * (offset / HALF_TURBULENT);
    let fourth = square * square;
    1.0 / (1.0 + fourth * fourth)
}

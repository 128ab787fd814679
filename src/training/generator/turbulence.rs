//! Pressure of turbulent air that flows over a capsule's port.
//!
//! # Spectrum
//!
//! Eddies are carried past the port faster than they change (Taylor, Proc. R. Soc. A 164, 1938). So the spectrum is a
//! property of length, not of time, and a noise n(ξ) of the way ξ (m) is played at the speed of the air: ξ = ∫ U dt.
//! A corner, a fluctuation of U and the end of a breath then all sound as they must. Over κ = f/U (cycles per m):
//!
//! ```text
//! |n(κ)|² ∝ (1 + (κ/κ₀)²)^(−m/2) · (1 + (κ b)²)⁻¹ · exp(−5.2 · 2π κ η)
//! ```
//!
//! with κ₀ = 0.75/(2π L) for the integral scale L, von Kármán's spectrum (Pope, Turbulent Flows, 2000, section 6.5).
//! The slope m is 5/3 for a port that stops the air (p = ρ U u') and 7/3 for static pressure (George, Beuther and
//! Arndt, J. Fluid Mech. 148, 1984). The body of the size b averages over smaller eddies. Kolmogorov's length is
//! η = L (L u'/ν)^(−3/4). The corner in time is f_c = 0.75 U/(2π L): it falls with the distance.
//!
//! The housing sheds eddies of its own size (Strasberg, J. Acoust. Soc. Am. 83, 1988: a microphone hums in smooth air
//! too). They have the same spectrum with their own scale, and nothing in common at two capsules.
//!
//! # Pressure
//!
//! The port sees c ½ρ (v|v| + σ u') with v = U + u', so ρ U u' + ½ρ u'² about the mean. c is its coefficient of pressure.
//! Eddies across the flow, of the strength σ of those along it, are the last term: they press when v is about 0, too.
//!
//! # Two capsules
//!
//! Coherence of two points at the spacing s across the flow, IEC 61400-1 (2005), annex B, after Davenport (1961):
//!
//! ```text
//! γ(κ) = exp(−a √((κ s)² + (0.12 s/L)²)),   a = 6 … 14, 12 in the standard
//! ```

use soffio_math::noise::Random;
use soffio_math::{PI, exp, pow};

use super::jet::SAMPLES;
use super::noise::{RATE, Shape, Workshop};

/// Density of air, kg/m³, at 20 °C.
pub(super) const DENSITY: f64 = 1.2;
/// Kinematic viscosity of air, m²/s.
const VISCOSITY: f64 = 1.5e-5;
/// κ₀ · 2π L of von Kármán's longitudinal spectrum.
const KARMAN: f64 = 0.75;
/// Decay of the dissipation range (Pope 2000, section 6.5).
const DISSIPATION: f64 = 5.2;
/// Longest table: 8 s of the fastest air.
const LONGEST: usize = 1 << 17;

/// How a port and its housing answer to air.
#[derive(Clone, Copy, Debug)]
pub(super) struct Port {
    /// Coefficient of pressure.
    pub(super) coefficient: f64,
    /// m of the spectrum.
    pub(super) slope: f64,
    /// Size that averages, m.
    pub(super) size: f64,
    /// Eddies that the housing itself sheds: their scale, m, and their variance over that of the air's eddies.
    pub(super) wake: (f64, f64),
    /// Radius of a foam around it, m; 0 without.
    pub(super) foam: f64,
    /// Spacing of the two capsules, m.
    pub(super) spacing: f64,
    /// a of the coherence.
    pub(super) decay: f64,
}

impl Port {
    /// Spectrum of the eddies that the housing sheds.
    fn shed(&self, kappa: f64) -> f64 {
        self.wake.1 * karman(kappa, self.wake.0, self.slope)
    }

    /// What a foam leaves of the pressure at κ. It averages over its surface, and the air inside hardly moves: 10 to 15
    /// dB at large eddies, more at small (Morgan and Raspet, J. Acoust. Soc. Am. 92, 1992; Zheng and Tan 2003).
    fn foam_share(&self, kappa: f64) -> f64 {
        if self.foam == 0.0 { 1.0 } else { 0.3 / (1.0 + (2.0 * kappa * self.foam) * (2.0 * kappa * self.foam)).sqrt() }
    }
}

/// Von Kármán's spectrum of the scale `l`, m, whose variance is 1 for any scale, but for a factor of all.
fn karman(kappa: f64, l: f64, slope: f64) -> f64 {
    let x = kappa * 2.0 * PI * l / KARMAN;
    l * pow(1.0 + x * x, -0.5 * slope)
}

/// Speeds at the two capsules every [`super::jet::STEP`], m/s.
pub(super) struct Air {
    /// Speed at each capsule, with gusts but without small eddies.
    pub(super) speed: [Vec<f64>; 2],
    /// Root mean square of the small eddies' speed at each.
    pub(super) eddies: [Vec<f64>; 2],
    /// Speed that carries them.
    pub(super) carrier: Vec<f64>,
    /// Integral scale, m.
    pub(super) scale: f64,
    /// Way along the flow from the first to the second capsule, m.
    pub(super) lag: f64,
}

/// Pressure at both capsules, Pa.
pub(super) fn pressure(workshop: &mut Workshop, random: &mut Random, air: &Air, port: &Port) -> [Vec<f32>; 2] {
    let steps = air.carrier.len();
    let samples = steps * SAMPLES;
    let fastest = air.carrier.iter().copied().fold(0.05, f64::max);
    let typical = air.eddies[0].iter().copied().fold(0.01, f64::max);
    // One sample of the table at the fastest air is one sample of sound.
    let grain = fastest / RATE;
    let table = samples.next_power_of_two().clamp(1 << 12, LONGEST);
    let (l, per_metre) = (air.scale, 1.0 / grain);
    let eta = l * pow(l * typical / VISCOSITY, -0.75);
    let shape = Shape::new(per_metre, |kappa| {
        let size = 1.0 + (kappa * port.size) * (kappa * port.size);
        let decay = exp(-0.5 * DISSIPATION * 2.0 * PI * kappa * eta);
        let power = karman(kappa, l, port.slope) + port.shed(kappa);
        (power / size).sqrt() * decay * port.foam_share(kappa) / port.foam_share(0.0)
    });
    let coherence = Shape::new(per_metre, |kappa| {
        let (a, b) = (kappa * port.spacing, 0.12 * port.spacing / l);
        let common = karman(kappa, l, port.slope);
        exp(-port.decay * (a * a + b * b).sqrt()) * common / (common + port.shed(kappa))
    });
    let noise = workshop.pair(random, table, &shape, &coherence);
    let mask = table - 1;
    // Energy that the port's averaging took is not in the table, which has unit variance.
    let kept = kept_share(per_metre, table, l, port);
    let lags = [0.0, (air.lag / grain).max(-0.5 * table as f64) + table as f64];
    let gain = 0.5 * DENSITY * port.coefficient * port.foam_share(0.0);
    let start = random.unit() * table as f64;
    [0, 1].map(|capsule| {
        let (speed, eddies, n) = (&air.speed[capsule], &air.eddies[capsule], &noise[capsule]);
        let mut out = Vec::with_capacity(samples);
        let mut at = start + lags[capsule];
        for step in 0..steps {
            let next = (step + 1).min(steps - 1);
            let slope = |v: &[f64]| (v[next] - v[step]) / SAMPLES as f64;
            let (du, de, dc) = (slope(speed), slope(eddies) * kept, slope(&air.carrier) / fastest);
            let (mut u, mut e, mut c) = (speed[step], eddies[step] * kept, air.carrier[step] / fastest);
            for _ in 0..SAMPLES {
                let (k, t) = (at as usize, at - at.floor());
                let (a, b) = (f64::from(n[k & mask]), f64::from(n[(k + 1) & mask]));
                let eddy = e * (a + t * (b - a));
                let v = u + eddy;
                out.push((gain * (v * v.abs() + e * eddy)) as f32);
                at += c;
                u += du;
                e += de;
                c += dc;
            }
            if at > 4.0 * table as f64 {
                at -= 2.0 * table as f64;
            }
        }
        out
    })
}

/// Root of the share of the eddies' variance that the port's size and foam leave.
fn kept_share(per_metre: f64, table: usize, l: f64, port: &Port) -> f64 {
    let (mut all, mut kept, mut kappa) = (0.0, 0.0, per_metre / table as f64);
    while kappa < 0.5 * per_metre {
        let air = kappa * karman(kappa, l, port.slope);
        let foam = port.foam_share(kappa) / port.foam_share(0.0);
        all += air;
        kept += (air + kappa * port.shed(kappa)) * foam * foam / (1.0 + (kappa * port.size) * (kappa * port.size));
        kappa *= 1.1;
    }
    (kept / all).sqrt()
}

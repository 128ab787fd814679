//! Bending of a free beam, exactly: Timoshenko's with shear and rotary inertia, Euler and Bernoulli's without.
//!
//! Symbols: L length, A section, I second moment, K = √(I/A) radius of gyration, E, G moduli, ρ density, κ shear
//! coefficient, ω angular frequency, w deflection, ψ turn of the section, ξ = x/L from the middle, −½ … ½.
//!
//! ```text
//! b² = ρA ω² L⁴ / EI        r² = I / A L²        s² = EI / κGA L²
//! w'' − Ψ' + b² s² w = 0    s² Ψ'' + (b² r² s² − 1) Ψ + w' = 0          Ψ = L ψ
//! free ends: Ψ' = 0 and w' = Ψ at ξ = ±½
//! ```
//!
//! Solutions e^(λξ) have λ = ±α, ±iβ with α² = b² (√(((r² − s²)/2)² + 1/b²) − (r² + s²)/2) and β² with a plus (Huang,
//! J. Appl. Mech. 28, 1961). About the middle the modes are even or odd, so that each frequency equation is 2×2:
//!
//! ```text
//! even: w = C cosh αξ + D cos βξ    (α² + b²s²) sin(β/2)/β + (β² − b²s²) cos(β/2) tanh(α/2)/α = 0
//! odd:  w = C sinh αξ + D sin βξ    (α² + b²s²) α tanh(α/2) cos(β/2)/β − (β² − b²s²) sin(β/2) = 0
//! ```
//!
//! Where b r s > 1, α is imaginary and the hyperbolic functions become circular. With r = s = 0 these are the slender
//! beam's cos βL cosh βL = 1: f = (K/2πL²) √(E/ρ) (βL)², βL = 4.730, 7.853, 10.996, …, which the thesis writes as
//! (π K/8L²) √(E/ρ) m² with m = 3.0112, 5, 7, ….

use super::limits::HIGHEST;
use soffio_math::{PI, cos, exp, sin, tanh};

/// Steps of √b in which roots are looked for: the lowest two of one parity are 6 apart, later ones never below 0.1.
const STEP: f64 = 0.02;
/// Intervals of the integral that normalises a shape.
const INTERVALS: usize = 400;
/// Most steps: a beam that needs more has partials by the thousand.
const MOST_STEPS: usize = 50_000;

/// What a beam is, as far as its bending knows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Section {
    /// L, m.
    pub length: f64,
    /// A, m².
    pub area: f64,
    /// K = √(I/A), m.
    pub gyration: f64,
    /// E, Pa.
    pub youngs_modulus: f64,
    /// κG, Pa; infinite without shear and rotary inertia.
    pub shear_stiffness: f64,
    /// Density ρ, kg/m³.
    pub density: f64,
}

impl Section {
    /// √(E/ρ) K, m²/s.
    pub(super) fn stiffness(&self) -> f64 {
        (self.youngs_modulus / self.density).sqrt() * self.gyration
    }
}

/// One bending mode of a free beam.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BeamMode {
    /// Frequency, Hz.
    pub frequency: f64,
    /// Whether w is odd about the middle.
    pub odd: bool,
    waves: Waves,
    /// C, D, with the mass in them.
    factors: [f64; 2],
}

/// α and β of one frequency.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Waves {
    /// |α|, and whether it is imaginary.
    alpha: f64,
    imaginary: bool,
    beta: f64,
    /// b² s².
    shear: f64,
}

impl Waves {
    fn new(b: f64, r2: f64, s2: f64) -> Self {
        let root = (0.25 * (r2 - s2) * (r2 - s2) + 1.0 / (b * b)).sqrt();
        let half = 0.5 * (r2 + s2);
        let alpha2 = b * b * (root - half);
        Self { alpha: alpha2.abs().sqrt(), imaginary: alpha2 < 0.0, beta: b * (root + half).sqrt(), shear: b * b * s2 }
    }

    /// α² + b² s².
    fn first(&self) -> f64 {
        self.shear + if self.imaginary { -self.alpha * self.alpha } else { self.alpha * self.alpha }
    }

    /// β² − b² s².
    fn second(&self) -> f64 {
        self.beta * self.beta - self.shear
    }

    /// The frequency equation; above b r s = 1 times cos(α/2), which has no poles.
    fn equation(&self, odd: bool) -> f64 {
        let (a, b) = (0.5 * self.alpha, 0.5 * self.beta);
        // (cosh, sinh·α, sinh/α), the first divided out where it is hyperbolic.
        let (even_part, times, over) = if self.imaginary {
            (cos(a), -self.alpha * sin(a), sin(a) / self.alpha.max(1e-12))
        } else {
            (1.0, self.alpha * tanh(a), tanh(a) / self.alpha.max(1e-12))
        };
        if odd {
            self.first() * times * cos(b) / self.beta - self.second() * sin(b) * even_part
        } else {
            self.first() * even_part * sin(b) / self.beta + self.second() * cos(b) * over
        }
    }

    /// C and D for w' = Ψ at the end, C for functions divided by cosh(α/2) where they are hyperbolic.
    fn factors(&self, odd: bool) -> [f64; 2] {
        let (a, b) = (0.5 * self.alpha, 0.5 * self.beta);
        match (odd, self.imaginary) {
            (false, false) => [-self.alpha * sin(b) / (self.beta * tanh(a)), 1.0],
            (true, false) => [self.alpha * cos(b) / self.beta, 1.0],
            (false, true) => [sin(b) / self.beta, -sin(a) / self.alpha],
            (true, true) => [cos(b) / self.beta, -cos(a) / self.alpha],
        }
    }

    /// cosh and sinh of αξ over cosh(α/2), or cos and sin.
    fn first_functions(&self, xi: f64) -> [f64; 2] {
        if self.imaginary {
            return [cos(self.alpha * xi), sin(self.alpha * xi)];
        }
        let scale = 1.0 / (1.0 + exp(-self.alpha));
        let (near, far) = (exp(self.alpha * (xi.abs() - 0.5)), exp(-self.alpha * (xi.abs() + 0.5)));
        [scale * (near + far), (scale * (near - far)).copysign(xi)]
    }

    /// w and Ψ at ξ.
    fn shape(&self, odd: bool, [c, d]: [f64; 2], xi: f64) -> [f64; 2] {
        let [ch, sh] = self.first_functions(xi);
        let (co, si) = (cos(self.beta * xi), sin(self.beta * xi));
        let (first, second) = (self.first() / self.alpha, self.second() / self.beta);
        // d/dξ of cos is −sin, of cosh is sinh: the signs of Ψ = ∫ (w'' + b² s² w).
        match (odd, self.imaginary) {
            (false, false) => [c * ch + d * co, c * first * sh - d * second * si],
            (true, false) => [c * sh + d * si, c * first * ch + d * second * co],
            (false, true) => [c * ch + d * co, c * first * sh - d * second * si],
            (true, true) => [c * sh + d * si, -c * first * ch + d * second * co],
        }
    }
}

impl BeamMode {
    /// φ at ξ = −½ … ½, 1/√kg.
    pub fn shape(&self, xi: f64) -> f64 {
        self.waves.shape(self.odd, self.factors, xi)[0]
    }

    fn new(b: f64, odd: bool, section: &Section, r2: f64, s2: f64) -> Self {
        let waves = Waves::new(b, r2, s2);
        let factors = waves.factors(odd);
        // Simpson's rule of w² + r² Ψ², which is the kinetic energy of ρA ẇ² + ρI ψ̇².
        let energy = |i: usize| {
            let [w, turn] = waves.shape(odd, factors, i as f64 / INTERVALS as f64 - 0.5);
            w * w + r2 * turn * turn
        };
        let weight = |i: usize| if i == 0 || i == INTERVALS { 1.0 } else { 2.0 + 2.0 * (i % 2) as f64 };
        let mean: f64 = (0..=INTERVALS).map(|i| weight(i) * energy(i)).sum::<f64>() / (3.0 * INTERVALS as f64);
        let mass = section.density * section.area * section.length;
        let end = waves.shape(odd, factors, 0.5)[0];
        let scale = (1.0 / (mean * mass).sqrt()).copysign(end);
        let frequency = b * section.stiffness() / (section.length * section.length) / (2.0 * PI);
        Self { frequency, odd, waves, factors: factors.map(|f| f * scale) }
    }
}

/// The lowest `most` bending modes below [`HIGHEST`], ascending. Empty when a number is not positive.
pub fn beam_modes(section: &Section, most: usize) -> Vec<BeamMode> {
    let numbers = [section.length, section.area, section.gyration, section.youngs_modulus, section.density];
    if !(numbers.iter().all(|v| v.is_finite() && *v > 0.0) && section.shear_stiffness > 0.0) {
        return Vec::new();
    }
    let slender = section.gyration / section.length;
    // Without shear there is no rotary inertia either: the slender beam.
    let (r2, s2) = if section.shear_stiffness.is_finite() {
        (slender * slender, slender * slender * section.youngs_modulus / section.shear_stiffness)
    } else {
        (0.0, 0.0)
    };
    let highest = (2.0 * PI * HIGHEST * section.length * section.length / section.stiffness()).sqrt();
    let steps = ((highest / STEP) as usize).min(MOST_STEPS);
    let mut modes = Vec::new();
    let mut before = [0.0; 2];
    // Below √b = 0.5 there is only the rigid beam.
    for i in (0.5 / STEP) as usize..=steps {
        let x = i as f64 * STEP;
        for odd in [false, true] {
            let value = Waves::new(x * x, r2, s2).equation(odd);
            let old = std::mem::replace(&mut before[usize::from(odd)], value);
            if old * value < 0.0 {
                let root = bisect(x - STEP, x, |x| Waves::new(x * x, r2, s2).equation(odd));
                modes.push(BeamMode::new(root * root, odd, section, r2, s2));
            }
        }
        if modes.len() >= most {
            break;
        }
    }
    modes.sort_by(|a, b| a.frequency.total_cmp(&b.frequency));
    modes.truncate(most);
    modes
}

/// The root between two points of different sign, to rounding.
fn bisect(mut low: f64, mut high: f64, f: impl Fn(f64) -> f64) -> f64 {
    let sign = f(low) < 0.0;
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if (f(middle) < 0.0) == sign { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

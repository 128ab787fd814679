//! The state-variable filter.

use crate::timbre::FilterKind;
use soffio_math::PI;

/// The two integrators of a filter, and its coefficients.
#[derive(Clone)]
pub(super) struct StateVariable {
    integrators: [f64; 2],
    g: f64,
    damping: f64,
    shrink: f64,
}

impl Default for StateVariable {
    fn default() -> Self {
        Self { integrators: [0.0; 2], g: 0.0, damping: 1.0, shrink: 1.0 }
    }
}

impl StateVariable {
    /// Coefficients for a corner (Hz) and a quality.
    pub fn tune(&mut self, hz: f64, q: f64, sample_rate: f64) {
        self.g = libm::tan(PI * hz / sample_rate);
        self.damping = 1.0 / q;
        self.shrink = 1.0 / (1.0 + self.g * (self.damping + self.g));
        // Ringing below −400 dB is not worth the slow arithmetic of denormal numbers.
        for integrator in &mut self.integrators {
            if integrator.abs() < 1e-20 {
                *integrator = 0.0;
            }
        }
    }

    /// A block of the state-variable filter by trapezoidal integration (Zavalishin, "The Art of VA Filter Design",
    /// 2018, 4.1): stable under any change of its coefficients. g = tan(π f/fs), damping = 1/Q,
    /// shrink = 1/(1 + g (damping + g)). The one-pole is the same with one integrator.
    pub fn render(&mut self, kind: FilterKind, input: &[f32], out: &mut [f32]) {
        match kind {
            FilterKind::OnePole => self.one_pole(input, out),
            FilterKind::LowPass => self.two_poles(input, out, |_, _, low, _| low),
            FilterKind::BandPass => self.two_poles(input, out, |_, band, _, damping| damping * band),
            FilterKind::HighPass => self.two_poles(input, out, |high, _, _, _| high),
        }
    }

    fn one_pole(&mut self, input: &[f32], out: &mut [f32]) {
        let (mut s1, g) = (self.integrators[0], self.g);
        for (y, x) in out.iter_mut().zip(input) {
            let v = (f64::from(*x) - s1) * g / (1.0 + g);
            let low = v + s1;
            s1 = low + v;
            *y = low as f32;
        }
        self.integrators[0] = s1;
    }

    /// `pick` makes the output of high, band, low and the damping.
    fn two_poles(&mut self, input: &[f32], out: &mut [f32], pick: impl Fn(f64, f64, f64, f64) -> f64) {
        let ([mut s1, mut s2], g, damping, shrink) = (self.integrators, self.g, self.damping, self.shrink);
        // The next integrators, 2 band − s₁ and 2 low − s₂, straight from these and x: the way from sample to sample is one
        // product and two sums long, and the outputs beside it need not wait.
        let (to_band, to_low) = (2.0 * g * shrink, 2.0 * g * g * shrink);
        let (a11, a21) = (1.0 - to_band * (damping + g), 2.0 * g - to_low * (damping + g));
        for (y, x) in out.iter_mut().zip(input) {
            let x = f64::from(*x);
            let high = (x - (damping + g) * s1 - s2) * shrink;
            let band = g * high + s1;
            let low = g * band + s2;
            *y = pick(high, band, low, damping) as f32;
            (s1, s2) = (a11 * s1 + to_band * (x - s2), a21 * s1 + (s2 + to_low * (x - s2)));
        }
        self.integrators = [s1, s2];
    }
}

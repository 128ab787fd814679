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

    /// One sample of the state-variable filter by trapezoidal integration (Zavalishin, "The Art of VA Filter Design",
    /// 2018, 4.1): stable under any change of its coefficients. g = tan(π f/fs), damping = 1/Q,
    /// shrink = 1/(1 + g (damping + g)). The one-pole is the same with one integrator.
    pub fn next(&mut self, x: f64, kind: FilterKind) -> f64 {
        let [s1, s2] = self.integrators;
        let (g, damping) = (self.g, self.damping);
        if kind == FilterKind::OnePole {
            let v = (x - s1) * g / (1.0 + g);
            let low = v + s1;
            self.integrators[0] = low + v;
            return low;
        }
        let high = (x - (damping + g) * s1 - s2) * self.shrink;
        let band = g * high + s1;
        let low = g * band + s2;
        self.integrators = [2.0 * band - s1, 2.0 * low - s2];
        match kind {
            FilterKind::LowPass | FilterKind::OnePole => low,
            FilterKind::BandPass => damping * band,
            FilterKind::HighPass => high,
        }
    }
}

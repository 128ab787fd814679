//! Recursive filters of second order, and chains of them.
//!
//! Coefficients are those of the bilinear transform with the warped angle w = 2π f/rate (Bristow-Johnson, "Cookbook
//! formulae for audio EQ biquad filter coefficients", 1994; Zölzer, DAFX, 2011, chapter 2). A Butterworth filter of
//! order n has the pole qualities 1/(2 sin((2i − 1) π/(2n))).

use soffio_math::{PI, pow, sin, sincos};

use super::noise::RATE;

/// y = b₀ x + b₁ x₁ + b₂ x₂ − a₁ y₁ − a₂ y₂ (transposed form, two states).
#[derive(Clone, Copy, Debug)]
pub(super) struct Biquad {
    b: [f64; 3],
    a: [f64; 2],
    z: [f64; 2],
}

impl Biquad {
    fn scaled(b: [f64; 3], a: [f64; 3]) -> Self {
        Self { b: b.map(|b| b / a[0]), a: [a[1] / a[0], a[2] / a[0]], z: [0.0; 2] }
    }

    /// Sine and cosine of the corner's angle, and the half width α.
    fn angle(hertz: f64, q: f64) -> (f64, f64) {
        let (s, c) = sincos(2.0 * PI * hertz.min(0.49 * RATE) / RATE);
        (c, s / (2.0 * q))
    }

    /// Passes below `hertz`, −3 dB there at q = 0.707.
    pub(super) fn lowpass(hertz: f64, q: f64) -> Self {
        let (c, alpha) = Self::angle(hertz, q);
        Self::scaled([0.5 * (1.0 - c), 1.0 - c, 0.5 * (1.0 - c)], [1.0 + alpha, -2.0 * c, 1.0 - alpha])
    }

    /// Passes above `hertz`.
    pub(super) fn highpass(hertz: f64, q: f64) -> Self {
        let (c, alpha) = Self::angle(hertz, q);
        Self::scaled([0.5 * (1.0 + c), -1.0 - c, 0.5 * (1.0 + c)], [1.0 + alpha, -2.0 * c, 1.0 - alpha])
    }

    /// `db` at `hertz`, 0 dB far from it.
    pub(super) fn peak(hertz: f64, q: f64, db: f64) -> Self {
        let (c, alpha) = Self::angle(hertz, q);
        let a = pow(10.0, db / 40.0);
        let (up, down) = (alpha * a, alpha / a);
        Self::scaled([1.0 + up, -2.0 * c, 1.0 - up], [1.0 + down, -2.0 * c, 1.0 - down])
    }

    /// One pole and one zero at 0 Hz: a high-pass of first order.
    pub(super) fn first_highpass(hertz: f64) -> Self {
        let w = soffio_math::exp(-2.0 * PI * hertz / RATE);
        Self { b: [0.5 * (1.0 + w), -0.5 * (1.0 + w), 0.0], a: [-w, 0.0], z: [0.0; 2] }
    }

    /// One pole: a low-pass of first order.
    pub(super) fn first_lowpass(hertz: f64) -> Self {
        let w = soffio_math::exp(-2.0 * PI * hertz / RATE);
        Self { b: [1.0 - w, 0.0, 0.0], a: [-w, 0.0], z: [0.0; 2] }
    }

    /// Next sample.
    #[inline]
    pub(super) fn step(&mut self, x: f64) -> f64 {
        let y = self.b[0] * x + self.z[0];
        self.z[0] = self.b[1] * x - self.a[0] * y + self.z[1];
        self.z[1] = self.b[2] * x - self.a[1] * y;
        y
    }

    /// Filters in place.
    pub(super) fn run(mut self, samples: &mut [f32]) {
        for x in samples {
            // A tiny constant keeps the states from becoming denormal numbers in silence.
            *x = self.step(f64::from(*x) + 1e-18) as f32;
        }
    }
}

/// High-pass of Butterworth's response, order 1 to 4.
pub(super) fn highpass(hertz: f64, order: usize) -> Vec<Biquad> {
    butterworth(order, |q| Biquad::highpass(hertz, q), Biquad::first_highpass(hertz))
}

/// Low-pass of Butterworth's response, order 1 to 8.
pub(super) fn lowpass(hertz: f64, order: usize) -> Vec<Biquad> {
    butterworth(order, |q| Biquad::lowpass(hertz, q), Biquad::first_lowpass(hertz))
}

fn butterworth(order: usize, second: impl Fn(f64) -> Biquad, first: Biquad) -> Vec<Biquad> {
    let quality = |i: usize| 0.5 / sin(PI * (i as f64 + 0.5) / order as f64);
    let mut chain: Vec<Biquad> = (0..order / 2).map(|i| second(quality(i))).collect();
    if order % 2 == 1 {
        chain.push(first);
    }
    chain
}

//! A hit's force over time, and the ringing it leaves: exact during the contact and after.
//!
//! The force is half a sine, F(t) = J (Ω/2) sin Ωt, Ω = π/τ, as long as the contact lasts (Hertz). A partial of impulse
//! response Im e^(λt), λ = −c + iω, answers a pulse of unit area by the imaginary part of
//!
//! ```text
//! t ≤ τ:   K e^(λt) − K cos Ωt − K (λ/Ω) sin Ωt          K = (Ω²/2) / (λ² + Ω²)
//! t ≥ τ:   G e^(λt)                                      G = K (1 + e^(−λτ))
//! ```
//!
//! (put into y' = λy + F; at rest before). So a hit is free ringing from K while the bodies touch and from G
//! afterwards, beside one sinusoid of frequency 1/2τ that all partials of the body share. |G| is the spectrum of the pulse,
//! |cos(π f τ) / (1 − (2 f τ)²)| for a small c, and its phase the delay τ/2: harder, faster hits are brighter.

use super::kernel::times;
use soffio_math::{PI, exp, sincos};

/// A partial this near to the pulse's own frequency (relative) is taken to be this far off: K would be infinite there,
/// G is smooth.
const APART: f64 = 1e-4;
/// Decays during a contact beyond which K and G no longer fit into one f32 sum: the pulse is cut to it.
pub(super) const MOST_DECAYS: f64 = 5.0;

/// How a partial answers a pulse of unit area: real and imaginary part of the amplitude of its free ringing.
#[derive(Clone, Copy, Debug)]
pub(super) struct PulseResponse {
    /// K, while the contact lasts.
    pub during: [f64; 2],
    /// G, after it.
    pub after: [f64; 2],
}

/// A half-sine pulse of unit area.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pulse {
    /// τ, s.
    duration: f64,
    /// Ω, 1/s.
    omega: f64,
}

impl Pulse {
    /// Lasting `duration` s.
    pub fn new(duration: f64) -> Self {
        Self { duration, omega: PI / duration }
    }

    /// Samples that fall into the contact.
    pub fn samples(&self, sample_rate: f64) -> usize {
        (self.duration * sample_rate).ceil() as usize
    }

    /// K and G of a partial of decay c and angular frequency ω, 1/s.
    pub fn response(&self, decay: f64, omega: f64) -> PulseResponse {
        let w = self.omega;
        let omega = if (omega / w - 1.0).abs() < APART { w * (1.0 + APART) } else { omega };
        // λ² + Ω².
        let (re, im) = (decay * decay - omega * omega + w * w, -2.0 * decay * omega);
        let over = 0.5 * w * w / (re * re + im * im);
        let k = [re * over, -im * over];
        let (s, c) = sincos(omega * self.duration);
        let grown = exp((decay * self.duration).min(MOST_DECAYS));
        PulseResponse { during: k, after: times(k, [1.0 + grown * c, -grown * s]) }
    }

    /// What a partial adds to the common sinusoid: factors of cos Ωt and sin Ωt.
    pub fn shared(&self, decay: f64, omega: f64, k: [f64; 2]) -> [f64; 2] {
        [-k[1], -times(k, [-decay, omega])[1] / self.omega]
    }

    /// cos Ωt and sin Ωt after `t` s.
    pub fn sinusoid(&self, t: f64) -> [f64; 2] {
        let (s, c) = sincos(self.omega * t);
        [c, s]
    }
}

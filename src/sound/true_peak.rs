//! The highest point of the wave between samples.
//!
//! A wave may rise above its samples by 3 dB and more, and a converter plays the wave. It is looked at four times a sample
//! (ITU-R BS.1770, annex 2): the samples themselves and three points between each two,
//!
//! ```text
//! x(n + p/4) = Σ x[n + j] sinc(j − p/4) w(j − p/4),    j = −5 … 6,   w(d) = cos²(π d/12)
//! ```
//!
//! Content near half the rate may still hide up to 0.7 dB; none of the sounds here has any to speak of.

use crate::math::{PI, cos, sin};

/// Points between two samples, and one of the samples.
const PHASES: usize = 4;
/// Samples that one point is made of.
const TAPS: usize = 12;
/// Frames by which the answer is late.
pub(super) const DELAY: usize = TAPS / 2;

/// True peak of a stereo signal, one frame after the other.
pub(super) struct TruePeak {
    taps: [[f32; TAPS]; PHASES - 1],
    /// The last samples of either channel, the oldest first.
    last: [[f32; TAPS]; 2],
}

impl TruePeak {
    pub fn new() -> Self {
        let tap = |phase: usize, j: usize| {
            let d = j as f64 - (TAPS / 2 - 1) as f64 - (phase + 1) as f64 / PHASES as f64;
            let window = cos(PI * d / TAPS as f64);
            (sin(PI * d) / (PI * d) * window * window) as f32
        };
        let taps = std::array::from_fn(|phase| std::array::from_fn(|j| tap(phase, j)));
        Self { taps, last: [[0.0; TAPS]; 2] }
    }

    /// Takes a frame in; the highest point, of both channels, between the frames of [`DELAY`] and of one less ago, both
    /// included.
    pub fn process(&mut self, frame: [f32; 2]) -> f32 {
        let mut peak = 0.0f32;
        for (last, x) in self.last.iter_mut().zip(frame) {
            last.copy_within(1.., 0);
            last[TAPS - 1] = x;
            peak = peak.max(last[TAPS / 2 - 1].abs()).max(last[TAPS / 2].abs());
            for taps in &self.taps {
                let mut sum = 0.0;
                for (tap, x) in taps.iter().zip(last.iter()) {
                    sum += tap * x;
                }
                peak = peak.max(sum.abs());
            }
        }
        peak
    }
}

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

/// Sums that are made at once: each point of either channel, and two of nothing, for a processor's sake.
const LANES: usize = 8;

/// True peak of a stereo signal, one frame after the other.
pub(super) struct TruePeak {
    /// By samples, each point's tap for the left channel and for the right.
    taps: [[f32; LANES]; TAPS],
    /// The last frames twice over, a ring; from `at` on, the oldest first.
    last: [[f32; 2]; 2 * TAPS],
    at: usize,
}

impl TruePeak {
    pub fn new() -> Self {
        let tap = |phase: usize, j: usize| {
            let d = j as f64 - (TAPS / 2 - 1) as f64 - (phase + 1) as f64 / PHASES as f64;
            let window = cos(PI * d / TAPS as f64);
            (sin(PI * d) / (PI * d) * window * window) as f32
        };
        let lane = |l: usize, j: usize| if l / 2 < PHASES - 1 { tap(l / 2, j) } else { 0.0 };
        let taps = std::array::from_fn(|j| std::array::from_fn(|l| lane(l, j)));
        Self { taps, last: [[0.0; 2]; 2 * TAPS], at: 0 }
    }

    /// Takes a frame in; the highest point, of both channels, between the frames of [`DELAY`] and of one less ago, both
    /// included.
    pub fn process(&mut self, frame: [f32; 2]) -> f32 {
        // Every frame is written twice, so that the last of them always lie in one piece.
        self.last[self.at] = frame;
        self.last[self.at + TAPS] = frame;
        self.at = (self.at + 1) % TAPS;
        let last = &self.last[self.at..][..TAPS];
        let mut sums = [0.0f32; LANES];
        for (taps, x) in self.taps.iter().zip(last) {
            for l in 0..LANES {
                sums[l] += taps[l] * x[l % 2];
            }
        }
        let samples = last[TAPS / 2 - 1].iter().chain(&last[TAPS / 2]);
        samples.chain(&sums).fold(0.0, |peak: f32, x| peak.max(x.abs()))
    }
}

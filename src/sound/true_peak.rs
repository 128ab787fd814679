//! True peak: the highest point of the wave between samples (ITU-R BS.1770, annex 2).
//!
//! A wave may rise above its samples by 3 dB and more, and a converter plays the wave. It is looked at four times a sample
//! (ITU-R BS.1770, annex 2): the samples themselves and three points between each two,
//!
//! ```text
//! x(n + p/4) = Σ x[n + j] sinc(j − p/4) w(j − p/4),    j = −5 … 6,   w(d) = cos²(π d/12)
//! ```
//!
//! Content near half the rate may still hide up to 0.7 dB; none of the sounds here has any to speak of.

use soffio_math::{PI, cos, sin};

/// Points of the wave for each sample, the sample itself included (BS.1770-4, annex 2: fourfold).
const PHASES: usize = 4;
/// Samples that one point is interpolated from (BS.1770-4, annex 2).
const TAPS: usize = 12;
/// Frames by which the answer is late: half the taps.
pub(super) const DELAY: usize = TAPS / 2;

/// Factor by which sums of rounded numbers may exceed the sum.
const ROUNDING: f64 = 1.0 + 1e-5;
/// Sums that are made at once: each point of either channel, and two of nothing, for a processor's sake.
const LANES: usize = 8;

/// True peak of a stereo signal, one frame after the other.
pub(super) struct TruePeak {
    /// By samples, each point's tap for the left channel and for the right.
    taps: [[f32; LANES]; TAPS],
    /// How far a point can be beyond the samples that it is made of: the largest sum of taps' sizes, at least 1.
    most: f64,
    /// The last frames twice over, a ring; from `at` on, the oldest first.
    last: [[f32; 2]; 2 * TAPS],
    at: usize,
}

impl TruePeak {
    /// A meter that has seen silence.
    pub fn new() -> Self {
        let tap = |phase: usize, j: usize| {
            let d = j as f64 - (TAPS / 2 - 1) as f64 - (phase + 1) as f64 / PHASES as f64;
            let window = cos(PI * d / TAPS as f64);
            (sin(PI * d) / (PI * d) * window * window) as f32
        };
        let lane = |l: usize, j: usize| if l / 2 < PHASES - 1 { tap(l / 2, j) } else { 0.0 };
        let taps: [[f32; LANES]; TAPS] = std::array::from_fn(|j| std::array::from_fn(|l| lane(l, j)));
        let size = |l: usize| taps.iter().map(|tap| f64::from(tap[l].abs())).sum::<f64>();
        let most = ROUNDING * (0..LANES).map(size).fold(1.0, f64::max);
        Self { taps, most, last: [[0.0; 2]; 2 * TAPS], at: 0 }
    }

    /// What no point is above when these frames come next.
    pub fn bound(&self, frames: &[[f32; 2]]) -> f64 {
        self.most * f64::from(peak(frames.as_flattened()).max(peak(self.last[..TAPS].as_flattened())))
    }

    /// Adds frames without measuring.
    pub fn push_all(&mut self, frames: &[[f32; 2]]) {
        for frame in &frames[frames.len().saturating_sub(TAPS)..] {
            self.push(*frame);
        }
    }

    /// Every frame is written twice, so that the last of them always lie in one piece.
    fn push(&mut self, frame: [f32; 2]) {
        self.last[self.at] = frame;
        self.last[self.at + TAPS] = frame;
        self.at = if self.at + 1 == TAPS { 0 } else { self.at + 1 };
    }

    /// Takes a frame in; the highest point, of both channels, between the frames of [`DELAY`] and of one less ago, both
    /// included.
    pub fn process(&mut self, frame: [f32; 2]) -> f32 {
        self.push(frame);
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

/// The largest of some samples, whatever their sign; eight side by side, that none waits for the one before.
pub fn peak(samples: &[f32]) -> f32 {
    let larger = |most: &mut f32, x: &f32| {
        if x.abs() > *most {
            *most = x.abs();
        }
    };
    let (eights, rest) = samples.as_chunks::<8>();
    let mut most = [0.0; 8];
    eights.iter().for_each(|eight| most.iter_mut().zip(eight).for_each(|(most, x)| larger(most, x)));
    most.iter_mut().zip(rest).for_each(|(most, x)| larger(most, x));
    most.into_iter().fold(0.0, f32::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_peak_of_any_number_of_samples_is_the_largest_of_them() {
        for n in 0..40 {
            let samples: Vec<f32> = (0..n).map(|k| ((k * 29) % 37) as f32 - 18.0).collect();
            let one_by_one = samples.iter().fold(0.0f32, |most, x| most.max(x.abs()));
            assert_eq!(peak(&samples), one_by_one, "{n} samples");
        }
    }
}

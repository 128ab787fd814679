//! Look-ahead true-peak limiter, the last stage before the output. Neither samples nor the wave between them exceed [`CEILING`].
//! After a silence the ceiling is lower at first.
//!
//! Each frame's true peak x (of the wave, not of the samples: [`super::true_peak`]) requires a gain g(x) that keeps x g
//! below a ceiling C, with a soft knee k = C/2:
//!
//! ```text
//! x ≤ k: g = 1        x > k: g = (k + (C − k) u/(1 + u)) / x,   u = (x − k)/(C − k)
//! ```
//!
//! The signal is delayed by L frames and those that a true peak needs. The gain is the mean over L of the minimum over L of
//! the required gains. Every minimum within that mean at the time of a peak includes the peak, so the gain is at most
//! g(x). Recovery slows the minimum before it is averaged, which only makes it smaller.
//! (Giannoulis, Massberg and Reiss, "Digital Dynamic Range Compressor Design", JAES 60, 2012, for the terms.)
//!
//! Gains are whole numbers (2⁻³² units), so that the running sum is exact and never drifts.
//!
//! The ceiling itself moves. A sound startles by its onset: a blink and a jerk of the neck answer what is loud *and* rises
//! within some 12 ms, and more rarely the slower it rises (Fleshler, J. Comp. Physiol. Psychol. 60, 1965; Blumenthal,
//! Psychophysiology 25, 1988). So after a silence C is [`ONSET_CEILING`], and rises by [`RISE`] while something asks for more:
//! the last 8 dB of a bang take 0.1 s. It sinks again in the quiet that follows, by [`SINK`].
//!
//! While no frame within the delay, nor any new one, requires less gain, the gain is constant and frames only pass: the same
//! bits at less cost.
//!
//! Real-time: all storage is made by [`Limiter::new`].

use super::true_peak::{self, TruePeak};
use soffio_math::{exp, pow};

/// Largest true peak that leaves, −1 dBTP, linear: the maximum of EBU R 128.
pub const CEILING: f64 = 0.891_250_938_133_745_5;
/// Margin below the ceiling, −0.2 dB, linear: error of fourfold oversampling, and change of the gain.
const MARGIN: f64 = 0.977_237_220_955_810_7;
/// Ceiling after a silence, −9 dBFS, linear: 8 dB below [`CEILING`], chosen by ear, so that a bang out of silence does
/// not startle.
pub const ONSET_CEILING: f64 = 0.354_813_389_233_575_5;
/// Rise of the ceiling while peaks approach it, dB/s: 8 dB in 0.1 s, slower than the 12 ms of a startle.
const RISE: f64 = 80.0;
/// Fall of the ceiling otherwise, dB/s: 2 s to the ceiling after a silence. Chosen by ear.
const SINK: f64 = 4.0;
/// Look-ahead, s: long enough that a change of the gain does not click, short beside the latency of a block.
const LOOK_AHEAD: f64 = 0.0015;
/// Time constant of recovery, s: slower than a period of 20 Hz, so that bass is not distorted.
const RECOVERY: f64 = 0.08;
/// Gain 1 as a whole number, in units of 2⁻³².
const UNITY: u64 = 1 << 32;

pub(super) struct Limiter {
    /// Delayed frames, a ring of L.
    delay: Vec<[f32; 2]>,
    /// The held minima of the last L frames, a ring; `sum` is their sum.
    gains: Vec<u64>,
    sum: u64,
    at: usize,
    gain_at: usize,
    /// Minimum over a sliding window (Lemire 2006): ascending gains with the frame they were asked for, a ring of L + 1.
    minima: Vec<(u64, u64)>,
    first: usize,
    length: usize,
    frame: u64,
    held: u64,
    /// Frames for which `held` has not changed.
    still: usize,
    recovery: f64,
    true_peak: TruePeak,
    ceiling: f64,
    /// Factors of the ceiling a frame, up and down.
    rise: f64,
    sink: f64,
}

impl Limiter {
    /// A limiter at rest for this sample rate, Hz.
    pub fn new(sample_rate: f64) -> Self {
        let frames = ((LOOK_AHEAD * sample_rate) as usize).max(1);
        Self {
            delay: vec![[0.0; 2]; frames + true_peak::DELAY],
            gains: vec![UNITY; frames],
            sum: UNITY * frames as u64,
            at: 0,
            gain_at: 0,
            minima: vec![(0, 0); frames + 1],
            first: 0,
            length: 0,
            frame: 0,
            held: UNITY,
            still: frames,
            recovery: 1.0 - exp(-1.0 / (RECOVERY * sample_rate)),
            true_peak: TruePeak::new(),
            ceiling: ONSET_CEILING,
            rise: pow(10.0, RISE / 20.0 / sample_rate),
            sink: pow(10.0, -SINK / 20.0 / sample_rate),
        }
    }

    /// Frames by which the signal comes later.
    pub fn latency(&self) -> usize {
        self.delay.len()
    }

    /// Takes frames, gives those of [`Self::latency`] ago in their place.
    pub fn process(&mut self, frames: &mut [[f32; 2]]) {
        if self.is_steady() && self.true_peak.bound(frames) <= 0.5 * ONSET_CEILING {
            self.pass_through(frames);
        } else {
            frames.iter_mut().for_each(|frame| *frame = self.process_one(*frame));
        }
    }

    /// Whether the gain is constant while no frame requires less.
    fn is_steady(&self) -> bool {
        let nothing_asked = self.length > 0 && self.minima[self.first].0 == UNITY;
        nothing_asked && self.still >= self.gains.len() && self.recovered() == self.held
    }

    /// `held` after a frame that nothing is asked for in.
    fn recovered(&self) -> u64 {
        self.held + ((UNITY - self.held) as f64 * self.recovery) as u64
    }

    /// As [`Self::process_one`] for frames that require no less than a constant gain.
    fn pass_through(&mut self, frames: &mut [[f32; 2]]) {
        self.true_peak.push_all(frames);
        let gain = self.gain();
        let mut coming = &mut *frames;
        while !coming.is_empty() {
            let n = coming.len().min(self.delay.len() - self.at);
            let (now, later) = coming.split_at_mut(n);
            now.swap_with_slice(&mut self.delay[self.at..self.at + n]);
            self.at = next(self.at + n - 1, self.delay.len());
            coming = later;
        }
        frames.iter_mut().for_each(|frame| *frame = limited(*frame, gain));
        for _ in 0..frames.len() {
            let before = self.ceiling;
            self.ceiling = (before * self.sink).clamp(ONSET_CEILING, CEILING * MARGIN);
            if self.ceiling == before {
                break;
            }
        }
        self.frame += frames.len() as u64;
        (self.length, self.minima[self.first]) = (1, (UNITY, self.frame - 1));
    }

    fn process_one(&mut self, frame: [f32; 2]) -> [f32; 2] {
        let peak = f64::from(self.true_peak.process(frame));
        let minimum = self.sliding_minimum(required_gain(peak, self.ceiling));
        let reached = peak > 0.5 * self.ceiling;
        self.ceiling =
            (self.ceiling * if reached { self.rise } else { self.sink }).clamp(ONSET_CEILING, CEILING * MARGIN);
        let before = self.held;
        self.held = if minimum <= self.held {
            minimum
        } else {
            self.held + ((minimum - self.held) as f64 * self.recovery) as u64
        };
        self.still = if self.held == before { self.still + 1 } else { 0 };
        let delayed = std::mem::replace(&mut self.delay[self.at], frame);
        self.at = next(self.at, self.delay.len());
        self.sum = self.sum - self.gains[self.gain_at] + self.held;
        self.gains[self.gain_at] = self.held;
        self.gain_at = next(self.gain_at, self.gains.len());
        limited(delayed, self.gain())
    }

    fn gain(&self) -> f64 {
        self.sum as f64 / (UNITY * self.gains.len() as u64) as f64
    }

    /// Minimum of the last L + 1 required gains, this one included (Lemire 2006).
    fn sliding_minimum(&mut self, gain: u64) -> u64 {
        let size = self.minima.len();
        let place = |from: usize| if from < size { from } else { from - size };
        while self.length > 0 && self.minima[place(self.first + self.length - 1)].0 >= gain {
            self.length -= 1;
        }
        if self.length > 0 && self.minima[self.first].1 + (size as u64) <= self.frame {
            self.first = next(self.first, size);
            self.length -= 1;
        }
        self.minima[place(self.first + self.length)] = (gain, self.frame);
        self.length += 1;
        self.frame += 1;
        self.minima[self.first].0
    }
}

/// A delayed frame at this gain.
fn limited(delayed: [f32; 2], gain: f64) -> [f32; 2] {
    delayed.map(|sample| {
        let limit = CEILING as f32;
        // The clamp only undoes the last bit of rounding.
        ((f64::from(sample) * gain) as f32).clamp(-limit, limit)
    })
}

/// The next place in a ring.
fn next(at: usize, size: usize) -> usize {
    if at + 1 == size { 0 } else { at + 1 }
}

/// Gain required by a peak below a ceiling.
fn required_gain(peak: f64, ceiling: f64) -> u64 {
    let knee = 0.5 * ceiling;
    if peak <= knee {
        return UNITY;
    }
    let u = (peak - knee) / (ceiling - knee);
    let level = knee + (ceiling - knee) * u / (1.0 + u);
    (level / peak * UNITY as f64) as u64
}

#[cfg(test)]
mod tests {
    use super::*;
    use soffio_math::noise::Random;

    #[test]
    fn no_sample_passes_the_ceiling_and_soft_ones_pass_untouched() {
        let mut limiter = Limiter::new(48_000.0);
        let latency = limiter.latency();
        assert_eq!(latency, 78);
        let soft: Vec<f32> = (0..1000).map(|i| 0.17 * libm::sinf(i as f32 * 0.1)).collect();
        for (i, x) in soft.iter().enumerate() {
            let [y, _] = limiter.process_one([*x, -x]);
            if i >= latency {
                assert_eq!(y, soft[i - latency]);
            }
        }
        let mut random = Random::new(3);
        let (mut peak, mut unclamped) = (0.0f32, 0.0f64);
        for i in 0..200_000 {
            // Bursts up to +40 dB between silences, edges included.
            let loud = if random.unit() < 0.01 { 100.0 } else { 0.7 };
            let x = (loud * random.signed()) as f32 * f32::from(u8::from(i % 5000 < 3000));
            let delayed = limiter.delay[limiter.at][0];
            let [y, _] = limiter.process_one([x, 0.5 * x]);
            let gain = limiter.sum as f64 / (UNITY * limiter.gains.len() as u64) as f64;
            unclamped = unclamped.max((f64::from(delayed) * gain).abs());
            peak = peak.max(y.abs());
        }
        assert!(peak <= CEILING as f32, "{peak}");
        // Without the clamp too: the look-ahead does the work.
        assert!(unclamped <= CEILING, "{unclamped}");
    }

    #[test]
    fn what_only_passes_has_the_same_bits() {
        let mut random = Random::new(5);
        let (mut alone, mut together) = (Limiter::new(48_000.0), Limiter::new(48_000.0));
        let mut passed = 0;
        for block in 0..3000 {
            // Now and then loud enough to be limited, then near to it, then soft until the gain has come back: after a second.
            let loud = match block % 1000 {
                0 => 3.0,
                1..50 => 0.3,
                _ => 0.05,
            };
            let n = 1 + (random.unit() * 200.0) as usize;
            let mut frames: Vec<[f32; 2]> = (0..n).map(|_| [0, 1].map(|_| (loud * random.signed()) as f32)).collect();
            let expected: Vec<[f32; 2]> = frames.iter().map(|frame| alone.process_one(*frame)).collect();
            passed += usize::from(together.is_steady() && together.true_peak.bound(&frames) <= 0.5 * ONSET_CEILING);
            together.process(&mut frames);
            assert_eq!(frames, expected, "block {block}");
            assert_eq!(together.ceiling, alone.ceiling);
        }
        assert!(passed > 500, "only {passed} blocks passed");
    }
}

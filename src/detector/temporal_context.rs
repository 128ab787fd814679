//! Temporal context of a frame: trends of the last 0.24 s, and statistics of the seconds before it.
//!
//! A ring of 30 frames holds the levels (dB) of the low and middle bands. From it come their climbs, falls and deviations, and
//! the correlation between the two bands. The seconds before are summarised by an activity (share of time in which a band was
//! above the noise floor), a decaying peak level and a decaying peak periodicity.
//!
//! These statistics are frozen during a breath, as the noise floor is. So a breath is compared with the sound before it,
//! however long it lasts, and the first breath does not raise the activity that a second one is compared with.

use super::bands::{LOW, RISEN_DB, blend};
use super::spectrum::{FRAME_S, Power};

/// Length of the ring, frames: 0.24 s.
pub(super) const MEMORY: usize = 30;
/// Time constant of the activity, s.
pub(super) const ACTIVITY_S: f64 = 4.0;
/// Decay of the peak level, dB/s.
pub(super) const PEAK_DECAY_DB_S: f64 = 6.0;
/// Time constant of the peak periodicity, s.
const PITCH_DECAY_S: f64 = 0.8;
/// Bins of the low band.
const LOW_BINS: usize = LOW.1 - LOW.0;
/// Lag of the spectral correlation, frames: windows this far apart share no sample.
const CORRELATION_LAG: usize = 6;
/// Level before the first frame, dB.
pub(super) const NO_LEVEL_DB: f64 = -100.0;
/// Keeps quotients finite.
const EPSILON: f64 = 1e-14;

/// State of the temporal context.
#[derive(Clone, Debug)]
pub(super) struct TemporalContext {
    frames: u64,
    /// Levels of the low and middle bands in the last frames, dB; rings.
    levels: [[f64; MEMORY]; 2],
    /// Share of the last seconds in which the low and the middle band were above the noise floor, 0 … 1.
    activity: [f64; 2],
    /// Decaying peak levels of both bands, dB.
    peaks: [f64; 2],
    /// Decaying peak of the periodicity, 0 … 1.
    peak_periodicity: f64,
    /// Amplitudes of the low band's bins in the last frames; a ring.
    pattern: [[f64; LOW_BINS]; CORRELATION_LAG],
}

/// The values of one frame that enter the context.
#[derive(Clone, Copy, Debug)]
pub(super) struct ContextInput<'a> {
    /// Levels of the low and middle bands, dB.
    pub level: [f64; 2],
    /// Their rises over the noise floor, dB.
    pub rises: [f64; 2],
    /// Periodicity, 0 … 1.
    pub periodicity: f64,
    /// Power spectrum.
    pub power: &'a Power,
}

/// Features of one frame that depend on earlier frames.
#[derive(Clone, Copy, Debug)]
pub(super) struct ContextFeatures {
    /// Trends of the low and middle bands.
    pub trends: [Trend; 2],
    /// Correlation between the levels of the low and middle bands over 0.24 s, −1 … 1.
    pub band_correlation: f64,
    /// Share of the last seconds in which the low and the middle band were above the noise floor, 0 … 1.
    pub activity: [f64; 2],
    /// Levels over their own decaying peaks, dB.
    pub peak_ratios: [f64; 2],
    /// Highest periodicity of the last second, 0 … 1.
    pub peak_periodicity: f64,
    /// Correlation of the low band's amplitudes with those of [`CORRELATION_LAG`] frames ago, −1 … 1: high for a resonance,
    /// low for turbulence.
    pub spectral_correlation: f64,
}

/// Trend of a level over the last quarter of a second.
#[derive(Clone, Copy, Debug)]
pub(super) struct Trend {
    /// Rise in 48 ms, dB.
    pub climb: f64,
    /// Rise in 0.2 s, dB.
    pub long_climb: f64,
    /// Distance below the peak of 0.24 s, dB.
    pub fall: f64,
    /// Standard deviation over 0.16 s, dB.
    pub deviation: f64,
    /// Largest rise between two frames in 0.1 s, dB.
    pub step: f64,
}

impl TemporalContext {
    /// An empty context.
    pub fn new() -> Self {
        Self {
            frames: 0,
            levels: [[NO_LEVEL_DB; MEMORY]; 2],
            activity: [0.0; 2],
            peaks: [NO_LEVEL_DB; 2],
            peak_periodicity: 0.0,
            pattern: [[0.0; LOW_BINS]; CORRELATION_LAG],
        }
    }

    /// Takes one frame and returns its context features. While `blowing`, all but the ring of levels stands still.
    pub fn push(&mut self, now: &ContextInput, blowing: bool) -> ContextFeatures {
        self.frames += 1;
        let at = (self.frames % MEMORY as u64) as usize;
        for (ring, level) in self.levels.iter_mut().zip(now.level) {
            if self.frames == 1 {
                *ring = [level; MEMORY];
            }
            ring[at] = level;
        }
        if !blowing {
            self.update_statistics(now, at);
        }
        let pattern: [f64; LOW_BINS] = std::array::from_fn(|k| now.power[LOW.0 + k].sqrt());
        let before = std::mem::replace(&mut self.pattern[(self.frames % CORRELATION_LAG as u64) as usize], pattern);
        ContextFeatures {
            trends: [0, 1].map(|i| Trend::of(&self.levels[i], at)),
            // A standard deviation below about 0.3 dB counts as none.
            band_correlation: correlation(&self.levels[0], &self.levels[1], 0.1 * MEMORY as f64),
            activity: self.activity,
            peak_ratios: [0, 1].map(|i| now.level[i] - self.peaks[i]),
            peak_periodicity: self.peak_periodicity,
            spectral_correlation: correlation(&pattern, &before, EPSILON),
        }
    }

    /// Updates activity, peaks and periodicity.
    fn update_statistics(&mut self, now: &ContextInput, at: usize) {
        for i in 0..2 {
            let risen = if now.rises[i] > RISEN_DB { 1.0 } else { 0.0 };
            self.activity[i] += blend(ACTIVITY_S) * (risen - self.activity[i]);
            // The oldest level of the ring: a sound is not compared with its own onset.
            let oldest = self.levels[i][(at + 1) % MEMORY];
            self.peaks[i] = oldest.max(self.peaks[i] - PEAK_DECAY_DB_S * FRAME_S);
        }
        self.peak_periodicity = now.periodicity.max(self.peak_periodicity * (1.0 - blend(PITCH_DECAY_S)));
    }
}

impl Trend {
    /// Of a ring whose newest entry lies at `at`.
    pub fn of(ring: &[f64; MEMORY], at: usize) -> Self {
        let ago = |frames: usize| ring[(at + MEMORY - frames) % MEMORY];
        let peak = ring.iter().fold(f64::NEG_INFINITY, |m: f64, l| m.max(*l));
        let mean = (0..20).map(ago).sum::<f64>() / 20.0;
        let square = (0..20).map(|i| (ago(i) - mean) * (ago(i) - mean)).sum::<f64>() / 20.0;
        Self {
            climb: ago(0) - ago(6),
            long_climb: ago(0) - ago(24),
            fall: peak - ago(0),
            deviation: square.sqrt(),
            step: (0..12).map(|i| ago(i) - ago(i + 1)).fold(0.0, f64::max),
        }
    }
}

/// Correlation of two rows, −1 … 1; near 0 where the squares of one sum up to less than `still`.
fn correlation<const N: usize>(a: &[f64; N], b: &[f64; N], epsilon: f64) -> f64 {
    let count = N as f64;
    let (ma, mb) = (a.iter().sum::<f64>() / count, b.iter().sum::<f64>() / count);
    let (mut aa, mut bb, mut ab) = (epsilon, epsilon, 0.0);
    for (x, y) in a.iter().zip(b) {
        aa += (x - ma) * (x - ma);
        bb += (y - mb) * (y - mb);
        ab += (x - ma) * (y - mb);
    }
    ab / (aa * bb).sqrt()
}

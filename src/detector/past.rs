//! What the last quarter of a second, and the seconds before it, were like: a sound is judged by what it does and by what it
//! comes after.
//!
//! Of the levels of low and middle (dB), the last 30 frames are kept: how they climb, fall, waver, and whether they do so
//! together. Of the seconds before, a share of time, a peak that sinks and a pitch that fades are enough. While somebody blows
//! they stand still, as the room does: a breath is compared with what came before it, however long it lasts, and a second
//! one is not busier than the first.

use super::bands::{LOW, RISEN_DB, blend};
use super::spectrum::{FRAME_S, Power};

/// Frames that are remembered, 0.24 s.
pub(super) const MEMORY: usize = 30;
/// What came before is remembered as shares of time (s), as peaks that sink (dB/s), as a pitch that fades (s).
pub(super) const BUSY_S: f64 = 4.0;
pub(super) const SINKING_DB_S: f64 = 6.0;
const PITCH_FADES_S: f64 = 0.8;
/// Bins of low, and frames of a transform: so far apart they share no sample.
const LOW_BINS: usize = LOW.1 - LOW.0;
const APART: usize = 6;
/// Level of nothing, dB.
pub(super) const NONE_DB: f64 = -100.0;
/// Keeps quotients finite.
const NOTHING: f64 = 1e-14;

/// What is remembered.
#[derive(Clone, Debug)]
pub(super) struct Past {
    frames: u64,
    /// Levels of low and middle in the last frames, dB, rings.
    levels: [[f64; MEMORY]; 2],
    /// Share of the last seconds in which low and middle had risen; their peaks, dB; the highest periodicity.
    busy: [f64; 2],
    peaks: [f64; 2],
    pitched: f64,
    /// Amplitudes of low's bins in the last frames, a ring.
    pattern: [[f64; LOW_BINS]; APART],
}

/// One frame, as it is remembered.
#[derive(Clone, Copy, Debug)]
pub(super) struct Present<'a> {
    /// Levels of low and middle, dB.
    pub level: [f64; 2],
    /// Their rises over the room, dB.
    pub rises: [f64; 2],
    /// Periodicity, 0 … 1.
    pub periodicity: f64,
    /// Spectrum.
    pub power: &'a Power,
}

/// What the past says about a frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct Recalled {
    /// What low and middle did.
    pub trends: [Trend; 2],
    /// Correlation of low and middle over 0.24 s, −1 … 1.
    pub together: f64,
    /// Part of the last seconds in which low and middle had risen, 0 … 1.
    pub busy: [f64; 2],
    /// Levels over their own peaks of the seconds before, dB.
    pub over_peaks: [f64; 2],
    /// Highest periodicity of the last second.
    pub pitched: f64,
    /// How alike low's bins are to those of [`APART`] frames ago, −1 … 1: what rings keeps its pattern, turbulence
    /// does not.
    pub likeness: f64,
}

/// What a level did in the last quarter of a second, dB.
#[derive(Clone, Copy, Debug)]
pub(super) struct Trend {
    /// In 48 ms, and in 0.2 s.
    pub climb: f64,
    pub long_climb: f64,
    /// From its peak.
    pub fall: f64,
    /// Over 0.16 s.
    pub deviation: f64,
    /// Steepest from frame to frame in 0.1 s.
    pub step: f64,
}

impl Past {
    /// Nothing yet.
    pub fn new() -> Self {
        Self {
            frames: 0,
            levels: [[NONE_DB; MEMORY]; 2],
            busy: [0.0; 2],
            peaks: [NONE_DB; 2],
            pitched: 0.0,
            pattern: [[0.0; LOW_BINS]; APART],
        }
    }

    /// Takes note of a frame; says what came before it, or before the breath of which it is a part.
    pub fn push(&mut self, now: &Present, blowing: bool) -> Recalled {
        self.frames += 1;
        let at = (self.frames % MEMORY as u64) as usize;
        for (ring, level) in self.levels.iter_mut().zip(now.level) {
            if self.frames == 1 {
                *ring = [level; MEMORY];
            }
            ring[at] = level;
        }
        if !blowing {
            self.remember(now, at);
        }
        let pattern: [f64; LOW_BINS] = std::array::from_fn(|k| now.power[LOW.0 + k].sqrt());
        let before = std::mem::replace(&mut self.pattern[(self.frames % APART as u64) as usize], pattern);
        Recalled {
            trends: [0, 1].map(|i| Trend::of(&self.levels[i], at)),
            // Below 0.3 dB a level stands still.
            together: correlation(&self.levels[0], &self.levels[1], 0.1 * MEMORY as f64),
            busy: self.busy,
            over_peaks: [0, 1].map(|i| now.level[i] - self.peaks[i]),
            pitched: self.pitched,
            likeness: correlation(&pattern, &before, NOTHING),
        }
    }

    /// Lets the seconds before go on.
    fn remember(&mut self, now: &Present, at: usize) {
        for i in 0..2 {
            let risen = if now.rises[i] > RISEN_DB { 1.0 } else { 0.0 };
            self.busy[i] += blend(BUSY_S) * (risen - self.busy[i]);
            // The oldest of the ring: a sound does not hide behind its own beginning.
            let oldest = self.levels[i][(at + 1) % MEMORY];
            self.peaks[i] = oldest.max(self.peaks[i] - SINKING_DB_S * FRAME_S);
        }
        self.pitched = now.periodicity.max(self.pitched * (1.0 - blend(PITCH_FADES_S)));
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
fn correlation<const N: usize>(a: &[f64; N], b: &[f64; N], still: f64) -> f64 {
    let count = N as f64;
    let (ma, mb) = (a.iter().sum::<f64>() / count, b.iter().sum::<f64>() / count);
    let (mut aa, mut bb, mut ab) = (still, still, 0.0);
    for (x, y) in a.iter().zip(b) {
        aa += (x - ma) * (x - ma);
        bb += (y - mb) * (y - mb);
        ab += (x - ma) * (y - mb);
    }
    ab / (aa * bb).sqrt()
}

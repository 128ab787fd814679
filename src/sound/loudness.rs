//! Integrated loudness of a stereo run (EBU R 128 after ITU-R BS.1770-4), made for runs of hours: each frame is weighted once
//! and each tenth of a second added up once.
//!
//! ```text
//! l = −0.691 + 10 log₁₀ Σ_channels mean (K x)²         of 0.4 s, every 0.1 s
//! L = the same of the mean over all that are above −70 LUFS and above the mean of these by −10 LU
//! ```
//!
//! K is a shelf for the head and a high-pass; their coefficients at 48 kHz are the recommendation's. Two frames are taken at
//! a time, so that a filter waits for its own answer half as often: with y = b₀ x + s and s' = A s + B x,
//! s'' = A² s + A B x₀ + B x₁. Both filters of both channels go side by side as one vector: while the first has two frames in
//! hand, the second has what the first made of the two before.

use fearless_simd::prelude::*;
use fearless_simd::{Level, Simd, dispatch, f64x2, f64x4};

use soffio_math::amplitude_to_db;

/// b₀, b₁, b₂, a₁, a₂ of the shelf for the head, at [`LoudnessMeter::SAMPLE_RATE`] (ITU-R BS.1770-4, table 1).
const HEAD_SHELF: [f64; 5] =
    [1.535_124_859_586_97, -2.691_696_189_406_38, 1.198_392_810_852_85, -1.690_659_293_182_41, 0.732_480_774_215_85];
/// b₀, b₁, b₂, a₁, a₂ of the high-pass, at [`LoudnessMeter::SAMPLE_RATE`] (ITU-R BS.1770-4, table 2).
const HIGH_PASS: [f64; 5] = [1.0, -2.0, 1.0, -1.990_047_454_833_98, 0.990_072_250_366_21];
/// Frames of an interval, 0.1 s (BS.1770-4: gating blocks overlap by 75 %).
const INTERVAL: usize = LoudnessMeter::SAMPLE_RATE as usize / 10;
/// Intervals of a gating block, 0.4 s (BS.1770-4).
const BLOCK: usize = 4;
/// Loudness of a mean square of 1, LUFS (BS.1770-4): cancels the gain of the filters at 997 Hz.
const OFFSET: f64 = -0.691;
/// Absolute gate, LUFS (BS.1770-4).
const ABSOLUTE_GATE: f64 = -70.0;
/// Relative gate below the mean of the blocks above the absolute gate, LU (BS.1770-4).
const RELATIVE_GATE: f64 = 10.0;

/// A number of the first filter's channels, then of the second's.
type Lanes = [f64; 4];

/// Both filters.
struct Filters {
    b0: Lanes,
    /// A and B; the same of two frames at once.
    a: [[Lanes; 2]; 2],
    b: [Lanes; 2],
    a2: [[Lanes; 2]; 2],
    ab: [Lanes; 2],
    /// s.
    state: [Lanes; 2],
}

/// The numbers of [`Filters`] in registers.
struct Numbers<S: Simd> {
    b0: f64x4<S>,
    a: [f64x4<S>; 2],
    b: [f64x4<S>; 2],
    a2: [[f64x4<S>; 2]; 2],
    ab: [f64x4<S>; 2],
}

impl<S: Simd> Numbers<S> {
    /// Two frames through the first filter and two through the second: what comes out, and the state after.
    #[inline(always)]
    fn pair(
        &self,
        first: [f64x2<S>; 2],
        second: [f64x2<S>; 2],
        state: [f64x4<S>; 2],
    ) -> ([f64x4<S>; 2], [f64x4<S>; 2]) {
        let x = [first[0].combine(second[0]), first[1].combine(second[1])];
        let [s, t] = state;
        let middle = self.a[0] * s + self.a[1] * t + self.b[0] * x[0];
        let y = [self.b0 * x[0] + s, self.b0 * x[1] + middle];
        let next = |k: usize| self.a2[k][0] * s + (self.a2[k][1] * t + (self.ab[k] * x[0] + self.b[k] * x[1]));
        (y, [next(0), next(1)])
    }
}

impl Filters {
    fn new(filters: [[f64; 5]; 2]) -> Self {
        let lanes = |number: &dyn Fn([f64; 5]) -> f64| [0, 0, 1, 1].map(|which: usize| number(filters[which]));
        let a = |[_, _, _, a1, a2]: [f64; 5]| [[-a1, 1.0], [-a2, 0.0]];
        let b = |[b0, b1, b2, a1, a2]: [f64; 5]| [b1 - a1 * b0, b2 - a2 * b0];
        let product = |i: usize, number: &dyn Fn([f64; 5], usize) -> f64| {
            lanes(&|f| a(f)[i][0] * number(f, 0) + a(f)[i][1] * number(f, 1))
        };
        Self {
            b0: lanes(&|f| f[0]),
            a: [0, 1].map(|i| [0, 1].map(|k| lanes(&|f| a(f)[i][k]))),
            b: [0, 1].map(|i| lanes(&|f| b(f)[i])),
            a2: [0, 1].map(|i| [0, 1].map(|k| product(i, &|f, j| a(f)[j][k]))),
            ab: [0, 1].map(|i| product(i, &|f, j| b(f)[j])),
            state: [[0.0; 4]; 2],
        }
    }

    /// Takes pairs of frames in; the sum of squares of what comes out.
    fn squares(&mut self, level: Level, pairs: &[[[f32; 2]; 2]]) -> f64 {
        dispatch!(level, simd => self.squares_in(simd, pairs))
    }

    #[inline(always)]
    fn squares_in<S: Simd>(&mut self, simd: S, pairs: &[[[f32; 2]; 2]]) -> f64 {
        let load = |x: &Lanes| -> f64x4<S> { (*x).simd_into(simd) };
        let row = |row: &[Lanes; 2]| row.each_ref().map(load);
        let numbers = Numbers {
            b0: load(&self.b0),
            a: row(&self.a[0]),
            b: row(&self.b),
            a2: self.a2.each_ref().map(row),
            ab: row(&self.ab),
        };
        let Some((first, rest)) = pairs.split_first() else { return 0.0 };
        let silence = [f64x2::splat(simd, 0.0); 2];
        let frames = |pair: &[[f32; 2]; 2]| pair.map(|frame| frame.map(f64::from).simd_into(simd));
        let kept = row(&self.state);
        let mut sums = f64x4::splat(simd, 0.0);
        // At first the second filter has nothing in hand, and at last the first: they stay as they are.
        let (y, mut state) = numbers.pair(frames(first), silence, kept);
        state = [0, 1].map(|k| state[k].split().0.combine(kept[k].split().1));
        let mut between = y.map(|y| y.split().0);
        for pair in rest {
            let (y, next) = numbers.pair(frames(pair), between, state);
            (state, between) = (next, y.map(|y| y.split().0));
            sums += y[0] * y[0] + y[1] * y[1];
        }
        let (y, last) = numbers.pair(silence, between, state);
        sums += y[0] * y[0] + y[1] * y[1];
        self.state = [0, 1].map(|k| state[k].split().0.combine(last[k].split().1).into());
        sums[2] + sums[3]
    }

    /// Sets far inaudible states to 0: denormal numbers make processors slow.
    fn flush_denormals(&mut self) {
        self.state.as_flattened_mut().iter_mut().filter(|x| x.abs() < 1e-30).for_each(|x| *x = 0.0);
    }
}

/// Measures the integrated loudness of a stereo run.
pub struct LoudnessMeter {
    filters: Filters,
    /// Which instructions there are.
    level: Level,
    /// A frame that waits for its second.
    odd: Option<[f32; 2]>,
    /// Sum of squares and frames since the last look; the sums between the last looks.
    sum: f64,
    frames: usize,
    sums: [f64; BLOCK],
    intervals: usize,
    /// Mean squares of all blocks that are not silence.
    blocks: Vec<f64>,
}

impl LoudnessMeter {
    /// The rate that it is made for, Hz.
    pub const SAMPLE_RATE: u32 = 48_000;

    /// Before the first frame.
    pub fn new() -> Self {
        Self {
            filters: Filters::new([HEAD_SHELF, HIGH_PASS]),
            level: Level::new(),
            odd: None,
            sum: 0.0,
            frames: 0,
            sums: [0.0; BLOCK],
            intervals: 0,
            blocks: Vec::new(),
        }
    }

    /// Adds frames.
    pub fn push(&mut self, mut frames: &[[f32; 2]]) {
        if let (Some(first), Some((second, rest))) = (self.odd, frames.split_first()) {
            self.odd = None;
            self.take(&[first, *second]);
            frames = rest;
        }
        let whole = frames.len() / 2 * 2;
        self.odd = self.odd.or(frames.get(whole).copied());
        frames = &frames[..whole];
        // Looks lie between pairs.
        while !frames.is_empty() {
            let (now, later) = frames.split_at(frames.len().min(INTERVAL - self.frames));
            self.take(now);
            frames = later;
        }
    }

    /// An even number of frames, up to the next look.
    fn take(&mut self, frames: &[[f32; 2]]) {
        self.sum += self.filters.squares(self.level, frames.as_chunks().0);
        self.frames += frames.len();
        if self.frames == INTERVAL {
            self.filters.flush_denormals();
            self.sums[self.intervals % BLOCK] = std::mem::take(&mut self.sum);
            (self.intervals, self.frames) = (self.intervals + 1, 0);
            let square = self.sums.iter().sum::<f64>() / (BLOCK * INTERVAL) as f64;
            if self.intervals >= BLOCK && loudness(square) > ABSOLUTE_GATE {
                self.blocks.push(square);
            }
        }
    }

    /// L, LUFS; −∞ for silence.
    pub fn loudness(&self) -> f64 {
        let mean = |above: f64| {
            let heard = || self.blocks.iter().filter(|&&square| square > above);
            heard().sum::<f64>() / heard().count() as f64
        };
        if self.blocks.is_empty() {
            return f64::NEG_INFINITY;
        }
        let relative_gate = soffio_math::pow(10.0, -RELATIVE_GATE / 10.0);
        loudness(mean(relative_gate * mean(0.0)))
    }
}

impl Default for LoudnessMeter {
    fn default() -> Self {
        Self::new()
    }
}

/// Of a mean square, LUFS.
fn loudness(square: f64) -> f64 {
    OFFSET + 0.5 * amplitude_to_db(square)
}

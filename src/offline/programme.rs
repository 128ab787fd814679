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
//! s'' = A² s + A B x₀ + B x₁.

use crate::math::decibels;
use crate::simulation::SAMPLE_RATE;

/// The rate that the coefficients are for.
const _: () = assert!(SAMPLE_RATE == 48_000);
/// b₀, b₁, b₂, a₁, a₂ of the two filters.
const HEAD: [f64; 5] =
    [1.535_124_859_586_97, -2.691_696_189_406_38, 1.198_392_810_852_85, -1.690_659_293_182_41, 0.732_480_774_215_85];
const HIGH_PASS: [f64; 5] = [1.0, -2.0, 1.0, -1.990_047_454_833_98, 0.990_072_250_366_21];
/// Frames from one look to the next, and looks that a block is long.
const STRIDE: usize = SAMPLE_RATE as usize / 10;
const BLOCK: usize = 4;
/// Loudness of a mean square of 1, LUFS.
const FULL: f64 = -0.691;
/// Softer blocks are silence, LUFS; those softer than the others by so much are pauses, LU.
const SILENCE: f64 = -70.0;
const PAUSE: f64 = 10.0;

/// A number of either channel.
type Two = [f64; 2];

/// One filter.
struct Filter {
    b0: f64,
    /// A and B; the same of two frames at once.
    a: [[f64; 2]; 2],
    b: [f64; 2],
    a2: [[f64; 2]; 2],
    ab: [f64; 2],
    /// s.
    state: [Two; 2],
}

impl Filter {
    fn new([b0, b1, b2, a1, a2]: [f64; 5]) -> Self {
        let a = [[-a1, 1.0], [-a2, 0.0]];
        let b = [b1 - a1 * b0, b2 - a2 * b0];
        let row = |row: [f64; 2]| [0, 1].map(|k| row[0] * a[0][k] + row[1] * a[1][k]);
        Self { b0, a, b, a2: a.map(row), ab: a.map(|row| row[0] * b[0] + row[1] * b[1]), state: [[0.0; 2]; 2] }
    }

    /// Two frames through it.
    #[inline(always)]
    fn pair(&mut self, x: [Two; 2]) -> [Two; 2] {
        let [s, t] = self.state;
        let mut y = [[0.0; 2]; 2];
        for c in 0..2 {
            y[0][c] = self.b0 * x[0][c] + s[c];
            let middle = self.a[0][0] * s[c] + self.a[0][1] * t[c] + self.b[0] * x[0][c];
            y[1][c] = self.b0 * x[1][c] + middle;
            for k in 0..2 {
                let fed = self.ab[k] * x[0][c] + self.b[k] * x[1][c];
                self.state[k][c] = self.a2[k][0] * s[c] + (self.a2[k][1] * t[c] + fed);
            }
        }
        y
    }

    /// Far below what is heard: numbers that make processors slow.
    fn settle(&mut self) {
        for x in self.state.as_flattened_mut().iter_mut().filter(|x| x.abs() < 1e-30) {
            *x = 0.0;
        }
    }
}

/// The meter.
pub struct Programme {
    filters: [Filter; 2],
    /// A frame that waits for its second.
    odd: Option<[f32; 2]>,
    /// Sum of squares and frames since the last look; the sums between the last looks.
    sum: f64,
    frames: usize,
    sums: [f64; BLOCK],
    looks: usize,
    /// Mean squares of all blocks that are not silence.
    blocks: Vec<f64>,
}

impl Programme {
    /// Nothing has been heard.
    pub fn new() -> Self {
        Self {
            filters: [HEAD, HIGH_PASS].map(Filter::new),
            odd: None,
            sum: 0.0,
            frames: 0,
            sums: [0.0; BLOCK],
            looks: 0,
            blocks: Vec::new(),
        }
    }

    /// Goes on by these frames.
    pub fn hear(&mut self, mut frames: &[[f32; 2]]) {
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
            let (now, later) = frames.split_at(frames.len().min(STRIDE - self.frames));
            self.take(now);
            frames = later;
        }
    }

    /// An even number of frames, up to the next look.
    fn take(&mut self, frames: &[[f32; 2]]) {
        let [head, high_pass] = &mut self.filters;
        let mut sums = [0.0; 2];
        for pair in frames.as_chunks::<2>().0 {
            let y = high_pass.pair(head.pair(pair.map(|frame| frame.map(f64::from))));
            for c in 0..2 {
                sums[c] += y[0][c] * y[0][c] + y[1][c] * y[1][c];
            }
        }
        self.sum += sums[0] + sums[1];
        self.frames += frames.len();
        if self.frames == STRIDE {
            self.filters.iter_mut().for_each(Filter::settle);
            self.sums[self.looks % BLOCK] = std::mem::take(&mut self.sum);
            (self.looks, self.frames) = (self.looks + 1, 0);
            let square = self.sums.iter().sum::<f64>() / (BLOCK * STRIDE) as f64;
            if self.looks >= BLOCK && loudness(square) > SILENCE {
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
        let pause = crate::math::pow(10.0, -PAUSE / 10.0);
        loudness(mean(pause * mean(0.0)))
    }
}

impl Default for Programme {
    fn default() -> Self {
        Self::new()
    }
}

/// Of a mean square, LUFS.
fn loudness(square: f64) -> f64 {
    FULL + 0.5 * decibels(square)
}

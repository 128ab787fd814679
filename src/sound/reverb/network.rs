//! Inner loop of the reverb: delay lines, absorption filters and mixing matrix, a chunk of frames at a time.
//!
//! No line is shorter than a chunk, so a chunk's output does not depend on its input. Delays and mixing are vectorised over frames;
//! the recursive filters are vectorised over lines, with a transposition between. Each number is computed as it would be
//! alone, so chunks of any length give the same bits.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16, u32x16};

use super::absorption::{Absorptions, SHELVES};
use super::lines::{FLOOR, LINES};

/// Most frames of a chunk, as many as lines.
pub(super) const CHUNK: usize = LINES;
/// A number of each frame of a chunk.
pub(super) type Chunk = [f32; CHUNK];

/// Half of a line's shelves.
const HALF: usize = SHELVES / 2;

/// Coefficient of the allpasses (Schroeder 1962 has 0.7): a little less, so that single clicks do not ring.
const DIFFUSION: f32 = 0.6;
/// Factor of H that keeps energy: 1/√16, in H/4.
const MIXED: f32 = 0.25;
/// Gain into the lines: energy 1 for either side, which has eight of them (1/√8), with the signs of a row of H.
const INTO: f32 = 0.353_553_4;
/// Row of H whose signs the input has.
const INTO_ROW: usize = 6;
/// Row of H/4 that the left output takes; the mixing makes it anyway.
const LEFT: usize = 9;
/// Row of H/4 that the right output takes: orthogonal to the left one's.
const RIGHT: usize = 12;

/// Is H_ri = (−1)^popcount(r & i), of the Hadamard matrix, below 0?
const fn is_negative(r: usize, i: usize) -> bool {
    (r & i).count_ones() % 2 == 1
}

/// A delay line. The first chunk of the ring is repeated behind its end, so that a chunk is contiguous wherever it begins.
pub(super) struct Delay {
    samples: Vec<f32>,
    at: usize,
}

impl Delay {
    /// Silent, of so many frames; not less than [`CHUNK`], or no chunk may be longer.
    pub fn new(frames: usize) -> Self {
        Self { samples: vec![0.0; frames + CHUNK], at: 0 }
    }

    /// Frames.
    pub fn length(&self) -> usize {
        self.samples.len() - CHUNK
    }

    /// Silent.
    pub fn clear(&mut self) {
        self.samples.fill(0.0);
    }

    /// The next chunk of output.
    #[inline(always)]
    fn read<S: Simd>(&self, simd: S) -> f32x16<S> {
        let chunk: Chunk = self.samples[self.at..].first_chunk().copied().unwrap_or_default();
        chunk.simd_into(simd)
    }

    /// Writes the first `n` of a chunk in place of those that were read.
    #[inline(always)]
    fn write(&mut self, chunk: &Chunk, n: usize) {
        match self.samples[self.at..].first_chunk_mut() {
            Some(place) if n == CHUNK => *place = *chunk,
            _ => self.samples[self.at..self.at + n].copy_from_slice(&chunk[..n]),
        }
        let length = self.length();
        let (from, next) = (self.at, self.at + n);
        self.at = if next < length { next } else { next - length };
        if from < CHUNK || next > length {
            self.write_again(&chunk[..n], from);
        }
    }

    /// What went in at `from` once more, where it stands behind the end or passes it: from the chunk, as what has just been written
    /// to the ring would be waited for. Rare, and so kept apart: or a chunk would always be put together in memory.
    #[cold]
    #[inline(never)]
    fn write_again(&mut self, chunk: &[f32], from: usize) {
        let length = self.length();
        let within = chunk.len().min(length - from);
        self.samples[..chunk.len() - within].copy_from_slice(&chunk[within..]);
        let first = chunk.len().min(CHUNK.saturating_sub(from));
        self.samples[length + from.min(CHUNK)..][..first].copy_from_slice(&chunk[..first]);
    }

    /// One Schroeder allpass: y = v[n−m] − k v, v = x + k v[n−m].
    #[inline(always)]
    pub fn diffuse<S: Simd>(&mut self, simd: S, x: f32x16<S>, n: usize) -> f32x16<S> {
        let delayed = self.read(simd);
        let v = x + delayed * DIFFUSION;
        self.write(&floored(v).into(), n);
        delayed - v * DIFFUSION
    }
}

/// All lines and their filters.
pub(super) struct Network {
    lines: [Delay; LINES],
    absorption: Absorptions,
    /// Two a shelf and line.
    states: [[[f32; LINES]; 2]; SHELVES],
}

impl Network {
    /// Silent.
    pub fn new(lengths: &[usize; LINES], absorption: Absorptions) -> Self {
        Self { lines: lengths.map(Delay::new), absorption, states: [[[0.0; LINES]; 2]; SHELVES] }
    }

    /// Clears the states of the filters.
    pub fn clear_filters(&mut self) {
        self.states = [[[0.0; LINES]; 2]; SHELVES];
    }

    /// Takes `n` frames of the left and of the right side in; answers what comes out on either, and whether at a frame anything has
    /// gone into any line: 0 where nothing has.
    #[inline(always)]
    pub fn run<S: Simd>(&mut self, simd: S, input: [f32x16<S>; 2], n: usize) -> ([f32x16<S>; 2], u32x16<S>) {
        let by_lines: [f32x16<S>; LINES] = std::array::from_fn(|i| self.lines[i].read(simd));
        let mut frames = transposed(by_lines);
        self.absorb(simd, &mut frames[..n]);
        let mut y = transposed(frames);
        mix(&mut y);
        let input = input.map(|side| side * INTO);
        let mut any = u32x16::splat(simd, 0);
        for i in 0..LINES {
            let side = input[i % 2];
            let into = floored(if is_negative(INTO_ROW, i) { y[i] - side } else { y[i] + side });
            any |= into.bitcast::<u32x16<S>>();
            self.lines[i].write(&into.into(), n);
        }
        ([y[LEFT], y[RIGHT]], any)
    }

    /// Each frame through the filters of the lines: half of the shelves at a time, whose numbers a processor's registers hold.
    #[inline(always)]
    fn absorb<S: Simd>(&mut self, simd: S, frames: &mut [f32x16<S>]) {
        let load = |x: &[f32; LINES]| -> f32x16<S> { (*x).simd_into(simd) };
        let gain = load(&self.absorption.gain) * MIXED;
        for half in 0..2 {
            let own = HALF * half..HALF * (half + 1);
            let shelves: [[f32x16<S>; 4]; HALF] =
                std::array::from_fn(|k| self.absorption.shelves[own.start + k].each_ref().map(load));
            let mut states: [[f32x16<S>; 2]; HALF] =
                std::array::from_fn(|k| self.states[own.start + k].each_ref().map(load));
            for frame in &mut *frames {
                let mut y = if half == 0 { *frame * gain } else { *frame };
                for ([c1, c2, a1, a2], [s1, s2]) in shelves.iter().zip(&mut states) {
                    let (x, w) = (y, *s1);
                    y = x + w;
                    *s1 = *c1 * x - *a1 * w + *s2;
                    *s2 = *c2 * x - *a2 * w;
                }
                *frame = y;
            }
            for (kept, state) in self.states[own].iter_mut().zip(states) {
                *kept = state.map(Into::into);
            }
        }
    }
}

/// H by the fast transform: sums and differences of pairs. The 1/4 of H/4 is in the lines' gain already.
#[inline(always)]
fn mix<S: Simd>(y: &mut [f32x16<S>; LINES]) {
    for half in [8, 4, 2, 1] {
        for i in (0..LINES).filter(|i| i & half == 0) {
            (y[i], y[i + half]) = (y[i] + y[i + half], y[i] - y[i + half]);
        }
    }
}

/// Rows for columns: each round takes the highest bit of a number's row for the lowest of its column.
#[inline(always)]
fn transposed<S: Simd>(mut rows: [f32x16<S>; LINES]) -> [f32x16<S>; LINES] {
    for _ in 0..LINES.ilog2() {
        let before = rows;
        for i in 0..LINES / 2 {
            rows[2 * i] = before[i].zip_low(before[i + LINES / 2]);
            rows[2 * i + 1] = before[i].zip_high(before[i + LINES / 2]);
        }
    }
    rows
}

/// 0 for what is below [`FLOOR`]: rounding alone would keep the smallest numbers going round for ever.
#[inline(always)]
fn floored<S: Simd>(x: f32x16<S>) -> f32x16<S> {
    x.abs().simd_lt(FLOOR).select(f32x16::splat(x.simd, 0.0), x)
}

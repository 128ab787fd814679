//! Reverberation: a feedback delay network (FDN).
//!
//! Sixteen delay lines; what leaves them is absorbed, mixed by a Hadamard matrix and goes in again:
//!
//! ```text
//! in ─→ diffuser ─→ b ─→ (+) ─→ z^−m ─→ A(z) ─┬─→ c ─→ out
//!                         └───── H/4 ─────────┘
//! ```
//!
//! (Stautner and Puckette, "Designing multi-channel reverberators", Computer Music Journal 6, 1982; Jot and Chaigne 1991.)
//! H/4 keeps energy, so only A takes any: each line loses what its own length asks for ([`absorption`]), and all
//! modes of one octave die in the same time. Lengths are primes between 21 and 79 ms, evenly in their logarithms. Their
//! sum, 0.7 s, is the number of modes a hertz, more than the 0.15 T60 of a smooth tail
//! (Schroeder, "Natural sounding artificial reverberation", JAES 10, 1962).
//! The diffuser, three Schroeder allpasses a channel, makes clouds of the first echoes.
//!
//! Left goes into every second line and right into the others; two rows of H lead out, so the tails of the two sides are
//! not alike and a centred sound surrounds the listener. The input already contains the distance of a source. A metre of air
//! takes less than 0.3 dB at 16 kHz and is left out; the air absorption of the reverberation is part of T60.
//!
//! Level: of energy 1 that goes in, g²/(1 − g²)/16 comes out on either side, g² = 10^(−6 τ/T60) with the mean line τ;
//! [`ReverbSpec::level_db`] is the energy of the reverberation over that of the sound itself, at 1 kHz.
//!
//! Real-time: all storage is made by [`Reverb::new`]. A silent reverb (below −240 dB) skips work until the next
//! input, which also avoids denormal numbers.

mod absorption;
mod lines;
mod network;

pub use lines::BANDS;

use fearless_simd::prelude::*;
use fearless_simd::{Level, Simd, dispatch, f32x16, u32x16};

use crate::bounds::FAULT_LEVEL;
use absorption::{Absorption, Absorptions};
use lines::LINES;
use network::{CHUNK, Delay, Network};

use soffio_math::{amplitude_to_db, db_to_amplitude, pow, sqrt};

/// Allowed decay times, s: from a furnished room to a church.
pub const T60_RANGE: std::ops::RangeInclusive<f64> = 0.2..=5.0;
/// Greatest ratio of the decay times of neighbouring octaves that the shelves of `absorption` can follow.
pub const MAX_T60_RATIO: f64 = 1.6;

/// Shortest and longest line, s. Their sum gives the mode density of a smooth tail (Schroeder 1962).
const LENGTHS: (f64, f64) = (0.021, 0.079);
/// Delays of the allpasses of the left and of the right channel, s: incommensurate, and between 1 and 10 ms, where
/// echoes fuse.
const DIFFUSERS: [[f64; 3]; 2] = [[0.0017, 0.0041, 0.0089], [0.0019, 0.0045, 0.0083]];
/// Band whose decay sets the level: 1 kHz.
const LEVEL_BAND: usize = 3;

/// Specification of a reverb.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReverbSpec {
    /// Energy of the reverberation over the direct sound's, dB, at 1 kHz.
    pub level_db: f64,
    /// Decay by 60 dB in the octaves of [`BANDS`], s.
    pub t60: [f64; BANDS.len()],
}

impl ReverbSpec {
    /// A gallery of some 350 m³: plastered walls, a wooden floor, a few visitors. Its level is low, because the kiosk
    /// stands in a room already.
    pub const GALLERY: Self = Self { level_db: -8.0, t60: [1.6, 1.5, 1.4, 1.3, 1.15, 0.95, 0.7] };

    /// The first problem of it, with its octave; `None` if it is valid.
    pub fn problem(&self) -> Option<String> {
        for (band, t60) in BANDS.iter().zip(self.t60) {
            if !T60_RANGE.contains(&t60) {
                let (low, high) = (T60_RANGE.start(), T60_RANGE.end());
                return Some(format!("{t60} s at {band} Hz is outside {low} to {high} s"));
            }
        }
        let pairs = BANDS.windows(2).zip(self.t60.windows(2));
        for (band, t60) in pairs {
            let ratio = t60[0].max(t60[1]) / t60[0].min(t60[1]);
            if ratio > MAX_T60_RATIO {
                let (a, b) = (band[0], band[1]);
                return Some(format!(
                    "from {a} to {b} Hz it changes by a factor of {ratio:.2}, at most {MAX_T60_RATIO}"
                ));
            }
        }
        None
    }

    /// Decay by 60 dB at any frequency, s, of the reverb at this rate: exact at the octaves' centres, interpolated by the filters
    /// between them.
    pub fn decay(&self, frequency: f64, sample_rate: u32) -> f64 {
        let rate = f64::from(sample_rate);
        let samples = rate * sqrt(LENGTHS.0 * LENGTHS.1);
        let level = Absorption::new(samples as usize, &self.t60, rate).level(frequency, rate);
        -60.0 * (samples as usize) as f64 / (rate * level)
    }
}

/// The reverb: a stereo feedback delay network.
pub struct Reverb {
    /// Which instructions there are.
    simd: Level,
    diffusers: [[Delay; 3]; 2],
    network: Network,
    level: f32,
    /// Greatest number of frames side by side: no delay is shorter.
    chunk: usize,
    /// Frames since the last non-zero input of any line.
    quiet: usize,
    /// Frames after which all lines are empty.
    memory: usize,
}

impl Reverb {
    /// A silent reverb; `None` for an invalid specification (see [`ReverbSpec::problem`]).
    pub fn new(spec: &ReverbSpec, sample_rate: f64) -> Option<Self> {
        if spec.problem().is_some() {
            return None;
        }
        let lengths = lengths(sample_rate);
        let absorption = Absorptions::new(&lengths, &spec.t60, sample_rate)?;
        let allpass = |seconds: f64| Delay::new(prime((seconds * sample_rate) as usize));
        let diffusers = DIFFUSERS.map(|channel| channel.map(allpass));
        let delays = diffusers.iter().flatten().map(Delay::length).chain(lengths);
        Some(Self {
            simd: Level::new(),
            chunk: delays.fold(CHUNK, usize::min),
            diffusers,
            network: Network::new(&lengths, absorption),
            level: (db_to_amplitude(spec.level_db) / unit_level(&lengths, spec.t60[LEVEL_BAND], sample_rate)) as f32,
            quiet: usize::MAX,
            memory: lengths.into_iter().fold(0, usize::max),
        })
    }

    /// Replaces frames by their reverberation, without the direct sound. How they are cut into calls does not matter.
    pub fn process(&mut self, frames: &mut [[f32; 2]]) {
        dispatch!(self.simd, simd => self.process_in(simd, frames));
    }

    #[inline(always)]
    fn process_in<S: Simd>(&mut self, simd: S, mut frames: &mut [[f32; 2]]) {
        while !frames.is_empty() {
            if self.quiet > self.memory {
                // The reverberation of silence is silence.
                let Some(first) = frames.iter().position(|frame| *frame != [0.0; 2]) else { return };
                frames = &mut frames[first..];
                self.clear();
            }
            // It becomes idle between two chunks.
            let n = frames.len().min(self.chunk).min(self.memory + 1 - self.quiet);
            let (now, later) = frames.split_at_mut(n);
            self.run(simd, now);
            frames = later;
        }
    }

    /// All frames of a chunk, and all lines, go side by side through the widest registers that there are.
    #[inline(always)]
    fn run<S: Simd>(&mut self, simd: S, frames: &mut [[f32; 2]]) {
        let n = frames.len();
        let mut both = [[0.0; 2]; CHUNK];
        match frames.first_chunk() {
            Some(whole) => both = *whole,
            None => both[..n].copy_from_slice(frames),
        }
        let (first, second) = both.as_flattened().split_at(CHUNK);
        let (first, second) = (f32x16::from_slice(simd, first), f32x16::from_slice(simd, second));
        let mut input = [first.unzip_low(second), first.unzip_high(second)].map(sanitised);
        let heard = input.map(|side| side.abs().bitcast::<u32x16<S>>());
        for (x, allpasses) in input.iter_mut().zip(&mut self.diffusers) {
            for allpass in allpasses {
                *x = allpass.diffuse(simd, *x, n);
            }
        }
        let ([left, right], into) = self.network.run(simd, input, n);
        let any: [u32; CHUNK] = (heard[0] | heard[1] | into).into();
        let loud = any[..n].iter().rposition(|&bits| bits != 0);
        self.quiet = loud.map_or(self.quiet + n, |last| n - 1 - last);
        let (left, right) = (left * self.level, right * self.level);
        let (first, second) = both.as_flattened_mut().split_at_mut(CHUNK);
        left.zip_low(right).store_slice(first);
        left.zip_high(right).store_slice(second);
        match frames.first_chunk_mut() {
            Some(whole) => *whole = both,
            None => frames.copy_from_slice(&both[..n]),
        }
    }

    /// Clears all state, which is far inaudible by now.
    fn clear(&mut self) {
        self.network.clear_filters();
        self.diffusers.iter_mut().flatten().for_each(Delay::clear);
        self.quiet = 0;
    }
}

/// Clamps to the fault level; 0 for numbers that are not finite.
#[inline(always)]
fn sanitised<S: Simd>(x: f32x16<S>) -> f32x16<S> {
    // A fault is clamped, so that it does not persist in the lines.
    let bounded = x.min(FAULT_LEVEL).max(-FAULT_LEVEL);
    x.abs().simd_lt(f32::INFINITY).select(bounded, f32x16::splat(x.simd, 0.0))
}

/// Amplitude of the impulse response at a level of 0 dB.
fn unit_level(lengths: &[usize; LINES], t60: f64, sample_rate: f64) -> f64 {
    let mean = lengths.iter().sum::<usize>() as f64 / LINES as f64 / sample_rate;
    let kept = pow(10.0, -6.0 * mean / t60);
    sqrt(kept / (1.0 - kept) / LINES as f64)
}

/// Line lengths: primes, evenly in their logarithms, so that no two lines have a common echo.
fn lengths(sample_rate: f64) -> [usize; LINES] {
    let octaves = amplitude_to_db(LENGTHS.1 / LENGTHS.0) / (LINES - 1) as f64;
    let mut least = 0;
    std::array::from_fn(|i| {
        let target = (LENGTHS.0 * sample_rate * db_to_amplitude(octaves * i as f64)) as usize;
        least = prime(target.max(least + 1));
        least
    })
}

/// The first prime from here on.
fn prime(from: usize) -> usize {
    let is_prime = |n: usize| (2..).take_while(|d| d * d <= n).all(|d| !n.is_multiple_of(d));
    (from.max(2)..).find(|&n| is_prime(n)).unwrap_or(from)
}

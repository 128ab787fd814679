//! The room that a sound is heard in: a feedback delay network.
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
//! modes of one octave die in the same time. Lengths are primes between 21 and 79 ms, evenly in their logarithms: their
//! sum, 0.7 s, is the number of modes a hertz, more than the 0.15 T60 that an ear needs for a smooth tail
//! (Schroeder, "Natural sounding artificial reverberation", JAES 10, 1962).
//! The diffuser, three Schroeder allpasses a channel, makes clouds of the first echoes.
//!
//! Left goes into every second line and right into the others; two rows of H lead out, so the tails of the two sides are
//! not alike and a centred sound is heard all around. The distance of a source is in what comes in already; the air between
//! work and visitor, a metre of it, takes less than 0.3 dB at 16 kHz and is left out, that of the room's own ways is in T60.
//!
//! Level: of energy 1 that goes in, g²/(1 − g²)/16 comes out on either side, g² = 10^(−6 τ/T60) with the mean line τ;
//! [`ReverbSpec::level_db`] is the energy of the reverberation over that of the sound itself, at 1 kHz.
//!
//! Real-time: all storage is made by [`Room::new`]. A room that has become silent (below −240 dB) sleeps until there is
//! something to be heard, which spares work and keeps numbers out of the range where processors are slow.

mod absorption;
mod lines;
mod network;

pub use lines::BANDS;

use fearless_simd::prelude::*;
use fearless_simd::{Level, Simd, dispatch, f32x16, u32x16};

use absorption::{Absorption, Absorptions};
use lines::LINES;
use network::{CHUNK, Delay, Network};

use soffio_math::{amplitude_to_db, db_to_amplitude, pow, sqrt};

/// Shortest and longest decay that a room may have, s.
pub const T60_RANGE: std::ops::RangeInclusive<f64> = 0.2..=5.0;
/// Most that decays of neighbouring octaves may differ, as a ratio: what the shelves of `absorption` can follow.
pub const STEEPEST: f64 = 1.6;

/// Shortest and longest line, s.
const LENGTHS: (f64, f64) = (0.021, 0.079);
/// Allpasses of the left and of the right channel, s.
const DIFFUSERS: [[f64; 3]; 2] = [[0.0017, 0.0041, 0.0089], [0.0019, 0.0045, 0.0083]];
/// Louder than any sound; a number beyond it is a fault that must not live on in the lines.
const LOUDEST: f32 = 1e3;
/// Band whose decay sets the level: 1 kHz.
const MIDDLE: usize = 3;

/// A room as it is asked for.
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

    /// What is wrong with it, and the octave.
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
            if ratio > STEEPEST {
                let (a, b) = (band[0], band[1]);
                return Some(format!("from {a} to {b} Hz it changes by a factor of {ratio:.2}, at most {STEEPEST}"));
            }
        }
        None
    }

    /// Decay by 60 dB at any frequency, s, of a room that is built like this at this rate: as asked at the octaves'
    /// centres, and what the filters make of it between them.
    pub fn decay(&self, frequency: f64, sample_rate: u32) -> f64 {
        let rate = f64::from(sample_rate);
        let samples = rate * sqrt(LENGTHS.0 * LENGTHS.1);
        let level = Absorption::new(samples as usize, &self.t60, rate).level(frequency, rate);
        -60.0 * (samples as usize) as f64 / (rate * level)
    }
}

/// A room that sounds.
pub struct Reverb {
    /// Which instructions there are.
    simd: Level,
    diffusers: [[Delay; 3]; 2],
    network: Network,
    level: f32,
    /// Most frames that go side by side: none of the delays is shorter.
    chunk: usize,
    /// Frames for which nothing has gone into any line.
    quiet: usize,
    /// Frames after which nothing is left in any.
    forgets: usize,
}

impl Reverb {
    /// A silent room; `None` when it would not decay ([`ReverbSpec::problem`] says why).
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
            level: (db_to_amplitude(spec.level_db) / own_level(&lengths, spec.t60[MIDDLE], sample_rate)) as f32,
            quiet: usize::MAX,
            forgets: lengths.into_iter().fold(0, usize::max),
        })
    }

    /// The room's answer to these frames in their place: what comes on top of the sound itself. How they are cut into
    /// calls does not matter.
    pub fn answer(&mut self, frames: &mut [[f32; 2]]) {
        dispatch!(self.simd, simd => self.answer_in(simd, frames));
    }

    #[inline(always)]
    fn answer_in<S: Simd>(&mut self, simd: S, mut frames: &mut [[f32; 2]]) {
        while !frames.is_empty() {
            if self.quiet > self.forgets {
                // What is silent already is its answer to silence.
                let Some(first) = frames.iter().position(|frame| *frame != [0.0; 2]) else { return };
                frames = &mut frames[first..];
                self.wake();
            }
            // It falls asleep between two chunks.
            let n = frames.len().min(self.chunk).min(self.forgets + 1 - self.quiet);
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
        let mut fed = [first.unzip_low(second), first.unzip_high(second)].map(sane);
        let heard = fed.map(|side| side.abs().bitcast::<u32x16<S>>());
        for (x, allpasses) in fed.iter_mut().zip(&mut self.diffusers) {
            for allpass in allpasses {
                *x = allpass.diffuse(simd, *x, n);
            }
        }
        let ([left, right], into) = self.network.run(simd, fed, n);
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

    /// Everything is so small by now that it counts as nothing.
    fn wake(&mut self) {
        self.network.still();
        self.diffusers.iter_mut().flatten().for_each(Delay::clear);
        self.quiet = 0;
    }
}

/// Within what is ever loud; 0 for what is no number.
#[inline(always)]
fn sane<S: Simd>(x: f32x16<S>) -> f32x16<S> {
    let bounded = x.min(LOUDEST).max(-LOUDEST);
    x.abs().simd_lt(f32::INFINITY).select(bounded, f32x16::splat(x.simd, 0.0))
}

/// Amplitude of the answer to an impulse at a level of 0 dB.
fn own_level(lengths: &[usize; LINES], t60: f64, sample_rate: f64) -> f64 {
    let mean = lengths.iter().sum::<usize>() as f64 / LINES as f64 / sample_rate;
    let kept = pow(10.0, -6.0 * mean / t60);
    sqrt(kept / (1.0 - kept) / LINES as f64)
}

/// Primes, evenly in their logarithms: no two lines have an echo in common.
fn lengths(sample_rate: f64) -> [usize; LINES] {
    let octaves = amplitude_to_db(LENGTHS.1 / LENGTHS.0) / (LINES - 1) as f64;
    let mut least = 0;
    std::array::from_fn(|i| {
        let wanted = (LENGTHS.0 * sample_rate * db_to_amplitude(octaves * i as f64)) as usize;
        least = prime(wanted.max(least + 1));
        least
    })
}

/// The first prime from here on.
fn prime(from: usize) -> usize {
    let is_prime = |n: usize| (2..).take_while(|d| d * d <= n).all(|d| !n.is_multiple_of(d));
    (from.max(2)..).find(|&n| is_prime(n)).unwrap_or(from)
}

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
//! [`RoomSpec::level_db`] is the energy of the reverberation over that of the sound itself, at 1 kHz.
//!
//! Real-time: all storage is made by [`Room::new`]. A room that has become silent (below −240 dB) sleeps until there is
//! something to be heard, which spares work and keeps numbers out of the range where processors are slow.

mod absorption;

use fearless_simd::{Level, Simd, dispatch};

use absorption::{Absorption, Absorptions, SHELVES};

use crate::math::{decibels, from_decibels, pow, sqrt};

/// Delay lines.
pub(super) const LINES: usize = 16;
/// Octaves at which a room's decay is given, Hz.
pub const BANDS: [f64; 7] = [125.0, 250.0, 500.0, 1000.0, 2000.0, 4000.0, 8000.0];
/// Shortest and longest decay that a room may have, s.
pub const T60_RANGE: std::ops::RangeInclusive<f64> = 0.2..=5.0;
/// Most that decays of neighbouring octaves may differ, as a ratio: what the shelves of `absorption` can follow.
pub const STEEPEST: f64 = 1.6;

/// Shortest and longest line, s.
const LENGTHS: (f64, f64) = (0.021, 0.079);
/// Allpasses of the left and of the right channel, s, and their coefficient.
const DIFFUSERS: [[f64; 3]; 2] = [[0.0017, 0.0041, 0.0089], [0.0019, 0.0045, 0.0083]];
const DIFFUSION: f32 = 0.6;
/// What is below this becomes 0: −240 dB.
const FLOOR: f32 = 1e-12;
/// Louder than any sound; a number beyond it is a fault that must not live on in the lines.
const LOUDEST: f32 = 1e3;
/// Band whose decay sets the level: 1 kHz.
const MIDDLE: usize = 3;

/// A room as it is asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoomSpec {
    /// Energy of the reverberation over the direct sound's, dB, at 1 kHz.
    pub level_db: f64,
    /// Decay by 60 dB in the octaves of [`BANDS`], s.
    pub t60: [f64; BANDS.len()],
}

impl RoomSpec {
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

/// One Schroeder allpass: y = v[n−m] − k v, v = x + k v[n−m].
struct Allpass {
    line: Vec<f32>,
    at: usize,
}

impl Allpass {
    #[inline(always)]
    fn process(&mut self, x: f32) -> f32 {
        let delayed = self.line[self.at];
        let v = x + DIFFUSION * delayed;
        self.line[self.at] = floored(v);
        self.at = if self.at + 1 == self.line.len() { 0 } else { self.at + 1 };
        delayed - DIFFUSION * v
    }
}

/// A room that sounds.
pub struct Room {
    /// Which instructions there are.
    simd: Level,
    diffusers: [[Allpass; 3]; 2],
    /// All lines one after the other; `ends` are their ends, `at` where each is read and written.
    lines: Vec<f32>,
    starts: [usize; LINES],
    ends: [usize; LINES],
    at: [usize; LINES],
    absorption: Absorptions,
    /// Two a shelf and line.
    states: [[[f32; LINES]; 2]; SHELVES],
    level: f32,
    /// Frames for which nothing has gone into any line.
    quiet: usize,
    /// Frames after which nothing is left in any.
    forgets: usize,
}

impl Room {
    /// A silent room; `None` when it would not decay ([`RoomSpec::problem`] says why).
    pub fn new(spec: &RoomSpec, sample_rate: f64) -> Option<Self> {
        if spec.problem().is_some() {
            return None;
        }
        let lengths = lengths(sample_rate);
        let absorption = Absorptions::new(&lengths, &spec.t60, sample_rate)?;
        let mut starts = [0; LINES];
        let mut end = 0;
        let ends = std::array::from_fn(|i| {
            starts[i] = end;
            end += lengths[i];
            end
        });
        let allpass = |seconds: f64| Allpass { line: vec![0.0; prime((seconds * sample_rate) as usize)], at: 0 };
        let longest = lengths.iter().max().copied().unwrap_or_default();
        Some(Self {
            simd: Level::new(),
            diffusers: DIFFUSERS.map(|channel| channel.map(allpass)),
            lines: vec![0.0; end],
            starts,
            ends,
            at: starts,
            absorption,
            states: [[[0.0; LINES]; 2]; SHELVES],
            level: (from_decibels(spec.level_db) / own_level(&lengths, spec.t60[MIDDLE], sample_rate)) as f32,
            quiet: usize::MAX,
            forgets: longest,
        })
    }

    /// The room's answer to a frame: what comes on top of the sound itself.
    pub fn process(&mut self, frame: [f32; 2]) -> [f32; 2] {
        dispatch!(self.simd, simd => self.answer(simd, frame))
    }

    /// All lines go side by side through the widest registers that there are; each number is made as in any others.
    #[inline(always)]
    fn answer<S: Simd>(&mut self, _: S, frame: [f32; 2]) -> [f32; 2] {
        let frame = frame.map(|x| if x.is_finite() { x.clamp(-LOUDEST, LOUDEST) } else { 0.0 });
        if self.quiet > self.forgets {
            if frame == [0.0; 2] {
                return [0.0; 2];
            }
            self.wake();
        }
        let mut fed = frame;
        for (x, allpasses) in fed.iter_mut().zip(&mut self.diffusers) {
            for allpass in allpasses {
                *x = allpass.process(*x);
            }
        }
        let mut y: [f32; LINES] = std::array::from_fn(|i| self.lines[self.at[i]]);
        self.absorb(&mut y);
        let [mut left, mut right] = [0.0f32; 2];
        for (i, y) in y.iter().enumerate() {
            left += LEFT[i] * y;
            right += RIGHT[i] * y;
        }
        mix(&mut y);
        let mut anything = frame != [0.0; 2];
        for i in 0..LINES {
            let into = floored(y[i] + INTO[i] * fed[i % 2]);
            anything |= into != 0.0;
            self.lines[self.at[i]] = into;
            self.at[i] = if self.at[i] + 1 == self.ends[i] { self.starts[i] } else { self.at[i] + 1 };
        }
        self.quiet = if anything { 0 } else { self.quiet + 1 };
        [left * self.level, right * self.level]
    }

    #[inline(always)]
    fn absorb(&mut self, y: &mut [f32; LINES]) {
        let Absorptions { gain, shelves } = &self.absorption;
        for i in 0..LINES {
            y[i] *= gain[i];
        }
        for ([b0, b1, b2, a1, a2], [s1, s2]) in shelves.iter().zip(&mut self.states) {
            for i in 0..LINES {
                let x = y[i];
                y[i] = b0[i] * x + s1[i];
                s1[i] = b1[i] * x - a1[i] * y[i] + s2[i];
                s2[i] = b2[i] * x - a2[i] * y[i];
            }
        }
    }

    /// Everything is so small by now that it counts as nothing.
    fn wake(&mut self) {
        self.states = [[[0.0; LINES]; 2]; SHELVES];
        self.diffusers.iter_mut().flatten().for_each(|allpass| allpass.line.fill(0.0));
        self.quiet = 0;
    }
}

/// Row of the Hadamard matrix H_ri = (−1)^popcount(r & i), times a factor.
const fn row(r: usize, factor: f32) -> [f32; LINES] {
    let mut out = [factor; LINES];
    let mut i = 0;
    while i < LINES {
        if (r & i).count_ones() % 2 == 1 {
            out[i] = -factor;
        }
        i += 1;
    }
    out
}

/// Into the lines: energy 1 for either side, which has eight of them (1/√8).
const INTO: [f32; LINES] = row(6, 0.353_553_4);
/// Out of the lines.
const LEFT: [f32; LINES] = row(9, 0.25);
const RIGHT: [f32; LINES] = row(12, 0.25);

/// H/4 by the fast transform: sums and differences of pairs.
#[inline(always)]
fn mix(y: &mut [f32; LINES]) {
    let mut half = LINES / 2;
    while half > 0 {
        for start in (0..LINES).step_by(2 * half) {
            for i in start..start + half {
                (y[i], y[i + half]) = (y[i] + y[i + half], y[i] - y[i + half]);
            }
        }
        half /= 2;
    }
    y.iter_mut().for_each(|y| *y *= 0.25);
}

/// 0 for what is below [`FLOOR`]: rounding alone would keep the smallest numbers going round for ever.
#[inline(always)]
fn floored(x: f32) -> f32 {
    if x.abs() < FLOOR { 0.0 } else { x }
}

/// Amplitude of the answer to an impulse at a level of 0 dB.
fn own_level(lengths: &[usize; LINES], t60: f64, sample_rate: f64) -> f64 {
    let mean = lengths.iter().sum::<usize>() as f64 / LINES as f64 / sample_rate;
    let kept = pow(10.0, -6.0 * mean / t60);
    sqrt(kept / (1.0 - kept) / LINES as f64)
}

/// Primes, evenly in their logarithms: no two lines have an echo in common.
fn lengths(sample_rate: f64) -> [usize; LINES] {
    let octaves = decibels(LENGTHS.1 / LENGTHS.0) / (LINES - 1) as f64;
    let mut least = 0;
    std::array::from_fn(|i| {
        let wanted = (LENGTHS.0 * sample_rate * from_decibels(octaves * i as f64)) as usize;
        least = prime(wanted.max(least + 1));
        least
    })
}

/// The first prime from here on.
fn prime(from: usize) -> usize {
    let is_prime = |n: usize| (2..).take_while(|d| d * d <= n).all(|d| !n.is_multiple_of(d));
    (from.max(2)..).find(|&n| is_prime(n)).unwrap_or(from)
}

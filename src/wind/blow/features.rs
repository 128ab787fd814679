//! What tells a breath from a room: a dozen numbers per frame, none of which knows the microphone's gain.
//!
//! The room is a power spectrum that follows the microphone slowly and stands still while somebody blows. What rises
//! above it (the *excess*, power subtraction after Boll 1979) is judged by shape: breath at a capsule is noise below
//! 200 Hz that falls by 12 dB an octave, has no pitch, and neither jumps nor dies like a knock.
//!
//! Symbols: S_k smoothed power of bin k, F_k room, O_k the kiosk's own, E_k = max(S_k − 1.5 F_k − O_k, 0) excess, B_i sums of E over
//! 31–94, 94–203, 203–406, 406–812, 812–1625, 1625–3400 Hz.

use super::spectrum::{BINS, FRAME_S, Power, TRANSFORM, band};
use crate::math::{PI, cos, exp, ln, log10};

/// Number of features.
pub const COUNT: usize = 14;

/// Names of the features, in order.
pub const NAMES: [&str; COUNT] = [
    "rise of the low band over the room, 10 dB",
    "the same less twice the room's unrest, 10 dB",
    "share of the low band in the excess, 10 dB",
    "31–94 Hz over 94–203 Hz, 10 dB",
    "203–406 Hz over the low band, 10 dB",
    "406–1625 Hz over the low band, 10 dB",
    "1625–3400 Hz over 406–1625 Hz, 10 dB",
    "periodicity of the excess, 80–400 Hz",
    "flatness of the low band, 10 dB",
    "flatness of 406–1625 Hz, 10 dB",
    "fall from the peak of the last 0.2 s, 10 dB",
    "climb of the low band in the last 48 ms, 10 dB",
    "rise of 406–1625 Hz over the room, 10 dB",
    "flatness of the low band over 80 ms, 10 dB",
];

/// One frame's features, in the order of [`NAMES`].
pub type Features = [f64; COUNT];

/// Index of the periodicity.
pub const PERIODICITY: usize = 7;
/// Index of the middle's share.
pub const MIDDLE_SHARE: usize = 5;
/// Index of the fall from the peak.
pub const FALL: usize = 10;

/// Bins of the low band, 31–203 Hz.
pub const LOW: (usize, usize) = (2, 13);
/// Bins of the middle, 406–1625 Hz.
const MIDDLE: (usize, usize) = (26, 104);
/// Bins of everything that is looked at.
const ALL: (usize, usize) = (2, 218);
/// Bins that may carry harmonics of a voice, 94–1000 Hz.
const HARMONICS: (usize, usize) = (6, 64);
/// Lags of 400 Hz and 80 Hz, internal samples.
const PITCH_LAGS: (usize, usize) = (20, 100);
/// Smoothing of the powers, s: longer would make a pop look like a breath.
const SMOOTHING_S: f64 = 0.012;
/// Frames that are remembered, 0.2 s.
const MEMORY: usize = 24;
/// Frames over which a climb is taken, 48 ms: by then a bang falls and a breath still rises.
const CLIMB: usize = 6;
/// A room is never taken to be quieter than this, power (−75 dBFS): below it lies a converter's own noise.
const QUIETEST: f64 = 3.2e-8;
/// Below the room by more than this, it is the room that has become quieter, dB.
const SUNK_DB: f64 = -6.0;
/// Unrest of a steady noise, dB: what its frames scatter by.
const CALM_DB: f64 = 2.0;
/// Part of the predicted own sound that may remain after it is taken away.
const RESIDUE: f64 = 0.03;
/// Keeps logarithms finite; far below [`QUIETEST`].
const NOTHING: f64 = 1e-14;

/// The room and the last fifth of a second.
#[derive(Clone, Debug)]
pub(super) struct Listener {
    smooth: Power,
    room: Power,
    unrest_db: f64,
    frames: u64,
    /// Frames from which the room was learnt.
    learnt: u64,
    /// Low-band levels of the last frames, dB, a ring.
    levels: [f64; MEMORY],
    excess: Power,
    /// Excess of the low band, smoothed over 80 ms: shows a steady tone that single frames hide.
    slow_low: [f64; LOW.1 - LOW.0],
    cosine: Vec<f64>,
}

/// Levels that the decision needs beside the features.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Levels {
    /// Rise of the low band over the room, dB.
    pub rise_db: f64,
    /// Excess of the low band, dB of full scale.
    pub excess_dbfs: f64,
    /// Room's low band, dB of full scale.
    pub floor_dbfs: f64,
}

impl Listener {
    /// A listener that knows no room yet.
    pub fn new() -> Self {
        Self {
            smooth: [0.0; BINS],
            room: [0.0; BINS],
            unrest_db: CALM_DB,
            frames: 0,
            learnt: 0,
            levels: [-100.0; MEMORY],
            excess: [0.0; BINS],
            slow_low: [0.0; LOW.1 - LOW.0],
            cosine: (0..TRANSFORM).map(|i| cos(2.0 * PI * i as f64 / TRANSFORM as f64)).collect(),
        }
    }

    /// Time it has listened, s.
    pub fn age(&self) -> f64 {
        self.frames as f64 * FRAME_S
    }

    /// Hears one frame, of which `own` is explained by the kiosk itself; the room stands still where `frozen`.
    pub fn push(&mut self, power: &Power, own: &Power, frozen: bool) -> (Features, Levels) {
        self.frames += 1;
        let quick = if self.frames == 1 { 1.0 } else { blend(SMOOTHING_S) };
        for (s, p) in self.smooth.iter_mut().zip(power) {
            *s += quick * (p - *s);
        }
        // Of a room that is not known yet, whatever it sounds like is learnt.
        if !frozen || self.is_new() {
            self.learn_room();
        }
        for (((e, s), f), own) in self.excess.iter_mut().zip(&self.smooth).zip(&self.room).zip(own) {
            *e = (s - 1.5 * f - own).max(0.0);
        }
        for (slow, e) in self.slow_low.iter_mut().zip(&self.excess[LOW.0..LOW.1]) {
            *slow += blend(0.08) * (e - *slow);
        }
        let (features, levels) = self.measure(own);
        if !frozen {
            // A room that has become quieter is another room: its old unrest is forgotten.
            let unrest = if levels.rise_db > SUNK_DB { levels.rise_db.abs() } else { CALM_DB };
            self.unrest_db += blend(2.0) * (unrest - self.unrest_db).min(6.0);
        }
        (features, levels)
    }

    /// Has it heard the room for less than a third of a second?
    fn is_new(&self) -> bool {
        self.learnt as f64 * FRAME_S < 0.3
    }

    fn learn_room(&mut self) {
        // The first third of a second counts in full; then down within 0.4 s, up at no more than 9 dB a second,
        // whatever the bang: one frame weighs at most four times the room.
        self.learnt += 1;
        let early = 1.0 / self.learnt as f64;
        let (down, up) = (blend(0.4).max(early), blend(1.5));
        let new = self.is_new();
        for (f, s) in self.room.iter_mut().zip(&self.smooth) {
            *f = if new {
                *f + early * (s - *f)
            } else if s < f {
                *f + down * (s - *f)
            } else {
                *f + up * (s.min(4.0 * *f + QUIETEST) - *f)
            };
        }
    }

    fn measure(&mut self, own: &Power) -> (Features, Levels) {
        let (e, quiet) = (&self.excess, QUIETEST);
        let at = (self.frames % MEMORY as u64) as usize;
        let ago = |frames: usize| (at + MEMORY - frames) % MEMORY;
        let floor = band(&self.room, LOW.0, LOW.1) + quiet;
        let level = decibels(band(&self.smooth, LOW.0, LOW.1) + quiet);
        // Of what the kiosk itself explains, the prediction's own error remains: a little of it is taken as floor.
        let explained = |from, to| RESIDUE * band(own, from, to) + band(&self.room, from, to) + quiet;
        let cleaned = |from, to| {
            let bins = self.smooth[from..to].iter().zip(&own[from..to]);
            bins.map(|(s, own)| (s - own).max(0.0)).sum::<f64>() + quiet
        };
        let rise = decibels(cleaned(LOW.0, LOW.1) / explained(LOW.0, LOW.1));
        self.levels[at] = level;

        let low = band(e, LOW.0, LOW.1);
        let middle = band(e, MIDDLE.0, MIDDLE.1);
        let peak = self.levels.iter().fold(f64::NEG_INFINITY, |m: f64, l| m.max(*l));
        let climb = level - self.levels[ago(CLIMB)];
        let rise_middle = decibels(cleaned(MIDDLE.0, MIDDLE.1) / explained(MIDDLE.0, MIDDLE.1));
        let features = [
            rise.clamp(-5.0, 60.0),
            (rise - 2.0 * self.unrest_db).clamp(-15.0, 60.0),
            ratio(low, band(e, ALL.0, ALL.1)).clamp(-30.0, 0.0),
            ratio(band(e, 2, 6), band(e, 6, 13)).clamp(-20.0, 20.0),
            ratio(band(e, 13, 26), low).clamp(-30.0, 20.0),
            ratio(middle, low).clamp(-40.0, 20.0),
            ratio(band(e, 104, 218), middle).clamp(-30.0, 20.0),
            10.0 * self.periodicity(),
            flatness(&e[LOW.0..LOW.1]).clamp(-20.0, 0.0),
            flatness(&e[MIDDLE.0..MIDDLE.1]).clamp(-20.0, 0.0),
            (peak - level).clamp(0.0, 20.0),
            climb.clamp(-20.0, 20.0),
            rise_middle.clamp(-5.0, 60.0),
            flatness(&self.slow_low).clamp(-20.0, 0.0),
        ]
        .map(|x| 0.1 * x);
        let levels = Levels { rise_db: rise, excess_dbfs: decibels(low), floor_dbfs: decibels(floor) };
        (features, levels)
    }

    /// Highest peak of the autocorrelation between the lags of 400 and 80 Hz, 0 … 1, of the excess between 94 and
    /// 1000 Hz. The spectrum is compressed to its square root first, which whitens it, so that the colour of the noise does
    /// not look like a pitch (Tolonen and Karjalainen 2000). r(τ) = Σ_k √E_k cos(2π k τ / N) (Wiener–Khinchin).
    fn periodicity(&self) -> f64 {
        let mut amplitude = [0.0; HARMONICS.1];
        let mut total = NOTHING;
        for (a, e) in amplitude[HARMONICS.0..].iter_mut().zip(&self.excess[HARMONICS.0..]) {
            *a = e.sqrt();
            total += *a;
        }
        let correlation = |lag: usize| {
            (HARMONICS.0..HARMONICS.1).map(|k| amplitude[k] * self.cosine[(k * lag) % TRANSFORM]).sum::<f64>()
        };
        let peak = (PITCH_LAGS.0..PITCH_LAGS.1).map(correlation).fold(0.0, f64::max);
        (peak / total).clamp(0.0, 1.0)
    }
}

/// Weight of a new frame in an exponential mean with this time constant, s.
pub fn blend(time_constant: f64) -> f64 {
    1.0 - exp(-FRAME_S / time_constant)
}

/// Decibels of a power.
pub fn decibels(power: f64) -> f64 {
    10.0 * log10(power.max(NOTHING))
}

fn ratio(a: f64, b: f64) -> f64 {
    10.0 * log10((a + NOTHING) / (b + NOTHING))
}

/// Spectral flatness, dB: geometric over arithmetic mean, 0 for white noise.
fn flatness(power: &[f64]) -> f64 {
    let count = power.len() as f64;
    let geometric = exp(power.iter().map(|p| ln(p + NOTHING)).sum::<f64>() / count);
    let mean = power.iter().sum::<f64>() / count + NOTHING;
    10.0 * log10(geometric / mean)
}

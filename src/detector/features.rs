//! What tells a breath from a room: forty numbers per frame, none of which knows the microphone's gain, and the means of
//! each over the last tenth and the last half of a second.
//!
//! The room is a power spectrum that follows the microphone slowly and stands still while somebody blows. What rises
//! above it (the *excess*, power subtraction after Boll 1979) is judged by shape, by its last quarter of a second, and by
//! what the seconds before were like: a bump among bumps is less of a breath than the same in a quiet room. A
//! breath at a capsule is noise below 200 Hz that falls by 12 dB an octave; beside the stream it is the hiss above 400 Hz
//! alone. It has no pitch, it swells within a tenth of a second, goes on, and its rumble and its hiss waver each for
//! itself. Knocks jump and die; voices have harmonics; wheels and trains bring the room with them.
//!
//! Symbols: S_k smoothed power of bin k, F_k room, O_k the kiosk's own, E_k = max(S_k − 1.5 F_k − O_k, 0) excess, over the
//! bands 31–94, 94–203, 203–406, 406–812, 812–1625, 1625–3400 Hz. *Low* are the first two, *middle* the last three.

use super::bands::{BANDS, NOTHING};
pub use super::bands::{EDGES, LOW, MIDDLE, QUIETEST_DIFFERENCE, blend, decibels};
pub(super) use super::bands::{QUIETEST, RISEN_DB};
use super::means::{self, Means, TOLD};
use super::past::{Past, Present};
use super::room::Weight;
use super::spectrum::{BINS, FRAME_S, Power, TRANSFORM, band};
use soffio_math::{PI, cos, exp, ln, log10};

/// What is measured in each frame.
pub const MEASURED: usize = 40;
/// Number of features: what is measured, and its means.
pub const COUNT: usize = MEASURED * TOLD;

/// Names of what is measured, in order.
pub const NAMES: [&str; MEASURED] = [
    "rise of 31–94 Hz over the room, 10 dB",
    "rise of 94–203 Hz",
    "rise of 203–406 Hz",
    "rise of 406–812 Hz",
    "rise of 812–1625 Hz",
    "rise of 1625–3400 Hz",
    "rise of low less twice the room's unrest there, 10 dB",
    "rise of middle less twice the room's unrest there, 10 dB",
    "excess of 31–94 Hz over 94–203 Hz, 10 dB",
    "excess of 94–203 Hz over 203–406 Hz",
    "excess of 203–406 Hz over 406–812 Hz",
    "excess of 406–812 Hz over 812–1625 Hz",
    "excess of 812–1625 Hz over 1625–3400 Hz",
    "share of low in the excess, 10 dB",
    "periodicity of the excess, 80–400 Hz",
    "periodicity over 80 ms",
    "flatness of the excess of low over 80 ms, 10 dB",
    "flatness of the excess of 406–1625 Hz over 80 ms, 10 dB",
    "climb of low in 48 ms, 10 dB",
    "climb of low in 0.2 s",
    "climb of middle in 48 ms",
    "climb of middle in 0.2 s",
    "fall of low from its peak in 0.24 s, 10 dB",
    "fall of middle from its peak in 0.24 s",
    "deviation of low in 0.16 s, 10 dB",
    "deviation of middle in 0.16 s",
    "correlation of low and middle in 0.24 s",
    "time since nothing rose, logarithmic",
    "share of low over 0.16 s, 10 dB",
    "change of the middle's shape from frame to frame, 10 dB",
    "steepest step of low in 0.1 s, 10 dB",
    "steepest step of middle in 0.1 s",
    "part of the last 4 s in which low had risen",
    "part of the last 4 s in which middle had risen",
    "low over its own peak of the seconds before, 10 dB",
    "middle over its own peak of the seconds before",
    "highest periodicity of the last second",
    "likeness of low's bins to those of 48 ms ago",
    "peakedness of the treble over 40 ms",
    "peakedness of the treble over 0.16 s",
];

/// What a feature is, in words.
pub fn name(feature: usize) -> String {
    means::name(&NAMES, feature)
}

/// One frame's features: what is measured in the order of [`NAMES`], then its means, the shorter one first.
pub type Features = [f64; COUNT];

/// Index of the periodicity over 80 ms.
pub const PERIODICITY: usize = 15;
/// Index of the falls of low and middle.
pub const FALL: [usize; 2] = [22, 23];

/// Bins whose flatness shows a tone, 406–1625 Hz.
const TONES: (usize, usize) = (EDGES[3], EDGES[5]);
/// Bins that may carry harmonics of a voice, 94–1000 Hz.
const HARMONICS: (usize, usize) = (6, 64);
/// Lags of 400 Hz and 80 Hz, internal samples.
const PITCH_LAGS: (usize, usize) = (20, 100);
/// Smoothing of the powers, s: longer would make a pop look like a breath.
const SMOOTHING_S: f64 = 0.008;
/// Below the room by more than this, it is the room that has become quieter, dB.
const SUNK_DB: f64 = -6.0;
/// Unrest of a steady noise, dB: what its frames scatter by.
const CALM_DB: f64 = 2.0;
/// Part of the predicted own sound that may remain after it is taken away.
pub(super) const RESIDUE: f64 = 0.03;
/// The room, and what rises above it.
#[derive(Clone, Debug)]
pub(super) struct Listener {
    /// What it never takes the room to be quieter than, power: below the middle, and there.
    quietest: [f64; 2],
    smooth: Power,
    room: Power,
    /// How much low and middle waver about the room, dB.
    unrest_db: [f64; 2],
    frames: u64,
    /// Frames from which the room was learnt.
    learnt: u64,
    /// Excess, and the same over 80 ms: shows a steady tone that single frames hide.
    excess: Power,
    slow: Power,
    periodicity: f64,
    low_share: f64,
    /// Middle bands of the last frame against each other, dB, and how much they change.
    shape: [f64; 2],
    flux: f64,
    risen_for: f64,
    /// Over 40 ms and over 0.16 s.
    peakedness: [f64; 2],
    past: Past,
    means: Means<MEASURED>,
    cosine: Vec<f64>,
}

/// What stands still, so that a breath is not learnt as what it is told from.
#[derive(Clone, Copy, Debug)]
pub(super) struct Still {
    /// The room, while there may be a breath or the kiosk drowns it.
    pub room: bool,
    /// What came before, while somebody blows.
    pub past: bool,
}

/// Levels that the decision needs beside the features.
#[derive(Clone, Copy, Debug, Default)]
pub struct Levels {
    /// Rise of low over the room, dB.
    pub rise_db: f64,
    /// Rise of the middle over the room, dB.
    pub middle_rise_db: f64,
    /// Low and middle together, without the kiosk's own, dB of full scale.
    pub loud_dbfs: f64,
    /// Excess of low, dB of full scale.
    pub excess_dbfs: f64,
    /// Excess of the middle, dB of full scale.
    pub hiss_dbfs: f64,
    /// The same and some of the room there, so that it is never nothing.
    pub middle_dbfs: f64,
    /// Rise of what lies above 4 kHz, dB, where two capsules listen.
    pub upper_rise_db: f64,
    /// Room's low, dB of full scale.
    pub floor_dbfs: f64,
    /// The kiosk's own sound covers the low band.
    pub covered: bool,
    /// What is heard of 1625–3400 Hz, dB of full scale: it shows what a gain control does.
    pub treble_dbfs: f64,
}

impl Levels {
    /// How far what has risen most has risen, dB.
    pub fn most_db(&self) -> f64 {
        self.rise_db.max(self.middle_rise_db).max(self.upper_rise_db)
    }
}

impl Listener {
    /// A listener that knows no room yet, and takes none to be quieter in a band below the middle than this, power.
    pub fn new(quietest: f64) -> Self {
        Self {
            quietest: [quietest, QUIETEST],
            smooth: [0.0; BINS],
            room: [0.0; BINS],
            unrest_db: [CALM_DB; 2],
            frames: 0,
            learnt: 0,
            excess: [0.0; BINS],
            slow: [0.0; BINS],
            periodicity: 0.0,
            low_share: 0.0,
            shape: [0.0; 2],
            flux: 0.0,
            risen_for: 0.0,
            peakedness: [0.0; 2],
            past: Past::new(),
            means: Means::new(),
            cosine: (0..TRANSFORM).map(|i| cos(2.0 * PI * i as f64 / TRANSFORM as f64)).collect(),
        }
    }

    /// Time it has listened, s.
    pub fn age(&self) -> f64 {
        self.frames as f64 * FRAME_S
    }

    /// Hears one frame and its `peakedness`, of which `own` is explained by the kiosk itself.
    pub fn push(&mut self, power: &Power, own: &Power, peakedness: f64, still: Still) -> (Features, Levels) {
        for (mean, over) in self.peakedness.iter_mut().zip([0.04, 0.16]) {
            *mean += blend(over) * (peakedness - *mean);
        }
        self.frames += 1;
        let quick = if self.frames == 1 { 1.0 } else { blend(SMOOTHING_S) };
        for (s, p) in self.smooth.iter_mut().zip(power) {
            *s += quick * (p - *s);
        }
        // Of a room that is not known yet, whatever it sounds like is learnt.
        if !still.room || self.is_new() {
            self.learn_room();
        }
        for (((e, s), f), own) in self.excess.iter_mut().zip(&self.smooth).zip(&self.room).zip(own) {
            *e = (s - 1.5 * f - own).max(0.0);
        }
        for (slow, e) in self.slow.iter_mut().zip(&self.excess) {
            *slow += blend(0.08) * (e - *slow);
        }
        let (measured, levels) = self.measure(own, still);
        if !still.room {
            for (unrest, rise) in self.unrest_db.iter_mut().zip([levels.rise_db, levels.middle_rise_db]) {
                // A room that has become quieter is another room: its old unrest is forgotten.
                let now = if rise > SUNK_DB { rise.abs() } else { CALM_DB };
                *unrest += blend(2.0) * (now - *unrest).min(6.0);
            }
        }
        let mut features = [0.0; COUNT];
        self.means.push(&measured, &mut features);
        (features, levels)
    }

    /// Has it heard the room for less than a third of a second?
    fn is_new(&self) -> bool {
        self.learnt as f64 * FRAME_S < 0.3
    }

    fn learn_room(&mut self) {
        self.learnt += 1;
        let (mean, new) = (1.0 / self.learnt as f64, self.is_new());
        let known = Weight::known();
        let weight = Weight { down: known.down.max(mean), ..known };
        let quietest = |bin: usize| self.quietest[usize::from(bin >= MIDDLE.0)];
        for (bin, (f, s)) in self.room.iter_mut().zip(&self.smooth).enumerate() {
            // The first third of a second counts in full.
            if new {
                *f += mean * (s - *f);
            } else {
                weight.learn(f, *s, quietest(bin));
            }
        }
    }

    fn measure(&mut self, own: &Power, still: Still) -> ([f64; MEASURED], Levels) {
        // Of what the kiosk itself explains, the prediction's own error remains: a little of it is taken as floor.
        let quietest = |from: usize| self.quietest[usize::from(from >= MIDDLE.0)];
        let floor = |from, to| RESIDUE * band(own, from, to) + band(&self.room, from, to) + quietest(from);
        let cleaned = |from: usize, to: usize| {
            let bins = self.smooth[from..to].iter().zip(&own[from..to]);
            bins.map(|(s, own)| (s - own).max(0.0)).sum::<f64>() + quietest(from)
        };
        let rise = |(from, to)| decibels(cleaned(from, to) / floor(from, to)).clamp(-5.0, 50.0);
        let excess = |(from, to)| band(&self.excess, from, to) + 0.03 * floor(from, to);
        let bands: [(usize, usize); BANDS] = std::array::from_fn(|b| (EDGES[b], EDGES[b + 1]));
        let (rises, parts) = (bands.map(rise), bands.map(excess));
        let (low_rise, middle_rise) = (rise(LOW), rise(MIDDLE));
        let total: f64 = parts.iter().sum();
        let share = decibels((parts[0] + parts[1]) / total);
        let level = [decibels(cleaned(LOW.0, LOW.1)), decibels(cleaned(MIDDLE.0, MIDDLE.1))];
        let levels = Levels {
            rise_db: low_rise,
            middle_rise_db: middle_rise,
            loud_dbfs: decibels(cleaned(LOW.0, LOW.1) + cleaned(MIDDLE.0, MIDDLE.1)),
            excess_dbfs: decibels(band(&self.excess, LOW.0, LOW.1)),
            hiss_dbfs: decibels(band(&self.excess, MIDDLE.0, MIDDLE.1)),
            middle_dbfs: decibels(parts[3] + parts[4] + parts[5]),
            floor_dbfs: decibels(band(&self.room, LOW.0, LOW.1) + quietest(LOW.0)),
            treble_dbfs: decibels(band(&self.smooth, EDGES[5], EDGES[6])),
            ..Levels::default()
        };

        let periodicity = self.periodicity();
        let shape = [decibels(parts[3] / parts[4]), decibels(parts[4] / parts[5])];
        self.follow(periodicity, share, shape, low_rise.max(middle_rise));
        let present =
            Present { level, rises: [low_rise, middle_rise], periodicity: self.periodicity, power: &self.smooth };
        let past = self.past.push(&present, still.past);
        let [low, middle] = past.trends;
        let measured = [
            rises[0],
            rises[1],
            rises[2],
            rises[3],
            rises[4],
            rises[5],
            low_rise - 2.0 * self.unrest_db[0],
            middle_rise - 2.0 * self.unrest_db[1],
            decibels(parts[0] / parts[1]),
            decibels(parts[1] / parts[2]),
            decibels(parts[2] / parts[3]),
            shape[0],
            shape[1],
            share,
            10.0 * periodicity,
            10.0 * self.periodicity,
            flatness(&self.slow[LOW.0..LOW.1]),
            flatness(&self.slow[TONES.0..TONES.1]),
            low.climb,
            low.long_climb,
            middle.climb,
            middle.long_climb,
            low.fall,
            middle.fall,
            low.deviation,
            middle.deviation,
            10.0 * past.together,
            10.0 * ln(1.0 + self.risen_for.min(2.0) / 0.04),
            self.low_share,
            self.flux,
            low.step,
            middle.step,
            10.0 * past.busy[0],
            10.0 * past.busy[1],
            past.over_peaks[0],
            past.over_peaks[1],
            10.0 * past.pitched,
            10.0 * past.likeness,
            10.0 * self.peakedness[0],
            10.0 * self.peakedness[1],
        ]
        .map(|x| 0.1 * x.clamp(-60.0, 60.0));
        (measured, levels)
    }

    /// Lets the means of a frame follow its periodicity, share of low, shape of the middle and highest rise (dB).
    fn follow(&mut self, periodicity: f64, share: f64, shape: [f64; 2], rise: f64) {
        self.periodicity += blend(0.08) * (periodicity - self.periodicity);
        self.low_share += blend(0.16) * (share - self.low_share);
        let change = (shape[0] - self.shape[0]).abs() + (shape[1] - self.shape[1]).abs();
        self.flux += blend(0.08) * (change - self.flux);
        self.shape = shape;
        self.risen_for = if rise > RISEN_DB { self.risen_for + FRAME_S } else { 0.0 };
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

/// Spectral flatness, dB: geometric over arithmetic mean, 0 for white noise.
fn flatness(power: &[f64]) -> f64 {
    let count = power.len() as f64;
    let geometric = exp(power.iter().map(|p| ln(p + NOTHING)).sum::<f64>() / count);
    let mean = power.iter().sum::<f64>() / count + NOTHING;
    10.0 * log10(geometric / mean)
}

//! Feature extraction: forty gain-independent features per frame of 8 ms, and their moving averages over 0.1 and 0.5 s.
//!
//! Each bin has a noise floor, a slow average of the microphone's power that is frozen during a breath. The *excess* is the
//! power above it (spectral subtraction, Boll 1979). Features describe the excess by its shape, by its trend over the last
//! quarter of a second, and by the seconds before: one burst among many is less likely a breath than one in a quiet room.
//!
//! A breath at a capsule is noise below 200 Hz that falls by 12 dB an octave; an off-axis breath is only the hiss above 400 Hz.
//! Breath has no pitch, swells within a tenth of a second and lasts, and its rumble and its hiss vary independently. Knocks jump
//! and decay, voices have harmonics, and wheels and trains raise the noise floor as they approach.
//!
//! Symbols: S_k smoothed power of bin k, F_k noise floor, O_k echo of the kiosk's loudspeaker, E_k = max(S_k − 1.5 F_k − O_k, 0)
//! excess. The bands are 31–94, 94–203, 203–406, 406–812, 812–1625 and 1625–3400 Hz. *Low* is the first two, *middle* the last
//! three.

use super::bands::{BANDS, EPSILON};
pub use super::bands::{EDGES, LOW, MIDDLE, MIN_DIFFERENCE_FLOOR, blend, power_to_db};
pub(super) use super::bands::{MIN_FLOOR, RISEN_DB};
use super::moving_averages::{self, MovingAverages, OUTPUTS_PER_INPUT};
use super::noise_floor::FloorWeights;
use super::spectrum::{BINS, FRAME_S, Power, TRANSFORM, band};
use super::temporal_context::{ContextInput, TemporalContext};
use soffio_math::{PI, cos, exp, ln, log10};

/// Features that are computed from each frame.
pub const MEASURED: usize = 40;
/// Number of features: those of the frame and their moving averages.
pub const COUNT: usize = MEASURED * OUTPUTS_PER_INPUT;

/// Names of the frame's features, in order.
pub const NAMES: [&str; MEASURED] = [
    "rise of 31–94 Hz over the noise floor, 10 dB",
    "rise of 94–203 Hz",
    "rise of 203–406 Hz",
    "rise of 406–812 Hz",
    "rise of 812–1625 Hz",
    "rise of 1625–3400 Hz",
    "rise of low less twice its floor variance, 10 dB",
    "rise of middle less twice its floor variance, 10 dB",
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
    "activity of low in the last 4 s",
    "activity of middle in the last 4 s",
    "ratio of low to its own peak, 10 dB",
    "ratio of middle to its own peak",
    "highest periodicity of the last second",
    "spectral correlation of low with 48 ms ago",
    "kurtosis of the treble over 40 ms",
    "kurtosis of the treble over 0.16 s",
];

/// Name of a feature.
pub fn name(feature: usize) -> String {
    moving_averages::name(&NAMES, feature)
}

/// Features of one frame: those of [`NAMES`], then their averages over 0.1 s, then those over 0.5 s.
pub type Features = [f64; COUNT];

/// Index of the periodicity over 80 ms.
pub const PERIODICITY: usize = 15;
/// Indices of the falls of the low and middle bands.
pub const FALL: [usize; 2] = [22, 23];

/// Bins whose flatness shows a tone, 406–1625 Hz.
const TONES: (usize, usize) = (EDGES[3], EDGES[5]);
/// Bins that may carry harmonics of a voice, 94–1000 Hz.
const HARMONICS: (usize, usize) = (6, 64);
/// Lags of 400 Hz and 80 Hz, internal samples.
const PITCH_LAGS: (usize, usize) = (20, 100);
/// Smoothing of the powers, s: longer would make a pop look like a breath.
const SMOOTHING_S: f64 = 0.008;
/// From this far below the noise floor, the ambient noise itself has become quieter, dB.
const DROP_DB: f64 = -6.0;
/// Floor variance of steady noise, dB: the scatter of single frames.
const STEADY_VARIANCE_DB: f64 = 2.0;
/// Part of the predicted echo that may remain after subtraction.
pub(super) const RESIDUE: f64 = 0.03;

/// Feature extractor of one spectrum.
#[derive(Clone, Debug)]
pub(super) struct FeatureExtractor {
    /// Smallest noise floor of a band, power: below the middle band, and in it.
    min_floor: [f64; 2],
    smooth: Power,
    noise_floor: Power,
    /// Mean absolute deviation of the low and middle bands from the noise floor, dB.
    floor_variance_db: [f64; 2],
    frames: u64,
    /// Frames that have entered the noise floor.
    learnt: u64,
    /// Excess power.
    excess: Power,
    /// Excess over 80 ms: shows a steady tone that single frames hide.
    slow: Power,
    periodicity: f64,
    low_share: f64,
    /// Ratios of neighbouring middle bands in the last frame, dB.
    shape: [f64; 2],
    /// Mean change of these ratios (spectral flux), dB.
    flux: f64,
    /// Time for which a band has been above the noise floor, s.
    risen_for: f64,
    /// Kurtosis over 40 ms and over 0.16 s.
    kurtosis: [f64; 2],
    context: TemporalContext,
    averages: MovingAverages<MEASURED>,
    cosine: Vec<f64>,
}

/// Adaptations that are frozen, so that a breath does not become part of its own reference.
#[derive(Clone, Copy, Debug)]
pub(super) struct Freeze {
    /// Freeze the noise floor, while a breath is likely or the loudspeaker masks it.
    pub noise_floor: bool,
    /// Freeze the temporal context, during a breath.
    pub context: bool,
}

/// Levels that the decision needs beside the features.
#[derive(Clone, Copy, Debug, Default)]
pub struct Levels {
    /// Rise of the low band over the noise floor, dB.
    pub rise_db: f64,
    /// Rise of the middle band over the noise floor, dB.
    pub middle_rise_db: f64,
    /// Level of the low and middle bands without the echo, dB of full scale.
    pub loud_dbfs: f64,
    /// Excess of the low band, dB of full scale.
    pub excess_dbfs: f64,
    /// Excess of the middle band, dB of full scale.
    pub hiss_dbfs: f64,
    /// Excess of the middle band plus 3 % of its noise floor, dB of full scale: finite in silence.
    pub middle_dbfs: f64,
    /// Rise of the high band (4.4–7 kHz) over its noise floor, dB; 0 with one capsule.
    pub high_band_rise_db: f64,
    /// Noise floor of the low band, dB of full scale.
    pub floor_dbfs: f64,
    /// The loudspeaker's echo masks the low band.
    pub masked: bool,
    /// Level of 1625–3400 Hz, dB of full scale; shows the action of a gain control.
    pub agc_band_dbfs: f64,
}

impl Levels {
    /// Largest rise of any band, dB.
    pub fn max_rise_db(&self) -> f64 {
        self.rise_db.max(self.middle_rise_db).max(self.high_band_rise_db)
    }
}

impl FeatureExtractor {
    /// An extractor without a noise floor yet; `min_floor` is the smallest one of a band below the middle, power.
    pub fn new(min_floor: f64) -> Self {
        Self {
            min_floor: [min_floor, MIN_FLOOR],
            smooth: [0.0; BINS],
            noise_floor: [0.0; BINS],
            floor_variance_db: [STEADY_VARIANCE_DB; 2],
            frames: 0,
            learnt: 0,
            excess: [0.0; BINS],
            slow: [0.0; BINS],
            periodicity: 0.0,
            low_share: 0.0,
            shape: [0.0; 2],
            flux: 0.0,
            risen_for: 0.0,
            kurtosis: [0.0; 2],
            context: TemporalContext::new(),
            averages: MovingAverages::new(),
            cosine: (0..TRANSFORM).map(|i| cos(2.0 * PI * i as f64 / TRANSFORM as f64)).collect(),
        }
    }

    /// Time since the first frame, s.
    pub fn age(&self) -> f64 {
        self.frames as f64 * FRAME_S
    }

    /// Takes one frame: its power, the echo in it and its kurtosis.
    pub fn push(&mut self, power: &Power, echo: &Power, kurtosis: f64, freeze: Freeze) -> (Features, Levels) {
        for (mean, over) in self.kurtosis.iter_mut().zip([0.04, 0.16]) {
            *mean += blend(over) * (kurtosis - *mean);
        }
        self.frames += 1;
        let quick = if self.frames == 1 { 1.0 } else { blend(SMOOTHING_S) };
        for (s, p) in self.smooth.iter_mut().zip(power) {
            *s += quick * (p - *s);
        }
        // At first the noise floor learns any sound.
        if !freeze.noise_floor || self.is_new() {
            self.update_noise_floor();
        }
        for (((e, s), f), echo) in self.excess.iter_mut().zip(&self.smooth).zip(&self.noise_floor).zip(echo) {
            *e = (s - 1.5 * f - echo).max(0.0);
        }
        for (slow, e) in self.slow.iter_mut().zip(&self.excess) {
            *slow += blend(0.08) * (e - *slow);
        }
        let (measured, levels) = self.measure(echo, freeze);
        if !freeze.noise_floor {
            for (variance, rise) in self.floor_variance_db.iter_mut().zip([levels.rise_db, levels.middle_rise_db]) {
                // A quieter ambient noise is another one: its old variance is discarded.
                let now = if rise > DROP_DB { rise.abs() } else { STEADY_VARIANCE_DB };
                *variance += blend(2.0) * (now - *variance).min(6.0);
            }
        }
        let mut features = [0.0; COUNT];
        self.averages.push(&measured, &mut features);
        (features, levels)
    }

    /// True until the noise floor has learnt from 0.3 s.
    fn is_new(&self) -> bool {
        self.learnt as f64 * FRAME_S < 0.3
    }

    fn update_noise_floor(&mut self) {
        self.learnt += 1;
        let (mean, new) = (1.0 / self.learnt as f64, self.is_new());
        let known = FloorWeights::steady();
        let weight = FloorWeights { down: known.down.max(mean), ..known };
        let min_floor = |bin: usize| self.min_floor[usize::from(bin >= MIDDLE.0)];
        for (bin, (f, s)) in self.noise_floor.iter_mut().zip(&self.smooth).enumerate() {
            // The first 0.3 s form a plain mean.
            if new {
                *f += mean * (s - *f);
            } else {
                weight.update(f, *s, min_floor(bin));
            }
        }
    }

    fn measure(&mut self, echo: &Power, freeze: Freeze) -> ([f64; MEASURED], Levels) {
        // The prediction of the echo has an error: a little of it counts as floor.
        let min_floor = |from: usize| self.min_floor[usize::from(from >= MIDDLE.0)];
        let floor = |from, to| RESIDUE * band(echo, from, to) + band(&self.noise_floor, from, to) + min_floor(from);
        let cleaned = |from: usize, to: usize| {
            let bins = self.smooth[from..to].iter().zip(&echo[from..to]);
            bins.map(|(s, echo)| (s - echo).max(0.0)).sum::<f64>() + min_floor(from)
        };
        let rise = |(from, to)| power_to_db(cleaned(from, to) / floor(from, to)).clamp(-5.0, 50.0);
        let excess = |(from, to)| band(&self.excess, from, to) + 0.03 * floor(from, to);
        let bands: [(usize, usize); BANDS] = std::array::from_fn(|b| (EDGES[b], EDGES[b + 1]));
        let (rises, parts) = (bands.map(rise), bands.map(excess));
        let (low_rise, middle_rise) = (rise(LOW), rise(MIDDLE));
        let total: f64 = parts.iter().sum();
        let share = power_to_db((parts[0] + parts[1]) / total);
        let level = [power_to_db(cleaned(LOW.0, LOW.1)), power_to_db(cleaned(MIDDLE.0, MIDDLE.1))];
        let levels = Levels {
            rise_db: low_rise,
            middle_rise_db: middle_rise,
            loud_dbfs: power_to_db(cleaned(LOW.0, LOW.1) + cleaned(MIDDLE.0, MIDDLE.1)),
            excess_dbfs: power_to_db(band(&self.excess, LOW.0, LOW.1)),
            hiss_dbfs: power_to_db(band(&self.excess, MIDDLE.0, MIDDLE.1)),
            middle_dbfs: power_to_db(parts[3] + parts[4] + parts[5]),
            floor_dbfs: power_to_db(band(&self.noise_floor, LOW.0, LOW.1) + min_floor(LOW.0)),
            agc_band_dbfs: power_to_db(band(&self.smooth, EDGES[5], EDGES[6])),
            ..Levels::default()
        };

        let periodicity = self.periodicity();
        let shape = [power_to_db(parts[3] / parts[4]), power_to_db(parts[4] / parts[5])];
        self.update_averages(periodicity, share, shape, low_rise.max(middle_rise));
        let present =
            ContextInput { level, rises: [low_rise, middle_rise], periodicity: self.periodicity, power: &self.smooth };
        let context = self.context.push(&present, freeze.context);
        let [low, middle] = context.trends;
        let measured = [
            rises[0],
            rises[1],
            rises[2],
            rises[3],
            rises[4],
            rises[5],
            low_rise - 2.0 * self.floor_variance_db[0],
            middle_rise - 2.0 * self.floor_variance_db[1],
            power_to_db(parts[0] / parts[1]),
            power_to_db(parts[1] / parts[2]),
            power_to_db(parts[2] / parts[3]),
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
            10.0 * context.band_correlation,
            10.0 * ln(1.0 + self.risen_for.min(2.0) / 0.04),
            self.low_share,
            self.flux,
            low.step,
            middle.step,
            10.0 * context.activity[0],
            10.0 * context.activity[1],
            context.peak_ratios[0],
            context.peak_ratios[1],
            10.0 * context.peak_periodicity,
            10.0 * context.spectral_correlation,
            10.0 * self.kurtosis[0],
            10.0 * self.kurtosis[1],
        ]
        .map(|x| 0.1 * x.clamp(-60.0, 60.0));
        (measured, levels)
    }

    /// Updates the averages of periodicity, share of the low band and spectral flux, and the time since the last rise (dB).
    fn update_averages(&mut self, periodicity: f64, share: f64, shape: [f64; 2], rise: f64) {
        self.periodicity += blend(0.08) * (periodicity - self.periodicity);
        self.low_share += blend(0.16) * (share - self.low_share);
        let change = (shape[0] - self.shape[0]).abs() + (shape[1] - self.shape[1]).abs();
        self.flux += blend(0.08) * (change - self.flux);
        self.shape = shape;
        self.risen_for = if rise > RISEN_DB { self.risen_for + FRAME_S } else { 0.0 };
    }

    /// Highest peak of the autocorrelation of the excess of 94–1000 Hz, at the lags of 80–400 Hz, 0 … 1. The square root of the
    /// spectrum whitens it, so that coloured noise does not look like a pitch (Tolonen and Karjalainen 2000).
    /// r(τ) = Σ_k √E_k cos(2π k τ / N) (Wiener–Khinchin).
    fn periodicity(&self) -> f64 {
        let mut amplitude = [0.0; HARMONICS.1];
        let mut total = EPSILON;
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
    let geometric = exp(power.iter().map(|p| ln(p + EPSILON)).sum::<f64>() / count);
    let mean = power.iter().sum::<f64>() / count + EPSILON;
    10.0 * log10(geometric / mean)
}

//! Inputs of the model, a vector per frame of 8 ms, independent of the microphone's gain.
//!
//! Air at a capsule is noise of low frequency: turbulence that is swept past at the local speed U has a flat spectrum below
//! U/(2π L), L being the size of the large eddies, and falls steeply above (`../training/generator`). Where a microphone has a high-pass,
//! only the flank is left. Lips add a hiss above 400 Hz. Between two capsules turbulence is incoherent and sound is not.
//! So for each frame the model sees:
//!
//! | inputs | meaning |
//! |---|---|
//! | shape | level of each band relative to the loudest one |
//! | excess | the same of the power over the noise floor: what is new in this room |
//! | change | level of three regions relative to its recent peak, and to its mean: impacts jump and die away, a breath swells |
//! | periodicity | largest autocorrelation at 80–400 Hz: voices and music |
//! | echo | share of the loudspeaker's echo in the rumble |
//! | rise | rise over the floor of the highest band, and means of the highest three and six |
//! | strangeness | the same of the rise relative to the usual spread of this room |
//! | two capsules | 1, or 0 with one: then all inputs after it are 0 |
//! | incoherent rise | rise of the incoherent power of wide bands |
//! | incoherent strangeness | the same, relative to its spread |
//! | decorrelation | 1 − γ² of wide bands |
//!
//! Rise, strangeness and decorrelation are evidence in one direction: more of them never speaks against a breath ([`is_rising`]).
//!
//! Decibels are compressed, tanh(r/R): 25 dB over the floor say no more than 60, which only a microphone that is silent in between
//! has. Each input is followed by its running means over 0.1, 0.4 and 1.5 s: how a sound has developed.

use super::bands::{BANDS, EDGES, RUMBLE, WIDE, WIDE_EDGES, blend, power_to_db, powers};
use super::coherence::Coherence;
use super::noise_floor::{Floor, Spreads};
use super::spectrum::{FRAME_S, Framer, Power, TRANSFORM};
use soffio_math::{PI, cos, db_to_amplitude, tanh};

/// Values of one frame.
const NOW: usize = STEREO + 1 + 3 * WIDE;
/// Number of inputs: the values of the frame and their means.
pub const COUNT: usize = NOW * (1 + AVERAGES_S.len());
/// Inputs of the model for one frame.
pub type Inputs = [f32; COUNT];

/// Time constants of the running means, s: an attack, a puff, a breath.
const AVERAGES_S: [f64; 3] = [0.1, 0.4, 1.5];
/// Where the groups of values begin.
const EXCESS: usize = BANDS;
const CHANGE: usize = 2 * BANDS;
const PERIODICITY: usize = CHANGE + 2 * REGIONS.len();
const ECHO: usize = PERIODICITY + 1;
const RISE: usize = ECHO + 1;
const STRANGENESS: usize = RISE + TOP.len();
const STEREO: usize = STRANGENESS + TOP.len();
/// Bands of the regions whose change is followed: 16–219, 219–875 and 875–3406 Hz.
const REGIONS: [std::ops::Range<usize>; 3] = [0..5, 5..9, 9..13];
/// Fall of the recent peak, dB/s.
const PEAK_FALL_DB_S: f64 = 20.0;
/// Time constant of the mean beside the recent peak, s.
const CHANGE_S: f64 = 0.1;
/// R of the compression of a change, dB.
const CHANGE_DB: f64 = 15.0;
/// Numbers of highest bands whose rises are averaged.
const TOP: [usize; 3] = [1, 3, 6];
/// Power of the noise floor that is subtracted, over its mean: noise scatters by this much.
const FLOOR_MARGIN: f64 = 1.5;
/// Least excess relative to the band's power.
const LEAST_EXCESS: f64 = 0.01;

/// Smallest power of a band (−78 dBFS): below it lies a converter's own noise.
const MIN_POWER: f64 = 1.6e-8;
/// Part of the predicted echo that may remain after subtraction, and its part that two capsules do not share.
const RESIDUE: f64 = 0.03;
/// Bins that may carry harmonics of a voice, 94–1000 Hz.
const HARMONICS: std::ops::Range<usize> = 6..64;
/// Lags of 400 Hz and 80 Hz, internal samples.
const PITCH_LAGS: std::ops::Range<usize> = 20..100;
const LAGS: usize = PITCH_LAGS.end - PITCH_LAGS.start;
/// R of the compression of a rise, dB. How far a sound rises says how near and how loud it is, not what it is.
const RISE_DB: f64 = 20.0;
/// R of the compression of the shape, dB.
const SHAPE_DB: f64 = 30.0;
/// R of the compression of strangeness.
const STRANGE: f64 = 8.0;
/// Smallest spread, dB: the scatter of noise in a wide band.
const MIN_SPREAD_DB: f64 = 1.5;

/// Spread of steady noise below 219 Hz about its floor, dB: 3.2 to 3.5 (a test measures it).
const STEADY_SPREAD_DB: f64 = 3.5;

/// Extractor of the inputs, with the floors that they refer to.
#[derive(Clone, Debug)]
pub struct Features {
    /// Floor of the bands.
    pub floor: Floor<BANDS>,
    /// Floor of the incoherent power of the wide bands.
    pub incoherent_floor: Floor<WIDE>,
    /// Levels of the last frame, of bands and of incoherent power, dB of full scale.
    levels: [f64; BANDS],
    incoherent_levels: [f64; WIDE],
    coherence: Coherence,
    /// cos(2π k τ / N) for each bin k of the harmonics, and each lag τ.
    cosines: Vec<[f32; LAGS]>,
    /// Recent peak and mean of the level of each region, dB of full scale; `None` before the first frame.
    change: [Option<(f64, f64)>; REGIONS.len()],
    /// The values of the last frame and their means, one after the other; `None` before the first frame.
    inputs: Option<Inputs>,
}

/// What a detector learns of a room over minutes: how far its own sounds and draughts usually rise over the noise floor. No sound can be
/// restored from it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AmbientSpread {
    /// Of the bands.
    pub bands: Spreads<BANDS>,
    /// Of the incoherent power of two capsules in the wide bands.
    pub incoherent: Spreads<WIDE>,
}

impl AmbientSpread {
    /// How much farther than steady noise the gustiest band below 219 Hz rises, dB: a breath must rise so much more to be as unusual.
    /// Draughts and doors cost that.
    pub fn gusts_db(&self) -> f64 {
        let most = self.bands.db[RUMBLE].iter().copied().fold(0.0, f64::max);
        (most - STEADY_SPREAD_DB).max(0.0)
    }
}

/// Measurements of one frame.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    /// Inputs of the model.
    pub inputs: Inputs,
    /// Levels of the bands without the echo, dB of full scale.
    pub levels: [f64; BANDS],
    /// Largest rise of a band, dB.
    pub rise_db: f64,
    /// Share of the echo in the rumble, 0 … 1.
    pub echo: f64,
    /// Periodicity, 0 … 1.
    pub periodicity: f32,
}

impl Features {
    /// An extractor that knows no floor yet.
    pub(crate) fn new() -> Self {
        Self {
            floor: Floor::new(),
            incoherent_floor: Floor::new(),
            levels: [0.0; BANDS],
            incoherent_levels: [0.0; WIDE],
            coherence: Coherence::new(),
            cosines: HARMONICS
                .map(|k| {
                    let turn = |lag: usize| 2.0 * PI * (k * (PITCH_LAGS.start + lag)) as f64 / TRANSFORM as f64;
                    std::array::from_fn(|lag| cos(turn(lag)) as f32)
                })
                .collect(),
            change: [None; REGIONS.len()],
            inputs: None,
        }
    }

    /// Measures a frame; `echo_spectrum` is the predicted power of the loudspeaker's echo, and `stereo` says that there are two capsules.
    pub fn push(&mut self, framer: &Framer, echo_spectrum: &Power, stereo: bool) -> Frame {
        let [power, echo_power]: [[f64; BANDS]; 2] = [&framer.microphone, echo_spectrum].map(|p| powers(p, &EDGES));
        let levels: [f64; BANDS] = std::array::from_fn(|b| {
            // A prediction is no sound: there is no more echo than power.
            let echo = echo_power[b].min(power[b]);
            power_to_db((power[b] - echo).max(RESIDUE * echo) + MIN_POWER)
        });
        self.floor.learn(&levels);
        self.levels = levels;
        let mut now = [0.0; NOW];
        let rises: [f64; BANDS] = std::array::from_fn(|b| self.floor.rise(b, levels[b]));
        let strangeness = std::array::from_fn(|b| rises[b] / self.floor.spread(b).max(MIN_SPREAD_DB));
        let excess = std::array::from_fn(|b| {
            // Power relative to the floor, then back to the level of the band.
            let over = db_to_amplitude(2.0 * rises[b]);
            self.floor.level[b] + power_to_db((over - FLOOR_MARGIN).max(LEAST_EXCESS * over))
        });
        now[..EXCESS].copy_from_slice(&shape(&levels));
        now[EXCESS..CHANGE].copy_from_slice(&shape(&excess));
        for (i, (change, bands)) in self.change.iter_mut().zip(REGIONS).enumerate() {
            let level = power_to_db(levels[bands].iter().map(|db| db_to_amplitude(2.0 * db)).sum());
            let (peak, mean) = change.unwrap_or((level, level));
            let (peak, mean) = (level.max(peak - PEAK_FALL_DB_S * FRAME_S), mean + blend(CHANGE_S) * (level - mean));
            *change = Some((peak, mean));
            now[CHANGE + 2 * i] = compressed(level - peak, CHANGE_DB);
            now[CHANGE + 2 * i + 1] = compressed(level - mean, CHANGE_DB);
        }
        let sum = |of: &[f64; BANDS]| of[RUMBLE].iter().sum::<f64>();
        let echo = (sum(&echo_power) / (sum(&power) + MIN_POWER)).min(1.0);
        let periodicity = self.periodicity(&framer.microphone);
        (now[PERIODICITY], now[ECHO]) = (periodicity, echo as f32);
        now[RISE..STRANGENESS].copy_from_slice(&highest(rises).map(|mean| compressed(mean, RISE_DB)));
        now[STRANGENESS..STEREO].copy_from_slice(&highest(strangeness).map(|mean| compressed(mean, STRANGE)));
        if stereo {
            now[STEREO] = 1.0;
            self.compare(framer, &powers(echo_spectrum, &WIDE_EDGES), &mut now[STEREO + 1..]);
        }
        let rise_db = rises.into_iter().fold(0.0, f64::max);
        Frame { inputs: self.with_averages(&now), levels, rise_db, echo, periodicity }
    }

    /// The values of a frame, followed by their running means.
    fn with_averages(&mut self, now: &[f32; NOW]) -> Inputs {
        let inputs = self.inputs.get_or_insert_with(|| std::array::from_fn(|i| now[i % NOW]));
        inputs[..NOW].copy_from_slice(now);
        for (averages, seconds) in inputs[NOW..].chunks_mut(NOW).zip(AVERAGES_S) {
            let weight = blend(seconds) as f32;
            averages.iter_mut().zip(now).for_each(|(mean, x)| *mean += weight * (x - *mean));
        }
        *inputs
    }

    /// Levels of the last frame, dB of full scale.
    pub fn levels(&self) -> [f64; BANDS] {
        self.levels
    }

    /// What is learnt of the room.
    pub fn ambient_spread(&self) -> AmbientSpread {
        AmbientSpread { bands: self.floor.spreads(), incoherent: self.incoherent_floor.spreads() }
    }

    /// Begins with what an earlier run has learnt of the room.
    pub fn recall(&mut self, ambient_spread: &AmbientSpread) {
        self.floor.recall(&ambient_spread.bands);
        self.incoherent_floor.recall(&ambient_spread.incoherent);
    }

    /// Takes the last frame as the noise floor.
    pub fn adopt_floors(&mut self) {
        self.floor.adopt(&self.levels);
        self.incoherent_floor.adopt(&self.incoherent_levels);
    }

    /// Inputs of two capsules.
    fn compare(&mut self, framer: &Framer, echo: &[f64; WIDE], inputs: &mut [f32]) {
        let parts = self.coherence.push(&framer.channels, framer.scale);
        let levels: [f64; WIDE] =
            std::array::from_fn(|b| power_to_db((parts[b].0 - RESIDUE * echo[b]).max(0.0) + MIN_POWER));
        self.incoherent_floor.learn(&levels);
        self.incoherent_levels = levels;
        for b in 0..WIDE {
            let rise = self.incoherent_floor.rise(b, levels[b]);
            inputs[b] = compressed(rise, RISE_DB);
            inputs[WIDE + b] = compressed(rise / self.incoherent_floor.spread(b).max(MIN_SPREAD_DB), STRANGE);
            inputs[2 * WIDE + b] = parts[b].1 as f32;
        }
    }

    /// Highest peak of the autocorrelation of 94–1000 Hz at the lags of 80–400 Hz, 0 … 1. The square root of the spectrum whitens
    /// it, so that coloured noise does not look like a pitch (Tolonen and Karjalainen, IEEE Trans. Speech Audio Process. 8, 2000).
    /// r(τ) = Σ_k √P_k cos(2π k τ / N) (Wiener–Khinchin).
    fn periodicity(&self, power: &Power) -> f32 {
        let mut total = MIN_POWER as f32;
        let mut correlation = [0.0; LAGS];
        for (cosines, p) in self.cosines.iter().zip(&power[HARMONICS]) {
            let amplitude = p.sqrt() as f32;
            total += amplitude;
            correlation.iter_mut().zip(cosines).for_each(|(sum, cosine)| *sum += amplitude * cosine);
        }
        let peak = correlation.into_iter().fold(0.0, f32::max);
        (peak / total).clamp(0.0, 1.0)
    }
}

/// Levels relative to the loudest band, compressed.
fn shape(levels: &[f64; BANDS]) -> [f32; BANDS] {
    let loudest = levels.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    levels.map(|level| compressed(level - loudest, SHAPE_DB))
}

/// Means of the highest values of bands, for each number of them in [`TOP`].
fn highest(mut values: [f64; BANDS]) -> [f64; TOP.len()] {
    values.sort_by(|a, b| b.total_cmp(a));
    TOP.map(|count| values[..count].iter().sum::<f64>() / count as f64)
}

/// True for an input of which more never speaks against a breath.
pub fn is_rising(input: usize) -> bool {
    let value = input % NOW;
    (RISE..STEREO).contains(&value) || value > STEREO
}

/// tanh(x/R): −1 … 1.
fn compressed(x: f64, range: f64) -> f32 {
    tanh(x / range) as f32
}

//! High-band features: breath noise at 4.4 to 7 kHz, above most of a crowd's sound, with a dual microphone.
//!
//! An off-axis breath reaches the microphone only as broadband noise, which a crowd masks below 3.4 kHz. Vowels have their
//! formants below 4 kHz and fall by 12 dB an octave above (Fant 1960). Walls and air absorb the rest, while a jet from lips
//! extends to 6 kHz and beyond. A rehearsed day had 64 such breaths. At a threshold that 0.1 % of all other frames reached, the
//! rise of 5 to 7 kHz detected 54 of them within 0.22 s, and the rise of 0.4 to 3.4 kHz detected 18.
//!
//! Other sounds in the high band differ from breath: an s lasts for a tenth of a second and recurs, a chime fills few bins, and a
//! crowd's noise is diffuse (`coherence.rs`). The features are therefore:
//!
//! - the rise of each region over its noise floor, and of the quietest third of all bins, which no tone lifts;
//! - trends and temporal context, as below 4 kHz (`temporal_context.rs`);
//! - decorrelation and coherent rise of both capsules;
//! - the level of the hiss below 3.4 kHz relative to it.
//!
//! Symbols as in `features.rs`: S_k smoothed power of bin k, F_k noise floor, O_k echo. Bin k lies at 8 kHz − k · 15.6 Hz
//! (`resample.rs`).

use super::coherence::{BAND_WIDTH, Coherence};
use super::features::{Freeze, MIN_FLOOR, RESIDUE, RISEN_DB, blend, power_to_db};
use super::moving_averages::{self, MovingAverages, OUTPUTS_PER_INPUT};
use super::noise_floor::FloorWeights;
use super::resample::HIGH_BAND_GAIN_DB;
use super::spectrum::{BINS, FRAME_S, Framer, Power, band};
use super::temporal_context::{ACTIVITY_S, MEMORY, NO_LEVEL_DB, PEAK_DECAY_DB_S, Trend};

/// Number of regions: 7 to 5.6 kHz and 5.6 to 4.4 kHz.
const REGIONS: usize = 2;
/// First bin, and the ends of the regions in bands of [`BAND_WIDTH`].
const COHERENCE_REGIONS: (usize, [usize; REGIONS]) = (64, [8, 15]);
/// Edges of the regions, bins.
const EDGES: [usize; REGIONS + 1] = [
    COHERENCE_REGIONS.0,
    COHERENCE_REGIONS.0 + COHERENCE_REGIONS.1[0] * BAND_WIDTH,
    COHERENCE_REGIONS.0 + COHERENCE_REGIONS.1[1] * BAND_WIDTH,
];
/// Bins of the whole high band.
const ALL: std::ops::Range<usize> = EDGES[0]..EDGES[REGIONS];
/// Smoothing of the powers, s: a single bin of a single frame scatters by 5 dB.
const SMOOTHING_S: f64 = 0.02;
/// Time constant of the floor variance, s.
const FLOOR_VARIANCE_S: f64 = 2.0;
/// Rank of the loudest bin of the quietest third, by rise.
const THIRD: usize = (EDGES[REGIONS] - EDGES[0]) / 3;
/// Ratio of a jet's hiss at 0.4 to 3.4 kHz to that at 4.4 to 7 kHz, dB ([`crate::generate`]).
const HISS_DB: f64 = 9.2;

/// Features that are computed from each frame.
const MEASURED: usize = 16;
/// Number of inputs: the frame's features and their moving averages.
pub const COUNT: usize = MEASURED * OUTPUTS_PER_INPUT;

/// Names of the frame's features, in order.
const NAMES: [&str; MEASURED] = [
    "rise of 5.6–7 kHz over the noise floor, 10 dB",
    "rise of 4.4–5.6 kHz",
    "rise of the quietest third of 4.4–7 kHz",
    "rise of all of it less twice its floor variance",
    "climb in 48 ms, 10 dB",
    "climb in 0.2 s",
    "fall from its peak in 0.24 s, 10 dB",
    "deviation in 0.16 s, 10 dB",
    "steepest step in 0.1 s, 10 dB",
    "activity in the last 4 s",
    "ratio to its own peak, 10 dB",
    "decorrelation of 5.6–7 kHz, 10 dB",
    "decorrelation of 4.4–5.6 kHz",
    "coherent rise of 5.6–7 kHz, 10 dB",
    "coherent rise of 4.4–5.6 kHz",
    "excess of 0.4–3.4 kHz over it, 10 dB",
];

/// Name of an input.
pub fn name(input: usize) -> String {
    moving_averages::name(&NAMES, input)
}

/// Feature extractor of the high band.
#[derive(Clone, Debug)]
pub struct HighBand {
    smooth: Power,
    noise_floor: Power,
    floor_variance_db: f64,
    frames: u64,
    learnt: u64,
    /// Levels of the last frames, dB; a ring.
    levels: [f64; MEMORY],
    /// Share of the last seconds in which the band was above its noise floor, 0 … 1.
    activity: f64,
    /// Decaying peak level, dB.
    peak: f64,
    coherence: Coherence<REGIONS>,
    averages: MovingAverages<MEASURED>,
    /// Features of the last frame and their moving averages.
    pub inputs: [f64; COUNT],
    /// Rise over the noise floor, dB.
    pub rise_db: f64,
    /// Equivalent hiss at 0.4 to 3.4 kHz of a jet with this excess, dB of full scale.
    pub hiss_dbfs: f64,
}

impl HighBand {
    /// An extractor without a noise floor yet.
    pub fn new() -> Self {
        Self {
            smooth: [0.0; BINS],
            noise_floor: [0.0; BINS],
            floor_variance_db: 0.0,
            frames: 0,
            learnt: 0,
            levels: [NO_LEVEL_DB; MEMORY],
            activity: 0.0,
            peak: NO_LEVEL_DB,
            coherence: Coherence::new(COHERENCE_REGIONS),
            averages: MovingAverages::new(),
            inputs: [0.0; COUNT],
            rise_db: 0.0,
            hiss_dbfs: NO_LEVEL_DB,
        }
    }

    /// Takes one frame and the echo in it; `middle_dbfs` is the level of the middle band (0.4 to 3.4 kHz), dB of full scale.
    pub fn push(&mut self, framer: &Framer, echo: &Power, freeze: Freeze, middle_dbfs: f64) {
        self.frames += 1;
        let quick = if self.frames == 1 { 1.0 } else { blend(SMOOTHING_S) };
        self.smooth.iter_mut().zip(&framer.microphone).for_each(|(s, p)| *s += quick * (p - *s));
        if !freeze.noise_floor {
            self.update_noise_floor();
        }
        self.coherence.push(&framer.channels, echo, !freeze.noise_floor, framer.scale);
        let measured = self.measure(echo, freeze, middle_dbfs).map(|x| 0.1 * x.clamp(-60.0, 60.0));
        self.averages.push(&measured, &mut self.inputs);
    }

    fn update_noise_floor(&mut self) {
        self.learnt += 1;
        let weight = FloorWeights::nth(self.learnt);
        self.noise_floor.iter_mut().zip(&self.smooth).for_each(|(f, s)| weight.update(f, *s, MIN_FLOOR));
    }

    fn measure(&mut self, echo: &Power, freeze: Freeze, middle_dbfs: f64) -> [f64; MEASURED] {
        let (smooth, noise_floor) = (&self.smooth, &self.noise_floor);
        let cleaned =
            |from: usize, to: usize| (from..to).map(|k| (smooth[k] - echo[k]).max(0.0)).sum::<f64>() + MIN_FLOOR;
        let floor = |from, to| band(noise_floor, from, to) + RESIDUE * band(echo, from, to) + MIN_FLOOR;
        let rise = |from, to| power_to_db(cleaned(from, to) / floor(from, to)).clamp(-5.0, 50.0);
        let [high, low] = [rise(EDGES[0], EDGES[1]), rise(EDGES[1], EDGES[2])];
        self.rise_db = rise(ALL.start, ALL.end);
        let nothing = MIN_FLOOR / ALL.len() as f64;
        let mut rises: [f64; ALL.end - ALL.start] = std::array::from_fn(|i| {
            let k = ALL.start + i;
            ((smooth[k] - echo[k]).max(0.0) + nothing) / (noise_floor[k] + RESIDUE * echo[k] + nothing)
        });
        let (_, third, _) = rises.select_nth_unstable_by(THIRD, f64::total_cmp);
        let third = power_to_db(*third).clamp(-10.0, 50.0);
        let floor = floor(ALL.start, ALL.end);
        let excess = (cleaned(ALL.start, ALL.end) - floor).max(0.0);
        let hiss = |power: f64| power_to_db(power) - HIGH_BAND_GAIN_DB + HISS_DB;
        self.hiss_dbfs = hiss(excess);

        let level = power_to_db(cleaned(ALL.start, ALL.end));
        let at = (self.frames % MEMORY as u64) as usize;
        if self.frames == 1 {
            self.levels = [level; MEMORY];
        }
        self.levels[at] = level;
        if !freeze.context {
            let risen = if self.rise_db > RISEN_DB { 1.0 } else { 0.0 };
            self.activity += blend(ACTIVITY_S) * (risen - self.activity);
            // The oldest level of the ring: a sound is not compared with its own onset.
            self.peak = self.levels[(at + 1) % MEMORY].max(self.peak - PEAK_DECAY_DB_S * FRAME_S);
        }
        let trend = Trend::of(&self.levels, at);
        let rise_over_variance = self.rise_db - 2.0 * self.floor_variance_db;
        if !freeze.noise_floor {
            self.floor_variance_db += blend(FLOOR_VARIANCE_S) * (self.rise_db.abs() - self.floor_variance_db).min(6.0);
        }
        let Coherence { decorrelation, rise_db, .. } = &self.coherence;
        [
            high,
            low,
            third,
            rise_over_variance,
            trend.climb,
            trend.long_climb,
            trend.fall,
            trend.deviation,
            trend.step,
            10.0 * self.activity,
            level - self.peak,
            power_to_db(decorrelation[0]),
            power_to_db(decorrelation[1]),
            rise_db[0],
            rise_db[1],
            middle_dbfs - hiss(excess + 0.03 * floor),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::super::frontend::{BreathState, Frontend};
    use super::*;
    use crate::generate::filter::{high_passed, low_passed, normalised, white};
    use soffio_math::noise::Random;
    use soffio_math::{PI, db_to_amplitude, sin};

    const RATE: u32 = 16_000;
    const SEED: u64 = 29;

    /// Noise between two corners, Hz, each of as many poles, at a level, dB of full scale.
    fn noise(seconds: u32, (from, to, poles): (f64, f64, usize), dbfs: f64, random: &mut Random) -> Vec<f64> {
        let rate = f64::from(RATE);
        let band =
            high_passed(low_passed(white((seconds * RATE) as usize, random), rate, to, poles), rate, from, poles);
        normalised(band).into_iter().map(|x| db_to_amplitude(dbfs) * x).collect()
    }

    /// Time, s, high band, and rise of the middle band, dB, of each frame. The noise floor is frozen from a time on, s.
    fn frames(signal: [&[f64]; 2], played: &[f64], freeze_s: f64) -> Vec<(f64, HighBand, f64)> {
        let mut frontend = Frontend::new(RATE);
        let mut out = Vec::new();
        for (i, (l, r)) in signal[0].iter().zip(signal[1]).enumerate() {
            let t = i as f64 / f64::from(RATE);
            let breath = BreathState { blowing: t >= freeze_s, likely: t >= freeze_s };
            let played = played.get(i).map_or(0.0, |x| *x as f32);
            if let Some(frame) = frontend.push(*l as f32, Some(*r as f32), played, breath) {
                out.push((t, HighBand::clone(&frontend.high_band), frame.levels.middle_rise_db));
            }
        }
        out
    }

    fn mean(frames: &[(f64, HighBand, f64)], from: f64, of: impl Fn(&(f64, HighBand, f64)) -> f64) -> f64 {
        let late: Vec<f64> = frames.iter().filter(|(t, ..)| *t > from).map(of).collect();
        late.iter().sum::<f64>() / late.len() as f64
    }

    #[test]
    fn hiss_that_a_crowd_masks_below_stands_out_in_the_high_band() {
        const BEGINS_S: f64 = 6.0;
        /// The spectrum differs a little from a jet's, and noise scatters, dB.
        const ABOUT_DB: f64 = 5.0;
        let mut random = Random::new(SEED);
        // A crowd that falls by 36 dB an octave above 1.5 kHz, and hiss 18 dB below it.
        let crowd = noise(8, (300.0, 1500.0, 6), -50.0, &mut random);
        let hiss = noise(8, (400.0, 6000.0, 1), -68.0, &mut random);
        let both = crowd
            .iter()
            .zip(&hiss)
            .enumerate()
            .map(|(i, (crowd, hiss))| crowd + if i as f64 >= BEGINS_S * f64::from(RATE) { *hiss } else { 0.0 });
        let both: Vec<f64> = both.collect();
        let frames = frames([&both, &both], &[], BEGINS_S);
        let middle = mean(&frames, BEGINS_S + 0.5, |(.., middle)| *middle);
        let above = mean(&frames, BEGINS_S + 0.5, |(_, high_band, _)| high_band.rise_db);
        assert!(middle < RISEN_DB && above > 15.0, "{middle:.1} dB below, {above:.1} above");
        // The equivalent jet has all of this hiss at 0.4 to 3.4 kHz, less the small part outside.
        let hiss = mean(&frames, BEGINS_S + 0.5, |(_, high_band, _)| high_band.hiss_dbfs);
        assert!((hiss + 68.0).abs() < ABOUT_DB, "{hiss:.1} dB of full scale");
    }

    #[test]
    fn a_chime_raises_the_band_but_not_its_quietest_third() {
        let mut random = Random::new(SEED);
        let air = noise(8, (100.0, 7000.0, 1), -70.0, &mut random);
        let chime = |t: f64| [4810.0, 5390.0, 6130.0].iter().map(|hz| 0.01 * sin(2.0 * PI * hz * t)).sum::<f64>();
        let rung: Vec<f64> = air
            .iter()
            .enumerate()
            .map(|(i, air)| (air, i as f64 / f64::from(RATE)))
            .map(|(air, t)| air + if t >= 6.0 { chime(t) } else { 0.0 })
            .collect();
        let frames = frames([&rung, &rung], &[], 6.0);
        let [all, third] = [0, 2].map(|i| mean(&frames, 6.5, |(_, high_band, _)| 10.0 * high_band.inputs[i]));
        assert!(all > 15.0 && third < 3.0, "{all:.1} dB in all, {third:.1} of the quietest third");
    }

    #[test]
    fn the_loudspeakers_own_high_band_is_explained() {
        let mut random = Random::new(SEED);
        let burst = |i: usize| if (i / 4000).is_multiple_of(3) { 1.0 } else { 0.0 };
        let played: Vec<f64> = noise(16, (3000.0, 7000.0, 1), -30.0, &mut random)
            .into_iter()
            .enumerate()
            .map(|(i, x)| burst(i) * x)
            .collect();
        let air = noise(16, (100.0, 7000.0, 1), -75.0, &mut random);
        // It comes back 50 ms later and 12 dB softer.
        let back = |i: usize| i.checked_sub(800).map_or(0.0, |i| 0.25 * played[i]);
        let signal: Vec<f64> = air.iter().enumerate().map(|(i, air)| air + back(i)).collect();
        let peak = |reference: &[f64]| {
            let frames = frames([&signal, &signal], reference, f64::INFINITY);
            mean(&frames, 8.0, |(_, high_band, _)| if high_band.rise_db > RISEN_DB { 1.0 } else { 0.0 })
        };
        let (unknown, known) = (peak(&[]), peak(&played));
        assert!(unknown > 0.15 && known < 0.02, "it rises {unknown:.2} of the time, and {known:.2} where it is known");
    }

    #[test]
    fn a_microphone_below_sixteen_kilohertz_has_no_high_band() {
        let mut frontend = Frontend::new(11_025);
        let mut random = Random::new(SEED);
        for _ in 0..22_050 {
            let x = 0.1 * random.signed() as f32;
            frontend.push(x, Some(x), 0.0, BreathState { blowing: false, likely: false });
        }
        assert!(frontend.high_band.rise_db == 0.0, "{}", frontend.high_band.rise_db);
    }
}

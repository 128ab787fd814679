//! Above the voices: what two capsules hear of 4.4 to 7 kHz, where a stream still hisses and a crowd is low.
//!
//! Who blows past the microphone is heard by the hiss alone, and below 3.4 kHz that is what a house is full of. Vowels have
//! their formants below 4 kHz and fall by 12 dB an octave above (Fant 1960), walls and air take what is left, and a jet from lips
//! goes on to 6 kHz and beyond. Of 64 breaths that a rehearsed day blew far aside, the rise of 5 to 7 kHz told 54 within
//! 0.22 s at a threshold that a thousandth of all other frames reached; the rise of 0.4 to 3.4 kHz told 18.
//!
//! What is left up there is told apart by what it does: an s lasts for a tenth of a second and comes again, a chime fills few
//! bins, a crowd's hiss comes from everywhere (`nearness.rs`). So it is measured how far each region has risen above its room, and how
//! far the quietest third of all bins has, which no tone lifts; what the last quarter of a second and the seconds before were like,
//! as of the lower half (`past.rs`); how much is one wave; and how loud the hiss below 3.4 kHz is beside it.
//!
//! Symbols as in `features.rs`: S_k smoothed power of bin k, F_k room, O_k the kiosk's own. Bin k lies at 8 kHz − k · 15.6 Hz
//! (`resample.rs`).

use super::features::{QUIETEST, RESIDUE, RISEN_DB, Still, blend, decibels};
use super::means::{self, Means, TOLD};
use super::nearness::{Nearness, WIDTH};
use super::past::{BUSY_S, MEMORY, NONE_DB, SINKING_DB_S, Trend};
use super::resample::UPPER_LIFT_DB;
use super::room::Weight;
use super::spectrum::{BINS, FRAME_S, Framer, Power, band};

/// Regions, from 7 kHz down to 5.6 and to 4.4 kHz.
const REGIONS: usize = 2;
const WAVES: (usize, [usize; REGIONS]) = (64, [8, 15]);
const EDGES: [usize; REGIONS + 1] = [WAVES.0, WAVES.0 + WAVES.1[0] * WIDTH, WAVES.0 + WAVES.1[1] * WIDTH];
const ALL: std::ops::Range<usize> = EDGES[0]..EDGES[REGIONS];
/// Smoothing of the powers, s: of a single bin a frame alone scatters by 5 dB.
const SMOOTHING_S: f64 = 0.02;
/// The room's unrest is learnt in this time, s.
const UNREST_S: f64 = 2.0;
/// Which of the bins is the quietest third's loudest, by its rise.
const THIRD: usize = (EDGES[REGIONS] - EDGES[0]) / 3;
/// A jet's hiss of 0.4 to 3.4 kHz is so much louder than that of 4.4 to 7 kHz, dB ([`crate::generate`]).
const HISS_DB: f64 = 9.2;

/// What is measured in each frame.
const MEASURED: usize = 16;
/// What is measured, and its means.
pub const COUNT: usize = MEASURED * TOLD;

/// Names of what is measured, in order.
const NAMES: [&str; MEASURED] = [
    "rise of 5.6–7 kHz over the room, 10 dB",
    "rise of 4.4–5.6 kHz",
    "rise of the quietest third of 4.4–7 kHz",
    "rise of all of it less twice the room's unrest",
    "climb in 48 ms, 10 dB",
    "climb in 0.2 s",
    "fall from its peak in 0.24 s, 10 dB",
    "deviation in 0.16 s, 10 dB",
    "steepest step in 0.1 s, 10 dB",
    "part of the last 4 s in which it had risen",
    "level over its own peak of the seconds before, 10 dB",
    "what of 5.6–7 kHz is not one wave, 10 dB",
    "what of 4.4–5.6 kHz is not one wave",
    "rise of what is one wave of 5.6–7 kHz, 10 dB",
    "rise of what is one wave of 4.4–5.6 kHz",
    "excess of 0.4–3.4 kHz over it, 10 dB",
];

/// What an input is, in words.
pub fn name(input: usize) -> String {
    means::name(&NAMES, input)
}

/// What is heard above the voices.
#[derive(Clone, Debug)]
pub struct Upper {
    smooth: Power,
    room: Power,
    unrest_db: f64,
    frames: u64,
    learnt: u64,
    /// Levels of the last frames, dB, a ring; share of the last seconds in which it had risen; peak of them, dB.
    levels: [f64; MEMORY],
    busy: f64,
    peak: f64,
    nearness: Nearness<REGIONS>,
    means: Means<MEASURED>,
    /// What is measured of the last frame, then its means.
    pub inputs: [f64; COUNT],
    /// How far it has risen above the room, dB.
    pub rise_db: f64,
    /// Hiss below 3.4 kHz of a jet that would hiss so loudly here, dB of full scale.
    pub hiss_dbfs: f64,
}

impl Upper {
    /// Nothing heard yet.
    pub fn new() -> Self {
        Self {
            smooth: [0.0; BINS],
            room: [0.0; BINS],
            unrest_db: 0.0,
            frames: 0,
            learnt: 0,
            levels: [NONE_DB; MEMORY],
            busy: 0.0,
            peak: NONE_DB,
            nearness: Nearness::new(WAVES),
            means: Means::new(),
            inputs: [0.0; COUNT],
            rise_db: 0.0,
            hiss_dbfs: NONE_DB,
        }
    }

    /// Hears one frame, of which `own` is explained by the kiosk itself, beside hiss of 0.4 to 3.4 kHz of so much (dB of full
    /// scale).
    pub fn push(&mut self, framer: &Framer, own: &Power, still: Still, middle_dbfs: f64) {
        self.frames += 1;
        let quick = if self.frames == 1 { 1.0 } else { blend(SMOOTHING_S) };
        self.smooth.iter_mut().zip(&framer.microphone).for_each(|(s, p)| *s += quick * (p - *s));
        if !still.room {
            self.learn_room();
        }
        self.nearness.push(&framer.capsules, own, !still.room, framer.scale);
        let measured = self.measure(own, still, middle_dbfs).map(|x| 0.1 * x.clamp(-60.0, 60.0));
        self.means.push(&measured, &mut self.inputs);
    }

    fn learn_room(&mut self) {
        self.learnt += 1;
        let weight = Weight::nth(self.learnt);
        self.room.iter_mut().zip(&self.smooth).for_each(|(f, s)| weight.learn(f, *s, QUIETEST));
    }

    fn measure(&mut self, own: &Power, still: Still, middle_dbfs: f64) -> [f64; MEASURED] {
        let (smooth, room) = (&self.smooth, &self.room);
        let cleaned =
            |from: usize, to: usize| (from..to).map(|k| (smooth[k] - own[k]).max(0.0)).sum::<f64>() + QUIETEST;
        let floor = |from, to| band(room, from, to) + RESIDUE * band(own, from, to) + QUIETEST;
        let rise = |from, to| decibels(cleaned(from, to) / floor(from, to)).clamp(-5.0, 50.0);
        let [high, low] = [rise(EDGES[0], EDGES[1]), rise(EDGES[1], EDGES[2])];
        self.rise_db = rise(ALL.start, ALL.end);
        let nothing = QUIETEST / ALL.len() as f64;
        let mut rises: [f64; ALL.end - ALL.start] = std::array::from_fn(|i| {
            let k = ALL.start + i;
            ((smooth[k] - own[k]).max(0.0) + nothing) / (room[k] + RESIDUE * own[k] + nothing)
        });
        let (_, third, _) = rises.select_nth_unstable_by(THIRD, f64::total_cmp);
        let third = decibels(*third).clamp(-10.0, 50.0);
        let floor = floor(ALL.start, ALL.end);
        let excess = (cleaned(ALL.start, ALL.end) - floor).max(0.0);
        let hiss = |power: f64| decibels(power) - UPPER_LIFT_DB + HISS_DB;
        self.hiss_dbfs = hiss(excess);

        let level = decibels(cleaned(ALL.start, ALL.end));
        let at = (self.frames % MEMORY as u64) as usize;
        if self.frames == 1 {
            self.levels = [level; MEMORY];
        }
        self.levels[at] = level;
        if !still.past {
            let risen = if self.rise_db > RISEN_DB { 1.0 } else { 0.0 };
            self.busy += blend(BUSY_S) * (risen - self.busy);
            // The oldest of the ring: a sound does not hide behind its own beginning.
            self.peak = self.levels[(at + 1) % MEMORY].max(self.peak - SINKING_DB_S * FRAME_S);
        }
        let trend = Trend::of(&self.levels, at);
        let unrestful = self.rise_db - 2.0 * self.unrest_db;
        if !still.room {
            self.unrest_db += blend(UNREST_S) * (self.rise_db.abs() - self.unrest_db).min(6.0);
        }
        let Nearness { apart, rise_db, .. } = &self.nearness;
        [
            high,
            low,
            third,
            unrestful,
            trend.climb,
            trend.long_climb,
            trend.fall,
            trend.deviation,
            trend.step,
            10.0 * self.busy,
            level - self.peak,
            decibels(apart[0]),
            decibels(apart[1]),
            rise_db[0],
            rise_db[1],
            middle_dbfs - hiss(excess + 0.03 * floor),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::super::front::FrontEnd;
    use super::*;
    use crate::generate::filter::{high_passed, low_passed, normalised, white};
    use soffio_math::noise::Random;
    use soffio_math::{PI, from_decibels, sin};

    const RATE: u32 = 16_000;
    const SEED: u64 = 29;

    /// Noise between two corners, Hz, each of so many poles, this loud, dB of full scale.
    fn noise(seconds: u32, (from, to, poles): (f64, f64, usize), dbfs: f64, random: &mut Random) -> Vec<f64> {
        let rate = f64::from(RATE);
        let band =
            high_passed(low_passed(white((seconds * RATE) as usize, random), rate, to, poles), rate, from, poles);
        normalised(band).into_iter().map(|x| from_decibels(dbfs) * x).collect()
    }

    /// What is told of each frame: its time, s, what was heard above 4 kHz, and how far the middle has risen, dB. The room stands
    /// still from a time on, s.
    fn told(heard: [&[f64]; 2], played: &[f64], still_s: f64) -> Vec<(f64, Upper, f64)> {
        let mut front = FrontEnd::new(RATE);
        let mut out = Vec::new();
        for (i, (l, r)) in heard[0].iter().zip(heard[1]).enumerate() {
            let t = i as f64 / f64::from(RATE);
            let still = t >= still_s;
            let played = played.get(i).map_or(0.0, |x| *x as f32);
            if let Some(frame) = front.push(*l as f32, Some(*r as f32), played, (still, still)) {
                out.push((t, Upper::clone(&front.upper), frame.levels.middle_rise_db));
            }
        }
        out
    }

    fn mean(told: &[(f64, Upper, f64)], from: f64, of: impl Fn(&(f64, Upper, f64)) -> f64) -> f64 {
        let late: Vec<f64> = told.iter().filter(|(t, ..)| *t > from).map(of).collect();
        late.iter().sum::<f64>() / late.len() as f64
    }

    #[test]
    fn hiss_that_a_house_drowns_below_stands_out_above_the_voices() {
        const BEGINS_S: f64 = 6.0;
        /// Its band is not the jet's to the letter, and noise scatters, dB.
        const ABOUT_DB: f64 = 5.0;
        let mut random = Random::new(SEED);
        // A house whose treble falls by 36 dB an octave, and hiss 18 dB below it.
        let house = noise(8, (300.0, 1500.0, 6), -50.0, &mut random);
        let hiss = noise(8, (400.0, 6000.0, 1), -68.0, &mut random);
        let both = house
            .iter()
            .zip(&hiss)
            .enumerate()
            .map(|(i, (house, hiss))| house + if i as f64 >= BEGINS_S * f64::from(RATE) { *hiss } else { 0.0 });
        let both: Vec<f64> = both.collect();
        let told = told([&both, &both], &[], BEGINS_S);
        let middle = mean(&told, BEGINS_S + 0.5, |(.., middle)| *middle);
        let above = mean(&told, BEGINS_S + 0.5, |(_, upper, _)| upper.rise_db);
        assert!(middle < RISEN_DB && above > 15.0, "{middle:.1} dB below, {above:.1} above");
        // A jet that hisses so loudly up there: its whole hiss of 0.4 to 3.4 kHz, less the little that lies elsewhere.
        let hiss = mean(&told, BEGINS_S + 0.5, |(_, upper, _)| upper.hiss_dbfs);
        assert!((hiss + 68.0).abs() < ABOUT_DB, "{hiss:.1} dB of full scale");
    }

    #[test]
    fn a_chime_rises_and_the_quietest_third_does_not_hear_it() {
        let mut random = Random::new(SEED);
        let air = noise(8, (100.0, 7000.0, 1), -70.0, &mut random);
        let chime = |t: f64| [4810.0, 5390.0, 6130.0].iter().map(|hz| 0.01 * sin(2.0 * PI * hz * t)).sum::<f64>();
        let rung: Vec<f64> = air
            .iter()
            .enumerate()
            .map(|(i, air)| (air, i as f64 / f64::from(RATE)))
            .map(|(air, t)| air + if t >= 6.0 { chime(t) } else { 0.0 })
            .collect();
        let told = told([&rung, &rung], &[], 6.0);
        let [all, third] = [0, 2].map(|i| mean(&told, 6.5, |(_, upper, _)| 10.0 * upper.inputs[i]));
        assert!(all > 15.0 && third < 3.0, "{all:.1} dB in all, {third:.1} of the quietest third");
    }

    #[test]
    fn what_the_kiosk_itself_plays_up_there_is_explained() {
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
        let heard: Vec<f64> = air.iter().enumerate().map(|(i, air)| air + back(i)).collect();
        let peak = |reference: &[f64]| {
            let told = told([&heard, &heard], reference, f64::INFINITY);
            mean(&told, 8.0, |(_, upper, _)| if upper.rise_db > RISEN_DB { 1.0 } else { 0.0 })
        };
        let (unknown, known) = (peak(&[]), peak(&played));
        assert!(unknown > 0.15 && known < 0.02, "it rises {unknown:.2} of the time, and {known:.2} where it is known");
    }

    #[test]
    fn a_microphone_of_less_than_sixteen_kilohertz_hears_nothing_there() {
        let mut front = FrontEnd::new(11_025);
        let mut random = Random::new(SEED);
        for _ in 0..22_050 {
            let x = 0.1 * random.signed() as f32;
            front.push(x, Some(x), 0.0, (false, false));
        }
        assert!(front.upper.rise_db == 0.0, "{}", front.upper.rise_db);
    }
}

//! Breaths in front of a microphone among other sounds, and their signal-to-noise ratio.

use super::{Condition, Dry, Hearing, Lips, R, Scenario};
use crate::rooms::SPACING_M;
use crate::{Breath, Kind, RATE, Take, kiosk_sound};
use soffio_detector::features::MIN_DIFFERENCE_FLOOR;
use soffio_detector::generate::filter::{high_passed, low_passed, power};
use soffio_detector::generate::{self, BreathShape};
use soffio_math::noise::{Random, hash_words};
use soffio_math::{db_to_amplitude, log10, pow};

/// Longest steady part of a breath, s: with attack and release it is shorter than the detector's time-out.
const LONGEST_HOLD_S: f64 = 5.0;
/// Time from the beginning of a scene to the breath, s. Visitors come to rooms that have been loud for long, so the detector's
/// temporal context must be as full in training.
const LEAD_IN_S: (f64, f64) = (0.7, 12.0);
/// Largest signal-to-noise ratio of a faint breath, which cannot be detected, dB.
const FAINT_DB: f64 = 3.0;

/// Power of a band of the sound at one or two capsules.
type Loudness = fn(&[Vec<f64>]) -> f64;

impl Scenario {
    /// A scene with breaths; `mouth` is distance (m), angle (degrees), and whether it is a child's.
    pub(super) fn blow(
        &self,
        condition: Condition,
        index: u64,
        mouth: (f64, f64, bool),
        hearing: Hearing,
        random: &mut Random,
    ) -> Take {
        let angle_deg = mouth.1;
        let first = self.first_breath(condition, index, mouth, hearing, random);
        let (shapes, breaths) = Self::row_of_breaths(&first, random);
        let seconds = shapes.iter().map(BreathShape::duration).sum::<f64>();
        let seed = random.word();
        let lips = Lips::random(angle_deg, random);
        let capsules = 1 + u64::from(hearing.stereo);
        let streams: Vec<Vec<f64>> = (0..capsules)
            .map(|capsule| {
                let air = (0..).zip(&shapes).map(|(i, s)| generate::stream(RATE, hash_words(&[seed, i]), s, capsule));
                lips.filtered(air.collect::<Vec<_>>().concat())
            })
            .collect();
        // Band of the signal-to-noise ratio: hiss for an off-axis breath, the difference of two capsules, otherwise all.
        let (snr, loudness): (_, Loudness) = match condition {
            Condition::Noisy(snr) => (Some(snr), |heard| power(&heard[0])),
            Condition::Aside(snr) => (Some(snr), |heard| hiss(&heard[0])),
            Condition::Between(snr) => (Some(snr), rumble_difference),
            _ => (None, |_| 0.0),
        };
        let noisy = snr.is_some();
        let dry = match condition {
            Condition::Spoken => self.talk_before(breaths[0].onset, seconds, random),
            Condition::Companions => self.companions(seconds, random),
            _ if noisy && random.unit() < 0.5 => self.throng(seconds, random),
            _ if noisy => self.museum_sounds(seconds, random.range(0.5, 2.5), random),
            _ => Dry::silent(streams[0].len()),
        };
        let mut channels = self.heard(&dry, hearing.stereo, random);
        channels.iter_mut().for_each(|c| c.resize(streams[0].len(), 0.0));
        let loudest = match condition {
            _ if noisy => -30.0,
            Condition::Spoken | Condition::Companions => -45.0,
            _ => -58.0,
        };
        let air_dbfs = random.range(if noisy { -70.0 } else { -72.0 }, loudest);
        Self::add_air(&mut channels, air_dbfs, random);
        let during = |heard: &[Vec<f64>], b: &Breath| {
            heard
                .iter()
                .map(|samples| samples[(b.onset * R) as usize..(b.offset * R) as usize].to_vec())
                .collect::<Vec<_>>()
        };
        if let Some(snr) = snr {
            // The first breath sets the level of the noise.
            let [air, noise] = [&streams, &channels].map(|heard| loudness(&during(heard, &breaths[0])));
            let gain = (air / noise.max(1e-12) / db_to_amplitude(2.0 * snr)).sqrt();
            channels.iter_mut().flatten().for_each(|x| *x *= gain);
        }
        let heard = |b: &Breath| above_noise(&during(&streams, b), &during(&channels, b));
        let breaths: Vec<Breath> =
            breaths.iter().map(|b| Breath { snr_db: snr, faint: heard(b) < FAINT_DB, ..*b }).collect();
        for (channel, stream) in channels.iter_mut().zip(&streams) {
            channel.iter_mut().zip(stream).for_each(|(y, x)| *y += x);
        }
        let mut played = Vec::new();
        if let Condition::Answered(room) = condition {
            played = kiosk_sound::answers(seconds, &breaths, random);
            // With headphones, a hearing loop or a loose cable the microphone receives little or no echo.
            let loud = if random.unit() < 0.25 { random.range(-60.0, -8.0) } else { random.range(-8.0, 4.0) };
            self.add_echo(&played, (room, loud), &mut channels, random);
        }
        let take = self.finish(condition, index, channels, Kind::Blow, breaths, hearing, random);
        let played = played.iter().map(|x| *x as f32).chain(std::iter::repeat(0.0)).take(take.left.len());
        let played = if matches!(condition, Condition::Answered(_)) { played.collect() } else { Vec::new() };
        Take { events: dry.events, played, ..take }
    }

    /// First breath of a scene, from a distance (m) and an angle (degrees), of a child or an adult.
    fn first_breath(
        &self,
        condition: Condition,
        index: u64,
        (distance, angle_deg, child): (f64, f64, bool),
        hearing: Hearing,
        random: &mut Random,
    ) -> BreathShape {
        // Soft breaths, which are harder to detect, are as frequent as hard ones.
        let (soft, hard) = if child { (3.6_f64, 10.5) } else { (6.0, 17.0) };
        let mut pair = Random::new(hash_words(&[self.seed, condition.number(), index, 3]));
        let (spacing, azimuth_deg) = (pair.range(SPACING_M.0, SPACING_M.1), pair.range(0.0, 360.0));
        BreathShape {
            lead_in: random.range(LEAD_IN_S.0, LEAD_IN_S.1),
            strength: soft * pow(hard / soft, random.unit()),
            lead_out: random.range(0.8, 1.5),
            distance,
            angle_deg,
            spacing: if hearing.stereo { spacing } else { 0.0 },
            azimuth_deg,
            foam_db: if random.unit() < 0.2 { random.range(4.0, 15.0) } else { 0.0 },
            colour: pow(2.0, random.range(-0.8, 1.4)),
            corner_hz: 5.0,
            ..BreathShape::default()
        }
    }

    /// One breath like `first`, or several of the same visitor: short and long, hard and soft; with their times.
    fn row_of_breaths(first: &BreathShape, random: &mut Random) -> (Vec<BreathShape>, Vec<Breath>) {
        let count = if random.unit() < 0.6 { 1 } else { 2 + (random.unit() * 2.0) as usize };
        let (mut shapes, mut breaths, mut start) = (Vec::new(), Vec::new(), 0.0);
        for i in 0..count {
            let long = random.unit() < 0.2;
            let shape = BreathShape {
                // The visitor breathes in between two breaths.
                lead_in: if i == 0 { first.lead_in } else { random.range(0.4, 1.2) },
                strength: (first.strength * if i == 0 { 1.0 } else { random.range(0.7, 1.3) }).clamp(3.6, 17.0),
                attack: random.range(0.04, 0.22),
                hold: if long { random.range(3.0, LONGEST_HOLD_S) } else { random.range(0.4, 3.0) },
                release: random.range(0.08, 0.45),
                lead_out: if i + 1 == count { first.lead_out } else { 0.1 },
                ..*first
            };
            let (onset, offset) = shape.span();
            let (onset, offset) = (start + onset, start + offset);
            breaths.push(Breath { onset, offset, strength: shape.strength, snr_db: None, faint: false });
            start += shape.duration();
            shapes.push(shape);
        }
        (shapes, breaths)
    }
}

/// Largest signal-to-noise ratio of a breath over its bands, dB: below 200 Hz, above 500 Hz; with two capsules also the rumble of
/// their difference, and the high band.
fn above_noise(breath: &[Vec<f64>], noise: &[Vec<f64>]) -> f64 {
    let ratio = |of: Loudness| of(breath) / of(noise).max(1e-12);
    let most = ratio(|heard| rumble(&heard[0])).max(ratio(|heard| hiss(&heard[0])));
    let difference = rumble_difference(breath) / (rumble_difference(noise) + MIN_DIFFERENCE_FLOOR);
    let treble = if breath.len() == 2 { ratio(|heard| treble(&heard[0])) } else { 0.0 };
    10.0 * log10(most.max(difference).max(treble).max(1e-12))
}

/// Power below 200 Hz.
fn rumble(x: &[f64]) -> f64 {
    power(&low_passed(x.to_vec(), R, 200.0, 2))
}

/// Power below 200 Hz of half the difference of two capsules, which never match exactly ([`super::UNLIKE`]); with one capsule, all of it.
fn rumble_difference(heard: &[Vec<f64>]) -> f64 {
    const LEFT: f64 = 1e-3;
    let [first, second] = heard else { return rumble(&heard[0]) };
    rumble(&first.iter().zip(second).map(|(a, b)| 0.5 * (a - b)).collect::<Vec<_>>()) + LEFT * rumble(first)
}

/// Power from 500 Hz to 3 kHz.
fn hiss(x: &[f64]) -> f64 {
    power(&low_passed(high_passed(x.to_vec(), R, 500.0, 2), R, 3000.0, 2))
}

/// Power of the high band (`detector/high_band.rs`). So near half the sample rate one high-pass is little more than a difference of
/// neighbours; six of them leave 3 kHz 17 dB below 6 kHz.
fn treble(x: &[f64]) -> f64 {
    power(&high_passed(x.to_vec(), R, 4400.0, 6))
}

#[cfg(test)]
mod tests {
    use super::*;
    use soffio_detector::generate::filter::white;

    #[test]
    fn the_difference_removes_common_sound_and_keeps_half_of_the_turbulence() {
        const ROUNDING: f64 = 1e-12;
        const HALF: std::ops::Range<f64> = 0.45..0.55;
        let mut random = Random::new(5);
        let [one, other] = [(); 2].map(|()| white(RATE as usize, &mut random));
        let all = rumble(&one);
        assert!(rumble_difference(&[one.clone(), one.clone()]) < 1.1e-3 * all);
        assert!((rumble_difference(std::slice::from_ref(&one)) - all).abs() < ROUNDING);
        let eddies = rumble_difference(&[one, other]) / all;
        assert!(HALF.contains(&eddies), "{eddies} of their power");
    }

    #[test]
    fn the_high_band_excludes_the_band_of_voices() {
        /// Error from the first samples of the tones.
        const BEGINS_DB: f64 = 0.1;
        let tone =
            |hz: f64| (0..RATE).map(|i| soffio_math::sin(std::f64::consts::TAU * hz * f64::from(i) / R)).collect();
        let [voice, breath]: [Vec<f64>; 2] = [3000.0, 6000.0].map(tone);
        // A first-order high-pass with k = e^(−2π 4.4/16) has the gain k |1 − z| / |1 − k z| at z = e^(iω).
        let pass = |hz: f64| {
            let (k, c) = (
                soffio_math::exp(-std::f64::consts::TAU * 4400.0 / R),
                soffio_math::cos(std::f64::consts::TAU * hz / R),
            );
            (2.0 - 2.0 * c) / (1.0 - 2.0 * k * c + k * k)
        };
        let apart_db = 10.0 * log10(treble(&breath) / treble(&voice));
        let by_formula = 60.0 * log10(pass(6000.0) / pass(3000.0));
        assert!((apart_db - by_formula).abs() < BEGINS_DB && apart_db > 15.0, "{apart_db}, not {by_formula} dB");
        // One capsule does not use the high band.
        let [one, two] = [1, 2].map(|n| above_noise(&vec![breath.clone(); n], &vec![voice.clone(); n]));
        assert!(two > 15.0 && one < two - 10.0, "{one} dB of one, {two} dB of two");
    }

    #[test]
    fn a_breath_that_shows_in_the_difference_alone_is_not_faint() {
        let (scenario, index) = (Scenario::new(11), 3);
        let take = |snr, stereo| scenario.take(Condition::Between(snr), index, Hearing { gain_db: 0.0, stereo });
        let plain = take(20.0, true);
        assert!(plain.right.is_some() && !plain.breaths[0].faint && plain.breaths[0].snr_db == Some(20.0));
        assert!(take(-20.0, true).breaths[0].faint, "drowned in the difference as well");
        // The crowd is as loud as the breath's difference allows.
        let crowd = |snr| {
            power(&take(snr, true).left.iter().take(RATE as usize / 2).map(|x| f64::from(*x)).collect::<Vec<_>>())
        };
        assert!(crowd(0.0) > 10.0 * crowd(20.0), "{} and {}", crowd(0.0), crowd(20.0));
    }

    #[test]
    fn companions_talk_before_and_during_a_breath() {
        let (scenario, hearing) = (Scenario::new(11), Hearing { gain_db: 0.0, stereo: true });
        for index in 0..8 {
            let take = scenario.take(Condition::Companions, index, hearing);
            let talk = |at: f64| {
                let talks = take.events.iter().filter(|event| event.what == "a companion's talk");
                talks.filter(|event| event.at <= at && at <= event.until).count()
            };
            for breath in &take.breaths {
                assert!((2..5).contains(&talk(breath.onset)) && (2..5).contains(&talk(breath.offset)), "{index}");
            }
            assert!(take.events.iter().any(|event| event.what == "a companion's laughter"), "{index}");
        }
    }
}

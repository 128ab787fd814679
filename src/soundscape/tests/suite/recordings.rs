//! Synthetic recordings against those of people at telephones: band levels, envelope, periodicity.

use super::{R, RATE, db};
use soffio_math::noise::Random;
use soffio_soundscape::breath::{Breath, Manner, Person};
use soffio_soundscape::filters::{high_passed, low_passed, power};
use soffio_soundscape::level::band_powers;
use soffio_soundscape::microphone::Microphone;
use soffio_soundscape::statistics::quantile;

/// Limits of the bands of the measured levels, Hz.
const BANDS_HZ: [f64; 8] = [31.0, 94.0, 203.0, 406.0, 812.0, 1625.0, 3400.0, 7000.0];
/// Medians of 17 people who breathed at telephones, dB relative to 31–203 Hz; the high-pass of the telephones takes the first.
const TELEPHONES_DB: [f64; 7] = [-17.0, 0.0, -5.0, -18.0, -25.0, -25.0, -24.0];
/// Recordings of each test.
const COUNT: u64 = 60;

/// Gentle breaths at a telephone, from arrival to end: to breathe is not to blow.
fn telephones() -> Vec<Vec<f64>> {
    let mut random = Random::new(5);
    let recording = |seed: u64| {
        let drawn = Breath::random(Manner::Plain, Person::Weak, (0.06, 0.15), &mut random);
        let microphone = Microphone { high_pass_hz: 150.0, order: 4, ..Microphone::default() };
        let breath = Breath { angle_deg: drawn.angle_deg.min(4.0), room_db: 30.0, microphone, ..drawn };
        let label = breath.label(0.0, &breath.speeds(seed));
        let samples = breath.recorded(RATE, seed);
        let (from, until) = ((label.arrival * R) as usize, ((label.end * R) as usize).min(samples.len()));
        samples[from..until].iter().map(|x| f64::from(*x)).collect::<Vec<f64>>()
    };
    (0..COUNT).map(recording).filter(|samples| samples.len() > RATE as usize / 4).collect()
}

#[test]
fn band_levels_are_those_of_people_at_telephones() {
    // Telephones, lips and distances differ: the quartiles of the measured levels are 5 to 8 dB apart.
    const APART_DB: f64 = 7.0;
    let mut levels = vec![Vec::new(); 7];
    for samples in telephones() {
        let powers = band_powers(&samples, R, &BANDS_HZ);
        let low = powers[0] + powers[1];
        levels.iter_mut().zip(&powers).for_each(|(levels, power)| levels.push(db(power / low)));
    }
    let medians: Vec<f64> = levels.iter().map(|levels| quantile(levels, 0.5)).collect();
    for (median, measured) in medians.iter().zip(TELEPHONES_DB) {
        assert!((median - measured).abs() < APART_DB, "{medians:?}, not {TELEPHONES_DB:?} dB");
    }
}

#[test]
fn the_envelope_falls_and_the_pitch_is_none_as_measured() {
    // Measured: a median of 4.6 dB below the peak of the last 0.24 s, and 9 to 12 dB at the ninth decile; autocorrelation of 0.2 to
    // 0.45, and 0.65 to 0.72 of speech.
    let (mut falls, mut peaks) = (Vec::new(), Vec::new());
    for samples in telephones() {
        let band = low_passed(high_passed(samples.clone(), R, 20.0, 2), R, 200.0, 2);
        let envelope: Vec<f64> = band.chunks(320).map(|frame| db(power(frame))).collect();
        for window in envelope.windows(13) {
            let peak = window.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            falls.push(peak - window[12]);
        }
        for frame in samples.chunks_exact(1600) {
            let whole: f64 = frame.iter().map(|x| x * x).sum();
            let at = |lag: usize| frame[lag..].iter().zip(frame).map(|(a, b)| a * b).sum::<f64>() / whole;
            peaks.push((40..200).map(at).fold(0.0, f64::max));
        }
    }
    let (median, ninth) = (quantile(&falls, 0.5), quantile(&falls, 0.9));
    assert!((3.5..6.5).contains(&median) && (8.0..16.0).contains(&ninth), "{median} and {ninth} dB");
    let periodicity = quantile(&peaks, 0.5);
    assert!((0.1..0.45).contains(&periodicity), "{periodicity}");
}

#[test]
fn a_hard_near_breath_clips_and_a_gentle_far_one_is_far_below() {
    let peak = |breath: Breath| breath.recorded(RATE, 1).iter().fold(0.0_f32, |top, x| top.max(x.abs()));
    assert!(peak(Breath { speed: 17.0, distance: 0.08, ..Breath::default() }) >= 1.0);
    assert!(peak(Breath { speed: 5.0, distance: 0.4, ..Breath::default() }) < 0.2);
}

#[test]
fn every_manner_gives_air_and_a_puff_is_short() {
    let mut random = Random::new(9);
    for manner in Manner::ALL {
        let drawn = Breath::random(manner, Person::Adult, (0.15, 0.16), &mut random);
        let breath = Breath { angle_deg: 0.0, ..drawn };
        let label = breath.label(2.0, &breath.speeds(4));
        assert!(label.peak_speed > 1.0 && label.arrival >= 2.0, "{manner:?}: {} m/s", label.peak_speed);
        let length = label.end - label.arrival;
        let lengths = match manner {
            Manner::Hold => 4.5..7.0,
            Manner::Puff => 0.1..0.9,
            _ => 0.2..4.5,
        };
        assert!(lengths.contains(&length), "{manner:?}: {length} s");
        let before = label.speed_at(label.arrival - 0.01);
        assert!(label.speed_at(label.arrival) >= 0.35 && before < 0.35, "{manner:?}: {before} m/s before");
    }
}

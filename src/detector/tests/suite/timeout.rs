//! Sustained sounds, such as ventilation, trains and fans: they may be taken for breath briefly, never for long.

use soffio_detector::generate::{self, BreathShape};
use soffio_detector::{BlowDetector, Reason};
use soffio_math::noise::Random;
use soffio_soundscape::{RATE, noises};

/// Longest false breath at the sudden beginning of a sustained sound, s.
const FALSE_S: f64 = 0.5;

/// Wind speed over a sound, a value per 5 ms.
fn speeds(samples: &[f32]) -> Vec<f64> {
    let mut detector = BlowDetector::new(RATE);
    let step = |block: &[f32]| {
        detector.push(block, &[]);
        detector.estimate().speed
    };
    samples.chunks(80).map(step).collect()
}

/// Two seconds of a quiet room, then the sound at this level (RMS), with a breath at its end.
fn sound_with_breath(sound: &[f64], dbfs: f64, seed: u64) -> Vec<f32> {
    let gain = soffio_math::db_to_amplitude(dbfs);
    let mut all = generate::pink_noise(RATE, seed, 2.0, -60.0);
    all.extend(sound.iter().map(|x| (gain * x) as f32));
    let shape = BreathShape { strength: 15.0, distance: 0.08, ..BreathShape::default() };
    let breath = generate::breath(RATE, seed, &shape);
    let from = all.len() - breath.len();
    generate::mix(&mut all[from..], &breath);
    all
}

#[test]
fn ventilation_enters_the_noise_floor_and_a_breath_in_it_is_detected() {
    let (mut false_s, mut detected) = (0.0_f64, 0);
    for seed in 0..6 {
        let mut random = Random::new(seed);
        let all = sound_with_breath(&noises::air(12.0, &mut random), -38.0, seed);
        let wind = speeds(&all);
        let breath = wind.len() - (200.0 * BreathShape::default().duration()) as usize;
        false_s = false_s.max(wind[..breath].iter().filter(|s| **s > 0.0).count() as f64 / 200.0);
        detected += usize::from(wind[breath..].iter().any(|s| *s > 0.0));
    }
    assert!(false_s <= FALSE_S, "wind of ventilation for {false_s} s");
    assert!(detected >= 5, "breaths before ventilation: {detected} of 6");
}

#[test]
fn a_fan_at_the_capsule_times_out_and_enters_the_noise_floor() {
    let fan = BreathShape { strength: 9.0, hold: 20.0, lead_out: 0.5, ..BreathShape::default() };
    let samples = generate::breath(RATE, 3, &fan);
    let mut detector = BlowDetector::new(RATE);
    let (mut blowing, mut timed_out) = (0.0, false);
    for block in samples.chunks(80) {
        detector.push(block, &[]);
        blowing += if detector.estimate().speed > 0.0 { 0.005 } else { 0.0 };
        timed_out |= detector.estimate().reason == Reason::TimedOut;
    }
    assert!(timed_out && blowing < 8.0, "wind of a fan for {blowing} s of {} s", fan.hold);
}

//! Noise, filters, rooms, devices and labels.

use soffio_math::noise::Random;
use soffio_math::{PI, sin};

use super::super::filter::{Biquad, highpass};
use super::super::labels::over_db;
use super::super::microphone;
use super::super::noise::{Draw, Drift, RATE, Shape, Workshop};
use super::super::stage::{Room, Stage, pascal};
use super::super::turbulence::Port;
use super::super::voice;
use super::{band, db, fluctuation, spectra};

const PORT: Port =
    Port { coefficient: 1.0, slope: 2.0, size: 0.002, wake: (0.003, 0.0), foam: 0.0, spacing: 0.05, decay: 10.0 };
const ROOM: Room = Room { t60: 0.5, critical: 1.0, reflection: (0.002, 0.0) };

fn level(x: &[f32]) -> f64 {
    20.0 * soffio_math::log10(fluctuation(x.iter().map(|x| f64::from(*x))))
}

#[test]
fn a_noise_has_its_spectrum_and_unit_power() {
    let shape = Shape::corners(&[(100.0, 0.0), (200.0, 0.0), (800.0, -20.0), (8000.0, -20.0)]);
    for seconds in [1.0, 20.0] {
        let x = Workshop::default().noise(&mut Random::new(1), (seconds * RATE) as usize, &shape);
        assert!(level(&x).abs() < 1.0, "{} dB", level(&x));
        let (power, _, _) = spectra(&x, &x);
        let fall = db(band(&power, 80.0, 180.0) / band(&power, 2000.0, 2100.0));
        assert!((fall - 20.0).abs() < 1.5, "{fall} dB");
    }
}

#[test]
fn drawn_numbers_and_drifts_have_unit_variance() {
    let mut random = Random::new(4);
    let normal: Vec<f64> = (0..20_000).map(|_| random.normal()).collect();
    assert!((fluctuation(normal.iter().copied()) - 1.0).abs() < 0.03);
    let drift = Drift::new(&mut random, 4000.0);
    let spread = fluctuation((0..40_000).map(|i| drift.at(0.1 * f64::from(i))));
    assert!((spread - 1.0).abs() < 0.08, "{spread}");
}

#[test]
fn convolution_is_the_sum_of_shifted_copies() {
    let mut random = Random::new(6);
    let x: Vec<f32> = (0..40_000).map(|_| random.signed() as f32).collect();
    let (mut first, mut second) = (vec![0.0; 9000], vec![0.0; 9000]);
    (first[0], first[8999], second[77]) = (1.0, 0.5, -2.0);
    let [a, b] = Workshop::default().convolve(&x, [&first, &second]);
    for i in [0, 5000, 8999, 9000, 23_456, 39_999] {
        let early = if i >= 8999 { 0.5 * x[i - 8999] } else { 0.0 };
        assert!((a[i] - x[i] - early).abs() < 1e-4);
        let late = if i >= 77 { -2.0 * x[i - 77] } else { 0.0 };
        assert!((b[i] - late).abs() < 1e-4);
    }
}

#[test]
fn filters_have_their_corner() {
    for order in 1..=4 {
        let gain = |f: f64| {
            let mut x: Vec<f32> = (0..32_000).map(|i| sin(2.0 * PI * f * f64::from(i) / RATE) as f32).collect();
            highpass(120.0, order).into_iter().for_each(|filter| filter.run(&mut x));
            level(&x[16_000..]) + 3.01
        };
        assert!((gain(120.0) + 3.0).abs() < 0.3, "order {order}: {} dB at the corner", gain(120.0));
        let slope = gain(60.0) - gain(30.0);
        assert!((slope - 6.0 * order as f64).abs() < 1.5, "order {order}: {slope} dB an octave");
    }
    let mut x: Vec<f32> = (0..32_000).map(|i| sin(2.0 * PI * 500.0 * f64::from(i) / RATE) as f32).collect();
    Biquad::peak(500.0, 2.0, 9.0).run(&mut x);
    assert!((level(&x[16_000..]) + 3.01 - 9.0).abs() < 0.1);
}

#[test]
fn sounds_have_their_levels_near_and_in_the_room() {
    let mut random = Random::new(8);
    let mut stage = Stage::new(4.0, 3, ROOM, PORT);
    let shape = Shape::corners(&[(100.0, 0.0), (1000.0, 0.0)]);
    let wave = stage.noise(&mut random, 4.0, &shape);
    stage.sound(0.0, &wave, 60.0, 2.0);
    let expected = 20.0 * soffio_math::log10(0.5 * pascal(60.0));
    assert!((level(&stage.other[0]) - expected).abs() < 0.5);
    // At twice the critical distance the room is four times as strong.
    stage.reverberate(&mut random);
    let both = level(&stage.other[0][16_000..]) - expected;
    assert!((both - db(5.0)).abs() < 2.5, "{both} dB");
}

#[test]
fn the_label_is_the_ratio_of_the_best_octave() {
    let mut workshop = Workshop::default();
    let mut random = Random::new(2);
    let flat = Shape::corners(&[(20.0, 0.0), (8000.0, 0.0)]);
    let low = Shape::corners(&[(60.0, 0.0), (100.0, 0.0), (200.0, -60.0), (8000.0, -60.0)]);
    let other = workshop.noise(&mut random, 80_000, &low);
    let ours: Vec<f32> = workshop.noise(&mut random, 80_000, &flat).iter().map(|x| 0.01 * x).collect();
    let over = over_db(&mut workshop, &ours, &other, 5000);
    // Above 200 Hz both are known: ours has 1e-4/8000 per Hz, the other one 1e-6/87 per Hz.
    let expected = db(1e-4 / 8000.0 / (1e-6 / 87.0));
    let mean = over[1000..4000].iter().map(|x| f64::from(*x)).sum::<f64>() / 3000.0;
    // The best of four octaves is up to 2 dB above their mean; the power between 100 and 200 Hz adds 15 % to the other.
    assert!((mean - expected).abs() < 2.5, "{mean} dB, not {expected}");
    assert!(over_db(&mut workshop, &[0.0; 9000], &other[..9000], 500).iter().all(|x| *x == -100.0));
}

#[test]
fn devices_cut_off_hard_and_suppress_steady_noise() {
    let mut random = Random::new(31);
    let mut suppressed = 0;
    for _ in 0..60 {
        let device = microphone::draw(&mut random);
        let shape = Shape::corners(&[(300.0, 0.0), (3000.0, 0.0)]);
        let steady: Vec<f32> =
            Workshop::default().noise(&mut random, 64_000, &shape).iter().map(|x| 0.02 * x).collect();
        let mut capsules = vec![steady.clone(), steady.iter().map(|x| 1000.0 * x).collect()];
        device.finish(&mut random, &mut capsules);
        assert!(capsules[1].iter().all(|x| x.abs() <= 1.0));
        if device.suppresses() {
            suppressed += 1;
            // The louder capsule drives the common gain, so the comparison is within the first.
            let fall = level(&steady[48_000..]) - level(&capsules[0][48_000..]);
            assert!(fall > 2.0, "{fall} dB");
        }
    }
    assert!(suppressed > 4);
}

#[test]
fn speech_has_pitch_pauses_and_consonants() {
    let mut random = Random::new(12);
    let speaker = voice::draw_speaker(&mut random, false);
    let score = voice::speech(&mut random, &speaker, 8.0, 1.0);
    let wave = voice::perform(&mut random, &speaker, &score);
    assert!(score.puffs.len() > 5);
    let (mut peaks, window) = (Vec::new(), 800);
    for part in wave.chunks_exact(window) {
        let energy = |x: &[f32]| x.iter().map(|x| f64::from(*x) * f64::from(*x)).sum::<f64>();
        if energy(part) < 0.3 * window as f64 {
            continue;
        }
        let correlation = |lag: usize| part[lag..].iter().zip(part).map(|(a, b)| f64::from(*a) * f64::from(*b)).sum();
        let best = (40..200).map(correlation).fold(0.0_f64, |best: f64, x: f64| best.max(x));
        peaks.push(best / energy(part));
    }
    // Recorded speech has 0.65 to 0.72 with its room and consonants, a breath 0.2 to 0.45. These are loud parts alone.
    let median = super::quantile(&mut peaks, 0.5);
    assert!((0.55..0.88).contains(&median), "{median}");
    let quiet = wave.iter().filter(|x| x.abs() < 1e-3).count() as f64 / wave.len() as f64;
    assert!(quiet > 0.05 && quiet < 0.6, "{quiet} of it is silence");
}

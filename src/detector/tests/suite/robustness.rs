//! Blocks, sample rates, bad numbers and memory: none of them matters.

use super::estimates;
use assert_no_alloc::assert_no_alloc;
use soffio_detector::{BlowDetector, Reason};
use soffio_math::noise::Random;
use soffio_soundscape::breath::Breath;
use soffio_soundscape::microphone::resampled;

#[test]
fn blocks_of_any_size_give_the_same_estimates_and_later_samples_change_none() {
    let samples = Breath::default().recorded(44_100, 3);
    let mut whole = BlowDetector::new(44_100);
    whole.push(&samples, &samples);
    let mut random = Random::new(4);
    for longest in [1.0, 200.0, 5000.0] {
        let mut detector = BlowDetector::new(44_100);
        let mut from = 0;
        while from < samples.len() {
            let to = (from + 1 + (random.unit() * longest) as usize).min(samples.len());
            detector.push(&samples[from..to], &samples[from..to]);
            from = to;
        }
        assert_eq!(detector.estimate(), whole.estimate(), "blocks of up to {longest} samples");
    }
    let all = estimates(&samples, 44_100);
    let half = estimates(&samples[..samples.len() / 2], 44_100);
    assert!(half[..half.len() - 1] == all[..half.len() - 1], "later samples change earlier estimates");
}

#[test]
fn the_sample_rate_does_not_matter() {
    /// Frames lie on another grid of samples, so a decision may fall a few frames of 8 ms away.
    const SAME_TIME_S: f64 = 0.04;
    /// Mean speed at another rate, relative.
    const SAME_SPEED: f64 = 0.03;
    let original = Breath { speed: 8.0, ..Breath::default() }.recorded(16_000, 5);
    let measure = |samples: &[f32], rate: u32| {
        let wind = estimates(samples, rate);
        let blown: Vec<_> = wind.iter().filter(|(_, e)| e.speed > 0.0).collect();
        let mean = blown.iter().map(|(_, e)| e.speed).sum::<f64>() / blown.len() as f64;
        (blown[0].0, blown[blown.len() - 1].0, mean)
    };
    let (first, last, mean) = measure(&original, 16_000);
    for rate in [22_050, 44_100, 48_000, 96_000, 192_000] {
        let (f, l, m) = measure(&resampled(&original, 16_000, rate), rate);
        let same_time = (f - first).abs() < SAME_TIME_S && (l - last).abs() < SAME_TIME_S;
        assert!(same_time, "{rate} Hz: {f} to {l} s, not {first} to {last} s");
        assert!((m / mean - 1.0).abs() < SAME_SPEED, "{rate} Hz: {m} m/s instead of {mean}");
    }
}

#[test]
fn bad_numbers_are_a_fault_and_pass() {
    let mut samples = Breath { hold: 2.0, ..Breath::default() }.recorded(16_000, 6);
    for (i, x) in samples[24_000..24_100].iter_mut().enumerate() {
        *x = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY][i % 3];
    }
    let wind = estimates(&samples, 16_000);
    assert!(wind.iter().all(|(_, e)| e.speed.is_finite() && e.confidence.is_finite() && e.floor_dbfs.is_finite()));
    let faults: Vec<_> = wind.iter().filter(|(_, e)| e.reason == Reason::Fault).collect();
    assert!(!faults.is_empty() && faults.iter().all(|(t, e)| (1.5..1.65).contains(t) && e.speed == 0.0), "{faults:?}");
    let after = wind.iter().filter(|(t, e)| *t > 1.9 && *t < 2.9 && e.speed > 0.0).count();
    assert!(after > 150, "the breath continues after the fault: {after} of 200 blocks");
}

#[test]
fn one_microphone_on_both_channels_is_one_microphone() {
    let samples = Breath::default().recorded(16_000, 8);
    let mut detector = BlowDetector::new(16_000);
    let both = samples.chunks(80).map(|block| {
        detector.push_stereo(block, block, &[]);
        (detector.estimate().speed, detector.estimate().reason)
    });
    let one = estimates(&samples, 16_000);
    assert!(both.eq(one.iter().map(|(_, e)| (e.speed, e.reason))), "another speed or reason");
    assert!(one.iter().any(|(_, e)| e.speed > 0.0), "a breath");
}

#[test]
fn the_detector_never_allocates() {
    let samples = Breath::default().recorded(48_000, 13);
    let mut detector = BlowDetector::new(48_000);
    for block in samples.chunks(200) {
        assert_no_alloc(|| {
            detector.push(block, block);
            detector.push_stereo(block, block, &[]);
        });
    }
}

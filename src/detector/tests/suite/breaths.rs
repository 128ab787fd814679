//! Requirements for any microphone: latency, release, other sounds, sample rates, gain, faults.

use std::path::Path;

use assert_no_alloc::assert_no_alloc;
use soffio_detector::generate::{self, BreathShape};
use soffio_detector::{BlowDetector, BlowEstimate, Reason};
use soffio_math::noise::Random;
use soffio_soundscape::FIRST_VALIDATION_SEED;
use soffio_soundscape::scenes::{Condition, Hearing, Scenario};

/// A WAV of 16-bit samples and one channel: samples from −1 to 1, and their rate, Hz.
fn mono(path: &Path) -> (Vec<f32>, u32) {
    let mut file = hound::WavReader::open(path).expect("a shipped breath");
    let spec = file.spec();
    assert_eq!((spec.channels, spec.bits_per_sample), (1, 16), "{}", path.display());
    let samples = file.samples::<i16>().map(|x| f32::from(x.expect("a sample")) / 32768.0).collect();
    (samples, spec.sample_rate)
}

/// The estimate after every block of 5 ms, with its time, s.
fn estimates(samples: &[f32], sample_rate: u32) -> Vec<(f64, BlowEstimate)> {
    let mut detector = BlowDetector::new(sample_rate);
    let mut count = 0;
    let block = (sample_rate / 200) as usize;
    let step = |block: &[f32]| {
        detector.push(block, &[]);
        count += block.len();
        (count as f64 / f64::from(sample_rate), detector.estimate())
    };
    samples.chunks(block).map(step).collect()
}

fn seconds_blowing(samples: &[f32], sample_rate: u32) -> f64 {
    estimates(samples, sample_rate).iter().filter(|(_, e)| e.speed > 0.0).count() as f64 / 200.0
}

#[track_caller]
fn assert_no_wind(what: &str, samples: &[f32], sample_rate: u32) {
    for (t, estimate) in estimates(samples, sample_rate) {
        assert!(estimate.speed == 0.0, "{what}: wind at {t:.3} s: {estimate:?}");
        assert!(estimate.confidence.is_finite() && estimate.level_dbfs.is_finite(), "{what}: {estimate:?}");
    }
}

/// Longest time from onset to wind, s. The goal is a median of 120 ms, and 250 ms for nine in ten; single breaths of the generator
/// may be as slow as the slowest tenth.
const LATENCY_S: f64 = 0.25;
/// Longest time from the end of the air to wind 0, s (the goal).
const RELEASE_S: f64 = 0.3;

#[test]
fn a_breath_of_any_strength_makes_wind_that_ends_with_it() {
    let mut mean_speeds = Vec::new();
    for (seed, strength) in [3.8, 6.0, 8.9, 13.3, 17.0].into_iter().enumerate() {
        let shape = BreathShape { strength, ..BreathShape::default() };
        let wind = estimates(&generate::breath(48000, seed as u64, &shape), 48000);
        let (onset, end) = shape.span();
        let first = wind.iter().find(|(_, e)| e.speed > 0.0).expect("a breath").0;
        let last = wind.iter().rfind(|(_, e)| e.speed > 0.0).unwrap().0;
        assert!((onset..onset + LATENCY_S).contains(&first), "{strength} m/s from {onset} s: wind at {first} s");
        assert!(last < end + RELEASE_S, "{strength} m/s until {end} s: wind until {last} s");
        let blowing: Vec<f64> = wind.iter().map(|(_, e)| e.speed).filter(|s| *s > 0.0).collect();
        mean_speeds.push(blowing.iter().sum::<f64>() / blowing.len() as f64);
    }
    assert!(
        mean_speeds.windows(2).all(|pair| pair[0] < pair[1]),
        "a stronger breath is a stronger wind: {mean_speeds:?}"
    );
    assert!(mean_speeds[0] > 1.0 && mean_speeds[4] <= 17.0, "speeds of a mouth: {mean_speeds:?}");
}

/// Level of the onset of a shipped breath: the first 5 ms louder than this, RMS of full scale (−45 dB).
const ONSET: f64 = 5.6e-3;
/// Time from onset to wind in a quiet room, s: the kiosk's required median, and its goal for nine in ten, here for all.
const AT_ONCE_S: (f64, f64) = (0.14, 0.25);

/// The detection of a breath must not depend on the position of frames or on the noise.
#[test]
fn a_breath_is_detected_at_once_whatever_the_frames_and_the_noise() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../exhibits/steel-fish/breaths");
    let mut delays = Vec::new();
    for (name, draw) in ["strong", "normal"].into_iter().flat_map(|name| (0..16).map(move |draw| (name, draw))) {
        let (breath, rate) = mono(&folder.join(format!("{name}.wav")));
        // Frames come every 8 ms.
        let early = rate as usize * (1500 + draw) / 1000;
        let mut samples = generate::pink_noise(rate, draw as u64, 5.0, -60.0);
        samples[early..].iter_mut().zip(&breath).for_each(|(x, b)| *x += b);
        let loud =
            |block: &[f32]| block.iter().map(|x| f64::from(x * x)).sum::<f64>() > ONSET * ONSET * block.len() as f64;
        let block = rate as usize / 200;
        let onset = early + block * samples[early..].chunks(block).position(loud).expect("a breath");
        let wind = estimates(&samples, rate).into_iter().find(|(_, e)| e.speed > 0.0).expect("wind").0;
        delays.push(wind - onset as f64 / f64::from(rate));
    }
    delays.sort_by(f64::total_cmp);
    println!("{delays:.3?}");
    let (median, most) = (delays[delays.len() / 2], delays[delays.len() - 1]);
    assert!(delays[0] > 0.0 && median <= AT_ONCE_S.0 && most <= AT_ONCE_S.1, "{delays:.3?}");
}

#[test]
fn sounds_other_than_breath_make_no_wind() {
    let rate = 16000;
    assert_no_wind("digital zero", &vec![0.0; 48000], rate);
    assert_no_wind("a sensor stuck at the rail", &vec![1.0; 48000], rate);
    for seed in 0..3 {
        let mut random = Random::new(seed);
        let quietly = |mut samples: Vec<f32>| {
            generate::mix(&mut samples, &generate::pink_noise(rate, seed + 50, 4.0, -60.0));
            samples
        };
        assert_no_wind("white noise", &generate::white_noise(rate, seed, 4.0, -20.0), rate);
        assert_no_wind("pink noise", &generate::pink_noise(rate, seed, 4.0, -20.0), rate);
        assert_no_wind("hum", &quietly(generate::hum(rate, 4.0, [50.0, 60.0, 100.0][seed as usize], -20.0)), rate);
        assert_no_wind("a voice", &quietly(generate::voice(rate, seed, 4.0, random.range(90.0, 220.0), -18.0)), rate);
        let times = [0.6, 1.3, 2.1, 3.2];
        assert_no_wind("knocks", &quietly(generate::knocks(rate, seed, 4.0, &times, 0.7)), rate);
        assert_no_wind("plosives", &quietly(generate::plosives(rate, seed, 4.0, &times, 0.5)), rate);
    }
}

#[test]
fn blocks_of_any_size_give_the_same_estimates() {
    let samples = generate::breath(44100, 3, &BreathShape::default());
    let whole = {
        let mut detector = BlowDetector::new(44100);
        detector.push(&samples, &samples);
        detector.estimate()
    };
    let mut random = Random::new(4);
    for longest in [1.0, 200.0, 5000.0] {
        let mut detector = BlowDetector::new(44100);
        let mut from = 0;
        while from < samples.len() {
            let to = (from + 1 + (random.unit() * longest) as usize).min(samples.len());
            detector.push(&samples[from..to], &samples[from..to]);
            from = to;
        }
        assert_eq!(detector.estimate(), whole, "blocks of up to {longest} samples");
    }
}

/// The same sound at another rate: a windowed sinc of 32 zero crossings (the source has nothing above its band).
fn resampled(samples: &[f32], from: f64, to: f64) -> Vec<f32> {
    use std::f64::consts::PI;
    const HALF: f64 = 16.0;
    let at = |i: usize| {
        let centre = i as f64 * from / to;
        let (first, last) = ((centre - HALF).ceil().max(0.0) as usize, (centre + HALF) as usize);
        let tap = |j: usize| {
            let t = centre - j as f64;
            let sinc = if t.abs() < 1e-9 { 1.0 } else { (PI * t).sin() / (PI * t) };
            f64::from(samples[j]) * sinc * (0.5 + 0.5 * (PI * t / HALF).cos())
        };
        (first..=last.min(samples.len() - 1)).map(tap).sum::<f64>() as f32
    };
    (0..(samples.len() as f64 * to / from) as usize).map(at).collect()
}

/// Frames lie on another grid of samples, so a decision may fall one or two frames of 8 ms away.
const SAME_TIME_S: f64 = 0.025;
/// Mean speed at another rate, relative.
const SAME_SPEED: f64 = 0.02;

#[test]
fn the_sample_rate_does_not_matter() {
    let shape = BreathShape { strength: 7.0, ..BreathShape::default() };
    let original = generate::breath(16000, 5, &shape);
    let measure = |samples: &[f32], rate: u32| {
        let wind = estimates(samples, rate);
        let blowing: Vec<_> = wind.iter().filter(|(_, e)| e.speed > 0.0).collect();
        let mean = blowing.iter().map(|(_, e)| e.speed).sum::<f64>() / blowing.len() as f64;
        (blowing.first().unwrap().0, blowing.last().unwrap().0, mean)
    };
    let (first, last, mean) = measure(&original, 16000);
    for rate in [22050, 44100, 48000, 96000, 192_000] {
        let (f, l, m) = measure(&resampled(&original, 16000.0, f64::from(rate)), rate);
        assert!(
            (f - first).abs() < SAME_TIME_S && (l - last).abs() < SAME_TIME_S,
            "{rate} Hz: {f}–{l}, {first}–{last}"
        );
        assert!((m / mean - 1.0).abs() < SAME_SPEED, "{rate} Hz: {m} m/s instead of {mean}");
    }
}

#[test]
fn bad_numbers_are_a_fault_and_pass() {
    let shape = BreathShape { hold: 2.0, ..BreathShape::default() };
    let mut samples = generate::breath(16000, 6, &shape);
    let bad = 16000 * 3 / 2..16000 * 3 / 2 + 100;
    for (i, x) in samples[bad].iter_mut().enumerate() {
        *x = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY][i % 3];
    }
    let wind = estimates(&samples, 16000);
    assert!(wind.iter().all(|(_, e)| e.speed.is_finite() && e.confidence.is_finite() && e.floor_dbfs.is_finite()));
    let faults: Vec<f64> = wind.iter().filter(|(_, e)| e.reason == Reason::Fault).map(|(t, _)| *t).collect();
    assert!(!faults.is_empty() && faults.iter().all(|t| (1.5..1.65).contains(t)), "faults at {faults:?}");
    assert!(wind.iter().filter(|(_, e)| e.reason == Reason::Fault).all(|(_, e)| e.speed == 0.0));
    let after = wind.iter().filter(|(t, e)| *t > 1.9 && *t < 2.9 && e.speed > 0.0).count();
    assert!(after > 150, "the breath continues after the fault: {after} of 200 blocks");
}

#[test]
fn an_overdriven_microphone_still_detects_a_breath() {
    let mut samples = generate::breath(16000, 8, &BreathShape { strength: 13.0, ..BreathShape::default() });
    samples.iter_mut().for_each(|x| *x = (*x * 8.0).clamp(-1.0, 1.0));
    let wind = estimates(&samples, 16000);
    assert!(wind.iter().any(|(_, e)| e.clipping && e.speed > 10.0), "clipped, and strong");
    assert!(wind.iter().all(|(_, e)| e.speed <= 17.0), "no stronger than a mouth");
}

#[test]
fn no_one_blows_for_longer_than_six_seconds() {
    let fan = BreathShape { hold: 14.0, lead_out: 3.0, ..BreathShape::default() };
    let mut samples = generate::breath(16000, 9, &fan);
    let fan_end = fan.span().1;
    samples.extend(generate::breath(16000, 10, &BreathShape::default()));
    let wind = estimates(&samples, 16000);
    let blowing = wind.iter().filter(|(t, e)| *t < fan_end + 1.0 && e.speed > 0.0).count() as f64 / 200.0;
    assert!((5.5..6.5).contains(&blowing), "wind for {blowing} s of a fan's 14 s");
    assert!(wind.iter().any(|(_, e)| e.reason == Reason::TimedOut));
    assert!(wind.iter().any(|(t, e)| *t > fan_end + 3.0 && e.speed > 0.0), "a breath after it is detected");
}

#[test]
fn gain_does_not_decide() {
    let samples = generate::breath(16000, 12, &BreathShape { strength: 7.0, ..BreathShape::default() });
    let plain = seconds_blowing(&samples, 16000);
    for gain in [0.25, 4.0] {
        let scaled: Vec<f32> = samples.iter().map(|x| (x * gain).clamp(-1.0, 1.0)).collect();
        let seconds = seconds_blowing(&scaled, 16000);
        assert!((seconds - plain).abs() < 0.2, "{seconds} s at gain {gain}, {plain} s without");
    }
}

#[test]
fn the_detector_never_allocates() {
    let samples = generate::breath(48000, 13, &BreathShape::default());
    let mut detector = BlowDetector::new(48000);
    for block in samples.chunks(200) {
        assert_no_alloc(|| {
            detector.push(block, block);
            detector.push_stereo(block, block, &[]);
        });
    }
    // Two capsules that the detector recognises.
    let stereo = Hearing { gain_db: 0.0, stereo: true };
    let take = Scenario::new(FIRST_VALIDATION_SEED + 80).take(Condition::Noisy(5.0), 0, stereo);
    let right = take.right.expect("two capsules");
    let mut detector = BlowDetector::new(take.sample_rate);
    for (left, right) in take.left.chunks(66).zip(right.chunks(66)) {
        assert_no_alloc(|| detector.push_stereo(left, right, left));
    }
    assert!(detector.last_frame().dual_mic.is_some());
}

#[test]
fn later_samples_change_no_earlier_estimate() {
    let samples = generate::breath(44100, 14, &BreathShape::default());
    let whole = estimates(&samples, 44100);
    for part in [0.3, 0.55, 0.81] {
        let cut = (part * samples.len() as f64) as usize;
        let some = estimates(&samples[..cut], 44100);
        let full_blocks = cut / (44100 / 200);
        assert!(some[..full_blocks] == whole[..full_blocks], "cut at {part} of the recording");
    }
}

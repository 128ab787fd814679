//! Breaths make wind, at once and as long as they last; other sounds make none.

use super::estimates;
use soffio_math::noise::Random;
use soffio_soundscape::breath::Breath;
use soffio_soundscape::test_sounds as sounds;

/// Longest time from the air at the capsule to wind, s: nine in ten breaths must not wait longer.
const LATENCY_S: f64 = 0.3;
/// Longest time from the end of the air to wind 0, s (the goal).
const RELEASE_S: f64 = 0.3;

#[test]
fn a_breath_of_any_strength_makes_wind_that_ends_with_it_and_grows_with_it() {
    let mut averages = Vec::new();
    for (seed, speed) in (0..).zip([3.8, 6.0, 9.0, 13.0, 17.0]) {
        let breath = Breath { speed, ..Breath::default() };
        let label = breath.label(0.0, &breath.speeds(seed));
        let wind = estimates(&breath.recorded(48_000, seed), 48_000);
        let blown: Vec<_> = wind.iter().filter(|(_, e)| e.speed > 0.0).collect();
        let (first, last) = (blown.first().expect("a breath").0, blown.last().expect("a breath").0);
        assert!(first < label.arrival + LATENCY_S, "{speed} m/s, air from {} s: wind at {first} s", label.arrival);
        assert!(first > breath.lead_in, "{speed} m/s: wind at {first} s, before the breath");
        assert!(last < label.end + RELEASE_S, "{speed} m/s, air until {} s: wind until {last} s", label.end);
        averages.push(blown.iter().map(|(_, e)| e.speed).sum::<f64>() / blown.len() as f64);
    }
    assert!(averages.is_sorted() && averages[0] > 1.0 && averages[4] <= 17.0, "speeds at the lips: {averages:.1?}");
}

#[test]
fn sounds_other_than_breath_make_no_wind() {
    let rate = 16_000;
    let no_wind = |what: &str, samples: &[f32]| {
        let wind = estimates(samples, rate).into_iter().find(|(_, e)| e.speed > 0.0 || !e.confidence.is_finite());
        assert!(wind.is_none(), "{what}: {wind:?}");
    };
    no_wind("digital zero", &vec![0.0; 48_000]);
    no_wind("a sensor stuck at the rail", &vec![1.0; 48_000]);
    for seed in 0..3 {
        let mut random = Random::new(seed);
        let quietly = |mut samples: Vec<f32>| {
            sounds::mix(&mut samples, &sounds::pink_noise(rate, seed + 50, 4.0, -60.0));
            samples
        };
        no_wind("white noise", &sounds::white_noise(rate, seed, 4.0, -20.0));
        no_wind("pink noise", &sounds::pink_noise(rate, seed, 4.0, -20.0));
        no_wind("hum", &quietly(sounds::hum(rate, 4.0, [50.0, 60.0, 100.0][seed as usize], -20.0)));
        no_wind("a voice", &quietly(sounds::voice(rate, seed, 4.0, random.range(90.0, 220.0), -18.0)));
        let times = [0.6, 1.3, 2.1, 3.2];
        no_wind("knocks", &quietly(sounds::knocks(rate, seed, 4.0, &times, 0.7)));
        no_wind("plosives", &quietly(sounds::plosives(rate, seed, 4.0, &times, 0.5)));
    }
}

#[test]
fn a_fan_becomes_usual_and_a_breath_after_it_is_detected() {
    /// Longest wind of a fan, s: after eight seconds the floors learn it.
    const FAN_S: f64 = 20.0;
    let fan = Breath { speed: 5.0, hold: 60.0, lead_out: 3.0, ..Breath::default() };
    let mut samples = fan.recorded(16_000, 9);
    let fan_s = samples.len() as f64 / 16_000.0;
    samples.extend(Breath::default().recorded(16_000, 10));
    let wind = estimates(&samples, 16_000);
    let blowing = wind.iter().filter(|(t, e)| *t < fan_s && e.speed > 0.0).count() as f64 / 200.0;
    assert!(blowing < FAN_S, "wind for {blowing} s of a fan's 60 s");
    assert!(wind.iter().any(|(t, e)| *t > fan_s + 1.0 && e.speed > 0.0), "a breath after it");
}

#[test]
fn gain_does_not_decide() {
    let samples = Breath { speed: 7.0, ..Breath::default() }.recorded(16_000, 12);
    let seconds = |gain: f32| {
        let scaled: Vec<f32> = samples.iter().map(|x| (x * gain).clamp(-1.0, 1.0)).collect();
        estimates(&scaled, 16_000).iter().filter(|(_, e)| e.speed > 0.0).count() as f64 / 200.0
    };
    let plain = seconds(1.0);
    assert!(plain > 1.0);
    for gain in [0.25, 4.0] {
        assert!((seconds(gain) - plain).abs() < 0.2, "{} s at gain {gain}, {plain} s without", seconds(gain));
    }
}

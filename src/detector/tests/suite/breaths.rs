//! Breaths make wind, at once and as long as they last; other sounds make none.

use super::estimates;
use soffio_detector::{AmbientSpread, BlowDetector};
use soffio_math::noise::Random;
use soffio_soundscape::RATE;
use soffio_soundscape::breath::Breath;
use soffio_soundscape::draught::Draught;
use soffio_soundscape::microphone::Microphone;
use soffio_soundscape::scenes::{Scenario, Stage};
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

#[test]
fn gain_control_is_named_after_one_breath_and_hardly_changes_its_strength() {
    const VISITS: u64 = 12;
    /// Visits in which one breath must be enough; a crowd may hide the drop.
    const NAMED: usize = 10;
    /// Mean strength with gain control relative to that without.
    const STRENGTH: std::ops::Range<f64> = 0.8..1.2;
    let scenario = Scenario::new(3);
    let listen = |gain_control: bool, visit: u64| {
        let mut random = Random::new(visit);
        let mut stage = Stage::new(8.0, 1);
        stage.add_noise(0.0, &scenario.air_noise(8.0, 50.0, 1, &mut random), &[]);
        stage.add_breath(4.0, &Breath { hold: 1.5, ..Breath::default() }, random.word());
        let take = stage.recorded(&Microphone { gain_control, ..Microphone::default() }, visit);
        let wind = estimates(&take.left, take.sample_rate);
        let speeds: Vec<f64> = wind.iter().filter(|(_, e)| e.speed > 0.0).map(|(_, e)| e.speed).collect();
        (wind.last().is_some_and(|(_, e)| e.gain_control), speeds.iter().sum::<f64>() / speeds.len() as f64)
    };
    let mut named = 0;
    for visit in 0..VISITS {
        let ((plain, speed), (controlled, controlled_speed)) = (listen(false, visit), listen(true, visit));
        assert!(!plain, "visit {visit}: there is no gain control");
        assert!(STRENGTH.contains(&(controlled_speed / speed)), "visit {visit}: {controlled_speed}, not {speed} m/s");
        named += usize::from(controlled);
    }
    assert!(named >= NAMED, "named in {named} of {VISITS} visits");
}

#[test]
fn what_is_learnt_of_a_draughty_room_outlasts_a_restart() {
    const LEARNING_S: f64 = 150.0;
    let listen = |samples: &[f32], known: Option<&AmbientSpread>| {
        let mut detector = BlowDetector::new(RATE);
        known.into_iter().for_each(|ambient_spread| detector.recall(ambient_spread));
        detector.push(samples, &[]);
        detector.ambient_spread()
    };
    let steady = listen(&sounds::white_noise(RATE, 1, LEARNING_S, -50.0), None);
    assert!(steady.gusts_db() < 0.3, "steady noise has no gusts: {steady:?}");
    let mut random = Random::new(7);
    let mut stage = Stage::new(LEARNING_S, 1);
    stage.add_noise(0.0, &Scenario::new(3).air_noise(LEARNING_S, 40.0, 1, &mut random), &[]);
    let draught = Draught::random(0.6, 0.3, 0.0, &mut random);
    stage.add_noise(0.0, &draught.pressure(LEARNING_S, RATE, 9), &[]);
    let take = stage.recorded(&Microphone::default(), 4);
    let learnt = listen(&take.left, None);
    assert!((1.5..6.0).contains(&learnt.gusts_db()), "{} dB: {learnt:?}", learnt.gusts_db());
    // Five seconds after a restart.
    let soon = &take.left[..5 * RATE as usize];
    let off = |ambient_spread: &AmbientSpread| {
        ambient_spread
            .bands
            .db
            .iter()
            .zip(&learnt.bands.db)
            .map(|(a, b)| (a - b).abs())
            .fold(0.0_f64, |most, db| most.max(db))
    };
    let (known, unknown) = (off(&listen(soon, Some(&learnt))), off(&listen(soon, None)));
    assert!(known < 0.7 && unknown > 2.0, "off by {known} dB with and {unknown} dB without what was kept");
}

//! The nightly audio self-test in simulated rooms: a delay, reflections, a filter for what is wrong, the room's noise.

use soffio_config::{Config, Day, TimeOfDay};
use soffio_devices::audio::output;
use soffio_devices::audio::{AudioStatus, DeviceState, Knobs};
use soffio_kiosk::fleet::persisted::{PersistedState, StateStore};
use soffio_kiosk::fleet::{Fleet, LocalTime};
use soffio_kiosk::venue::self_test::{REFERENCE_RUNS, SelfTestHistory, Verdict};
use soffio_kiosk::venue::self_test_run::{SelfTestAction, SelfTestRun};
use soffio_kiosk::venue::sweep::{RECORDED_S, measure_response, sweep};
use soffio_math::noise::Random;
use std::sync::Arc;

const RATE: u32 = 48_000;
/// Delay of the devices and of the air, s.
const DELAY_S: f64 = 0.037;
/// From the loudspeaker to the microphone, as an amplitude.
const WAY: f32 = 0.1;
/// Noise of a quiet gallery, and beside somebody who cleans it with a machine, as amplitudes.
const QUIET: f32 = 0.001;
const CLEANER: f32 = 0.1;
/// Levels come back within this of the filter that was put in, dB: the noise and the reflections within the window.
const NEAR_DB: f64 = 2.0;

/// Acoustic path between loudspeaker and microphone.
#[derive(Clone, Copy)]
struct Way {
    /// Of everything, dB.
    all_db: f64,
    /// Above 1.5 kHz, dB.
    high_db: f64,
    noise: f32,
}

const CLEAN: Way = Way { all_db: 0.0, high_db: 0.0, noise: QUIET };

/// What the microphone hears of `sent`, in another night for another seed; the reflections are the room's and stay.
fn recorded(sent: &[f32], way: Way, seed: u64) -> Vec<f32> {
    let rate = f64::from(RATE);
    let length = (RECORDED_S * rate) as usize;
    let mut heard = vec![0.0f32; length];
    let mut walls = Random::new(7);
    // The sound itself and 200 reflections that decay by 60 dB in 0.8 s.
    let taps = (0..200).map(|i| {
        let t = if i == 0 { 0.0 } else { 0.8 * walls.unit() };
        let gain = if i == 0 { 1.0 } else { 0.2 * walls.signed() * 10f64.powf(-3.0 * t / 0.8) };
        (((DELAY_S + t) * rate) as usize, gain as f32)
    });
    for (at, gain) in taps.collect::<Vec<_>>() {
        heard.iter_mut().skip(at).zip(sent).for_each(|(y, x)| *y += WAY * gain * x);
    }
    // A shelf of first order: what a low-pass lets through stays, the rest is softer.
    let pole = (-std::f64::consts::TAU * 1500.0 / rate).exp() as f32;
    let amplitude = |db: f64| 10f64.powf(db / 20.0) as f32;
    let (all, high) = (amplitude(way.all_db), amplitude(way.high_db));
    let (mut low, mut noise) = (0.0, Random::new(seed));
    for y in &mut heard {
        low = pole * low + (1.0 - pole) * *y;
        *y = all * (low + high * (*y - low)) + way.noise * noise.signed() as f32;
    }
    heard
}

/// A kiosk that knows its room.
fn settled() -> SelfTestHistory {
    let mut history = SelfTestHistory::default();
    for night in 1..=REFERENCE_RUNS {
        let heard = recorded(&sweep(RATE), CLEAN, night as u64);
        let verdict = history.record(&Ok(measure_response(&heard, RATE)), String::new());
        assert_eq!(*verdict, Verdict::Learns(night));
    }
    history
}

/// What it says of a night.
fn night(way: Way) -> Verdict {
    let heard = recorded(&sweep(RATE), way, 99);
    settled().record(&Ok(measure_response(&heard, RATE)), String::new()).clone()
}

#[test]
fn a_night_like_the_first_ones_is_good() {
    assert!(matches!(night(CLEAN), Verdict::Good(by) if by.abs() < 0.5), "{:?}", night(CLEAN));
    let warmer = Way { all_db: -2.0, high_db: -2.0, ..CLEAN };
    assert!(matches!(night(warmer), Verdict::Good(by) if (by + 2.5).abs() < NEAR_DB), "{:?}", night(warmer));
}

#[test]
fn a_wet_foam_is_known_by_its_high_tones() {
    let verdict = night(Way { high_db: -12.0, ..CLEAN });
    // A shelf of first order takes 4, 7 and 9 dB of the three high octaves, and some of 1 kHz.
    assert!(matches!(verdict, Verdict::WetFoam(by) if (5.0..7.0).contains(&by)), "{verdict:?}");
    assert!(verdict.to_string().contains("change it"));
}

#[test]
fn a_way_that_is_blocked_is_told_from_a_wet_foam() {
    for by_db in [-14.0, -20.0] {
        let verdict = night(Way { all_db: by_db, ..CLEAN });
        assert!(matches!(verdict, Verdict::Blocked(by) if (by + by_db).abs() < NEAR_DB), "{verdict:?}");
    }
    let verdict = night(Way { all_db: 14.0, ..CLEAN });
    assert!(matches!(verdict, Verdict::Louder(by) if (by - 14.0).abs() < NEAR_DB), "{verdict:?}");
}

#[test]
fn a_dead_loudspeaker_and_a_dead_microphone_are_told_apart() {
    assert_eq!(night(Way { all_db: -200.0, ..CLEAN }), Verdict::Unheard);
    assert_eq!(night(Way { all_db: -200.0, noise: 0.0, ..CLEAN }), Verdict::DeadMicrophone);
    let mut history = settled();
    let none = history.record(&Err("loudspeaker: missing".into()), String::new());
    assert!(none.is_bad() && none.to_string().contains("loudspeaker: missing"));
}

#[test]
fn somebody_who_cleans_beside_it_alarms_nobody() {
    for noise in [CLEANER, 1.0] {
        let verdict = night(Way { noise, ..CLEAN });
        assert!(!verdict.is_bad(), "noise {noise}: {verdict:?}");
    }
    // Nor does it become what later nights are compared with.
    let mut history = SelfTestHistory::default();
    let heard = recorded(&sweep(RATE), Way { noise: 1.0, ..CLEAN }, 3);
    let verdict = history.record(&Ok(measure_response(&heard, RATE)), String::new()).clone();
    assert!(matches!(verdict, Verdict::Noisy | Verdict::Unheard), "{verdict:?}");
    assert!(history.reference_db.is_empty());
}

#[test]
fn a_microphone_with_a_clock_of_its_own_hears_the_same() {
    let history = settled();
    let usual = history.reference_db[0];
    // Ninety millionths fast.
    let heard = recorded(&sweep(RATE + 4), CLEAN, 5);
    let levels = measure_response(&heard, RATE).levels_db;
    assert!(levels.iter().zip(usual).all(|(a, b)| (a - b).abs() < NEAR_DB), "{levels:?} {usual:?}");
    // Nothing but numbers is kept of it.
    let text = serde_json::to_string(&history).expect("JSON");
    assert!(text.len() < 1000 && !text.contains("samples"), "{text}");
    assert_eq!(serde_json::from_str::<SelfTestHistory>(&text).expect("it comes back"), history);
}

#[test]
fn the_course_goes_through_the_real_callback_and_ends_with_an_answer() {
    const BLOCK: usize = 480;
    /// What the loudspeaker's volume leaves.
    const VOLUME: f32 = 0.5;
    let knobs = Arc::new(Knobs::new(VOLUME));
    let (mut player, mut voice, _workshop) = output::open(RATE, 2, knobs);
    let device = || DeviceState::Ok { name: "one".into(), sample_rate: RATE };
    let status = AudioStatus { input: device(), output: device(), ..AudioStatus::default() };
    let mut run = SelfTestRun::default();
    assert!(run.update(0.0, &status, (&[0.0; BLOCK], Some(RATE))).is_none() && !run.is_running());
    run.begin(0.0);
    let mut air = std::collections::VecDeque::from(vec![0.0; 3 * BLOCK]);
    let mut outcome = None;
    for block in 0..1200 {
        let mut stereo = [0.0f32; 2 * BLOCK];
        player.play(&mut stereo);
        air.extend(stereo.as_chunks::<2>().0.iter().map(|[left, _]| WAY * left));
        let heard: Vec<f32> = air.drain(..BLOCK).collect();
        match run.update(block as f64 * 0.01, &status, (&heard, Some(RATE))) {
            Some(SelfTestAction::PlaySweep(words)) => voice.say(&words),
            Some(SelfTestAction::Done(done)) => outcome = Some(done),
            None => {}
        }
    }
    let arrived = outcome.expect("it ended").expect("it heard");
    assert!(!run.is_running() && arrived.clear == [true; 7], "{arrived:?}");
    let expected = 20.0 * f64::from(WAY * VOLUME).log10();
    assert!(arrived.levels_db.iter().all(|db| (db - expected).abs() < NEAR_DB), "{arrived:?} {expected}");
}

#[test]
fn without_a_device_it_ends_and_says_which() {
    let status = AudioStatus { output: DeviceState::Missing("unplugged".into()), ..AudioStatus::default() };
    let mut run = SelfTestRun::default();
    run.begin(0.0);
    let end = (0..100).find_map(|i| run.update(0.1 * f64::from(i), &status, (&[], None)));
    assert!(
        matches!(&end, Some(SelfTestAction::Done(Err(why))) if why.contains("loudspeaker: missing: unplugged")),
        "{end:?}"
    );
}

#[test]
fn it_runs_once_a_day_and_waits_for_whoever_is_there() {
    let mut fleet = Fleet::start(StateStore::default(), PersistedState::default(), false, &Config::default());
    let day = |day| Day { year: 2027, month: 3, day, weekday: 0 };
    let at = Some(TimeOfDay::from_minutes(23 * 60 + 40));
    let moment = |[today, yesterday]: [u8; 2], minutes| LocalTime {
        today: day(today),
        yesterday: day(yesterday),
        time: TimeOfDay::from_minutes(minutes),
    };
    let mut requested = |days: [u8; 2], minutes| fleet.self_test_is_due(at, moment(days, minutes), false);
    assert!(!requested([2, 1], 23 * 60 + 39));
    assert!(requested([2, 1], 23 * 60 + 40));
    assert!(!requested([2, 1], 23 * 60 + 41), "once");
    assert!(!requested([3, 2], 10), "the same hour, after midnight");
    assert!(requested([3, 2], 23 * 60 + 50));
    assert!(!requested([4, 3], 45), "too late");
    assert!(requested([5, 4], 20), "the hour of the fourth, which nobody was there for");
    assert!(!fleet.self_test_is_due(None, moment([9, 8], 0), false), "staff only");
}

#[test]
fn a_foam_counts_the_breaths_since_it_was_changed() {
    let mut history = SelfTestHistory::default();
    assert_eq!(history.foam_breaths(70), 70);
    history.change_foam(70);
    assert_eq!((history.foam_breaths(70), history.foam_breaths(75)), (0, 5));
    assert_eq!(history.foam_breaths(3), 0, "the counters were deleted");
}

//! The rehearsed gallery day: its programme, the scorers of pictures and sound, the detector-only day, and failing days.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use soffio_config::Config;
use soffio_detector::{BlowSettings, Rules};
use soffio_exhibit as exhibit;
use soffio_kiosk::venue::site::Site;
use soffio_math::noise::Random;
use soffio_offline::wav::Recording;
use soffio_rehearsal::day::{Day, Task};
use soffio_rehearsal::report::{ENOUGH, Report};
use soffio_rehearsal::scorer::{BEFORE, CONTINGENT, FPS, Picture, Response, SOON, median, score};
use soffio_rehearsal::visitor::{Intent, Visit};
use soffio_rehearsal::{Crowd, Rehearsal, recorded, run, run_detector};
use soffio_soundscape::breath::Breath;

use crate::cli::Desk;

/// Size of a drawn picture, pixels.
const SIZE: (usize, usize) = (80, 45);

/// A dark square of 9 pixels in front of a bright wall, `at` pixels from the left, with antialiased edges.
fn square(at: f64) -> Picture {
    let mut rgb = vec![230; 3 * SIZE.0 * SIZE.1];
    for (i, pixel) in rgb.as_chunks_mut::<3>().0.iter_mut().enumerate() {
        let (x, y) = ((i % SIZE.0) as f64, i / SIZE.0);
        let covered = ((x + 1.0).min(at + 9.0) - x.max(at)).clamp(0.0, 1.0);
        if (18..27).contains(&y) {
            pixel.fill((230.0 - 200.0 * covered) as u8);
        }
    }
    Picture(rgb)
}

/// Response for a square whose position is `at(t)` after the onset, and `control(t)` in the control run, t in seconds.
fn scored(at: impl Fn(f64) -> f64, control: impl Fn(f64) -> f64) -> Response {
    let pictures: Vec<Picture> =
        (0..=2 * BEFORE).map(|k| square(at((k as f64 - BEFORE as f64) / FPS as f64))).collect();
    let control: Vec<Picture> = (1..=SOON).map(|k| square(control(k as f64 / FPS as f64))).collect();
    score(&pictures, &control).expect("enough pictures")
}

#[test]
fn an_object_that_rests_or_moves_as_before_is_no_response() {
    // The energy of a square that moves across pixels varies a little from picture to picture.
    const UNEVEN: std::ops::Range<f64> = 0.8..1.25;
    let alike = |at: fn(f64) -> f64| scored(at, at);
    let still = alike(|_| 30.0);
    assert_eq!(still, Response { changed: None, seen: None, energy: [0.0; 2], contingency: 1.0 });
    for at in [|t| 30.0 + 6.0 * t, |t: f64| 30.0 + 3.0 * (2.0 * std::f64::consts::PI * t).sin()] {
        let moving = alike(at);
        assert!(moving.changed.is_none() && moving.seen.is_none(), "{moving:?}");
        assert!(UNEVEN.contains(&moving.contingency), "{moving:?}");
    }
    assert_eq!(score(&[square(0.0), square(1.0)], &[]), None, "two pictures are not enough");
}

#[test]
fn a_change_is_seen_in_its_first_picture() {
    for late in 1..=9 {
        // Half a pixel per picture, from that picture on.
        let begins = (f64::from(late) - 1.0) / FPS as f64;
        let moved = scored(|t| 30.0 + 15.0 * (t - begins).max(0.0), |_| 30.0);
        assert_eq!((moved.changed, moved.seen), (Some(late as usize), Some(late as usize)));
        assert!(moved.is_visible() && moved.contingency > CONTINGENT, "{moved:?}");
    }
    let too_late = scored(|t| 30.0 + 15.0 * (t - 0.35).max(0.0), |_| 30.0);
    assert!(too_late.changed.is_none() && too_late.seen.is_none() && !too_late.is_visible(), "{too_late:?}");
    // Half as fast again as before is a change, but not enough for a response.
    let faster = scored(|t| 30.0 + 6.0 * t + 3.0 * t.max(0.0), |t| 30.0 + 6.0 * t);
    assert!(faster.changed.is_some() && !faster.is_visible() && faster.contingency > 1.0, "{faster:?}");
}

#[test]
fn a_push_changes_a_swinging_object_without_standing_out() {
    let swing = |t: f64| 30.0 + 3.0 * (2.0 * std::f64::consts::PI * t).sin();
    let pushed = scored(|t| swing(t) + 3.0 * t.max(0.0), swing);
    assert!(pushed.changed.is_some() && pushed.seen.is_none() && !pushed.is_visible(), "{pushed:?}");
}

#[test]
fn random_moments_have_a_contingency_of_about_one() {
    /// Range of the median of 200 ratios.
    const ABOUT_ONE: std::ops::Range<f64> = 0.7..1.4;
    let mut random = Random::new(5);
    // A square that sways, and is pushed aside and back from time to time, within half a second.
    let pushes: Vec<f64> = (0..60).map(|i| 5.0 * f64::from(i) + random.range(1.0, 4.0)).collect();
    let pushed = |t: f64| 2.0 + 2.0 * ((t - 0.25) / 0.1).tanh();
    let place = |t: f64| {
        let shifts = pushes.iter().enumerate().map(|(i, push)| pushed(t - push) * if i % 2 == 0 { 1.0 } else { -1.0 });
        30.0 + 0.5 * (2.1 * t).sin() + shifts.sum::<f64>()
    };
    let at = |onset: f64| scored(|t| place(onset + t), |t| place(onset + t));
    let shuffled: Vec<f64> = (0..200).map(|_| at(random.range(2.0, 298.0)).contingency).collect();
    let own: Vec<f64> = pushes.iter().map(|push| at(*push).contingency).collect();
    let (own, shuffled) = (median(own).expect("some"), median(shuffled).expect("some"));
    println!("contingency {own:.1}, shuffled {shuffled:.2}");
    assert!(own >= CONTINGENT && ABOUT_ONE.contains(&shuffled), "{own} {shuffled}");
}

#[test]
fn a_day_is_the_same_for_its_seed_and_has_every_group_in_it() {
    const EIGHT_HOURS: f64 = 8.0 * 3600.0;
    let day = Day::new(3, EIGHT_HOURS, 3, Some(60.0));
    assert_eq!(format!("{day:?}"), format!("{:?}", Day::new(3, EIGHT_HOURS, 3, Some(60.0))));
    assert_ne!(format!("{day:?}"), format!("{:?}", Day::new(4, EIGHT_HOURS, 3, Some(60.0))));
    assert!(day.entries.len() >= 200, "{} visitors", day.entries.len());
    for pair in day.entries.windows(2) {
        assert!(pair[0].visit.leaves <= pair[1].visit.arrives, "one after another");
    }
    let mut groups = BTreeMap::<&str, usize>::new();
    let expecting = day.entries.iter().filter(|entry| entry.expects_response());
    expecting.flat_map(|entry| entry.visit.groups()).for_each(|group| *groups.entry(group).or_default() += 1);
    println!("{groups:?}");
    assert!(groups.values().all(|visits| *visits >= ENOUGH), "a group is too small to be judged: {groups:?}");
    assert_eq!(groups.len(), 17);
    for task in [Task::Mute, Task::Clean, Task::Unplug] {
        assert!(day.staff_tasks.iter().filter(|staff| staff.task == task).count() >= 3, "{task:?}");
        assert!(
            day.entries.iter().filter(|entry| entry.after == Some(task)).count() >= 3,
            "a visit right after {task:?}"
        );
    }
    assert!(!day.entries.iter().any(|entry| entry.during == Some(Task::Unplug) && entry.expects_response()));
    let walks = day.entries.iter().filter(|entry| entry.visit.intent == Intent::WalksAway).count();
    assert!(walks > 0 && day.attracts.len() + 1 >= walks, "{walks} walk away");
    assert!(day.changes.len() >= 6);
}

#[test]
fn a_short_day_has_staff_tasks_and_several_exhibits_too() {
    for seed in 1..20 {
        let day = Day::new(seed, 720.0, 3, Some(60.0));
        assert!(day.entries.len() >= 6, "seed {seed}: {}", day.entries.len());
        assert!(day.staff_tasks.len() >= 3 && !day.changes.is_empty(), "seed {seed}: {day:?}");
        assert!(day.entries.iter().all(|entry| entry.visit.leaves < 720.0), "seed {seed}");
    }
}

#[test]
fn a_visitor_who_sees_no_response_blows_again_from_the_same_place_and_gives_up() {
    const BREATHS: usize = 3;
    for seed in 0..40 {
        let mut visit = Visit::of(Intent::Blows, 100.0, 0.0, &mut Random::new(seed));
        let mouth = visit.breaths[0].recipe;
        while let Some(next) = visit.retry() {
            let pause = next.onset - visit.last_breath_end().expect("it blows");
            assert!((1.5..4.0).contains(&pause), "seed {seed}: {pause} s");
            let recipe = next.recipe;
            assert_eq!(
                (recipe.distance, recipe.angle_deg, recipe.attack),
                (mouth.distance, mouth.angle_deg, mouth.attack)
            );
            assert!((0.69 * mouth.speed..1.31 * mouth.speed).contains(&recipe.speed), "seed {seed}");
            assert_eq!(visit.retry().map(|breath| breath.onset), Some(next.onset), "the same the second time");
            visit.breaths.push(next);
        }
        assert_eq!((visit.breaths.len(), visit.successive_breaths().count()), (BREATHS, BREATHS), "seed {seed}");
        // Two breaths at once are one action. Visitors who then touch do not try again, and visitors who hold do not blow.
        let two = Visit::of(Intent::TwoAtOnce, 100.0, 0.0, &mut Random::new(seed));
        assert!(
            two.breaths[1].onset < two.breaths[0].end() && two.successive_breaths().all(|(i, _)| i != 1),
            "seed {seed}"
        );
        for intent in [Intent::ThenTouches, Intent::Holds, Intent::WalksAway] {
            assert!(Visit::of(intent, 100.0, 0.0, &mut Random::new(seed)).retry().is_none(), "seed {seed}");
        }
    }
}

#[test]
fn a_missing_driver_an_unknown_room_and_bad_options_are_reported() {
    let desk = Desk::new();
    desk.soffio(&["rehearse", "--hours", "0.1"]).refused(3, &["Vulkan"]);
    desk.soffio(&["rehearse", "--room", "cellar"]).refused(2, &["cellar", "gallery", "hall"]);
    desk.soffio(&["rehearse", "--hours", "0"]).refused(2, &["0.05"]);
    desk.soffio(&["rehearse", "--crowd", "nowhere"]).refused(1, &["nowhere", "check the path"]);
    assert!(desk.files().is_empty());
}

#[test]
fn a_detector_alone_runs_over_a_day_and_one_with_an_infinite_threshold_detects_nothing() {
    /// Smallest share of the first breaths that are detected within a second.
    const DETECTED: f64 = 0.9;
    const HOURS: f64 = 0.25;
    /// Length of the other days, h.
    const SHORT: f64 = 0.06;
    let report = |hours: f64, settings: &BlowSettings| {
        let rehearsal = rehearsal(hours, 3, Crowd::Made);
        run_detector(rehearsal, settings).unwrap_or_else(|error| panic!("{error}"))
    };
    let long = report(HOURS, &BlowSettings::default());
    let day = Day::new(3, 3600.0 * HOURS, 1, Site::new(&Config::default(), 3).idle_s);
    let blown = day.entries.iter().filter(|entry| entry.expects_response() && !entry.visit.breaths.is_empty());
    let onsets: Vec<f64> = blown.map(|entry| entry.visit.breaths[0].onset).collect();
    assert!(onsets.len() > 8 && long.breaths.iter().map(|breath| breath.onset_s).eq(onsets), "each once, in order");
    assert!(long.all.missed as f64 <= (1.0 - DETECTED) * long.all.breaths as f64, "{long}");
    assert!(long.all.in_time + long.all.missed <= long.all.breaths && long.all.breaths == long.breaths.len());
    let short = report(SHORT, &BlowSettings::default());
    assert!(short.all.breaths > short.all.missed, "{short}");
    assert!(short == report(SHORT, &BlowSettings::default()), "the same result with any number of threads");
    let never = Rules { on: f64::INFINITY, ..Rules::default() };
    let never = report(SHORT, &BlowSettings { rules: never, ..BlowSettings::default() });
    assert_eq!((never.all.missed, never.detected_after_s, never.false_triggers_s.len()), (short.all.breaths, None, 0));
    // A detector with a threshold that everything reaches has false triggers.
    let always = Rules { drift: [-9.0; 2], on: 0.02, ..Rules::default() };
    let always = report(SHORT, &BlowSettings { rules: always, ..BlowSettings::default() });
    assert!(!always.false_triggers_s.is_empty(), "{always}");
}

#[test]
fn the_detector_alone_needs_no_pictures() {
    let desk = Desk::new();
    let detector = |more: &[&str]| desk.soffio(&[&["rehearse", "--detector-only", "--hours", "0.05"], more].concat());
    let table = detector(&[]);
    table.done();
    assert!(table.out.contains("first breaths") && table.out.contains("false triggers: "), "{}", table.out);
    let json: serde_json::Value = serde_json::from_str(&detector(&["--json", "--capsules", "1"]).out).expect("JSON");
    assert!(json["all"]["breaths"].as_u64().is_some_and(|breaths| breaths > 0), "{json}");
    assert!(desk.files().is_empty());
    let old = desk.soffio(&["rehearse", "--ear", "--hours", "0.05"]);
    old.done();
    assert_eq!(old.out, table.out, "the old option is still read");
    assert!(old.err.contains("--ear is now called --detector-only"), "{}", old.err);
}

/// A rehearsal with a single exhibit.
fn rehearsal(hours: f64, seed: u64, crowd: Crowd) -> Rehearsal {
    let folder = exhibit::resolve("steel-fish").unwrap_or_else(|report| panic!("{report}"));
    let exhibit = Arc::new(exhibit::load(&folder).unwrap_or_else(|report| panic!("{report}")));
    let site = Site::new(&Config::default(), seed);
    Rehearsal { exhibits: vec![exhibit], site, room: "gallery".into(), capsules: 2, crowd, hours, seed }
}

fn rehearsed(rehearsal: Rehearsal) -> Report {
    run(rehearsal, &AtomicBool::new(false), |_| ()).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
#[ignore = "draws hundreds of pictures, minutes in software"]
fn some_minutes_get_responses_and_the_same_report_twice() {
    const HOURS: f64 = 0.05;
    let [report, again] = [(); 2].map(|()| rehearsed(rehearsal(HOURS, 1, Crowd::Made)));
    let json = |report: &Report| serde_json::to_string(report).expect("JSON");
    println!("{report}");
    assert_eq!(json(&report), json(&again));
    assert!(report.headline.visits >= 2 && report.headline.good >= 1, "{report}");
    assert!(report.false_triggers.is_empty() && report.staff.iter().all(|check| check.good), "{report}");
}

#[test]
#[ignore = "draws hundreds of pictures, minutes in software"]
fn a_breath_in_the_crowds_recording_is_a_false_trigger_and_misses_the_bar() {
    // The person in the recording is no visitor, so a response to that breath is a false trigger.
    let breath = Breath { lead_in: 3.0, speed: 13.0, lead_out: 25.0, ..Breath::default() };
    let samples = breath.recorded(16_000, 9);
    let recording = Recording { samples, capsules: None, sample_rate: 16_000 };
    let crowd = recorded(&[recording]).expect("long enough");
    let report = rehearsed(rehearsal(0.03, 1, crowd));
    println!("{report}");
    assert!(report.false_triggers.len() >= 2, "{:?}", report.false_triggers);
    assert!(report.failures.iter().any(|failure| failure.contains("no false trigger")), "{:?}", report.failures);
}

//! The synthetic gallery day: who comes, how pictures and loudspeaker are judged, and that a day can fail.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use soffio_config::Config;
use soffio_detector::generate::{self, BreathShape};
use soffio_detector::{BlowSettings, Rules};
use soffio_exhibit as exhibit;
use soffio_kiosk::venue::site::Site;
use soffio_math::noise::Random;
use soffio_offline::wav::Recording;
use soffio_rehearsal::day::{Day, Task};
use soffio_rehearsal::judge::{Answer, BEFORE, CONTINGENT, FPS, Picture, SOON, answer, median};
use soffio_rehearsal::report::{ENOUGH, Report};
use soffio_rehearsal::visitor::{Visit, Way};
use soffio_rehearsal::{Crowd, Rehearsal, listen, recorded, run};

use crate::cli::Desk;

/// Pixels of a drawn picture.
const SIZE: (usize, usize) = (80, 45);

/// A dark square of 9 pixels before a bright wall, `at` pixels from the left; its edges are as dark as they are covered.
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

/// Judges a square that moves as `at` says, in seconds after the onset, and without a visitor as `alone` says.
fn judged(at: impl Fn(f64) -> f64, alone: impl Fn(f64) -> f64) -> Answer {
    let pictures: Vec<Picture> =
        (0..=2 * BEFORE).map(|k| square(at((k as f64 - BEFORE as f64) / FPS as f64))).collect();
    let alone: Vec<Picture> = (1..=SOON).map(|k| square(alone(k as f64 / FPS as f64))).collect();
    answer(&pictures, &alone).expect("enough pictures")
}

#[test]
fn what_stands_still_or_goes_on_as_before_has_not_answered() {
    // A square that crosses pixels as it goes is not quite as much in each picture.
    const UNEVEN: std::ops::Range<f64> = 0.8..1.25;
    let alike = |at: fn(f64) -> f64| judged(at, at);
    let still = alike(|_| 30.0);
    assert_eq!(still, Answer { changed: None, seen: None, energy: [0.0; 2], contingency: 1.0 });
    for at in [|t| 30.0 + 6.0 * t, |t: f64| 30.0 + 3.0 * (2.0 * std::f64::consts::PI * t).sin()] {
        let moving = alike(at);
        assert!(moving.changed.is_none() && moving.seen.is_none(), "{moving:?}");
        assert!(UNEVEN.contains(&moving.contingency), "{moving:?}");
    }
    assert_eq!(answer(&[square(0.0), square(1.0)], &[]), None, "two pictures say nothing");
}

#[test]
fn a_change_is_seen_in_the_picture_in_which_it_is() {
    for late in 1..=9 {
        // Half a pixel a picture, from that picture on.
        let begins = (f64::from(late) - 1.0) / FPS as f64;
        let moved = judged(|t| 30.0 + 15.0 * (t - begins).max(0.0), |_| 30.0);
        assert_eq!((moved.changed, moved.seen), (Some(late as usize), Some(late as usize)));
        assert!(moved.is_answer() && moved.contingency > CONTINGENT, "{moved:?}");
    }
    let too_late = judged(|t| 30.0 + 15.0 * (t - 0.35).max(0.0), |_| 30.0);
    assert!(too_late.changed.is_none() && too_late.seen.is_none() && !too_late.is_answer(), "{too_late:?}");
    // Half as fast again as before is somebody's doing, and not yet an answer.
    let faster = judged(|t| 30.0 + 6.0 * t + 3.0 * t.max(0.0), |t| 30.0 + 6.0 * t);
    assert!(faster.changed.is_some() && !faster.is_answer() && faster.contingency > 1.0, "{faster:?}");
}

#[test]
fn a_push_is_found_in_what_swings_anyhow_where_it_does_not_stand_out() {
    let swing = |t: f64| 30.0 + 3.0 * (2.0 * std::f64::consts::PI * t).sin();
    let pushed = judged(|t| swing(t) + 3.0 * t.max(0.0), swing);
    assert!(pushed.changed.is_some() && pushed.seen.is_none() && !pushed.is_answer(), "{pushed:?}");
}

#[test]
fn shuffled_moments_are_as_likely_to_come_before_as_after() {
    /// Of the median of so many ratios.
    const ABOUT_ONE: std::ops::Range<f64> = 0.7..1.4;
    let mut random = Random::new(5);
    // A square that sways, and is pushed aside and back now and then, within half a second.
    let pushes: Vec<f64> = (0..60).map(|i| 5.0 * f64::from(i) + random.range(1.0, 4.0)).collect();
    let pushed = |t: f64| 2.0 + 2.0 * ((t - 0.25) / 0.1).tanh();
    let place = |t: f64| {
        let ways = pushes.iter().enumerate().map(|(i, push)| pushed(t - push) * if i % 2 == 0 { 1.0 } else { -1.0 });
        30.0 + 0.5 * (2.1 * t).sin() + ways.sum::<f64>()
    };
    let at = |onset: f64| judged(|t| place(onset + t), |t| place(onset + t));
    let shuffled: Vec<f64> = (0..200).map(|_| at(random.range(2.0, 298.0)).contingency).collect();
    let own: Vec<f64> = pushes.iter().map(|push| at(*push).contingency).collect();
    let (own, shuffled) = (median(own).expect("some"), median(shuffled).expect("some"));
    println!("contingency {own:.1}, shuffled {shuffled:.2}");
    assert!(own >= CONTINGENT && ABOUT_ONE.contains(&shuffled), "{own} {shuffled}");
}

#[test]
fn a_day_is_the_same_for_its_seed_and_has_everybody_in_it() {
    const EIGHT_HOURS: f64 = 8.0 * 3600.0;
    let day = Day::new(3, EIGHT_HOURS, 3, Some(60.0));
    assert_eq!(format!("{day:?}"), format!("{:?}", Day::new(3, EIGHT_HOURS, 3, Some(60.0))));
    assert_ne!(format!("{day:?}"), format!("{:?}", Day::new(4, EIGHT_HOURS, 3, Some(60.0))));
    assert!(day.entries.len() >= 200, "{} visitors", day.entries.len());
    for pair in day.entries.windows(2) {
        assert!(pair[0].visit.leaves <= pair[1].visit.arrives, "one after another");
    }
    let mut groups = BTreeMap::<&str, usize>::new();
    let judged = day.entries.iter().filter(|entry| entry.answered());
    judged.flat_map(|entry| entry.visit.groups()).for_each(|group| *groups.entry(group).or_default() += 1);
    println!("{groups:?}");
    assert!(groups.values().all(|visits| *visits >= ENOUGH), "a group is too small to be judged: {groups:?}");
    assert_eq!(groups.len(), 17);
    for task in [Task::Mute, Task::Clean, Task::Unplug] {
        assert!(day.duties.iter().filter(|duty| duty.task == task).count() >= 3, "{task:?}");
        assert!(
            day.entries.iter().filter(|entry| entry.after == Some(task)).count() >= 3,
            "a visit right after {task:?}"
        );
    }
    assert!(!day.entries.iter().any(|entry| entry.during == Some(Task::Unplug) && entry.answered()));
    let walks = day.entries.iter().filter(|entry| entry.visit.way == Way::WalksAway).count();
    assert!(walks > 0 && day.attracts.len() + 1 >= walks, "{walks} walk away");
    assert!(day.changes.len() >= 6);
}

#[test]
fn a_short_day_has_staff_and_other_works_too() {
    for seed in 1..20 {
        let day = Day::new(seed, 720.0, 3, Some(60.0));
        assert!(day.entries.len() >= 6, "seed {seed}: {}", day.entries.len());
        assert!(day.duties.len() >= 3 && !day.changes.is_empty(), "seed {seed}: {day:?}");
        assert!(day.entries.iter().all(|entry| entry.visit.leaves < 720.0), "seed {seed}");
    }
}

#[test]
fn whoever_sees_nothing_move_blows_again_from_the_same_place_and_gives_up() {
    const BREATHS: usize = 3;
    for seed in 0..40 {
        let mut visit = Visit::of(Way::Blows, 100.0, 0.0, &mut Random::new(seed));
        let mouth = visit.breaths[0].shape;
        while let Some(next) = visit.tries_again() {
            let pause = next.onset - visit.blown().expect("it blows");
            assert!((1.5..4.0).contains(&pause), "seed {seed}: {pause} s");
            let shape = next.shape;
            assert_eq!(
                (shape.distance, shape.angle_deg, shape.attack),
                (mouth.distance, mouth.angle_deg, mouth.attack)
            );
            assert!((0.69 * mouth.strength..1.31 * mouth.strength).contains(&shape.strength), "seed {seed}");
            assert_eq!(visit.tries_again().map(|breath| breath.onset), Some(next.onset), "the same the second time");
            visit.breaths.push(next);
        }
        assert_eq!((visit.breaths.len(), visit.separate().count()), (BREATHS, BREATHS), "seed {seed}");
        // Two at once are one doing; who touches then does not try again, and who holds does not blow.
        let two = Visit::of(Way::TwoAtOnce, 100.0, 0.0, &mut Random::new(seed));
        assert!(two.breaths[1].onset < two.breaths[0].end() && two.separate().all(|(i, _)| i != 1), "seed {seed}");
        for way in [Way::ThenTouches, Way::Holds, Way::WalksAway] {
            assert!(Visit::of(way, 100.0, 0.0, &mut Random::new(seed)).tries_again().is_none(), "seed {seed}");
        }
    }
}

#[test]
fn a_rehearsal_without_a_driver_and_one_without_a_room_say_so() {
    let desk = Desk::new();
    desk.soffio(&["rehearse", "--hours", "0.1"]).refused(3, &["Vulkan"]);
    desk.soffio(&["rehearse", "--room", "cellar"]).refused(2, &["cellar", "gallery", "hall"]);
    desk.soffio(&["rehearse", "--hours", "0"]).refused(2, &["0.05"]);
    desk.soffio(&["rehearse", "--crowd", "nowhere"]).refused(1, &["nowhere", "check the path"]);
    assert!(desk.files().is_empty());
}

#[test]
fn an_ear_alone_hears_a_day_and_a_deaf_one_hears_nobody() {
    /// Of the day's first breaths, nine of ten are heard within the second at least.
    const HEARD: f64 = 0.9;
    const HOURS: f64 = 0.25;
    /// Of the days that are heard in other ways.
    const SHORT: f64 = 0.06;
    let listened = |hours: f64, settings: &BlowSettings| {
        let rehearsal = rehearsal(hours, 3, Crowd::Made);
        listen(rehearsal, settings).unwrap_or_else(|error| panic!("{error}"))
    };
    let heard = listened(HOURS, &BlowSettings::default());
    let day = Day::new(3, 3600.0 * HOURS, 1, Site::new(&Config::default(), 3).idle_s);
    let blown = day.entries.iter().filter(|entry| entry.answered() && !entry.visit.breaths.is_empty());
    let onsets: Vec<f64> = blown.map(|entry| entry.visit.breaths[0].onset).collect();
    assert!(onsets.len() > 8 && heard.breaths.iter().map(|breath| breath.onset_s).eq(onsets), "each once, in order");
    assert!(heard.all.unheard as f64 <= (1.0 - HEARD) * heard.all.breaths as f64, "{heard}");
    assert!(heard.all.in_time + heard.all.unheard <= heard.all.breaths && heard.all.breaths == heard.breaths.len());
    let short = listened(SHORT, &BlowSettings::default());
    assert!(short.all.breaths > short.all.unheard, "{short}");
    assert!(short == listened(SHORT, &BlowSettings::default()), "the same day, heard alike, in however many threads");
    let never = Rules { on: f64::INFINITY, ..Rules::default() };
    let deaf = listened(SHORT, &BlowSettings { rules: never, ..BlowSettings::default() });
    assert_eq!((deaf.all.unheard, deaf.heard_after_s, deaf.nobody_s.len()), (short.all.breaths, None, 0));
    // A detector that is as sure of anything as of a breath has wind without one.
    let credulous = Rules { drift: -9.0, on: 0.02, ..Rules::default() };
    let credulous = listened(SHORT, &BlowSettings { rules: credulous, ..BlowSettings::default() });
    assert!(!credulous.nobody_s.is_empty(), "{credulous}");
}

#[test]
fn an_ear_alone_needs_no_pictures() {
    let desk = Desk::new();
    let listen = |more: &[&str]| desk.soffio(&[&["rehearse", "--ear", "--hours", "0.05"], more].concat());
    let table = listen(&[]);
    table.done();
    assert!(table.out.contains("first breaths") && table.out.contains("wind without breath: "), "{}", table.out);
    let json: serde_json::Value = serde_json::from_str(&listen(&["--json", "--capsules", "1"]).out).expect("JSON");
    assert!(json["all"]["breaths"].as_u64().is_some_and(|breaths| breaths > 0), "{json}");
    assert!(desk.files().is_empty());
}

/// A rehearsal of the first work alone.
fn rehearsal(hours: f64, seed: u64, crowd: Crowd) -> Rehearsal {
    let folder = exhibit::resolve("steel-fish").unwrap_or_else(|report| panic!("{report}"));
    let work = Arc::new(exhibit::load(&folder).unwrap_or_else(|report| panic!("{report}")));
    let site = Site::new(&Config::default(), seed);
    Rehearsal { works: vec![work], site, room: "gallery".into(), capsules: 2, crowd, hours, seed }
}

fn rehearsed(rehearsal: Rehearsal) -> Report {
    run(rehearsal, &AtomicBool::new(false), |_| ()).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
#[ignore = "draws hundreds of pictures, minutes in software"]
fn some_minutes_are_answered_and_the_same_the_second_time() {
    const HOURS: f64 = 0.05;
    let [report, again] = [(); 2].map(|()| rehearsed(rehearsal(HOURS, 1, Crowd::Made)));
    let json = |report: &Report| serde_json::to_string(report).expect("numbers and words");
    println!("{report}");
    assert_eq!(json(&report), json(&again));
    assert!(report.headline.visits >= 2 && report.headline.good >= 1, "{report}");
    assert!(report.phantoms.is_empty() && report.staff.iter().all(|check| check.good), "{report}");
}

#[test]
#[ignore = "draws hundreds of pictures, minutes in software"]
fn a_crowd_with_a_breath_in_it_is_answered_to_nobody_and_misses_the_bar() {
    // People in the recording are no visitors: a response to them counts as one to nobody.
    let shape = BreathShape { lead_in: 3.0, strength: 13.0, lead_out: 25.0, ..BreathShape::default() };
    let samples = generate::breath(16_000, 9, &shape);
    let recording = Recording { samples, capsules: None, sample_rate: 16_000 };
    let crowd = recorded(&[recording]).expect("long enough");
    let report = rehearsed(rehearsal(0.03, 1, crowd));
    println!("{report}");
    assert!(report.phantoms.len() >= 2, "{:?}", report.phantoms);
    assert!(report.failures.iter().any(|failure| failure.contains("nobody")), "{:?}", report.failures);
}

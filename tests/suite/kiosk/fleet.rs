//! One kiosk among many: the numbers, and how one goes on where the last one was.

use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

use soffio_config::Config;
use soffio_detector::BlowDetector;
use soffio_exhibit as exhibit;
use soffio_kiosk::fleet::metrics::{ContentVersion, MetricsInput, text};
use soffio_kiosk::fleet::persisted::{PersistedState, StateStore};
use soffio_kiosk::fleet::visits::{DWELL_S, FRAME_S, Histogram};
use soffio_kiosk::fleet::{Fleet, WindowStatus};
use soffio_kiosk::live::{LiveState, RunStatus};
use soffio_kiosk::staff::gate::{Gate, LONGEST_S};
use soffio_kiosk::step::breaths::{BreathCounts, BreathEvent, BreathSource};
use soffio_kiosk::step::stage::Stage;
use soffio_kiosk::venue::loudness::{NightBy, VolumeRequests};
use soffio_kiosk::venue::site::Overrides;
use soffio_kiosk::venue::state::VenueState;
use soffio_simulation::Settings;

fn frame(load: RunStatus) -> LiveState {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("exhibits/pendulum");
    let exhibit = Arc::new(exhibit::load(&folder).expect("the shipped exhibit is valid"));
    let stage = Stage::new(exhibit, Settings::default(), None, None);
    LiveState { hears: true, load, ..LiveState::new(&stage) }
}

#[test]
fn every_number_is_a_line_of_the_format_and_silence_is_left_out() {
    let mut load = RunStatus::default();
    load.loudness.level_db = [f64::NEG_INFINITY, -31.5];
    load.audio.xruns = 3;
    let mut kept = PersistedState { starts: 7, ..PersistedState::default() };
    kept.counters.visits = 2;
    [4.0, 70.0].into_iter().for_each(|seconds| kept.counters.dwell.record(DWELL_S, seconds));
    kept.counters.blows.insert("microphone".into(), 5);
    kept.counters.languages.insert("a\"b\\".into(), 1);
    let mut frames = Histogram::default();
    (0..10).for_each(|_| frames.record(FRAME_S, 0.016));
    let content = ContentVersion { exhibit: "pendulum", version: "00ff" };
    let text = text(
        &frame(load),
        &MetricsInput {
            persisted: &kept,
            frames: &frames,
            safe: true,
            reloads: false,
            dropped_lines: 3,
            foam_lasts: 100,
            content,
        },
    );
    for line in [
        "kiosk_up 1",
        "kiosk_starts_total 7",
        "kiosk_safe_mode 1",
        "kiosk_log_lines_dropped_total 3",
        "kiosk_last_reload_success 0",
        "kiosk_content_info{exhibit=\"pendulum\",version=\"00ff\"} 1",
        "kiosk_audio_xruns_total 3",
        "kiosk_level_day_db -31.5",
        "kiosk_sessions_total 2",
        "kiosk_dwell_seconds_bucket{le=\"5\"} 1",
        "kiosk_dwell_seconds_bucket{le=\"120\"} 2",
        "kiosk_dwell_seconds_bucket{le=\"+Inf\"} 2",
        "kiosk_dwell_seconds_sum 74",
        "kiosk_blows_total{source=\"microphone\"} 5",
        "kiosk_language_total{lang=\"a\\\"b\\\\\"} 1",
        "kiosk_frame_seconds_bucket{le=\"0.012\"} 0",
        "kiosk_frame_seconds_bucket{le=\"0.017\"} 10",
        "kiosk_solver_mode{mode=\"dynamics\"} 1",
    ] {
        assert!(text.lines().any(|other| other == line), "{line} is not in\n{text}");
    }
    assert!(!text.contains("kiosk_level_minute_db") && !text.contains("laeq"), "{text}");
    // Every sample follows the one HELP and the one TYPE of its name, and is a number.
    let mut names = Vec::new();
    for line in text.lines() {
        match line.strip_prefix("# ") {
            Some(head) => {
                let mut words = head.split(' ');
                let (word, name) = (words.next().expect("HELP or TYPE"), words.next().expect("a name"));
                if word == "HELP" {
                    assert!(!names.contains(&name), "{name} is told twice");
                    names.push(name);
                }
            }
            None => {
                let (name, value) = line.rsplit_once(' ').expect("a name and a number");
                let exported = names.last().expect("a head before the first sample");
                assert!(name.starts_with(exported) && value.parse::<f64>().is_ok(), "{line}");
                assert!(!value.contains("inf") && !value.contains("NaN"), "{line}");
            }
        }
    }
}

#[test]
fn what_the_detector_knows_of_the_room_is_persisted_every_ten_minutes() {
    let known = BlowDetector::new(48_000).ambient_spread();
    let frame = frame(RunStatus { ambient_spread: Some(known), ..RunStatus::default() });
    let mut fleet = Fleet::start(StateStore::default(), PersistedState::default(), false, &Config::default());
    let began = Instant::now();
    let mut after = |seconds| {
        let seen = WindowStatus {
            frame: &frame,
            site: &Config::default(),
            venue: &VenueState::default(),
            breath_time: &PersistedState::default().breath_time,
            language: "en",
            activity: 0,
            wrong_pins: 0,
            dropped_lines: 0,
        };
        fleet.update(began + Duration::from_secs(seconds), &seen);
        fleet.persisted().ambient_spread.clone()
    };
    assert_eq!(after(590), None, "it changes over minutes");
    assert_eq!(after(601).and_then(|persisted| persisted.ambient_spread()), Some(known));
}

#[test]
fn the_alerts_and_the_board_ask_for_numbers_that_there_are() {
    let numbers = MetricsInput {
        persisted: &PersistedState::default(),
        frames: &Histogram::default(),
        safe: false,
        reloads: true,
        dropped_lines: 0,
        foam_lasts: 5000,
        content: ContentVersion { exhibit: "pendulum", version: "" },
    };
    let mut exported = text(&frame(RunStatus::default()), &numbers);
    // These are exported only once they have a value.
    exported += "kiosk_audio_self_test_bad\nkiosk_blows_total\nkiosk_language_total\nkiosk_laeq_minute_db\nkiosk_level_minute_db\n";
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("kiosk-config/prometheus");
    let mut queried = 0;
    for file in ["soffio.rules.yml", "soffio.grafana.json"] {
        let text = std::fs::read_to_string(folder.join(file)).expect(file);
        for (at, _) in text.match_indices("kiosk_") {
            let name: String = text[at..].chars().take_while(|c| c.is_ascii_lowercase() || *c == '_').collect();
            assert!(exported.contains(&name), "{file} asks for {name}");
            queried += 1;
        }
    }
    assert!(queried > 15, "{queried}");
    let board = std::fs::read_to_string(folder.join("soffio.grafana.json")).expect("the board");
    let board: serde_json::Value = serde_json::from_str(&board).expect("JSON");
    assert!(board["panels"].as_array().is_some_and(|panels| panels.len() >= 8));
}

#[test]
fn breaths_are_counted_by_their_source_when_they_begin() {
    let mut blows = BreathCounts::default();
    blows.record(&BreathEvent::Begins(BreathSource::Hold, 3.0));
    blows.record(&BreathEvent::Ends { source: BreathSource::Hold, seconds: 1.0, peak: 3.0 });
    blows.record(&BreathEvent::Begins(BreathSource::Hold, 3.0));
    blows.record(&BreathEvent::Begins(BreathSource::Script, 3.0));
    let counts: Vec<u64> = blows.iter().map(|(_, count)| count).collect();
    assert_eq!(counts, [0, 2, 0, 1]);
}

#[test]
fn the_night_key_leads_from_the_hours_to_what_staff_had_chosen() {
    // As the loudness counts presses: the hours, night, day, and round again.
    for (by, presses) in [(NightBy::Hours, 0), (NightBy::Night, 1), (NightBy::Day, 2)] {
        assert_eq!(by.presses(), presses);
    }
    assert_eq!(VolumeRequests::default().nights, NightBy::default().presses());
}

#[test]
fn wrong_pins_are_not_forgotten_at_a_restart() {
    for (wrong, pause) in [(0, None), (1, Some(2.0)), (5, Some(32.0)), (40, Some(LONGEST_S))] {
        let mut gate = Gate::default();
        gate.remember(wrong, 100.0);
        assert_eq!((gate.pause(100.0), gate.wrong()), (pause, wrong));
    }
}

#[test]
fn what_is_made_black_from_afar_stays_black_until_it_is_woken_there_or_here() {
    let mut house = VenueState::default();
    house.set_blank(true);
    assert!(!house.is_open() && !house.accepts_input(0.0));
    house.open_early();
    assert!(house.is_open() && !house.is_blank() && !house.is_early(), "staff open it by their key");
    house.set_blank(true);
    house.set_blank(false);
    assert!(house.is_open());
}

#[test]
fn safe_mode_leaves_out_what_comes_from_outside() {
    let mut config = Config::default();
    config.mqtt.broker = "broker.museum".into();
    let safe = Overrides { safe: true, ..Overrides::default() }.apply(config.clone());
    assert!(safe.controllers.listen.is_empty() && safe.mqtt.address().is_none());
    assert_eq!(Overrides::default().apply(config.clone()), config);
}

#[test]
fn a_broker_has_a_host_a_port_and_a_topic_of_its_own() {
    let mqtt = |broker: &str, topic: &str| {
        Config::parse(&format!("[mqtt]\nbroker = {broker:?}\ntopic = {topic:?}\n"), Path::new("kiosk.toml"))
    };
    for (broker, address) in [("", None), ("10.0.0.5", Some(("10.0.0.5", 1883))), ("hub:8883", Some(("hub", 8883)))] {
        assert_eq!(mqtt(broker, "museum/hall-2").expect("good").mqtt.address(), address, "{broker}");
    }
    for (broker, topic, place) in [
        ("hub:port", "a", (2, 10)),
        (":1883", "a", (2, 10)),
        ("tcp://hub", "a", (2, 10)),
        ("hub", "", (3, 9)),
        ("hub", "a/#", (3, 9)),
    ] {
        let error = mqtt(broker, topic).expect_err("refused");
        assert_eq!(error.problems.len(), 1, "{error}");
        assert_eq!((error.problems[0].line, error.problems[0].column), place, "{error}");
    }
    let encrypted = |more: &str| Config::parse(&format!("[mqtt]\nbroker = \"hub\"\n{more}"), Path::new("kiosk.toml"));
    let good = encrypted("authority = \"ca.pem\"\n").expect("good").mqtt;
    assert_eq!(good.address(), Some(("hub", 8883)), "the port of encrypted connections");
    for half in ["certificate = \"own.pem\"\n", "certificate = \"own.pem\"\nkey = \"own.key\"\n"] {
        let error = encrypted(half).expect_err("refused");
        assert!(
            error.to_string().contains("kiosk.toml:3:") && error.to_string().contains("give certificate, key and"),
            "{error}"
        );
    }
    assert!(Config::default().mqtt.obeys.is_empty(), "a kiosk obeys nobody that its site has not named");
}

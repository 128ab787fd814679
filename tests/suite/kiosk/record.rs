//! A recorded day is run again to the bit, by the program itself.

use std::path::Path;
use std::sync::Arc;

use serde_json::Value;
use soffio_exhibit::{self as exhibit, Exhibit};
use soffio_kiosk::live::recording::Recording;
use soffio_kiosk::step::controls::Controls;
use soffio_kiosk::step::stage::Stage;
use soffio_kiosk::visitor::gesture::Press;
use soffio_offline::feed::WavFeed;
use soffio_simulation::{MotionMode, Settings};

use crate::cli::Desk;

fn shipped(id: &str) -> Arc<Exhibit> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("exhibits").join(id);
    Arc::new(exhibit::load(&folder).expect("a shipped exhibit is valid"))
}

/// A breath, a pull, position-based motion, the assembly of another exhibit, a held key, attract mode: the record, and the hashes at the
/// ends of both parts.
fn day(path: &Path) -> [String; 2] {
    let (fish, chimes) = (shipped("steel-fish"), shipped("wind-chimes"));
    let breath = WavFeed::from(&soffio_offline::wav::read(fish.folder.join("breaths/normal.wav")).expect("a breath"));
    let settings = Settings { seed: 77, breath_gain: 1.1, ..Settings::default() };
    let mut stage = Stage::new(fish.clone(), settings, Some(breath), Some(4.0));
    let mut recording = Recording::create(path).expect("writable");
    recording.begin(&fish, settings);
    let mut hashes = Vec::new();
    for step in 0..16 * 240 {
        if step == 6 * 240 {
            hashes.push(format!("{:016x}", stage.state_hash()));
            recording.end(&stage);
            stage.swap(chimes.clone(), None);
            recording.begin(&chimes, settings);
        }
        let t = f64::from(step) / 240.0;
        let during = |from: f64, to: f64| (from..to).contains(&t);
        let pull = Press { id: 3, at: [0.3 + 0.1 * (t - 4.0), 0.4] };
        stage.step(
            &Controls {
                aspect: if t < 2.0 { 16.0 / 9.0 } else { 9.0 / 16.0 },
                aim: during(1.0, 2.5).then_some([0.27 + 0.01 * t, 0.21]),
                presses: if during(4.0, 5.0) { vec![pull] } else { Vec::new() },
                mode: during(5.0, 5.5).then_some(MotionMode::PositionBased),
                hold: during(7.0, 8.0),
                strength: if during(8.5, 9.0) { 0.4 } else { 0.0 },
                ..Controls::default()
            },
            None,
        );
        recording.record(&stage);
    }
    assert!(stage.attracts(), "nobody was there for four seconds");
    hashes.push(format!("{:016x}", stage.state_hash()));
    recording.end(&stage);
    recording.finish();
    hashes.try_into().expect("two parts")
}

/// A folder with the shipped exhibits and a recorded day.
fn desk() -> (Desk, [String; 2]) {
    let desk = Desk::new();
    let exhibits = Path::new(env!("CARGO_MANIFEST_DIR")).join("exhibits");
    std::os::unix::fs::symlink(exhibits, desk.path("exhibits")).expect("a link");
    let hashes = day(&desk.path("day.jsonl"));
    (desk, hashes)
}

#[test]
fn a_recorded_day_is_run_again_to_the_bit() {
    let (desk, hashes) = desk();
    assert_eq!(desk.files(), ["day.jsonl", "exhibits"]);
    let run = desk.soffio(&["replay", "day.jsonl"]);
    let states: Vec<Value> = run
        .done()
        .lines()
        .map(|line| serde_json::from_str::<Value>(line).expect("JSON")["state_hash"].take())
        .collect();
    assert_eq!(states, hashes);
    // Hits of the chimes are in the sound of their part.
    desk.soffio(&["replay", "day.jsonl", "--part", "2", "--audio", "a.wav", "--trace", "t.csv"]).done();
    let sound = soffio_offline::wav::read(desk.path("a.wav")).expect("a sound");
    assert!(sound.samples.iter().any(|x| x.abs() > 1e-3), "the chimes are silent");
    assert!(std::fs::read_to_string(desk.path("t.csv")).expect("a trace").lines().count() > 600);
    desk.soffio(&["replay", "day.jsonl", "--audio", "b.wav"]).refused(2, &["2 parts", "--part"]);
    desk.soffio(&["replay", "day.jsonl", "--part", "3"]).refused(2, &["from 1 to 2"]);
}

#[test]
fn a_record_that_was_changed_or_cut_off_says_so() {
    let (desk, hashes) = desk();
    let text = std::fs::read_to_string(desk.path("day.jsonl")).expect("readable");
    assert!(text.len() < 200_000, "{} bytes for 16 s", text.len());
    let ends = |line: &&str| line.contains("\"speed\":0.0");
    let held = text.lines().enumerate().filter(|(_, line)| ends(line)).map(|(line, _)| line).last();
    let held = held.expect("the key was let go");
    let without: String =
        text.lines().enumerate().filter(|(line, _)| *line != held).map(|(_, line)| format!("{line}\n")).collect();
    desk.write("changed.jsonl", without);
    let changed = desk.soffio(&["replay", "changed.jsonl"]);
    assert_eq!(changed.code, Some(1), "{}", changed.err);
    for word in ["part 2 ends in", &hashes[1], "has changed since"] {
        assert!(changed.err.contains(word), "{}", changed.err);
    }
    desk.write("cut.jsonl", &text[..text.len() / 3]);
    let cut = desk.soffio(&["replay", "cut.jsonl"]);
    cut.done();
    assert!(cut.err.contains("incomplete"), "{}", cut.err);
    desk.write("broken.jsonl", text.replacen("\"pointer\":[", "\"pointer\":[null,", 1));
    desk.soffio(&["replay", "broken.jsonl"]).refused(1, &["broken.jsonl, line "]);
    desk.write("none.jsonl", "{\"t\": 1.0}\n");
    desk.soffio(&["replay", "none.jsonl"]).refused(1, &["line 1", "record"]);
}

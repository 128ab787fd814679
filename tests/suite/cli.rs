//! The program as its users meet it: the real binary, its exit codes, its words, the files it leaves.
//!
//! Every run has a folder of its own as working directory. A refusal is one message on stderr that names the place,
//! the fault and the remedy; it leaves no file, and neither it nor a success ever shows the program's inside.

use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

/// A folder of its own for one test.
pub(super) struct Desk(tempfile::TempDir);

/// What a run of the program left.
pub(super) struct Run {
    pub(super) code: Option<i32>,
    pub(super) out: String,
    pub(super) err: String,
    args: String,
}

impl Desk {
    pub(super) fn new() -> Self {
        Self(tempfile::tempdir().expect("a temporary folder"))
    }

    pub(super) fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub(super) fn write(&self, name: &str, bytes: impl AsRef<[u8]>) {
        std::fs::write(self.path(name), bytes).expect("a writable folder");
    }

    /// The program in this folder, without a screen or a graphics driver.
    pub(super) fn soffio(&self, args: &[&str]) -> Run {
        let output = Command::new(env!("CARGO_BIN_EXE_soffio"))
            .args(args)
            .current_dir(self.0.path())
            .env("RUST_BACKTRACE", "1")
            .env("VK_ICD_FILENAMES", "/nonexistent")
            .env("VK_DRIVER_FILES", "/nonexistent")
            // Nothing outlives a run at a desk; that the folder cannot be made stops nothing.
            .env("XDG_STATE_HOME", "/dev/null")
            .env_remove("STATE_DIRECTORY")
            .env_remove("RUST_LOG")
            .env_remove("DISPLAY")
            .env_remove("WAYLAND_DISPLAY")
            .output()
            .expect("the program starts");
        let text = |bytes| String::from_utf8(bytes).expect("UTF-8");
        let (out, err, args) = (text(output.stdout), text(output.stderr), args.join(" "));
        for inside in ["panicked", "stack backtrace", "RUST_BACKTRACE"] {
            assert!(!err.contains(inside), "{args}: {err}");
        }
        Run { code: output.status.code(), out, err, args }
    }

    /// Names of all that lies here, sorted.
    pub(super) fn files(&self) -> Vec<String> {
        let entries = std::fs::read_dir(self.0.path()).expect("readable").flatten();
        let mut names: Vec<_> = entries.map(|e| e.file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }

    /// The fish's folder with one text of its sidecar replaced (its first place), as `exhibit/` here.
    fn spoiled(&self, find: &str, replace: &str) -> PathBuf {
        let folder = self.path("exhibit");
        std::fs::create_dir_all(folder.join("breaths")).expect("a writable folder");
        for name in ["steel-fish.glb", "breaths/gentle.wav", "breaths/normal.wav", "breaths/strong.wav"] {
            std::fs::copy(fish().join(name), folder.join(name)).expect("shipped");
        }
        let sidecar = std::fs::read_to_string(fish().join("exhibit.toml")).expect("shipped");
        assert!(sidecar.contains(find), "the sidecar has no {find}");
        std::fs::write(folder.join("exhibit.toml"), sidecar.replacen(find, replace, 1)).expect("writable");
        folder
    }

    /// Mono 16-bit samples at `rate`.
    fn wav(&self, name: &str, rate: u32, samples: &[i16]) {
        let spec = hound::WavSpec {
            channels: 1,
            sample_rate: rate,
            bits_per_sample: 16,
            sample_format: hound::SampleFormat::Int,
        };
        let mut writer = hound::WavWriter::create(self.path(name), spec).expect("writable");
        samples.iter().for_each(|&sample| writer.write_sample(sample).expect("writable"));
        writer.finalize().expect("writable");
    }
}

impl Run {
    /// Ended with `code` and nothing on stdout, and stderr is one message with all these words.
    #[track_caller]
    pub(super) fn refused(&self, code: i32, words: &[&str]) {
        assert_eq!(self.code, Some(code), "soffio {}\n{}", self.args, self.err);
        assert_eq!(self.out, "", "soffio {}", self.args);
        let heads = self.err.lines().filter(|line| line.starts_with("soffio: ") || line.starts_with("error: ")).count();
        assert_eq!(heads, 1, "one message: {}", self.err);
        for word in words {
            assert!(self.err.contains(word), "soffio {}: no \"{word}\" in\n{}", self.args, self.err);
        }
    }

    /// Ended well; its stdout.
    #[track_caller]
    pub(super) fn done(&self) -> &str {
        assert_eq!(self.code, Some(0), "soffio {}\n{}", self.args, self.err);
        &self.out
    }

    /// Ended well; all of its stdout as JSON.
    #[track_caller]
    fn json(&self) -> Value {
        serde_json::from_str(self.done()).unwrap_or_else(|error| panic!("{error}: {}", self.out))
    }

    /// Stdout's last line as JSON.
    #[track_caller]
    fn summary(&self) -> Value {
        let line = self.out.lines().last().unwrap_or_else(|| panic!("no output: {}", self.err));
        serde_json::from_str(line).unwrap_or_else(|error| panic!("{error}: {line}"))
    }
}

fn fish() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("exhibits/steel-fish")
}

pub(super) fn text(path: &Path) -> &str {
    path.to_str().expect("UTF-8")
}

#[test]
fn a_missing_exhibit_is_named_with_those_there_are() {
    let desk = Desk::new();
    desk.soffio(&["play", "steel-fsh"]).refused(1, &["steel-fsh", "steel-fish"]);
    desk.soffio(&["explain", "steel-fsh"]).refused(1, &["steel-fsh", "steel-fish"]);
    desk.soffio(&["explain", text(&fish()), "RedPlat"]).refused(1, &["RedPlat", "\"RedPlate\""]);
    assert!(desk.files().is_empty());
}

#[test]
fn a_broken_sidecar_is_reported_with_file_line_reason_and_remedy() {
    for (find, replace, words) in [
        ("[scene]", "[scene", &["exhibit.toml:", "not TOML"][..]),
        ("loss_factor", "loss_facter", &["exhibit.toml:", "unknown key \"loss_facter\"", "\"loss_factor\""]),
        ("node = \"RedPlate\"", "node = \"RedPlat\"", &["exhibit.toml:", "no node named \"RedPlat\"", "\"RedPlate\""]),
        ("node = \"RedPlate\"", "node = \"RedPlate\"\nmass = 0", &["exhibit.toml:", "mass = 0", "0 is not above zero"]),
        ("timbre = \"plate\"", "timbre = \"plat\"", &["exhibit.toml:", "no timbre named \"plat\"", "\"plate\""]),
        ("breaths/gentle.wav", "breaths/gentl.wav", &["exhibit.toml:", "gentl.wav", "cannot be read"]),
        ("model = \"steel-fish.glb\"", "model = \"../fish.glb\"", &["exhibit.toml:", "leaves the exhibit folder"]),
    ] {
        let desk = Desk::new();
        let folder = desk.spoiled(find, replace);
        desk.soffio(&["play", text(&folder), "--audio", "out.wav"]).refused(1, words);
        assert_eq!(desk.files(), ["exhibit"], "nothing is written");
        let checked = desk.soffio(&["check", text(&folder), "--json"]);
        assert_eq!(checked.code, Some(1));
        let problems: Value = serde_json::from_str(&checked.out).expect("JSON");
        let first = &problems[0];
        assert!(first["line"].as_u64().is_some_and(|line| line > 0), "{first}");
        assert!(first["code"].as_str().is_some_and(|code| code.starts_with('E')), "{first}");
    }
}

#[test]
fn a_truncated_model_is_reported_where_the_sidecar_names_it() {
    let desk = Desk::new();
    let folder = desk.spoiled("", "");
    let model = std::fs::read(fish().join("steel-fish.glb")).expect("shipped");
    std::fs::write(folder.join("steel-fish.glb"), &model[..model.len() / 2]).expect("writable");
    desk.soffio(&["play", text(&folder)])
        .refused(1, &["exhibit.toml:", "steel-fish.glb", "a copy may have been cut short"]);
    let alone = desk.soffio(&["check", text(&folder.join("steel-fish.glb"))]);
    assert_eq!(alone.code, Some(1), "{}", alone.err);
    assert!(alone.err.contains("1 problem"), "{}", alone.err);
}

#[test]
fn a_recording_that_cannot_be_heard_is_refused_with_a_remedy() {
    let desk = Desk::new();
    desk.wav("empty.wav", 48_000, &[]);
    desk.wav("slow.wav", 4_000, &[0; 4_000]);
    desk.write("words.wav", "not a sound");
    desk.wav("whole.wav", 48_000, &[0; 480]);
    let whole = std::fs::read(desk.path("whole.wav")).expect("just written");
    desk.write("cut.wav", &whole[..whole.len() / 2]);
    let before = desk.files();
    for (file, words) in [
        ("missing.wav", &["missing.wav", "Check the path"][..]),
        ("empty.wav", &["empty.wav", "no samples"]),
        ("words.wav", &["words.wav", "not a WAV", "Convert it"]),
        ("slow.wav", &["slow.wav", "4000 Hz", "8000–192000 Hz", "Resample"]),
        ("cut.wav", &["cut.wav", "truncated"]),
    ] {
        desk.soffio(&["play", text(&fish()), "--breath", file, "--trace", "trace.csv"]).refused(1, words);
        desk.soffio(&["breath", file]).refused(1, words);
    }
    assert_eq!(desk.files(), before, "nothing is written");
}

#[test]
fn a_silent_recording_plays_and_moves_no_air() {
    let desk = Desk::new();
    desk.wav("silent.wav", 48_000, &[0; 24_000]);
    desk.soffio(&["play", text(&fish()), "--breath", "silent.wav", "--seconds", "0.5", "--events", "e.jsonl"]).done();
    let events = std::fs::read_to_string(desk.path("e.jsonl")).expect("written");
    assert!(!events.contains("\"trigger\""), "{events}");
    let heard = desk.soffio(&["breath", "silent.wav"]);
    heard.done();
    let summary = heard.summary();
    assert_eq!((&summary["blow"], &summary["onset_s"]), (&Value::Bool(false), &Value::Null));
}

#[test]
fn a_clock_by_positions_is_refused_with_the_reason() {
    let desk = Desk::new();
    let clock = Path::new(env!("CARGO_MANIFEST_DIR")).join("exhibits/terry-clock");
    for solver in ["procedural", "position-based"] {
        let run = desk.soffio(&["play", text(&clock), "--seconds", "1", "--solver", solver]);
        run.refused(2, &["terry-clock moves by dynamics alone", "gears"]);
    }
    let folder = desk.path("clock");
    std::fs::create_dir(&folder).expect("a writable folder");
    for file in std::fs::read_dir(&clock).expect("a folder").flatten() {
        std::fs::copy(file.path(), folder.join(file.file_name())).expect("a copy");
    }
    let sidecar = std::fs::read_to_string(folder.join("exhibit.toml")).expect("a sidecar");
    let sidecar = sidecar.replacen("[solver]\n", "", 1) + "\n[solver]\nmotion = \"procedural\"\n";
    std::fs::write(folder.join("exhibit.toml"), sidecar).expect("a writable folder");
    desk.soffio(&["play", "clock", "--seconds", "1"]).refused(1, &["E0266", "gears", "motion = \"dynamics\""]);
}

#[test]
fn mistyped_options_are_usage() {
    let desk = Desk::new();
    let exhibit = fish();
    let play = |args: &[&str]| desk.soffio(&[&["play", text(&exhibit)], args].concat());
    play(&["--aim", "0.5"]).refused(2, &["--aim", "0.4,0.5"]);
    play(&["--aim", "0.5,2"]).refused(2, &["--aim", "0 to 1"]);
    play(&["--size", "1280"]).refused(2, &["--size", "1280x720"]);
    play(&["--size", "0x720"]).refused(2, &["--size"]);
    play(&["--seconds", "-1"]).refused(2, &["--seconds"]);
    play(&["--seconds", "long"]).refused(2, &["--seconds", "long"]);
    play(&["--seconds", "nan"]).refused(2, &["--seconds"]);
    play(&["--fps", "0"]).refused(2, &["--fps"]);
    play(&["--lodu"]).refused(2, &["--lodu"]);
    desk.soffio(&["plya"]).refused(2, &["plya", "play"]);
    assert!(desk.files().is_empty());
}

#[test]
fn a_bad_script_line_is_named() {
    let desk = Desk::new();
    desk.write("script.jsonl", "{\"t\": 0, \"aim\": [0.5, 0.5]}\n{\"t\": 1, \"blwo\": 3}\n");
    desk.soffio(&["play", text(&fish()), "--script", "script.jsonl"]).refused(1, &["script.jsonl", "line 2", "blow"]);
    desk.soffio(&["play", text(&fish()), "--script", "none.jsonl"]).refused(1, &["none.jsonl", "check the path"]);
}

#[test]
fn an_output_without_a_folder_is_refused_and_leaves_nothing() {
    let desk = Desk::new();
    for (option, file) in [("--audio", "no/a.wav"), ("--trace", "no/a.csv"), ("--events", "no/a.jsonl")] {
        let refused = desk.soffio(&["play", text(&fish()), "--seconds", "0.1", option, file]);
        refused.refused(1, &[file, "folder"]);
    }
    desk.soffio(&["sound", "plate", "-o", "no/a.wav"]).refused(1, &["no/a.wav", "folder"]);
    desk.soffio(&["sound", "plat", "-o", "a.wav"]).refused(1, &["plat", "plate"]);
    assert!(desk.files().is_empty());
}

#[test]
fn sounds_are_rendered_and_pictured() {
    let desk = Desk::new();
    let short = ["--seconds", "0.2", "-o", "a.wav"];
    let sound = |args: &[&str]| desk.soffio(&[&["sound"], args, &short].concat());
    sound(&["scrape-wood", "--slip", "0.4", "--force", "5"]).done();
    sound(&["wind-wire", "--wind", "3", "--direction", "-90"]).done();
    sound(&["chime-brass", "--force", "20", "--speed", "1", "--set", "body.split=0"]).done();
    sound(&["wood", "--set", "body.partials=6000"]).refused(1, &["node.body.partials", "1024"]);
    desk.write("gong.toml", "timbre = 1\nname = \"gong\"\ndescription = \"\"\n[node.out]\ntype = \"nose\"\n");
    sound(&["gong.toml"]).refused(1, &["gong.toml:5", "node.out.type", "\"noise\""]);
    desk.soffio(&["sound", "clock-tick", "--page", "sheets"]).done();
    for file in ["sheets/index.html", "sheets/clock-tick.png", "sheets/clock-tick.wav"] {
        assert!(desk.path(file).metadata().expect(file).len() > 500, "{file}");
    }
}

#[cfg(feature = "kiosk")]
#[test]
fn a_picture_without_a_driver_says_what_to_install() {
    let desk = Desk::new();
    desk.soffio(&["render", text(&fish()), "-o", "a.png"]).refused(3, &["mesa-vulkan-drivers"]);
    desk.soffio(&["render", text(&fish()), "--size", "wide", "-o", "a.png"]).refused(2, &["--size", "1280x720"]);
    desk.soffio(&["render", text(&fish()), "--time", "-1", "-o", "a.png"]).refused(2, &["--time"]);
    desk.soffio(&["render", text(&fish()), "--samples", "4", "-o", "a.png"]).refused(2, &["--reference"]);
    assert!(desk.files().is_empty());
}

#[cfg(feature = "kiosk")]
#[test]
fn a_reference_picture_needs_no_driver() {
    let desk = Desk::new();
    let quick = ["--reference", "--samples", "1", "--size", "32x18", "-o", "a.png"];
    desk.soffio(&[&["render", text(&fish())], &quick[..]].concat()).done();
    assert!(desk.path("a.png").metadata().expect("the picture").len() > 500);
}

#[cfg(feature = "kiosk")]
#[test]
fn the_kiosk_without_a_display_says_so_and_demonstrates_only_if_asked() {
    let desk = Desk::new();
    let exhibit = fish();
    let kiosk = ["kiosk", "--for", "1", "--exhibit", text(&exhibit)];
    let run = desk.soffio(&kiosk);
    assert!(
        run.code == Some(3) && run.err.contains("--demo") && desk.files().is_empty(),
        "{:?}: {}",
        run.code,
        run.err
    );
    let run = desk.soffio(&[&kiosk[..], &["--demo"]].concat());
    run.done();
    assert!(run.err.contains("no display"), "{}", run.err);
    for name in ["out/steel-fish.wav", "out/steel-fish.csv"] {
        assert!(run.err.contains(name), "{name} is not named: {}", run.err);
        assert!(desk.path(name).metadata().is_ok_and(|file| file.len() > 1000), "{name}");
    }
    assert!(run.summary()["steps"].as_u64().is_some_and(|steps| steps > 0));
}

#[cfg(feature = "kiosk")]
#[test]
fn devices_and_doctor_speak_json() {
    let desk = Desk::new();
    let devices = desk.soffio(&["devices", "--json"]);
    // A computer without a sound system lacks a driver, which is reported.
    if devices.code == Some(3) {
        devices.refused(3, &[]);
    } else {
        devices.done();
        let all = devices.summary();
        assert!(["microphones", "loudspeakers", "gpus"].iter().all(|kind| all[kind].is_array()), "{all}");
        assert_eq!(all["gpus"], Value::Array(Vec::new()), "the drivers are hidden");
    }
    let doctor = desk.soffio(&["doctor", "--json"]);
    assert!(matches!(doctor.code, Some(0 | 1 | 3)), "{:?} {}", doctor.code, doctor.err);
    let findings: Vec<Value> = serde_json::from_str(&doctor.out).expect("a JSON array");
    for finding in findings {
        assert!(finding["what"].is_string() && finding["found"].is_string(), "{finding}");
        let bad = finding["health"] == "bad";
        assert!(!bad || finding["remedy"].as_str().is_some_and(|remedy| !remedy.is_empty()), "{finding}");
    }
}

#[test]
fn schemas_are_json_schemas() {
    let desk = Desk::new();
    for kind in ["exhibit", "kiosk", "timbre"] {
        let schema = desk.soffio(&["schema", kind]).json();
        assert!(schema["$schema"].as_str().is_some_and(|is| is.contains("json-schema.org")), "{kind}: {schema}");
        assert!(schema["properties"].as_object().is_some_and(|keys| !keys.is_empty()), "{kind}: {schema}");
    }
    let kiosk = desk.soffio(&["schema", "kiosk"]).json();
    for limit in soffio_config::LIMITS {
        let pointer = format!("/properties/{}", limit.key.replace('.', "/properties/"));
        let number = kiosk.pointer(&pointer).unwrap_or_else(|| panic!("no {} in {kiosk}", limit.key));
        assert_eq!((number["minimum"].as_f64(), number["maximum"].as_f64()), (Some(limit.low), Some(limit.high)));
    }
    desk.soffio(&["schema", "exhibi"]).refused(2, &["exhibit"]);
}

#[test]
fn the_shipped_files_are_good() {
    let desk = Desk::new();
    let config = Path::new(env!("CARGO_MANIFEST_DIR")).join(soffio_config::FILE);
    // A folder of exhibits is all that are in it.
    let all = fish().parent().expect("exhibits stand in a folder").to_path_buf();
    let run = desk.soffio(&["check", "--quick", text(&all), text(&fish().join("steel-fish.glb")), text(&config)]);
    run.done();
    let shipped = soffio_exhibit::ids().len();
    assert_eq!(run.err.lines().filter(|line| line.ends_with(": good")).count(), shipped + 2, "{}", run.err);
}

#[test]
fn a_configuration_is_checked_where_it_stands() {
    let desk = Desk::new();
    desk.write("site.toml", "[breath]\ngian = 2\ndistance_m = 30.0\n");
    let run = desk.soffio(&["check", "site.toml"]);
    assert_eq!(run.code, Some(1));
    for word in ["site.toml:2:1", "breath.gian", "`gain`", "site.toml:3:14", "30", "2 problems"] {
        assert!(run.err.contains(word), "{word} is missing: {}", run.err);
    }
    let json = desk.soffio(&["check", "site.toml", "--json"]);
    let problems: Value = serde_json::from_str(&json.out).expect("JSON");
    assert_eq!((&problems[0]["line"], &problems[1]["line"]), (&Value::from(2), &Value::from(3)), "{problems}");
}

#[cfg(feature = "kiosk")]
#[test]
fn a_museums_texts_are_checked_with_its_configuration_or_alone() {
    let desk = Desk::new();
    std::fs::create_dir_all(desk.path("texts")).expect("a writable folder");
    desk.write("kiosk.toml", "[visit]\nbreath = false\n");
    desk.write("texts/de.ftl", "moer = Mehr\n");
    for argument in ["kiosk.toml", "texts", "texts/de.ftl"] {
        let run = desk.soffio(&["check", argument]);
        assert_eq!(run.code, Some(1), "{argument}: {}", run.err);
        for word in ["texts/de.ftl:1:1", "unknown key `moer`", "did you mean `more`?", "E0503"] {
            assert!(run.err.contains(word), "{argument}: {word} is missing: {}", run.err);
        }
    }
    // A language that lacks texts is a warning.
    desk.write("texts/de.ftl", "more = Noch mehr\n");
    desk.write("texts/nl.ftl", "more = Meer\n");
    let run = desk.soffio(&["check", "kiosk.toml"]);
    run.done();
    assert!(run.err.contains("W0413") && run.err.contains("2 warnings"), "{}", run.err);
}

#[test]
fn explain_says_where_each_value_comes_from() {
    let desk = Desk::new();
    let run = desk.soffio(&["explain", text(&fish()), "Boom"]);
    let output = run.done();
    for words in ["body Boom", "[exhibit.toml:", "[derived: mesh × 7850 kg/m³]", "constraint cup-on-point", "boom-rod"]
    {
        assert!(output.contains(words), "no \"{words}\" in\n{output}");
    }
    assert!(!output.contains("body RedPlate"), "{output}");
}

#[test]
fn a_breath_is_summed_up_in_the_promised_fields() {
    let desk = Desk::new();
    let breath = fish().join("breaths/strong.wav");
    let run = desk.soffio(&["breath", text(&breath)]);
    run.done();
    let summary = run.summary();
    assert_eq!(summary["file"], text(&breath));
    assert_eq!(summary["blow"], true);
    let number = |key: &str| summary[key].as_f64().unwrap_or_else(|| panic!("{key}: {summary}"));
    assert!(number("peak") >= number("mean") && number("mean") > 0.0, "{summary}");
    assert!(number("onset_s") > 0.0 && number("seconds_blowing") > 0.0 && number("triggers") >= 1.0, "{summary}");
    let rows = desk.soffio(&["breath", text(&breath), "--csv"]);
    assert!(rows.done().starts_with("t,speed,confidence\n"));
    desk.soffio(&["breath", "--csv", text(&breath), text(&breath)]).refused(2, &["--csv"]);
}

#[test]
fn a_run_is_summed_up_in_the_promised_fields_and_leaves_what_was_asked() {
    let desk = Desk::new();
    let breath = fish().join("breaths/strong.wav");
    let outputs = ["--audio", "a.wav", "--trace", "t.csv", "--events", "e.jsonl"];
    let exhibit = fish();
    let args = ["play", text(&exhibit), "--breath", text(&breath), "--seconds", "0.5", "--seed", "7"];
    let run = desk.soffio(&[&args[..], &outputs].concat());
    run.done();
    let summary = run.summary();
    for key in [
        "steps",
        "wall_s",
        "cpu_s",
        "real_time_factor",
        "max_joint_error_m",
        "energy_j",
        "impacts",
        "solver_switches",
        "peak_dbfs",
        "lufs",
        "profile",
        "seed",
        "state_hash",
    ] {
        assert!(summary.get(key).is_some(), "no {key} in {summary}");
    }
    assert_eq!((&summary["steps"], &summary["seed"]), (&Value::from(120), &Value::from(7)));
    assert_eq!(summary["profile"], "gallery");
    assert_eq!(desk.files(), ["a.wav", "e.jsonl", "t.csv"]);
    let trace = std::fs::read_to_string(desk.path("t.csv")).expect("written");
    assert!(trace.starts_with("t,body,x,y,z,qw,qx,qy,qz\n"), "{}", trace.lines().next().unwrap_or_default());
}

#[test]
fn dynamics_and_position_based_motion_are_compared_in_numbers_a_table_and_a_picture() {
    let desk = Desk::new();
    let breath = fish().join("breaths/strong.wav");
    let exhibit = fish();
    let args = ["play", text(&exhibit), "--breath", text(&breath), "--seconds", "3", "--fps", "30", "--compare"];
    let compare = |more: &[&str]| {
        let run = desk.soffio(&[&args[..], more].concat());
        run.done();
        run.summary()
    };
    let summary = compare(&["--out", "apart.csv", "--plot", "apart.png"]);
    let number = |key: &str| summary[key].as_f64().unwrap_or_else(|| panic!("{key}: {summary}"));
    assert_eq!((&summary["solver"], &summary["steps"]), (&"position-based".into(), &Value::from(720)));
    assert!(number("rms_m") > 0.0 && number("rms_m") <= number("max_m") && number("max_m") < 0.6, "{summary}");
    assert!(number("rms_deg") > 0.0 && number("rms_deg") <= number("max_deg"), "{summary}");
    assert!(number("apart_1mm_s") > 0.0 && number("energy_max_j") >= number("energy_rms_j"), "{summary}");
    assert_eq!(summary["faults"], serde_json::json!([0, 0]));
    assert_eq!(desk.files(), ["apart.csv", "apart.png"]);
    let picture = image::open(desk.path("apart.png")).expect("a picture").into_rgb8();
    assert!(picture.pixels().any(|pixel| pixel.0 != picture.get_pixel(0, 0).0), "the picture is empty");
    let table = std::fs::read_to_string(desk.path("apart.csv")).expect("written");
    let mut lines = table.lines();
    let head = "t,rms_m,max_m,rms_deg,max_deg,energy_dynamics_j,energy_other_j,events_dynamics,events_other";
    assert_eq!(lines.next(), Some(head));
    let rows: Vec<Vec<f64>> =
        lines.map(|line| line.split(',').map(|cell| cell.parse().expect("a number")).collect()).collect();
    assert_eq!(rows.len(), 91, "a row a frame");
    assert_eq!(rows[0][..5], [0.0; 5], "both begin alike");
    assert!(rows.iter().all(|row| row[1] <= row[2] && row[2] <= number("max_m")), "{table}");
    assert_eq!(rows[90][7..], [number("events_dynamics"), number("events_other")]);
    // The source's rule is another motion than all joints at once, and keeps as near to the laws.
    let other = compare(&["--solver", "procedural"]);
    assert_eq!(other["solver"], "procedural");
    let rms = |of: &Value| of["rms_m"].as_f64().expect("a number");
    assert!(rms(&other) != rms(&summary) && rms(&other) < 2.0 * rms(&summary), "{other}\n{summary}");
    desk.soffio(&["play", "x", "--compare", "--trace", "t.csv"]).refused(2, &["--trace"]);
    desk.soffio(&["play", "x", "--plot", "t.png"]).refused(2, &["--compare"]);
    desk.soffio(&[&args[..], &["--solver", "dynamics"]].concat()).refused(2, &["position-based"]);
}

#[test]
fn a_scene_is_measured_with_every_field() {
    let desk = Desk::new();
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cases/scenes/pendulum.json");
    let run = desk.soffio(&["bench", "--scene", text(&scene), "--seconds", "3", "--json"]);
    let row = run.json();
    let is = |key: &str| row.get(key).unwrap_or_else(|| panic!("no {key} in {row}"));
    assert_eq!(
        (is("engine"), is("config"), is("scene")),
        (&"soffio".into(), &"auto/sparse".into(), &"pendulum".into())
    );
    assert_eq!((is("n"), is("sim_s"), is("diverged_at_s")), (&1.into(), &3.0.into(), &Value::Null));
    assert_eq!(is("repeat_bitwise"), &Value::Bool(true));
    assert!(is("version").is_string());
    for key in ["dt", "us_per_step", "us_per_sim_s", "timed_steps", "substeps"] {
        assert!(is(key).as_f64().is_some_and(|value| value > 0.0), "{key}: {row}");
    }
    for (key, most) in [
        ("max_joint_err_m", 1e-9),
        ("max_energy_drift_rel", 1e-5),
        ("final_energy_drift_rel", 1e-5),
        ("s5_period_err_ppm", 1.0),
        ("s5_period_err_hermite_ppm", 1.0),
    ] {
        assert!(is(key).as_f64().is_some_and(|value| value.abs() < most), "{key}: {row}");
    }
    assert!(is("s5_amplitude_ratio").as_f64().is_some_and(|ratio| (ratio - 1.0).abs() < 1e-3), "{row}");
    assert!(row.get("s4_speed_rel_err").is_none(), "{row}");
    let table = desk.soffio(&["bench", "--scene", text(&scene), "--seconds", "3", "--dt", "0.01"]);
    assert!(table.done().contains("0.010000"), "{}", table.out);
    assert!(desk.files().is_empty());
}

#[test]
fn the_wind_on_ten_thousand_patches_is_twenty_times_faster_than_asking_every_triangle() {
    /// ms on one core; a debug build may take twice as long as the release build is allowed.
    const BUDGET: f64 = 8.0;
    let row = Desk::new().soffio(&["bench", "--wind", "--json"]).json();
    println!("{row}");
    assert!(row["patches"].as_u64() >= Some(10_000) && row["triangles"].as_u64() >= Some(5_000), "{row}");
    assert!(
        row["ms_per_step"].as_f64().expect("ms") <= BUDGET && row["ratio"].as_f64().expect("a ratio") >= 20.0,
        "{row}"
    );
    assert!(row["seen"].as_f64().expect("a count") > 1_000.0, "{row}");
}

#[test]
fn a_mobile_of_127_joints_is_dragged_in_three_passes_a_frame_with_the_joints_closed() {
    /// µs a frame; a debug build may take six times what the release build is allowed.
    const BUDGET: f64 = 270.0;
    let run = Desk::new().soffio(&["bench", "--procedural", "breaking-chain", "--seconds", "1", "--json"]);
    let rows: Vec<Value> = run.done().lines().map(|line| serde_json::from_str(line).expect("JSON")).collect();
    println!("{}", run.out);
    let [drag, rule, beside] = &rows[..] else { panic!("three rows: {}", run.out) };
    let number = |row: &Value, key: &str| row[key].as_f64().unwrap_or_else(|| panic!("no {key} in {row}"));
    assert_eq!(
        (&drag["joints"], &drag["method"], &rule["method"]),
        (&127.into(), &"position-based".into(), &"procedural".into())
    );
    assert!(number(drag, "residual_m") <= 1e-6 && number(drag, "missed_m") <= 1e-6, "{drag}");
    assert!(number(drag, "most_passes") <= 4.0 && number(drag, "median_us") <= BUDGET, "{drag}");
    assert!(number(rule, "residual_m") <= 1e-6, "{rule}");
    // Places are cheaper than laws.
    assert!(number(beside, "position_based_ratio") < 1.0, "{beside}");
}

#[cfg(feature = "kiosk")]
#[test]
fn pictures_are_measured_by_the_processor_time_of_all_threads() {
    const NO_DRIVER: Option<i32> = Some(3);
    let args = ["bench", "pendulum", "--picture", "320x180", "--seconds", "0.1", "--json"];
    let desk = Desk::new();
    desk.soffio(&args).refused(3, &["no graphics adapter", "mesa-vulkan-drivers"]);
    desk.soffio(&["bench", "--picture", "0x5"]).refused(2, &["no size"]);
    desk.soffio(&["bench", "--picture", "320x180", "--wind"]).refused(2, &["--wind"]);
    // With a driver, where the machine has one.
    let run = Command::new(env!("CARGO_BIN_EXE_soffio")).args(args).output().expect("the program starts");
    let found = if run.status.code() == NO_DRIVER { Err(String::from_utf8_lossy(&run.stderr)) } else { Ok(()) };
    if crate::require::require("Vulkan driver", found).is_none() {
        return;
    }
    let row: Value = serde_json::from_slice(&run.stdout).expect("JSON");
    println!("{row}");
    assert_eq!((&row["exhibit"], &row["pictures"], &row["msaa"]), (&"pendulum".into(), &6.into(), &4.into()));
    assert_eq!((&row["width"], &row["height"]), (&320.into(), &180.into()));
    for key in ["light_cpu_ms", "light_ms", "full_cpu_ms", "full_ms"] {
        assert!(row[key].as_f64().is_some_and(|ms| ms > 0.0 && ms.is_finite()), "{key}: {row}");
    }
}

#[test]
fn a_scene_that_is_none_is_refused() {
    let desk = Desk::new();
    desk.write("words.json", "not a scene");
    desk.write("other.json", "{\"format\": 3}");
    desk.soffio(&["bench", "--scene", "missing.json"]).refused(1, &["missing.json", "Check the path"]);
    desk.soffio(&["bench", "--scene", "words.json"]).refused(1, &["words.json:1:"]);
    desk.soffio(&["bench", "--scene", "other.json"]).refused(1, &["other.json:1:", "string"]);
    desk.soffio(&["bench", "steel-fish", "--scene", "words.json"]).refused(2, &["--scene"]);
    desk.soffio(&["bench", "--linear", "--scene", "words.json"]).refused(2, &["--linear"]);
    desk.soffio(&["bench", "--dt", "0.1"]).refused(2, &["--scene"]);
    desk.soffio(&["bench", "--scene", "words.json", "--dt", "0"]).refused(2, &["--dt"]);
}

#[test]
fn a_pin_becomes_the_line_that_the_configuration_takes() {
    let desk = Desk::new();
    desk.soffio(&["pin"]).refused(1, &["6 to 12 digits"]);
    desk.write("digits", "271828\n");
    let digits = std::fs::File::open(desk.path("digits")).expect("written");
    let output = Command::new(env!("CARGO_BIN_EXE_soffio")).arg("pin").stdin(digits).output().expect("it starts");
    let line = String::from_utf8(output.stdout).expect("UTF-8");
    assert!(output.status.success() && line.starts_with("pin = \"$argon2id$") && !line.contains("271828"), "{line}");
    desk.write("site.toml", format!("[staff]\n{line}"));
    desk.soffio(&["check", "site.toml"]).done();
    let config = soffio_config::Config::load(Some(&desk.path("site.toml"))).expect("good").config;
    assert!(config.staff.pin.matches("271828"));
}

#[test]
fn exports_are_written_whole_and_name_what_they_leave_out() {
    let desk = Desk::new();
    let exhibit = fish();
    desk.soffio(&["export", text(&exhibit)]).refused(2, &["--gltf", "--mjcf"]);
    desk.soffio(&["export", text(&exhibit), "--gltf", "a.glb", "--mjcf", "a.xml"]).refused(2, &["cannot be used with"]);
    desk.soffio(&["export", text(&exhibit), "--gltf", "no/a.glb", "--seconds", "0.1"]).refused(1, &["no folder no"]);
    desk.soffio(&["export", text(&exhibit), "--gltf", "a.glb", "--seconds", "1e5"]).refused(2, &["600"]);
    assert!(desk.files().is_empty());
    let model = desk.soffio(&["export", text(&exhibit), "--mjcf", "a.xml"]);
    model.done();
    for words in ["left out: cup-on-point: ", "left out: air: ", "left out: red-on-b2: friction"] {
        assert!(model.err.contains(words), "no \"{words}\" in {}", model.err);
    }
    desk.soffio(&["export", text(&exhibit), "--gltf", "a.glb", "--seconds", "0.2"]).done();
    assert_eq!(desk.files(), ["a.glb", "a.xml"]);
    desk.soffio(&["check", "a.glb"]).done();
}

#[test]
fn a_graphics_driver_writes_no_errors_where_there_is_no_session() {
    let desk = Desk::new();
    let mut command = Command::new(env!("CARGO_BIN_EXE_soffio"));
    command.args(["render", text(&fish()), "--size", "64x64", "-o", text(&desk.path("a.png"))]);
    for variable in ["XDG_RUNTIME_DIR", "DISPLAY", "WAYLAND_DISPLAY", "NODEVICE_SELECT"] {
        command.env_remove(variable);
    }
    let output = command.output().expect("the program starts");
    let said = String::from_utf8_lossy(&output.stderr);
    // Without a driver there is no picture, but no word about the session either.
    assert!([Some(0), Some(3)].contains(&output.status.code()), "{said}");
    assert!(!said.contains("XDG_RUNTIME_DIR"), "{said}");
}

//! The tool's binary: exit codes, messages and written files.

use std::path::PathBuf;
use std::process::Command;

/// Largest rounding error of a table with four decimal places, and of a sum.
const FOUR_PLACES: f64 = 0.500_1e-4;

/// Temporary folder of one test.
struct Desk(tempfile::TempDir);

/// Result of a run of the tool.
struct Run {
    code: Option<i32>,
    out: String,
    err: String,
}

impl Desk {
    fn new() -> Self {
        Self(tempfile::tempdir().expect("a temporary folder"))
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn write(&self, name: &str, bytes: impl AsRef<[u8]>) {
        std::fs::write(self.path(name), bytes).expect("a writable folder");
    }

    fn run(&self, args: &[&str]) -> Run {
        let tool = Command::new(env!("CARGO_BIN_EXE_soffio-training")).args(args).current_dir(self.0.path()).output();
        let output = tool.expect("the tool starts");
        let text = |bytes| String::from_utf8(bytes).expect("UTF-8");
        Run { code: output.status.code(), out: text(output.stdout), err: text(output.stderr) }
    }
}

impl Run {
    #[track_caller]
    fn done(&self) {
        assert_eq!(self.code, Some(0), "{}", self.err);
    }

    /// Checks that it ended with `code`, an empty stdout, and all these words on stderr.
    #[track_caller]
    fn refused(&self, code: i32, words: &[&str]) {
        assert_eq!((self.code, self.out.as_str()), (Some(code), ""), "{}", self.err);
        for word in words {
            assert!(self.err.contains(word), "no \"{word}\" in\n{}", self.err);
        }
    }
}

/// The shipped table of two capsules, and one whose weights are all zero.
fn tables_of_two_capsules() -> (String, String) {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../detector/dual_mic_table.rs");
    let shipped = std::fs::read_to_string(path).expect("a table");
    let (scales, weights) = shipped.split_once("weights:").expect("weights");
    let nothing: String = weights.chars().map(|c| if c.is_ascii_digit() { '0' } else { c }).collect();
    let blank = format!("{scales}weights:{nothing}");
    (shipped, blank)
}

#[test]
fn a_table_is_scored_before_it_replaces_the_shipped_one() {
    let desk = Desk::new();
    let score = |tables: &[&str]| {
        let options = ["score", "--generated", "--stereo", "--only", "between two capsules", "--hours", "0.002"];
        let tables = tables.iter().flat_map(|table| ["--table", table]);
        desk.run(&options.into_iter().chain(tables).collect::<Vec<_>>())
    };
    let (shipped, blank) = tables_of_two_capsules();
    desk.write("shipped.rs", &shipped);
    let (own, given) = (score(&[]), score(&["shipped.rs"]));
    own.done();
    given.done();
    assert_eq!(own.out, given.out, "the same table, the same scores");
    // Weights of 0: no frame is likely, so no breath is detected.
    desk.write("zero.rs", blank);
    let zero = score(&["zero.rs"]);
    zero.done();
    assert!(zero.out != own.out && zero.out.contains("  0.0 % ["), "{}", zero.out);
    desk.write("cut.rs", &shipped[..shipped.len() / 2]);
    score(&["cut.rs"]).refused(1, &["cut.rs", "finite numbers, this one"]);
    desk.write("words.rs", "not a table");
    score(&["words.rs"]).refused(1, &["words.rs", "no table of two capsules", "soffio-training train --out"]);
    score(&["missing.rs"]).refused(1, &["missing.rs"]);
}

#[test]
fn training_continues_from_the_mean_of_the_given_tables() {
    let desk = Desk::new();
    let (shipped, blank) = tables_of_two_capsules();
    desk.write("shipped.rs", &shipped);
    desk.write("blank.rs", blank);
    let train = |tables: &[&str]| {
        let options = ["train", "--capsules", "2", "--keep", "1", "--iterations", "1", "--scenarios", "1"];
        let options = options.into_iter().chain(["--size", "0.001", "--epochs", "1", "--out", "trained.rs"]);
        desk.run(&options.chain(tables.iter().copied()).collect::<Vec<_>>())
    };
    // With --keep 1 the written table is the initial one.
    train(&["--resume", "--table", "shipped.rs", "--table", "blank.rs"]).done();
    let trained = std::fs::read_to_string(desk.path("trained.rs")).expect("a table was written");
    let weights = |table: &str| -> Vec<f64> {
        let (_, weights) = table.split_once("weights:").expect("weights");
        weights.split([' ', ',', '\n', '[', ']']).filter_map(|word| word.parse().ok()).collect()
    };
    let (whole, half) = (weights(&shipped), weights(&trained));
    assert_eq!(whole.len(), half.len());
    for (whole, half) in whole.iter().zip(&half) {
        assert!((half - 0.5 * whole).abs() < FOUR_PLACES, "the mean of {whole} and nothing is not {half}");
    }
    train(&["--table", "shipped.rs"]).refused(2, &["--resume"]);
    let old = train(&["--go-on", "--table", "missing.rs"]);
    old.refused(1, &["missing.rs", "--go-on is now called --resume"]);
}

#[test]
fn the_detector_runs_over_a_rehearsed_day() {
    let desk = Desk::new();
    let day = |room: &str| desk.run(&["day", "--hours", "0.05", "--room", room, "--json"]);
    let gallery = day("gallery");
    gallery.done();
    let report: serde_json::Value = serde_json::from_str(&gallery.out).expect("one JSON object");
    assert!(report["all"]["breaths"].as_u64() > Some(0), "{report}");
    day("cathedral").refused(1, &["cathedral", "gallery"]);
    desk.run(&["day", "--table", "nowhere.rs"]).refused(1, &["nowhere.rs"]);
}

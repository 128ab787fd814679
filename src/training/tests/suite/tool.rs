//! The tool as its users meet it: the real binary, its exit codes, its words, the files it leaves.

use std::path::PathBuf;
use std::process::Command;

/// A table has four places: what it says is off by half of the last one at most, and by what a sum rounds.
const FOUR_PLACES: f64 = 0.500_1e-4;

/// A folder of its own for one test.
struct Desk(tempfile::TempDir);

/// What a run of the tool left.
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

    /// Ended with `code` and nothing on stdout, and stderr has all these words.
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
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../detector/pair_table.rs");
    let shipped = std::fs::read_to_string(path).expect("a table");
    let (scales, weights) = shipped.split_once("weights:").expect("weights");
    let nothing: String = weights.chars().map(|c| if c.is_ascii_digit() { '0' } else { c }).collect();
    let blank = format!("{scales}weights:{nothing}");
    (shipped, blank)
}

#[test]
fn a_table_of_the_ear_is_marked_before_it_takes_its_place() {
    let desk = Desk::new();
    let score = |tables: &[&str]| {
        let asked = ["score", "--generated", "--stereo", "--only", "between two capsules", "--hours", "0.002"];
        let tables = tables.iter().flat_map(|table| ["--table", table]);
        desk.run(&asked.into_iter().chain(tables).collect::<Vec<_>>())
    };
    let (shipped, blank) = tables_of_two_capsules();
    desk.write("shipped.rs", &shipped);
    let (own, given) = (score(&[]), score(&["shipped.rs"]));
    own.done();
    given.done();
    assert_eq!(own.out, given.out, "the same table, the same marks");
    // Weights of nothing at all: it holds nothing to be likely, and hears nothing.
    desk.write("deaf.rs", blank);
    let deaf = score(&["deaf.rs"]);
    deaf.done();
    assert!(deaf.out != own.out && deaf.out.contains("  0.0 % ["), "{}", deaf.out);
    desk.write("cut.rs", &shipped[..shipped.len() / 2]);
    score(&["cut.rs"]).refused(1, &["cut.rs", "finite numbers, this one"]);
    desk.write("words.rs", "not a table");
    score(&["words.rs"]).refused(1, &["words.rs", "no table of two capsules", "soffio-training train --out"]);
    score(&["missing.rs"]).refused(1, &["missing.rs"]);
}

#[test]
fn a_course_goes_on_with_the_mean_of_the_tables_it_is_given() {
    let desk = Desk::new();
    let (shipped, blank) = tables_of_two_capsules();
    desk.write("shipped.rs", &shipped);
    desk.write("blank.rs", blank);
    let go_on = |tables: &[&str]| {
        let asked = ["train", "--capsules", "2", "--keep", "1", "--lessons", "1", "--worlds", "1"];
        let asked = asked.into_iter().chain(["--size", "0.001", "--rounds", "1", "--out", "learnt.rs"]);
        desk.run(&asked.chain(tables.iter().copied()).collect::<Vec<_>>())
    };
    // All of what came before is kept, so what is written is what the course began with.
    go_on(&["--go-on", "--table", "shipped.rs", "--table", "blank.rs"]).done();
    let learnt = std::fs::read_to_string(desk.path("learnt.rs")).expect("a table was written");
    let weights = |table: &str| -> Vec<f64> {
        let (_, weights) = table.split_once("weights:").expect("weights");
        weights.split([' ', ',', '\n', '[', ']']).filter_map(|word| word.parse().ok()).collect()
    };
    let (whole, half) = (weights(&shipped), weights(&learnt));
    assert_eq!(whole.len(), half.len());
    for (whole, half) in whole.iter().zip(&half) {
        assert!((half - 0.5 * whole).abs() < FOUR_PLACES, "the mean of {whole} and nothing is not {half}");
    }
    go_on(&["--table", "shipped.rs"]).refused(2, &["--go-on"]);
    go_on(&["--go-on", "--table", "missing.rs"]).refused(1, &["missing.rs"]);
}

#[test]
fn the_detector_listens_to_a_rehearsed_day() {
    let desk = Desk::new();
    let day = |room: &str| desk.run(&["day", "--hours", "0.05", "--room", room, "--json"]);
    let heard = day("gallery");
    heard.done();
    let report: serde_json::Value = serde_json::from_str(&heard.out).expect("one JSON object");
    assert!(report["all"]["breaths"].as_u64() > Some(0), "{report}");
    day("cathedral").refused(1, &["cathedral", "gallery"]);
    desk.run(&["day", "--table", "nowhere.rs"]).refused(1, &["nowhere.rs"]);
}

//! What the fuzzer begins with, and all that it ever found, through the functions that it tries (`tests/fuzz`).

use std::path::{Path, PathBuf};

use std::time::Duration;

use cpu_time::ThreadTime;
use soffio_exhibit as exhibit;
use soffio_offline::wav;
use soffio_simulation::record::{self, Recorder};
use soffio_simulation::{Command, Settings, StepInput};

use super::exhibit::glb::{Folder, boom_and_plate};

#[path = "../fuzz/src/inputs.rs"]
mod inputs;
#[cfg(feature = "kiosk")]
#[path = "../fuzz/src/messages.rs"]
mod messages;

/// Torn inputs of each kind in an ordinary run; `SOFFIO_FUZZ_INPUTS` sets another number.
const INPUTS: u64 = 300;
/// Processor time that one input may take. In the suite other tests run beside it, and debug assertions are on.
const MOST_TIME: Duration = Duration::from_secs(4);

/// Every kind of input: files, and messages where there is a kiosk.
fn kinds() -> Vec<(&'static str, inputs::Reader)> {
    #[cfg(feature = "kiosk")]
    return [inputs::KINDS, messages::KINDS].concat();
    #[cfg(not(feature = "kiosk"))]
    inputs::KINDS.to_vec()
}

/// Files of `tests/fuzz/<of>/<kind>`.
fn files(of: &str, kind: &str) -> Vec<PathBuf> {
    let folder = Path::new("tests/fuzz").join(of).join(kind);
    let mut files: Vec<PathBuf> =
        std::fs::read_dir(folder).into_iter().flatten().map(|entry| entry.expect("a file").path()).collect();
    files.sort();
    files
}

#[test]
fn seeds_are_good_files() {
    let stored = std::fs::read("tests/fuzz/seeds/model/figure.glb").expect("a seed");
    assert!(stored == boom_and_plate(), "seeds/model/figure.glb is not the figure that the tests make");
    for file in files("seeds", "model") {
        exhibit::load_model(&file).unwrap_or_else(|report| panic!("{}", report.to_text()));
    }
    for file in files("seeds", "recording") {
        assert!(wav::read(&file).is_ok_and(|recording| recording.samples.len() == 64), "{file:?}");
    }
    for file in files("seeds", "sidecar") {
        let folder = Folder::exhibit(&boom_and_plate(), "");
        folder.write(exhibit::SIDECAR, &std::fs::read(&file).expect("a seed"));
        exhibit::load(folder.path()).unwrap_or_else(|report| panic!("{}", report.to_text()));
    }
}

#[test]
fn inputs_that_once_failed_do_not_fail_again() {
    let mut tried = 0;
    for (kind, try_it) in kinds() {
        for file in ["seeds", "found"].iter().flat_map(|of| files(of, kind)) {
            println!("{file:?}");
            let folder = Folder::exhibit(&boom_and_plate(), "");
            try_it(folder.path(), &std::fs::read(&file).expect("a file"));
            tried += 1;
        }
    }
    assert!(tried > 0);
}

#[test]
fn a_recording_of_impossible_bits_is_refused_with_a_reason() {
    let error = wav::read("tests/fuzz/found/recording/bits.wav").expect_err("544 bits a sample");
    assert!(error.to_string().contains("544 bits a sample"), "{error}");
}

#[test]
fn a_sound_of_a_body_of_unknown_material_is_reported_and_not_looked_up() {
    let folder = Folder::exhibit(&boom_and_plate(), "");
    let torn = std::fs::read("tests/fuzz/found/sidecar/unknown-material-sounds.toml").expect("what was found");
    folder.write(exhibit::SIDECAR, &torn);
    let report = exhibit::load(folder.path()).expect_err("there is no such material");
    assert!(report.to_string().contains("s:teel"), "{report}");
}

#[test]
fn a_model_that_says_it_is_shorter_than_its_header_is_refused() {
    // The file that was found has another version, too, which is said first.
    let mut found = std::fs::read("tests/fuzz/found/model/short-length.glb").expect("in the repository");
    found[4..8].copy_from_slice(&2u32.to_le_bytes());
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("short-length.glb");
    std::fs::write(&path, found).expect("writable");
    let report = exhibit::load_model(&path).expect_err("no room");
    assert!(report.to_string().contains("its length is shorter than its header"), "{report}");
}

/// A record with a line of each sort.
fn good_record() -> String {
    let mut recorder = Recorder::default();
    let grabs = [soffio_simulation::PointerGrab { id: 1, at: [0.4, 0.5], body: None }];
    let commands = [Command::Assemble(7), Command::Reset];
    let mut lines = vec![Recorder::head(), recorder.begin("figure", Settings::default())];
    let moved = StepInput { aspect: 1.5, pointer: Some([0.25, 0.75]), turn: [0.1, 0.2], ..StepInput::default() };
    lines.extend(recorder.step(0, &moved, 3.5));
    let grabbed = StepInput { pointer_grabs: &grabs, commands: &commands, ..StepInput::default() };
    lines.extend(recorder.step(4, &grabbed, 0.0));
    lines.push(Recorder::end(9, 0xf3));
    lines.join("\n") + "\n"
}

#[test]
fn the_seed_of_records_is_a_good_record_of_this_version() {
    let good = good_record();
    let stored = std::fs::read_to_string("tests/fuzz/seeds/record/good.jsonl").unwrap_or_default();
    assert_eq!(stored, good, "write the right side to tests/fuzz/seeds/record/good.jsonl");
    assert_eq!(record::parse(&stored).expect("good").len(), 1);
}

/// Random numbers (xorshift64*, Vigna 2016).
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        self.0.wrapping_mul(0x2545_f491_4f6c_dd1d)
    }

    fn below(&mut self, end: usize) -> usize {
        (self.next() >> 16) as usize % end.max(1)
    }
}

/// Texts that readers have stumbled over.
const WORDS: [&str; 24] = [
    "1e30",
    "-1e308",
    "1e309",
    "nan",
    "-inf",
    "0",
    "-0",
    "4294967296",
    "18446744073709551615",
    "-9223372036854775808",
    "\0",
    "\u{1b}[2J",
    "\u{feff}",
    "\"",
    "'",
    "<",
    ">",
    "{",
    "[",
    "]",
    "\n",
    ",,",
    "..",
    "[[[[[[[[",
];

/// Tears bytes in one to eight places: other bits, words, parts left out, doubled or moved.
fn torn(bytes: &[u8], random: &mut Random) -> Vec<u8> {
    const MOST_BYTES: usize = 1 << 16;
    let mut out = bytes.to_vec();
    for _ in 0..1 + random.below(8) {
        let at = random.below(out.len() + 1);
        let longest = 1 << random.below(9);
        let end = (at + 1 + random.below(longest)).min(out.len());
        match random.below(7) {
            0 if at < out.len() => out[at] ^= 1 << random.below(8),
            1 if at < out.len() => out[at] = random.next() as u8,
            2 => drop(out.splice(at..at, WORDS[random.below(WORDS.len())].bytes())),
            3 => drop(out.splice(at.min(end)..end, WORDS[random.below(WORDS.len())].bytes())),
            4 => drop(out.drain(at.min(end)..end)),
            5 if out.len() < MOST_BYTES => {
                let part = out[at.min(end)..end].repeat(1 + random.below(40));
                drop(out.splice(at..at, part));
            }
            _ => out.truncate(at.max(1)),
        }
    }
    out
}

/// Writes an input to a file if its trial fails.
struct KeptOnFailure<'a>(&'a Path, &'a [u8]);

impl Drop for KeptOnFailure<'_> {
    fn drop(&mut self) {
        if std::thread::panicking() {
            // The failure is reported whether or not the input can be kept.
            let _ = std::fs::write(self.0, self.1);
        }
    }
}

#[test]
fn torn_inputs_neither_panic_nor_take_long() {
    let inputs = std::env::var("SOFFIO_FUZZ_INPUTS").ok().and_then(|count| count.parse().ok()).unwrap_or(INPUTS);
    let only = std::env::var("SOFFIO_FUZZ_KIND").ok();
    for (kind, try_it) in kinds().into_iter().filter(|(kind, _)| only.as_deref().is_none_or(|only| only == *kind)) {
        let seeds: Vec<Vec<u8>> = ["seeds", "found"]
            .iter()
            .flat_map(|of| files(of, kind))
            .map(|file| std::fs::read(file).expect("a file"))
            .collect();
        if seeds.is_empty() {
            continue;
        }
        let folder = Folder::exhibit(&boom_and_plate(), "");
        let last = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("torn-{kind}"));
        for number in 0..inputs {
            let mut random = Random(number.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1);
            random.next();
            let bytes = torn(&seeds[random.below(seeds.len())], &mut random);
            let _kept = KeptOnFailure(&last, &bytes);
            let began = ThreadTime::now();
            try_it(folder.path(), &bytes);
            assert!(began.elapsed() < MOST_TIME, "{kind} {number} took {:?}: {}", began.elapsed(), last.display());
        }
    }
}

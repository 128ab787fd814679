//! What the fuzzer begins with, and all that it ever found, through the functions that it tries (`tests/fuzz`).

use std::path::{Path, PathBuf};

use soffio_exhibit as exhibit;
use soffio_offline::wav;

use super::exhibit::glb::{Folder, boom_and_plate};

#[path = "../fuzz/src/inputs.rs"]
mod inputs;

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
    for (kind, try_it) in inputs::KINDS {
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

//! The rooms of the kiosk stand in an order, and each uses only those before it.

use std::path::{Path, PathBuf};

/// All source files below a folder.
fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).expect("a folder of the source").flatten().map(|entry| entry.path());
    entries.flat_map(|path| if path.is_dir() { files(&path) } else { vec![path] }).collect()
}

#[test]
fn a_room_uses_only_the_rooms_before_it() {
    let kiosk = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/kiosk");
    let text = std::fs::read_to_string(kiosk.join("lib.rs")).expect("readable");
    let modules: Vec<&str> = text.lines().filter_map(|line| line.strip_prefix("pub mod ")?.strip_suffix(';')).collect();
    assert!(modules.len() >= 7, "{modules:?}");
    for (place, module) in modules.iter().enumerate() {
        for file in files(&kiosk.join(module)) {
            let text = std::fs::read_to_string(&file).expect("readable");
            for line in text.lines().filter(|line| !line.trim_start().starts_with("//")) {
                for later in &modules[place + 1..] {
                    let uses = line.contains(&format!("crate::{later}::"));
                    assert!(!uses, "{}: {line}: {later} comes after {module}", file.display());
                }
            }
        }
    }
}

//! No shipped timbre lies unused: each is the voice of something in the collection.

use std::collections::BTreeSet;
use std::path::Path;

use soffio_exhibit as exhibit;
use soffio_sound::timbre;

#[test]
fn every_shipped_timbre_sounds_in_some_exhibit() {
    let collection = Path::new(env!("CARGO_MANIFEST_DIR")).join("exhibits");
    let entries = std::fs::read_dir(&collection).expect("the shipped exhibits").flatten().map(|entry| entry.path());
    let mut used = BTreeSet::new();
    for folder in entries.filter(|path| path.join(exhibit::SIDECAR).is_file()) {
        let loaded = exhibit::load(&folder).unwrap_or_else(|report| panic!("{}", report.to_text()));
        for sound in &loaded.sounds {
            let instrument = &loaded.instruments[sound.instrument];
            // A file in the exhibit's folder goes before a shipped timbre of its name.
            if instrument.own.is_none() {
                used.insert(instrument.timbre.clone());
            }
        }
    }
    let unused: Vec<&str> = timbre::names().filter(|name| !used.contains(*name)).collect();
    assert!(unused.is_empty(), "no exhibit uses {unused:?}");
}

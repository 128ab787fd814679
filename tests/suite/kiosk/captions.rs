//! Captions and descriptions for visitors who cannot hear or see: every sound of every shipped exhibit has a caption, and every string
//! exists in every shipped language.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use soffio_exhibit::{self as exhibit, AttractAction, Exhibit, SoundTrigger};

/// The folders of all shipped exhibits.
pub fn folders() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("exhibits");
    let entries = std::fs::read_dir(&folder).expect("the shipped exhibits").flatten().map(|entry| entry.path());
    let mut folders: Vec<PathBuf> = entries.filter(|path| path.join(exhibit::SIDECAR).is_file()).collect();
    folders.sort();
    folders
}

fn shipped() -> Vec<Exhibit> {
    folders().iter().map(|folder| exhibit::load(folder).unwrap_or_else(|report| panic!("{report}"))).collect()
}

#[test]
fn every_sound_is_captioned_and_every_string_is_there_in_every_shipped_language() {
    let all = shipped();
    assert!(all.len() >= 29, "{} exhibits", all.len());
    let languages: BTreeSet<&str> =
        all.iter().flat_map(|exhibit| exhibit.labels.languages.iter().map(|(code, _)| code.as_str())).collect();
    let (mut missing, mut sounds, mut winds) = (Vec::new(), 0, 0);
    for exhibit in &all {
        let id = &exhibit.id;
        for sound in &exhibit.sounds {
            sounds += 1;
            winds += usize::from(sound.on == SoundTrigger::Wind);
            if sound.caption.is_none() {
                missing.push(format!("{id}: a sound has no caption"));
            }
        }
        let keys: BTreeSet<&str> = exhibit.sounds.iter().filter_map(|sound| sound.caption.as_deref()).collect();
        let shown: BTreeSet<&str> = exhibit
            .attract
            .steps
            .iter()
            .filter_map(|step| match &step.action {
                AttractAction::Show(key) => Some(key.as_str()),
                _ => None,
            })
            .collect();
        for &code in &languages {
            let Some((_, label)) = exhibit.labels.languages.iter().find(|(other, _)| other == code) else {
                missing.push(format!("{id}: no label in {code}"));
                continue;
            };
            for (what, text) in [("title", &label.title), ("body", &label.body), ("alt", &label.alt)] {
                if text.trim().is_empty() {
                    missing.push(format!("{id}: no {what} in {code}"));
                }
            }
            let has =
                |all: &[(String, String)], key: &str| all.iter().any(|(k, text)| k == key && !text.trim().is_empty());
            for key in keys.iter().filter(|key| !has(&label.caption, key)) {
                missing.push(format!("{id}: no caption {key} in {code}"));
            }
            for key in shown.iter().filter(|key| !has(&label.text, key)) {
                missing.push(format!("{id}: attract mode shows {key}, which {code} lacks"));
            }
        }
    }
    assert!(missing.is_empty(), "{}", missing.join("\n"));
    assert!(languages.len() >= 3 && sounds > 100, "{languages:?}, {sounds} sounds");
    // What is only the air is named too.
    assert!(winds > 20, "{winds} sounds of the wind");
}

#[test]
fn what_is_heard_is_another_caption_than_what_another_kind_of_sound_is() {
    // A visitor must not read "the bell rings" while only the wind blows.
    for exhibit in shipped() {
        for a in &exhibit.sounds {
            for b in exhibit.sounds.iter().filter(|b| b.on != a.on) {
                assert!(a.caption != b.caption, "{}: {:?} stands for {:?} and {:?}", exhibit.id, a.caption, a.on, b.on);
            }
        }
    }
}

//! What belongs to a configuration and stands in files of its own: the settings of staff, and the broker's password.

use std::path::Path;

use soffio_config::{Config, LoadedConfig, STAFF_FILE};

#[cfg(feature = "kiosk")]
use crate::cli::Desk;

fn layered(text: &str) -> LoadedConfig {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join(STAFF_FILE), text).expect("writable");
    let base = "[breath]\nsensitivity_db = 3.0\ngain = 2.0\n[staff]\ncloses_s = 60.0\n";
    let config = Config::parse(base, Path::new("kiosk.toml")).expect("a good file");
    LoadedConfig { config, ..LoadedConfig::default() }.with_staff_overrides(folder.path())
}

#[test]
fn settings_of_staff_lie_over_the_file_key_by_key_and_are_named() {
    let loaded = layered("[breath]\nsensitivity_db = -4.5\n[exhibits]\nshow = [\"harp\"]\n");
    assert_eq!((loaded.config.breath.sensitivity_db, loaded.config.breath.gain), (-4.5, 2.0));
    assert_eq!(loaded.config.exhibits.show, ["harp"]);
    assert_eq!(loaded.config.staff.closes_s, 60.0);
    let staff = loaded.staff.expect("a layer");
    assert_eq!(staff.keys, ["breath.sensitivity_db", "exhibits.show"]);
    let summary = staff.summary();
    assert!(summary.contains("exhibits.show") && summary.contains(STAFF_FILE), "{summary}");
    assert_eq!(layered("").staff, None, "nothing is set");
}

#[test]
fn a_broken_layer_or_one_with_other_keys_is_left_out_as_a_whole_with_its_problem() {
    for (text, word) in [
        ("[breath]\nsensitivity_db = 400.0\n", ":2:18"),
        ("[breath]\nsensitivity_db = 1.0\n[staff]\npin = \"\"\n", "`staff.pin` is no setting of the staff panel"),
        ("[breath]\nsensitivty_db = 1.0\n", "did you mean"),
        ("[breath\n", ":1:"),
    ] {
        let loaded = layered(text);
        assert_eq!(loaded.config.breath.sensitivity_db, 3.0, "{text}");
        let staff = loaded.staff.expect("a problem");
        assert!(staff.keys.is_empty() && staff.problem.is_some(), "{staff:?}");
        assert!(staff.summary().contains(word), "{word}: {}", staff.summary());
    }
}

#[test]
fn a_password_comes_from_its_own_file_and_a_missing_one_is_a_warning() {
    let folder = tempfile::tempdir().expect("a folder");
    let (file, secret) = (folder.path().join("kiosk.toml"), folder.path().join("broker.secret"));
    std::fs::write(&file, "[mqtt]\npassword_file = \"broker.secret\"\n").expect("writable");
    let loaded = Config::load(Some(&file)).expect("a good file");
    assert_eq!(loaded.config.mqtt.password, "");
    let warnings: Vec<String> = loaded.warning_texts().collect();
    assert!(warnings.len() == 1 && warnings[0].contains("broker.secret"), "{warnings:?}");
    std::fs::write(&secret, " two words \n").expect("writable");
    let loaded = Config::load(Some(&file)).expect("a good file");
    assert_eq!((loaded.config.mqtt.password.as_str(), loaded.warnings.len()), (" two words ", 0));
    std::fs::write(&file, "[mqtt]\npassword = \"a\"\npassword_file = \"broker.secret\"\n").expect("writable");
    let error = Config::load(Some(&file)).expect_err("two passwords").to_string();
    assert!(error.contains(":3:") && error.contains("mqtt.password"), "{error}");
}

#[cfg(feature = "kiosk")]
#[test]
fn explain_says_of_each_value_where_it_comes_from_and_shows_no_secret() {
    let desk = Desk::new();
    std::fs::create_dir(desk.path("state")).expect("writable");
    let state = desk.path("state").to_string_lossy().into_owned();
    desk.write(
        "site.toml",
        format!("[breath]\ngain = 2.0\nsensitivity_db = 3.0\n[mqtt]\npassword = \"open sesame\"\n[staff]\nstate = {state:?}\n"),
    );
    desk.write("state/overrides.toml", "[breath]\nsensitivity_db = -4.0\n");
    let explained = desk.soffio(&["explain", "site.toml"]);
    let line = |key: &str| {
        let line = explained.done().lines().find(|line| line.trim_start().starts_with(key));
        line.unwrap_or_else(|| panic!("no {key}: {}", explained.out)).to_owned()
    };
    assert!(line("gain").contains("2.0") && line("gain").contains("[site.toml]"), "{}", line("gain"));
    let sensitivity = line("sensitivity_db");
    assert!(sensitivity.contains("-4.0") && sensitivity.contains("staff panel"), "{sensitivity}");
    assert!(line("threshold").contains("[default]"), "{}", line("threshold"));
    assert!(!explained.out.contains("sesame") && line("password ").contains("(set)"), "{}", explained.out);
}

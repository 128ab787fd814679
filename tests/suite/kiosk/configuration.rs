//! The configuration file: defaults, ranges, located mistakes, chords.

use std::path::Path;

use soffio_config::{Chord, Config, FILE, LIMITS, Modifiers};

/// The file that is shipped.
fn shipped() -> String {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join(FILE);
    std::fs::read_to_string(&file).unwrap_or_else(|error| panic!("{}: {error}", file.display()))
}

/// What is wrong with a configuration text, as `line:column message`.
fn problems(text: &str) -> Vec<String> {
    match Config::parse(text, Path::new("kiosk.toml")) {
        Ok(_) => Vec::new(),
        Err(error) => {
            error.problems.iter().map(|p| format!("{}:{} {} {}", p.line, p.column, p.message, p.help)).collect()
        }
    }
}

#[test]
fn the_shipped_configuration_is_the_default() {
    assert_eq!(Config::parse(&shipped(), Path::new(FILE)), Ok(Config::default()));
    assert_eq!(Config::parse("", Path::new(FILE)), Ok(Config::default()), "an empty file is the default");
}

#[test]
fn the_shipped_configuration_states_every_key_and_every_range() {
    let text = shipped();
    let stated: toml::Table = toml::from_str(&text).expect("it parses");
    assert_eq!(stated, toml::Table::try_from(Config::default()).expect("it serialises"), "every key is there");
    for limit in LIMITS {
        let key = limit.key.rsplit('.').next().expect("a key");
        let line = text.lines().find(|line| line.starts_with(&format!("{key} ="))).expect(key);
        let range = format!("{} to {}", limit.low, limit.high);
        assert!(line.contains(&range), "{key} does not say \"{range}\": {line}");
        let unit = if limit.unit == "1" { "" } else { limit.unit };
        assert!(line.contains(unit), "{key} does not say {unit}: {line}");
    }
}

#[test]
fn every_number_of_the_configuration_has_a_range_that_holds_its_default() {
    fn numbers(table: &toml::Table, prefix: &str, found: &mut Vec<(String, f64)>) {
        for (name, value) in table {
            let key = format!("{prefix}{name}");
            match value {
                toml::Value::Table(table) => numbers(table, &format!("{key}."), found),
                toml::Value::Integer(value) => found.push((key, *value as f64)),
                toml::Value::Float(value) => found.push((key, *value)),
                _ => {}
            }
        }
    }
    let mut found = Vec::new();
    numbers(&toml::Table::try_from(Config::default()).expect("it serialises"), "", &mut found);
    assert_eq!(found.len(), LIMITS.len(), "{found:?}");
    for (key, value) in found {
        let limit = LIMITS.iter().find(|limit| limit.key == key).unwrap_or_else(|| panic!("{key} has no range"));
        assert!((limit.low..=limit.high).contains(&value), "{key} = {value}");
    }
}

#[test]
fn two_microphones_are_two_channels() {
    assert_eq!(problems("[audio]\nmicrophone_channel = 1\nsecond_microphone_channel = 2"), [""; 0]);
    for (first, message) in [(0, "a second microphone beside a mix"), (2, "both microphones are channel 2")] {
        let text = format!("[audio]\nmicrophone_channel = {first}\nsecond_microphone_channel = 2");
        let found = problems(&text);
        assert!(found.len() == 1 && found[0].starts_with(&format!("3:29 {message}")), "{found:?}");
    }
}

#[test]
fn a_work_is_in_one_group_and_a_group_has_a_heading() {
    let group = |heading: &str, ids: &str| format!("[[exhibits.groups]]\nheading = {heading}\nexhibits = {ids}\n");
    let mobiles = group("{ en = \"Mobiles\" }", "[\"steel-fish\"]");
    assert_eq!(problems(&format!("{mobiles}{}", group("{ it = \"Altre\" }", "[\"*\"]"))), [""; 0]);
    for (text, message) in [
        (group("{ en = \"All\" }", "[\"*\", \"steel-fish\"]"), "\"steel-fish\" is twice"),
        (group("{}", "[]"), "has no heading"),
        (group("{ en = 3 }", "[]"), "expected a string"),
        (group("{ en = \"A\" }", "[]\nwork = []"), "unknown field `work`"),
    ] {
        let found = problems(&format!("{mobiles}{text}"));
        assert!(found.len() == 1 && found[0].contains(message) && !found[0].starts_with('0'), "{text}: {found:?}");
    }
}

#[test]
fn everything_wrong_with_a_configuration_is_said_at_once_and_located() {
    let found = problems("[breath]\ngian = 2\ndistance_m = 30.0\n\n[screens]\n");
    assert_eq!(
        found,
        [
            "2:1 unknown key `breath.gian` did you mean `gain`?",
            "3:14 `breath.distance_m` is 30 m, outside 0.1 to 2 m choose a number in between; the default is 0.5 m",
            "5:2 unknown key `screens` did you mean `screen`?",
        ]
    );
}

#[test]
fn wrong_types_words_and_grammar_are_located() {
    for (text, place) in [
        ("[audio]\nvolume_db = \"loud\"\n", "2:13"),
        ("[breath]\nprofile = \"gale\"\n", "2:11"),
        ("[staff]\nchord = \"Ctrl+S\"\n", "2:9"),
        ("breath = 3\n", "1:1"),
        ("[audio\n", "1:7"),
        ("[attract]\nidle_s = nan\n", "2:10"),
    ] {
        let found = problems(text);
        assert_eq!(found.len(), 1, "{text}: {found:?}");
        assert!(found[0].starts_with(&format!("{place} ")), "{text}: {found:?}");
    }
    let found = problems("[attract]\nidle_s = \"a minute\"\n");
    assert!(found[0].ends_with("write it as the default is written: idle_s = 60.0"), "{found:?}");
}

#[test]
fn a_file_stands_over_the_defaults_key_by_key() {
    let config = Config::parse("[breath]\nprofile = \"true\"\ngain = 2\n", Path::new(FILE)).expect("it is valid");
    let settings = config.simulation_settings(7);
    assert_eq!(settings.profile, soffio_simulation::Profile::Physical);
    assert_eq!((settings.breath_gain, settings.seed), (2.0, 7));
    assert_eq!(settings.distance, Config::default().breath.distance_m, "what is not said stays");
}

#[test]
fn a_missing_configuration_says_which_and_what_to_do() {
    let error = Config::load(Some(Path::new("no/such.toml"))).expect_err("there is no such file").to_string();
    assert!(error.contains("no/such.toml") && error.contains("--config"), "{error}");
}

#[test]
fn a_chord_needs_two_modifiers_and_one_key() {
    let chord: Chord = "alt + CTRL+s".parse().expect("a chord");
    assert_eq!(chord.to_string(), "Ctrl+Alt+S");
    let (three, one) =
        (Modifiers { shift: true, ..Modifiers::CTRL_ALT }, Modifiers { alt: false, ..Modifiers::CTRL_ALT });
    assert!(chord.matches(Modifiers::CTRL_ALT, "S"));
    assert!(!chord.matches(three, "S") && !chord.matches(one, "S"));
    for bad in ["S", "Ctrl+S", "Ctrl+Alt", "Ctrl+Alt+S+T", "Ctrl+Alt+F13", "Ctrl+Alt+é", ""] {
        assert!(bad.parse::<Chord>().is_err(), "{bad:?} is no chord");
    }
}

//! Old names in files: read with a warning, known to the schema, and rewritten by `soffio check --fix`.

use std::path::Path;

use soffio_config::Config;
use soffio_exhibit::codes;
use soffio_exhibit::renamed::{FileKind, OLD_NAMES, OldName, Subject, update};
use soffio_exhibit::schema;

use crate::cli::Desk;

/// A file with one old name.
fn sample(name: &OldName) -> &'static str {
    match (name.file, name.old) {
        (FileKind::Configuration, "room") => "[room]\nlevel_db = -12 # quiet\n",
        (FileKind::Configuration, "care") => "[care]\nfoam_blows = 10\n",
        (FileKind::Configuration, "chirp_at") => "[maintenance]\nchirp_at = \"03:30\"\n",
        (FileKind::Configuration, "works") => "[[exhibits.groups]]\nheading = { en = \"All\" }\nworks = [\"*\"]\n",
        (FileKind::Configuration, "loudspeaker") => "audio = { loudspeaker = \"left\" }\n",
        (FileKind::Configuration, "second_capsule_channel") => {
            "[audio]\nmicrophone_channel = 1\nsecond_capsule_channel = 2\n"
        }
        (FileKind::Configuration, "calm") => "visit.calm = true\n",
        (FileKind::Configuration, "reads_aloud") => "[visit]\n\"reads_aloud\" = \"\"\n",
        (FileKind::Configuration, "true") => "[breath]\nprofile = \"true\"\n",
        (FileKind::Sidecar, "gathers") => "[scene]\ngathers = false\n",
        (FileKind::Sidecar, "calm") => "[wind]\ncalm = { after = \"4 s\", time = \"3 s\" }\n",
        (FileKind::Sidecar, "room") => "[wind.room]\nspeed = \"0.1 m/s\"\n[wind.room.x_own]\nroom = 1\n",
        (FileKind::Sidecar, "by_blow") => "[[clock.by_blow]]\nbody = \"Snail\"\n",
        (FileKind::Sidecar, "turn") if name.path == "clock.by_hour" => "[[clock.by_hour]]\nturn = \"30 deg\"\n",
        (FileKind::Sidecar, "turn") => "[[clock.by_strike]]\nturn = \"4 deg\"\n",
        (FileKind::Sidecar, "look") => "[[attract.step]]\nat = 1\nlook = [0, 0]\n",
        (FileKind::Sidecar, "given") => "[label.en]\ntext = { invite = \"Blow.\", given = \"{day} s\" }\n",
        (FileKind::Scene, _) => "{ \"name\": \"format\", \"format\": \"isaac-bench-scene/1\" }\n",
        _ => panic!("no sample for {name:?}"),
    }
}

#[test]
fn each_old_name_becomes_the_new_one_where_it_stands() {
    for name in OLD_NAMES {
        let old = sample(name);
        let updated = update(name.file, old);
        assert!(updated.replacements.iter().any(|change| change.name == *name), "{name:?}");
        assert!(updated.text.contains(name.new), "{name:?}: {}", updated.text);
        assert_eq!(update(name.file, &updated.text).replacements, [], "once is enough: {name:?}");
        for change in &updated.replacements {
            assert!(old[change.span.clone()].trim_matches('"') == name.old, "{name:?}: {change}");
            assert!(change.to_string().contains(&format!("now called {}", quoted(name))), "{change}");
        }
    }
    let repeated = update(FileKind::Sidecar, "[wind.room]\nspeed = 1\n[wind.room.speed.x]\n[wind.fan.room]\n");
    assert_eq!(repeated.text, "[wind.ambient]\nspeed = 1\n[wind.ambient.speed.x]\n[wind.fan.room]\n");
}

fn quoted(name: &OldName) -> String {
    match name.subject {
        Subject::Key if name.path.is_empty() => format!("`{}`", name.new),
        Subject::Key => format!("`{}.{}`", name.path, name.new),
        Subject::Word => format!("\"{}\"", name.new),
    }
}

#[test]
fn a_configuration_with_an_old_name_is_read_with_a_warning_that_names_the_new_one() {
    let file = Path::new("kiosk.toml");
    for name in OLD_NAMES.iter().filter(|name| name.file == FileKind::Configuration) {
        let old = sample(name);
        let (config, warnings) = Config::parse_with_warnings(old, file).unwrap_or_else(|error| panic!("{error}"));
        let new = update(name.file, old).text;
        assert_eq!(Config::parse_with_warnings(&new, file), Ok((config.clone(), Vec::new())), "{name:?}");
        assert_ne!(config, Config::default(), "{name:?}: the value counts");
        assert!(warnings.len() == 1 && warnings[0].message.contains(name.new), "{name:?}: {warnings:?}");
        assert!(warnings[0].line > 0 && warnings[0].help.contains("soffio check --fix kiosk.toml"), "{warnings:?}");
    }
    // Problems keep their places in the file as it is written.
    let text = "[care]\nfoam_blows = -1\n[audio]\nsecond_capsule_channel = 99 \n";
    let error = Config::parse(text, file).expect_err("two numbers are out of range").to_string();
    assert!(error.contains("kiosk.toml:2:14: ") && error.contains("kiosk.toml:4:26: "), "{error}");
}

#[test]
fn a_file_with_both_names_of_a_key_says_that_one_is_the_old_name_of_the_other() {
    for (text, place, old, new) in [
        ("[care]\n[maintenance]\n", "2:", "care", "maintenance"),
        ("[maintenance]\n[care]\n", "2:", "care", "maintenance"),
        ("[visit]\nreduced_motion = true\ncalm = true\n", "3:1", "calm", "reduced_motion"),
        ("[visit]\n\"calm\" = true\nreduced_motion = true\n", "3:1", "calm", "reduced_motion"),
    ] {
        let error = Config::parse(text, Path::new("kiosk.toml")).expect_err("the same key twice").to_string();
        let message = format!("`{new}` and `{old}` are one key: `{old}` is its old name");
        assert!(error.contains(&message) && error.contains(&format!("kiosk.toml:{place}")), "{text}: {error}");
        assert!(error.contains(&format!("keep one of the two, `{new}`")), "{error}");
    }
    // A key that stands twice by one name is another mistake, with old names nearby or without.
    for text in ["[visit]\ncalm = true\ncalm = true\n", "[care]\n[visit]\ndwell = true\ndwell = true\n"] {
        let error = Config::parse(text, Path::new("kiosk.toml")).expect_err("the same key twice").to_string();
        assert!(error.contains("duplicate key") && !error.contains("one key"), "{text}: {error}");
    }
    let desk = Desk::new();
    let folder = desk.path("steel-fish");
    copy(&root().join("exhibits/steel-fish"), &folder);
    let file = folder.join("exhibit.toml");
    let text = std::fs::read_to_string(&file).expect("readable") + "\n[wind.calm]\nafter = \"4 s\"\n";
    std::fs::write(&file, text).expect("writable");
    let run = desk.soffio(&["check", "--quick", "steel-fish"]);
    let said = &run.err;
    for words in ["`idle_damping` and `calm` are one key: `calm` is its old name", "[wind.calm]", "keep one of the two"]
    {
        assert!(said.contains(words), "no \"{words}\" in {said}");
    }
    assert!(said.contains("steel-fish: 1 problem"), "{said}");
}

/// The text with old names in the place of new ones.
fn aged(text: &str, renames: &[(&str, &str)]) -> String {
    renames.iter().fold(text.to_owned(), |text, (new, old)| {
        assert!(text.contains(new), "{new} is not in the file");
        text.replace(new, old)
    })
}

const CONFIGURATION: &[(&str, &str)] = &[
    ("\n[reverb]", "\n[room]"),
    ("\n[maintenance]", "\n[care]"),
    ("\naudio_self_test_at = ", "\nchirp_at = "),
    ("\nexhibits = [", "\nworks = ["),
    ("\noutput = ", "\nloudspeaker = "),
    ("\nsecond_microphone_channel = ", "\nsecond_capsule_channel = "),
    ("\nreduced_motion = ", "\ncalm = "),
    ("\nread_aloud = ", "\nreads_aloud = "),
];
const SIDECAR: &[(&str, &str)] = &[
    ("\n[wind.ambient]", "\n[wind.room]"),
    ("\n[wind.idle_damping]", "\n[wind.calm]"),
    ("\ncamera = [", "\nlook = ["),
];

#[test]
fn a_sidecar_with_old_names_loads_with_located_warnings() {
    let desk = Desk::new();
    let folder = desk.path("steel-fish");
    copy(&root().join("exhibits/steel-fish"), &folder);
    let good = soffio_exhibit::load(&folder).expect("the shipped exhibit");
    assert!(good.warnings.is_empty(), "{:?}", good.warnings);
    let file = folder.join("exhibit.toml");
    let old = aged(&std::fs::read_to_string(&file).expect("readable"), SIDECAR);
    std::fs::write(&file, &old).expect("writable");
    let exhibit = soffio_exhibit::load(&folder).expect("old names are read");
    assert_eq!(exhibit.winds.len(), good.winds.len());
    let found: Vec<_> = exhibit.warnings.iter().filter(|warning| warning.code == codes::OLD_NAME.name).collect();
    assert_eq!((found.len(), exhibit.warnings.len()), (4, 4), "{:?}", exhibit.warnings);
    for warning in found {
        let line = warning.location.as_ref().expect("located").line;
        let text = old.lines().nth(line - 1).expect("a line of the file");
        assert!(["[wind.room]", "[wind.calm]", "look ="].iter().any(|old| text.starts_with(old)), "{line}: {text}");
    }
}

#[test]
fn the_schemas_know_old_names_as_deprecated() {
    let deprecated = |schema: &serde_json::Value, pointer: &str| {
        let part = schema.pointer(pointer).unwrap_or_else(|| panic!("no {pointer}"));
        assert_eq!(part["deprecated"], true, "{pointer}");
    };
    let config = soffio_config::schema();
    for pointer in ["room", "care", "visit/properties/calm", "maintenance/properties/chirp_at"] {
        deprecated(&config, &format!("/properties/{pointer}"));
    }
    deprecated(&config, "/properties/exhibits/properties/groups/items/properties/works");
    let words = config["properties"]["breath"]["properties"]["profile"]["enum"].to_string();
    assert!(words.contains("physical") && words.contains("\"true\""), "{words}");
    let sidecar = schema::schema_with_old_names().to_string();
    for name in ["gathers", "by_blow", "look"] {
        assert!(sidecar.contains(&format!("\"{name}\":")), "{name}");
    }
    let plain = schema::schema().to_string();
    assert!(plain.contains("\"assembly_animation\":") && !plain.contains("\"gathers\":"));
}

#[test]
fn check_fix_rewrites_old_names_and_nothing_else() {
    let desk = Desk::new();
    let shipped = |path: &str| std::fs::read_to_string(root().join(path)).expect("it is shipped");
    copy(&root().join("exhibits/steel-fish"), &desk.path("steel-fish"));
    for (file, new, old) in [
        ("kiosk.toml", shipped("kiosk-config/kiosk.toml"), CONFIGURATION),
        ("steel-fish/exhibit.toml", shipped("exhibits/steel-fish/exhibit.toml"), SIDECAR),
        ("windows.toml", shipped("kiosk-config/kiosk.toml").replace('\n', "\r\n"), &[("[reverb]", "[room]")][..]),
    ] {
        std::fs::write(desk.path(file), aged(&new, old)).expect("writable");
        let run = desk.soffio(&["check", "--quick", "--fix", file]);
        run.done();
        let said = &run.err;
        assert_eq!(std::fs::read_to_string(desk.path(file)).expect("readable"), new, "{file}");
        assert!(old.iter().all(|(new, _)| said.contains(new.trim_matches(|c| "\n[]= ".contains(c)))), "{said}");
        // The second time there is nothing to do, and the file is not even written.
        let before = std::fs::metadata(desk.path(file)).expect("it is there").modified().expect("a time");
        let again = desk.soffio(&["check", "--quick", "--fix", file]);
        again.done();
        assert!(again.err.contains("no old names"), "{}", again.err);
        assert_eq!(std::fs::metadata(desk.path(file)).expect("it is there").modified().expect("a time"), before);
    }
    let scene = shipped("tests/cases/scenes/pendulum.json");
    std::fs::write(desk.path("pendulum.json"), &scene).expect("writable");
    desk.soffio(&["check", "--fix", "pendulum.json"]).done();
    let fixed = std::fs::read_to_string(desk.path("pendulum.json")).expect("readable");
    assert_eq!(fixed, scene.replace("isaac-bench-scene/1", "soffio-scene/1"));
}

#[test]
fn check_fix_writes_all_files_or_none() {
    let desk = Desk::new();
    let (good, both, broken) = ("[room]\nlevel_db = -9\n", "[care]\n[maintenance]\n", "[care\n");
    for bad in [both, broken] {
        std::fs::write(desk.path("good.toml"), good).expect("writable");
        std::fs::write(desk.path("bad.toml"), bad).expect("writable");
        desk.soffio(&["check", "--fix", "good.toml", "bad.toml"]).refused(1, &["bad.toml cannot be rewritten"]);
        assert_eq!(std::fs::read_to_string(desk.path("good.toml")).expect("readable"), good);
        assert_eq!(std::fs::read_to_string(desk.path("bad.toml")).expect("readable"), bad);
    }
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn copy(from: &Path, to: &Path) {
    std::fs::create_dir_all(to).expect("a folder");
    for entry in std::fs::read_dir(from).expect("a folder").flatten() {
        let target = to.join(entry.file_name());
        if entry.path().is_dir() {
            copy(&entry.path(), &target);
        } else {
            std::fs::copy(entry.path(), target).expect("copied");
        }
    }
}

//! A curator's files, changed in their place.

use std::path::Path;

use soffio_config::Config;
use soffio_exhibit as exhibit;
use soffio_kiosk::staff::edit::{Changes, Number, numbers, with_key, with_list, with_number};

fn shipped(path: &str) -> String {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join(path);
    std::fs::read_to_string(&file).unwrap_or_else(|error| panic!("{}: {error}", file.display()))
}

fn find<'a>(all: &'a [Number], of: &str, name: &str) -> &'a Number {
    let known: Vec<_> = all.iter().map(|number| (&number.of, &number.name)).collect();
    all.iter().find(|number| number.of == of && number.name == name).unwrap_or_else(|| panic!("{of} {name}: {known:?}"))
}

/// The lines that differ between two texts of as many lines.
fn differing<'a>(a: &'a str, b: &'a str) -> Vec<(&'a str, &'a str)> {
    assert_eq!(a.lines().count(), b.lines().count());
    a.lines().zip(b.lines()).filter(|(a, b)| a != b).collect()
}

#[test]
fn numbers_of_a_sidecar_are_found_by_the_names_a_curator_gave() {
    let all = numbers(&shipped("exhibits/steel-fish/exhibit.toml")).expect("it parses");
    let friction = find(&all, "constraint.nail cup-on-point", "friction.coefficient");
    assert_eq!((friction.value, friction.unit.as_str()), (0.25, ""));
    let radius = find(&all, "wire b2-wire", "radius");
    assert_eq!((radius.value, radius.unit.as_str()), (0.6, "mm"));
    assert_eq!(find(&all, "wind.ambient", "speed").unit, "m/s");
    assert_eq!(find(&all, "material.steel", "loss_factor").value, 1.5e-3);
    assert_eq!(find(&all, "scene", "level").unit, "dB");
    assert!(find(&all, "wind_surface RedPlate", "sampling.max").whole);
    for number in &all {
        assert!(!number.of.starts_with("label") && !number.of.starts_with("attract"), "{number:?}");
        assert!(!number.name.ends_with("seed"), "{number:?}");
    }
}

#[test]
fn a_number_changes_in_its_line_and_nothing_else_does() {
    let text = shipped("exhibits/steel-fish/exhibit.toml");
    for number in numbers(&text).expect("it parses") {
        let wanted = if number.whole { number.value + 1.0 } else { 1.25 * number.value + 0.001 };
        let new = with_number(&text, &number.place, wanted).unwrap_or_else(|error| panic!("{number:?}: {error}"));
        let lines = differing(&text, &new);
        assert_eq!(lines.len(), 1, "{number:?}: {lines:?}");
        let again = numbers(&new).expect("it parses");
        let now = again.iter().find(|other| other.place == number.place).expect("it is still there");
        // Four digits are written.
        assert!((now.value - wanted).abs() <= 1e-3 * wanted.abs(), "{number:?} became {now:?}");
        assert_eq!((&now.unit, now.whole), (&number.unit, number.whole));
    }
    let text = "[material.steel] # painted\nloss_factor = 1.5e-3 # rings shorter\nname = \"x\"\n";
    let place = &numbers(text).expect("it parses")[0].place;
    let new = with_number(text, place, 0.002).expect("it is there");
    assert_eq!(new, "[material.steel] # painted\nloss_factor = 0.002 # rings shorter\nname = \"x\"\n");
    assert!(with_number("[material]\n", place, 1.0).is_err(), "a table that is gone is said");
}

#[test]
fn every_number_of_every_shipped_sidecar_can_be_set() {
    let mut set = 0;
    for id in exhibit::ids() {
        let text = shipped(&format!("exhibits/{id}/exhibit.toml"));
        for number in numbers(&text).expect("it parses") {
            let new =
                with_number(&text, &number.place, number.value).unwrap_or_else(|e| panic!("{id} {number:?}: {e}"));
            assert_eq!(text.lines().count(), new.lines().count(), "{id} {number:?}");
            set += 1;
        }
    }
    assert!(set > 200, "{set} numbers");
}

#[test]
fn the_order_of_exhibits_changes_in_its_line_with_its_comment() {
    let text = shipped("kiosk-config/kiosk.toml");
    let wanted = ["terry-clock", "*", "steel-fish", "marionette"].map(str::to_owned);
    let new = with_list(&text, "exhibits", "show", &wanted).expect("it is there");
    let lines = differing(&text, &new);
    assert_eq!(lines.len(), 1, "{lines:?}");
    let (before, after) = lines[0];
    assert!(after.starts_with("show = [\"terry-clock\", \"*\", \"steel-fish\", \"marionette\"] # ids in the order"));
    assert_eq!(before.split_once('#').map(|part| part.1), after.split_once('#').map(|part| part.1));
    assert_eq!(Config::parse(&new, Path::new("kiosk.toml")).expect("good").exhibits.show, wanted);
    // A list of several lines keeps its comments.
    let many = "[exhibits]\nshow = [\n    \"a\", # the first\n    \"b\",\n]\n";
    let new = with_list(many, "exhibits", "show", &["b".into(), "a".into()]).expect("a list");
    let read: toml::Table = toml::from_str(&new).expect("it parses");
    assert_eq!(read["exhibits"]["show"].as_array().map(Vec::len), Some(2), "{new}");
    assert!(new.contains("# the first"), "{new}");
    // Where nothing stands yet it is added.
    let new = with_key("", "breath", "sensitivity_db", 6.0).expect("an empty file is good");
    assert_eq!(Config::parse(&new, Path::new("kiosk.toml")).expect("good").breath.sensitivity_db, 6.0);
}

#[test]
fn changes_are_taken_back_one_by_one_but_never_over_somebody_elses() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("exhibit.toml");
    let read = || std::fs::read_to_string(&file).expect("it is there");
    std::fs::write(&file, "a = 1.0 # one\n").expect("writable");
    let mut changes = Changes::default();
    for value in ["2.0", "3.0"] {
        changes.make(&file, |_| Ok(format!("a = {value} # one\n"))).expect("writable");
    }
    changes.make(&file, |text| Ok(text.into())).expect("nothing to do");
    assert_eq!(changes.count(), 2);
    changes.undo().expect("its own text");
    assert_eq!(read(), "a = 2.0 # one\n");
    std::fs::write(&file, "a = 7.0 # by hand\n").expect("writable");
    assert!(changes.undo().is_err_and(|error| error.contains("changed")));
    assert_eq!(read(), "a = 7.0 # by hand\n");
    let error = changes.make(&folder.path().join("none.toml"), |text| Ok(text.into())).expect_err("there is none");
    assert!(error.contains("none.toml"), "{error}");
}

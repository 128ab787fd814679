//! A new curator with the program itself: creates, explores, translates, and makes mistakes. Each mistake is reported
//! with its file, line, cause and remedy. No text, however broken, crashes the program.

use std::path::Path;

use serde_json::json;
use soffio_config::Config;
use soffio_exhibit as exhibit;
use soffio_math::noise::Random;

use super::super::cli::{Desk, text};
use super::super::exhibit::glb::{Scene, cuboid};

#[test]
fn an_exhibit_is_begun_played_translated_and_never_written_over() {
    let desk = Desk::new();
    std::fs::create_dir(desk.path("exhibits")).expect("writable");
    let new = desk.soffio(&["new", "red-mobile", "--from", "mobile", "--plates", "120x80,100,90x60"]);
    assert_eq!(new.done(), "exhibits/red-mobile\n");
    assert!(new.err.contains("Plate1: 120x80") && new.err.contains("soffio check exhibits/red-mobile"), "{}", new.err);
    let check = desk.soffio(&["check", "--quick", "red-mobile"]);
    check.done();
    assert!(check.err.contains("red-mobile: good\n"), "{}", check.err);
    desk.soffio(&["play", "red-mobile", "--no-wind", "--seconds", "0.5"]).done();
    // The second time nothing is touched.
    let sidecar = desk.path("exhibits/red-mobile/exhibit.toml");
    let before = std::fs::read(&sidecar).expect("a sidecar");
    for from in ["mobile", "empty", "clock"] {
        let more: &[&str] = if from == "mobile" { &["--plates", "90,80"] } else { &[] };
        let again = desk.soffio(&[&["new", "red-mobile", "--from", from], more].concat());
        again.refused(1, &["red-mobile", "is there already", "another id"]);
    }
    assert_eq!(std::fs::read(&sidecar).expect("a sidecar"), before);
    // Labels to a table and back.
    desk.soffio(&["labels", "red-mobile", "--csv", "words.csv"]).done();
    let table = std::fs::read_to_string(desk.path("words.csv")).expect("a table");
    let same = desk.soffio(&["labels", "red-mobile", "--from", "words.csv"]);
    same.done();
    assert!(same.err.contains("nothing has changed"), "{}", same.err);
    assert_eq!(std::fs::read(&sidecar).expect("a sidecar"), before);
    assert!(table.contains("Mobile (replace this title)"), "{table}");
    desk.write("new.csv", "key,en,fr\ntitle,Red leaves,Feuilles rouges\nalt,Five leaves.,Cinq feuilles.\n");
    let read = desk.soffio(&["labels", "red-mobile", "--from", "new.csv"]);
    read.done();
    for words in ["\"ko\" has no column", "\"body\" has no row", "4 texts changed"] {
        assert!(read.err.contains(words), "{words}: {}", read.err);
    }
    let output = desk.soffio(&["check", "--quick", "red-mobile"]);
    output.done();
    assert!(output.err.contains("missing in \"fr\""), "what is left to translate: {}", output.err);
    desk.soffio(&["labels", "red-mobile"]).refused(2, &["--csv"]);
    desk.soffio(&["labels", "red-mobil", "--csv", "a.csv"]).refused(1, &["red-mobil", "\"red-mobile\""]);
    desk.soffio(&["labels", "red-mobile", "--from", "none.csv"]).refused(1, &["none.csv"]);
    assert_eq!(desk.files(), ["exhibits", "new.csv", "words.csv"]);
}

#[test]
fn a_refused_beginning_leaves_nothing() {
    let desk = Desk::new();
    desk.write(
        "plates.svg",
        "<svg xmlns=\"http://www.w3.org/2000/svg\">\n<path id=\"open\" d=\"M0 0 L90 90 L0 90\"/>\n</svg>",
    );
    desk.write("latin.svg", [b'<', 0xff, 0xfe]);
    desk.write("broken.glb", "glTF and no more");
    let new = |args: &[&str]| desk.soffio(&[&["new"], args].concat());
    new(&["Red", "--from", "empty"]).refused(1, &["\"Red\"", "lower-case"]);
    new(&["../x y", "--from", "empty"]).refused(1, &["lower-case"]);
    new(&["none/x", "--from", "empty"]).refused(1, &["no folder none"]);
    new(&["x", "--from", "mobil"]).refused(2, &["mobile"]);
    new(&["x", "--from", "mobile"]).refused(2, &["--plates", "--outlines"]);
    new(&["x", "--from", "mobile", "--plates", "12x"]).refused(1, &["\"12x\"", "120x80"]);
    new(&["x", "--from", "mobile", "--plates", "5,90"]).refused(1, &["15 to 600"]);
    new(&["x", "--from", "mobile", "--plates", "90,80", "--thickness", "99"]).refused(1, &["0.3 to 4 mm"]);
    new(&["x", "--from", "mobile", "--plates", "90,80", "--material", "cheese"]).refused(2, &["cheese", "brass"]);
    new(&["x", "--from", "mobile", "--outlines", "none.svg"]).refused(1, &["none.svg"]);
    new(&["x", "--from", "mobile", "--outlines", "latin.svg"]).refused(1, &["latin.svg", "UTF-8"]);
    new(&["x", "--from", "mobile", "--outlines", "plates.svg"])
        .refused(1, &["plates.svg:2:", "id=\"open\"", "close it"]);
    new(&["x", "--from", "clock", "--plates", "90"]).refused(2, &["--plates"]);
    new(&["x", "--from", "chimes", "--notes", "C5,H9"]).refused(1, &["\"H9\"", "C5"]);
    desk.soffio(&["import", "none.glb"]).refused(1, &["none.glb"]);
    desk.soffio(&["import", "broken.glb"]).refused(1, &["broken.glb"]);
    assert_eq!(desk.files(), ["broken.glb", "latin.svg", "plates.svg"]);
}

#[test]
fn a_model_is_imported_under_the_name_of_its_file() {
    let desk = Desk::new();
    let mut scene = Scene::default();
    scene.node("Cup", [0.0, 1.0, 0.0], Some(&cuboid([0.1, 0.2, 0.1])), &[]);
    desk.write("My Cup_2.glb", scene.glb());
    let run = desk.soffio(&["import", "My Cup_2.glb"]);
    assert_eq!(run.done(), "my-cup-2\n");
    assert!(run.err.contains("node \"Cup\""), "{}", run.err);
    let check = desk.soffio(&["check", "--quick", "my-cup-2"]);
    check.done();
    assert!(check.err.contains("my-cup-2: good\n"), "{}", check.err);
    desk.soffio(&["import", "My Cup_2.glb"]).refused(1, &["my-cup-2", "is there already"]);
    desk.soffio(&["import", "My Cup_2.glb", "--id", "cup"]).done();
    // Physics that no body has: the folder is there to be corrected, and the message says where.
    let body = scene.node("Odd", [1.0, 1.0, 0.0], None, &[]);
    let motion = json!({ "motion": { "mass": 1.0, "inertiaDiagonal": [1.0, 1.0, 10.0] } });
    scene.set(body, "extensions", json!({ "KHR_physics_rigid_bodies": motion }));
    desk.write("odd.glb", scene.glb());
    let odd = desk.soffio(&["import", "odd.glb"]);
    odd.refused(1, &["E0223", "odd/exhibit.toml:", "is there; correct", "soffio check odd"]);
    assert_eq!(desk.soffio(&["check", "--quick", "odd"]).code, Some(1));
    assert_eq!(desk.files(), ["My Cup_2.glb", "cup", "my-cup-2", "odd", "odd.glb"]);
}

/// Text of a new sidecar, a curator's mistake in its place, and words of the report. The line is that of the mistake.
const MISTAKES: [(&str, &str, &[&str]); 17] = [
    ("id = \"mine\"", "id = mine", &["E0101", "not TOML", "quotes"]),
    ("material = \"steel\"", "materail = \"steel\"", &["E0102", "materail", "material"]),
    ("node = \"Plate1\"", "node = \"Plate11\"", &["E0207", "Plate11", "\"Plate1\""]),
    ("material = \"aluminium\"", "material = \"aluminum\"", &["E0209", "aluminum", "aluminium"]),
    ("radius = \"1.5 mm\"", "radius = \"1.5 mmm\"", &["E0104", "mmm", "mm"]),
    ("radius = \"1.5 mm\"", "radius = -0.0015", &["E0226", "above zero"]),
    ("points = \"CeilingHook.*\"", "points = \"CeilngHook.*\"", &["E0207", "CeilngHook", "CeilingHook"]),
    ("at = \"Pair1Loop\"", "at = \"Plate1Hook\"", &["E0225", "belongs to", "below the body"]),
    ("shape = { fit = \"plate\" }", "shape = { fit = \"disk\" }", &["E0105", "disk", "\"plate\"", "\"convex\""]),
    ("on = \"impact\"", "on = \"hit\"", &["E0105", "\"hit\"", "\"impact\"", "\"wind\""]),
    ("timbre = \"plate\"", "timbre = \"plat\"", &["E0263", "plat", "plate"]),
    ("caption = \"plate\"", "caption = \"bell\"", &["E0260", "bell", "add it"]),
    (
        "model = \"mine.glb\"",
        "model = \"../mine.glb\"",
        &["E0003", "leaves the exhibit folder", "into the exhibit folder"],
    ),
    ("model = \"mine.glb\"", "model = \"mien.glb\"", &["E0002", "cannot be read", "did you mean \"mine.glb\"?"]),
    ("schema = \"exhibit/1\"", "schema = \"exhibit/9\"", &["E0106", "exhibit/9", "reads schema = \"exhibit/1\""]),
    ("duration = 42", "duration = 4", &["E0262", "last step"]),
    ("camera = \"CamFront\"", "camera = \"Cam\"", &["E0207", "\"Cam\"", "CamFront"]),
];

#[test]
fn every_mistake_is_told_with_its_line_its_cause_and_a_remedy() {
    let desk = Desk::new();
    desk.soffio(&["new", "mine", "--from", "mobile", "--plates", "120x80,100,90x60,70"]).done();
    let path = desk.path("mine/exhibit.toml");
    let good = std::fs::read_to_string(&path).expect("a sidecar");
    for (find, replace, words) in MISTAKES {
        let at = good.find(find).unwrap_or_else(|| panic!("no {find} in\n{good}"));
        std::fs::write(&path, good.replacen(find, replace, 1)).expect("writable");
        let line = good[..at].matches('\n').count() + 1;
        let output = desk.soffio(&["check", "--quick", "mine"]);
        assert_eq!(output.code, Some(1), "{replace}: {}", output.err);
        assert_eq!(output.out, "");
        let place = format!("mine/exhibit.toml:{line}:");
        for word in [place.as_str(), "help: "].iter().chain(words) {
            assert!(output.err.contains(word), "{replace}: no \"{word}\" in\n{}", output.err);
        }
    }
    std::fs::write(&path, &good).expect("writable");
    desk.soffio(&["check", "--quick", "mine"]).done();
}

/// One spoiled text: lines that are gone, double, moved or cut, and characters that are others.
fn spoiled(random: &mut Random, text: &str) -> String {
    const CHARACTERS: [char; 16] =
        ['"', '[', ']', '{', '}', '=', '.', ',', '-', '#', '\n', '0', '9', 'e', 'ß', '\u{7}'];
    const VALUES: [&str; 12] =
        ["0", "-1", "1e308", "nan", "inf", "\"\"", "\"x\"", "[]", "{}", "true", "\"9 furlongs\"", "1979-05-27"];
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    let mut pick = |n: usize| ((random.unit() * n as f64) as usize).min(n.saturating_sub(1));
    for _ in 0..=pick(4) {
        let at = pick(lines.len());
        let line = lines[at].clone();
        match pick(7) {
            0 => _ = lines.remove(at),
            1 => lines.insert(at, line),
            2 => {
                let other = pick(lines.len());
                lines.swap(at, other);
            }
            3 => lines[at] = line.chars().take(pick(line.chars().count() + 1)).collect(),
            4 => {
                let mut characters: Vec<char> = line.chars().collect();
                let place = pick(characters.len() + 1);
                characters.insert(place, CHARACTERS[pick(CHARACTERS.len())]);
                lines[at] = characters.into_iter().collect();
            }
            5 => {
                if let Some((key, _)) = line.split_once('=') {
                    lines[at] = format!("{key}= {}", VALUES[pick(VALUES.len())]);
                }
            }
            _ => {
                if let Some((key, value)) = line.split_once('=') {
                    lines[at] = format!("{}x ={value}", key.trim_end());
                }
            }
        }
        if lines.is_empty() {
            break;
        }
    }
    lines.join("\n")
}

#[test]
fn two_hundred_spoiled_sidecars_are_told_where_and_none_ends_the_program() {
    let desk = Desk::new();
    let mut random = Random::new(7);
    let (mut good, mut bad, mut unplaced, mut helpless) = (0, 0, Vec::new(), Vec::new());
    for id in ["plates", "pendulum", "windmill", "chain-heavy", "hang-it"] {
        let shipped = exhibit::resolve(id).unwrap_or_else(|report| panic!("{report}"));
        let sidecar = std::fs::read_to_string(shipped.join("exhibit.toml")).expect("shipped");
        let folder = desk.path(id);
        std::fs::create_dir(&folder).expect("writable");
        let model = format!("{id}.glb");
        std::fs::copy(shipped.join(&model), folder.join(&model)).expect("shipped");
        for round in 0..40 {
            let text = spoiled(&mut random, &sidecar);
            std::fs::write(folder.join("exhibit.toml"), &text).expect("writable");
            let lines = text.lines().count().max(1);
            match exhibit::load(&folder) {
                Ok(_) => good += 1,
                Err(report) => {
                    bad += 1;
                    assert!(report.has_errors() && !report.to_text().is_empty());
                    for problem in &report.diagnostics {
                        let placed = problem.location.as_ref().is_some_and(|l| {
                            (1..=lines + 1).contains(&l.line) && l.column >= 1 && l.file.ends_with("exhibit.toml")
                        });
                        if problem.help.as_ref().is_none_or(String::is_empty) {
                            helpless.push(format!("{}: {}", problem.code, problem.message));
                        }
                        if !placed || problem.message.is_empty() {
                            unplaced.push(format!("{id}, round {round}: {problem:?}"));
                        }
                    }
                }
            }
        }
    }
    println!("{good} load, {bad} are refused");
    assert!(unplaced.is_empty(), "{} without a place: {:#?}", unplaced.len(), &unplaced[..unplaced.len().min(5)]);
    helpless.sort();
    assert!(helpless.is_empty(), "without a remedy: {helpless:#?}");
    assert!(bad >= 100, "only {bad} are refused");
}

#[test]
fn two_hundred_spoiled_configurations_are_told_where_and_none_ends_the_program() {
    let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join(soffio_config::FILE);
    let text = std::fs::read_to_string(shipped).expect("shipped");
    let mut random = Random::new(8);
    let (mut good, mut bad) = (0, 0);
    for round in 0..200 {
        let spoiled = spoiled(&mut random, &text);
        match Config::parse(&spoiled, Path::new("site.toml")) {
            Ok(_) => good += 1,
            Err(error) => {
                bad += 1;
                assert!(!error.problems.is_empty(), "round {round}");
                for problem in &error.problems {
                    let placed = (1..=spoiled.lines().count() + 1).contains(&problem.line) && problem.column >= 1;
                    assert!(placed && !problem.message.is_empty(), "round {round}: {problem:?}\n{spoiled}");
                    assert!(!problem.help.is_empty(), "round {round}, without a remedy: {problem:?}");
                }
                assert!(error.to_string().contains("site.toml:"), "round {round}: {error}");
            }
        }
    }
    println!("{good} are read, {bad} are refused");
    assert!(bad >= 50, "only {bad} are refused");
}

#[test]
fn folders_that_are_made_can_be_read_by_others() {
    let desk = Desk::new();
    desk.soffio(&["new", "least", "--from", "empty"]).done();
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        let ordinary = desk.path("ordinary");
        std::fs::create_dir(&ordinary).expect("writable");
        let mode = |path: &Path| path.metadata().expect("there").permissions().mode() & 0o777;
        assert_eq!(mode(&desk.path("least")), mode(&ordinary));
    }
    let play = desk.soffio(&["play", text(&desk.path("least")), "--seconds", "0.2"]);
    assert_eq!(play.code, Some(0), "{}", play.err);
}

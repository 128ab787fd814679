//! New exhibits: whatever plates are given, the mobile hangs level, its wires balance, a breath moves it and makes it ring.

use std::sync::Arc;

use soffio_authoring::drawing::outlines;
use soffio_authoring::notes::{self, chime, note};
use soffio_authoring::plate_mobile::{self, Metal, Outline, sized};
use soffio_authoring::template::Template;
use soffio_authoring::{ExhibitFolder, FolderFile, starter};
use soffio_exhibit::{self as exhibit, Exhibit, Report};
use soffio_math::DVec3;
use soffio_math::noise::Random;
use soffio_simulation::{Command, EventKind, STEPS_PER_SECOND, Settings, Simulation, StepInput};

/// A rest pose may lean so far, degrees: the eye sees no less.
const LEVEL_DEG: f64 = 1.0;
/// What the product promises of joints under anything, m.
const JOINT_ERROR: f64 = 1e-6;
/// Seconds without wind in which what is not balanced would have turned.
const REST: f64 = 10.0;

fn steps(seconds: f64) -> usize {
    (seconds * STEPS_PER_SECOND as f64).round() as usize
}

/// The exhibit of what is made, without a warning.
fn loaded(made: &ExhibitFolder) -> Arc<Exhibit> {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for FolderFile { name, bytes } in &made.files {
        let path = folder.path().join(name);
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("a writable folder");
        std::fs::write(path, bytes).expect("a writable folder");
    }
    let exhibit = exhibit::load(folder.path()).unwrap_or_else(|report| panic!("{}", report.to_text()));
    assert!(exhibit.warnings.is_empty(), "{}", exhibit.warning_report().to_text());
    Arc::new(exhibit)
}

/// The farthest any body leans from upright, degrees.
fn lean(simulation: &Simulation) -> f64 {
    let up = simulation.bodies().iter().map(|body| (body.rotation * DVec3::Y).y).fold(1.0, f64::min);
    up.clamp(-1.0, 1.0).acos().to_degrees()
}

/// Left alone, the work stays level.
fn rests(name: &str, exhibit: &Arc<Exhibit>) {
    let settings = Settings { wind: false, ..Settings::default() };
    let mut simulation = Simulation::new(exhibit.clone(), settings);
    let start: Vec<DVec3> = simulation.bodies().iter().map(|body| body.position).collect();
    let mut worst = lean(&simulation);
    for _ in 0..steps(REST) {
        simulation.step(&StepInput::default());
        worst = worst.max(lean(&simulation));
        let hits = simulation.events().iter().filter(|event| event.kind == EventKind::Impact).count();
        assert_eq!(hits, 0, "{name}: something touches at rest");
    }
    let moved = simulation.bodies().iter().zip(start).map(|(b, p)| b.position.distance(p)).fold(0.0, f64::max);
    println!("{name}: leans by {worst:.4}°, moved by {moved:.1e} m, joints {:.1e} m", simulation.joint_error());
    assert!(worst < LEVEL_DEG, "{name}: leans by {worst}°");
    assert!(simulation.joint_error() < JOINT_ERROR);
}

/// Breaths as a visitor's, at the places of its own attract script: it moves, and it rings. Hits.
fn blown(name: &str, exhibit: &Arc<Exhibit>, aims: &[[f64; 2]]) -> usize {
    /// A normal breath at the lips, m/s.
    const SPEED: f64 = 8.9;
    /// Seen from across a room, m.
    const SEEN: f64 = 5e-3;
    let mut simulation = Simulation::new(exhibit.clone(), Settings::default());
    let start: Vec<DVec3> = simulation.bodies().iter().map(|body| body.position).collect();
    let (mut hits, mut moved, mut worst) = (0, 0.0_f64, 0.0_f64);
    for aim in aims {
        for step in 0..steps(6.0) {
            let commands = [Command::Blow(Some(SPEED).filter(|_| step < steps(2.0)))];
            simulation.step(&StepInput { commands: &commands, pointer: Some(*aim), ..StepInput::default() });
            hits += simulation.events().iter().filter(|event| event.kind == EventKind::Impact).count();
            assert!(simulation.events().iter().all(|event| event.kind != EventKind::Fault), "{name}: a fault");
            worst = worst.max(simulation.joint_error());
            let way = simulation.bodies().iter().zip(&start).map(|(b, p)| b.position.distance(*p));
            moved = way.fold(moved, f64::max);
        }
    }
    println!("{name}: {hits} hits, moved by {moved:.3} m, joints within {worst:.1e} m");
    assert!(hits > 0, "{name}: it does not ring");
    assert!(moved > SEEN, "{name}: moved by {moved} m");
    assert!(worst < JOINT_ERROR, "{name}: joints {worst} m apart");
    hits
}

/// A mobile of these plates, tried; and its figures.
fn tried(name: &str, plates: &[Outline], thickness: f64, metal: Metal) {
    let output = |problems: Vec<_>| format!("{name}: {}", Report::from(problems).to_text());
    let work =
        plate_mobile::mobile(name, plates, thickness, metal).unwrap_or_else(|problems| panic!("{}", output(problems)));
    // The rule that the branches are bent by: what the wires balance, they balance to rounding.
    let offset = work.mobile.statics().worst_offset;
    assert!(offset < 1e-9, "{name}: {offset} m from under a hook");
    let made =
        starter::mobile(name, plates, thickness, metal).unwrap_or_else(|problems| panic!("{}", output(problems)));
    let exhibit = loaded(&made);
    assert_eq!(exhibit.bodies.len(), 2 * plates.len() - 1);
    rests(name, &exhibit);
    let aims: Vec<[f64; 2]> =
        work.pairs.iter().take(4).map(|[_, front]| work.plates[*front].picture_position).collect();
    blown(name, &exhibit, &aims);
}

fn sizes(list: &str) -> Vec<Outline> {
    list.split(',').map(|size| sized(size).unwrap_or_else(|problem| panic!("{}", problem.message))).collect()
}

#[test]
fn any_plates_hang_level_and_ring_in_a_breath() {
    tried("two", &sizes("120x80,100"), 0.8e-3, Metal::Aluminium);
    tried("proposed", &sizes("120x80,100,90x60,70"), 0.8e-3, Metal::Aluminium);
    (1..=2).for_each(any_plates);
}

#[test]
#[ignore = "a quarter of a minute of the machine; part `plates` of tests/check.sh --long"]
fn many_plates_hang_level_and_ring_in_a_breath() {
    (3..=12).for_each(any_plates);
}

/// Two to ten plates of any size, thickness and metal.
fn any_plates(seed: u64) {
    let mut random = Random::new(seed);
    let count = 2 + (random.unit() * 9.0) as usize;
    let first = random.range(40.0, 150.0);
    let list: Vec<String> = (0..count)
        .map(|_| {
            let [width, height] = [first * random.range(0.7, 1.5), first * random.range(0.7, 1.5)].map(f64::round);
            if random.unit() < 0.4 { format!("{width}") } else { format!("{width}x{height}") }
        })
        .collect();
    let metal = [Metal::Aluminium, Metal::Steel, Metal::Brass, Metal::Copper][seed as usize % 4];
    let thickness = random.range(0.4e-3, 1.2e-3);
    println!("seed {seed}: {} of {metal:?}, {:.2} mm", list.join(","), 1e3 * thickness);
    tried(&format!("seed-{seed}"), &sizes(&list.join(",")), thickness, metal);
}

/// A leaf, a fish and a card; the drawing is 200 mm wide and has 400 units.
const DRAWING: &str = r#"<svg xmlns="http://www.w3.org/2000/svg" width="200mm" height="200mm" viewBox="0 0 400 400">
  <title>Three plates</title>
  <defs><linearGradient id="unused"/></defs>
  <g transform="translate(10 20)">
    <path id="leaf" d="M 100 0 C 180 60 180 160 100 240 C 20 160 20 60 100 0 Z"/>
    <path id="fish" d="m 220 60 c 40 -50 120 -50 150 0 l 0 70 c -30 60 -110 60 -150 0 z" transform="rotate(5)"/>
  </g>
  <rect id="card" x="20" y="280" width="160" height="100" rx="12"/>
  <circle cx="300" cy="320" r="62"/>
</svg>"#;

#[test]
fn a_drawing_becomes_plates_of_its_own_size() {
    /// Half the flatness of a curve on either side, mm.
    const FLAT: f64 = 0.1;
    let plates = outlines("three.svg", DRAWING).unwrap_or_else(|report| panic!("{}", report.to_text()));
    let names: Vec<&str> = plates.iter().map(|plate| plate.name.as_str()).collect();
    assert_eq!(names, ["<path id=\"leaf\">", "<path id=\"fish\">", "<rect id=\"card\">", "<circle>"]);
    let size = |i: usize| {
        let of = |pick: fn(f64, f64) -> f64, k: usize, from: f64| {
            plates[i].polygon.iter().map(|p| p.to_array()[k]).fold(from, pick)
        };
        [0, 1].map(|k| of(f64::max, k, f64::NEG_INFINITY) - of(f64::min, k, f64::INFINITY))
    };
    // 400 units are 200 mm: half a millimetre each.
    for (i, expected) in [(2, [80.0, 50.0]), (3, [62.0, 62.0])] {
        let found = size(i);
        assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < FLAT), "{found:?}, not {expected:?}");
    }
    tried("drawn", &plates, 0.8e-3, Metal::Steel);
}

#[test]
fn an_outline_that_is_no_plate_is_refused_with_its_position() {
    let cases = [
        ("<path id=\"ring\" d=\"M0 0H90V90H0Z M20 20H40V40H20Z\"/>", "holes", "id=\"ring\""),
        ("<path id=\"open\" d=\"M0 0 L90 0 L90 90\"/>", "open line", "close it"),
        ("<path id=\"eight\" d=\"M0 0 L90 90 L90 0 L0 90 Z\"/>", "crosses itself", "remove the loop"),
        ("<path id=\"bad\" d=\"M0 0 L90 ninety Z\"/>", "cannot be read", "plain SVG"),
        ("<path id=\"nothing\" d=\"M0 0 L90 0 L0 0 Z\"/>", "no area", "15"),
        ("<text id=\"word\">SOFFIO</text>", "is text", "Object to Path"),
        ("<image id=\"photo\" href=\"a.png\"/>", "is a picture", "trace"),
        ("<use href=\"#a\"/>", "copy of another", "nlink"),
        ("<line id=\"stick\" x1=\"0\" y1=\"0\" x2=\"9\" y2=\"9\"/>", "is a line", "closed outline"),
        ("<rect id=\"wide\" width=\"9parsec\" height=\"3\"/>", "is not a length", "id=\"wide\""),
        ("<g transform=\"spin(3)\"><rect width=\"90\" height=\"90\"/></g>", "transform", "<g>"),
        ("", "no closed shape", "closed path"),
    ];
    for (element, why, other) in cases {
        let text = format!("<svg xmlns=\"http://www.w3.org/2000/svg\">\n{element}\n</svg>");
        let report = outlines("plates.svg", &text).expect_err(element);
        let output = report.to_text();
        for word in [why, other] {
            assert!(output.contains(word), "{element}: no \"{word}\" in\n{output}");
        }
        let line = if element.is_empty() { "plates.svg:1:" } else { "plates.svg:2:" };
        assert!(output.contains(line), "{element}: no {line} in\n{output}");
    }
    // All at once, and what is not SVG at all.
    let both = "<svg xmlns=\"http://www.w3.org/2000/svg\"><text>a</text><line/></svg>";
    assert_eq!(outlines("plates.svg", both).expect_err("two problems").diagnostics.len(), 2);
    for text in ["", "not SVG", "<svg", "<html/>", "<svg xmlns=\"http://www.w3.org/2000/svg\"><path d=\"M0 0"] {
        let output = outlines("plates.svg", text).expect_err(text).to_text();
        assert!(output.contains("E0601"), "{text}: {output}");
    }
}

#[test]
fn plates_that_cannot_hang_are_refused_with_the_reason() {
    let cases = [
        ("100", 0.8, "2 to 24"),
        ("5x5,90", 0.8, "5.0 × 5.0 mm"),
        ("700,90", 0.8, "15 to 600"),
        ("200,20", 0.8, "more alike"),
        ("90,80", 9.0, "0.3 to 4 mm"),
    ];
    for (list, thickness, word) in cases {
        let problems = starter::mobile("x", &sizes(list), 1e-3 * thickness, Metal::Steel).expect_err(list);
        let output = Report::from(problems).to_text();
        assert!(output.contains(word), "{list}: no \"{word}\" in\n{output}");
    }
    for text in ["", "x", "12x", "0", "-5", "1x2x3", "nan", "inf", "12 by 3"] {
        assert!(sized(text).is_err(), "{text}");
    }
    // A crescent whose centre lies outside it has nothing above to hang by but its horn.
    let horn = "<svg xmlns=\"http://www.w3.org/2000/svg\"><path id=\"horn\" d=\"M0 0 L60 1 L120 0 L60 3 Z\"/>\
                <rect width=\"80\" height=\"60\"/></svg>";
    let plates = outlines("horn.svg", horn).unwrap_or_else(|report| panic!("{}", report.to_text()));
    let problems = starter::mobile("x", &plates, 1e-3, Metal::Steel).expect_err("too thin");
    assert!(problems[0].message.contains("horn"), "{}", problems[0].message);
}

#[test]
fn tubes_are_as_long_as_their_notes_ask() {
    /// Of a length rounded to a tenth of a millimetre on a tube of 0.4 m, and the design sheet's last digit.
    const MM: f64 = 1.0;
    // The design sheet: 25.4 × 1.65 mm of 6061-T6.
    for (name, hz, mm) in [("C5", 523.25, 533.8), ("E5", 659.26, 474.7), ("A5", 880.0, 409.7), ("C6", 1046.5, 374.9)] {
        let note = note(name).unwrap_or_else(|problem| panic!("{}", problem.message));
        assert!((note.frequency - hz).abs() < 0.01, "{name}: {} Hz", note.frequency);
        let length = 1e3 * notes::length(note.frequency);
        println!("{name}: {length:.2} mm, sheet {mm}");
        assert!((length - mm).abs() < MM, "{name}: {length} mm, not {mm}");
    }
    for text in ["", "H5", "C", "C99", "C2", "C8", "5C", "Cx5"] {
        assert!(note(text).is_err(), "{text}");
    }
    let of = |list: &str| {
        let notes: Vec<_> = list.split(',').map(|name| note(name).expect("a note")).collect();
        chime("some-chimes", &notes)
    };
    assert!(of("C5,D5").is_err());
    for list in ["C5,E5,G5", "A5,F#4,Bb5,C5,G4", "C5,D5,E5,F5,G5,A5,B5,C6"] {
        let made = of(list).unwrap_or_else(|problem| panic!("{}", problem.message));
        let exhibit = loaded(&made);
        rests(list, &exhibit);
        blown(list, &exhibit, &[[0.5, 0.86], [0.5, 0.86]]);
    }
}

#[test]
fn copies_and_the_least_exhibit_load_without_a_warning() {
    let least = loaded(&starter::empty("least"));
    assert_eq!((least.id.as_str(), least.bodies.len()), ("least", 1));
    let mut languages: Vec<&str> = least.labels.languages.iter().map(|(code, _)| code.as_str()).collect();
    languages.sort_unstable();
    assert_eq!(languages, ["en", "it", "ko"]);
    rests("least", &least);
    for (template, shipped) in [(Template::Clock, "terry-clock"), (Template::Pendulum, "pendulum")] {
        let copy = loaded(&template.copy("my-copy").expect("TOML"));
        let original = exhibit::load(&exhibit::resolve(shipped).expect("shipped")).expect("good");
        assert_eq!(copy.id, "my-copy");
        assert_eq!(copy.constraints, original.constraints);
        assert_eq!(copy.bodies.len(), original.bodies.len());
    }
}

//! Timbres of an exhibit's own folder: they load, follow the motion, reload when saved, and say what is wrong with them.

use std::sync::Arc;

use soffio_exhibit::{self as exhibit, Exhibit, Report};
use soffio_simulation::{Settings, Simulation, StepInput};
use soffio_sound::{SoundCommand, Synth};

use super::{RATE, render, rms, spectrum};
use crate::exhibit::glb::{Folder, Scene, cuboid};

/// A curator's timbre: a bank that is struck, and a tone by frequency modulation whose pitch and brightness follow the spin.
pub const WHIRR: &str = r#"# A brass wheel that hums as it turns and rings when it is hit.
timbre = 1
name = "whirr"
description = "A wheel that hums"

[node.bank]
type = "modal"
from = "table"
fundamental = 2000          # Hz
contact_radius = 0.002      # m
gain = 20
table = [
    { ratio = 1, gain = 1, t60 = 1.5 },
    { ratio = 2.76, gain = 0.4, t60 = 0.8 },
]

[node.swell]
type = "function"
of = "clamp(body_spin / 10, 0, 1)^2"

[node.tone]
type = "fm"
carrier = { input = "body_spin", scale = 40 }     # Hz
ratio = 1.5
index = { input = "body_spin", scale = 0.15 }     # rad

[node.hum]
type = "product"
in = ["tone", "swell"]
gain = 0.2

[node.out]
type = "sum"
in = ["bank", "hum"]
"#;

/// A ball without weight that spins at 10 rad/s, and its sound.
fn spinning(timbre: &str, more: &str) -> (Vec<u8>, String) {
    let mut scene = Scene::default();
    scene.node("Wheel", [0.0; 3], Some(&cuboid([0.1; 3])), &[]);
    let sidecar = format!(
        "[scene]\ngravity = [0, 0, 0]\n\
         [[body]]\nnode = \"Wheel\"\nmaterial = \"brass\"\ninitial = {{ angular_velocity = [0, 0, 10] }}\n\
         [[collider]]\nnode = \"Wheel\"\nshape = {{ sphere = {{ radius = 0.05 }} }}\n\
         [[sound]]\nname = \"whirr\"\nbody = \"Wheel\"\non = \"motion\"\ntimbre = \"{timbre}\"\n{more}\n"
    );
    (scene.glb(), sidecar)
}

pub fn folder(timbre: &str, more: &str, files: &[(&str, &str)]) -> Folder {
    let (model, sidecar) = spinning(timbre, more);
    let folder = Folder::exhibit(&model, &sidecar);
    std::fs::create_dir_all(folder.path().join("timbres")).expect("writable");
    files.iter().for_each(|(name, text)| folder.write(&format!("timbres/{name}"), text.as_bytes()));
    folder
}

fn refused(timbre: &str, more: &str, files: &[(&str, &str)]) -> Report {
    exhibit::load(folder(timbre, more, files).path()).expect_err("not valid")
}

/// Left side of the first seconds of an exhibit.
pub fn heard(exhibit: Exhibit, seconds: usize) -> Vec<f64> {
    let mut synth = Synth::new(RATE, &exhibit.instruments, 1).expect("checked");
    synth.set_dry(true);
    let mut simulation = Simulation::new(Arc::new(exhibit), Settings::default());
    let mut out = Vec::new();
    for _ in 0..240 * seconds {
        simulation.step(&StepInput::default());
        simulation.sounds().iter().for_each(|command| synth.command(*command));
        out.extend(render(&mut synth, 200).chunks(2).map(|frame| f64::from(frame[0])));
    }
    assert_eq!(synth.faults(), 0);
    out
}

#[test]
fn a_file_in_the_folder_is_a_timbre_and_follows_the_spin() {
    for name in ["whirr", "timbres/whirr.toml", "whirr.toml"] {
        let folder = folder(name, "", &[("whirr.toml", WHIRR)]);
        let loaded = exhibit::load(folder.path()).unwrap_or_else(|report| panic!("{name}: {}", report.to_text()));
        assert_eq!(loaded.own_timbres.len(), 1);
        let out = heard(loaded, 3);
        // Settled. 10 rad/s: a carrier of 400 Hz, a modulator of 600 Hz: the partials are 200 Hz apart.
        let power = spectrum(&out[RATE as usize..], 4800);
        let [tone, beside] = [40, 45].map(|bin| power[bin]);
        assert!(tone > 1e3 * beside, "{name}: {tone} at 400 Hz, {beside} at 450 Hz");
    }
}

#[test]
fn a_file_goes_before_a_shipped_timbre_of_its_name() {
    let text = WHIRR.replace("name = \"whirr\"", "name = \"bell\"");
    let loaded = exhibit::load(folder("bell", "", &[("bell.toml", &text)]).path()).expect("valid");
    assert!(loaded.instruments[0].own.as_ref().is_some_and(|preset| preset.moves()));
}

#[test]
fn a_parameter_of_the_exhibit_reaches_its_timbre_as_it_changes() {
    let text = "timbre = 1\nname = \"swell\"\ndescription = \"\"\n\
        [node.out]\ntype = \"oscillator\"\nfrequency = 500\ngain = { input = \"parameter\", scale = 0.1 }\n";
    let more = "parameter = { keys = [[0, 0], [1, 0], [2, 1], [3, 1]], interpolation = \"linear\" }";
    let out = heard(exhibit::load(folder("swell", more, &[("swell.toml", text)]).path()).expect("valid"), 3);
    let level = |from: f64, to: f64| {
        let part: Vec<f32> = out[(from * 48e3) as usize..(to * 48e3) as usize].iter().map(|x| *x as f32).collect();
        rms(&part)
    };
    assert_eq!(level(0.0, 0.9), 0.0);
    let ratio = level(1.45, 1.55) / level(2.5, 2.9);
    assert!((ratio - 0.5).abs() < 0.02, "half way it is half as loud: {ratio}");
}

#[test]
fn forces_of_joints_and_springs_are_heard_only_where_the_sound_names_them() {
    let text = |input: &str| {
        format!(
            "timbre = 1\nname = \"pull\"\ndescription = \"\"\n[node.out]\ntype = \"oscillator\"\nfrequency = 500\n\
             gain = {{ input = \"{input}\", scale = 0.01 }}\n"
        )
    };
    // A ball of brass, 8.5 g/cm³ and 0.1 m wide, hangs on a nail: 41.7 N.
    let mut scene = Scene::default();
    scene.node("Ball", [0.0; 3], Some(&cuboid([0.1; 3])), &[]);
    scene.node("Nail", [0.0, 0.2, 0.0], None, &[]);
    let base = |more: &str| {
        format!(
            "[[body]]\nnode = \"Ball\"\nmaterial = \"brass\"\n\
             [[constraint.nail]]\nname = \"cord\"\nbody = \"Ball\"\nat = [0, 0.2, 0]\nto = [0, 0.2, 0]\n\
             [[sound]]\nname = \"pull\"\nbody = \"Ball\"\non = \"motion\"\ntimbre = \"pull\"\n{more}\n"
        )
    };
    let with = |more: &str, input: &str| {
        let folder = Folder::exhibit(&scene.glb(), &base(more));
        std::fs::create_dir_all(folder.path().join("timbres")).expect("writable");
        folder.write("timbres/pull.toml", text(input).as_bytes());
        exhibit::load(folder.path())
    };
    let hanging = with("force_of = \"cord\"", "joint_force").unwrap_or_else(|report| panic!("{}", report.to_text()));
    let weight = hanging.bodies[0].properties.mass * 9.81;
    let out = heard(hanging, 2);
    let part: Vec<f32> = out[RATE as usize..].iter().map(|x| *x as f32).collect();
    // Panned to the middle: both sides have 1/√2 of a sine of this amplitude at the distance of the listener.
    let distance = rms(&part);
    assert!(distance > 0.0 && weight > 0.0);
    let heavier = with("force_of = \"cord\"\ngain = \"6.0206 dB\"", "joint_force").expect("valid");
    let twice: Vec<f32> = heard(heavier, 2)[RATE as usize..].iter().map(|x| *x as f32).collect();
    assert!((rms(&twice) / distance - 2.0).abs() < 1e-3);
    for (more, input, code, words) in [
        ("", "joint_force", "E0271", "force of a constraint"),
        ("", "tension", "E0271", "force of a spring"),
        ("force_of = \"cord\"", "tension", "E0271", "force of a spring"),
        ("force_of = \"chord\"", "joint_force", "E0239", "did you mean \"cord\"?"),
    ] {
        let report = with(more, input).expect_err("not valid").to_text();
        assert!(report.contains(code) && report.contains(words), "{more} {input}: {report}");
    }
    for (more, words) in [("force_of = \"cord\"", "force_of of sound"), ("parameter = 2", "parameter of sound")] {
        let loaded = with(more, "body_speed").expect("valid");
        let warnings = loaded.warning_report().to_text();
        assert!(warnings.contains("W0410") && warnings.contains(words), "{warnings}");
    }
}

/// Twenty mistakes: what is replaced, by what, on which line it is found, and words of the message.
const BROKEN: [(&str, &str, usize, &str); 20] = [
    ("timbre = 1", "timbre = 2", 2, "version 2"),
    ("name = \"whirr\"", "name = \"wirr\"", 3, "not the file's name"),
    ("description =", "descripton =", 4, "did you mean \"description\""),
    ("type = \"modal\"", "type = \"model\"", 7, "did you mean \"modal\""),
    ("from = \"table\"", "from = \"tabel\"", 8, "did you mean \"table\""),
    ("fundamental = 2000", "fundamental = -2000", 9, "above 0"),
    ("contact_radius = 0.002", "contact_radius = \"2 mm\"", 10, "invalid type"),
    ("t60 = 1.5", "t60 = 0", 12, "above 0"),
    ("ratio = 2.76", "rato = 2.76", 14, "did you mean \"ratio\""),
    ("type = \"function\"", "type = \"formula\"", 18, "no type \"formula\""),
    ("of = \"clamp(body_spin / 10, 0, 1)^2\"", "of = \"clamp(body_spin / 10, 0)^2\"", 19, "takes 3 numbers, not 2"),
    (
        "of = \"clamp(body_spin / 10, 0, 1)^2\"",
        "of = \"clamp(body_spni / 10, 0, 1)^2\"",
        19,
        "did you mean \"body_spin\"",
    ),
    ("of = \"clamp(body_spin / 10, 0, 1)^2\"", "of = \"clamp(body_spin / 10, 0, 1\"", 19, "missing"),
    ("input = \"body_spin\", scale = 40", "input = \"spin\", scale = 40", 23, "no \"spin\""),
    ("scale = 40", "scale = inf", 23, "scale"),
    ("ratio = 1.5", "ratios = 1.5", 24, "did you mean \"ratio\""),
    ("in = [\"tone\", \"swell\"]", "in = [\"tone\", \"swel\"]", 29, "did you mean \"swell\""),
    ("in = [\"tone\", \"swell\"]", "in = [\"tone\", \"out\"]", 6, "ring"),
    ("[node.out]", "[node.output]", 6, "missing: the node that is heard"),
    ("in = [\"bank\", \"hum\"]", "in = [\"bank\", \"hum\"", 34, ""),
];

#[test]
fn twenty_broken_files_are_reported_at_their_lines() {
    for (from, to, line, words) in BROKEN {
        assert!(WHIRR.contains(from), "{from}");
        let broken = WHIRR.replacen(from, to, 1);
        let report = refused("whirr", "", &[("whirr.toml", &broken)]);
        let found = report
            .diagnostics
            .iter()
            .find(|d| d.code == "E0270")
            .unwrap_or_else(|| panic!("{to}: {}", report.to_text()));
        let place = found.location.as_ref().unwrap_or_else(|| panic!("{to}: no place"));
        assert!(place.file.ends_with("timbres/whirr.toml"), "{to}: {}", place.file);
        assert_eq!(place.line, line, "{to}: {}", report.to_text());
        assert!(found.message.contains(words), "{to}: {}", found.message);
        assert!(found.help.as_ref().is_some_and(|help| help.contains("soffio sound")), "{to}");
        // With the line itself.
        assert!(
            report.to_text().contains(broken.lines().nth(line - 1).expect("a line").trim()),
            "{}",
            report.to_text()
        );
    }
}

#[test]
fn a_timbre_that_does_not_fit_its_body_or_its_trigger_is_reported() {
    let picture =
        "timbre = 1\nname = \"scratch\"\ndescription = \"\"\n[node.out]\ntype = \"texture\"\nkind = \"image\"\n";
    let report = refused("scratch", "", &[("scratch.toml", picture)]).to_text();
    assert!(report.contains("E0264") && report.contains("on = \"slide\""), "{report}");
    assert!(report.contains("E0270") && report.contains("picture"), "{report}");
    let report = refused("wirr", "", &[("whirr.toml", WHIRR)]).to_text();
    assert!(report.contains("E0263") && report.contains("did you mean \"whirr\""), "{report}");
    // Unused files are checked too.
    let report = refused("whirr", "", &[("whirr.toml", WHIRR), ("other.toml", "timbre = 1\n")]).to_text();
    assert!(report.contains("E0270") && report.contains("other.toml"), "{report}");
}

#[test]
fn motion_is_told_to_the_synth_only_where_a_timbre_follows_it() {
    let commands = |timbre: &str, on: &str| {
        let (model, sidecar) = spinning(timbre, "");
        let folder = Folder::exhibit(&model, &sidecar.replace("on = \"motion\"", &format!("on = \"{on}\"")));
        std::fs::create_dir_all(folder.path().join("timbres")).expect("writable");
        folder.write("timbres/whirr.toml", WHIRR.as_bytes());
        let loaded = exhibit::load(folder.path()).unwrap_or_else(|report| panic!("{}", report.to_text()));
        let mut simulation = Simulation::new(Arc::new(loaded), Settings::default());
        simulation.step(&StepInput::default());
        simulation.sounds().iter().filter(|command| matches!(command, SoundCommand::Motion(_))).count()
    };
    assert_eq!(commands("bell", "impact"), 0);
    assert_eq!(commands("whirr", "motion"), 1);
    assert_eq!(commands("whirr", "impact"), 1, "a struck bank and its hum are one instrument");
}

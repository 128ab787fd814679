//! What is done with bytes that somebody hands to Soffio as a file: read, and where they are good, tried for a moment.
//!
//! Invariant: no bytes panic, take long or take much memory. The fuzzer makes bytes up; the suite runs the seeds and all
//! that was ever found, through the same functions.

use std::path::Path;
use std::sync::Arc;

use soffio_authoring::drawing::outlines;
use soffio_config::Config;
use soffio_exhibit::{self as exhibit, Exhibit};
use soffio_multibody::dynamics::{Integrator, Solver};
use soffio_offline::audition::TestSound;
use soffio_offline::scene::PhysicsScene;
use soffio_offline::scene::run::{Engine, Soffio};
use soffio_offline::wav;
use soffio_simulation::{Script, Settings, Simulation, StepInput, record};
use soffio_sound::Preset;

/// Steps that a good exhibit or scene is run for.
const STEPS: usize = 8;
/// How long a good timbre sounds, s.
const SOUNDS: f64 = 0.02;

/// Reads bytes as a file of one kind, in a folder of its own.
pub type Reader = fn(&Path, &[u8]);

/// A kind of file by its name.
pub const KINDS: &[(&str, Reader)] = &[
    ("sidecar", sidecar),
    ("model", model),
    ("recording", recording),
    ("timbre", timbre),
    ("config", config),
    ("script", script),
    ("scene", scene),
    ("drawing", drawing),
    ("labels", labels),
    ("record", record),
];

/// `exhibit.toml` beside the models that lie in `folder`.
pub fn sidecar(folder: &Path, bytes: &[u8]) {
    put(&folder.join(exhibit::SIDECAR), bytes);
    match exhibit::load(folder) {
        Ok(exhibit) => begin(exhibit),
        Err(report) => drop(report.to_text()),
    }
}

/// `.glb` or `.gltf`.
pub fn model(folder: &Path, bytes: &[u8]) {
    let path = folder.join("torn.glb");
    put(&path, bytes);
    match exhibit::load_model(&path) {
        Ok(exhibit) => begin(exhibit),
        Err(report) => drop(report.to_text()),
    }
}

/// WAV.
pub fn recording(folder: &Path, bytes: &[u8]) {
    let path = folder.join("torn.wav");
    put(&path, bytes);
    match wav::read(&path) {
        Ok(recording) => assert!(!recording.samples.is_empty() && recording.duration() > 0.0),
        Err(error) => drop(error.to_string()),
    }
}

/// A timbre's TOML.
pub fn timbre(_: &Path, bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    // A timbre is called as its file is; here every name is right.
    let name = text.lines().find_map(|line| line.strip_prefix("name = \"")?.split('"').next()).unwrap_or("torn");
    match Preset::parse(name, text) {
        Ok(preset) => drop(TestSound::default().render(&preset, &preset.specimen, SOUNDS)),
        Err(error) => drop(error.to_string()),
    }
}

/// `kiosk.toml`.
pub fn config(_: &Path, bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    match Config::parse(text, Path::new("kiosk.toml")) {
        Ok(config) => drop(config.simulation_settings(0)),
        Err(error) => drop(error.to_string()),
    }
}

/// A script's JSON lines, or a record's.
pub fn script(_: &Path, bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    if let Ok(mut script) = Script::parse(text) {
        let mut commands = Vec::new();
        for part in 0..=STEPS {
            script.due(script.duration() * part as f64 / STEPS as f64, &mut commands);
        }
    }
    if let Err(error) = record::parse(text) {
        drop(error.to_string());
    }
}

/// A physics scene's JSON.
pub fn scene(_: &Path, bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    match PhysicsScene::parse(text, "torn.json") {
        Ok(scene) => {
            let mut run = Soffio::new(&scene, scene.dts[0], Integrator::Auto, Solver::Sparse);
            for _ in 0..STEPS {
                run.step();
            }
        }
        Err(error) => drop(error.to_string()),
    }
}

/// An SVG drawing of plates.
pub fn drawing(_: &Path, bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    match outlines("torn.svg", text) {
        Ok(plates) => assert!(plates.iter().all(|plate| plate.polygon.iter().all(|corner| corner.is_finite()))),
        Err(report) => drop(report.to_text()),
    }
}

/// A translator's table, CSV.
pub fn labels(_: &Path, bytes: &[u8]) {
    /// The sidecar that it belongs to.
    const SIDECAR: &str = "[label.en]\ntitle = \"A\"\nalt = \"B\"\ntext = { invite = \"C\" }\n";
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    match exhibit::labels::from_csv(exhibit::SIDECAR, SIDECAR, "torn.csv", text) {
        Ok(merged) => drop(exhibit::labels::to_csv(exhibit::SIDECAR, &merged.sidecar)),
        Err(report) => drop(report.to_text()),
    }
}

/// A record of a run, replayed for a moment with the settings that it has.
pub fn record(folder: &Path, bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let Ok(sections) = record::parse(text) else { return };
    let Ok(exhibit) = exhibit::load_model(&folder.join("model.glb")) else { return };
    let exhibit = Arc::new(exhibit);
    for mut section in sections.into_iter().take(2) {
        let mut simulation = Simulation::new(exhibit.clone(), section.begin.settings);
        for step in 0..section.steps().min(STEPS as u64) {
            simulation.step(&section.input(step));
        }
    }
}

/// A valid exhibit is one that runs.
fn begin(exhibit: Exhibit) {
    let mut simulation = Simulation::new(Arc::new(exhibit), Settings::default());
    for _ in 0..STEPS {
        simulation.step(&StepInput { hold: true, ..StepInput::default() });
    }
}

fn put(path: &Path, bytes: &[u8]) {
    std::fs::write(path, bytes).expect("a writable folder");
}

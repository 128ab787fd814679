//! Each exhibit's `expected.toml`: the state that a run ends in, how it is at rest, how much of it moves and what that weighs.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Arc;

use serde::{Deserialize, Serialize};
use soffio_exhibit::Exhibit;
use soffio_math::DVec3;
use soffio_simulation::{STEPS_PER_SECOND, Settings, Simulation, StepInput};

use crate::{load, note};

/// Seconds of the run that is hashed: 10,000 steps.
const SECONDS: &str = "41.6667";
const STEPS: u64 = 10_000;
/// Without wind an exhibit that rests is at rest after so long, s.
const SETTLED: usize = 20;
/// What the collection promises of rest.
const UPRIGHT_DEG: f64 = 1.0;
/// The file keeps angles to a hundredth of a degree.
const ROUNDED_DEG: f64 = 0.006;
/// Of masses in the file: what another drawing of the same thing may differ by.
const MASS_TOLERANCE: f64 = 1e-3;

/// What the file holds.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Expected {
    /// Hash of the state after 10,000 steps of tests/cases/gusts.jsonl, the same in every build.
    state: String,
    /// Bodies that move by forces.
    moving_bodies: usize,
    /// Their mass, kg, and how far it may be off, as a share.
    moving_mass: f64,
    mass_tolerance: f64,
    /// Largest tilt of a body off the model's pose after 20 s without wind, degrees.
    rest_tilt_deg: Option<f64>,
    /// Instead, why it has no rest.
    moves: Option<String>,
}

fn file(id: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("exhibits").join(id).join("expected.toml")
}

fn stored(id: &str) -> Option<Expected> {
    let text = std::fs::read_to_string(file(id)).ok()?;
    Some(toml::from_str(&text).unwrap_or_else(|error| panic!("{id}: {error}")))
}

/// The hash that the program ends with.
fn played(id: &str) -> String {
    let output = Command::new(env!("CARGO_BIN_EXE_soffio"))
        .args(["play", id, "--seconds", SECONDS, "--script"])
        .arg(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cases/gusts.jsonl"))
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .expect("the program starts");
    let text = String::from_utf8_lossy(&output.stdout);
    let summary: serde_json::Value = serde_json::from_str(text.trim())
        .unwrap_or_else(|error| panic!("{id}: {error}: {text}{}", String::from_utf8_lossy(&output.stderr)));
    assert_eq!((summary["steps"].as_u64(), summary["faults"].as_u64()), (Some(STEPS), Some(0)), "{id}");
    summary["state_hash"].as_str().expect("a word").to_owned()
}

/// Largest angle between where a body's own upright points in the model and where it points once all has settled.
fn rest_tilt_deg(exhibit: &Arc<Exhibit>) -> f64 {
    let mut simulation = Simulation::new(exhibit.clone(), Settings { wind: false, ..Settings::default() });
    let up = |simulation: &Simulation| -> Vec<DVec3> {
        simulation.bodies().iter().map(|body| body.rotation * DVec3::Y).collect()
    };
    let model: Vec<DVec3> = exhibit.bodies.iter().map(|body| body.pose.rotation * DVec3::Y).collect();
    let mut most: f64 = 0.0;
    for step in 0..(SETTLED + 1) * STEPS_PER_SECOND as usize {
        simulation.step(&StepInput::default());
        // The last second: what still swings does not pass by its rest unseen.
        if step >= SETTLED * STEPS_PER_SECOND as usize {
            for (now, then) in up(&simulation).iter().zip(&model) {
                most = most.max(now.cross(*then).length().atan2(now.dot(*then)));
            }
        }
    }
    most.to_degrees()
}

fn found(id: &str, moves: Option<String>) -> Expected {
    let exhibit = load(id);
    let kinematic = |body: usize| exhibit.drives.iter().any(|drive| drive.body == body);
    let moving: Vec<f64> =
        (0..exhibit.bodies.len()).filter(|&b| !kinematic(b)).map(|b| exhibit.bodies[b].properties.mass).collect();
    Expected {
        state: played(id),
        moving_bodies: moving.len(),
        moving_mass: moving.iter().sum(),
        mass_tolerance: MASS_TOLERANCE,
        rest_tilt_deg: moves.is_none().then(|| rest_tilt_deg(&exhibit)),
        moves,
    }
}

pub fn is_as_its_folder_says(id: &str) {
    let stored = stored(id).unwrap_or_else(|| panic!("{id}: no expected.toml"));
    let found = found(id, stored.moves.clone());
    let tilts = match (stored.rest_tilt_deg, found.rest_tilt_deg) {
        (Some(a), Some(b)) => (a - b).abs() <= ROUNDED_DEG && b <= UPRIGHT_DEG,
        (a, b) => a.is_none() && b.is_none() && stored.moves.is_some(),
    };
    let mass = (found.moving_mass / stored.moving_mass - 1.0).abs() <= stored.mass_tolerance;
    let same = stored.state == found.state && stored.moving_bodies == found.moving_bodies;
    assert!(
        same && mass && tilts,
        "{id}: stored {stored:#?}\nfound {found:#?}\nA change must be meant; then write the files again: \
         cargo test --no-default-features --test exhibits write_what_is_expected -- --ignored"
    );
}

pub fn write_what_is_expected(id: &str) {
    let moves = stored(id).and_then(|expected| expected.moves);
    let found = found(id, moves);
    let mut text = format!(
        "# What the exhibit is known by. Written by a test where a change is meant:\n\
         # cargo test --no-default-features --test exhibits write_what_is_expected -- --ignored\n\n\
         # The state after 10,000 steps of tests/cases/gusts.jsonl: the same in every build.\n\
         state = \"{}\"\n\n\
         # Bodies that forces move, their mass (kg), and how far that may be off, as a share.\n\
         moving_bodies = {}\nmoving_mass = {:.6}\nmass_tolerance = {}\n\n",
        found.state, found.moving_bodies, found.moving_mass, found.mass_tolerance
    );
    text += &match (found.rest_tilt_deg, found.moves) {
        (Some(tilt), _) => format!(
            "# Largest tilt of a body off the model's pose after {SETTLED} s without wind, degrees; at most {UPRIGHT_DEG}.\n\
             rest_tilt_deg = {tilt:.2}\n"
        ),
        (None, moves) => {
            format!("# Why it has no rest.\nmoves = {}\n", toml::Value::String(moves.expect("a reason")))
        }
    };
    note!("{id}: {:?}°", found.rest_tilt_deg);
    std::fs::write(file(id), text).expect("a writable folder");
}

//! Import of glTF models: an exhibit folder with the model's files and a proposed sidecar.
//!
//! A model with physics ([`super::khr`]) keeps it. Of other models, each top-level object is proposed as a body that is
//! nailed above its centre and feels the wind. Objects with names such as floor or stand are fixed. Masses are volumes
//! times density; an open mesh counts as sheet.

use std::fmt::Write;
use std::path::Path;

use serde_json::Value;

use super::khr;
use super::nodes::{Names, fit, meshes, toml_vector, world_meshes};
use super::texts::{AttractBreath, attract, in_three_languages, labels, quoted};
use super::{ExhibitFolder, FolderFile};
use soffio_exhibit::diagnostic::{Diagnostic, Report};
use soffio_exhibit::model::{Imported, MAX_FILE_BYTES, Model, import};
use soffio_exhibit::{SIDECAR, files, materials, paths};
use soffio_geometry::TriangleMesh;
use soffio_math::DVec3;

/// Words in the names of fixed objects.
const STATIC_WORDS: [&str; 14] = [
    "stand", "base", "floor", "ground", "wall", "room", "frame", "ceiling", "post", "plinth", "foot", "table", "case",
    "support",
];
/// Most objects for which bodies are proposed: more than a kiosk moves in real time. Each is compared with every other.
const MAX_PROPOSED: usize = 256;
/// Proposed material, and thickness of its sheet, m.
const MATERIAL: &str = "aluminium";
const SHEET_THICKNESS: f64 = 1e-3;

/// The files of an exhibit folder for the model at `path`.
///
/// # Errors
/// Problems of the model, and referenced files that cannot be read.
pub fn folder(path: &Path, id: &str) -> Result<ExhibitFolder, Report> {
    let Imported { model, warnings, document: json } = import(path)?;
    let bytes = files::read_limited(path, MAX_FILE_BYTES).map_err(Report::single)?;
    let binary = bytes.starts_with(b"glTF");
    let name = format!("{id}.{}", if binary { "glb" } else { "gltf" });
    let mut made = ExhibitFolder { files: referenced_files(path, &json).map_err(Report::single)?, remarks: Vec::new() };
    made.remarks.extend(warnings.into_iter().map(|warning| warning.message));
    let text = sidecar(id, &name, &model, &json, &mut made.remarks);
    made.files.push(FolderFile { name, bytes });
    made.files.push(FolderFile { name: SIDECAR.into(), bytes: text.into_bytes() });
    Ok(made)
}

/// Buffers and images that the model references, by their paths in the file.
fn referenced_files(path: &Path, json: &Value) -> Result<Vec<FolderFile>, Diagnostic> {
    let folder = path.parent().unwrap_or(Path::new(""));
    let mut files: Vec<FolderFile> = Vec::new();
    for kind in ["buffers", "images"] {
        for uri in json[kind].as_array().into_iter().flatten().filter_map(|entry| entry["uri"].as_str()) {
            // Data lies in the file; addresses are not opened.
            if uri.starts_with("data:") || uri.contains("://") {
                continue;
            }
            let name = paths::percent_decoded(uri);
            if files.iter().all(|file| file.name != name) {
                let bytes = files::read_inside(folder, &name, MAX_FILE_BYTES)?;
                files.push(FolderFile { name, bytes });
            }
        }
    }
    Ok(files)
}

fn sidecar(id: &str, file: &str, model: &Model, json: &Value, remarks: &mut Vec<String>) -> String {
    let names = Names::new(model);
    let physics = khr::physics(model, json);
    let mut out = format!(
        "# Made by `soffio import`: a proposal. Check bodies and joints, and REPLACE the texts.\n\
         # `soffio check` with this folder says what is wrong in this file, where, and what to do; `soffio explain` prints each\n\
         # value with its origin; `soffio schema exhibit` lists every key.\n\
         schema = \"exhibit/1\"\nmodel = \"{file}\"\nid = \"{id}\"\n\n[scene]\n"
    );
    let camera = model.nodes.iter().position(|node| node.camera.is_some());
    match camera {
        Some(node) => _ = writeln!(out, "camera = {}", quoted(&names.of(node))),
        None => out.push_str("# The model has no camera: its bounds are framed. camera = \"NodeName\" uses one.\n"),
    }
    out.push_str("# Level of all sounds: `soffio loudness --write` makes exhibits equally loud.\nlevel = \"0 dB\"\n\n");
    let moving = match physics {
        Some(physics) => {
            if physics.joints_open {
                out.push_str("# Some joints of the model are open at the start; the mechanism closes them.\n[solver]\nassemble = true\n\n");
            }
            out.push_str("# ---- from the model's own physics (KHR_physics_rigid_bodies) -------------------------------------------------\n\n");
            for remark in &physics.remarks {
                let _ = writeln!(out, "# {remark}");
            }
            if !physics.remarks.is_empty() {
                out.push('\n');
            }
            out.push_str(&physics.text);
            remarks.extend(physics.remarks);
            physics.moving
        }
        None => propose_bodies(&mut out, model, &names, remarks),
    };
    let seen: Vec<usize> = moving.iter().copied().filter(|&node| !meshes(model, node).is_empty()).collect();
    for (seed, node) in (1..).zip(&seen) {
        let name = quoted(&names.of(*node));
        let _ = write!(
            out,
            "[[wind_surface]]\nnode = {name}\nsampling = {{ per_area = \"4000 /m2\", min = 16, max = 64, seed = {seed} }}\n\n"
        );
    }
    let mut captions = Vec::new();
    if let Some(node) = seen.first() {
        let name = quoted(&names.of(*node));
        let _ = write!(
            out,
            "# `soffio sound --list` names the timbres; on = \"impact\" plays at impacts on a body.\n\
             [[sound]]\nname = \"air\"\nbody = {name}\non = \"wind\"\ntimbre = \"wind-room\"\ncaption = \"wind\"\n\n"
        );
        captions.push(("wind", ["[breath rushes past]", "[숨결이 스치는 소리]", "[fruscio del soffio]"]));
    }
    out.push_str(&attract(&[
        AttractBreath { at: 5.0, strength: 0.35, aim: [0.5, 0.5] },
        AttractBreath { at: 22.0, strength: 0.5, aim: [0.5, 0.6] },
    ]));
    out.push('\n');
    let words = in_three_languages(
        ["Replace this title", "제목을 바꾸세요", "Titolo da sostituire"],
        ["", "", ""],
        [
            "REPLACE: a description for visitors who cannot see it.".into(),
            "바꾸세요: 무엇이 보이는지.".into(),
            "DA SOSTITUIRE: che cosa si vede.".into(),
        ],
        &captions,
    );
    out.push_str(&labels(&words));
    if let Some(copyright) = json["asset"]["copyright"].as_str().filter(|text| !text.is_empty()) {
        remarks.push(format!("the model's copyright notice: {copyright}"));
        out = out.replace("\"REPLACE by the maker's name\"", &quoted(copyright));
    }
    out
}

/// Proposes bodies for a model without physics; returns the moving nodes.
fn propose_bodies(out: &mut String, model: &Model, names: &Names, remarks: &mut Vec<String>) -> Vec<usize> {
    out.push_str(
        "# ---- bodies, as proposed --------------------------------------------------------------------------------------\n\
         # A body moves as one with the nodes below it. Each hangs on a nail above its centre: put the nail where the object\n\
         # really hangs, or join two of them ([[constraint.point-to-point]]). Nodes that are not listed are fixed.\n\n",
    );
    // An empty node that contains everything is not an object itself.
    let mut objects: Vec<usize> = model.roots.clone();
    while let [only] = objects[..]
        && model.nodes[only].mesh.is_none()
    {
        objects = model.nodes[only].children.clone();
    }
    if objects.len() > MAX_PROPOSED {
        let count = objects.len();
        remarks
            .push(format!("{count} objects: bodies are proposed for the first {MAX_PROPOSED}, the others are fixed"));
        objects.truncate(MAX_PROPOSED);
    }
    let boxes: Vec<(DVec3, DVec3)> = objects.iter().map(|&node| bounds(&world_meshes(model, node))).collect();
    let mut moving = Vec::new();
    for (i, &node) in objects.iter().enumerate() {
        let (name, solids) = (names.of(node), world_meshes(model, node));
        if solids.is_empty() {
            continue;
        }
        let lower = model.nodes[node].name.to_lowercase();
        if let Some(word) = STATIC_WORDS.iter().find(|word| lower.contains(**word)) {
            remarks.push(format!("node \"{name}\" is fixed: its name contains \"{word}\""));
            continue;
        }
        let density = materials::builtin(MATERIAL).map_or(1.0, |material| material.density);
        let open = solids.iter().any(|mesh| mesh.open_edges() > 0);
        let moments = solids.iter().map(|mesh| {
            if mesh.open_edges() > 0 {
                mesh.sheet_moments(SHEET_THICKNESS, density)
            } else {
                mesh.solid_moments(density)
            }
        });
        let (mut mass, mut first) = (0.0, DVec3::ZERO);
        for own in moments {
            mass += own.mass;
            first += own.mass * own.center();
        }
        if mass <= 0.0 || !mass.is_finite() {
            remarks.push(format!("node \"{name}\" has no volume, or its faces point inwards: it is fixed"));
            continue;
        }
        let (low, high) = boxes[i];
        // The nail is above the object as on a cord, by a tenth of its height, at least 2 cm.
        let hook = (first / mass).with_y(high.y + (0.1 * (high.y - low.y)).max(0.02));
        let local = model.nodes[node].world.inverse().transform_point3(hook);
        let sheet_thickness = if open {
            format!("thickness = \"{} mm\"  # its mesh is open: treated as sheet\n", 1e3 * SHEET_THICKNESS)
        } else {
            String::new()
        };
        let (shown, node_name) = (hook.to_array().map(|x| (x * 1e4).round() / 1e4), quoted(&name));
        let _ = write!(
            out,
            "# {:.1} g as {MATERIAL}.\n[[body]]\nnode = {node_name}\nmaterial = \"{MATERIAL}\"\n{sheet_thickness}\n\
             # At {shown:?} m of the world.\n[[constraint.nail]]\nname = \"hangs-{node}\"\nbody = {node_name}\nat = {}\nto = {}\n\
             friction = {{ coefficient = 0.3, radius = \"0.3 mm\" }}\n\n",
            1e3 * mass,
            toml_vector(local),
            toml_vector(hook)
        );
        remarks
            .push(format!("node \"{name}\" is a body of {:.1} g as {MATERIAL}, nailed above its centre", 1e3 * mass));
        let touches = |k: usize| k != i && boxes[k].0.cmple(high).all() && low.cmple(boxes[k].1).all();
        if (0..objects.len()).any(touches) {
            remarks.push(format!("node \"{name}\" overlaps another's bounds: it has no collider yet"));
        } else if let Some(fit) = fit(model, node) {
            let _ = write!(out, "[[collider]]\nnode = {node_name}\nshape = {{ fit = \"{fit}\" }}\n\n");
        }
        moving.push(node);
    }
    if moving.is_empty() {
        remarks.push("nothing moves yet: declare a node as a [[body]]".to_owned());
    }
    moving
}

/// Bounding box of meshes; empty where there is none.
fn bounds(solids: &[TriangleMesh]) -> (DVec3, DVec3) {
    let none = (DVec3::splat(f64::INFINITY), DVec3::splat(f64::NEG_INFINITY));
    solids.iter().flat_map(|mesh| &mesh.positions).fold(none, |(low, high), p| (low.min(*p), high.max(*p)))
}

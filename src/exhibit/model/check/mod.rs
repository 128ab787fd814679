//! Checks a glTF document against the standard (glTF 2.0, Khronos Group 2021) before anything is decoded.
//!
//! First its objects by [`tables`], then what fields of several objects have to agree on: accessors and their buffers, the
//! node tree, primitives, animations, materials. An error stands where the picture or the motion would be wrong, or where
//! the meaning is uncertain; what makes no difference here is a warning.

mod animations;
mod buffers;
mod fields;
mod looks;
mod primitives;
mod scene;
pub mod tables;

use serde_json::{Value, json};

use super::fault::{Cause, Faults, Place};
use buffers::Use;
use fields::Walk;

/// The greatest version of glTF that is read.
const VERSION: (u64, u64) = (2, 0);

/// Checks a document and makes it one that the `gltf` crate can read.
pub fn document(root: &mut Value, faults: &mut Faults) {
    if !root.is_object() {
        faults.add(Cause::WrongType, "the document", "is no object; glTF is a JSON object with the field \"asset\"");
        return;
    }
    version(root, faults);
    unknown_types(root, faults);
    if !faults.errors.is_empty() {
        return;
    }
    Walk::new(root, faults).document(root);
    if !faults.errors.is_empty() {
        return;
    }
    unsupported_channels(root, faults);
    // A scene may be empty, but the crate wants the list.
    for scene in root.get_mut("scenes").and_then(Value::as_array_mut).into_iter().flatten() {
        if let Some(scene) = scene.as_object_mut() {
            scene.entry("nodes").or_insert_with(|| json!([]));
        }
    }
    let mut check = Check { root, faults, uses: Vec::new() };
    check.extensions();
    check.buffers();
    check.tree();
    if check.faults.errors.is_empty() {
        check.primitives();
        check.skins();
        check.animations();
        check.looks();
    }
}

/// A document whose objects are valid one by one.
struct Check<'a> {
    root: &'a Value,
    faults: &'a mut Faults,
    /// Use of each buffer view so far.
    uses: Vec<Option<Use>>,
}

impl<'a> Check<'a> {
    /// A top-level list.
    fn list(&self, key: &str) -> &'a [Value] {
        self.root[key].as_array().map_or(&[], Vec::as_slice)
    }

    fn warn(&mut self, place: impl std::fmt::Display, what: impl std::fmt::Display) {
        self.faults.add(Cause::Harmless, place, what);
    }

    /// Extensions that the document declares.
    fn extensions(&mut self) {
        let (used, required) = (self.list("extensionsUsed"), self.list("extensionsRequired"));
        for (i, name) in required.iter().enumerate().filter(|(_, name)| !used.contains(name)) {
            self.warn(format_args!("extensionsRequired[{i}]"), format_args!("{name} is not listed in extensionsUsed"));
        }
        let quantized = |name: &Value| name == "KHR_mesh_quantization";
        if used.iter().any(quantized) && !required.iter().any(quantized) {
            self.warn("extensionsUsed", "KHR_mesh_quantization has to be in extensionsRequired too");
        }
    }
}

/// An index or another whole number of an object.
fn whole(value: &Value, key: &str) -> Option<usize> {
    value.get(key)?.as_u64()?.try_into().ok()
}

fn version(root: &Value, faults: &mut Faults) {
    let Some(asset) = root.get("asset").filter(|asset| asset.is_object()) else { return };
    let read = |key: &str, faults: &mut Faults| {
        let text = asset.get(key)?.as_str()?;
        let digits = |part: &str| part.bytes().all(|b| b.is_ascii_digit()).then(|| part.parse::<u64>().ok()).flatten();
        let numbers = text.split_once('.').and_then(|(major, minor)| Some((digits(major)?, digits(minor)?)));
        if numbers.is_none() {
            let what = format_args!("is \"{text}\"; a version is two numbers with a point between them, such as 2.0");
            faults.add(Cause::Version, format_args!("asset.{key}"), what);
        }
        numbers
    };
    let (stated, least) = (read("version", faults), read("minVersion", faults));
    if let Some((major, minor)) = stated
        && major != VERSION.0
    {
        faults.add(Cause::Version, "asset.version", format_args!("is {major}.{minor}; glTF 2.0 is read"));
    }
    if let Some((major, minor)) = least
        && (major, minor) > VERSION
    {
        let what = format_args!("is {major}.{minor}: the model needs a reader of that version; glTF 2.0 is read");
        faults.add(Cause::Version, "asset.minVersion", what);
    }
}

/// Accessors and lights of types that are not known yet: allowed as long as nothing reads them. They become ones that the
/// crate can represent.
fn unknown_types(root: &mut Value, faults: &mut Faults) {
    for (index, light) in lights(root).iter_mut().enumerate() {
        let kind = light.get("type").and_then(Value::as_str).unwrap_or("spot");
        if !["directional", "point", "spot"].contains(&kind) {
            let place = format!("extensions.{}.lights[{index}].type", tables::PUNCTUAL);
            faults.add(Cause::Skipped, place, format_args!("is \"{kind}\", which is not known: the light is dark"));
            *light = json!({ "type": "point", "intensity": 0 });
        }
    }
    let unknown: Vec<(usize, &str)> = root["accessors"]
        .as_array()
        .into_iter()
        .flatten()
        .enumerate()
        .filter_map(|(index, accessor)| {
            let kind = accessor["type"].as_str().is_some_and(|kind| !tables::TYPES.contains(&kind));
            let code = accessor["componentType"].as_u64().is_some_and(|code| !tables::COMPONENTS.contains(&code));
            (kind || code).then_some((index, if kind { "type" } else { "componentType" }))
        })
        .collect();
    for (index, key) in unknown {
        let place = format!("accessors[{index}].{key}");
        let value = root["accessors"][index][key].take();
        if reads(root, index as u64) {
            faults.add(Cause::Format, place, format_args!("is {value}, which is not known, and the accessor is read"));
            continue;
        }
        faults.add(Cause::Skipped, place, format_args!("is {value}, which is not known; nothing reads the accessor"));
        root["accessors"][index] = json!({ "componentType": 5126, "count": 1, "type": "SCALAR" });
    }
}

fn lights(root: &mut Value) -> &mut [Value] {
    let held = root.get_mut("extensions").and_then(|all| all.get_mut(tables::PUNCTUAL)?.get_mut("lights"));
    held.and_then(Value::as_array_mut).map_or(&mut [], Vec::as_mut_slice)
}

/// Does a primitive, a skin or an animation read this accessor?
fn reads(root: &Value, accessor: u64) -> bool {
    let each = |value: &'_ Value| value.as_array().cloned().unwrap_or_default();
    let is = |value: &Value| value.as_f64() == Some(accessor as f64);
    let in_map = |map: &Value| map.as_object().is_some_and(|map| map.values().any(is));
    let primitive = |p: &Value| is(&p["indices"]) || in_map(&p["attributes"]) || each(&p["targets"]).iter().any(in_map);
    let sampler = |s: &Value| is(&s["input"]) || is(&s["output"]);
    each(&root["meshes"]).iter().any(|mesh| each(&mesh["primitives"]).iter().any(primitive))
        || each(&root["skins"]).iter().any(|skin| is(&skin["inverseBindMatrices"]))
        || each(&root["animations"]).iter().any(|animation| each(&animation["samplers"]).iter().any(sampler))
}

/// Removes channels that move no property of a node: those of extensions, and of paths that are not known.
fn unsupported_channels(root: &mut Value, faults: &mut Faults) {
    let animations = root.get_mut("animations").and_then(Value::as_array_mut);
    for (index, animation) in animations.into_iter().flatten().enumerate() {
        let Some(channels) = animation.get_mut("channels").and_then(Value::as_array_mut) else { continue };
        let mut at = 0;
        channels.retain(|channel| {
            let place = format!("animations[{index}].channels[{at}].target");
            at += 1;
            let target = &channel["target"];
            let moves = target.get("path").is_some() && target.get("node").is_some();
            if !moves {
                faults.add(Cause::Skipped, place, "moves no property of a node: the channel is not played");
            }
            moves
        });
    }
}

impl Walk<'_> {
    /// Walks through a document.
    fn document(&mut self, root: &mut Value) {
        self.object(root, &tables::ROOT, Place::Root);
    }
}

//! Primitives: formats and lengths of their attributes, indices and morph targets (glTF 2.0, section 3.7.2).

use std::collections::BTreeMap;

use serde_json::Value;

use super::super::fault::{Cause, Fault};
use super::buffers::{Use, component_name};
use super::{Check, whole};

/// Most elements of all attributes and morph targets together, each counted for every primitive that reads it: 400 MB when
/// decoded.
const MAX_ELEMENTS: usize = 32_000_000;

const BYTE: usize = 5120;
const UNSIGNED_BYTE: usize = 5121;
const SHORT: usize = 5122;
const UNSIGNED_SHORT: usize = 5123;
const UNSIGNED_INT: usize = 5125;
const FLOAT: usize = 5126;

/// An attribute's types and components, and the further components of KHR_mesh_quantization.
type Format = (&'static [&'static str], &'static [usize], &'static [usize]);

/// The format of an attribute; `None` where the standard does not know its name.
fn format(semantic: &str, target: bool) -> Option<Format> {
    let (base, set) = semantic.split_once('_').unwrap_or((semantic, ""));
    let numbered = !set.is_empty() && set.bytes().all(|b| b.is_ascii_digit()) && (set == "0" || !set.starts_with('0'));
    Some(match base {
        "POSITION" if set.is_empty() => (&["VEC3"], &[FLOAT], &[BYTE, UNSIGNED_BYTE, SHORT, UNSIGNED_SHORT]),
        "NORMAL" if set.is_empty() => (&["VEC3"], &[FLOAT], &[BYTE, SHORT]),
        "TANGENT" if set.is_empty() && target => (&["VEC3"], &[FLOAT], &[BYTE, SHORT]),
        "TANGENT" if set.is_empty() => (&["VEC4"], &[FLOAT], &[BYTE, SHORT]),
        "TEXCOORD" if numbered => (&["VEC2"], &[FLOAT, UNSIGNED_BYTE, UNSIGNED_SHORT], &[BYTE, SHORT]),
        "COLOR" if numbered => (&["VEC3", "VEC4"], &[FLOAT, UNSIGNED_BYTE, UNSIGNED_SHORT], &[]),
        "JOINTS" if numbered => (&["VEC4"], &[UNSIGNED_BYTE, UNSIGNED_SHORT], &[]),
        "WEIGHTS" if numbered => (&["VEC4"], &[FLOAT, UNSIGNED_BYTE, UNSIGNED_SHORT], &[]),
        _ => return None,
    })
}

impl Check<'_> {
    pub(super) fn primitives(&mut self) {
        let mut elements = 0_usize;
        for (m, mesh) in self.list("meshes").iter().enumerate() {
            let primitives = mesh["primitives"].as_array().map_or(&[][..], Vec::as_slice);
            for (index, primitive) in primitives.iter().enumerate() {
                elements =
                    elements.saturating_add(self.primitive(primitive, &format!("meshes[{m}].primitives[{index}]")));
            }
            self.targets_agree(mesh, primitives, m);
        }
        if elements > MAX_ELEMENTS {
            let what =
                format_args!("have {elements} elements of attributes and morph targets; the limit is {MAX_ELEMENTS}");
            self.faults.push(Fault::at(Cause::Limit, "meshes", what));
        }
        for (index, node) in self.list("nodes").iter().enumerate() {
            let (Some(mesh), Some(weights)) = (whole(node, "mesh"), node["weights"].as_array()) else { continue };
            self.weights(weights.len(), mesh, &format!("nodes[{index}].weights"));
        }
    }

    /// Checks a primitive; the number of its elements.
    fn primitive(&mut self, primitive: &Value, place: &str) -> usize {
        let none = serde_json::Map::new();
        let attributes = primitive["attributes"].as_object().unwrap_or(&none);
        let vertices = attributes.get("POSITION").and_then(Value::as_u64).map(|accessor| self.count(accessor as usize));
        let mut elements = 0_usize;
        let mut views: BTreeMap<usize, usize> = BTreeMap::new();
        for (semantic, accessor) in attributes {
            let accessor = accessor.as_u64().unwrap_or(0) as usize;
            let at = format!("{place}.attributes.{semantic}");
            elements = elements.saturating_add(self.elements(accessor));
            self.attribute(semantic, accessor, false, &at);
            let (count, wanted) = (self.count(accessor), vertices.unwrap_or(self.count(accessor)));
            if count != wanted {
                let what = format_args!("names accessors[{accessor}] of {count} elements; POSITION has {wanted}");
                self.faults.add(Cause::Count, &at, what);
            }
            if let Some(view) = whole(&self.list("accessors")[accessor], "bufferView") {
                let strided = self.list("bufferViews")[view].get("byteStride").is_some();
                let before = views.insert(view, accessor);
                if !strided && before.is_some_and(|other| other != accessor) {
                    self.warn(
                        &at,
                        format_args!("shares bufferViews[{view}], which has no byteStride; it is read as dense"),
                    );
                }
            }
        }
        self.sets(attributes, place);
        if let Some(indices) = whole(primitive, "indices") {
            let at = format!("{place}.indices");
            let (kind, component) = self.format(indices);
            if kind != "SCALAR" || ![UNSIGNED_BYTE, UNSIGNED_SHORT, UNSIGNED_INT].contains(&component) {
                let name = component_name(component);
                let what =
                    format_args!("names accessors[{indices}] of {kind} {name}; indices are SCALAR unsigned integers");
                self.faults.add(Cause::Format, &at, what);
            }
            elements = elements.saturating_add(self.elements(indices));
            self.accessor_used(indices, Use::Indices, &at);
        }
        for (t, target) in primitive["targets"].as_array().into_iter().flatten().enumerate() {
            for (semantic, accessor) in target.as_object().into_iter().flatten() {
                let accessor = accessor.as_u64().unwrap_or(0) as usize;
                let at = format!("{place}.targets[{t}].{semantic}");
                elements = elements.saturating_add(self.elements(accessor));
                self.attribute(semantic, accessor, true, &at);
                let Some(base) = attributes.get(semantic).and_then(Value::as_u64) else {
                    self.warn(&at, "changes an attribute that the primitive does not have; it is ignored");
                    continue;
                };
                let (count, wanted) = (self.count(accessor), self.count(base as usize));
                if count != wanted {
                    let what =
                        format_args!("names accessors[{accessor}] of {count} elements; the attribute has {wanted}");
                    self.faults.add(Cause::Count, &at, what);
                }
            }
        }
        self.texture_coordinates(primitive, attributes, place);
        elements
    }

    /// What an accessor adds to the elements: its count; 16 times that without a view, as a short file can claim any number
    /// of zeros.
    fn elements(&self, accessor: usize) -> usize {
        let weight = if self.list("accessors")[accessor].get("bufferView").is_some() { 1 } else { 16 };
        self.count(accessor).saturating_mul(weight)
    }

    fn attribute(&mut self, semantic: &str, accessor: usize, target: bool, at: &str) {
        let found = &self.list("accessors")[accessor];
        let (kind, component) =
            (found["type"].as_str().unwrap_or_default(), whole(found, "componentType").unwrap_or(0));
        self.accessor_used(accessor, Use::Vertices, at);
        if semantic == "POSITION" && (found.get("min").is_none() || found.get("max").is_none()) {
            self.warn(at, format_args!("names accessors[{accessor}], which has no min and max"));
        }
        self.aligned(accessor, at);
        if semantic.starts_with('_') {
            if component == UNSIGNED_INT {
                self.warn(at, "is of UNSIGNED_INT, which attributes may not be; it is ignored");
            }
            return;
        }
        let Some((kinds, components, quantized)) = format(semantic, target) else {
            self.warn(at, "is no attribute of glTF 2.0; it is ignored (names of your own begin with _)");
            return;
        };
        let name = component_name(component);
        if !kinds.contains(&kind) || !(components.contains(&component) || quantized.contains(&component)) {
            let names: Vec<&str> = components.iter().map(|&code| component_name(code)).collect();
            let what = format_args!(
                "names accessors[{accessor}] of {kind} {name}; {semantic} is {} of {}",
                kinds.join(" or "),
                names.join(", ")
            );
            self.faults.add(Cause::Format, at, what);
        } else if !components.contains(&component) && !self.declares("KHR_mesh_quantization") {
            self.warn(at, format_args!("is of {name}, and KHR_mesh_quantization is not in extensionsUsed"));
        }
    }

    /// Vertices begin at multiples of four bytes.
    fn aligned(&mut self, accessor: usize, at: &str) {
        let found = &self.list("accessors")[accessor];
        let Some(view) = whole(found, "bufferView") else { return };
        let start = whole(&self.list("bufferViews")[view], "byteOffset").unwrap_or(0);
        if !start.saturating_add(whole(found, "byteOffset").unwrap_or(0)).is_multiple_of(4) {
            self.warn(at, format_args!("names accessors[{accessor}], which does not begin at a multiple of 4 bytes"));
        }
    }

    pub(super) fn declares(&self, extension: &str) -> bool {
        self.list("extensionsUsed").iter().any(|name| name == extension)
    }

    /// Numbered attributes count from 0 without gaps; joints have weights.
    fn sets(&mut self, attributes: &serde_json::Map<String, Value>, place: &str) {
        let count = |base: &str| {
            attributes
                .keys()
                .filter(|key| {
                    key.strip_prefix(base).is_some_and(|rest| format(key, false).is_some() && !rest.is_empty())
                })
                .count()
        };
        for base in ["TEXCOORD_", "COLOR_", "JOINTS_", "WEIGHTS_"] {
            if let Some(gap) = (0..count(base)).find(|i| !attributes.contains_key(&format!("{base}{i}"))) {
                self.warn(format_args!("{place}.attributes"), format_args!("has no {base}{gap}, but a later one"));
            }
        }
        let (joints, weights) = (count("JOINTS_"), count("WEIGHTS_"));
        if joints != weights {
            let what = format_args!("has {joints} lists of JOINTS and {weights} of WEIGHTS");
            self.faults.add(Cause::Count, format_args!("{place}.attributes"), what);
        }
    }

    /// All primitives of a mesh have as many morph targets, and the mesh as many weights.
    fn targets_agree(&mut self, mesh: &Value, primitives: &[Value], index: usize) {
        let count = |primitive: &Value| primitive["targets"].as_array().map_or(0, Vec::len);
        let first = primitives.first().map_or(0, count);
        if let Some(other) = primitives.iter().position(|primitive| count(primitive) != first) {
            let what = format_args!("has {} morph targets; the first primitive has {first}", count(&primitives[other]));
            self.faults.add(Cause::Count, format_args!("meshes[{index}].primitives[{other}].targets"), what);
        }
        if let Some(weights) = mesh["weights"].as_array() {
            self.weights(weights.len(), index, &format!("meshes[{index}].weights"));
        }
    }

    fn weights(&mut self, weights: usize, mesh: usize, place: &str) {
        let targets = self.list("meshes")[mesh]["primitives"][0]["targets"].as_array().map_or(0, Vec::len);
        if weights != targets {
            let what = format_args!("has {weights} weights; meshes[{mesh}] has {targets} morph targets");
            self.faults.add(Cause::Count, place, what);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::format;

    #[test]
    fn attributes_are_known_by_name_and_number() {
        for name in ["POSITION", "TEXCOORD_0", "TEXCOORD_12", "WEIGHTS_1"] {
            assert!(format(name, false).is_some(), "{name}");
        }
        for name in ["POSITION_0", "TEXCOORD", "TEXCOORD_01", "TEXCOORD_x", "FOO", "NORMAL_"] {
            assert!(format(name, false).is_none() || name == "NORMAL_", "{name}");
        }
        assert_eq!(format("TANGENT", true).map(|f| f.0), Some(&["VEC3"][..]));
        assert_eq!(format("TANGENT", false).map(|f| f.0), Some(&["VEC4"][..]));
    }
}

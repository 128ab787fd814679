//! Writes a [`Model`] as a binary glTF 2.0 file: the inverse of [`soffio_exhibit::model::import`].
//!
//! Contents: visible nodes with content, their ancestors, and animated nodes; meshes as triangles of 32-bit floats;
//! images as PNG. The output is deterministic. Layout as in the glTF 2.0 specification, section 4.4: header, JSON
//! padded with spaces, binary chunk padded with zeros.

use serde_json::{Value, json};

use soffio_exhibit::model::{Curve, LightKind, Model, Node, Primitive, Track};
use soffio_math::DMat4;

mod materials;

const FLOAT: u32 = 5126;
const UNSIGNED_INT: u32 = 5125;
const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;
/// Largest difference of a matrix from the product of its parts, relative to its largest number.
const SHEAR: f64 = 1e-6;

/// The model as the bytes of a `.glb`; `copyright` is shown by viewers.
pub fn write(model: &Model, copyright: &str) -> Vec<u8> {
    let mut writer = Writer::default();
    let materials = writer.materials(model);
    let place = writer.nodes(model);
    writer.animations(model, &place);
    let Writer {
        nodes, meshes, accessors, views, mut binary, animations, images, textures, samplers, mut used, ..
    } = writer;
    let roots: Vec<_> = model.roots.iter().filter_map(|&root| place[root]).collect();
    let mut asset = json!({ "version": "2.0", "generator": "Soffio" });
    if !copyright.is_empty() {
        asset["copyright"] = json!(copyright);
    }
    binary.resize(binary.len().next_multiple_of(4), 0);
    let mut document = json!({ "asset": asset, "scene": 0, "scenes": [{ "nodes": roots }] });
    let lights: Vec<Value> = model.lights.iter().map(light).collect();
    if nodes.iter().any(|node| node["extensions"]["KHR_lights_punctual"].is_object()) {
        document["extensions"] = json!({ "KHR_lights_punctual": { "lights": lights } });
        used.push("KHR_lights_punctual");
    }
    let cameras: Vec<Value> = model.cameras.iter().map(camera).collect();
    let buffers = if binary.is_empty() { Vec::new() } else { vec![json!({ "byteLength": binary.len() })] };
    // glTF has no empty lists.
    for (key, list) in [
        ("nodes", nodes),
        ("meshes", meshes),
        ("materials", materials),
        ("cameras", cameras),
        ("animations", animations),
        ("images", images),
        ("textures", textures),
        ("samplers", samplers),
        ("accessors", accessors),
        ("bufferViews", views),
        ("buffers", buffers),
    ] {
        if !list.is_empty() {
            document[key] = Value::Array(list);
        }
    }
    used.sort_unstable();
    used.dedup();
    if !used.is_empty() {
        document["extensionsUsed"] = json!(used);
    }
    container(document.to_string().into_bytes(), &binary)
}

/// A JSON document and its buffer (of whole words; may be empty) as one binary file: glTF 2.0, section 4.4.
pub fn container(mut text: Vec<u8>, binary: &[u8]) -> Vec<u8> {
    text.resize(text.len().next_multiple_of(4), b' ');
    let length = 12 + 8 + text.len() + if binary.is_empty() { 0 } else { 8 + binary.len() };
    let mut file = Vec::with_capacity(length);
    let word = |file: &mut Vec<u8>, value: usize| file.extend_from_slice(&(value as u32).to_le_bytes());
    file.extend_from_slice(b"glTF");
    word(&mut file, 2);
    word(&mut file, length);
    word(&mut file, text.len());
    file.extend_from_slice(b"JSON");
    file.extend_from_slice(&text);
    if !binary.is_empty() {
        word(&mut file, binary.len());
        file.extend_from_slice(b"BIN\0");
        file.extend_from_slice(binary);
    }
    file
}

#[derive(Default)]
struct Writer {
    nodes: Vec<Value>,
    meshes: Vec<Value>,
    /// Index of each mesh in the file.
    written: Vec<Option<usize>>,
    accessors: Vec<Value>,
    views: Vec<Value>,
    binary: Vec<u8>,
    animations: Vec<Value>,
    images: Vec<Value>,
    textures: Vec<Value>,
    samplers: Vec<Value>,
    used: Vec<&'static str>,
}

impl Writer {
    /// Writes the nodes; returns the index of each in the file.
    fn nodes(&mut self, model: &Model) -> Vec<Option<usize>> {
        let mut wanted = vec![false; model.nodes.len()];
        let moved = model.animations.iter().flat_map(|a| &a.channels).map(|channel| channel.node);
        let carries = |node: &Node| {
            let drawn = node.mesh.is_some_and(|m| model.meshes[m].primitives.iter().any(|p| !p.indices.is_empty()));
            drawn || node.camera.is_some() || node.light.is_some()
        };
        for from in moved.chain((0..model.nodes.len()).filter(|&i| carries(&model.nodes[i]))) {
            let mut at = Some(from);
            while let Some(index) = at.filter(|&index| !wanted[index]) {
                wanted[index] = true;
                at = model.nodes[index].parent;
            }
        }
        model.hidden.iter().for_each(|&index| wanted[index] = false);
        let mut place = vec![None; model.nodes.len()];
        for (count, index) in (0..model.nodes.len()).filter(|&i| wanted[i]).enumerate() {
            place[index] = Some(count);
        }
        self.written = vec![None; model.meshes.len()];
        for (index, node) in model.nodes.iter().enumerate().filter(|(i, _)| wanted[*i]) {
            let moves = model.animations.iter().flat_map(|a| &a.channels).any(|channel| channel.node == index);
            let mut out = json!({ "name": node.name });
            transform(&mut out, &node.local, moves);
            let children: Vec<_> = node.children.iter().filter_map(|&child| place[child]).collect();
            if !children.is_empty() {
                out["children"] = json!(children);
            }
            if let Some(mesh) = node.mesh.and_then(|mesh| self.mesh(model, mesh)) {
                out["mesh"] = json!(mesh);
            }
            if let Some(camera) = node.camera {
                out["camera"] = json!(camera);
            }
            if let Some(light) = node.light {
                out["extensions"] = json!({ "KHR_lights_punctual": { "light": light } });
            }
            self.nodes.push(out);
        }
        place
    }

    /// Writes a mesh once; `None` where it has nothing to draw.
    fn mesh(&mut self, model: &Model, index: usize) -> Option<usize> {
        if self.written[index].is_none() {
            let mesh = &model.meshes[index];
            let drawn = mesh.primitives.iter().filter(|primitive| !primitive.indices.is_empty());
            let primitives: Vec<Value> = drawn.map(|primitive| self.primitive(primitive)).collect();
            if primitives.is_empty() {
                return None;
            }
            self.written[index] = Some(self.meshes.len());
            self.meshes.push(json!({ "name": mesh.name, "primitives": primitives }));
        }
        self.written[index]
    }

    fn primitive(&mut self, primitive: &Primitive) -> Value {
        let position = self.vectors(&primitive.positions, "VEC3", Some(ARRAY_BUFFER));
        let bound = |pick: fn(f32, f32) -> f32| {
            let corners = primitive.positions.iter().copied();
            corners.reduce(|a, b| std::array::from_fn(|i| pick(a[i], b[i]))).unwrap_or_default()
        };
        self.accessors[position]["min"] = json!(bound(f32::min));
        self.accessors[position]["max"] = json!(bound(f32::max));
        let normals: Vec<[f32; 3]> = primitive.normals.iter().map(|n| unit(*n)).collect();
        let mut attributes =
            json!({ "POSITION": position, "NORMAL": self.vectors(&normals, "VEC3", Some(ARRAY_BUFFER)) });
        if !primitive.tangents.is_empty() {
            let straight = |t: &[f32; 4]| {
                let [x, y, z] = unit([t[0], t[1], t[2]]);
                [x, y, z, if t[3] < 0.0 { -1.0 } else { 1.0 }]
            };
            let tangents: Vec<[f32; 4]> = primitive.tangents.iter().map(straight).collect();
            attributes["TANGENT"] = json!(self.vectors(&tangents, "VEC4", Some(ARRAY_BUFFER)));
        }
        for (name, uvs) in [("TEXCOORD_0", &primitive.uvs), ("TEXCOORD_1", &primitive.second_uvs)] {
            if !uvs.is_empty() {
                attributes[name] = json!(self.vectors(uvs, "VEC2", Some(ARRAY_BUFFER)));
            }
        }
        if !primitive.colors.is_empty() {
            let within: Vec<[f32; 4]> = primitive.colors.iter().map(|c| c.map(|x| x.clamp(0.0, 1.0))).collect();
            attributes["COLOR_0"] = json!(self.vectors(&within, "VEC4", Some(ARRAY_BUFFER)));
        }
        let bytes = bytemuck::cast_slice(&primitive.indices);
        let indices = self.accessor(bytes, UNSIGNED_INT, "SCALAR", primitive.indices.len(), Some(ELEMENT_ARRAY_BUFFER));
        let mut out = json!({ "attributes": attributes, "indices": indices });
        if let Some(material) = primitive.material {
            out["material"] = json!(material);
        }
        out
    }

    fn animations(&mut self, model: &Model, place: &[Option<usize>]) {
        for animation in &model.animations {
            let (mut channels, mut samplers) = (Vec::new(), Vec::new());
            for channel in &animation.channels {
                let Some(node) = place[channel.node] else { continue };
                let (path, output) = match &channel.track {
                    Track::Translation(values) => {
                        let values: Vec<[f32; 3]> = values.iter().map(|v| v.as_vec3().to_array()).collect();
                        ("translation", self.vectors(&values, "VEC3", None))
                    }
                    Track::Rotation(values) => {
                        let values: Vec<[f32; 4]> = values.iter().map(|q| q.as_quat().to_array()).collect();
                        ("rotation", self.vectors(&values, "VEC4", None))
                    }
                    Track::Scale(values, ..) => {
                        let values: Vec<[f32; 3]> = values.iter().map(|v| v.as_vec3().to_array()).collect();
                        ("scale", self.vectors(&values, "VEC3", None))
                    }
                    // Meshes are written in their rest shape.
                    Track::Weights(_) => continue,
                };
                let times: Vec<[f32; 1]> = channel.times.iter().map(|t| [*t as f32]).collect();
                let input = self.vectors(&times, "SCALAR", None);
                self.accessors[input]["min"] = json!(times.first());
                self.accessors[input]["max"] = json!(times.last());
                let interpolation = match channel.curve {
                    Curve::Step => "STEP",
                    Curve::Linear => "LINEAR",
                    Curve::Cubic => "CUBICSPLINE",
                };
                channels.push(json!({ "sampler": samplers.len(), "target": { "node": node, "path": path } }));
                samplers.push(json!({ "input": input, "output": output, "interpolation": interpolation }));
            }
            if !channels.is_empty() {
                self.animations.push(json!({ "name": animation.name, "channels": channels, "samplers": samplers }));
            }
        }
    }

    fn vectors<const LANES: usize>(&mut self, values: &[[f32; LANES]], shape: &str, target: Option<u32>) -> usize
    where
        [f32; LANES]: bytemuck::Pod,
    {
        self.accessor(bytemuck::cast_slice(values), FLOAT, shape, values.len(), target)
    }

    fn accessor(&mut self, bytes: &[u8], component: u32, shape: &str, count: usize, target: Option<u32>) -> usize {
        let view = self.view(bytes);
        if let Some(target) = target {
            self.views[view]["target"] = json!(target);
        }
        let accessor = json!({ "bufferView": view, "componentType": component, "count": count, "type": shape });
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }

    /// Adds bytes to the binary chunk, aligned for accessors of four bytes.
    fn view(&mut self, bytes: &[u8]) -> usize {
        self.binary.resize(self.binary.len().next_multiple_of(4), 0);
        self.views.push(json!({ "buffer": 0, "byteOffset": self.binary.len(), "byteLength": bytes.len() }));
        self.binary.extend_from_slice(bytes);
        self.views.len() - 1
    }
}

/// Writes a transform by its parts, which animated nodes require; a sheared one as its matrix.
fn transform(out: &mut Value, local: &DMat4, moves: bool) {
    let (scale, rotation, translation) = local.to_scale_rotation_translation();
    let again = DMat4::from_scale_rotation_translation(scale, rotation, translation);
    let size = local.to_cols_array().iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    if !moves && !again.abs_diff_eq(*local, SHEAR * size) {
        out["matrix"] = json!(local.to_cols_array());
        return;
    }
    if translation != soffio_math::DVec3::ZERO {
        out["translation"] = json!(translation.to_array());
    }
    if rotation != soffio_math::DQuat::IDENTITY {
        out["rotation"] = json!(rotation.normalize().to_array());
    }
    if !scale.abs_diff_eq(soffio_math::DVec3::ONE, f64::EPSILON * 8.0) {
        out["scale"] = json!(scale.to_array());
    }
}

fn camera(camera: &soffio_exhibit::model::Camera) -> Value {
    let mut lens = json!({ "yfov": camera.fovy, "znear": 0.01, "zfar": 100.0 });
    if let Some(aspect) = camera.aspect {
        lens["aspectRatio"] = json!(aspect);
    }
    json!({ "type": "perspective", "perspective": lens })
}

fn light(light: &soffio_exhibit::model::Light) -> Value {
    let mut out = json!({ "color": light.color.to_array(), "intensity": light.intensity });
    if light.range.is_finite() && light.kind != LightKind::Directional {
        out["range"] = json!(light.range);
    }
    out["type"] = match light.kind {
        LightKind::Directional => json!("directional"),
        LightKind::Point => json!("point"),
        LightKind::Spot(inner, outer) => {
            out["spot"] = json!({ "innerConeAngle": inner, "outerConeAngle": outer });
            json!("spot")
        }
    };
    out
}

/// Normalises a vector; a zero one points up.
fn unit(v: [f32; 3]) -> [f32; 3] {
    glam::Vec3::from_array(v).normalize_or(glam::Vec3::Y).to_array()
}

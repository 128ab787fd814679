//! Small models written by the tests themselves.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};

/// A folder that vanishes with the test.
pub struct Folder(tempfile::TempDir);

impl Folder {
    /// A folder with `model.glb` and an `exhibit.toml` that begins with its two required keys.
    pub fn exhibit(model: &[u8], sidecar: &str) -> Self {
        let folder = Self(tempfile::tempdir().expect("a temporary folder"));
        folder.write("model.glb", model);
        folder.write("exhibit.toml", format!("schema = \"exhibit/1\"\nmodel = \"model.glb\"\n{sidecar}").as_bytes());
        folder
    }

    pub fn write(&self, name: &str, bytes: &[u8]) {
        std::fs::write(self.0.path().join(name), bytes).expect("a writable folder");
    }

    pub fn path(&self) -> &Path {
        self.0.path()
    }

    pub fn file(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }
}

/// Positions and triangles.
pub type Shape = (Vec<[f32; 3]>, Vec<u32>);

/// A closed box of full lengths `size` about the origin, outward.
pub fn cuboid(size: [f32; 3]) -> Shape {
    let corner = |i: u32| [0, 1, 2].map(|k| if i & (1 << k) == 0 { -0.5 * size[k] } else { 0.5 * size[k] });
    let quads = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let triangles = quads.iter().flat_map(|q: &[u32; 4]| [q[0], q[1], q[2], q[0], q[2], q[3]]);
    ((0..8).map(corner).collect(), triangles.collect())
}

/// An open rectangle in the xy plane.
pub fn sheet(width: f32, height: f32) -> Shape {
    let (x, y) = (0.5 * width, 0.5 * height);
    (vec![[-x, -y, 0.0], [x, -y, 0.0], [x, y, 0.0], [-x, y, 0.0]], vec![0, 1, 2, 0, 2, 3])
}

/// A scene in the making: glTF JSON and its binary chunk.
#[derive(Default)]
pub struct Scene {
    nodes: Vec<Value>,
    meshes: Vec<Value>,
    accessors: Vec<Value>,
    views: Vec<Value>,
    binary: Vec<u8>,
    animations: Vec<Value>,
    /// Put into the document's top level as they are.
    pub extra: Vec<(&'static str, Value)>,
}

impl Scene {
    /// Adds a node with these children; its index.
    pub fn node(&mut self, name: &str, at: [f32; 3], shape: Option<&Shape>, children: &[usize]) -> usize {
        let mut node = json!({ "name": name, "translation": at });
        if let Some(shape) = shape {
            node["mesh"] = json!(self.mesh(shape, 4));
        }
        if !children.is_empty() {
            node["children"] = json!(children);
        }
        self.nodes.push(node);
        self.nodes.len() - 1
    }

    /// Changes a node's JSON.
    pub fn set(&mut self, node: usize, key: &str, value: Value) {
        self.nodes[node][key] = value;
    }

    /// Adds a mesh of this primitive mode; its index.
    pub fn mesh(&mut self, (positions, indices): &Shape, mode: u32) -> usize {
        let bytes: Vec<u8> = positions.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
        let (lo, hi) = positions.iter().fold(([f32::MAX; 3], [f32::MIN; 3]), |(lo, hi), p| {
            ([0, 1, 2].map(|k| lo[k].min(p[k])), [0, 1, 2].map(|k| hi[k].max(p[k])))
        });
        let position = self.accessor(
            &bytes,
            json!({ "componentType": 5126, "type": "VEC3", "count": positions.len(), "min": lo, "max": hi }),
        );
        let bytes: Vec<u8> = indices.iter().flat_map(|i| i.to_le_bytes()).collect();
        let index = self.accessor(&bytes, json!({ "componentType": 5125, "type": "SCALAR", "count": indices.len() }));
        self.meshes.push(
            json!({ "primitives": [{ "attributes": { "POSITION": position }, "indices": index, "mode": mode }] }),
        );
        self.meshes.len() - 1
    }

    /// Adds a mesh of the first material with these texture coordinates; its index.
    pub fn textured(&mut self, shape: &Shape, uvs: &[[f32; 2]]) -> usize {
        let mesh = self.mesh(shape, 4);
        let bytes: Vec<u8> = uvs.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
        let flat = self.accessor(&bytes, json!({ "componentType": 5126, "type": "VEC2", "count": uvs.len() }));
        self.meshes[mesh]["primitives"][0]["attributes"]["TEXCOORD_0"] = json!(flat);
        self.meshes[mesh]["primitives"][0]["material"] = json!(0);
        mesh
    }

    /// Adds morph targets to a mesh: what each adds to its positions.
    pub fn morph(&mut self, mesh: usize, targets: &[Vec<[f32; 3]>]) {
        let mut list = Vec::new();
        for target in targets {
            let bytes: Vec<u8> = target.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
            let (lo, hi) = target.iter().fold(([f32::MAX; 3], [f32::MIN; 3]), |(lo, hi), p| {
                ([0, 1, 2].map(|k| lo[k].min(p[k])), [0, 1, 2].map(|k| hi[k].max(p[k])))
            });
            let vectors = json!({ "componentType": 5126, "type": "VEC3", "count": target.len(), "min": lo, "max": hi });
            list.push(json!({ "POSITION": self.accessor(&bytes, vectors) }));
        }
        self.meshes[mesh]["primitives"][0]["targets"] = json!(list);
    }

    /// Adds an animation named `name` of one channel: `path` is "translation", "rotation", "scale" or "weights", `keys` hold a
    /// time and its numbers (three times as many where `interpolation` is "CUBICSPLINE").
    pub fn animate(&mut self, name: &str, node: usize, path: &str, interpolation: &str, keys: &[(f32, Vec<f32>)]) {
        let times: Vec<u8> = keys.iter().flat_map(|(t, _)| t.to_le_bytes()).collect();
        let (first, last) = (keys[0].0, keys[keys.len() - 1].0);
        let scalar = json!({
            "componentType": 5126, "type": "SCALAR", "count": keys.len(), "min": [first], "max": [last],
        });
        let input = self.accessor(&times, scalar);
        let values: Vec<u8> = keys.iter().flat_map(|(_, v)| v.iter().flat_map(|x| x.to_le_bytes())).collect();
        let (shape, lanes) = match path {
            "rotation" => ("VEC4", 4),
            "weights" => ("SCALAR", 1),
            _ => ("VEC3", 3),
        };
        let count = keys.iter().map(|(_, v)| v.len()).sum::<usize>() / lanes;
        let output = self.accessor(&values, json!({ "componentType": 5126, "type": shape, "count": count }));
        self.animations.push(json!({
            "name": name,
            "samplers": [{ "input": input, "output": output, "interpolation": interpolation }],
            "channels": [{ "sampler": 0, "target": { "node": node, "path": path } }],
        }));
    }

    /// Makes all animations of this name one.
    pub fn merge(&mut self, name: &str) {
        let (same, mut kept): (Vec<Value>, Vec<Value>) =
            std::mem::take(&mut self.animations).into_iter().partition(|animation| animation["name"] == name);
        let mut one = json!({ "name": name, "samplers": [], "channels": [] });
        for (index, animation) in same.iter().enumerate() {
            let mut channel = animation["channels"][0].clone();
            channel["sampler"] = json!(index);
            for (list, item) in [("samplers", animation["samplers"][0].clone()), ("channels", channel)] {
                one[list].as_array_mut().expect("a list").push(item);
            }
        }
        kept.push(one);
        self.animations = kept;
    }

    fn accessor(&mut self, bytes: &[u8], mut accessor: Value) -> usize {
        self.views.push(json!({ "buffer": 0, "byteOffset": self.binary.len(), "byteLength": bytes.len() }));
        self.binary.extend_from_slice(bytes);
        accessor["bufferView"] = json!(self.views.len() - 1);
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }

    /// The whole file.
    pub fn glb(&self) -> Vec<u8> {
        let mut child = vec![false; self.nodes.len()];
        for node in &self.nodes {
            for index in node["children"].as_array().into_iter().flatten() {
                child[index.as_u64().expect("an index") as usize] = true;
            }
        }
        let roots: Vec<usize> = (0..child.len()).filter(|&i| !child[i]).collect();
        let mut root = json!({
            "asset": { "version": "2.0" },
            "scene": 0,
            "scenes": [{ "nodes": roots }],
            "nodes": self.nodes,
        });
        if !self.meshes.is_empty() {
            root["meshes"] = json!(self.meshes);
        }
        if !self.animations.is_empty() {
            root["animations"] = json!(self.animations);
        }
        if !self.accessors.is_empty() {
            root["accessors"] = json!(self.accessors);
            root["bufferViews"] = json!(self.views);
            root["buffers"] = json!([{ "byteLength": self.binary.len() }]);
        }
        for (key, value) in &self.extra {
            root[*key] = value.clone();
        }
        assemble(root.to_string().into_bytes(), self.binary.clone())
    }
}

/// Header, JSON chunk, binary chunk (glTF 2.0, 4.4).
pub fn assemble(mut json: Vec<u8>, mut binary: Vec<u8>) -> Vec<u8> {
    json.resize(json.len().next_multiple_of(4), b' ');
    binary.resize(binary.len().next_multiple_of(4), 0);
    let mut out = b"glTF".to_vec();
    let chunk = |kind: u32, bytes: &[u8]| {
        let head = [(bytes.len() as u32).to_le_bytes(), kind.to_le_bytes()].concat();
        [head, bytes.to_vec()].concat()
    };
    let mut body = chunk(0x4E4F_534A, &json);
    if !binary.is_empty() {
        body.extend(chunk(0x004E_4942, &binary));
    }
    out.extend(2_u32.to_le_bytes());
    out.extend((12 + body.len() as u32).to_le_bytes());
    out.extend(body);
    out
}

/// Post (still), Boom with Weight, Plate on the boom's tip, an open Flag, and two nodes named Twin.
pub fn boom_and_plate() -> Vec<u8> {
    let mut scene = Scene::default();
    let tip = scene.node("Tip", [0.5, 0.0, 0.0], None, &[]);
    let end = scene.node("End", [-0.5, 0.0, 0.0], None, &[]);
    let weight = scene.node("Weight", [-0.4, 0.0, 0.0], Some(&cuboid([0.02, 0.02, 0.02])), &[]);
    scene.node("Boom", [0.0, 1.0, 0.0], None, &[tip, end, weight]);
    let hook = scene.node("Hook", [0.0, 0.1, 0.0], None, &[]);
    scene.node("Plate", [0.5, 0.9, 0.0], Some(&cuboid([0.1, 0.2, 0.001])), &[hook]);
    scene.node("Post", [0.0, 0.5, 0.0], Some(&cuboid([0.01, 1.0, 0.01])), &[]);
    scene.node("Flag", [0.0, 2.0, 0.0], Some(&sheet(0.2, 0.1)), &[]);
    scene.node("Twin", [0.0, 3.0, 0.0], None, &[]);
    scene.node("Twin", [0.0, 4.0, 0.0], None, &[]);
    let stretched = scene.node("Stretched", [0.0, 5.0, 0.0], Some(&cuboid([0.1; 3])), &[]);
    scene.set(stretched, "scale", json!([1.0, 2.0, 1.0]));
    scene.glb()
}

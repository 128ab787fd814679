//! Writer of binary glTF 2.0 files from meshes, finishes and cameras.
//!
//! The output is deterministic: JSON keys are sorted, lengths rounded to 0.1 µm, positions and normals stored as 32-bit
//! floats. Layout as in the glTF 2.0 specification, section 4.4: a 12-byte header, the JSON chunk padded with spaces,
//! the binary chunk with zeros.

use std::collections::BTreeMap;

use serde_json::{Value, json};

use super::solid::Solid;
use crate::model_writer::container;
use soffio_exhibit::model::FINISH;
use soffio_math::{DQuat, DVec3, Pose};

const FLOAT: u32 = 5126;
const UNSIGNED_SHORT: u32 = 5123;
const UNSIGNED_INT: u32 = 5125;
const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;

/// Surface finish (glTF metallic–roughness).
#[derive(Clone, Copy, Debug)]
pub struct Finish {
    /// Name in the file.
    pub name: &'static str,
    /// Base colour, linear RGB.
    pub color: [f64; 3],
    /// Metalness: 0 paint … 1 bare metal.
    pub metallic: f64,
    /// Perceptual roughness, 0…1.
    pub roughness: f64,
    /// Name of what gives it its visible structure, one of [`soffio_exhibit::finish::FINISHES`].
    pub finish: Option<&'static str>,
}

/// Optical properties of glass.
#[derive(Clone, Copy, Debug)]
pub struct Glass {
    /// Thickness of the wall, m.
    pub wall_thickness: f64,
    /// Index of refraction n: 1.5 for window glass.
    pub ior: f64,
    /// Transmitted fraction of the light, 0…1.
    pub transmission: f64,
    /// Attenuation colour: what white light becomes after `attenuation_distance`, linear RGB.
    pub attenuation_color: [f64; 3],
    /// Attenuation distance, m.
    pub attenuation_distance: f64,
}

/// A picture on a finish, laid flat over the part's own x and y.
#[derive(Clone, Debug)]
pub struct Picture {
    /// RGB, row by row from the top (the largest y).
    pub pixels: image::RgbImage,
    /// Length along x and y that it covers, centred on the part's origin, m.
    pub size: [f64; 2],
}

/// A key of a node's way.
#[derive(Clone, Copy, Debug)]
pub struct Key {
    /// Time, s.
    pub time: f64,
    /// Place of the node in its parent, m.
    pub place: DVec3,
    /// Velocity of the node, m/s.
    pub velocity: DVec3,
}

/// A glTF scene under construction.
#[derive(Debug, Default)]
pub struct Scene {
    animations: Vec<Value>,
    images: Vec<Value>,
    /// Sizes of the pictures of finishes.
    pictures: BTreeMap<usize, [f64; 2]>,
    nodes: Vec<Value>,
    children: Vec<Vec<usize>>,
    roots: Vec<usize>,
    meshes: Vec<Value>,
    materials: Vec<Value>,
    skins: Vec<Value>,
    cameras: Vec<Value>,
    accessors: Vec<Value>,
    views: Vec<Value>,
    binary: Vec<u8>,
}

impl Scene {
    /// Adds an empty node and returns its index; `translation` in m, in the frame of `parent`.
    pub fn node(&mut self, name: &str, parent: Option<usize>, translation: DVec3, rotation: DQuat) -> usize {
        let index = self.nodes.len();
        let mut node = json!({ "name": name });
        if translation != DVec3::ZERO {
            node["translation"] = json!(rounded(&translation.to_array(), 1e7));
        }
        if rotation != DQuat::IDENTITY {
            node["rotation"] = json!(rounded(&rotation.to_array(), 1e9));
        }
        self.nodes.push(node);
        self.children.push(Vec::new());
        match parent {
            Some(parent) => self.children[parent].push(index),
            None => self.roots.push(index),
        }
        index
    }

    /// Adds a marker: an empty node that names a point of its parent's frame.
    pub fn marker(&mut self, name: &str, parent: Option<usize>, point: DVec3) {
        self.node(name, parent, point, DQuat::IDENTITY);
    }

    /// Adds a finish and returns its index.
    pub fn finish(&mut self, finish: &Finish) -> usize {
        let [r, g, b] = finish.color;
        let mut material = json!({
            "name": finish.name,
            "pbrMetallicRoughness": {
                "baseColorFactor": [r, g, b, 1.0],
                "metallicFactor": finish.metallic,
                "roughnessFactor": finish.roughness,
            },
        });
        if let Some(structure) = finish.finish {
            material["extras"] = json!({ FINISH: structure });
        }
        self.materials.push(material);
        self.materials.len() - 1
    }

    /// Makes a finish transparent, as the wall of a glass body.
    pub fn clear(&mut self, finish: usize, glass: &Glass) {
        let Glass { wall_thickness, ior, transmission, attenuation_color, attenuation_distance } = glass;
        self.materials[finish]["extensions"] = json!({
            "KHR_materials_ior": { "ior": ior },
            "KHR_materials_transmission": { "transmissionFactor": transmission },
            "KHR_materials_volume": {
                "attenuationColor": attenuation_color,
                "attenuationDistance": attenuation_distance,
                "thicknessFactor": wall_thickness,
            },
        });
    }

    /// Lays a picture on a finish, as PNG inside the file; its colour multiplies the picture's.
    ///
    /// # Errors
    /// The picture cannot be encoded.
    pub fn picture(&mut self, finish: usize, picture: &Picture) -> Result<(), image::ImageError> {
        let mut png = std::io::Cursor::new(Vec::new());
        picture.pixels.write_to(&mut png, image::ImageFormat::Png)?;
        let mut bytes = png.into_inner();
        let length = bytes.len();
        // The next view must begin at a multiple of four.
        bytes.resize(length.next_multiple_of(4), 0);
        self.views.push(json!({ "buffer": 0, "byteOffset": self.binary.len(), "byteLength": length }));
        self.binary.extend_from_slice(&bytes);
        self.images.push(json!({ "bufferView": self.views.len() - 1, "mimeType": "image/png" }));
        self.materials[finish]["pbrMetallicRoughness"]["baseColorTexture"] = json!({ "index": self.images.len() - 1 });
        self.pictures.insert(finish, picture.size);
        Ok(())
    }

    /// Moves a node along a smooth way through its keys (cubic splines of glTF), as an animation of this title.
    pub fn animate(&mut self, title: &str, node: usize, keys: &[Key]) {
        let times: Vec<f32> = keys.iter().map(|key| key.time as f32).collect();
        let ways: Vec<[f32; 3]> = keys
            .iter()
            .flat_map(|key| [key.velocity, key.place, key.velocity])
            .map(|value| value.as_vec3().to_array())
            .collect();
        let input = self.accessor(bytemuck::cast_slice(&times), FLOAT, "SCALAR", times.len(), 0);
        self.accessors[input]["min"] = json!([times.first()]);
        self.accessors[input]["max"] = json!([times.last()]);
        let output = self.accessor(bytemuck::cast_slice(&ways), FLOAT, "VEC3", ways.len(), 0);
        self.animations.push(json!({
            "name": title,
            "channels": [{ "sampler": 0, "target": { "node": node, "path": "translation" } }],
            "samplers": [{ "input": input, "output": output, "interpolation": "CUBICSPLINE" }],
        }));
    }

    /// Draws both sides of a finish: of cloth, which has no thickness in the model.
    pub fn two_sided(&mut self, finish: usize) {
        self.materials[finish]["doubleSided"] = json!(true);
    }

    /// Gives `node` the mesh of `solid` with a finish, as a skin: each vertex follows up to four of the joints by its weights
    /// (index of the joint, share). The joints are nodes, each with its pose in the model, which is the skin's too.
    pub fn skin(
        &mut self,
        node: usize,
        solid: &Solid,
        finish: usize,
        weights: &[[(u16, f64); 4]],
        joints: &[(usize, Pose)],
    ) {
        self.mesh(node, solid, finish);
        let indices: Vec<[u16; 4]> = weights.iter().map(|vertex| vertex.map(|(joint, _)| joint)).collect();
        let shares: Vec<[f32; 4]> = weights.iter().map(|vertex| vertex.map(|(_, share)| share as f32)).collect();
        let to_joint = |(_, pose): &(usize, Pose)| pose.matrix().inverse().as_mat4().to_cols_array();
        let bind: Vec<[f32; 16]> = joints.iter().map(to_joint).collect();
        let index = self.accessor(bytemuck::cast_slice(&indices), UNSIGNED_SHORT, "VEC4", indices.len(), ARRAY_BUFFER);
        let share = self.accessor(bytemuck::cast_slice(&shares), FLOAT, "VEC4", shares.len(), ARRAY_BUFFER);
        let bind = self.accessor(bytemuck::cast_slice(&bind), FLOAT, "MAT4", bind.len(), 0);
        if let Some(mesh) = self.meshes.last_mut() {
            mesh["primitives"][0]["attributes"]["JOINTS_0"] = json!(index);
            mesh["primitives"][0]["attributes"]["WEIGHTS_0"] = json!(share);
        }
        self.nodes[node]["skin"] = json!(self.skins.len());
        let nodes: Vec<usize> = joints.iter().map(|(joint, _)| *joint).collect();
        self.skins.push(json!({ "joints": nodes, "inverseBindMatrices": bind }));
    }

    /// Gives `node` the mesh of `solid` with a finish.
    pub fn mesh(&mut self, node: usize, solid: &Solid, finish: usize) {
        let single = |v: &DVec3| v.as_vec3().to_array();
        let positions: Vec<[f32; 3]> = solid.positions.iter().map(single).collect();
        let normals: Vec<[f32; 3]> = solid.normals.iter().map(single).collect();
        let bound = |pick: fn(f32, f32) -> f32| {
            positions.iter().copied().reduce(|a, b| std::array::from_fn(|i| pick(a[i], b[i]))).unwrap_or_default()
        };
        let (low, high) = (bound(f32::min), bound(f32::max));
        let indices: Vec<u32> = solid.triangles.iter().flatten().copied().collect();

        let position = self.accessor(bytemuck::cast_slice(&positions), FLOAT, "VEC3", positions.len(), ARRAY_BUFFER);
        self.accessors[position]["min"] = json!(low);
        self.accessors[position]["max"] = json!(high);
        let normal = self.accessor(bytemuck::cast_slice(&normals), FLOAT, "VEC3", normals.len(), ARRAY_BUFFER);
        let index =
            self.accessor(bytemuck::cast_slice(&indices), UNSIGNED_INT, "SCALAR", indices.len(), ELEMENT_ARRAY_BUFFER);
        let mut attributes = json!({ "POSITION": position, "NORMAL": normal });
        if let Some([length, width]) = self.pictures.get(&finish) {
            let laid = |p: &DVec3| [(p.x / length + 0.5) as f32, (0.5 - p.y / width) as f32];
            let places: Vec<[f32; 2]> = solid.positions.iter().map(laid).collect();
            let place = self.accessor(bytemuck::cast_slice(&places), FLOAT, "VEC2", places.len(), ARRAY_BUFFER);
            attributes["TEXCOORD_0"] = json!(place);
        }
        self.nodes[node]["mesh"] = json!(self.meshes.len());
        self.meshes.push(json!({
            "name": self.nodes[node]["name"],
            "primitives": [{
                "attributes": attributes,
                "indices": index,
                "material": finish,
            }],
        }));
    }

    /// Adds a perspective camera at `eye` that looks at `target`, y upwards; `fovy` in rad, made for `aspect`.
    pub fn camera(&mut self, name: &str, eye: DVec3, target: DVec3, fovy: f64, aspect: f64) {
        // A glTF camera looks along −Z of its node with +Y up.
        let back = (eye - target).normalize();
        let right = DVec3::Y.cross(back).normalize();
        let rotation = DQuat::from_mat3(&soffio_math::DMat3::from_cols(right, back.cross(right), back));
        let node = self.node(name, None, eye, rotation);
        self.nodes[node]["camera"] = json!(self.cameras.len());
        self.cameras.push(json!({
            "name": name,
            "type": "perspective",
            "perspective": { "yfov": fovy, "aspectRatio": aspect, "znear": 0.01, "zfar": 100.0 },
        }));
    }

    fn accessor(&mut self, bytes: &[u8], component: u32, shape: &str, count: usize, target: u32) -> usize {
        // Every element here is a multiple of four bytes, so the views stay aligned as the accessors need.
        let mut view = json!({ "buffer": 0, "byteOffset": self.binary.len(), "byteLength": bytes.len() });
        // Only vertices and indices have a target.
        if target != 0 {
            view["target"] = json!(target);
        }
        self.views.push(view);
        self.binary.extend_from_slice(bytes);
        self.accessors.push(json!({
            "bufferView": self.views.len() - 1, "componentType": component, "count": count, "type": shape,
        }));
        self.accessors.len() - 1
    }

    /// The bytes of the file; `copyright` is shown by glTF viewers.
    pub fn into_glb(mut self, name: &str, copyright: &str) -> Vec<u8> {
        for (node, children) in self.nodes.iter_mut().zip(&self.children) {
            if !children.is_empty() {
                node["children"] = json!(children);
            }
        }
        let mut document = json!({
            "asset": { "version": "2.0", "generator": "Soffio forge", "copyright": copyright },
            "scene": 0,
            "scenes": [{ "name": name, "nodes": self.roots }],
            "nodes": self.nodes,
            "meshes": self.meshes,
            "materials": self.materials,
            "cameras": self.cameras,
            "accessors": self.accessors,
            "bufferViews": self.views,
            "buffers": [{ "byteLength": self.binary.len() }],
        });
        if !self.images.is_empty() {
            let textures: Vec<Value> = (0..self.images.len()).map(|source| json!({ "source": source })).collect();
            document["textures"] = json!(textures);
            document["images"] = json!(self.images);
        }
        if !self.animations.is_empty() {
            document["animations"] = json!(self.animations);
        }
        if !self.skins.is_empty() {
            document["skins"] = json!(self.skins);
        }
        let mut used: Vec<&String> =
            self.materials.iter().filter_map(|m| m["extensions"].as_object()).flat_map(|e| e.keys()).collect();
        used.sort_unstable();
        used.dedup();
        if !used.is_empty() {
            document["extensionsUsed"] = json!(used);
        }
        container(document.to_string().into_bytes(), &self.binary)
    }
}

/// Numbers rounded to multiples of 1/scale.
fn rounded(values: &[f64], scale: f64) -> Vec<f64> {
    values.iter().map(|v| (v * scale).round() / scale).collect()
}

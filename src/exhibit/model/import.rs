//! glTF 2.0 (`.glb`, `.gltf`) to [`Model`]: checked, decoded, within limits. Nothing here panics on a bad file.
//!
//! The file is split ([`glb`]), its document is checked against the standard ([`check`]), and the `gltf` crate reads what is
//! valid. Then the data of accessors is checked ([`data`]), and the sizes in the world ([`size`]).

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use gltf::json;
use serde_json::Value;

use super::super::budget::{Budget, Excess};
use super::super::diagnostic::{Diagnostic, Report};
use super::super::files;
use super::check::tables::{GREATEST_FOV, LEAST_FOV};
use super::fault::{Cause, Fault, Faults};
use super::primitive::{self, decode, is_drawn};
use super::sources::{MAX_FILE_BYTES, Sources};
use super::{
    Animation, Camera, Light, LightKind, Mesh, Model, Morph, Node, Primitive, Skin, accessor, animation, check, data,
    deform, glb, material, nodes, size,
};
use soffio_math::DVec3;

/// Most triangles of a model.
pub const MAX_TRIANGLES: usize = 4_000_000;
/// Least width over height of a camera's picture, and least height over width.
const LEAST_ASPECT: f64 = 0.01;

/// Required extensions that are supported: handled here, or without effect on the picture.
const HANDLED: &[&str] = &[
    "KHR_lights_punctual",
    "KHR_materials_emissive_strength",
    "KHR_mesh_quantization",
    "KHR_materials_volume",
    "KHR_materials_specular",
    "KHR_materials_ior",
    "KHR_materials_transmission",
    "KHR_materials_clearcoat",
    "KHR_materials_sheen",
    "KHR_materials_variants",
    "KHR_materials_unlit",
    "KHR_node_visibility",
    "KHR_texture_transform",
    "KHR_xmp_json_ld",
    // Physics that `soffio import` converts into a sidecar.
    "KHR_implicit_shapes",
    "KHR_physics_rigid_bodies",
];

/// Remedy for a required extension that is not supported.
fn remedy(extension: &str) -> String {
    let command = match extension {
        "KHR_draco_mesh_compression" | "EXT_meshopt_compression" | "KHR_meshopt_compression" => {
            "gltf-transform copy in.glb out.glb"
        }
        "KHR_texture_basisu" | "EXT_texture_webp" | "EXT_texture_avif" => "gltf-transform png in.glb out.glb",
        _ => return "export the model again without it".into(),
    };
    format!("export again without it, or run: {command}")
}

/// A model, with warnings about parts of its file that were skipped.
#[derive(Debug)]
pub struct Imported {
    /// The model.
    pub model: Model,
    /// What of the file is not drawn, or contradicts the standard without effect here.
    pub warnings: Vec<Diagnostic>,
    /// The file's JSON.
    pub document: Value,
}

/// Loads a plain `.glb` or `.gltf`.
///
/// # Errors
/// All problems of the file.
pub fn load(path: &Path) -> Result<Model, Report> {
    import(path).map(|imported| imported.model)
}

/// Loads a plain `.glb` or `.gltf`, with warnings.
///
/// # Errors
/// All problems of the file.
pub fn import(path: &Path) -> Result<Imported, Report> {
    import_within(path, &Budget::default())
}

/// As [`import`], within the rest of a budget.
///
/// # Errors
/// All problems of the file.
pub fn import_within(path: &Path, budget: &Budget) -> Result<Imported, Report> {
    let name = path.file_name().map_or_else(|| path.display().to_string(), |n| n.to_string_lossy().into_owned());
    let folder = path.parent().map(PathBuf::from).unwrap_or_default();
    let file = files::open_regular(path).and_then(|file| file.within(MAX_FILE_BYTES)).map_err(Report::single)?;
    budget.charge(file.size()).map_err(|excess| Report::single(excess.diagnostic(&name)))?;
    let bytes = file.read().map_err(Report::single)?;
    Reader { name, folder, faults: Faults::default(), budget }.import(&bytes)
}

struct Reader<'a> {
    name: String,
    folder: PathBuf,
    faults: Faults,
    budget: &'a Budget,
}

/// A value, or all problems so far.
type Outcome<T> = Result<T, Vec<Diagnostic>>;

impl Reader<'_> {
    fn refused(&self, fault: &Fault) -> Vec<Diagnostic> {
        vec![fault.diagnostic(&self.name)]
    }

    fn warn(&mut self, place: impl std::fmt::Display, what: impl std::fmt::Display) {
        self.faults.add(Cause::Skipped, place, what);
    }

    /// Goes on if no errors were found.
    fn sound(&self) -> Outcome<()> {
        if self.faults.errors.is_empty() { Ok(()) } else { Err(self.faults.errors(&self.name)) }
    }

    fn import(mut self, bytes: &[u8]) -> Result<Imported, Report> {
        match self.read(bytes) {
            Ok((model, document)) => Ok(Imported { model, warnings: self.faults.warnings(&self.name), document }),
            Err(problems) => Err(Report::from(problems)),
        }
    }

    fn read(&mut self, bytes: &[u8]) -> Outcome<(Model, Value)> {
        let parts = glb::split(bytes, &mut self.faults).map_err(|fault| self.refused(&fault))?;
        let tree = document_bytes(parts.json);
        self.budget.charge(tree).map_err(|excess| self.exceeded(excess, "the JSON"))?;
        let mut root: Value = serde_json::from_slice(parts.json).map_err(|error| self.refused(&syntax(&error)))?;
        check::document(&mut root, &mut self.faults);
        self.extensions(&root);
        self.sound()?;
        let document = represent(&root).map_err(|fault| self.refused(&fault))?;
        let (name, folder) = (self.name.clone(), self.folder.clone());
        let sources = Sources { file: &name, folder: &folder, root: &root, budget: self.budget };
        let buffers = sources.buffers(parts.bin, &mut self.faults).map_err(|problem| vec![problem])?;
        self.accessors(&document)?;
        data::check(&document, &buffers, &mut self.faults);
        self.sound()?;
        let (mut nodes, roots) = nodes::nodes(&document).map_err(|fault| self.refused(&fault))?;
        let hidden = nodes::hidden(&document, &nodes);
        let mut meshes = self.meshes(&document, &buffers)?;
        size::check(&nodes, &meshes, &mut self.faults);
        self.sound()?;
        let (skins, morphs) = self.rest_pose_meshes(&document, &buffers, &mut nodes, &mut meshes)?;
        size::check(&nodes, &meshes, &mut self.faults);
        self.sound()?;
        let images = sources.images(&buffers, &mut self.faults).map_err(|problem| vec![problem])?;
        let model = Model {
            nodes,
            roots,
            meshes,
            skins,
            morphs,
            hidden,
            materials: document
                .materials()
                .map(|m| {
                    let place = format!("materials[{}]", m.index().unwrap_or_default());
                    material::appearance(&m, &document, |what| self.warn(&place, what))
                })
                .collect(),
            images: images.into_iter().map(Arc::new).collect(),
            cameras: document.cameras().map(|camera| self.camera(&camera)).collect(),
            lights: document.lights().into_iter().flatten().map(|light| punctual(&light)).collect(),
            animations: self.animations(&document, &buffers)?,
        };
        Ok((model, root))
    }

    /// A part of the file costs too much.
    fn exceeded(&self, excess: Excess, place: impl std::fmt::Display) -> Vec<Diagnostic> {
        self.refused(&Fault::excess(excess, place))
    }

    /// Is there memory to check each accessor, and time? The check of weights decodes two at once.
    fn accessors(&self, document: &gltf::Document) -> Outcome<()> {
        for accessor in document.accessors() {
            let decoded = 2 * accessor::decoded_bytes(&accessor);
            let place = format_args!("accessors[{}]", accessor.index());
            self.budget.charge_briefly(decoded).map_err(|excess| self.exceeded(excess, place))?;
        }
        Ok(())
    }

    /// Charges a primitive that is about to be decoded.
    fn charge_primitive(&self, primitive: &gltf::Primitive, place: impl std::fmt::Display) -> Outcome<()> {
        self.budget.charge(primitive::decoded_bytes(primitive)).map_err(|excess| self.exceeded(excess, place))
    }

    /// Refuses required extensions that are not supported.
    fn extensions(&mut self, root: &Value) {
        for (index, name) in root["extensionsRequired"].as_array().into_iter().flatten().enumerate() {
            let name = name.as_str().unwrap_or_default();
            if !HANDLED.contains(&name) {
                let what = format_args!("requires {name}, which is not supported");
                let fault = Fault::at(Cause::Extension, format_args!("extensionsRequired[{index}]"), what);
                self.faults.push(fault.remedy(remedy(name)));
            }
        }
    }

    fn meshes(&mut self, document: &gltf::Document, buffers: &[Vec<u8>]) -> Outcome<Vec<Mesh>> {
        let mut triangles = 0;
        let mut meshes = Vec::new();
        for mesh in document.meshes() {
            let name = mesh.name().map_or_else(|| format!("mesh {}", mesh.index()), str::to_owned);
            let mut primitives = Vec::new();
            for primitive in mesh.primitives() {
                let place = format!("meshes[{}].primitives[{}]", mesh.index(), primitive.index());
                if !is_drawn(&primitive) {
                    let what = "has points or lines, which are not drawn; a wire can stand for a line";
                    self.warn(&place, format_args!("\"{name}\" {what}"));
                    continue;
                }
                if primitive.get(&gltf::Semantic::Positions).is_none() {
                    self.warn(&place, format_args!("\"{name}\" has no positions: it is not drawn"));
                    continue;
                }
                self.charge_primitive(&primitive, &place)?;
                let primitive = decode(&primitive, buffers, |_| Ok(()))
                    .map_err(|fault| self.refused(&fault.within(format_args!("{place} of \"{name}\""))))?;
                triangles += primitive.indices.len() / 3;
                primitives.push(primitive);
            }
            if triangles > MAX_TRIANGLES {
                let what = format_args!("have more than {MAX_TRIANGLES} triangles");
                return Err(self.refused(&Fault::at(Cause::Limit, "meshes", what)));
            }
            meshes.push(Mesh { name, primitives });
        }
        Ok(meshes)
    }

    /// Gives each skinned or morphed node a mesh of its own, deformed as in the rest pose. Also returns the undeformed
    /// meshes of skins and animated morph targets.
    fn rest_pose_meshes(
        &mut self,
        document: &gltf::Document,
        buffers: &[Vec<u8>],
        nodes: &mut [Node],
        meshes: &mut Vec<Mesh>,
    ) -> Outcome<(Vec<Skin>, Vec<Morph>)> {
        let channels = document.animations().flat_map(|animation| animation.channels());
        let morphing: BTreeSet<usize> = channels
            .filter(|channel| channel.target().property() == gltf::animation::Property::MorphTargetWeights)
            .map(|channel| channel.target().node().index())
            .collect();
        let (mut triangles, mut skins, mut morphs) = (0, Vec::new(), Vec::new());
        for node in document.nodes() {
            let Some(mesh) = node.mesh() else { continue };
            let keyed = morphing.contains(&node.index());
            if !keyed && !deform::deforms(&node) {
                continue;
            }
            if keyed && mesh.primitives().any(|p| p.morph_targets().count() != primitive::targets(&node)) {
                let what = format_args!("the primitives of \"{}\" differ in them", nodes[node.index()].name);
                let place = format_args!("meshes[{}].primitives.targets", mesh.index());
                return Err(self.refused(&Fault::at(Cause::Count, place, what)));
            }
            let at = format!("nodes[{}]", node.index());
            for primitive in mesh.primitives().filter(is_drawn) {
                // As at rest, and as it is bound.
                self.charge_primitive(&primitive, &at)?;
                self.charge_primitive(&primitive, &at)?;
            }
            let primitives = mesh.primitives().filter(is_drawn).map(|primitive| {
                decode(&primitive, buffers, |out| deform::deform(&node, &primitive, nodes, buffers, out))
            });
            let name = nodes[node.index()].name.clone();
            let place = format!("nodes[{}] \"{name}\"", node.index());
            let broken = |fault: Fault| self.refused(&fault.within(&place));
            let primitives: Vec<Primitive> = primitives.collect::<Result<_, _>>().map_err(broken)?;
            triangles += primitives.iter().map(|p| p.indices.len() / 3).sum::<usize>();
            if triangles > MAX_TRIANGLES {
                let what = format_args!("have more than {MAX_TRIANGLES} triangles in skins and morphed meshes");
                return Err(self.refused(&Fault::at(Cause::Limit, "nodes", what)));
            }
            let bound = mesh.primitives().filter(is_drawn).map(|primitive| {
                decode(&primitive, buffers, |out| deform::bind(&node, keyed, &primitive, buffers, out))
            });
            if let Some(skin) = node.skin() {
                skins.push(Skin {
                    node: node.index(),
                    joints: skin.joints().map(|joint| joint.index()).collect(),
                    inverse_bind: deform::inverse_bind(&skin, buffers).map_err(broken)?,
                    bound: bound.collect::<Result<_, _>>().map_err(broken)?,
                });
            } else if keyed {
                morphs.push(Morph { node: node.index(), primitives: bound.collect::<Result<_, _>>().map_err(broken)? });
            }
            nodes[node.index()].mesh = Some(meshes.len());
            meshes.push(Mesh { name, primitives });
        }
        Ok((skins, morphs))
    }

    fn animations(&self, document: &gltf::Document, buffers: &[Vec<u8>]) -> Outcome<Vec<Animation>> {
        let mut animations = Vec::new();
        for source in document.animations() {
            let name = source.name().map_or_else(|| format!("#{}", source.index()), str::to_owned);
            let mut channels = Vec::new();
            for (index, channel) in source.channels().enumerate() {
                let place =
                    format_args!("animations[{}].channels[{index}] (animation \"{name}\")", source.index()).to_string();
                let cost = animation::decoded_bytes(&channel);
                self.budget.charge(cost).map_err(|excess| self.exceeded(excess, &place))?;
                let decoded = animation::channel(&channel, buffers);
                channels.push(decoded.map_err(|fault| self.refused(&fault.within(place)))?);
            }
            animations.push(Animation { name, channels });
        }
        Ok(animations)
    }

    fn camera(&mut self, camera: &gltf::Camera) -> Camera {
        match camera.projection() {
            gltf::camera::Projection::Perspective(lens) => {
                let fovy = f64::from(lens.yfov()).clamp(LEAST_FOV, GREATEST_FOV);
                Camera {
                    fovy,
                    aspect: lens.aspect_ratio().map(|x| f64::from(x).clamp(LEAST_ASPECT, 1.0 / LEAST_ASPECT)),
                }
            }
            gltf::camera::Projection::Orthographic(_) => {
                /// Field of view that approximates a parallel projection.
                const NARROW: f64 = 0.2;
                let place = format!("cameras[{}]", camera.index());
                self.warn(place, "an orthographic camera is shown as a narrow perspective one");
                Camera { fovy: NARROW, aspect: None }
            }
        }
    }
}

/// Most memory of a document, bytes: its text and three trees of it (as values, a copy to read the types from, and the types). An
/// object of one key takes 0.7 KB as a value and up to 1 KB as a type, any other value at most 50 bytes in each.
fn document_bytes(json: &[u8]) -> u64 {
    const TEXTS: u64 = 4;
    const OBJECT: u64 = 2400;
    const VALUE: u64 = 150;
    let count = |of: &[u8]| json.iter().filter(|byte| of.contains(byte)).count() as u64;
    TEXTS * json.len() as u64 + OBJECT * count(b"{") + VALUE * count(b",[")
}

/// What is wrong with a text that is not JSON.
fn syntax(error: &serde_json::Error) -> Fault {
    let at = format!("line {}, column {}", error.line(), error.column());
    let text = error.to_string();
    let what = text.split(" at line ").next().unwrap_or_default();
    match what {
        _ if error.is_eof() => Fault::new(Cause::Truncated, format_args!("its JSON ends early, at {at}")),
        "number out of range" => Fault::new(Cause::NotFinite, format_args!("a number at {at} is infinite")),
        _ => Fault::new(Cause::Json, format_args!("is not JSON: {what} at {at}")),
    }
}

/// The document for the `gltf` crate. Its own checks come last: they hold what the crate relies on, and should find nothing
/// that [`check`] lets through.
fn represent(root: &Value) -> Result<gltf::Document, Fault> {
    use json::validation::{Error, Validate};
    let mut typed: json::Root = json::deserialize::from_value(root.clone())
        .map_err(|error| Fault::new(Cause::WrongType, format_args!("its document cannot be read: {error}")))?;
    // The crate knows fewer extensions than are handled here.
    typed.extensions_required.clear();
    // Names that the standard does not know are ignored, with a warning.
    for primitive in typed.meshes.iter_mut().flat_map(|mesh| &mut mesh.primitives) {
        primitive.attributes.retain(|semantic, _| matches!(semantic, json::validation::Checked::Valid(_)));
    }
    let mut found = None;
    typed.validate(&typed, json::Path::new, &mut |path: &dyn Fn() -> json::Path, error: Error| {
        let path = path().to_string();
        // Legal: accessors without a view, whose elements are zeros, and primitives without positions, which are not drawn.
        let zeros = path.starts_with("accessors[") && path.ends_with(".bufferView");
        let nowhere = path.starts_with("meshes[") && path.ends_with("[\"POSITION\"]");
        if !(error == Error::Missing && (zeros || nowhere)) && found.is_none() {
            found = Some(Fault::at(Cause::Range, path, error));
        }
    });
    match found {
        Some(fault) => Err(fault),
        None => Ok(gltf::Document::from_json_without_validation(typed)),
    }
}

fn punctual(light: &gltf::khr_lights_punctual::Light) -> Light {
    use gltf::khr_lights_punctual::Kind;
    Light {
        kind: match light.kind() {
            Kind::Directional => LightKind::Directional,
            Kind::Point => LightKind::Point,
            Kind::Spot { inner_cone_angle, outer_cone_angle } => {
                LightKind::Spot(f64::from(inner_cone_angle), f64::from(outer_cone_angle))
            }
        },
        color: DVec3::from(light.color().map(f64::from)),
        intensity: f64::from(light.intensity()),
        range: light.range().map_or(f64::INFINITY, f64::from),
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// Reads the bytes of a model's file, in a folder without others.
    pub fn read(bytes: &[u8]) -> Result<Imported, Report> {
        let folder = PathBuf::from("no/such/folder");
        let budget = Budget::default();
        Reader { name: "model.glb".into(), folder, faults: Faults::default(), budget: &budget }.import(bytes)
    }
}

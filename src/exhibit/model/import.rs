//! glTF 2.0 (`.glb`, `.gltf`) to [`Model`]: checked, decoded, within limits. Nothing here panics on a bad file.
//!
//! The `gltf` crate refuses every required extension outside a short list of its own. Those handled here are removed
//! from the list before it looks; its index checks stay.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use gltf::json;

use super::super::codes::{self, Code};
use super::super::diagnostic::{Diagnostic, Report};
use super::super::paths;
use super::primitive::{decode, is_drawn};
use super::{
    Animation, Camera, Image, Light, LightKind, Mesh, Model, Morph, Node, Primitive, Skin, animation, deform, material,
    primitive,
};
use soffio_math::{DMat4, DQuat, DVec3};

/// Most bytes of a model file or of a buffer beside it.
pub const MAX_FILE_BYTES: u64 = 256 << 20;
/// Most triangles of a model.
pub const MAX_TRIANGLES: usize = 4_000_000;
/// Most pixels of one image.
pub const MAX_IMAGE_PIXELS: u64 = 8192 * 8192;
/// Most pixels of all images together: 1 GiB when decoded.
pub const MAX_PIXELS: u64 = 4 * MAX_IMAGE_PIXELS;
/// Most nodes of a model.
pub const MAX_NODES: usize = 65_536;
/// Remedy for a file that is not a complete model.
pub const EXPORT_AGAIN: &str = "export the model again; a copy may have been cut short";
/// Remedy for too many triangles.
const SIMPLIFY: &str = "simplify the model: gltf-transform simplify in.glb out.glb";

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
    /// Parts of the file that are not drawn.
    pub warnings: Vec<Diagnostic>,
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
    let name = path.file_name().map_or_else(|| path.display().to_string(), |n| n.to_string_lossy().into_owned());
    let mut reader =
        Reader { name, folder: path.parent().map(PathBuf::from).unwrap_or_default(), warnings: Vec::new() };
    let model = reader.read(path).map_err(Report::single)?;
    Ok(Imported { model, warnings: reader.warnings })
}

/// Bytes of a GLB file's header.
const GLB_HEADER: u32 = 12;

struct Reader {
    name: String,
    folder: PathBuf,
    warnings: Vec<Diagnostic>,
}

type Outcome<T> = Result<T, Diagnostic>;

impl Reader {
    fn problem(&self, code: Code, what: impl std::fmt::Display, help: impl Into<String>) -> Diagnostic {
        Diagnostic::new(code, format!("{}: {what}", self.name)).help(help)
    }

    fn broken(&self, what: impl std::fmt::Display) -> Diagnostic {
        self.problem(codes::BROKEN_MODEL, what, EXPORT_AGAIN)
    }

    fn warn(&mut self, what: impl std::fmt::Display) {
        self.warnings.push(Diagnostic::new(codes::SKIPPED, format!("{}: {what}", self.name)));
    }

    fn read(&mut self, path: &Path) -> Outcome<Model> {
        let bytes = paths::read_limited(path, MAX_FILE_BYTES)?;
        let (json_bytes, blob) = if bytes.starts_with(b"glTF") {
            // The reader assumes that the length includes its own header.
            let length = bytes.get(8..12).and_then(|length| length.try_into().ok()).map(u32::from_le_bytes);
            if length.is_none_or(|length| length < GLB_HEADER) {
                return Err(self.broken("not a complete GLB file: its length is shorter than its header"));
            }
            let glb = gltf::binary::Glb::from_slice(&bytes)
                .map_err(|error| self.broken(format_args!("not a whole GLB file: {error}")))?;
            (glb.json.into_owned(), glb.bin.map(std::borrow::Cow::into_owned))
        } else {
            (bytes, None)
        };
        let mut root: json::Root = json::deserialize::from_slice(&json_bytes)
            .map_err(|error| self.broken(format_args!("its JSON cannot be read: {error}")))?;
        if root.asset.version != "2.0" {
            let what = format!("glTF version {}; 2.0 is needed", root.asset.version);
            return Err(self.problem(codes::BROKEN_MODEL, what, "export it as glTF 2.0"));
        }
        if let Some(extension) = root.extensions_required.iter().find(|name| !HANDLED.contains(&name.as_str())) {
            let what = format!("requires {extension}, which is not supported");
            return Err(self.problem(codes::EXTENSION, what, remedy(extension)));
        }
        root.extensions_required.clear();
        // The crate looks up the positions' accessor before it has checked its index.
        let position = json::validation::Checked::Valid(json::mesh::Semantic::Positions);
        let primitives = root.meshes.iter().flat_map(|mesh| &mesh.primitives);
        let positions = primitives.filter_map(|primitive| primitive.attributes.get(&position));
        if let Some(index) = positions.map(|i| i.value()).find(|&i| i >= root.accessors.len()) {
            return Err(self.broken(format_args!("accessor {index} does not exist")));
        }
        // The crate does not check that an image has a source.
        if let Some(index) = root.images.iter().position(|image| image.uri.is_none() && image.buffer_view.is_none()) {
            return Err(self.broken(format_args!("image {index} has neither a uri nor a bufferView")));
        }
        let document =
            gltf::Document::from_json(root).map_err(|error| self.broken(format_args!("not valid glTF: {error}")))?;
        if document.nodes().len() > MAX_NODES {
            let help = "join meshes that do not move against each other, and export the model again";
            return Err(self.problem(codes::MODEL_LIMIT, format_args!("more than {MAX_NODES} nodes"), help));
        }
        let buffers = self.buffers(&document, blob)?;
        let (mut nodes, roots) = self.nodes(&document)?;
        let hidden = hidden(&document, &nodes);
        let mut meshes = self.meshes(&document, &buffers)?;
        let (skins, morphs) = self.rest_pose_meshes(&document, &buffers, &mut nodes, &mut meshes)?;
        Ok(Model {
            nodes,
            roots,
            meshes,
            skins,
            morphs,
            hidden,
            materials: document
                .materials()
                .map(|m| material::appearance(&m, &document, |what| self.warn(what)))
                .collect(),
            images: self.images(&document, &buffers)?,
            cameras: document.cameras().map(|camera| self.camera(&camera)).collect(),
            lights: document.lights().into_iter().flatten().map(|light| punctual(&light)).collect(),
            animations: self.animations(&document, &buffers)?,
        })
    }

    /// Bytes of a data URI or of a file beside the model.
    fn uri(&self, uri: &str) -> Outcome<Vec<u8>> {
        let source = gltf::buffer::Source::Uri(uri);
        if uri.starts_with("data:") {
            return gltf::buffer::Data::from_source(source, None)
                .map(|data| data.0)
                .map_err(|error| self.broken(format_args!("a data URI cannot be decoded: {error}")));
        }
        let path = paths::inside(&self.folder, &paths::percent_decoded(uri))?;
        paths::read_limited(&path, MAX_FILE_BYTES)
    }

    fn buffers(&self, document: &gltf::Document, mut blob: Option<Vec<u8>>) -> Outcome<Vec<Vec<u8>>> {
        document
            .buffers()
            .map(|buffer| {
                let bytes = match buffer.source() {
                    gltf::buffer::Source::Bin => {
                        blob.take().ok_or_else(|| self.broken("its binary chunk is missing"))?
                    }
                    gltf::buffer::Source::Uri(uri) => self.uri(uri)?,
                };
                if bytes.len() < buffer.length() {
                    let (has, says) = (bytes.len(), buffer.length());
                    return Err(self.broken(format_args!("buffer {} has {has} bytes of {says}", buffer.index())));
                }
                Ok(bytes)
            })
            .collect()
    }

    fn nodes(&self, document: &gltf::Document) -> Outcome<(Vec<Node>, Vec<usize>)> {
        let mut nodes: Vec<Node> = Vec::new();
        for node in document.nodes() {
            let local = matrix(node.transform())
                .ok_or_else(|| self.broken(format_args!("the transform of node {} is not finite", node.index())))?;
            nodes.push(Node {
                name: node.name().map_or_else(|| format!("#{}", node.index()), str::to_owned),
                parent: None,
                children: node.children().map(|child| child.index()).collect(),
                local,
                world: local,
                mesh: node.mesh().map(|mesh| mesh.index()),
                camera: node.camera().map(|camera| camera.index()),
                light: node.light().map(|light| light.index()),
            });
        }
        for parent in 0..nodes.len() {
            for child in nodes[parent].children.clone() {
                if nodes[child].parent.replace(parent).is_some() || child == parent {
                    let name = &nodes[child].name;
                    let help = "give it one parent, copy it for the other, and export the model again";
                    return Err(self.problem(codes::CYCLE, format!("node \"{name}\" has two parents"), help));
                }
            }
        }
        let scene = document.default_scene().or_else(|| document.scenes().next());
        let roots: Vec<usize> = match scene {
            Some(scene) => scene.nodes().map(|node| node.index()).collect(),
            None => (0..nodes.len()).filter(|&i| nodes[i].parent.is_none()).collect(),
        };
        // Every node has at most one parent, so nodes that no root reaches form a cycle (or belong to another scene).
        let mut waiting: Vec<usize> = (0..nodes.len()).filter(|&i| nodes[i].parent.is_none()).collect();
        let mut reached = 0;
        while let Some(index) = waiting.pop() {
            reached += 1;
            if let Some(parent) = nodes[index].parent {
                nodes[index].world = nodes[parent].world * nodes[index].local;
            }
            waiting.extend(&nodes[index].children);
        }
        if reached < nodes.len() {
            let help = "remove one of them from the cycle, and export the model again";
            return Err(self.problem(codes::CYCLE, "some nodes are their own ancestors", help));
        }
        Ok((nodes, roots))
    }

    fn meshes(&mut self, document: &gltf::Document, buffers: &[Vec<u8>]) -> Outcome<Vec<Mesh>> {
        let mut triangles = 0;
        let mut meshes = Vec::new();
        for mesh in document.meshes() {
            let name = mesh.name().map_or_else(|| format!("mesh {}", mesh.index()), str::to_owned);
            let mut primitives = Vec::new();
            for primitive in mesh.primitives() {
                if !is_drawn(&primitive) {
                    self.warn(format_args!(
                        "\"{name}\" has points or lines, which are not drawn; a wire can stand for a line"
                    ));
                    continue;
                }
                let primitive = decode(&primitive, buffers, |_| Ok(()))
                    .map_err(|what| self.broken(format_args!("mesh \"{name}\": {what}")))?;
                triangles += primitive.indices.len() / 3;
                primitives.push(primitive);
            }
            if triangles > MAX_TRIANGLES {
                return Err(self.problem(codes::MODEL_LIMIT, format!("more than {MAX_TRIANGLES} triangles"), SIMPLIFY));
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
        let morphing: Vec<usize> = channels
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
                let what =
                    format!("node \"{}\": its primitives differ in their morph targets", nodes[node.index()].name);
                return Err(self.broken(what));
            }
            let primitives = mesh.primitives().filter(is_drawn).map(|primitive| {
                decode(&primitive, buffers, |out| deform::deform(&node, &primitive, nodes, buffers, out))
            });
            let name = nodes[node.index()].name.clone();
            let primitives: Vec<Primitive> = primitives
                .collect::<Result<_, _>>()
                .map_err(|what| self.broken(format_args!("node \"{name}\": {what}")))?;
            triangles += primitives.iter().map(|p| p.indices.len() / 3).sum::<usize>();
            if triangles > MAX_TRIANGLES {
                let what = format!("more than {MAX_TRIANGLES} triangles in skins");
                return Err(self.problem(codes::MODEL_LIMIT, what, SIMPLIFY));
            }
            let broken = |what| self.broken(format_args!("node \"{name}\": {what}"));
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

    fn images(&self, document: &gltf::Document, buffers: &[Vec<u8>]) -> Outcome<Vec<Arc<Image>>> {
        let mut pixels = 0;
        let mut images = Vec::new();
        for source in document.images() {
            let index = source.index();
            let bytes = match source.source() {
                gltf::image::Source::View { view, .. } => {
                    let range = view.offset()..view.offset().saturating_add(view.length());
                    let bytes = buffers.get(view.buffer().index()).and_then(|buffer| buffer.get(range));
                    bytes.ok_or_else(|| self.broken(format_args!("image {index} lies outside its buffer")))?.to_vec()
                }
                gltf::image::Source::Uri { uri, .. } => self.uri(uri)?,
            };
            let undecodable = |error: image::ImageError| {
                let help = "PNG and JPEG are read; convert others: gltf-transform png in.glb out.glb";
                self.problem(codes::IMAGE, format_args!("image {index} cannot be decoded: {error}"), help)
            };
            let open = || image::ImageReader::new(std::io::Cursor::new(&bytes)).with_guessed_format();
            let reader = open().map_err(|error| undecodable(error.into()))?;
            // Check the size first: a small file can claim an image that fills the memory.
            let (width, height) = reader.into_dimensions().map_err(undecodable)?;
            let size = u64::from(width) * u64::from(height);
            pixels += size;
            if size > MAX_IMAGE_PIXELS || pixels > MAX_PIXELS {
                let what =
                    format!("image {index} is {width} × {height}; the limit is 8192 × 8192, four of them in all");
                let help = "gltf-transform resize --width 4096 --height 4096 in.glb out.glb";
                return Err(self.problem(codes::MODEL_LIMIT, what, help));
            }
            let decoded = open().map_err(|error| undecodable(error.into()))?.decode().map_err(undecodable)?;
            images.push(Arc::new(Image { width, height, rgba: decoded.into_rgba8().into_raw() }));
        }
        Ok(images)
    }

    fn animations(&self, document: &gltf::Document, buffers: &[Vec<u8>]) -> Outcome<Vec<Animation>> {
        let mut animations = Vec::new();
        for source in document.animations() {
            let name = source.name().map_or_else(|| format!("#{}", source.index()), str::to_owned);
            let mut channels = Vec::new();
            for channel in source.channels() {
                let decoded = animation::channel(&channel, buffers);
                channels.push(decoded.map_err(|what| self.broken(format_args!("animation \"{name}\": {what}")))?);
            }
            animations.push(Animation { name, channels });
        }
        Ok(animations)
    }

    fn camera(&mut self, camera: &gltf::Camera) -> Camera {
        match camera.projection() {
            gltf::camera::Projection::Perspective(lens) => {
                Camera { fovy: f64::from(lens.yfov()), aspect: lens.aspect_ratio().map(f64::from) }
            }
            gltf::camera::Projection::Orthographic(_) => {
                /// Field of view that approximates a parallel projection.
                const NARROW: f64 = 0.2;
                self.warn("an orthographic camera is shown as a narrow perspective one");
                Camera { fovy: NARROW, aspect: None }
            }
        }
    }
}

/// Nodes hidden by KHR_node_visibility, and all nodes below them.
fn hidden(document: &gltf::Document, nodes: &[Node]) -> Vec<usize> {
    let visible = |node: &gltf::Node| node.extension_value("KHR_node_visibility")?.get("visible")?.as_bool();
    let mut open: Vec<usize> = document.nodes().filter(|n| visible(n) == Some(false)).map(|n| n.index()).collect();
    let mut hidden = Vec::new();
    // Nodes form a forest, so none is visited more often than it has hidden ancestors; visited ones are not opened
    // again.
    let mut seen = vec![false; nodes.len()];
    while let Some(index) = open.pop() {
        if !std::mem::replace(&mut seen[index], true) {
            hidden.push(index);
            open.extend(&nodes[index].children);
        }
    }
    hidden.sort_unstable();
    hidden
}

/// The transform in double precision; `None` where it is not finite.
fn matrix(transform: gltf::scene::Transform) -> Option<DMat4> {
    let matrix = match transform {
        gltf::scene::Transform::Matrix { matrix } => {
            DMat4::from_cols_array_2d(&matrix.map(|column| column.map(f64::from)))
        }
        gltf::scene::Transform::Decomposed { translation, rotation, scale } => {
            // Composed in double precision: the crate's quaternions are single precision and not quite unit.
            let quaternion = DQuat::from_array(rotation.map(f64::from));
            let length = quaternion.length();
            if !(length.is_finite() && length > 0.0) {
                return None;
            }
            DMat4::from_scale_rotation_translation(
                DVec3::from(scale.map(f64::from)),
                quaternion * (1.0 / length),
                DVec3::from(translation.map(f64::from)),
            )
        }
    };
    matrix.is_finite().then_some(matrix)
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

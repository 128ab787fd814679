//! glTF 2.0 (`.glb`, `.gltf`) to [`Model`]: checked, decoded, within limits. Nothing here panics on a bad file.
//!
//! The `gltf` crate refuses every required extension outside a short list of its own, so those handled here are taken
//! out of the list before it looks; its index checks stay.

use std::path::{Path, PathBuf};

use gltf::json;
use gltf::mesh::Mode;

use super::super::codes::{self, Code};
use super::super::diagnostic::{Diagnostic, Report};
use super::super::paths;
use super::{Animation, Camera, Image, Light, LightKind, Mesh, Model, Node, Primitive, accessor, animation, look};
use crate::math::{DMat4, DQuat, DVec3};

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

/// Extensions a file may require: what they ask for is done here, or changes nothing in the picture.
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
    "KHR_xmp_json_ld",
];

/// What to do about a required extension that is not handled.
fn remedy(extension: &str) -> String {
    let command = match extension {
        "KHR_draco_mesh_compression" | "EXT_meshopt_compression" | "KHR_meshopt_compression" => {
            "gltf-transform copy in.glb out.glb"
        }
        "KHR_texture_basisu" | "EXT_texture_webp" | "EXT_texture_avif" => "gltf-transform png in.glb out.glb",
        "KHR_texture_transform" => "gltf-transform flatten in.glb out.glb, or bake the textures",
        _ => return "export the model again without it".into(),
    };
    format!("export again without it, or run: {command}")
}

/// A model and what was not taken over from its file.
#[derive(Debug)]
pub struct Imported {
    /// The model.
    pub model: Model,
    /// Parts of the file that are not drawn.
    pub warnings: Vec<Diagnostic>,
}

/// Loads a plain `.glb` or `.gltf`.
pub fn load(path: &Path) -> Result<Model, Report> {
    import(path).map(|imported| imported.model)
}

/// Loads a plain `.glb` or `.gltf`, with warnings.
pub fn import(path: &Path) -> Result<Imported, Report> {
    let name = path.file_name().map_or_else(|| path.display().to_string(), |n| n.to_string_lossy().into_owned());
    let mut reader =
        Reader { name, folder: path.parent().map(PathBuf::from).unwrap_or_default(), warnings: Vec::new() };
    let model = reader.read(path).map_err(Report::of)?;
    Ok(Imported { model, warnings: reader.warnings })
}

struct Reader {
    name: String,
    folder: PathBuf,
    warnings: Vec<Diagnostic>,
}

type Outcome<T> = Result<T, Diagnostic>;

impl Reader {
    fn problem(&self, code: Code, what: impl std::fmt::Display) -> Diagnostic {
        Diagnostic::new(code, format!("{}: {what}", self.name))
    }

    fn broken(&self, what: impl std::fmt::Display) -> Diagnostic {
        self.problem(codes::BROKEN_MODEL, what).help("export the model again; a copy may have been cut short")
    }

    fn warn(&mut self, what: impl std::fmt::Display) {
        let warning = self.problem(codes::SKIPPED, what);
        self.warnings.push(warning);
    }

    fn read(&mut self, path: &Path) -> Outcome<Model> {
        let bytes = paths::read_limited(path, MAX_FILE_BYTES)?;
        let (json_bytes, blob) = if bytes.starts_with(b"glTF") {
            let glb = gltf::binary::Glb::from_slice(&bytes)
                .map_err(|error| self.broken(format_args!("not a whole GLB file: {error}")))?;
            (glb.json.into_owned(), glb.bin.map(std::borrow::Cow::into_owned))
        } else {
            (bytes, None)
        };
        let mut root: json::Root = json::deserialize::from_slice(&json_bytes)
            .map_err(|error| self.broken(format_args!("its JSON cannot be read: {error}")))?;
        if !root.asset.version.starts_with("2.") {
            return Err(
                self.problem(codes::BROKEN_MODEL, format_args!("glTF version {}; 2.0 is needed", root.asset.version))
            );
        }
        if let Some(extension) = root.extensions_required.iter().find(|name| !HANDLED.contains(&name.as_str())) {
            return Err(self
                .problem(codes::EXTENSION, format_args!("requires {extension}, which is not supported"))
                .help(remedy(extension)));
        }
        root.extensions_required.clear();
        // The crate's own check looks up the positions' accessor before it has checked the index.
        let position = json::validation::Checked::Valid(json::mesh::Semantic::Positions);
        let primitives = root.meshes.iter().flat_map(|mesh| &mesh.primitives);
        let positions = primitives.filter_map(|primitive| primitive.attributes.get(&position));
        if let Some(index) = positions.map(|i| i.value()).find(|&i| i >= root.accessors.len()) {
            return Err(self.broken(format_args!("accessor {index} does not exist")));
        }
        let document =
            gltf::Document::from_json(root).map_err(|error| self.broken(format_args!("not valid glTF: {error}")))?;
        if document.nodes().len() > MAX_NODES {
            return Err(self.problem(codes::MODEL_LIMIT, format_args!("more than {MAX_NODES} nodes")));
        }
        let buffers = self.buffers(&document, blob)?;
        let (nodes, roots) = self.nodes(&document)?;
        Ok(Model {
            nodes,
            roots,
            meshes: self.meshes(&document, &buffers)?,
            materials: document.materials().map(|material| look::appearance(&material)).collect(),
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
                    return Err(self.problem(codes::CYCLE, format_args!("node \"{name}\" hangs from two parents")));
                }
            }
        }
        let scene = document.default_scene().or_else(|| document.scenes().next());
        let roots: Vec<usize> = match scene {
            Some(scene) => scene.nodes().map(|node| node.index()).collect(),
            None => (0..nodes.len()).filter(|&i| nodes[i].parent.is_none()).collect(),
        };
        // Every node has at most one parent, so what no root reaches is a ring (or belongs to another scene).
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
            return Err(self.problem(codes::CYCLE, "some nodes are their own ancestors"));
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
                if matches!(primitive.mode(), Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip) {
                    self.warn(format_args!(
                        "\"{name}\" has points or lines, which are not drawn; a wire can stand for a line"
                    ));
                    continue;
                }
                let primitive =
                    decode(&primitive, buffers).map_err(|what| self.broken(format_args!("mesh \"{name}\": {what}")))?;
                triangles += primitive.indices.len() / 3;
                primitives.push(primitive);
            }
            if triangles > MAX_TRIANGLES {
                return Err(self
                    .problem(codes::MODEL_LIMIT, format_args!("more than {MAX_TRIANGLES} triangles"))
                    .help("simplify the model: gltf-transform simplify in.glb out.glb"));
            }
            meshes.push(Mesh { name, primitives });
        }
        Ok(meshes)
    }

    fn images(&self, document: &gltf::Document, buffers: &[Vec<u8>]) -> Outcome<Vec<Image>> {
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
                self.problem(codes::IMAGE, format_args!("image {index} cannot be decoded: {error}"))
                    .help("PNG and JPEG are read; convert others: gltf-transform png in.glb out.glb")
            };
            let open = || image::ImageReader::new(std::io::Cursor::new(&bytes)).with_guessed_format();
            let reader = open().map_err(|error| undecodable(error.into()))?;
            // Ask for the size first: a small file can claim a picture that fills the memory.
            let (width, height) = reader.into_dimensions().map_err(undecodable)?;
            let size = u64::from(width) * u64::from(height);
            pixels += size;
            if size > MAX_IMAGE_PIXELS || pixels > MAX_PIXELS {
                return Err(self
                    .problem(
                        codes::MODEL_LIMIT,
                        format_args!(
                            "image {index} is {width} × {height}; the limit is 8192 × 8192, four of them in all"
                        ),
                    )
                    .help("gltf-transform resize --width 4096 --height 4096 in.glb out.glb"));
            }
            let decoded = open().map_err(|error| undecodable(error.into()))?.decode().map_err(undecodable)?;
            images.push(Image { width, height, rgba: decoded.into_rgba8().into_raw() });
        }
        Ok(images)
    }

    fn animations(&mut self, document: &gltf::Document, buffers: &[Vec<u8>]) -> Outcome<Vec<Animation>> {
        let mut animations = Vec::new();
        for source in document.animations() {
            let name = source.name().map_or_else(|| format!("#{}", source.index()), str::to_owned);
            let mut channels = Vec::new();
            for channel in source.channels() {
                let decoded = animation::channel(&channel, buffers)
                    .map_err(|what| self.broken(format_args!("animation \"{name}\": {what}")))?;
                match decoded {
                    Some(channel) => channels.push(channel),
                    None => self.warn(format_args!("animation \"{name}\" scales or morphs, which bodies do not")),
                }
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
                /// A long lens: nearest to parallel projection that still has a place to stand.
                const NARROW: f64 = 0.2;
                self.warn("an orthographic camera is shown as a narrow perspective one");
                Camera { fovy: NARROW, aspect: None }
            }
        }
    }
}

/// The transform in double precision; `None` where it is not finite.
fn matrix(transform: gltf::scene::Transform) -> Option<DMat4> {
    let matrix = match transform {
        gltf::scene::Transform::Matrix { matrix } => {
            DMat4::from_cols_array_2d(&matrix.map(|column| column.map(f64::from)))
        }
        gltf::scene::Transform::Decomposed { translation, rotation, scale } => {
            // Composed here rather than by the crate: its quaternions are single precision and not quite unit.
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

fn decode(primitive: &gltf::Primitive, buffers: &[Vec<u8>]) -> Result<Primitive, accessor::Broken> {
    use gltf::Semantic;
    use gltf::accessor::Dimensions::{Vec2, Vec3, Vec4};
    let positions = primitive.get(&Semantic::Positions).ok_or("a primitive has no positions")?;
    let positions: Vec<[f32; 3]> = accessor::vectors(&positions, buffers, &[Vec3], 0.0)?;
    let list = match primitive.indices() {
        Some(indices) => accessor::indices(&indices, buffers, positions.len())?,
        None => (0..positions.len() as u32).collect(),
    };
    let same = |length: usize, what: &str| {
        if length == positions.len() { Ok(()) } else { Err(format!("{what} and positions differ in number")) }
    };
    let mut out = Primitive { indices: triangles(primitive.mode(), &list), ..Primitive::default() };
    out.material = primitive.material().index();
    if let Some(source) = primitive.get(&Semantic::TexCoords(0)) {
        out.uvs = accessor::vectors(&source, buffers, &[Vec2], 0.0)?;
        same(out.uvs.len(), "texture coordinates")?;
    }
    if let Some(source) = primitive.get(&Semantic::Colors(0)) {
        out.colors = accessor::vectors(&source, buffers, &[Vec3, Vec4], 1.0)?;
        same(out.colors.len(), "colours")?;
    }
    if let Some(source) = primitive.get(&Semantic::Tangents) {
        out.tangents = accessor::vectors(&source, buffers, &[Vec4], 1.0)?;
        same(out.tangents.len(), "tangents")?;
    }
    match primitive.get(&Semantic::Normals) {
        Some(source) => {
            out.normals = accessor::vectors(&source, buffers, &[Vec3], 0.0)?;
            same(out.normals.len(), "normals")?;
            out.positions = positions;
        }
        None => look::flatten(&mut out, positions),
    }
    Ok(out)
}

/// Indices of a strip or fan as separate triangles, all wound alike.
fn triangles(mode: Mode, list: &[u32]) -> Vec<u32> {
    match mode {
        Mode::TriangleStrip => {
            let turned = |(i, t): (usize, &[u32])| if i % 2 == 0 { [t[0], t[1], t[2]] } else { [t[1], t[0], t[2]] };
            list.windows(3).enumerate().flat_map(turned).collect()
        }
        Mode::TriangleFan => match list.split_first() {
            Some((&hub, rim)) => rim.windows(2).flat_map(|t| [hub, t[0], t[1]]).collect(),
            None => Vec::new(),
        },
        _ => list[..list.len() - list.len() % 3].to_vec(),
    }
}

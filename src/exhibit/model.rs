//! A glTF model as plain data: nodes, meshes, materials, textures, cameras, lights.

use crate::math::{DMat4, DVec3};

mod accessor;
mod animation;
mod import;
mod look;

pub use animation::{Animation, Channel, Curve, Track};
pub use import::{Imported, import, load};

/// A glTF model.
#[derive(Clone, Debug, Default)]
pub struct Model {
    /// All nodes, in file order.
    pub nodes: Vec<Node>,
    /// Nodes without a parent in the scene shown.
    pub roots: Vec<usize>,
    /// Meshes.
    pub meshes: Vec<Mesh>,
    /// Surface appearances.
    pub materials: Vec<Appearance>,
    /// Decoded images, RGBA8.
    pub images: Vec<Image>,
    /// Cameras, by index.
    pub cameras: Vec<Camera>,
    /// Punctual lights, by index.
    pub lights: Vec<Light>,
    /// Key frames.
    pub animations: Vec<Animation>,
}

/// A node of the scene graph.
#[derive(Clone, Debug)]
pub struct Node {
    /// Name, or `#index` where the file has none.
    pub name: String,
    /// Parent node.
    pub parent: Option<usize>,
    /// Child nodes.
    pub children: Vec<usize>,
    /// Node to parent.
    pub local: DMat4,
    /// Node to world at rest.
    pub world: DMat4,
    /// Index of the mesh.
    pub mesh: Option<usize>,
    /// Index of the camera.
    pub camera: Option<usize>,
    /// Index of the light.
    pub light: Option<usize>,
}

/// A mesh: primitives with a material each.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// Name.
    pub name: String,
    /// Parts.
    pub primitives: Vec<Primitive>,
}

/// Triangles with one material.
#[derive(Clone, Debug, Default)]
pub struct Primitive {
    /// m.
    pub positions: Vec<[f32; 3]>,
    /// Unit; computed flat where the file has none.
    pub normals: Vec<[f32; 3]>,
    /// Unit, w the sign of the bitangent; empty where the file has none.
    pub tangents: Vec<[f32; 4]>,
    /// Texture coordinates; empty where the file has none.
    pub uvs: Vec<[f32; 2]>,
    /// Linear RGBA per vertex; empty where the file has none.
    pub colors: Vec<[f32; 4]>,
    /// Three per triangle.
    pub indices: Vec<u32>,
    /// Index of the appearance.
    pub material: Option<usize>,
}

/// How a surface looks: the metallic–roughness model of glTF 2.0.
#[derive(Clone, Debug)]
pub struct Appearance {
    /// Name.
    pub name: String,
    /// Linear RGBA.
    pub base_color: [f32; 4],
    /// Index of the image.
    pub base_color_texture: Option<usize>,
    /// 0…1.
    pub metallic: f32,
    /// Perceptual, 0…1.
    pub roughness: f32,
    /// Index of the image: green roughness, blue metallic.
    pub metallic_roughness_texture: Option<usize>,
    /// Index of the image and scale.
    pub normal_texture: Option<(usize, f32)>,
    /// Index of the image and strength.
    pub occlusion_texture: Option<(usize, f32)>,
    /// Linear RGB, strength included.
    pub emissive: [f32; 3],
    /// Index of the image.
    pub emissive_texture: Option<usize>,
    /// How alpha is used.
    pub alpha: AlphaMode,
    /// Drawn from both sides.
    pub double_sided: bool,
}

impl Default for Appearance {
    fn default() -> Self {
        Self {
            name: String::new(),
            base_color: [1.0; 4],
            base_color_texture: None,
            metallic: 1.0,
            roughness: 1.0,
            metallic_roughness_texture: None,
            normal_texture: None,
            occlusion_texture: None,
            emissive: [0.0; 3],
            emissive_texture: None,
            alpha: AlphaMode::Opaque,
            double_sided: false,
        }
    }
}

/// How alpha is used.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AlphaMode {
    /// Ignored.
    Opaque,
    /// Cut at a threshold.
    Mask(f32),
    /// Blended.
    Blend,
}

/// A decoded image, 8 bit RGBA as stored (sRGB or linear by use), with its sampler's wrapping.
#[derive(Clone, Debug, Default)]
pub struct Image {
    /// Pixels.
    pub width: u32,
    /// Pixels.
    pub height: u32,
    /// width × height × 4 bytes.
    pub rgba: Vec<u8>,
}

/// A glTF camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Vertical field of view, rad.
    pub fovy: f64,
    /// width / height it was made for.
    pub aspect: Option<f64>,
}

/// A punctual light (KHR_lights_punctual), shining along −Z of its node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    /// Kind and shape.
    pub kind: LightKind,
    /// Linear RGB.
    pub color: DVec3,
    /// Candela (point, spot) or lux (directional).
    pub intensity: f64,
    /// m; infinite where the file has none.
    pub range: f64,
}

/// Kind of a punctual light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightKind {
    /// Parallel rays.
    Directional,
    /// All directions.
    Point,
    /// A cone, inner and outer half-angle, rad.
    Spot(f64, f64),
}

//! The model: its tree of nodes, and what the nodes show.

use super::animation::Animation;
use super::appearance::Appearance;
use super::mesh::{Mesh, Morph, Skin};
use soffio_math::{DMat4, DVec3};

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
    /// Meshes that follow joints; the mesh of each one's node is as it stands at rest.
    pub skins: Vec<Skin>,
    /// Meshes without joints whose weights key frames change; the mesh of each one's node is as it stands at rest.
    pub morphs: Vec<Morph>,
    /// Nodes that are not drawn, sorted: hidden by KHR_node_visibility, or below one that is.
    pub hidden: Vec<usize>,
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

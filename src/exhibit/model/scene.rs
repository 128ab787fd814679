//! The glTF scene: its tree of nodes with meshes, cameras and lights.

use std::sync::Arc;

use super::animation::Animation;
use super::appearance::Appearance;
use super::mesh::{Mesh, Morph, Skin};
use soffio_math::{DMat4, DVec3};

/// A glTF model.
#[derive(Clone, Debug, Default)]
pub struct Model {
    /// All nodes, in file order.
    pub nodes: Vec<Node>,
    /// Root nodes of the scene shown.
    pub roots: Vec<usize>,
    /// Meshes.
    pub meshes: Vec<Mesh>,
    /// Surface materials.
    pub materials: Vec<Appearance>,
    /// Decoded images, RGBA8; those of finishes are shared by all models.
    pub images: Vec<Arc<Image>>,
    /// Cameras, by index.
    pub cameras: Vec<Camera>,
    /// Punctual lights, by index.
    pub lights: Vec<Light>,
    /// Key-frame animations.
    pub animations: Vec<Animation>,
    /// Skinned meshes; the mesh of each one's node is deformed as in the rest pose.
    pub skins: Vec<Skin>,
    /// Meshes with animated morph weights; the mesh of each one's node is as at rest.
    pub morphs: Vec<Morph>,
    /// Nodes that are not drawn, sorted: those hidden by KHR_node_visibility and all nodes below them.
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
    /// Transform from node to parent.
    pub local: DMat4,
    /// Transform from node to world in the model.
    pub world: DMat4,
    /// Index of the mesh.
    pub mesh: Option<usize>,
    /// Index of the camera.
    pub camera: Option<usize>,
    /// Index of the light.
    pub light: Option<usize>,
}

/// A decoded image, 8-bit RGBA as stored (sRGB or linear, depending on its use).
#[derive(Clone, Debug, Default)]
pub struct Image {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Pixels, width × height × 4 bytes.
    pub rgba: Vec<u8>,
}

/// A glTF camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Vertical field of view, rad.
    pub fovy: f64,
    /// Width / height that it was made for.
    pub aspect: Option<f64>,
}

/// A punctual light (KHR_lights_punctual) that shines along −Z of its node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    /// Kind and shape.
    pub kind: LightKind,
    /// Linear RGB.
    pub color: DVec3,
    /// Candela (point, spot) or lux (directional).
    pub intensity: f64,
    /// Range, m; infinite where the file has none.
    pub range: f64,
}

/// Kind of a punctual light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightKind {
    /// Directional: parallel rays.
    Directional,
    /// Point: all directions.
    Point,
    /// Spot: a cone, inner and outer half-angle, rad.
    Spot(f64, f64),
}

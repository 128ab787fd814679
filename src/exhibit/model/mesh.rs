//! Meshes: triangles with a material each, and what they follow or morph to.

use soffio_math::DMat4;

/// A mesh: primitives with a material each.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// Name.
    pub name: String,
    /// Parts.
    pub primitives: Vec<Primitive>,
}

/// A mesh that follows joints (glTF 2.0, 3.7.3).
#[derive(Clone, Debug, Default)]
pub struct Skin {
    /// The node that shows it.
    pub node: usize,
    /// Nodes that it follows.
    pub joints: Vec<usize>,
    /// For each joint, what takes the mesh as it is bound to the joint's frame.
    pub inverse_bind: Vec<DMat4>,
    /// The primitives of the node's mesh as they are bound, corner by corner; not morphed where key frames change its weights.
    pub bound: Vec<Primitive>,
}

/// A mesh whose morph weights key frames change (glTF 2.0, 3.7.2.2).
#[derive(Clone, Debug, Default)]
pub struct Morph {
    /// The node that shows it.
    pub node: usize,
    /// The primitives of its mesh before any target is added, with their targets.
    pub primitives: Vec<Primitive>,
}

/// A morph target: what is added to each corner for a weight of one. A list is empty where the file has none.
#[derive(Clone, Debug, Default)]
pub struct MorphTarget {
    /// m.
    pub positions: Vec<[f32; 3]>,
    /// To unit normals.
    pub normals: Vec<[f32; 3]>,
    /// To unit tangents.
    pub tangents: Vec<[f32; 3]>,
}

/// Joints of its skin that a corner follows, and by which shares: their sum is 1, or 0 where it follows none.
pub type Influences = [(u16, f32); 4];

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
    /// The second set of them.
    pub second_uvs: Vec<[f32; 2]>,
    /// Linear RGBA per vertex; empty where the file has none.
    pub colors: Vec<[f32; 4]>,
    /// Joints of a bound primitive's corners; empty elsewhere.
    pub influences: Vec<Influences>,
    /// What key frames morph it to; empty elsewhere.
    pub targets: Vec<MorphTarget>,
    /// Has the file no normals? Then they are those of the triangles, none of which shares a corner.
    pub flat: bool,
    /// Three per triangle.
    pub indices: Vec<u32>,
    /// Index of the appearance.
    pub material: Option<usize>,
}

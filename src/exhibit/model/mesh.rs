//! Triangle meshes, skins and morph targets.

use soffio_math::DMat4;

/// A mesh: primitives with a material each.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// Name.
    pub name: String,
    /// Primitives: triangles of one material.
    pub primitives: Vec<Primitive>,
}

impl Mesh {
    /// Memory of its vertices and indices, bytes.
    pub fn bytes(&self) -> u64 {
        let bytes = |p: &Primitive| {
            size_of_val(&*p.positions)
                + size_of_val(&*p.normals)
                + size_of_val(&*p.tangents)
                + size_of_val(&*p.uvs)
                + size_of_val(&*p.second_uvs)
                + size_of_val(&*p.colors)
                + size_of_val(&*p.indices)
        };
        self.primitives.iter().map(|primitive| bytes(primitive) as u64).sum()
    }
}

/// A skinned mesh: it follows joints (glTF 2.0, 3.7.3).
#[derive(Clone, Debug, Default)]
pub struct Skin {
    /// Index of the node that shows it.
    pub node: usize,
    /// Indices of the joint nodes.
    pub joints: Vec<usize>,
    /// Inverse bind matrix of each joint.
    pub inverse_bind: Vec<DMat4>,
    /// The undeformed primitives of the node's mesh; without morph targets where their weights are animated.
    pub bound: Vec<Primitive>,
}

/// A mesh with animated morph weights (glTF 2.0, 3.7.2.2).
#[derive(Clone, Debug, Default)]
pub struct Morph {
    /// Index of the node that shows it.
    pub node: usize,
    /// The primitives of its mesh without any target, and their targets.
    pub primitives: Vec<Primitive>,
}

/// A morph target: differences at weight one. A list is empty where the file has none.
#[derive(Clone, Debug, Default)]
pub struct MorphTarget {
    /// Differences of the positions, m.
    pub positions: Vec<[f32; 3]>,
    /// Differences of the unit normals.
    pub normals: Vec<[f32; 3]>,
    /// Differences of the unit tangents.
    pub tangents: Vec<[f32; 3]>,
}

/// Joint index and skin weight of the joints that a vertex follows; the weights sum to 1, or are all 0 where it follows
/// none.
pub type Influences = [(u16, f32); 4];

/// Triangles with one material.
#[derive(Clone, Debug, Default)]
pub struct Primitive {
    /// Positions, m.
    pub positions: Vec<[f32; 3]>,
    /// Unit normals; flat ones where the file has none.
    pub normals: Vec<[f32; 3]>,
    /// Unit tangents, w the sign of the bitangent; empty where the file has none.
    pub tangents: Vec<[f32; 4]>,
    /// Texture coordinates; empty where the file has none.
    pub uvs: Vec<[f32; 2]>,
    /// Second set of texture coordinates.
    pub second_uvs: Vec<[f32; 2]>,
    /// Vertex colours, linear RGBA; empty where the file has none.
    pub colors: Vec<[f32; 4]>,
    /// Joints of a skinned primitive's vertices; empty elsewhere.
    pub influences: Vec<Influences>,
    /// Animated morph targets; empty elsewhere.
    pub targets: Vec<MorphTarget>,
    /// Are the normals those of the triangles, because the file has none? Then no two triangles share a vertex.
    pub flat: bool,
    /// Vertex indices, three for each triangle.
    pub indices: Vec<u32>,
    /// Index of the appearance.
    pub material: Option<usize>,
}

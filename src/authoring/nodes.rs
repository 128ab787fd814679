//! Names of a model's nodes in a sidecar, and their meshes in the world.

use std::collections::BTreeMap;

use soffio_exhibit::fit as shapes;
use soffio_exhibit::model::Model;
use soffio_geometry::TriangleMesh;
use soffio_math::{DMat3, DVec3};

/// A vector in TOML.
pub(super) fn toml_vector(v: DVec3) -> String {
    // Debug formatting uses an exponent for large numbers: 1e30 is a TOML float, its digits are not.
    format!("[{:?}, {:?}, {:?}]", v.x, v.y, v.z)
}

/// Names of a model's nodes in the sidecar.
pub(super) struct Names<'m> {
    model: &'m Model,
    /// Number of nodes of each name.
    counts: BTreeMap<&'m str, usize>,
}

impl<'m> Names<'m> {
    /// The names of a model's nodes.
    pub fn new(model: &'m Model) -> Self {
        let mut counts = BTreeMap::new();
        for node in &model.nodes {
            *counts.entry(node.name.as_str()).or_default() += 1;
        }
        Self { model, counts }
    }

    /// The name of a node, or its number where the name is not unique.
    pub fn of(&self, node: usize) -> String {
        let name = &self.model.nodes[node].name;
        let alone = self.counts.get(name.as_str()) == Some(&1);
        if alone && !name.is_empty() && !name.starts_with('#') { name.clone() } else { format!("#{node}") }
    }
}

/// Nodes at and below one that have a mesh.
pub(super) fn meshes(model: &Model, root: usize) -> Vec<usize> {
    let mut found = Vec::new();
    let mut open = vec![root];
    while let Some(node) = open.pop() {
        found.extend(model.nodes[node].mesh.map(|_| node));
        open.extend(&model.nodes[node].children);
    }
    found.sort_unstable();
    found
}

/// The meshes at and below a node, in world coordinates.
pub(super) fn world_meshes(model: &Model, root: usize) -> Vec<TriangleMesh> {
    let mut solids = Vec::new();
    for node in meshes(model, root) {
        let world = model.nodes[node].world;
        let Some(mesh) = model.nodes[node].mesh.and_then(|mesh| model.meshes.get(mesh)) else { continue };
        let mut out = TriangleMesh::default();
        for primitive in &mesh.primitives {
            let base = out.positions.len() as u32;
            out.positions.extend(primitive.positions.iter().map(|p| DVec3::from(p.map(f64::from))));
            out.triangles.extend(primitive.indices.chunks_exact(3).map(|t| [base + t[0], base + t[1], base + t[2]]));
        }
        let mut out = out.welded();
        out.positions.iter_mut().for_each(|p| *p = world.transform_point3(*p));
        if DMat3::from_mat4(world).determinant() < 0.0 {
            out.triangles.iter_mut().for_each(|t| t.swap(1, 2));
        }
        solids.push(out);
    }
    solids
}

/// The `fit` that suits the meshes at and below a node.
pub(super) fn fit(model: &Model, node: usize) -> Option<&'static str> {
    let mut whole = TriangleMesh::default();
    world_meshes(model, node).iter().for_each(|mesh| whole.append(mesh));
    let extents = whole.extents()?;
    // A sheet is at least twenty times as wide as thick.
    let flat = extents.half.z < 0.05 * extents.half.y;
    if flat && shapes::plate(&whole, &extents).is_some() {
        return Some("plate");
    }
    shapes::convex(&whole).map(|_| "convex")
}

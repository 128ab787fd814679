//! Nodes of a model with their transforms in double precision, the roots of the scene, and what is hidden.

use gltf::scene::Transform;

use super::fault::{Cause, Fault};
use super::scene::Node;
use soffio_math::{DMat4, DQuat, DVec3};

/// The nodes, and the roots of the scene that is shown. The tree has been checked: each node has one parent at most.
///
/// # Errors
/// A transform that is not finite.
pub fn nodes(document: &gltf::Document) -> Result<(Vec<Node>, Vec<usize>), Fault> {
    let mut nodes: Vec<Node> = Vec::new();
    for node in document.nodes() {
        let name = node.name().map_or_else(|| format!("#{}", node.index()), str::to_owned);
        let local = matrix(node.transform()).ok_or_else(|| {
            let place = format!("nodes[{}]", node.index());
            Fault::at(Cause::NotFinite, place, format_args!("the transform of node \"{name}\" is not finite"))
        })?;
        nodes.push(Node {
            name,
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
            nodes[child].parent = Some(parent);
        }
    }
    let scene = document.default_scene().or_else(|| document.scenes().next());
    let roots: Vec<usize> = match scene {
        Some(scene) => scene.nodes().map(|node| node.index()).collect(),
        None => (0..nodes.len()).filter(|&i| nodes[i].parent.is_none()).collect(),
    };
    let mut open: Vec<usize> = (0..nodes.len()).filter(|&i| nodes[i].parent.is_none()).collect();
    while let Some(index) = open.pop() {
        if let Some(parent) = nodes[index].parent {
            nodes[index].world = nodes[parent].world * nodes[index].local;
        }
        open.extend(&nodes[index].children);
    }
    Ok((nodes, roots))
}

/// Nodes hidden by KHR_node_visibility, and all nodes below them.
pub fn hidden(document: &gltf::Document, nodes: &[Node]) -> Vec<usize> {
    let visible = |node: &gltf::Node| node.extension_value("KHR_node_visibility")?.get("visible")?.as_bool();
    let mut open: Vec<usize> = document.nodes().filter(|n| visible(n) == Some(false)).map(|n| n.index()).collect();
    let mut hidden = Vec::new();
    // Visited nodes are not opened again.
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
fn matrix(transform: Transform) -> Option<DMat4> {
    let matrix = match transform {
        Transform::Matrix { matrix } => DMat4::from_cols_array_2d(&matrix.map(|column| column.map(f64::from))),
        Transform::Decomposed { translation, rotation, scale } => {
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

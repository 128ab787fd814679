//! The node tree, transforms, scenes and skins (glTF 2.0, sections 3.5 and 3.7.3).

use serde_json::Value;

use super::super::fault::{Cause, Fault};
use super::buffers::Use;
use super::{Check, whole};

/// Most nodes of a model.
pub const MAX_NODES: usize = 65_536;
/// Most nodes from a root to a leaf. Chains of bones have some hundred; a walk from each node to its root stays short.
pub const MAX_DEPTH: usize = 1024;
/// Largest difference of a quaternion's length from 1, and of the cosine of a matrix's axes from 0, without a warning:
/// ten times what single precision loses in a product.
const ROUNDED: f64 = 1e-4;

/// The numbers of a list; NaN where one is none.
fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().into_iter().flatten().map(|x| x.as_f64().unwrap_or(f64::NAN)).collect()
}

fn length(v: &[f64]) -> f64 {
    v.iter().map(|x| x * x).sum::<f64>().sqrt()
}

impl Check<'_> {
    /// Nodes form trees: each has one parent at most, and none is its own ancestor.
    pub(super) fn tree(&mut self) {
        let nodes = self.list("nodes");
        if nodes.len() > MAX_NODES {
            let help = "join meshes that do not move against each other, and export the model again";
            let what = format_args!("has {} nodes; the limit is {MAX_NODES}", nodes.len());
            self.faults.push(Fault::at(Cause::Limit, "nodes", what).remedy(help));
            return;
        }
        let children = |node: usize| nodes[node]["children"].as_array().into_iter().flatten().filter_map(Value::as_u64);
        let mut parents: Vec<Option<usize>> = vec![None; nodes.len()];
        for node in 0..nodes.len() {
            for (k, child) in children(node).enumerate() {
                let child = child as usize;
                let name = self.name(child);
                match parents[child].replace(node) {
                    Some(other) => {
                        let what = format_args!("is {child}: node {name} has two parents, {} and {node}", other);
                        self.faults.add(Cause::Tree, format_args!("nodes[{node}].children[{k}]"), what);
                    }
                    None if child == node => {
                        let what = format_args!("is {child}: node {name} is its own child");
                        self.faults.add(Cause::Tree, format_args!("nodes[{node}].children[{k}]"), what);
                    }
                    None => {}
                }
            }
        }
        // Depths from the roots on; a node that is not reached lies on a cycle or below one.
        let mut depths = vec![0; nodes.len()];
        let mut open: Vec<usize> = (0..nodes.len()).filter(|&node| parents[node].is_none()).collect();
        open.iter().for_each(|&root| depths[root] = 1);
        while let Some(node) = open.pop() {
            for child in children(node).map(|child| child as usize).filter(|&child| parents[child] == Some(node)) {
                if depths[child] == 0 {
                    depths[child] = depths[node] + 1;
                    open.push(child);
                }
            }
        }
        if let Some(node) = depths.iter().position(|&depth| depth == 0)
            && self.faults.errors.is_empty()
        {
            let what = format_args!("node {} is its own ancestor", self.name(node));
            self.faults.add(Cause::Tree, format_args!("nodes[{node}]"), what);
        }
        if let Some(node) = depths.iter().position(|&depth| depth > MAX_DEPTH) {
            let what = format_args!(
                "node {} is {} nodes below its root; the limit is {MAX_DEPTH}",
                self.name(node),
                depths[node]
            );
            let help = "put the nodes beside each other, or leave out empty ones between them, and export again";
            self.faults.push(Fault::at(Cause::Limit, format_args!("nodes[{node}]"), what).remedy(help));
        }
        for (index, scene) in self.list("scenes").iter().enumerate() {
            for (k, node) in scene["nodes"].as_array().into_iter().flatten().enumerate() {
                let node = node.as_u64().unwrap_or(0) as usize;
                if let Some(parent) = parents[node] {
                    let what = format_args!("is {node}, which is no root: it is a child of node {parent}");
                    self.warn(format_args!("scenes[{index}].nodes[{k}]"), what);
                }
            }
        }
        for (index, node) in nodes.iter().enumerate() {
            self.node(index, node);
        }
    }

    /// A node for messages: its name in quotes, or its number.
    fn name(&self, node: usize) -> String {
        let name = self.list("nodes")[node]["name"].as_str().unwrap_or_default();
        if name.is_empty() { format!("#{node}") } else { format!("\"{name}\"") }
    }

    fn node(&mut self, index: usize, node: &Value) {
        let place = format!("nodes[{index}]");
        let parts = ["translation", "rotation", "scale"].into_iter().find(|key| node.get(key).is_some());
        if let Some(matrix) = node.get("matrix") {
            if let Some(part) = parts {
                let what = format_args!("node {} has both a matrix and a {part}", self.name(index));
                self.faults.add(Cause::Conflict, format_args!("{place}.matrix"), what);
            }
            self.matrix(&numbers(matrix), &format!("{place}.matrix"), index);
        }
        if let Some(rotation) = node.get("rotation") {
            let size = length(&numbers(rotation));
            if size == 0.0 {
                let what = format_args!("of node {} has no length; a rotation has the length 1", self.name(index));
                self.faults.add(Cause::Range, format_args!("{place}.rotation"), what);
            } else if (size - 1.0).abs() > ROUNDED {
                self.warn(
                    format_args!("{place}.rotation"),
                    format_args!("has the length {size}; it is read as if it were 1"),
                );
            }
        }
        let mesh = whole(node, "mesh");
        for key in ["skin", "weights"] {
            if mesh.is_none() && node.get(key).is_some() {
                self.warn(format_args!("{place}.{key}"), "belongs to a mesh, and the node has none; it is ignored");
            }
        }
    }

    /// A transform has no perspective, and its axes are perpendicular.
    fn matrix(&mut self, m: &[f64], place: &str, node: usize) {
        let [.., w] = [m[3], m[7], m[11], m[15]];
        if [m[3], m[7], m[11]].iter().any(|x| x.abs() > ROUNDED) || (w - 1.0).abs() > ROUNDED {
            let what = format_args!("of node {} has a last row other than 0, 0, 0, 1", self.name(node));
            self.faults.add(Cause::Range, place, what);
            return;
        }
        let axes = [&m[0..3], &m[4..7], &m[8..11]];
        let skewed = [(0, 1), (1, 2), (2, 0)].iter().any(|&(i, k)| {
            let dot: f64 = axes[i].iter().zip(axes[k]).map(|(a, b)| a * b).sum();
            dot.abs() > ROUNDED * length(axes[i]) * length(axes[k])
        });
        if skewed || axes.iter().any(|axis| length(axis) == 0.0) {
            self.warn(place, "is no rotation with a scale along its axes; it is used as it is");
        }
    }

    /// Skins: one inverse bind matrix a joint, joints below one root.
    pub(super) fn skins(&mut self) {
        let nodes = self.list("nodes");
        let mut parents: Vec<Option<usize>> = vec![None; nodes.len()];
        for (index, node) in nodes.iter().enumerate() {
            for child in node["children"].as_array().into_iter().flatten().filter_map(Value::as_u64) {
                parents[child as usize] = Some(index);
            }
        }
        let above = |node: usize| std::iter::successors(Some(node), |&n| parents[n]);
        let roots: Vec<usize> = (0..nodes.len()).map(|node| above(node).last().unwrap_or(node)).collect();
        let scenes: Vec<Vec<bool>> = self.list("scenes").iter().map(|scene| shown_roots(scene, nodes.len())).collect();
        for (index, skin) in self.list("skins").iter().enumerate() {
            let joints: Vec<usize> =
                skin["joints"].as_array().into_iter().flatten().filter_map(|j| Some(j.as_u64()? as usize)).collect();
            // The roots of one scene belong together.
            let together = |shown: &Vec<bool>| joints.iter().all(|&joint| shown[roots[joint]]);
            let apart = joints.windows(2).any(|pair| roots[pair[0]] != roots[pair[1]]);
            if apart && !scenes.iter().any(together) {
                self.warn(format_args!("skins[{index}].joints"), "have no common root");
            } else if let Some(skeleton) = whole(skin, "skeleton")
                && !joints.iter().all(|&joint| above(joint).any(|node| node == skeleton))
            {
                self.warn(format_args!("skins[{index}].skeleton"), "is no common root of the joints");
            }
            let Some(matrices) = whole(skin, "inverseBindMatrices") else { continue };
            let place = format!("skins[{index}].inverseBindMatrices");
            let (kind, component) = self.format(matrices);
            if (kind, component) != ("MAT4", 5126) {
                let what = format_args!("names accessors[{matrices}] of {kind}; it must be MAT4 of FLOAT");
                self.faults.add(Cause::Format, &place, what);
            } else if self.count(matrices) < joints.len() {
                let (has, wants) = (self.count(matrices), joints.len());
                let what = format_args!("names accessors[{matrices}] of {has} matrices; the skin has {wants} joints");
                self.faults.add(Cause::Count, &place, what);
            }
            self.accessor_used(matrices, Use::Other("matrices of a skin"), &place);
        }
        for (index, node) in nodes.iter().enumerate() {
            let (Some(skin), Some(mesh)) = (whole(node, "skin"), whole(node, "mesh")) else { continue };
            let primitives = self.list("meshes")[mesh]["primitives"].as_array();
            let skinned = |p: &Value| p["attributes"].get("JOINTS_0").is_some();
            if !primitives.into_iter().flatten().any(skinned) {
                let what = format_args!("is skins[{skin}], and the node's mesh names no joints; it stays in its pose");
                self.warn(format_args!("nodes[{index}].skin"), what);
            }
            let joint = self.list("skins")[skin]["joints"][0].as_u64().unwrap_or(0) as usize;
            if let Some(scene) = scenes.iter().position(|shown| shown[roots[index]] && !shown[roots[joint]]) {
                let what = format_args!("shows nodes[{index}] without the joints of its skin");
                self.warn(format_args!("scenes[{scene}]"), what);
            }
        }
    }
}

/// Is a node listed in a scene?
fn shown_roots(scene: &Value, nodes: usize) -> Vec<bool> {
    let mut shown = vec![false; nodes];
    for node in scene["nodes"].as_array().into_iter().flatten().filter_map(Value::as_u64) {
        shown[node as usize] = true;
    }
    shown
}

//! Resolves the paths of moving nails, as nodes of the model.

use super::super::model::{Model, Node};
use super::super::sidecar::{self, Sidecar, Target};
use soffio_math::{DMat4, DVec3};

/// Name of the node of a nail's path.
pub(super) fn path_node(nail: &str) -> String {
    format!("{nail}/path")
}

/// Adds the paths of moving nails to the model: each is an empty node at its first point, and becomes a kinematic body.
pub(super) fn add_path_nodes(model: &mut Model, sidecar: &Sidecar) {
    for (name, path) in sidecar.constraint.paths() {
        let [_, x, y, z] = path.points.first().copied().unwrap_or_default();
        let place = DMat4::from_translation(DVec3::new(x, y, z));
        model.roots.push(model.nodes.len());
        model.nodes.push(Node {
            name: path_node(name),
            parent: None,
            children: Vec::new(),
            local: place,
            world: place,
            mesh: None,
            camera: None,
            light: None,
        });
    }
}

impl sidecar::Constraints {
    /// Names and paths of the constraints that hold a body to a path.
    pub(super) fn paths(&self) -> Vec<(&str, &sidecar::Path)> {
        let required = self.nail.iter().map(|c| (&c.name, Some(&c.to)));
        let hinges = self.hinge.iter().chain(&self.windmill).map(|c| (&c.name, c.to.as_ref()));
        let others = self.universal.iter().map(|c| (&c.name, c.to.as_ref()));
        let sliders = self.slider.iter().map(|c| (&c.name, c.to.as_ref()));
        let lines = self.line.iter().map(|c| (&c.name, c.to.as_ref()));
        let welds = self.weld.iter().map(|c| (&c.name, c.to.as_ref()));
        let all = required.chain(hinges).chain(others).chain(sliders).chain(lines).chain(welds);
        all.filter_map(|(name, to)| match to {
            Some(Target::Path { path }) => Some((name.as_str(), path)),
            _ => None,
        })
        .collect()
    }
}

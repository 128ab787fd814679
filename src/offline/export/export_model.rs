//! The model for export: each moving body as a root node, wires as meshes, and the visitor's camera.

use soffio_exhibit::model::{Appearance, Camera, Mesh, Model, Node};
use soffio_exhibit::{Exhibit, Wire};
use soffio_math::{DMat3, DMat4, DQuat, DVec3};

use super::tube::tube;

/// Aspect of the camera where the exhibit has none.
const ASPECT: f64 = 16.0 / 9.0;

/// An exhibit's model for other programs.
pub struct ExportModel {
    /// The model: nodes of bodies are roots at their start pose, with those descendants that are no bodies.
    pub model: Model,
    /// For each body, the scale of its node, which applies to its descendants.
    pub scales: Vec<DMat4>,
}

/// A mesh in the rigid frame of the body that carries it.
pub struct PlacedPrimitive<'a> {
    /// Index of the body; `None` is the world.
    pub body: Option<usize>,
    /// The mesh.
    pub mesh: &'a Mesh,
    /// Transform from the mesh to the body's frame.
    pub place: DMat4,
}

impl ExportModel {
    /// Builds the model of an exhibit.
    pub fn new(exhibit: &Exhibit) -> Self {
        let mut model = Model { animations: Vec::new(), ..exhibit.model.clone() };
        let mut scales = Vec::with_capacity(exhibit.bodies.len());
        for body in &exhibit.bodies {
            let (_, rotation, position) = exhibit.model.nodes[body.node].world.to_scale_rotation_translation();
            let rigid = DMat4::from_rotation_translation(rotation, position);
            let scale = rigid.inverse() * exhibit.model.nodes[body.node].world;
            // A scale of one within rounding is none.
            let scale = if scale.abs_diff_eq(DMat4::IDENTITY, 1e-6) { DMat4::IDENTITY } else { scale };
            if let Some(parent) = model.nodes[body.node].parent.take() {
                model.nodes[parent].children.retain(|&child| child != body.node);
                model.roots.push(body.node);
            }
            model.nodes[body.node].local = body.pose.matrix() * scale;
            scales.push(scale);
        }
        let mut scenery = Self { model, scales };
        exhibit.wires.iter().for_each(|wire| scenery.add_wire(exhibit, wire));
        if exhibit.camera_node.is_none() {
            scenery.add_camera(exhibit);
        }
        scenery
    }

    fn add_wire(&mut self, exhibit: &Exhibit, wire: &Wire) {
        let model = &mut self.model;
        let look = Appearance {
            base_color: [wire.color[0], wire.color[1], wire.color[2], 1.0],
            metallic: wire.metallic,
            roughness: wire.roughness,
            ..Appearance::default()
        };
        let same = |m: &Appearance| {
            m.name.starts_with("wire")
                && (m.base_color, m.metallic, m.roughness) == (look.base_color, look.metallic, look.roughness)
        };
        let material = model.materials.iter().position(same).unwrap_or_else(|| {
            let name = format!("wire {}", model.materials.len());
            model.materials.push(Appearance { name, ..look });
            model.materials.len() - 1
        });
        let mut primitive = tube(&wire.points, wire.radius);
        primitive.material = Some(material);
        let mesh = model.meshes.len();
        model.meshes.push(Mesh { name: wire.name.clone(), primitives: vec![primitive] });
        let parent = wire.body.map(|body| exhibit.bodies[body].node);
        // Points of wires are in metres whatever the node's scale.
        let local = wire.body.map_or(DMat4::IDENTITY, |body| self.scales[body].inverse());
        self.add(Node { mesh: Some(mesh), ..node(&wire.name, parent, local) });
    }

    fn add_camera(&mut self, exhibit: &Exhibit) {
        let view = exhibit.view(ASPECT);
        let (right, up, forward) = view.axes();
        let turn = DQuat::from_mat3(&DMat3::from_cols(right, up, -forward));
        let camera = self.model.cameras.len();
        self.model.cameras.push(Camera { fovy: view.fovy, aspect: Some(ASPECT) });
        let local = DMat4::from_rotation_translation(turn, view.eye);
        self.add(Node { camera: Some(camera), ..node("View", None, local) });
    }

    fn add(&mut self, node: Node) {
        let index = self.model.nodes.len();
        match node.parent {
            Some(parent) => self.model.nodes[parent].children.push(index),
            None => self.model.roots.push(index),
        }
        self.model.nodes.push(node);
    }

    /// All visible meshes, in the frames of the bodies that carry them.
    pub fn placed_primitives(&self, exhibit: &Exhibit) -> Vec<PlacedPrimitive<'_>> {
        let body_of = |node| exhibit.bodies.iter().position(|body| body.node == node);
        let mut out = Vec::new();
        for &root in &self.model.roots {
            let body = body_of(root);
            let place = body.map_or(self.model.nodes[root].local, |body| self.scales[body]);
            let mut open = vec![(root, place)];
            while let Some((index, place)) = open.pop() {
                if self.model.hidden.binary_search(&index).is_ok() {
                    continue;
                }
                let node = &self.model.nodes[index];
                if let Some(mesh) = node.mesh.and_then(|mesh| self.model.meshes.get(mesh)) {
                    out.push(PlacedPrimitive { body, mesh, place });
                }
                open.extend(node.children.iter().map(|&child| (child, place * self.model.nodes[child].local)));
            }
        }
        out
    }

    /// Bounding radius of each body about its node, m.
    pub fn node_radii(&self, exhibit: &Exhibit) -> Vec<f64> {
        let mut reaches = vec![0.0; exhibit.bodies.len()];
        for PlacedPrimitive { body, mesh, place } in self.placed_primitives(exhibit) {
            let Some(body) = body else { continue };
            for corner in mesh.primitives.iter().flat_map(|primitive| &primitive.positions) {
                let at = place.transform_point3(DVec3::from(corner.map(f64::from)));
                reaches[body] = at.length().max(reaches[body]);
            }
        }
        reaches
    }
}

fn node(name: &str, parent: Option<usize>, local: DMat4) -> Node {
    let (mesh, camera, light) = (None, None, None);
    Node { name: name.into(), parent, children: Vec::new(), local, world: local, mesh, camera, light }
}

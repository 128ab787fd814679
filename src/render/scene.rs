//! The exhibit as one vertex buffer.
//!
//! Whatever moves is rigid, so each vertex is stored in the frame of the body that carries it, scales of the scene
//! graph applied, with the index of that frame (0 is the world). A pose is then one 3×4 matrix a body, and a whole
//! exhibit one draw for each material and state.

use bytemuck::{Pod, Zeroable};
use glam::{DMat4, Mat4, Vec3, Vec4};

use super::RenderError;
use super::globals::PunctualUniform;
use crate::exhibit::Exhibit;
use crate::exhibit::model::{AlphaMode, LightKind, Primitive};
use crate::math::Pose;

/// Frames the uniform buffer holds: 48 KiB, below the 64 every adapter has. The first is the world.
pub(super) const MAX_FRAMES: usize = 1024;
/// Punctual lights of a model that are lit; the rest stay dark.
pub(super) const MAX_PUNCTUAL: usize = 8;

/// One corner, in the frame of its body.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(super) struct Vertex {
    pub position: Vec3,
    pub normal: Vec3,
    pub tangent: [f32; 4],
    pub uv: [f32; 2],
    pub color: [f32; 4],
    pub frame: u32,
}

/// Triangles drawn alike.
#[derive(Clone, Debug)]
pub(super) struct Part {
    /// Range in the index buffer.
    pub indices: std::ops::Range<u32>,
    /// Index of the appearance; one past the last is the default.
    pub material: usize,
    pub double_sided: bool,
    pub blend: bool,
    /// Middle of the triangles in their frame, to sort what is blended.
    pub center: Vec3,
    pub frame: usize,
}

/// A punctual light in the frame of its body.
#[derive(Clone, Copy, Debug)]
pub(super) struct Punctual {
    pub frame: usize,
    position: Vec3,
    axis: Vec3,
    color: Vec3,
    range: f32,
    kind: LightKind,
}

/// All meshes and lights of an exhibit.
pub(super) struct Scene {
    pub vertices: Vec<Vertex>,
    pub indices: Vec<u32>,
    /// Opaque parts first: the first `opaque` indices are what throws shadows.
    pub parts: Vec<Part>,
    pub opaque: u32,
    pub lights: Vec<Punctual>,
}

impl Scene {
    pub fn new(exhibit: &Exhibit) -> Result<Self, RenderError> {
        if exhibit.bodies.len() >= MAX_FRAMES {
            return Err(RenderError::TooManyBodies { count: exhibit.bodies.len(), limit: MAX_FRAMES - 1 });
        }
        let model = &exhibit.model;
        let mut pieces = Vec::new();
        let mut lights = Vec::new();
        for (node, carrier) in model.nodes.iter().zip(exhibit.carriers()) {
            let frame_from_node = match carrier {
                Some(body) => rigid(model.nodes[exhibit.bodies[body].node].world).inverse() * node.world,
                None => node.world,
            };
            let frame = carrier.map_or(0, |body| body + 1);
            if let Some(mesh) = node.mesh.and_then(|m| model.meshes.get(m)) {
                pieces.extend(mesh.primitives.iter().map(|p| (p, frame, frame_from_node.as_mat4())));
            }
            if let Some(light) = node.light.and_then(|l| model.lights.get(l))
                && lights.len() < MAX_PUNCTUAL
            {
                let m = frame_from_node.as_mat4();
                lights.push(Punctual {
                    frame,
                    position: m.w_axis.truncate(),
                    axis: -m.z_axis.truncate().normalize_or(Vec3::Z),
                    color: (light.color * light.intensity).as_vec3(),
                    range: if light.range.is_finite() { light.range as f32 } else { 0.0 },
                    kind: light.kind,
                });
            }
        }
        let state = |p: &Primitive| {
            let look = p.material.and_then(|m| model.materials.get(m));
            let blend = look.is_some_and(|l| l.alpha == AlphaMode::Blend);
            (blend, look.is_some_and(|l| l.double_sided), p.material.unwrap_or(model.materials.len()))
        };
        // Opaque before blended, then by state, so that neighbours merge into one draw.
        pieces.sort_by_key(|(p, ..)| state(p));
        let mut scene = Self { vertices: Vec::new(), indices: Vec::new(), parts: Vec::new(), opaque: 0, lights };
        for (primitive, frame, matrix) in pieces {
            let (blend, double_sided, material) = state(primitive);
            let start = scene.indices.len() as u32;
            let center = scene.append(primitive, frame as u32, matrix);
            let end = scene.indices.len() as u32;
            if !blend {
                scene.opaque = end;
            }
            match scene.parts.last_mut() {
                Some(last) if !blend && (last.material, last.double_sided) == (material, double_sided) => {
                    last.indices.end = end;
                }
                _ => scene.parts.push(Part { indices: start..end, material, double_sided, blend, center, frame }),
            }
        }
        Ok(scene)
    }

    /// Adds a primitive's triangles and returns their middle.
    fn append(&mut self, primitive: &Primitive, frame: u32, matrix: Mat4) -> Vec3 {
        let base = self.vertices.len() as u32;
        let linear = glam::Mat3::from_mat4(matrix);
        let mirrored = linear.determinant() < 0.0;
        // Cofactors: the normal's transform even where a scale is zero.
        let cofactor = glam::Mat3::from_cols(
            linear.y_axis.cross(linear.z_axis),
            linear.z_axis.cross(linear.x_axis),
            linear.x_axis.cross(linear.y_axis),
        ) * if mirrored { -1.0 } else { 1.0 };
        let mut center = Vec3::ZERO;
        for (i, &position) in primitive.positions.iter().enumerate() {
            let position = matrix.transform_point3(position.into());
            center += position;
            let normal = primitive.normals.get(i).map_or(Vec3::Y, |&n| Vec3::from_array(n));
            let tangent = primitive.tangents.get(i).map_or([0.0; 4], |t| {
                let along = (linear * Vec3::new(t[0], t[1], t[2])).normalize_or_zero();
                let hand = if mirrored { -t[3] } else { t[3] };
                [along.x, along.y, along.z, hand]
            });
            self.vertices.push(Vertex {
                position,
                normal: (cofactor * normal).normalize_or(Vec3::Y),
                tangent,
                uv: primitive.uvs.get(i).copied().unwrap_or_default(),
                color: primitive.colors.get(i).copied().unwrap_or([1.0; 4]),
                frame,
            });
        }
        let count = primitive.positions.len() as u32;
        for corners in primitive.indices.chunks_exact(3) {
            if corners.iter().all(|&c| c < count) {
                let [a, b, c] = [corners[0], corners[1], corners[2]].map(|c| base + c);
                self.indices.extend(if mirrored { [a, c, b] } else { [a, b, c] });
            }
        }
        center / count.max(1) as f32
    }
}

impl Punctual {
    /// The light where its frame is now.
    pub fn uniform(&self, world_from_frame: Mat4) -> PunctualUniform {
        let (kind, cone) = match self.kind {
            LightKind::Directional => (0.0, Vec4::ZERO),
            LightKind::Point => (1.0, Vec4::ZERO),
            LightKind::Spot(inner, outer) => (2.0, Vec4::new((inner as f32).cos(), (outer as f32).cos(), 0.0, 0.0)),
        };
        PunctualUniform {
            position: world_from_frame.transform_point3(self.position),
            kind,
            color: self.color,
            range: self.range,
            axis: world_from_frame.transform_vector3(self.axis),
            spare: 0.0,
            cone,
        }
    }
}

/// The rotation and translation of a node's world matrix, its scale left out.
fn rigid(world: DMat4) -> DMat4 {
    let (_, rotation, translation) = world.to_scale_rotation_translation();
    DMat4::from_rotation_translation(rotation, translation)
}

/// A pose as the three rows of its 3×4 matrix, as `mat3x4f` columns.
pub(super) fn rows(pose: &Pose) -> [Vec4; 3] {
    let m = pose.matrix().as_mat4();
    [m.row(0), m.row(1), m.row(2)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exhibit::model::{Mesh, Model, Node};

    #[test]
    fn a_mirrored_node_keeps_its_outside_out() {
        let triangle = Primitive {
            positions: vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
            normals: vec![[0.0, 0.0, 1.0]; 3],
            indices: vec![0, 1, 2],
            ..Default::default()
        };
        let world = DMat4::from_scale(crate::math::DVec3::new(-2.0, 1.0, 1.0));
        let node = Node {
            name: "mirror".into(),
            parent: None,
            children: Vec::new(),
            local: world,
            world,
            mesh: Some(0),
            camera: None,
            light: None,
        };
        let model = Model {
            nodes: vec![node],
            roots: vec![0],
            meshes: vec![Mesh { name: String::new(), primitives: vec![triangle] }],
            ..Default::default()
        };
        let scene = Scene::new(&crate::exhibit::Exhibit::of_model(model)).expect("few bodies");
        let corner = |i: usize| scene.vertices[scene.indices[i] as usize].position;
        let geometric = (corner(1) - corner(0)).cross(corner(2) - corner(0));
        assert!(geometric.z > 0.0 && scene.vertices[0].normal == Vec3::Z, "{geometric}");
    }
}

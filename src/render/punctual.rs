//! Punctual lights of a model (KHR_lights_punctual).

use bytemuck::{Pod, Zeroable};
use glam::{Mat4, Vec3, Vec4};

use soffio_exhibit::model::{Light, LightKind};

/// Most punctual lights of a model; further ones stay dark.
pub(super) const MAX_PUNCTUAL: usize = 8;

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

/// A punctual light in the layout of the shaders.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub(super) struct PunctualUniform {
    pub position: Vec3,
    pub kind: f32,
    pub color: Vec3,
    pub range: f32,
    pub axis: Vec3,
    pub spare: f32,
    pub cone: Vec4,
}

impl Punctual {
    /// A light of a node, in a body's frame.
    pub fn new(light: &Light, frame: usize, frame_from_node: Mat4) -> Self {
        let m = frame_from_node;
        Self {
            frame,
            position: m.w_axis.truncate(),
            axis: -m.z_axis.truncate().normalize_or(Vec3::Z),
            color: (light.color * light.intensity).as_vec3(),
            range: if light.range.is_finite() { light.range as f32 } else { 0.0 },
            kind: light.kind,
        }
    }

    /// The light at the present pose of its frame.
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

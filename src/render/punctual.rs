//! Punctual lights of a model (KHR_lights_punctual).

use bytemuck::{Pod, Zeroable};
use glam::{Mat4, Vec3, Vec4};

use soffio_exhibit::model::{Light, LightKind};

/// Most punctual lights of a model, the length of the array in `common.wgsl`; further ones stay dark.
pub(super) const MAX_PUNCTUAL: usize = 8;

/// A punctual light in the frame of its body.
#[derive(Clone, Copy, Debug)]
pub(super) struct Punctual {
    /// Index of the frame that carries it: 0 for static lights, else one above that of the body.
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
    /// Position, world, m.
    pub position: Vec3,
    /// Kind of the light: 0 directional, 1 point, 2 spot.
    pub kind: f32,
    /// Intensity, or irradiance of a directional light, linear RGB.
    pub color: Vec3,
    /// Distance at which the light has faded out, m; 0 where it has no end.
    pub range: f32,
    /// Direction of the light, world, unit.
    pub axis: Vec3,
    /// Fills the row; unused.
    pub spare: f32,
    /// Cosines of the half-angles at which a spotlight begins to fade and at which it ends; the rest is unused.
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

//! Layout of a vertex.

use bytemuck::{Pod, Zeroable};
use glam::Vec3;

/// A vertex, in the frame of its body.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(super) struct Vertex {
    /// Position, m.
    pub position: Vec3,
    /// Normal, unit.
    pub normal: Vec3,
    /// Unit tangent, and the sign of the bitangent.
    pub tangent: [f32; 4],
    /// Both sets of texture coordinates.
    pub uv: [f32; 4],
    /// Vertex colour, linear RGBA.
    pub color: [f32; 4],
    /// Index of the frame in the low 16 bits, then ambient visibility, then opacity to lamps, 8 bits each.
    pub tag: u32,
    /// Baked irradiance from other surfaces.
    pub bounce: Vec3,
    /// Visible fraction of the fill lamp, 0…1, baked.
    pub fill: f32,
    /// Index of the plate, where the batch is outlined.
    pub outline: u32,
}

impl Vertex {
    /// Index of the frame that carries it.
    pub fn frame(&self) -> usize {
        (self.tag & 0xffff) as usize
    }

    /// Sets the ambient visibility, 0…1.
    pub fn set_visibility(&mut self, visibility: f32) {
        let byte = (visibility.clamp(0.0, 1.0) * 255.0 + 0.5) as u32;
        self.tag = (self.tag & 0xff00_ffff) | (byte << 16);
    }
}

//! One corner of a scene.

use bytemuck::{Pod, Zeroable};
use glam::Vec3;

/// One corner, in the frame of its body.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(super) struct Vertex {
    pub position: Vec3,
    pub normal: Vec3,
    pub tangent: [f32; 4],
    /// Both sets of texture coordinates.
    pub uv: [f32; 4],
    pub color: [f32; 4],
    /// Frame in the low 16 bits, then ambient visibility, then opacity to lamps.
    pub tag: u32,
    /// Irradiance from other surfaces of a still scene.
    pub bounce: Vec3,
    /// Index of the plate, where the part is outlined.
    pub outline: u32,
}

impl Vertex {
    /// Index of the frame that carries it.
    pub fn frame(&self) -> usize {
        (self.tag & 0xffff) as usize
    }

    /// Sets what part of the sky it sees.
    pub fn set_visibility(&mut self, visibility: f32) {
        let byte = (visibility.clamp(0.0, 1.0) * 255.0 + 0.5) as u32;
        self.tag = (self.tag & 0xff00_ffff) | (byte << 16);
    }
}

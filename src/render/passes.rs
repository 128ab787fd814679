//! Plan of the render passes of a frame: attachments, reads and draw calls of each. The renderer creates its
//! attachments from it, and bandwidth can be counted without a device.
//!
//! Counted without compression or on-chip caches: an attachment is written whole with all its samples, and read whole
//! where it is loaded or resolved. A texture that a pass reads is fetched whole once.

use super::pipelines::{DEPTH_FORMAT, ORDER_FORMAT};
use super::shadows::{BLOCKER_FORMAT, MAP_FORMAT, PLANE_FORMAT};

/// A texture that a pass draws into or reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Attachment {
    /// Label for debuggers.
    pub label: &'static str,
    /// Size, pixels.
    pub size: (u32, u32),
    /// Samples per pixel.
    pub samples: u32,
    /// Texel format.
    pub format: wgpu::TextureFormat,
}

/// A render pass.
#[derive(Clone, Debug)]
pub struct Pass {
    /// Label for debuggers.
    pub label: &'static str,
    /// Attachments that it writes.
    pub writes: Vec<Attachment>,
    /// Textures that its shaders or the resolve read.
    pub reads: Vec<Attachment>,
    /// Draw calls.
    pub draws: u32,
}

/// Parameters of the plan.
#[derive(Clone, Copy, Debug)]
pub struct PassPlan {
    /// Size of the picture, pixels.
    pub size: (u32, u32),
    /// Size of the target, pixels, to which a smaller picture is upscaled.
    pub target: (u32, u32),
    /// Samples per pixel.
    pub samples: u32,
    /// Format of the picture.
    pub format: wgpu::TextureFormat,
    /// Texels of the shadows on the wall and on the floor; `None` without a gallery.
    pub planes: Option<[(u32, u32); 2]>,
    /// Draw calls on each of them.
    pub plane_draws: [u32; 2],
    /// Texels along each side of the square shadow map of the key light.
    pub map: u32,
    /// Draw calls of the meshes in the picture.
    pub mesh_draws: u32,
}

impl Attachment {
    /// Bytes of all its samples.
    pub fn bytes(&self) -> u64 {
        let texel = self.format.block_copy_size(None).unwrap_or(4);
        u64::from(self.size.0) * u64::from(self.size.1) * u64::from(self.samples) * u64::from(texel)
    }
}

impl Pass {
    /// Bytes read and written.
    pub fn bytes(&self) -> u64 {
        self.writes.iter().chain(&self.reads).map(Attachment::bytes).sum()
    }
}

impl PassPlan {
    /// Attachments of the shadow on a plane: fractions and order.
    pub fn plane(texels: (u32, u32)) -> [Attachment; 2] {
        let of = |label, format| Attachment { label, size: texels, samples: 1, format };
        [of("plane shadow", PLANE_FORMAT), of("plane order", ORDER_FORMAT)]
    }

    /// Attachments of a shadow map with so many texels along a side: depth target, and the same depths for reading.
    pub fn shadow_map(side: u32) -> [Attachment; 2] {
        let of = |label, format| Attachment { label, size: (side, side), samples: 1, format };
        [of("shadow map", MAP_FORMAT), of("blocker map", BLOCKER_FORMAT)]
    }

    /// Colour and depth of the picture.
    pub fn picture(&self) -> [Attachment; 2] {
        let of = |label, format| Attachment { label, size: self.size, samples: self.samples, format };
        [of("samples", self.format), of("depth", DEPTH_FORMAT)]
    }

    /// The picture before upscaling.
    pub fn scaled_target(&self) -> Attachment {
        Attachment { label: "scaled", size: self.size, samples: 1, format: self.format }
    }

    /// The passes of a frame in which something moved.
    pub fn passes(&self) -> Vec<Pass> {
        let mut passes = Vec::new();
        let mut shadows = Vec::new();
        for (texels, draws) in self.planes.into_iter().flatten().zip(self.plane_draws) {
            let writes = Self::plane(texels);
            shadows.push(writes[0]);
            passes.push(Pass { label: "plane shadow", writes: writes.into(), reads: Vec::new(), draws });
        }
        let map = Self::shadow_map(self.map);
        shadows.push(map[1]);
        passes.push(Pass { label: "shadow map", writes: map.into(), reads: Vec::new(), draws: 1 });
        // The gallery or the backdrop, the wires, the dust.
        let draws = self.mesh_draws + 3;
        let writes = self.picture();
        passes.push(Pass { label: "picture", writes: writes.into(), reads: shadows, draws });
        if self.samples > 1 {
            let target = Attachment { label: "target", samples: 1, ..writes[0] };
            passes.push(Pass { label: "resolve", writes: vec![target], reads: vec![writes[0]], draws: 1 });
        }
        if self.size != self.target {
            let scaled = self.scaled_target();
            let target = Attachment { label: "target", size: self.target, ..scaled };
            passes.push(Pass { label: "upscale", writes: vec![target], reads: vec![scaled], draws: 1 });
        }
        passes
    }
}

//! The list of passes of a frame: what each draws into, reads and how often, so that bandwidth and draws can be counted
//! without a device. The renderer makes its attachments from the same list.
//!
//! Counted raw, as if nothing were compressed or kept on the chip: an attachment is written whole with all its samples,
//! read whole where it is loaded or resolved, and a texture that a pass reads is fetched whole once.

use super::pipelines::{DEPTH_FORMAT, ORDER_FORMAT};
use super::shadows::{BLOCKER_FORMAT, MAP_FORMAT, PLANE_FORMAT};

/// A texture that a pass draws into or reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Attachment {
    /// For people and debuggers.
    pub label: &'static str,
    /// Pixels.
    pub size: (u32, u32),
    /// Of a pixel.
    pub samples: u32,
    /// Texel format.
    pub format: wgpu::TextureFormat,
}

/// One pass.
#[derive(Clone, Debug)]
pub struct Pass {
    /// For people and debuggers.
    pub label: &'static str,
    /// Drawn into.
    pub writes: Vec<Attachment>,
    /// Read by its shaders, or by the fixed function that resolves it.
    pub reads: Vec<Attachment>,
    /// Draw calls.
    pub draws: u32,
}

/// What decides the list.
#[derive(Clone, Copy, Debug)]
pub struct Plan {
    /// Pixels of the picture.
    pub size: (u32, u32),
    /// Pixels of the target, which it is stretched over where they are more.
    pub target: (u32, u32),
    /// Samples per pixel.
    pub samples: u32,
    /// Of the picture.
    pub format: wgpu::TextureFormat,
    /// Texels of the shadows on the wall and on the floor; none without a room.
    pub planes: Option<[(u32, u32); 2]>,
    /// Draw calls on each of them.
    pub plane_draws: [u32; 2],
    /// Texels along a side of the shadow map.
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
    /// Bytes moved.
    pub fn bytes(&self) -> u64 {
        self.writes.iter().chain(&self.reads).map(Attachment::bytes).sum()
    }
}

impl Plan {
    /// Shadow on a plane.
    pub fn plane(texels: (u32, u32)) -> [Attachment; 2] {
        let of = |label, format| Attachment { label, size: texels, samples: 1, format };
        [of("plane shadow", PLANE_FORMAT), of("plane order", ORDER_FORMAT)]
    }

    /// Shadow map of so many texels along a side: the order of what is drawn, and the same depths to be read.
    pub fn shadow_map(side: u32) -> [Attachment; 2] {
        let of = |label, format| Attachment { label, size: (side, side), samples: 1, format };
        [of("shadow map", MAP_FORMAT), of("blocker map", BLOCKER_FORMAT)]
    }

    /// Colour and depth of the picture.
    pub fn picture(&self) -> [Attachment; 2] {
        let of = |label, format| Attachment { label, size: self.size, samples: self.samples, format };
        [of("samples", self.format), of("depth", DEPTH_FORMAT)]
    }

    /// The picture before it is stretched.
    pub fn smaller(&self) -> Attachment {
        Attachment { label: "smaller", size: self.size, samples: 1, format: self.format }
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
        // The room or the backdrop, the wires, the motes.
        let draws = self.mesh_draws + 3;
        let writes = self.picture();
        passes.push(Pass { label: "picture", writes: writes.into(), reads: shadows, draws });
        if self.samples > 1 {
            let target = Attachment { label: "target", samples: 1, ..writes[0] };
            passes.push(Pass { label: "resolve", writes: vec![target], reads: vec![writes[0]], draws: 1 });
        }
        if self.size != self.target {
            let smaller = self.smaller();
            let target = Attachment { label: "target", size: self.target, ..smaller };
            passes.push(Pass { label: "stretch", writes: vec![target], reads: vec![smaller], draws: 1 });
        }
        passes
    }
}

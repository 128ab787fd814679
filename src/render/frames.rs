//! Body frames: their poses at rest, and their layout in the shaders.

use glam::{DMat4, Vec4};

use soffio_exhibit::Exhibit;
use soffio_math::Pose;

/// Number of frames in the uniform buffer: 48 KiB, below the 64 KiB of every adapter. The first is the world.
pub(super) const MAX_FRAMES: usize = 1024;
/// Pose of a body's frame at rest.
pub(super) fn rigid_of(exhibit: &Exhibit, body: usize) -> DMat4 {
    rigid(exhibit.model.nodes[exhibit.bodies[body].node].world)
}

/// Rotation and translation of a node's world matrix, without scale.
fn rigid(world: DMat4) -> DMat4 {
    let (_, rotation, translation) = world.to_scale_rotation_translation();
    DMat4::from_rotation_translation(rotation, translation)
}

/// A pose as the three rows of its 3×4 matrix, which the shaders read as the columns of a `mat3x4f`.
pub(super) fn rows(pose: &Pose) -> [Vec4; 3] {
    let m = pose.matrix().as_mat4();
    [m.row(0), m.row(1), m.row(2)]
}

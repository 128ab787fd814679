//! Frames of bodies: where they are at rest, and how the shaders read them.

use glam::{DMat4, Vec4};

use soffio_exhibit::Exhibit;
use soffio_math::Pose;

/// Frames the uniform buffer holds: 48 KiB, below the 64 every adapter has. The first is the world.
pub(super) const MAX_FRAMES: usize = 1024;
/// Where the frame of a body is at rest.
pub(super) fn rigid_of(exhibit: &Exhibit, body: usize) -> DMat4 {
    rigid(exhibit.model.nodes[exhibit.bodies[body].node].world)
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

//! Meshes that follow joints (glTF 2.0, 3.7.3), from picture to picture.
//!
//! A joint is carried by a body, or stands still. With F the pose of its body now, F₀ at rest, J₀ the joint's node at rest and I
//! its inverse bind matrix, a corner p₀ with shares w stands at
//!
//! ```text
//! p = A p₀,   A = Σ wⱼ Pⱼ,   Pⱼ = F_b⁻¹ Fⱼ Kⱼ,   Kⱼ = Fⱼ₀⁻¹ Jⱼ₀ Iⱼ
//! ```
//!
//! in the frame F_b of one of these bodies, so that the scene takes the mesh for one more of its parts; its normal is that of
//! the cofactors of A. All passes read the same vertices, which are written anew where something has moved: a few thousand
//! corners cost a fraction of a millisecond, and no shader knows of it. The memory is there before the first frame.

use glam::{Mat3, Mat4, Vec3, Vec4};

use super::scene::Vertex;
use crate::exhibit::Exhibit;
use crate::exhibit::model::{Influences, Primitive, Skin};
use crate::math::DMat4;

/// A joint: the frame that carries it, and K.
struct Joint {
    frame: usize,
    frame_from_bound: Mat4,
}

/// A corner as it is bound.
struct Corner {
    position: Vec3,
    normal: Vec3,
    tangent: Vec3,
    influences: Influences,
}

/// A primitive of a skinned mesh among the scene's vertices.
pub(super) struct Skinned {
    /// Its first vertex.
    pub first: u32,
    /// Its vertices as they stand.
    pub vertices: Vec<Vertex>,
    frame: usize,
    corners: Vec<Corner>,
    joints: Vec<Joint>,
    /// −1 where the node that shows it is mirrored.
    side: f32,
    palette: Vec<Mat4>,
}

impl Skinned {
    /// The primitive with this number of a skin, whose vertices begin at `first` in the frame of `body`. `carriers` are the
    /// bodies that carry the model's nodes.
    pub fn new(
        exhibit: &Exhibit,
        skin: &Skin,
        bound: &Primitive,
        (first, body, mirrored): (u32, usize, bool),
        carriers: &[Option<usize>],
    ) -> Self {
        let joints = skin.joints.iter().zip(&skin.inverse_bind).map(|(&node, inverse)| {
            let carrier = carriers[node];
            let rest = carrier.map_or(DMat4::IDENTITY, |b| super::scene::rigid_of(exhibit, b));
            let frame_from_bound = (rest.inverse() * exhibit.model.nodes[node].world * *inverse).as_mat4();
            Joint { frame: carrier.map_or(0, |body| body + 1), frame_from_bound }
        });
        let corner = |i: usize| Corner {
            position: bound.positions[i].into(),
            normal: bound.normals.get(i).map_or(Vec3::Y, |n| Vec3::from_array(*n)),
            tangent: bound.tangents.get(i).map_or(Vec3::ZERO, |t| Vec3::new(t[0], t[1], t[2])),
            influences: bound.influences.get(i).copied().unwrap_or_default(),
        };
        Self {
            first,
            vertices: Vec::new(),
            frame: body + 1,
            corners: (0..bound.positions.len()).map(corner).collect(),
            palette: Vec::with_capacity(skin.joints.len()),
            joints: joints.collect(),
            side: if mirrored { -1.0 } else { 1.0 },
        }
    }

    /// Takes the looks of its vertices from the scene's: all but where they stand.
    pub fn dress(&mut self, vertices: &[Vertex]) {
        let first = self.first as usize;
        self.vertices = vertices[first..first + self.corners.len()].to_vec();
    }

    /// Puts its vertices where the joints have them, with the rows of all frames.
    pub fn place(&mut self, frames: &[[Vec4; 3]]) {
        let pose =
            |frame: usize| Mat4::from_cols(frames[frame][0], frames[frame][1], frames[frame][2], Vec4::W).transpose();
        let home = pose(self.frame).inverse();
        self.palette.clear();
        self.palette.extend(self.joints.iter().map(|joint| home * pose(joint.frame) * joint.frame_from_bound));
        for (corner, vertex) in self.corners.iter().zip(&mut self.vertices) {
            let mut blended = Mat4::ZERO;
            for (joint, share) in corner.influences.iter().filter(|(_, share)| *share > 0.0) {
                blended += self.palette[usize::from(*joint)] * *share;
            }
            // What follows no joint stays where it is at rest.
            if blended == Mat4::ZERO {
                continue;
            }
            let linear = Mat3::from_mat4(blended);
            let (x, y, z) = (linear.x_axis, linear.y_axis, linear.z_axis);
            let cofactor = Mat3::from_cols(y.cross(z), z.cross(x), x.cross(y));
            vertex.position = blended.transform_point3(corner.position);
            vertex.normal = (cofactor * corner.normal * self.side).normalize_or(Vec3::Y);
            let along = (linear * corner.tangent).normalize_or_zero();
            vertex.tangent = [along.x, along.y, along.z, vertex.tangent[3]];
        }
    }
}

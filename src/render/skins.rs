//! Linear blend skinning (glTF 2.0, 3.7.3) and animated shapes (3.7.2.2), computed on the CPU in each frame.
//!
//! A joint is carried by a body or is fixed. With F the pose of its body now, F₀ at rest, J₀ the joint's node at rest
//! and I its inverse bind matrix, a vertex p₀ with weights w is at
//!
//! ```text
//! p = A p₀,   A = Σ wⱼ Pⱼ,   Pⱼ = F_b⁻¹ Fⱼ Kⱼ,   Kⱼ = Fⱼ₀⁻¹ Jⱼ₀ Iⱼ
//! ```
//!
//! in the frame F_b of one of these bodies, so that the mesh is one more batch of the scene. Normals use the cofactors
//! of A. Where key frames change scales, F₀ and J₀ are those of the time; a mesh without a skin whose node has an
//! animated scale follows that node alone. Where they change the weights of morph targets, p₀ is p + Σ ωₜ dₜ, and
//! likewise for normals and tangents. All passes read the same vertices, which are written again where something has
//! moved. A few thousand vertices cost a fraction of a millisecond. The memory is allocated before the first frame.

use glam::{Mat3, Mat4, Vec3, Vec4};

use super::frames::rigid_of;
use super::vertex::Vertex;
use soffio_exhibit::Exhibit;
use soffio_exhibit::animated_scale::AnimatedScale;
use soffio_exhibit::model::{Influences, MorphTarget, Primitive, Track};
use soffio_exhibit::shape_tracks::ShapeTrack;
use soffio_math::DMat4;

/// A mesh with the joints that it follows.
pub(super) struct BoundMesh<'a> {
    /// Joint nodes, and the inverse bind matrix of each.
    pub joints: Vec<(usize, DMat4)>,
    /// The undeformed primitives; without influences they follow the first joint.
    pub primitives: &'a [Primitive],
    /// Key frames of its morph weights.
    pub weights: Option<ShapeTrack>,
}

impl<'a> BoundMesh<'a> {
    /// The bound mesh of a node; `None` where its mesh is rigid in its body's frame.
    pub fn of(exhibit: &'a Exhibit, node: usize, carriers: &[Option<usize>]) -> Option<Self> {
        let model = &exhibit.model;
        let weights = exhibit
            .shapes
            .iter()
            .find(|track| track.channel.node == node && matches!(track.channel.track, Track::Weights(_)));
        let weights = weights.cloned();
        let grows = |node: usize| AnimatedScale::of(exhibit, node).is_animated();
        if let Some(skin) = model.skins.iter().find(|skin| skin.node == node) {
            let moves = |&joint: &usize| carriers[joint].is_some() || grows(joint);
            let joints = skin.joints.iter().copied().zip(skin.inverse_bind.iter().copied()).collect();
            return (weights.is_some() || skin.joints.iter().any(moves)).then(|| Self {
                joints,
                primitives: &skin.bound,
                weights,
            });
        }
        let morph = model.morphs.iter().find(|morph| morph.node == node);
        let stored = || model.nodes[node].mesh.and_then(|mesh| model.meshes.get(mesh)).map(|mesh| &mesh.primitives);
        let primitives = morph.map(|morph| &morph.primitives).or_else(stored)?;
        (morph.is_some() || grows(node)).then(|| Self { joints: vec![(node, DMat4::IDENTITY)], primitives, weights })
    }

    /// The body in whose frame the mesh is drawn: the first that carries one of its joints.
    pub fn leader(&self, carriers: &[Option<usize>]) -> Option<usize> {
        self.joints.iter().find_map(|&(joint, _)| carriers[joint])
    }
}

/// A joint: the index of its frame, and K.
struct Joint {
    frame: usize,
    frame_from_bound: Mat4,
    grows: Option<AnimatedScaleBinding>,
}

/// The parts of K where scales are animated.
struct AnimatedScaleBinding {
    own: AnimatedScale,
    carrier: Option<AnimatedScale>,
    /// F₀ without animated scales.
    rest: DMat4,
    inverse_bind: DMat4,
}

impl AnimatedScaleBinding {
    /// K at `t` seconds.
    fn frame_from_bound(&self, t: f64) -> Mat4 {
        let frame = self.carrier.as_ref().and_then(|carrier| carrier.frame(t)).unwrap_or(self.rest);
        (frame.inverse() * self.own.world(t) * self.inverse_bind).as_mat4()
    }
}

/// A vertex without morph targets.
struct Unmorphed {
    position: Vec3,
    normal: Vec3,
    tangent: Vec3,
}

/// Animated morph targets.
struct Morph {
    track: ShapeTrack,
    base: Vec<Unmorphed>,
    targets: Vec<MorphTarget>,
    weights: Vec<f64>,
    /// Are the normals those of the triangles?
    flat: bool,
}

impl Morph {
    fn new(track: ShapeTrack, corners: &[Corner], bound: &Primitive) -> Self {
        let base =
            |corner: &Corner| Unmorphed { position: corner.position, normal: corner.normal, tangent: corner.tangent };
        Self {
            track,
            base: corners.iter().map(base).collect(),
            weights: vec![0.0; bound.targets.len()],
            targets: bound.targets.clone(),
            flat: bound.flat,
        }
    }

    /// Morphs the vertices by the weights at `t` seconds.
    fn place(&mut self, corners: &mut [Corner], t: f64) {
        self.track.channel.sample_weights(self.track.time(t), &mut self.weights);
        for (corner, base) in corners.iter_mut().zip(&self.base) {
            (corner.position, corner.normal, corner.tangent) = (base.position, base.normal, base.tangent);
        }
        for (target, &weight) in self.targets.iter().zip(&self.weights).filter(|(_, weight)| **weight != 0.0) {
            let added = |difference: &[f32; 3]| Vec3::from_array(*difference) * weight as f32;
            corners.iter_mut().zip(&target.positions).for_each(|(corner, d)| corner.position += added(d));
            corners.iter_mut().zip(&target.normals).for_each(|(corner, d)| corner.normal += added(d));
            corners.iter_mut().zip(&target.tangents).for_each(|(corner, d)| corner.tangent += added(d));
        }
        if self.flat {
            for triangle in corners.chunks_exact_mut(3) {
                let [a, b, c] = [0, 1, 2].map(|i| triangle[i].position);
                let normal = (b - a).cross(c - a).normalize_or(Vec3::Y);
                triangle.iter_mut().for_each(|corner| corner.normal = normal);
            }
        } else {
            corners.iter_mut().for_each(|corner| corner.normal = corner.normal.normalize_or(Vec3::Y));
        }
    }
}

/// An undeformed vertex.
struct Corner {
    position: Vec3,
    normal: Vec3,
    tangent: Vec3,
    influences: Influences,
}

/// A skinned primitive among the scene's vertices.
pub(super) struct Skinned {
    /// Index of its first vertex.
    pub first: u32,
    /// Its deformed vertices.
    pub vertices: Vec<Vertex>,
    frame: usize,
    corners: Vec<Corner>,
    joints: Vec<Joint>,
    /// −1 where the node that shows it is mirrored, else 1.
    side: f32,
    palette: Vec<Mat4>,
    morph: Option<Morph>,
}

impl Skinned {
    /// Its vertices among the scene's.
    pub fn range(&self) -> std::ops::Range<u32> {
        self.first..self.first + self.corners.len() as u32
    }

    /// The primitive of this number, whose vertices begin at `first` in `frame`. `carriers` gives the body that carries
    /// each node.
    pub fn new(
        exhibit: &Exhibit,
        bound: &BoundMesh,
        number: usize,
        (first, frame, mirrored): (u32, usize, bool),
        carriers: &[Option<usize>],
    ) -> Self {
        let joints = bound.joints.iter().map(|&(node, inverse_bind)| {
            let carrier = carriers[node];
            let rest = carrier.map_or(DMat4::IDENTITY, |b| rigid_of(exhibit, b));
            let frame_from_bound = (rest.inverse() * exhibit.model.nodes[node].world * inverse_bind).as_mat4();
            let own = AnimatedScale::of(exhibit, node);
            let grows = own.is_animated().then(|| {
                let carrier = carrier.map(|body| AnimatedScale::of(exhibit, exhibit.bodies[body].node));
                AnimatedScaleBinding { own, carrier, rest, inverse_bind }
            });
            Joint { frame: carrier.map_or(0, |body| body + 1), frame_from_bound, grows }
        });
        let joints: Vec<Joint> = joints.collect();
        let weights = bound.weights.clone();
        let bound = &bound.primitives[number];
        let corner = |i: usize| Corner {
            position: bound.positions[i].into(),
            normal: bound.normals.get(i).map_or(Vec3::Y, |n| Vec3::from_array(*n)),
            tangent: bound.tangents.get(i).map_or(Vec3::ZERO, |t| Vec3::new(t[0], t[1], t[2])),
            influences: match bound.influences.get(i) {
                Some(influences) => *influences,
                None => [(0, 1.0), (0, 0.0), (0, 0.0), (0, 0.0)],
            },
        };
        let corners: Vec<Corner> = (0..bound.positions.len()).map(corner).collect();
        Self {
            first,
            vertices: Vec::new(),
            frame,
            morph: weights.map(|track| Morph::new(track, &corners, bound)),
            corners,
            palette: Vec::with_capacity(joints.len()),
            joints,
            side: if mirrored { -1.0 } else { 1.0 },
        }
    }

    /// Do key frames change its shape, so that it can move while no body does?
    pub fn is_keyed(&self) -> bool {
        self.morph.is_some() || self.joints.iter().any(|joint| joint.grows.is_some())
    }

    /// Copies everything except positions, normals and tangents from the scene's vertices.
    pub fn fill(&mut self, vertices: &[Vertex]) {
        let first = self.first as usize;
        self.vertices = vertices[first..first + self.corners.len()].to_vec();
    }

    /// Deforms its vertices for the poses of all frames and for the key frames at `t` seconds after the reset.
    pub fn place(&mut self, frames: &[[Vec4; 3]], t: f64) {
        if let Some(morph) = &mut self.morph {
            morph.place(&mut self.corners, t);
        }
        for joint in &mut self.joints {
            if let Some(grows) = &joint.grows {
                joint.frame_from_bound = grows.frame_from_bound(t);
            }
        }
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
            // Vertices without influences stay where they are at rest.
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

#[cfg(test)]
mod tests {
    use super::super::frames::rows;
    use super::super::scene::Scene;
    use super::*;
    use soffio_exhibit::model::{Animation, Channel, Curve, Mesh, Model, Morph as Morphing, Node};
    use soffio_math::{DQuat, DVec3, Pose};

    /// Single precision of numbers about one.
    const ROUNDING: f32 = 1e-6;

    fn node(parent: Option<usize>, mesh: Option<usize>) -> Node {
        let (local, world) = (DMat4::IDENTITY, DMat4::IDENTITY);
        Node { name: String::new(), parent, children: Vec::new(), local, world, mesh, camera: None, light: None }
    }

    /// A bent quadrilateral that morphs: its corner 2 rises, with a normal of its own unless `flat`.
    fn bent(flat: bool) -> Primitive {
        let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.5], [0.0, 1.0, 0.0]];
        let indices = [0, 1, 2, 0, 2, 3];
        let rise = |i: usize| if i == 2 { [0.0, 0.25, 1.0] } else { [0.0; 3] };
        let order: Vec<usize> = if flat { indices.into() } else { (0..4).collect() };
        Primitive {
            positions: order.iter().map(|&i| corners[i]).collect(),
            normals: vec![[0.0, 0.0, 1.0]; order.len()],
            indices: if flat { (0..6).collect() } else { indices.map(|i| i as u32).into() },
            targets: vec![MorphTarget {
                positions: order.iter().map(|&i| rise(i)).collect(),
                normals: if flat { Vec::new() } else { (0..4).map(|i| rise(i).map(|x| -x)).collect() },
                tangents: Vec::new(),
            }],
            flat,
            ..Primitive::default()
        }
    }

    /// Vertices of the primitive at `t`; its weight and its parent's scale grow from 0 and 1 to these values in one
    /// second.
    fn vertices(primitive: Primitive, weight: f64, scale: DVec3, t: f64) -> Vec<Vertex> {
        let channel = |node, track| Channel { node, curve: Curve::Linear, times: vec![0.0, 1.0], track };
        let model = Model {
            nodes: vec![Node { children: vec![1], ..node(None, None) }, node(Some(0), Some(0))],
            roots: vec![0],
            meshes: vec![Mesh { name: String::new(), primitives: vec![primitive.clone()] }],
            morphs: vec![Morphing { node: 1, primitives: vec![primitive] }],
            animations: vec![Animation {
                name: String::new(),
                channels: vec![
                    channel(1, Track::Weights(vec![vec![0.0], vec![weight]])),
                    channel(0, Track::Scale(vec![DVec3::ONE, scale], DQuat::IDENTITY, DVec3::ZERO)),
                ],
            }],
            ..Model::default()
        };
        let exhibit = Exhibit::from_model(model);
        let mut scene = Scene::new(&exhibit).expect("few bodies");
        let mut skin = scene.skins.pop().expect("what morphs");
        assert!(skin.is_keyed() && scene.skins.is_empty());
        skin.fill(&scene.vertices);
        skin.place(&[rows(&Pose::IDENTITY)], t);
        skin.vertices
    }

    #[test]
    fn a_morph_adds_positions_and_normals_by_its_weight_and_is_scaled_afterwards() {
        let scale = DVec3::new(2.0, 1.0, 3.0);
        let placed = vertices(bent(false), 0.8, scale, 0.5);
        // Half way: the weight is 0.4 and the scale (1.5, 1, 2).
        let position = Vec3::new(1.5, 1.0 + 0.4 * 0.25, 2.0 * (0.5 + 0.4));
        assert!(placed[2].position.distance(position) < ROUNDING, "{}", placed[2].position);
        assert!(placed[1].position.distance(Vec3::new(1.5, 0.0, 0.0)) < ROUNDING, "{}", placed[1].position);
        // Normals transform by the inverse of the scale.
        let normal = (Vec3::new(0.0, -0.4 * 0.25, 1.0 - 0.4).normalize() / Vec3::new(1.5, 1.0, 2.0)).normalize();
        assert!(placed[2].normal.distance(normal) < ROUNDING, "{} instead of {normal}", placed[2].normal);
        assert!(placed[0].normal.distance(Vec3::Z) < ROUNDING);
        // It repeats: 2.5 s shows the same as 0.5 s.
        let again = vertices(bent(false), 0.8, scale, 2.5);
        assert!(placed.iter().zip(&again).all(|(a, b)| a.position == b.position && a.normal == b.normal));
    }

    #[test]
    fn without_normals_of_its_own_a_morph_has_those_of_its_triangles() {
        let placed = vertices(bent(true), 1.0, DVec3::ONE, 0.5);
        for triangle in placed.chunks_exact(3) {
            let [a, b, c] = [0, 1, 2].map(|i| triangle[i].position);
            let normal = (b - a).cross(c - a).normalize();
            assert!(triangle.iter().all(|v| v.normal.distance(normal) < ROUNDING), "{}", triangle[0].normal);
        }
        assert!(placed[2].position.distance(Vec3::new(1.0, 1.125, 1.0)) < ROUNDING, "{}", placed[2].position);
    }
}

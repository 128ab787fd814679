//! Meshes that follow joints (glTF 2.0, 3.7.3) or key frames of their shape, from picture to picture.
//!
//! A joint is carried by a body, or stands still. With F the pose of its body now, F₀ at rest, J₀ the joint's node at rest and I
//! its inverse bind matrix, a corner p₀ with shares w stands at
//!
//! ```text
//! p = A p₀,   A = Σ wⱼ Pⱼ,   Pⱼ = F_b⁻¹ Fⱼ Kⱼ,   Kⱼ = Fⱼ₀⁻¹ Jⱼ₀ Iⱼ
//! ```
//!
//! in the frame F_b of one of these bodies, so that the scene takes the mesh for one more of its parts; its normal is that of
//! the cofactors of A. Where key frames change scales, F₀ and J₀ are those of the time; a mesh without a skin whose node grows
//! follows that node alone. Where they change the weights of morph targets, p₀ is p + Σ ωₜ dₜ (3.7.2.2), and so are normals and
//! tangents. All passes read the same vertices, which are written anew where something has moved: a few thousand
//! corners cost a fraction of a millisecond, and no shader knows of it. The memory is there before the first frame.

use glam::{Mat3, Mat4, Vec3, Vec4};

use super::frames::rigid_of;
use super::vertex::Vertex;
use soffio_exhibit::Exhibit;
use soffio_exhibit::growth::Growth;
use soffio_exhibit::model::{Influences, MorphTarget, Primitive, Track};
use soffio_exhibit::shapes::ShapeTrack;
use soffio_math::DMat4;

/// What a mesh follows.
pub(super) struct Bound<'a> {
    /// Nodes, and what takes the mesh to the frame of each.
    pub joints: Vec<(usize, DMat4)>,
    /// The primitives of the mesh as they are bound; without influences they follow the first joint.
    pub primitives: &'a [Primitive],
    /// What changes the weights of its morph targets.
    pub weights: Option<ShapeTrack>,
}

impl<'a> Bound<'a> {
    /// Of a node, where what it shows is not always the same in its body's frame.
    pub fn of(exhibit: &'a Exhibit, node: usize, carriers: &[Option<usize>]) -> Option<Self> {
        let model = &exhibit.model;
        let weights = exhibit
            .shapes
            .iter()
            .find(|track| track.channel.node == node && matches!(track.channel.track, Track::Weights(_)));
        let weights = weights.cloned();
        let grows = |node: usize| Growth::of(exhibit, node).grows();
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

/// A joint: the frame that carries it, and K.
struct Joint {
    frame: usize,
    frame_from_bound: Mat4,
    grows: Option<Grows>,
}

/// What K is made of where scales change.
struct Grows {
    own: Growth,
    carrier: Option<Growth>,
    /// F₀ without them.
    rest: DMat4,
    inverse_bind: DMat4,
}

impl Grows {
    /// K at `t` seconds.
    fn frame_from_bound(&self, t: f64) -> Mat4 {
        let frame = self.carrier.as_ref().and_then(|carrier| carrier.frame(t)).unwrap_or(self.rest);
        (frame.inverse() * self.own.world(t) * self.inverse_bind).as_mat4()
    }
}

/// A corner before any morph target is added.
struct Unmorphed {
    position: Vec3,
    normal: Vec3,
    tangent: Vec3,
}

/// What key frames add to the corners.
struct Morph {
    track: ShapeTrack,
    base: Vec<Unmorphed>,
    targets: Vec<MorphTarget>,
    weights: Vec<f64>,
    /// Normals are those of the triangles.
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

    /// Puts the corners where the weights at `t` seconds have them.
    fn place(&mut self, corners: &mut [Corner], t: f64) {
        self.track.channel.weigh(self.track.time(t), &mut self.weights);
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

/// A corner as it is bound.
struct Corner {
    position: Vec3,
    normal: Vec3,
    tangent: Vec3,
    influences: Influences,
}

/// A primitive of such a mesh among the scene's vertices.
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
    morph: Option<Morph>,
}

impl Skinned {
    /// The primitive of this number, whose vertices begin at `first` in `frame`. `carriers` are the bodies that carry the model's
    /// nodes.
    pub fn new(
        exhibit: &Exhibit,
        bound: &Bound,
        number: usize,
        (first, frame, mirrored): (u32, usize, bool),
        carriers: &[Option<usize>],
    ) -> Self {
        let joints = bound.joints.iter().map(|&(node, inverse_bind)| {
            let carrier = carriers[node];
            let rest = carrier.map_or(DMat4::IDENTITY, |b| rigid_of(exhibit, b));
            let frame_from_bound = (rest.inverse() * exhibit.model.nodes[node].world * inverse_bind).as_mat4();
            let own = Growth::of(exhibit, node);
            let grows = own.grows().then(|| {
                let carrier = carrier.map(|body| Growth::of(exhibit, exhibit.bodies[body].node));
                Grows { own, carrier, rest, inverse_bind }
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

    /// Do key frames change its shape, so that it may move while no body does?
    pub fn is_keyed(&self) -> bool {
        self.morph.is_some() || self.joints.iter().any(|joint| joint.grows.is_some())
    }

    /// Takes the looks of its vertices from the scene's: all but where they stand.
    pub fn dress(&mut self, vertices: &[Vertex]) {
        let first = self.first as usize;
        self.vertices = vertices[first..first + self.corners.len()].to_vec();
    }

    /// Puts its vertices where the joints have them, with the rows of all frames, and key frames, `t` seconds after the reset.
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

    /// A bent quadrilateral that morphs: its corner 2 rises, with a normal of its own where there are any.
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

    /// Vertices at `t` of the primitive, whose weight and whose parent's scale go from nothing and from one to these in a second.
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
        let exhibit = Exhibit::of_model(model);
        let mut scene = Scene::new(&exhibit).expect("few bodies");
        let mut skin = scene.skins.pop().expect("what morphs");
        assert!(skin.is_keyed() && scene.skins.is_empty());
        skin.dress(&scene.vertices);
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
        // A normal goes by the inverse of the scale.
        let normal = (Vec3::new(0.0, -0.4 * 0.25, 1.0 - 0.4).normalize() / Vec3::new(1.5, 1.0, 2.0)).normalize();
        assert!(placed[2].normal.distance(normal) < ROUNDING, "{} instead of {normal}", placed[2].normal);
        assert!(placed[0].normal.distance(Vec3::Z) < ROUNDING);
        // Over and over: 2.5 s shows what 0.5 s does.
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

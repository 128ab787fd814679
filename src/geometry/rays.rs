//! Rays against moving rigid meshes: is anything in the way?
//!
//! Two levels. Each part has a hierarchy of its triangles' boxes (`boxes.rs`), built once in its own frame: a rigid part
//! never deforms it. Over the parts stands a second hierarchy of their boxes in the world, refitted whenever they have
//! moved. Lines that are asked about together go through the upper one in the world as one beam, and each is carried into
//! the frames of the few parts whose boxes it meets, instead of carrying triangles into the world.
//!
//! A caller keeps a [`Hint`] of the triangle that blocked a line. It is tested first the next time; as a rule it still blocks, and
//! the hierarchies are not searched.
//!
//! Triangles and boxes are single precision; boxes are rounded outwards. A shadow's edge is off by less than a micrometre
//! a metre from the origin.

use std::cell::Cell;

use glam::Vec3A;

use super::TriangleMesh;
use super::boxes::{Aabb, Beam, Boxes, places};
use soffio_math::{DMat3, DVec3, Pose};

/// Lines that go through the upper hierarchy together, at most: more make the beam wide, fewer share less of it.
const TOGETHER: usize = 16;

/// Rigid parts that may stand in a ray's way.
#[derive(Clone)]
pub struct Occluders {
    parts: Vec<Part>,
    /// Of the parts, in the world.
    boxes: Boxes,
}

/// The triangle that blocked a ray last; it usually blocks the next one too.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Hint(Option<(u32, u32)>);

impl Hint {
    /// Does nothing stand in the way?
    #[inline(always)]
    pub fn is_open(&self) -> bool {
        self.0.is_none()
    }
}

/// A line of sight.
#[derive(Clone, Copy, Debug)]
pub struct SightLine {
    /// Start of the ray, world, m.
    pub origin: DVec3,
    /// Direction of the ray, world, unit.
    pub direction: DVec3,
    /// Length, m.
    pub far: f64,
    /// A body of which it is known that it is not in the way.
    pub past: Option<usize>,
    /// The triangle that blocks the ray, or did the last time.
    pub hint: Hint,
}

/// A triangle of a part, in the part's frame.
#[derive(Clone, Copy)]
struct Triangle([Vec3A; 3]);

/// One rigid part.
#[derive(Clone)]
struct Part {
    /// The body that carries it; `None` stands still.
    body: Option<usize>,
    triangles: Vec<Triangle>,
    /// Of the triangles, in its own frame.
    boxes: Boxes,
    /// Its box in its own frame: centre and half extents, m.
    center: DVec3,
    half: DVec3,
    /// Part axes to world axes and back, and the frame's origin, m.
    axes: DMat3,
    inverse: DMat3,
    origin: DVec3,
}

#[inline]
fn single(v: DVec3) -> Vec3A {
    v.as_vec3a()
}

impl Triangle {
    /// Distance at which a ray (unit direction) meets it, at most `far`; infinite where it does not (T. Möller and
    /// B. Trumbore, Fast, Minimum Storage Ray/Triangle Intersection, 1997).
    #[inline(always)]
    fn meets(&self, origin: Vec3A, direction: Vec3A, far: f32) -> f32 {
        let [a, b, c] = self.0;
        let (e1, e2) = (a - b, c - a);
        let n = e1.cross(e2);
        let to = a - origin;
        let r = direction.cross(to);
        let inverse = 1.0 / n.dot(direction);
        let u = r.dot(e2) * inverse;
        let v = r.dot(e1) * inverse;
        let w = 1.0 - u - v;
        let inside = (u.to_bits() | v.to_bits() | w.to_bits()) & 0x8000_0000 == 0;
        if inside && inverse != 0.0 {
            let t = n.dot(to) * inverse;
            if t >= 0.0 && t <= far {
                return t;
            }
        }
        f32::INFINITY
    }
}

impl Part {
    fn new(body: Option<usize>, mesh: &TriangleMesh) -> Option<Self> {
        let (low, high) = mesh.bounds().filter(|_| !mesh.triangles.is_empty())?;
        let triangles: Vec<Triangle> = mesh.corners().map(|corners| Triangle(corners.map(single))).collect();
        let aabb = |Triangle([a, b, c]): &Triangle| Aabb { low: a.min(*b).min(*c), high: a.max(*b).max(*c) };
        Some(Self {
            body,
            boxes: Boxes::new(triangles.iter().map(aabb).collect()),
            triangles,
            center: 0.5 * (low + high),
            half: 0.5 * (high - low),
            axes: DMat3::IDENTITY,
            inverse: DMat3::IDENTITY,
            origin: DVec3::ZERO,
        })
    }

    /// The box in the world, rounded outwards.
    #[inline]
    fn aabb(&self) -> Aabb {
        let center = single(self.axes * self.center + self.origin);
        let absolute = DMat3::from_cols(self.axes.x_axis.abs(), self.axes.y_axis.abs(), self.axes.z_axis.abs());
        Aabb::around(center, single(absolute * self.half))
    }

    /// Origin and direction of a world ray in the part's frame.
    #[inline(always)]
    fn local(&self, origin: DVec3, direction: DVec3) -> (Vec3A, Vec3A) {
        (single(self.inverse * (origin - self.origin)), single(self.inverse * direction))
    }

    /// Does one of its triangles stand nearer than `far` on a world ray?
    #[inline(always)]
    fn triangle_blocks(&self, triangle: usize, origin: DVec3, direction: DVec3, far: f32) -> bool {
        let (origin, direction) = self.local(origin, direction);
        self.triangles.get(triangle).is_some_and(|triangle| triangle.meets(origin, direction, far) < far)
    }

    /// Some triangle nearer than `far` on a world ray.
    #[inline]
    fn blocker(&self, origin: DVec3, direction: DVec3, far: f32) -> Option<u32> {
        let (origin, direction) = self.local(origin, direction);
        let mut found = None;
        self.boxes.meet(&Beam::new(origin, far * direction, Vec3A::ZERO), |node, met| {
            let mut indices = places(met).map(|place| node.index(place));
            found = indices.find(|&index| self.triangles[index].meets(origin, direction, far) < far);
            if found.is_some() { -1.0 } else { 1.0 }
        });
        found.map(|index| index as u32)
    }
}

impl Occluders {
    /// Meshes in the frames of the bodies that carry them (`None`: the world's), m. Meshes without triangles are left
    /// out.
    pub fn new<'a>(meshes: impl IntoIterator<Item = (Option<usize>, &'a TriangleMesh)>) -> Self {
        let parts: Vec<Part> = meshes.into_iter().filter_map(|(body, mesh)| Part::new(body, mesh)).collect();
        Self { boxes: Boxes::new(parts.iter().map(Part::aabb).collect()), parts }
    }

    /// Updates the meshes for new poses: `pose` gives the present pose of the body with an index. Meshes of the world stay.
    pub fn refit(&mut self, pose: impl Fn(usize) -> Pose) {
        self.boxes.refit(self.parts.iter_mut().enumerate().filter_map(|(index, part)| {
            let Pose { rotation, position } = pose(part.body?);
            (part.axes, part.origin) = (DMat3::from_quat(rotation), position);
            part.inverse = part.axes.transpose();
            Some((index, part.aabb()))
        }));
    }

    /// Lowest and highest coordinate, along a direction (unit, the body's frame), of the triangles that a body carries, m
    /// from its frame's origin. Without triangles: +∞ and −∞.
    pub fn extent(&self, body: usize, along: DVec3) -> (f64, f64) {
        let parts = self.parts.iter().filter(|part| part.body == Some(body));
        let corners = parts.flat_map(|part| &part.triangles).flat_map(|Triangle(corners)| corners);
        let ways = corners.map(|corner| corner.as_dvec3().dot(along));
        ways.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), way| (low.min(way), high.max(way)))
    }

    /// Finds a triangle that blocks each line, if any does. The one that its hint names is asked first. Lines that lie side
    /// by side and follow each other cost least.
    pub fn look(&self, lines: &mut [SightLine]) {
        for lines in lines.chunks_mut(TOGETHER) {
            self.look_together(lines);
        }
    }

    fn look_together(&self, lines: &mut [SightLine]) {
        let mut beams = [Beam::default(); TOGETHER];
        // What has not been found to be blocked, as bits.
        let mut open = 0_u32;
        let none = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        let (mut starts, mut ends) = (none, none);
        for (bit, line) in lines.iter_mut().enumerate() {
            if self.still_blocks(line) {
                continue;
            }
            line.hint = Hint(None);
            open |= 1 << bit;
            let way = line.far * line.direction;
            let end = line.origin + way;
            starts = (starts.0.min(line.origin), starts.1.max(line.origin));
            ends = (ends.0.min(end), ends.1.max(end));
            beams[bit] = Beam::new(single(line.origin), single(way), Vec3A::ZERO);
        }
        if open == 0 {
            return;
        }
        let [start, end] = [starts, ends].map(|(low, high)| 0.5 * (low + high));
        let half = (0.5 * (starts.1 - starts.0)).max(0.5 * (ends.1 - ends.0));
        self.boxes.meet(&Beam::new(single(start), single(end - start), single(half)), |node, met| {
            let mut rest = open;
            while rest != 0 {
                let bit = rest.trailing_zeros() as usize;
                rest &= rest - 1;
                let line = &mut lines[bit];
                for place in places(met & node.met(&beams[bit], 1.0)) {
                    let index = node.index(place);
                    let part = &self.parts[index];
                    if line.past.is_some() && part.body == line.past {
                        continue;
                    }
                    let blocker = part.blocker(line.origin, line.direction, line.far as f32);
                    if let Some(triangle) = blocker {
                        line.hint = Hint(Some((index as u32, triangle)));
                        open &= !(1 << bit);
                        break;
                    }
                }
            }
            if open == 0 { -1.0 } else { 1.0 }
        });
    }

    /// Does what the hint names block the line?
    #[inline]
    fn still_blocks(&self, line: &SightLine) -> bool {
        line.hint.0.is_some_and(|(part, triangle)| {
            let part = self.parts.get(part as usize);
            part.is_some_and(|part| {
                part.triangle_blocks(triangle as usize, line.origin, line.direction, line.far as f32)
            })
        })
    }

    /// Is there a triangle between `origin` and the point `far` metres away along `direction` (unit, world)? The one
    /// that `hint` names is asked first, and the hint is set to the one that was found.
    pub fn block(&self, origin: DVec3, direction: DVec3, far: f64, hint: &Cell<Hint>) -> bool {
        let mut line = [SightLine { origin, direction, far, past: None, hint: hint.get() }];
        self.look(&mut line);
        hint.set(line[0].hint);
        !line[0].hint.is_open()
    }

    /// The first triangle along a world ray (unit direction): the body that carries it (`None` stands still) and its
    /// distance, m.
    pub fn first(&self, origin: DVec3, direction: DVec3) -> Option<(Option<usize>, f64)> {
        // Nothing is farther off than the farthest corner of all.
        let from = single(origin);
        let around = self.boxes.around();
        let ray_length = (around.low - from).abs().max((around.high - from).abs()).length();
        let mut first: (Option<usize>, f32) = (None, f32::INFINITY);
        self.boxes.meet(&Beam::new(from, ray_length * single(direction), Vec3A::ZERO), |node, met| {
            for part in places(met).map(|place| &self.parts[node.index(place)]) {
                let (origin, direction) = part.local(origin, direction);
                part.boxes.meet(&Beam::new(origin, ray_length * direction, Vec3A::ZERO), |node, met| {
                    for triangle in places(met).map(|place| &part.triangles[node.index(place)]) {
                        let t = triangle.meets(origin, direction, f32::INFINITY);
                        if t < first.1 {
                            first = (part.body, t);
                        }
                    }
                    (first.1 / ray_length).min(1.0)
                });
            }
            (first.1 / ray_length).min(1.0)
        });
        first.1.is_finite().then(|| (first.0, f64::from(first.1)))
    }

    /// The same by asking every triangle: what the hierarchies are measured against.
    pub fn first_by_each(&self, origin: DVec3, direction: DVec3) -> Option<(Option<usize>, f64)> {
        let each = self.parts.iter().flat_map(|part| {
            let (origin, direction) = part.local(origin, direction);
            let met = move |triangle: &Triangle| triangle.meets(origin, direction, f32::INFINITY);
            part.triangles.iter().map(move |triangle| (part.body, met(triangle)))
        });
        let nearest = each.min_by(|a, b| a.1.total_cmp(&b.1)).filter(|(_, t)| t.is_finite());
        nearest.map(|(body, t)| (body, f64::from(t)))
    }

    /// [`Self::block`] by asking every triangle.
    pub fn block_by_each(&self, origin: DVec3, direction: DVec3, far: f64) -> bool {
        self.parts.iter().any(|part| {
            let (far, count) = (far as f32, part.triangles.len());
            (0..count).any(|triangle| part.triangle_blocks(triangle, origin, direction, far))
        })
    }

    /// Triangles of all parts.
    pub fn triangles(&self) -> usize {
        self.parts.iter().map(|part| part.triangles.len()).sum()
    }
}

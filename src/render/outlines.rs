//! Analytic antialiasing of plates: silhouettes whose partly covered pixels are measured instead of sampled.
//!
//! Four samples a pixel know five degrees of coverage: the edge of a slowly rotating sheet would move in jerks, and a
//! sheet seen edge-on, thinner than a pixel, would flicker. So each frame finds the silhouette of every plate in
//! pixels: the edges between a triangle that faces the camera and one that does not. The covered area of a pixel is a
//! sum over these edges in closed form (`outline.wgsl`). Partly covered pixels are left out of the mesh and drawn by
//! *ribbons* along the edges, blended by that area over the background. Plates of any thickness and slant so have exact
//! coverage.
//!
//! A plate is a closed, thin, opaque mesh that moves; its caps make up most of its surface. Static meshes may consist
//! of boards that touch, where two partly covered pixels would let light through.

use std::collections::BTreeMap;

use bytemuck::{Pod, Zeroable};
use glam::{Mat4, Vec2, Vec3, Vec4};

use super::globals::Globals;
use super::vertex::Vertex;

/// Texels along a row of the texture with the silhouettes: a whole number of 256-byte rows, which copies to textures
/// need.
pub(super) const CONTOUR_ROW: u32 = 256;
/// Most edges of an outlined plate's mesh; each of its pixels tests all edges of its silhouette.
const MAX_EDGES: usize = 900;
/// Smallest cosine between a plate's normal and those of its caps: 8°, so that slightly bent sheet counts.
const CAP_COSINE: f32 = 0.99;
/// Smallest fraction of a plate's surface that its caps make up: a square plate is then thinner than a sixth of its
/// side.
const CAP_SHARE: f32 = 0.75;

/// A plate's mesh with merged vertices, in the frame of its body.
pub(super) struct Plate {
    /// Index of the batch that draws it.
    pub batch: usize,
    /// Index of the frame that carries it: 0 for static plates, else one above that of the body.
    pub frame: usize,
    /// Merged vertices, m.
    pub corners: Vec<Vec3>,
    /// Index of a scene vertex at each corner.
    vertices: Vec<u32>,
    faces: Vec<[u16; 3]>,
    /// Unit normal of each face.
    pub normals: Vec<Vec3>,
    /// All edges, each between two faces.
    pub edges: Vec<Edge>,
    /// Normal of its caps, unit.
    pub normal: Vec3,
    /// Thickness, m.
    thickness: f32,
    /// Mean width of its caps, m: twice their area over their perimeter.
    width: f32,
}

/// An edge from corner `a` to `b` in the direction of the first of its faces.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Edge {
    /// Corner at which the edge begins.
    pub a: u16,
    /// Corner at which the edge ends.
    pub b: u16,
    /// Indices of the two faces that meet in it.
    pub faces: [u16; 2],
}

/// One edge of a silhouette with the plate's appearance there, in the layout of `forward.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(super) struct Ribbon {
    /// Ends, world, m.
    a: Vec3,
    b: Vec3,
    /// Normal, world, unit: the mean over the cap and the rim that a pixel shows.
    normal: Vec3,
    uv_a: [f32; 4],
    uv_b: [f32; 4],
    color: [f32; 4],
    /// Tag of the scene's vertices.
    tag: u32,
    /// Index of the plate in the low half, of the edge in its silhouette in the high half.
    outline: u32,
    /// Irradiance from other surfaces.
    bounce: Vec3,
    /// Visible fraction of the fill lamp.
    fill: f32,
}

/// The silhouettes of a frame.
pub(super) struct Outlines {
    plates: Vec<Plate>,
    /// Appearance of each plate at its corners.
    appearances: Vec<Vec<Vertex>>,
    /// Per plate a texel (first edge, number of edges, 0, 0), then the edges: both ends, pixels from the upper left.
    pub contours: Vec<Vec4>,
    /// Edges of all silhouettes.
    pub ribbons: Vec<Ribbon>,
    /// Batch and ribbons of each draw.
    pub draws: Vec<(usize, std::ops::Range<u32>)>,
    // Scratch.
    places: Vec<(Vec3, Vec2)>,
    facing: Vec<bool>,
    order: Vec<(usize, f32, usize)>,
}

impl Plate {
    /// The plate that these triangles form, or `None`. The vertices are those of one primitive, in the frame of its
    /// body.
    pub fn of(vertices: &[Vertex], indices: &[u32]) -> Option<Self> {
        let frame = vertices.first()?.frame();
        // Corners are counted with 16 bits.
        if frame == 0 || indices.len() > usize::from(u16::MAX) {
            return None;
        }
        let mut known = BTreeMap::new();
        let (mut corners, mut sources) = (Vec::new(), Vec::new());
        let mut corner = |index: u32| {
            let vertex = vertices.get(index as usize)?;
            let key = (vertex.position + Vec3::ZERO).to_array().map(f32::to_bits);
            Some(*known.entry(key).or_insert_with(|| {
                corners.push(vertex.position);
                sources.push(index);
                corners.len() as u16 - 1
            }))
        };
        let mut faces = Vec::new();
        for t in indices.chunks_exact(3) {
            let face = [corner(t[0])?, corner(t[1])?, corner(t[2])?];
            if face[0] != face[1] && face[1] != face[2] && face[2] != face[0] {
                faces.push(face);
            }
        }
        let crosses: Vec<Vec3> = faces
            .iter()
            .map(|f| f.map(|i| corners[usize::from(i)]))
            .map(|[a, b, c]| 0.5 * (b - a).cross(c - a))
            .collect();
        let normals: Vec<Vec3> = crosses.iter().map(|n| n.normalize_or_zero()).collect();
        let edges = edges(&faces)?;
        // The largest face lies in a cap.
        let largest = (0..faces.len()).max_by(|&i, &j| crosses[i].length().total_cmp(&crosses[j].length()))?;
        let normal = normals[largest];
        let total: f32 = crosses.iter().map(|n| n.length()).sum();
        let is_cap = |i: usize| normals[i].dot(normal).abs() > CAP_COSINE;
        let caps: f32 = (0..faces.len()).filter(|&i| is_cap(i)).map(|i| crosses[i].length()).sum();
        if total <= 0.0 || caps < CAP_SHARE * total {
            return None;
        }
        let heights = corners.iter().map(|c| c.dot(normal));
        let (low, high) = heights.fold((f32::INFINITY, f32::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
        let bounds = edges.iter().filter(|e| is_cap(e.faces[0].into()) != is_cap(e.faces[1].into()));
        let around: f32 = bounds.map(|e| corners[usize::from(e.a)].distance(corners[usize::from(e.b)])).sum();
        let width = 2.0 * caps / around.max(f32::MIN_POSITIVE);
        let vertices = sources;
        let thickness = high - low;
        Some(Self { batch: 0, frame, corners, vertices, faces, normals, edges, normal, thickness, width })
    }

    /// Are its edges few enough for each of its pixels to test them?
    pub fn is_simple(&self) -> bool {
        self.edges.len() <= MAX_EDGES
    }

    /// Sets its place in a scene: the batch that draws it, and its first vertex.
    pub fn place(&mut self, batch: usize, base: u32) {
        self.batch = batch;
        self.vertices.iter_mut().for_each(|index| *index += base);
    }
}

/// The edges of a closed mesh, each once; `None` where it is not closed or not a manifold.
fn edges(faces: &[[u16; 3]]) -> Option<Vec<Edge>> {
    let mut open: BTreeMap<(u16, u16), u16> = BTreeMap::new();
    let mut edges = Vec::new();
    for (index, face) in (0..).zip(faces) {
        for k in 0..3 {
            let (a, b) = (face[k], face[(k + 1) % 3]);
            match open.remove(&(b, a)) {
                Some(other) => edges.push(Edge { a: b, b: a, faces: [other, index] }),
                None => {
                    if open.insert((a, b), index).is_some() {
                        return None;
                    }
                }
            }
        }
    }
    open.is_empty().then_some(edges)
}

impl Outlines {
    /// Silhouettes for these plates of a scene, still empty.
    pub fn new(plates: Vec<Plate>, vertices: &[Vertex]) -> Self {
        let appearance = |plate: &Plate| plate.vertices.iter().map(|&index| vertices[index as usize]).collect();
        let edges: usize = plates.iter().map(|plate| plate.edges.len()).sum();
        let max_ribbons = |count: fn(&Plate) -> usize| plates.iter().map(count).max().unwrap_or(0);
        let texels = (plates.len() + edges).max(1).next_multiple_of(CONTOUR_ROW as usize);
        Self {
            contours: vec![Vec4::ZERO; texels],
            ribbons: Vec::with_capacity(edges),
            draws: Vec::with_capacity(plates.len()),
            places: Vec::with_capacity(max_ribbons(|plate| plate.corners.len())),
            facing: Vec::with_capacity(max_ribbons(|plate| plate.faces.len())),
            order: Vec::with_capacity(plates.len()),
            appearances: plates.iter().map(appearance).collect(),
            plates,
        }
    }

    /// Rows of the texture with the contours.
    pub fn rows(&self) -> u32 {
        self.contours.len() as u32 / CONTOUR_ROW
    }

    /// Largest number of ribbons.
    pub fn max_ribbons(&self) -> usize {
        self.ribbons.capacity()
    }

    /// Largest number of draw calls.
    pub fn max_draws(&self) -> u32 {
        let mut batches: Vec<usize> = self.plates.iter().map(|plate| plate.batch).collect();
        batches.dedup();
        batches.len() as u32
    }

    /// Finds the silhouettes that a frame's camera sees, in a picture of `size` pixels.
    pub fn update(&mut self, frames: &[[Vec4; 3]], globals: &Globals, size: (u32, u32)) {
        self.ribbons.clear();
        self.draws.clear();
        self.order.clear();
        for (index, plate) in self.plates.iter().enumerate() {
            let middle = plate.corners.first().map_or(Vec3::ZERO, |&corner| to_world(&frames[plate.frame], corner));
            self.order.push((plate.batch, -middle.distance_squared(globals.eye), index));
        }
        // By batch, the farthest plate first.
        self.order.sort_unstable_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)).then(a.2.cmp(&b.2)));
        let mut next = self.plates.len();
        for k in 0..self.order.len() {
            let (batch, _, index) = self.order[k];
            let first = self.ribbons.len() as u32;
            let count = self.outline(index, next, frames, globals, size);
            self.contours[index] = Vec4::new(next as f32, count as f32, 0.0, 0.0);
            next += count;
            let last = self.ribbons.len() as u32;
            match self.draws.last_mut() {
                Some((before, range)) if *before == batch => range.end = last,
                _ => self.draws.push((batch, first..last)),
            }
        }
    }

    /// Finds one silhouette, whose texels begin at `first`, and returns its number of edges. It is 0 where the plate
    /// reaches behind the camera: its mesh is drawn like any other then.
    fn outline(
        &mut self,
        index: usize,
        first: usize,
        frames: &[[Vec4; 3]],
        globals: &Globals,
        size: (u32, u32),
    ) -> usize {
        let plate = &self.plates[index];
        let frame = &frames[plate.frame];
        let size = Vec2::new(size.0 as f32, size.1 as f32);
        self.places.clear();
        for &corner in &plate.corners {
            let world = to_world(frame, corner);
            let Some(pixel) = pixel_of(&globals.clip_from_world, world, size) else { return 0 };
            self.places.push((world, pixel));
        }
        self.facing.clear();
        for face in &plate.faces {
            let [a, b, c] = face.map(|i| self.places[usize::from(i)].1);
            // Anticlockwise as seen, in a picture whose second axis points down.
            self.facing.push((b - a).perp_dot(c - a) < 0.0);
        }
        let cap = turned(frame, plate.normal);
        let mut count = 0;
        for edge in &plate.edges {
            let [f, g] = edge.faces.map(usize::from);
            if self.facing[f] == self.facing[g] {
                continue;
            }
            // Along the face that is seen, so that the plate lies on one side of all.
            let (a, b, seen) = if self.facing[f] { (edge.a, edge.b, f) } else { (edge.b, edge.a, g) };
            let (a, b) = (usize::from(a), usize::from(b));
            let ((from, p), (to, q)) = (self.places[a], self.places[b]);
            self.contours[first + count] = Vec4::new(p.x, p.y, q.x, q.y);
            let [appearance, other] = [a, b].map(|corner| &self.appearances[index][corner]);
            self.ribbons.push(Ribbon {
                a: from,
                b: to,
                normal: plate.mean_normal(globals, 0.5 * (from + to), cap, turned(frame, plate.normals[seen])),
                uv_a: appearance.uv,
                uv_b: other.uv,
                color: appearance.color,
                tag: appearance.tag,
                outline: index as u32 | (count as u32) << 16,
                bounce: appearance.bounce,
                fill: appearance.fill,
            });
            count += 1;
        }
        count
    }
}

impl Plate {
    /// Mean normal of the plate's cap and rim that a pixel at `place` on the silhouette shows. `seen` is the normal of
    /// the face that ends there; the other one fills the rest of the pixel.
    fn mean_normal(&self, globals: &Globals, place: Vec3, cap: Vec3, seen: Vec3) -> Vec3 {
        let view = globals.eye - place;
        let distance = view.length().max(f32::MIN_POSITIVE);
        let view = view / distance;
        let pixel = globals.pixel_angle * distance;
        let cosine = cap.dot(view);
        let cap = if cosine < 0.0 { -cap } else { cap };
        let across = (view - cap * cosine.abs()).length();
        let (cap_width, rim_width) = (self.width * cosine.abs() / pixel, self.thickness * across / pixel);
        let rim_side = seen.dot(cap).abs() < CAP_COSINE;
        let rim = if rim_side { seen } else { (view - cap * cosine.abs()) / across.max(1e-6) };
        let (cap_share, rim_share) = if rim_side {
            let rim_share = rim_width.min(1.0);
            (cap_width.min(1.0 - rim_share), rim_share)
        } else {
            let cap_share = cap_width.min(1.0);
            (cap_share, rim_width.min(1.0 - cap_share))
        };
        (cap * cap_share + rim * rim_share).normalize_or(cap)
    }
}

fn to_world(frame: &[Vec4; 3], point: Vec3) -> Vec3 {
    let point = point.extend(1.0);
    Vec3::new(frame[0].dot(point), frame[1].dot(point), frame[2].dot(point))
}

fn turned(frame: &[Vec4; 3], direction: Vec3) -> Vec3 {
    let direction = direction.extend(0.0);
    Vec3::new(frame[0].dot(direction), frame[1].dot(direction), frame[2].dot(direction))
}

/// Pixels from the upper left of the picture; none behind the near plane.
fn pixel_of(clip_from_world: &Mat4, world: Vec3, size: Vec2) -> Option<Vec2> {
    let clip = *clip_from_world * world.extend(1.0);
    // Reversed depth is 1 at the near plane.
    (clip.w > clip.z).then(|| Vec2::new(0.5 + 0.5 * clip.x / clip.w, 0.5 - 0.5 * clip.y / clip.w) * size)
}

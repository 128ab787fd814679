//! Lays a tile on a mesh: texture coordinates and tangents, in metres of the piece.
//!
//! The grain (u) runs along the longest side of the piece's bounding box, which is one of the three axes of its node's frame. Let p
//! be a position times the node's scale, so that lengths are those in the world.
//!
//! *Plates.* A piece that is thin along n gets one projection, with axes t along the grain and b = n × t:
//!
//! ```text
//! u = (p·t + p·n)/length of the tile      v = (p·b + p·n)/its width
//! ```
//!
//! On the flat sides p·n is constant, and the map is that of a parallel projection along n. The slant p·n keeps lengths on the rim,
//! where a projection along n would smear one texel over the whole thickness. No vertex is split: there are no seams.
//!
//! *Other pieces* get a box projection: each triangle is seen along the axis that is nearest to its normal. A vertex between
//! triangles of different axes is doubled; its normal stays, so that shading stays smooth. Of wood, triangles whose normal lies within
//! 26° of the grain show end grain, and become a primitive of their own; the others are seen from a side, which keeps the end grain of
//! round pieces small.
//!
//! Tangents follow glTF 2.0, 3.7.2.1: t points to where u grows, and w n × t to where v falls.

use soffio_math::DVec3;

use crate::model::Primitive;

/// How a finish is laid on one primitive.
#[derive(Clone, Copy, Debug)]
pub struct Laying {
    /// Scale of the node's frame along its axes.
    pub scale: DVec3,
    /// Lengths of the tile, m.
    pub tile: [f64; 2],
    /// Side of the end grain's tile, m; `None` where no grain ends.
    pub end_tile: Option<f64>,
    /// Where in the tile the piece begins, 0 … 1 each.
    pub offset: [f64; 2],
}

/// A primitive with texture coordinates, and its end grain.
#[derive(Debug)]
pub struct Laid {
    /// Triangles along the grain.
    pub face: Primitive,
    /// Triangles across it.
    pub end: Option<Primitive>,
}

/// A piece is a plate if its smallest extent is less than this share of the second one …
const THIN: f64 = 0.1;
/// … or if the triangles that are parallel to its largest one make up this share of its surface. It is the share from which the
/// renderer measures the coverage of moving plates at their silhouettes, for which it needs their triangles in one primitive.
const CAP_SHARE: f64 = 0.75;
/// Cosine of the largest angle between the grain and the normal of end grain: 26°.
const END_COSINE: f64 = 0.9;
/// Cosine of the angle up to which triangles count as parallel: 8°.
const CAP_COSINE: f64 = 0.99;

/// Lays a tile on a primitive.
pub fn lay(primitive: &Primitive, laying: &Laying) -> Laid {
    let places: Vec<DVec3> = primitive.positions.iter().map(|p| DVec3::from(p.map(f64::from)) * laying.scale).collect();
    let triangles: Vec<[u32; 3]> = primitive.indices.as_chunks::<3>().0.to_vec();
    let valid = |triangle: &&[u32; 3]| triangle.iter().all(|&i| (i as usize) < places.len());
    let crosses: Vec<DVec3> = triangles.iter().filter(valid).map(|t| cross(&places, t)).collect();
    let triangles: Vec<[u32; 3]> = triangles.iter().filter(valid).copied().collect();
    let low = places.iter().copied().fold(DVec3::INFINITY, DVec3::min);
    let high = places.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
    let size = high - low;
    match plate_normal(size, &crosses) {
        Some(normal) => Laid { face: plate(primitive, &places, grain(size, normal), normal, laying), end: None },
        None => boxed(primitive, &places, &triangles, &crosses, longest(size), laying),
    }
}

/// Twice the area of a triangle along its normal.
fn cross(places: &[DVec3], triangle: &[u32; 3]) -> DVec3 {
    let [a, b, c] = triangle.map(|i| places[i as usize]);
    (b - a).cross(c - a)
}

/// The normal of a plate; `None` of other pieces.
fn plate_normal(size: DVec3, crosses: &[DVec3]) -> Option<DVec3> {
    let mut extents = size.to_array();
    extents.sort_by(f64::total_cmp);
    if extents[0] < THIN * extents[1] {
        return Some(DVec3::AXES[(0..3).min_by(|&i, &j| size[i].total_cmp(&size[j]))?]);
    }
    let largest = crosses.iter().copied().reduce(|a, b| if b.length() > a.length() { b } else { a })?;
    let normal = largest.try_normalize()?;
    let total: f64 = crosses.iter().map(|c| c.length()).sum();
    let parallel = crosses.iter().filter(|c| c.dot(normal).abs() > CAP_COSINE * c.length());
    (parallel.map(|c| c.length()).sum::<f64>() >= CAP_SHARE * total).then_some(normal)
}

/// Index of the longest extent, the first of equal ones.
fn longest(size: DVec3) -> usize {
    (1..3).fold(0, |best, axis| if size[axis] > size[best] { axis } else { best })
}

/// Direction of the grain in a plate: its longest extent that does not lie along the normal.
fn grain(size: DVec3, normal: DVec3) -> DVec3 {
    let across = (0..3).fold(0, |best, axis| if normal[axis].abs() > normal[best].abs() { axis } else { best });
    let axis = DVec3::AXES[longest(size * (DVec3::ONE - DVec3::AXES[across]))];
    (axis - normal * axis.dot(normal)).normalize_or(normal.any_orthonormal_vector())
}

fn plate(primitive: &Primitive, places: &[DVec3], along: DVec3, normal: DVec3, laying: &Laying) -> Primitive {
    let across = normal.cross(along);
    let [length, width] = laying.tile;
    let [u, v] = laying.offset;
    let mut out = Primitive { uvs: Vec::with_capacity(places.len()), tangents: Vec::new(), ..primitive.clone() };
    out.uvs.extend(places.iter().map(|p| {
        let depth = p.dot(normal);
        [((p.dot(along) + depth) / length + u) as f32, ((p.dot(across) + depth) / width + v) as f32]
    }));
    out.tangents =
        (0..places.len()).map(|i| tangent(primitive, i, [along + normal, across + normal], laying.scale)).collect();
    out
}

fn boxed(
    primitive: &Primitive,
    places: &[DVec3],
    triangles: &[[u32; 3]],
    crosses: &[DVec3],
    grain: usize,
    laying: &Laying,
) -> Laid {
    let [mut face, mut end] = [Part::new(places.len()), Part::new(places.len())];
    for (triangle, cross) in triangles.iter().zip(crosses) {
        let is_end = laying.end_tile.is_some() && cross[grain].abs() > END_COSINE * cross.length();
        let sideways = if laying.end_tile.is_some() && !is_end { DVec3::ONE - DVec3::AXES[grain] } else { DVec3::ONE };
        let seen = side(*cross * sideways);
        let part = if is_end { &mut end } else { &mut face };
        for &index in triangle {
            part.add(index, seen);
        }
    }
    let Laying { tile, end_tile, offset, scale } = *laying;
    let projected = |part: &Part, tile: [f64; 2]| {
        let mut out = part.picked(primitive);
        for &(index, (axis, _)) in &part.vertices {
            let [along, across] = plane(axis, grain);
            let p = places[index as usize];
            out.uvs.push([(p[along] / tile[0] + offset[0]) as f32, (p[across] / tile[1] + offset[1]) as f32]);
            out.tangents.push(tangent(primitive, index as usize, [along, across].map(|k| DVec3::AXES[k]), scale));
        }
        out
    };
    let end = end_tile.filter(|_| !end.indices.is_empty()).map(|side| projected(&end, [side; 2]));
    Laid { face: projected(&face, tile), end }
}

/// Axis that a triangle is seen along, and whether from its far side.
type Side = (usize, bool);

/// The axis nearest to a normal; the first of equal ones, so that it does not change from triangle to triangle of a bevel.
fn side(cross: DVec3) -> Side {
    /// Preference of earlier axes: far above rounding, far below a visible angle.
    const PREFERENCE: f64 = 1e-4;
    let share = |axis: usize| cross[axis].abs() * (1.0 - PREFERENCE * axis as f64);
    let axis = (1..3).fold(0, |best, axis| if share(axis) > share(best) { axis } else { best });
    (axis, cross[axis] < 0.0)
}

/// The axes of u and v on a face that is seen along `axis`: along the grain where it lies in the face.
fn plane(axis: usize, grain: usize) -> [usize; 2] {
    let [next, last] = [(axis + 1) % 3, (axis + 2) % 3];
    if last == grain { [last, next] } else { [next, last] }
}

/// Vertices and triangles that a part takes from a primitive.
struct Part {
    /// New index of each vertex on each side.
    known: Vec<[Option<u32>; 6]>,
    /// Index in the primitive, and side.
    vertices: Vec<(u32, Side)>,
    indices: Vec<u32>,
}

impl Part {
    fn new(count: usize) -> Self {
        Self { known: vec![[None; 6]; count], vertices: Vec::new(), indices: Vec::new() }
    }

    fn add(&mut self, index: u32, seen: Side) {
        let (axis, far) = seen;
        let next = self.vertices.len() as u32;
        let slot = &mut self.known[index as usize][2 * axis + usize::from(far)];
        let vertex = *slot.get_or_insert(next);
        if vertex == next {
            self.vertices.push((index, seen));
        }
        self.indices.push(vertex);
    }

    /// The attributes of its vertices; without texture coordinates and tangents.
    fn picked(&self, from: &Primitive) -> Primitive {
        fn pick<T: Copy>(vertices: &[(u32, Side)], list: &[T]) -> Vec<T> {
            vertices.iter().filter_map(|(index, _)| list.get(*index as usize).copied()).collect()
        }
        Primitive {
            positions: pick(&self.vertices, &from.positions),
            normals: pick(&self.vertices, &from.normals),
            second_uvs: pick(&self.vertices, &from.second_uvs),
            colors: pick(&self.vertices, &from.colors),
            uvs: Vec::with_capacity(self.vertices.len()),
            tangents: Vec::with_capacity(self.vertices.len()),
            influences: Vec::new(),
            targets: Vec::new(),
            flat: from.flat,
            indices: self.indices.clone(),
            material: from.material,
        }
    }
}

/// The tangent of a vertex: the direction in its surface along which v stays and u grows, g_v × n or against it, where g are the
/// gradients of u and v. Then the sign with which n × t points to where v falls.
fn tangent(primitive: &Primitive, index: usize, [grow_u, grow_v]: [DVec3; 2], scale: DVec3) -> [f32; 4] {
    let normal = primitive.normals.get(index).map_or(DVec3::Y, |n| DVec3::from(n.map(f64::from)));
    // The gradients over positions in the frame of the node.
    let [grow_u, grow_v] = [grow_u * scale, grow_v * scale];
    let still = grow_v.cross(normal).try_normalize().unwrap_or_else(|| normal.any_orthonormal_vector());
    let t = if still.dot(grow_u) < 0.0 { -still } else { still };
    let hand = if normal.cross(t).dot(grow_v) > 0.0 { -1.0 } else { 1.0 };
    let [x, y, z] = t.as_vec3().to_array();
    [x, y, z, hand]
}

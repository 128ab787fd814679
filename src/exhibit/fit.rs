//! Collision shapes fitted to meshes: sphere, capsule, box, convex hull, and sheet metal as convex pieces of its
//! outline.
//!
//! A shape is a convex core with a sphere swept over it (`collision::Shape`). Sheet metal is the flat polygon of its
//! mid-surface, with half its thickness as the sphere's radius. Its outline is the rim of one face, simplified (Douglas
//! and Peucker 1973) and cut into triangles by ear clipping (Meisters 1975). They are merged where the union stays
//! convex (Hertel and Mehlhorn 1983: at most four times the least number of pieces). Holes are filled.

use std::collections::BTreeMap;

use soffio_geometry::hull::Hull;
use soffio_geometry::{Extents, TriangleMesh};
use soffio_math::{DMat3, DQuat, DVec2, DVec3, PI, Pose, cos, sin};
use soffio_multibody::collision::Shape;

/// Edge radius of boxes, cylinders and hulls, as a fraction of the smallest half extent. Rounded edges give impacts a
/// definite normal.
const ROUNDING: f64 = 0.02;
/// Number of support directions of a hull.
const HULL_DIRECTIONS: usize = 96;

/// A box with rounded edges whose faces lie where they should.
pub fn rounded_box(center: DVec3, [x, y, z]: [DVec3; 3], half: DVec3) -> Shape {
    // A box is its own mirror image, a rotation is not.
    let z = if x.cross(y).dot(z) < 0.0 { -z } else { z };
    let rotation = DQuat::from_mat3(&DMat3::from_cols(x, y, z)).normalize();
    Shape::cuboid(Pose { rotation, position: center }, half, ROUNDING * half.min_element())
}

/// A cylinder with rounded edges about a centre along a unit axis; lengths in m.
pub fn cylinder(center: DVec3, axis: DVec3, height: f64, radius: f64) -> Shape {
    let half = 0.5 * height * axis;
    Shape::cylinder(center - half, center + half, radius, ROUNDING * radius.min(0.5 * height))
}

/// The sphere around the mesh with its centre at the oriented box's.
pub fn sphere(mesh: &TriangleMesh, extents: &Extents) -> Shape {
    let far = mesh.corners().flatten().map(|p| p.distance(extents.center)).fold(0.0, f64::max);
    Shape::sphere(extents.center, far)
}

/// The capsule along the longest axis of the oriented box.
pub fn capsule(extents: &Extents) -> Shape {
    let radius = extents.half.y;
    let along = extents.axes.x_axis * (extents.half.x - radius).max(0.0);
    Shape::capsule(extents.center - along, extents.center + along, radius)
}

/// The convex hull with rounded edges, faces where they should be; of a large mesh the hull of its support points in
/// directions spread evenly over the sphere (Fibonacci lattice). `None` where the mesh has no volume.
pub fn convex(mesh: &TriangleMesh) -> Option<Shape> {
    let mut points: Vec<DVec3> = Vec::new();
    for point in mesh.corners().flatten() {
        if !points.contains(&point) {
            points.push(point);
        }
    }
    let golden = PI * (3.0 - 5.0_f64.sqrt());
    let directions = (0..HULL_DIRECTIONS).map(|i| {
        let y = 1.0 - (2.0 * i as f64 + 1.0) / HULL_DIRECTIONS as f64;
        let r = (1.0 - y * y).sqrt();
        let angle = golden * i as f64;
        DVec3::new(r * cos(angle), y, r * sin(angle))
    });
    let directions: Vec<DVec3> = directions.chain(DVec3::AXES).chain(DVec3::AXES.map(|a| -a)).collect();
    if points.len() > HULL_DIRECTIONS {
        let mut corners: Vec<DVec3> = Vec::new();
        for direction in &directions {
            let furthest = points.iter().copied().max_by(|a, b| a.dot(*direction).total_cmp(&b.dot(*direction)))?;
            if !corners.contains(&furthest) {
                corners.push(furthest);
            }
        }
        points = corners;
    }
    let middle = points.iter().sum::<DVec3>() / points.len() as f64;
    let reach = |d: &DVec3| points.iter().map(|p| (*p - middle).dot(*d)).fold(f64::NEG_INFINITY, f64::max);
    let inner = directions.iter().map(reach).fold(f64::INFINITY, f64::min);
    let radius = ROUNDING * inner;
    (inner > 0.0).then(|| Shape::hull(&Hull::new(&points).inset(radius), radius))
}

/// Sheet metal as convex pieces; `None` where the mesh has no outline.
pub fn plate(mesh: &TriangleMesh, extents: &Extents) -> Option<Vec<Shape>> {
    let normal = extents.axes.z_axis;
    let (u, v) = (extents.axes.x_axis, extents.axes.y_axis);
    // An open surface has no thickness of its own; it gets that of thin metal for its size.
    let radius = extents.half.z.max(1e-3 * extents.half.y);
    let flat = |p: DVec3| DVec2::new((p - extents.center).dot(u), (p - extents.center).dot(v));
    let outline: Vec<DVec2> = rim(mesh, normal)?.into_iter().map(flat).collect();
    let outline = simplify_ring(&outline, radius);
    if outline.len() < 3 {
        return None;
    }
    let lift = |p: &DVec2| extents.center + u * p.x + v * p.y;
    let pieces = convex_pieces(&outline);
    Some(pieces.iter().map(|piece| Shape::plate(&piece.iter().map(lift).collect::<Vec<_>>(), radius)).collect())
}

/// The triangles of a sheet that face along `normal`, for the wind: one side of a closed plate, all of an open surface.
pub fn one_side(mesh: &TriangleMesh, normal: DVec3) -> TriangleMesh {
    let faces = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|i| mesh.positions[i as usize]);
        let cross = (b - a).cross(c - a);
        cross.dot(normal) > 0.5 * cross.length()
    };
    let triangles = mesh.triangles.iter().copied().filter(faces).collect();
    TriangleMesh { positions: mesh.positions.clone(), triangles }
}

/// The longest ring of boundary edges of the side that faces `normal`, counter-clockwise about it.
fn rim(mesh: &TriangleMesh, normal: DVec3) -> Option<Vec<DVec3>> {
    let side = one_side(mesh, normal).welded();
    let mut edges: BTreeMap<(u32, u32), ()> = BTreeMap::new();
    for [a, b, c] in &side.triangles {
        for edge in [(*a, *b), (*b, *c), (*c, *a)] {
            edges.insert(edge, ());
        }
    }
    let border: BTreeMap<u32, u32> =
        edges.keys().filter(|(a, b)| !edges.contains_key(&(*b, *a))).map(|&(a, b)| (a, b)).collect();
    let mut left = border.clone();
    let mut best: Option<(f64, Vec<DVec3>)> = None;
    while let Some((start, mut next)) = left.pop_first() {
        let mut ring = vec![start];
        while next != start {
            ring.push(next);
            match left.remove(&next) {
                Some(following) => next = following,
                None => break,
            }
        }
        let points: Vec<DVec3> = ring.iter().map(|&i| side.positions[i as usize]).collect();
        let length: f64 = points.iter().zip(points.iter().cycle().skip(1)).map(|(a, b)| a.distance(*b)).sum();
        if best.as_ref().is_none_or(|(longest, _)| length > *longest) {
            best = Some((length, points));
        }
    }
    best.map(|(_, points)| points)
}

/// A ring without the corners that lie within `tolerance` of the line through their neighbours kept.
fn simplify_ring(ring: &[DVec2], tolerance: f64) -> Vec<DVec2> {
    if ring.len() < 4 {
        return ring.to_vec();
    }
    // The corner furthest from the first splits the ring into two lines.
    let far = |i: &usize| ring[*i].distance_squared(ring[0]);
    let split = (0..ring.len()).max_by(|a, b| far(a).total_cmp(&far(b))).unwrap_or(0);
    let lifted: Vec<DVec3> = ring.iter().chain([&ring[0]]).map(|p| p.extend(0.0)).collect();
    let mut kept = simplify(&lifted[..=split], tolerance);
    kept.pop();
    kept.extend(simplify(&lifted[split..], tolerance));
    kept.pop();
    kept.iter().map(|p| p.truncate()).collect()
}

/// A polyline without the corners that lie within `tolerance` of the rest (Douglas and Peucker 1973).
pub fn simplify(line: &[DVec3], tolerance: f64) -> Vec<DVec3> {
    let (Some(&first), Some(&last)) = (line.first(), line.last()) else { return Vec::new() };
    let chord = last - first;
    let off = |p: DVec3| {
        let along = if chord.length_squared() > 0.0 { (p - first).dot(chord) / chord.length_squared() } else { 0.0 };
        p.distance(first + chord * along.clamp(0.0, 1.0))
    };
    let furthest = (1..line.len().max(1) - 1).max_by(|&a, &b| off(line[a]).total_cmp(&off(line[b])));
    match furthest {
        Some(split) if off(line[split]) > tolerance => {
            let mut out = simplify(&line[..=split], tolerance);
            out.pop();
            out.extend(simplify(&line[split..], tolerance));
            out
        }
        _ if line.len() > 1 => vec![first, last],
        _ => vec![first],
    }
}

fn orientation(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    (b - a).perp_dot(c - b)
}

/// Convex decomposition of a simple counter-clockwise polygon.
fn convex_pieces(outline: &[DVec2]) -> Vec<Vec<DVec2>> {
    let mut pieces: Vec<Vec<usize>> = ear_clipping(outline).into_iter().map(|t| t.to_vec()).collect();
    // Remove each diagonal whose two neighbours together are convex, until none is left.
    'again: loop {
        for i in 0..pieces.len() {
            for j in i + 1..pieces.len() {
                if let Some(joined) = merged(outline, &pieces[i], &pieces[j]) {
                    pieces[i] = joined;
                    pieces.swap_remove(j);
                    continue 'again;
                }
            }
        }
        break;
    }
    pieces.into_iter().map(|piece| piece.into_iter().map(|i| outline[i]).collect()).collect()
}

/// Triangles of a simple counter-clockwise polygon by ear clipping.
fn ear_clipping(outline: &[DVec2]) -> Vec<[usize; 3]> {
    let mut left: Vec<usize> = (0..outline.len()).collect();
    let mut triangles = Vec::new();
    while left.len() > 3 {
        let n = left.len();
        let corner = |i: usize| [left[(i + n - 1) % n], left[i], left[(i + 1) % n]];
        let is_ear = |i: &usize| {
            let t = corner(*i);
            let [a, b, c] = t.map(|k| outline[k]);
            let covers =
                |p: DVec2| orientation(a, b, p) >= 0.0 && orientation(b, c, p) >= 0.0 && orientation(c, a, p) >= 0.0;
            orientation(a, b, c) > 0.0 && !left.iter().any(|k| !t.contains(k) && covers(outline[*k]))
        };
        // A polygon that touches itself may have no strict ear; the most convex corner goes first then.
        let bend = |i: &usize| {
            let [a, b, c] = corner(*i).map(|k| outline[k]);
            orientation(a, b, c)
        };
        let ear = (0..n).find(is_ear).or_else(|| (0..n).max_by(|a, b| bend(a).total_cmp(&bend(b)))).unwrap_or(0);
        triangles.push(corner(ear));
        left.remove(ear);
    }
    if let [a, b, c] = left[..] {
        triangles.push([a, b, c]);
    }
    triangles
}

/// The union of two polygons that share an edge, where it is convex.
fn merged(outline: &[DVec2], p: &[usize], q: &[usize]) -> Option<Vec<usize>> {
    for i in 0..p.len() {
        let (a, b) = (p[i], p[(i + 1) % p.len()]);
        let Some(j) = (0..q.len()).find(|&j| q[j] == b && q[(j + 1) % q.len()] == a) else { continue };
        // Round p from b to a, then round q from a to b.
        let mut joined: Vec<usize> = (0..p.len()).map(|k| p[(i + 1 + k) % p.len()]).collect();
        joined.extend((2..q.len()).map(|k| q[(j + k) % q.len()]));
        let n = joined.len();
        let corner = |k: usize| [k, (k + 1) % n, (k + 2) % n].map(|m| outline[joined[m]]);
        let convex = (0..n).all(|k| {
            let [a, b, c] = corner(k);
            orientation(a, b, c) >= 0.0
        });
        return convex.then_some(joined);
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(polygon: &[DVec2]) -> f64 {
        let next = polygon.iter().cycle().skip(1);
        polygon.iter().zip(next).map(|(a, b)| 0.5 * a.perp_dot(*b)).sum()
    }

    #[test]
    fn pieces_of_a_star_are_convex_and_cover_it() {
        /// Ten products of numbers near 1.
        const ROUNDING: f64 = 1e-13;
        let star: Vec<DVec2> = (0..10)
            .map(|i| {
                let (angle, r) = (PI * i as f64 / 5.0, if i % 2 == 0 { 1.0 } else { 0.4 });
                DVec2::new(r * cos(angle), r * sin(angle))
            })
            .collect();
        let pieces = convex_pieces(&star);
        let covered: f64 = pieces.iter().map(|p| area(p)).sum();
        assert!((covered - area(&star)).abs() < ROUNDING, "{covered} against {}", area(&star));
        for piece in &pieces {
            let n = piece.len();
            assert!((0..n).all(|k| orientation(piece[k], piece[(k + 1) % n], piece[(k + 2) % n]) >= 0.0), "{piece:?}");
        }
        // Five reflex corners need at least three pieces; Hertel–Mehlhorn gives at most four times that, here 6.
        assert!((3..=6).contains(&pieces.len()), "{} pieces", pieces.len());
    }

    #[test]
    fn simplifying_keeps_corners_and_drops_what_lies_between() {
        let line: Vec<DVec3> =
            (0..=10).map(|i| DVec3::new(f64::from(i), if i <= 5 { 0.0 } else { f64::from(i - 5) }, 0.0)).collect();
        assert_eq!(simplify(&line, 1e-9), vec![line[0], line[5], line[10]]);
        assert_eq!(simplify(&line[..1], 1.0), vec![line[0]]);
    }
}

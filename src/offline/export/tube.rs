//! Tube meshes of wires: a ring of vertices at each point, transported without twist.

use soffio_exhibit::model::Primitive;
use soffio_math::{DVec3, PI, sincos, tangents};

/// Vertices of a ring: the outline deviates by r (1 − cos π/12), a thirtieth of the radius.
const SIDES: u32 = 12;
/// Points nearer to each other than this fraction of the radius are merged.
const SAME_POINT: f64 = 1e-3;
/// Largest stretch of a ring at a bend, which keeps the wire's width.
const MITRE: f64 = 2.0;

/// Triangles of the wire through `points` (m), its ends flat; empty where it has no length.
pub(super) fn tube(points: &[DVec3], radius: f64) -> Primitive {
    let mut line: Vec<DVec3> = Vec::with_capacity(points.len());
    for &point in points {
        if line.last().is_none_or(|last| last.distance(point) > SAME_POINT * radius) {
            line.push(point);
        }
    }
    let mut out = Primitive::default();
    if line.len() < 2 {
        return out;
    }
    let directions: Vec<DVec3> = line.windows(2).map(|pair| (pair[1] - pair[0]).normalize()).collect();
    let mut side = tangents(directions[0]).0;
    for (i, &point) in line.iter().enumerate() {
        let (before, after) = (directions[i.saturating_sub(1)], directions[i.min(directions.len() - 1)]);
        // The ring lies in the bisecting plane of the bend; a wire that reverses has none.
        let normal = (before + after).try_normalize().unwrap_or(after);
        side = side.reject_from_normalized(before).try_normalize().unwrap_or_else(|| tangents(before).0);
        let other = before.cross(side);
        for k in 0..SIDES {
            let (s, c) = sincos(2.0 * PI * f64::from(k) / f64::from(SIDES));
            let across = side * c + other * s;
            // Project along `before` into the bisecting plane.
            let along = -across.dot(normal) / before.dot(normal).max(1.0 / MITRE);
            out.positions.push((point + (across + before * along) * radius).as_vec3().to_array());
            out.normals.push(across.as_vec3().to_array());
        }
        side = side.reject_from_normalized(after).try_normalize().unwrap_or_else(|| tangents(after).0);
    }
    for ring in 0..line.len() as u32 - 1 {
        for k in 0..SIDES {
            let (a, b) = (ring * SIDES + k, ring * SIDES + (k + 1) % SIDES);
            out.indices.extend([a, b, a + SIDES, b, b + SIDES, a + SIDES]);
        }
    }
    let last = SIDES * (line.len() as u32 - 1);
    cap(&mut out, 0, -directions[0]);
    cap(&mut out, last, directions[directions.len() - 1]);
    out
}

/// Closes the ring that begins at a vertex, facing outwards.
fn cap(out: &mut Primitive, ring: u32, outwards: DVec3) {
    let base = out.positions.len() as u32;
    for k in 0..SIDES {
        out.positions.push(out.positions[(ring + k) as usize]);
        out.normals.push(outwards.as_vec3().to_array());
    }
    for k in 1..SIDES - 1 {
        let (a, b) = if ring == 0 { (k + 1, k) } else { (k, k + 1) };
        out.indices.extend([base, base + a, base + b]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_straight_tube_has_the_volume_of_its_prism_and_faces_outwards() {
        let mesh = tube(&[DVec3::ZERO, DVec3::new(0.0, 0.3, 0.0), DVec3::new(0.0, 1.0, 0.0)], 0.1);
        let corner = |i: u32| DVec3::from(mesh.positions[i as usize].map(f64::from));
        let volume: f64 =
            mesh.indices.chunks_exact(3).map(|t| corner(t[0]).dot(corner(t[1]).cross(corner(t[2]))) / 6.0).sum();
        // A regular polygon of n corners on a circle of radius r: n/2 r² sin 2π/n.
        let area = 0.5 * f64::from(SIDES) * 0.01 * sincos(2.0 * PI / f64::from(SIDES)).0;
        assert!((volume - area).abs() < 1e-7, "{volume} {area}: single precision");
        for t in mesh.indices.chunks_exact(3) {
            let [a, b, c] = [corner(t[0]), corner(t[1]), corner(t[2])];
            let normal = DVec3::from(mesh.normals[t[0] as usize].map(f64::from));
            assert!((b - a).cross(c - a).dot(normal) > 0.0);
        }
    }

    #[test]
    fn a_bend_keeps_the_width_of_both_arms() {
        let mesh = tube(&[DVec3::X, DVec3::ZERO, DVec3::Y], 0.1);
        // The ring at the bend lies in the plane x = y, at the radius from both axes.
        for p in &mesh.positions[SIDES as usize..2 * SIDES as usize] {
            let [x, y, z] = p.map(f64::from);
            assert!((x - y).abs() < 1e-6, "{p:?}");
            assert!((y * y + z * z - 0.01).abs() < 1e-6, "{p:?}");
        }
    }
}

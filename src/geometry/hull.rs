//! Convex hulls of corners, with the faces that contact needs.
//!
//! Corners are few and hulls are made at load, so every plane through three corners is tried: it is a face when no
//! corner lies above it. That is O(n⁴) at worst, and has no order of insertion to go wrong on flat or round input.

use super::support::farthest;
use soffio_math::{DMat3, DVec2, DVec3, tangents};

/// Corners within this share of the hull's size of a plane lie in it: ten roundings of models' 32-bit coordinates.
const FLAT: f64 = 1e-6;
/// Three corners whose sides make a smaller sine than this have no plane of their own.
const LINE: f64 = 1e-4;

/// The convex hull of corners.
#[derive(Clone, Debug, PartialEq)]
pub struct Hull {
    corners: Vec<DVec3>,
    middle: DVec3,
    faces: Vec<Face>,
    /// Corner indices of all faces, one after the other, each with its first repeated after its last.
    loops: Vec<usize>,
}

/// A face: counter-clockwise corners `loops[first..end]` about its outward normal.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Face {
    normal: DVec3,
    first: usize,
    end: usize,
}

impl Hull {
    /// The hull of points (one at least, frame of the shape, m). Those inside it are dropped.
    pub fn new(points: &[DVec3]) -> Self {
        let mean = points.iter().sum::<DVec3>() / points.len() as f64;
        let size = points.iter().fold(0.0, |r: f64, p| r.max(p.distance(mean)));
        let mut found: Vec<(DVec3, Vec<usize>)> = Vec::new();
        let mut known = KnownFaces::new(points.len());
        for i in 0..points.len() {
            for j in i + 1..points.len() {
                for k in j + 1..points.len() {
                    plane_of(points, [i, j, k], FLAT * size, &mut found, &mut known);
                }
            }
        }
        if found.is_empty() {
            // All in a line: its two ends.
            let end = |from: DVec3| {
                let far = |i: &usize| points[*i].distance_squared(from);
                (0..points.len()).fold(0, |best, i| if far(&i) > far(&best) { i } else { best })
            };
            let first = end(mean);
            let last = end(points[first]);
            found.push((DVec3::ZERO, if first == last { vec![first] } else { vec![first, last] }));
        }
        let used: Vec<usize> = (0..points.len()).filter(|i| found.iter().any(|(_, ring)| ring.contains(i))).collect();
        let place = |i: &usize| used.iter().position(|u| u == i).unwrap_or(0);
        let (mut faces, mut loops) = (Vec::new(), Vec::new());
        for (normal, ring) in &found {
            let first = loops.len();
            loops.extend(ring.iter().map(place));
            faces.push(Face { normal: *normal, first, end: loops.len() });
            loops.push(loops[first]);
        }
        let corners: Vec<DVec3> = used.iter().map(|&i| points[i]).collect();
        let middle = corners.iter().sum::<DVec3>() / corners.len() as f64;
        Self { corners, middle, faces, loops }
    }

    /// The corners, m.
    #[inline]
    pub fn corners(&self) -> &[DVec3] {
        &self.corners
    }

    /// Mean of the corners, m.
    #[inline]
    pub fn middle(&self) -> DVec3 {
        self.middle
    }

    /// Outward normals of the faces.
    #[inline]
    pub fn normals(&self) -> impl Iterator<Item = DVec3> + '_ {
        self.faces.iter().map(|face| face.normal)
    }

    /// The corners of the hull whose faces lie so much deeper (m): with a ball of that radius swept over it, it has its own
    /// faces back. A corner of faces n goes by the d with n·d = −depth, of more than three faces by the one nearest to that.
    pub fn inset(&self, depth: f64) -> Vec<DVec3> {
        let moved = |(index, corner): (usize, &DVec3)| {
            let meets = |face: &&Face| self.loops[face.first..face.end].contains(&index);
            let (squares, sum) = self.faces.iter().filter(meets).fold((DMat3::ZERO, DVec3::ZERO), |(m, s), face| {
                let n = face.normal;
                (m + DMat3::from_cols(n * n.x, n * n.y, n * n.z), s + n)
            });
            *corner - depth * (squares.inverse() * sum)
        };
        self.corners.iter().enumerate().map(moved).collect()
    }

    /// Corners of the face, edge or point farthest along `d` (unit) that lean against the plane across it by a sine
    /// of `lean` at most, and the face's normal where it is one.
    pub fn feature(&self, d: DVec3, lean: f64) -> (&[usize], Option<DVec3>) {
        let tip = farthest(&self.corners, d);
        let rings = || self.faces.iter().map(|f| (f, &self.loops[f.first..=f.end]));
        let mut flattest: Option<(f64, &Face)> = None;
        for (face, ring) in rings() {
            let along = face.normal.dot(d);
            if along > 0.0 && ring.contains(&tip) && flattest.is_none_or(|(best, _)| along > best) {
                flattest = Some((along, face));
            }
        }
        if let Some((_, face)) = flattest
            && face.normal.cross(d).length_squared() <= lean * lean
        {
            return (&self.loops[face.first..face.end], Some(face.normal));
        }
        let mut best: (f64, &[usize]) = (lean, &[]);
        for (_, ring) in rings() {
            for edge in ring.windows(2) {
                if edge[0] != tip && edge[1] != tip {
                    continue;
                }
                let way = self.corners[edge[1]] - self.corners[edge[0]];
                let leans = way.dot(d).abs() / way.length();
                if leans < best.0 {
                    best = (leans, edge);
                }
            }
        }
        if !best.1.is_empty() {
            return (best.1, None);
        }
        let at = self.loops.iter().position(|&i| i == tip).unwrap_or(0);
        (&self.loops[at..=at], None)
    }
}

/// Which corners lie on the outline of which faces.
struct KnownFaces {
    /// For each corner a bit of each face.
    of: Vec<Vec<u64>>,
}

impl KnownFaces {
    fn new(points: usize) -> Self {
        Self { of: vec![Vec::new(); points] }
    }

    fn add(&mut self, face: usize, ring: &[usize]) {
        let (word, bit) = (face / 64, 1 << (face % 64));
        for &corner in ring {
            let words = &mut self.of[corner];
            words.resize(words.len().max(word + 1), 0);
            words[word] |= bit;
        }
    }

    /// Faces that have all three corners on their outline.
    fn with(&self, [i, j, k]: [usize; 3]) -> impl Iterator<Item = usize> + '_ {
        let words = self.of[i].iter().zip(&self.of[j]).zip(&self.of[k]).map(|((a, b), c)| a & b & c);
        let bits = |word: u64| (0..64).filter(move |bit| word >> bit & 1 == 1);
        words
            .enumerate()
            .filter(|(_, word)| *word != 0)
            .flat_map(move |(at, word)| bits(word).map(move |b| 64 * at + b))
    }
}

/// Adds the plane of three corners, either way up, where no corner lies above it and it is new. It is not new where a
/// face that looks the same way has all three on its outline.
fn plane_of(
    points: &[DVec3],
    [i, j, k]: [usize; 3],
    flat: f64,
    found: &mut Vec<(DVec3, Vec<usize>)>,
    faces: &mut KnownFaces,
) {
    let (u, v) = (points[j] - points[i], points[k] - points[i]);
    let cross = u.cross(v);
    let length = cross.length();
    if length <= LINE * u.length() * v.length() {
        return;
    }
    for normal in [cross / length, -cross / length] {
        if faces.with([i, j, k]).any(|face| found[face].0.dot(normal) > 0.0) {
            continue;
        }
        let above = |p: &DVec3| (*p - points[i]).dot(normal);
        if points.iter().any(|p| above(p) > flat) {
            continue;
        }
        let inside: Vec<usize> = (0..points.len()).filter(|&m| above(&points[m]) >= -flat).collect();
        let known = |(other, ring): &(DVec3, Vec<usize>)| {
            other.dot(normal) > 0.0 && ring.iter().filter(|m| inside.contains(m)).count() > 2
        };
        if !found.iter().any(known) {
            let ring = ring_of(points, &inside, normal);
            if ring.len() > 2 {
                faces.add(found.len(), &ring);
                found.push((normal, ring));
            }
        }
    }
}

/// The corners of a face's outline, counter-clockwise about its normal (Andrew's monotone chain, 1979).
fn ring_of(points: &[DVec3], inside: &[usize], normal: DVec3) -> Vec<usize> {
    let (t, b) = tangents(normal);
    let flat = |i: usize| DVec2::new(points[i].dot(t), points[i].dot(b));
    let mut order = inside.to_vec();
    order.sort_by(|&i, &j| {
        let (p, q) = (flat(i), flat(j));
        p.x.total_cmp(&q.x).then(p.y.total_cmp(&q.y))
    });
    let half = |order: &mut dyn Iterator<Item = usize>| {
        let mut chain: Vec<usize> = Vec::new();
        for i in order {
            while let [.., p, q] = chain[..] {
                let (u, v) = (flat(q) - flat(p), flat(i) - flat(q));
                if u.perp_dot(v) > 1e-9 * u.length() * v.length() {
                    break;
                }
                chain.pop();
            }
            chain.push(i);
        }
        chain.pop();
        chain
    };
    let mut ring = half(&mut order.iter().copied());
    ring.extend(half(&mut order.iter().rev().copied()));
    ring
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_inset_hull_with_its_ball_has_the_faces_of_the_hull() {
        /// m, of a part of 4 cm: rounding.
        const FACES: f64 = 1e-12;
        const BALL: f64 = 4e-5;
        // A long thin wedge: shrunk about its middle it would be short by far more than the ball.
        let outline = [(-0.02, 0.0), (0.02, 0.0), (0.015, 0.003), (-0.015, 0.003)];
        let corner = |side: f64| outline.map(|(x, y)| DVec3::new(x, y, 0.002 * side));
        let corners: Vec<DVec3> = [-1.0, 1.0].into_iter().flat_map(corner).collect();
        let hull = Hull::new(&corners);
        let inset = hull.inset(BALL);
        assert_eq!((hull.corners().len(), inset.len()), (8, 8));
        let extent = |points: &[DVec3], d: DVec3| points.iter().map(|p| p.dot(d)).fold(f64::NEG_INFINITY, f64::max);
        for normal in hull.normals() {
            let (own, whole) = (extent(&corners, normal), extent(&inset, normal) + BALL);
            assert!((own - whole).abs() < FACES, "{normal}: {whole} instead of {own}");
        }
        assert_eq!(hull.normals().count(), 6);
        // Where floor and slope n meet, the corner goes back by (1 + n_y)/n_x balls, and the ball comes forward by one.
        let slope = DVec3::new(0.003, 0.005, 0.0).normalize();
        let tip = 0.02 - BALL * ((1.0 + slope.y) / slope.x - 1.0);
        assert!((extent(&inset, DVec3::X) + BALL - tip).abs() < FACES, "{} instead of {tip}", extent(&inset, DVec3::X));
    }
}

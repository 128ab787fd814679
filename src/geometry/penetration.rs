//! Depth of overlapping convex cores: the expanding polytope algorithm.
//!
//! Where cores A and B overlap, the origin lies in their Minkowski difference A − B. The nearest point of its
//! surface, depth · n, is the shortest way out: B moved by it (or A moved back) leaves the two touching. The polytope
//! starts from the last simplex of `convex`. Its face nearest the origin is pushed out to the farthest corner along
//! its normal, until no corner lies farther (G. van den Bergen, Proximity Queries and Penetration Depth Computation
//! on 3D Game Objects, 2001).
//!
//! Capacity is fixed. A round body needs ever more faces. When they run out, the normal is refined by a search on its
//! sphere for a direction of less extent, h(n) = max (A − B)·n; the depth is the minimum of h.

use super::convex::{Corner, walk};
use super::support::Support;
use soffio_math::{DVec3, tangents};

/// How deep two cores overlap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Penetration {
    /// Length of the shortest way apart, m; negative by a rounding where they just touch.
    pub depth: f64,
    /// Unit: A moved along it by `depth` leaves B.
    pub normal: DVec3,
    /// The deepest point of A in B.
    pub a: DVec3,
    /// The deepest point of B in A.
    pub b: DVec3,
}

const MOST_CORNERS: usize = 64;
const MOST_FACES: usize = 2 * MOST_CORNERS;
/// The polytope is done when a corner lies outside its nearest face by no more than this, m or share of the depth.
const DONE: f64 = 1e-10;
const DONE_SHARE: f64 = 1e-6;
/// First and last step of the search for a better normal, rad: about the width of a face, and the root of [`DONE`].
const FIRST_STEP: f64 = 0.1;
const LAST_STEP: f64 = 1e-6;
/// Twice what halving from the first step to the last takes.
const MOST_STEPS: usize = 40;
/// A polytope flatter than this share of its size has no inside.
const FLAT: f64 = 1e-9;

#[derive(Clone, Copy, Default)]
struct Face {
    corners: [usize; 3],
    normal: DVec3,
    distance: f64,
}

struct Polytope {
    corners: [Corner; MOST_CORNERS],
    count: usize,
    faces: [Face; MOST_FACES],
    face_count: usize,
}

/// Depth of two cores that overlap or touch, given that [`super::convex::closest`] found no distance.
pub fn penetration(a: &(impl Support + ?Sized), b: &(impl Support + ?Sized)) -> Penetration {
    let start = walk(a, b);
    let mut corners = [Corner::default(); MOST_CORNERS];
    corners[..start.n].copy_from_slice(&start.simplex[..start.n]);
    let mut polytope = Polytope { corners, count: start.n, faces: [Face::default(); MOST_FACES], face_count: 0 };
    match polytope.fill(a, b) {
        Ok(()) => polytope.expand(a, b),
        Err(flat) => flat_overlap(a, b, flat),
    }
}

/// Cores whose difference is flat across `n` lie in one plane, or cross: they part along it at once.
fn flat_overlap(a: &(impl Support + ?Sized), b: &(impl Support + ?Sized), n: DVec3) -> Penetration {
    // The way apart is from B to A.
    let n = if (a.middle() - b.middle()).dot(n) < 0.0 { -n } else { n };
    let Corner { w, a, b } = Corner::farthest(a, b, -n);
    Penetration { depth: -w.dot(n), normal: n, a, b }
}

impl Polytope {
    /// Completes the simplex to a tetrahedron; else the normal of the plane (or of any that holds the line) in which
    /// the whole difference lies.
    fn fill(&mut self, a: &(impl Support + ?Sized), b: &(impl Support + ?Sized)) -> Result<(), DVec3> {
        let size = DVec3::AXES
            .iter()
            .fold(0.0, |size: f64, &d| size.max((Corner::farthest(a, b, d).w - Corner::farthest(a, b, -d).w).dot(d)));
        let flat = FLAT * size;
        let between = (a.middle() - b.middle()).try_normalize().unwrap_or(DVec3::Y);
        while self.count < 4 {
            let w = |k: usize| self.corners[k].w;
            let (u, v) = (w(1) - w(0), w(2) - w(0));
            // Directions across what there is, and a corner off it along one of them.
            let across: [DVec3; 3] = match self.count {
                1 => DVec3::AXES,
                2 => match u.try_normalize() {
                    Some(line) => {
                        let (t, s) = tangents(line);
                        [t, s, t + s]
                    }
                    None => DVec3::AXES,
                },
                _ => [u.cross(v).try_normalize().unwrap_or(DVec3::Y); 3],
            };
            let mut best: Option<(f64, Corner)> = None;
            for d in across.into_iter().flat_map(|d| [d, -d]) {
                let corner = Corner::farthest(a, b, d);
                let off = (corner.w - w(0)).dot(d);
                if off > flat && best.is_none_or(|(far, _)| off > far) {
                    best = Some((off, corner));
                }
            }
            let Some((_, corner)) = best else {
                return Err(match self.count {
                    1 => between,
                    // A line: the way across it that leads most between the middles.
                    2 => {
                        let line = u.normalize_or(DVec3::X);
                        (between - between.dot(line) * line).try_normalize().unwrap_or_else(|| tangents(line).0)
                    }
                    _ => across[0],
                });
            };
            self.corners[self.count] = corner;
            self.count += 1;
        }
        let w = |k: usize| self.corners[k].w;
        let normal = (w(1) - w(0)).cross(w(2) - w(0));
        let height = (w(3) - w(0)).dot(normal);
        if height.abs() <= flat * normal.length() {
            // The walk ended on a sliver: keep its widest triangle's plane and look off it.
            let n = normal.try_normalize().unwrap_or(between);
            self.count = 3;
            let (up, down) = (Corner::farthest(a, b, n), Corner::farthest(a, b, -n));
            let off = |c: &Corner| (c.w - w(0)).dot(n).abs();
            let corner = if off(&up) >= off(&down) { up } else { down };
            if off(&corner) <= flat || normal.length() <= flat * flat {
                return Err(n);
            }
            self.corners[3] = corner;
            self.count = 4;
        }
        let w = |k: usize| self.corners[k].w;
        if (w(3) - w(0)).dot((w(1) - w(0)).cross(w(2) - w(0))) > 0.0 {
            self.corners.swap(1, 2);
        }
        // Corner 3 lies below the face 0, 1, 2.
        for face in [[0, 1, 2], [0, 3, 1], [1, 3, 2], [2, 3, 0]] {
            self.add(face);
        }
        Ok(())
    }

    /// Adds a face with its corners counter-clockwise from outside.
    fn add(&mut self, corners: [usize; 3]) -> bool {
        let [p, q, r] = corners.map(|k| self.corners[k].w);
        let Some(normal) = (q - p).cross(r - p).try_normalize() else { return false };
        if self.face_count == MOST_FACES {
            return false;
        }
        self.faces[self.face_count] = Face { corners, normal, distance: normal.dot(p) };
        self.face_count += 1;
        true
    }

    fn nearest(&self) -> Face {
        let faces = &self.faces[..self.face_count];
        faces.iter().skip(1).fold(faces[0], |best, face| if face.distance < best.distance { *face } else { best })
    }

    fn expand(&mut self, a: &(impl Support + ?Sized), b: &(impl Support + ?Sized)) -> Penetration {
        let mut face = self.nearest();
        let mut ends = self.corners_of(&face);
        // Each round adds a corner, so there are few.
        while self.count < MOST_CORNERS {
            let corner = Corner::farthest(a, b, face.normal);
            let farther = corner.w.dot(face.normal) - face.distance;
            if farther <= DONE.max(DONE_SHARE * face.distance) || !self.push_out(corner) {
                break;
            }
            face = self.nearest();
            ends = self.corners_of(&face);
        }
        // The farthest corner along the normal bounds the depth from above, whatever the polytope lacks.
        let extent = |n: DVec3| Corner::farthest(a, b, n).w.dot(n);
        let (mut out, mut depth) = (face.normal, extent(face.normal));
        if depth - face.distance > DONE.max(DONE_SHARE * face.distance) {
            for other in &self.faces[..self.face_count] {
                let along = extent(other.normal);
                if along < depth {
                    (out, depth) = (other.normal, along);
                }
            }
            (out, depth) = least_extent(extent, out, depth);
        }
        let [u, v, t] = weights(ends.map(|c| c.w), out * face.distance);
        let (pa, pb) = (u * ends[0].a + v * ends[1].a + t * ends[2].a, u * ends[0].b + v * ends[1].b + t * ends[2].b);
        Penetration { depth, normal: -out, a: pa, b: pb }
    }

    fn corners_of(&self, face: &Face) -> [Corner; 3] {
        face.corners.map(|k| self.corners[k])
    }

    /// Replaces the faces that see a corner by a cone from their rim to it; false where that fails.
    fn push_out(&mut self, corner: Corner) -> bool {
        let sees = |face: &Face| face.normal.dot(corner.w) - face.distance > 0.0;
        let mut rim = [(0, 0); 3 * MOST_FACES];
        let mut rim_count = 0;
        let mut kept = 0;
        for k in 0..self.face_count {
            let face = self.faces[k];
            if !sees(&face) {
                self.faces[kept] = face;
                kept += 1;
                continue;
            }
            let [p, q, r] = face.corners;
            for edge in [(p, q), (q, r), (r, p)] {
                // An edge that two of these faces share is inside.
                match rim[..rim_count].iter().position(|&other| other == (edge.1, edge.0)) {
                    Some(at) => {
                        rim_count -= 1;
                        rim[at] = rim[rim_count];
                    }
                    None => {
                        rim[rim_count] = edge;
                        rim_count += 1;
                    }
                }
            }
        }
        self.face_count = kept;
        let tip = self.count;
        self.corners[tip] = corner;
        self.count += 1;
        rim[..rim_count].iter().all(|&(p, q)| self.add([p, q, tip])) && rim_count > 2
    }
}

/// A direction of locally least extent near `n`, whose own is `least`: a compass search on the sphere.
fn least_extent(extent: impl Fn(DVec3) -> f64, mut n: DVec3, mut least: f64) -> (DVec3, f64) {
    let mut step = FIRST_STEP;
    for _ in 0..MOST_STEPS {
        if step < LAST_STEP {
            break;
        }
        let (t, b) = tangents(n);
        let tries = [t, b, t + b, t - b].into_iter().flat_map(|d| [d, -d]).map(|d| (n + step * d).normalize());
        let best = tries.map(|d| (extent(d), d)).fold((least, n), |best, new| if new.0 < best.0 { new } else { best });
        if best.0 < least {
            (least, n) = best;
        } else {
            step *= 0.5;
        }
    }
    (n, least)
}

/// Weights of a point of a triangle's plane.
fn weights([p, q, r]: [DVec3; 3], at: DVec3) -> [f64; 3] {
    let (u, v, w) = (q - p, r - p, at - p);
    let (uu, uv, vv, wu, wv) = (u.dot(u), u.dot(v), v.dot(v), w.dot(u), w.dot(v));
    let all = uu * vv - uv * uv;
    if all <= 0.0 {
        return [1.0, 0.0, 0.0];
    }
    let s = ((vv * wu - uv * wv) / all).clamp(0.0, 1.0);
    let t = ((uu * wv - uv * wu) / all).clamp(0.0, 1.0 - s);
    [1.0 - s - t, s, t]
}

//! Distance of convex cores: the Gilbert–Johnson–Keerthi algorithm.
//!
//! The Minkowski difference A − B = { a − b } of two convex sets is convex, and its point nearest the origin gives
//! their distance and closest points. GJK (Gilbert, Johnson, Keerthi 1988) walks there with a simplex of at most four
//! corners, each found by a support query: the farthest corner in a direction. The nearest point of a simplex is
//! found by Voronoi regions (C. Ericson, Real-Time Collision Detection, 2005, section 5.1).
//!
//! The walk needs nothing of a core but its support map, so round cores are as exact as angular ones.

use super::support::Support;
use soffio_math::DVec3;

/// Nearest points of two convex cores.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Closest {
    /// Distance, m; 0 where they overlap.
    pub distance: f64,
    /// Point of the first core.
    pub a: DVec3,
    /// Point of the second core.
    pub b: DVec3,
}

/// A support query stops bringing the simplex nearer when it gains less than this share of the squared distance.
const GAIN: f64 = 1e-12;
/// Below this squared distance (m²) cores are taken to overlap: 1e-9 m, far under any radius in use.
const TOUCHING: f64 = 1e-18;
/// GJK ends in fewer rounds than this on any input; the bound guards against rounding cycles.
const ROUNDS: usize = 128;

/// A corner of the Minkowski difference and the points it came from.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Corner {
    /// a − b.
    pub w: DVec3,
    /// Its point on A, m.
    pub a: DVec3,
    /// Its point on B, m.
    pub b: DVec3,
}

impl Corner {
    /// The farthest corner of A − B along `d`.
    pub fn farthest(a: &(impl Support + ?Sized), b: &(impl Support + ?Sized), d: DVec3) -> Self {
        let (a, b) = (a.support(d), b.support(-d));
        Self { w: a - b, a, b }
    }
}

/// Where the walk ended: the simplex whose nearest point to the origin is v = Σ weight · w.
#[derive(Clone, Copy, Debug)]
pub(super) struct Walk {
    /// Corners of the simplex; the first `n` are used.
    pub simplex: [Corner; 4],
    /// Weight of each corner; they are positive and sum to 1.
    pub weights: [f64; 4],
    /// Number of corners, 1 to 4.
    pub n: usize,
    /// v, the point of the simplex nearest to the origin, m.
    pub v: DVec3,
}

/// Closest points of two convex cores.
pub fn closest(a: &(impl Support + ?Sized), b: &(impl Support + ?Sized)) -> Closest {
    let walk = walk(a, b);
    let Walk { simplex, weights, n, v } = &walk;
    let (pa, pb) = (combine(simplex, weights, *n, |c| c.a), combine(simplex, weights, *n, |c| c.b));
    Closest { distance: if walk.overlaps() { 0.0 } else { v.length() }, a: pa, b: pb }
}

impl Walk {
    /// Do the cores overlap or touch?
    pub fn overlaps(&self) -> bool {
        self.v.length_squared() <= TOUCHING
    }
}

pub(super) fn walk(a: &(impl Support + ?Sized), b: &(impl Support + ?Sized)) -> Walk {
    let mut simplex = [Corner::default(); 4];
    let mut weights = [0.0; 4];
    simplex[0] = Corner::farthest(a, b, b.middle() - a.middle());
    weights[0] = 1.0;
    let mut n = 1;
    let mut v = simplex[0].w;
    for _ in 0..ROUNDS {
        let distance2 = v.length_squared();
        if distance2 <= TOUCHING {
            break;
        }
        let corner = Corner::farthest(a, b, -v);
        // v·w is a lower bound of the squared distance: no corner lies nearer along v.
        if distance2 - v.dot(corner.w) <= GAIN * distance2 || simplex[..n].iter().any(|c| c.w == corner.w) {
            break;
        }
        let (before, weights_before, n_before) = (simplex, weights, n);
        simplex[n] = corner;
        n += 1;
        reduce(&mut simplex, &mut weights, &mut n);
        let mut next = combine(&simplex, &weights, n, |c| c.w);
        if next.length_squared() >= distance2 {
            // Round bodies give corners so close together that rounding picks the wrong face. The way from v, a point
            // of the difference itself, to the new corner always leads nearer.
            let of = |of: fn(&Corner) -> DVec3| combine(&before, &weights_before, n_before, of);
            simplex[0] = Corner { w: v, a: of(|c| c.a), b: of(|c| c.b) };
            simplex[1] = corner;
            n = 2;
            reduce(&mut simplex, &mut weights, &mut n);
            next = combine(&simplex, &weights, n, |c| c.w);
        }
        if next.length_squared() >= distance2 {
            // No progress beyond rounding. The former simplex is the better answer.
            (simplex, weights, n) = (before, weights_before, n_before);
            break;
        }
        v = next;
        if n == 4 {
            break;
        }
    }
    Walk { simplex, weights, n, v }
}

fn combine(simplex: &[Corner; 4], weights: &[f64; 4], n: usize, of: impl Fn(&Corner) -> DVec3) -> DVec3 {
    (0..n).fold(DVec3::ZERO, |sum, k| sum + weights[k] * of(&simplex[k]))
}

/// Keeps the corners of the simplex's face nearest the origin, with the weights of the nearest point.
fn reduce(simplex: &mut [Corner; 4], weights: &mut [f64; 4], n: &mut usize) {
    let w = simplex.map(|c| c.w);
    let (kept, count, bary) = match *n {
        2 => segment(&w, [0, 1]),
        3 => triangle(&w, [0, 1, 2]),
        _ => tetrahedron(&w),
    };
    let old = *simplex;
    for k in 0..count {
        simplex[k] = old[kept[k]];
        weights[k] = bary[k];
    }
    *n = count;
}

/// Indices kept, how many, and their weights.
type Face = ([usize; 4], usize, [f64; 4]);

fn vertex(i: usize) -> Face {
    ([i, 0, 0, 0], 1, [1.0, 0.0, 0.0, 0.0])
}

fn segment(w: &[DVec3; 4], [i, j]: [usize; 2]) -> Face {
    let ab = w[j] - w[i];
    let (t, length2) = (-w[i].dot(ab), ab.length_squared());
    if t <= 0.0 || length2 == 0.0 {
        vertex(i)
    } else if t >= length2 {
        vertex(j)
    } else {
        let s = t / length2;
        ([i, j, 0, 0], 2, [1.0 - s, s, 0.0, 0.0])
    }
}

fn triangle(w: &[DVec3; 4], [i, j, k]: [usize; 3]) -> Face {
    let (a, b, c) = (w[i], w[j], w[k]);
    let (ab, ac) = (b - a, c - a);
    let (d1, d2) = (-ab.dot(a), -ac.dot(a));
    if d1 <= 0.0 && d2 <= 0.0 {
        return vertex(i);
    }
    let (d3, d4) = (-ab.dot(b), -ac.dot(b));
    if d3 >= 0.0 && d4 <= d3 {
        return vertex(j);
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return segment(w, [i, j]);
    }
    let (d5, d6) = (-ab.dot(c), -ac.dot(c));
    if d6 >= 0.0 && d5 <= d6 {
        return vertex(k);
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return segment(w, [i, k]);
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 {
        return segment(w, [j, k]);
    }
    let denominator = va + vb + vc;
    if denominator <= 0.0 {
        // Corners in a line: the nearest of the three edges.
        return nearest(w, [segment(w, [i, j]), segment(w, [i, k]), segment(w, [j, k])]);
    }
    let (s, t) = (vb / denominator, vc / denominator);
    ([i, j, k, 0], 3, [1.0 - s - t, s, t, 0.0])
}

fn tetrahedron(w: &[DVec3; 4]) -> Face {
    let faces = [[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]];
    let opposite = [3, 1, 2, 0];
    // The origin is inside when it lies on the same side of each face as the corner opposite.
    let outside = |[i, j, k]: [usize; 3], far: usize| {
        let normal = (w[j] - w[i]).cross(w[k] - w[i]);
        let (origin, corner) = (-normal.dot(w[i]), normal.dot(w[far] - w[i]));
        // A flat tetrahedron has no inside: every face may hold the nearest point.
        origin * corner < 0.0 || corner.abs() <= 1e-300
    };
    let mut candidates = [vertex(0); 4];
    let mut count = 0;
    for (face, far) in faces.into_iter().zip(opposite) {
        if outside(face, far) {
            candidates[count] = triangle(w, face);
            count += 1;
        }
    }
    if count == 0 {
        let within = inside(w);
        if point(w, &within).length_squared() <= TOUCHING && within.2.iter().all(|&weight| weight >= 0.0) {
            return within;
        }
        // A sliver whose sides rounding cannot distinguish: the weights prove an inside.
        candidates = faces.map(|face| triangle(w, face));
        count = 4;
    }
    candidates[1..count].iter().fold(candidates[0], |best, &next| nearest(w, [best, next]))
}

/// Weights of the origin inside a tetrahedron.
fn inside(w: &[DVec3; 4]) -> Face {
    let volume = |a: DVec3, b: DVec3, c: DVec3| a.dot(b.cross(c));
    let all = volume(w[1] - w[0], w[2] - w[0], w[3] - w[0]);
    let u = volume(-w[0], w[2] - w[0], w[3] - w[0]) / all;
    let v = volume(w[1] - w[0], -w[0], w[3] - w[0]) / all;
    let t = volume(w[1] - w[0], w[2] - w[0], -w[0]) / all;
    ([0, 1, 2, 3], 4, [1.0 - u - v - t, u, v, t])
}

/// The point that a face's weights make.
fn point(w: &[DVec3; 4], face: &Face) -> DVec3 {
    (0..face.1).fold(DVec3::ZERO, |sum, k| sum + face.2[k] * w[face.0[k]])
}

fn nearest<const N: usize>(w: &[DVec3; 4], faces: [Face; N]) -> Face {
    let distance2 = |face: &Face| point(w, face).length_squared();
    let mut best = faces[0];
    for face in &faces[1..] {
        if distance2(face) < distance2(&best) {
            best = *face;
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::support::Support;
    use soffio_math::noise::Random;

    /// GJK stops when a step gains under 1e-12 of the squared distance: the distance is good to about its root.
    const GJK_RELATIVE: f64 = 1e-5;

    /// An independent reference: Frank–Wolfe with exact line search over the two hulls, slow but simple.
    fn reference(a: &[DVec3], b: &[DVec3]) -> f64 {
        let (mut p, mut q) = (a[0], b[0]);
        for _ in 0..20_000 {
            let v = p - q;
            let (sa, sb) = (a.support(-v), b.support(v));
            let d = (sa - sb) - v;
            if d.length_squared() < 1e-30 {
                break;
            }
            let s = (-v.dot(d) / d.length_squared()).clamp(0.0, 1.0);
            p += s * (sa - p);
            q += s * (sb - q);
        }
        (p - q).length()
    }

    #[test]
    fn distance_agrees_with_a_slow_independent_search() {
        // Frank–Wolfe converges as 1/steps: good to a per mille here, and never below the true distance.
        const SEARCH_RELATIVE: f64 = 2e-3;
        for seed in 0..200 {
            let mut random = Random::new(seed);
            let cloud = |random: &mut Random, count: usize, center: DVec3| -> Vec<DVec3> {
                (0..count).map(|_| center + DVec3::new(random.signed(), random.signed(), random.signed())).collect()
            };
            let count = 1 + (seed % 7) as usize;
            let a = cloud(&mut random, count, DVec3::ZERO);
            let b = cloud(&mut random, 8 - count, DVec3::new(3.0, 0.5, -0.4));
            let found = closest(&a[..], &b[..]);
            let slow = reference(&a, &b);
            assert!(
                found.distance <= slow * (1.0 + GJK_RELATIVE) && found.distance >= slow * (1.0 - SEARCH_RELATIVE),
                "seed {seed}: {} against {slow}",
                found.distance
            );
            assert!(((found.a - found.b).length() - found.distance).abs() < 1e-9, "seed {seed}: points disagree");
        }
    }

    #[test]
    fn parallel_plates_and_crossing_rods_are_exact() {
        let square =
            |z: f64| [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[x, y]: [f64; 2]| DVec3::new(x, y, z));
        assert!((closest(&square(0.0)[..], &square(0.25)[..]).distance - 0.25).abs() < 1e-15);
        let rod_x = [DVec3::new(-1.0, 0.0, 0.0), DVec3::new(1.0, 0.0, 0.0)];
        let rod_y = [DVec3::new(0.3, -1.0, 0.5), DVec3::new(0.3, 1.0, 0.5)];
        let found = closest(&rod_x[..], &rod_y[..]);
        assert!((found.distance - 0.5).abs() < 1e-15);
        assert!((found.a - DVec3::new(0.3, 0.0, 0.0)).length() < 1e-12);
    }

    #[test]
    fn overlapping_cores_have_distance_zero() {
        let cube = |center: DVec3| -> Vec<DVec3> {
            (0..8)
                .map(|i| center + DVec3::new((i & 1) as f64, (i >> 1 & 1) as f64, (i >> 2) as f64) - DVec3::splat(0.5))
                .collect()
        };
        assert_eq!(closest(&cube(DVec3::ZERO)[..], &cube(DVec3::new(0.3, 0.2, 0.1))[..]).distance, 0.0);
    }
}

//! Contact manifolds of resting shapes, by clipping the features that face each other (I. Sutherland, G. Hodgman
//! 1974).
//!
//! Along the contact normal n each core shows a point, an edge or a face (what leans by little counts as lying,
//! `geometry::support`). A face is clipped by the side planes of the other (I. Sutherland and G. Hodgman 1974), an
//! edge by a face or by a parallel edge; the remainder are points of one surface, each with the point of the other
//! straight across, and a gap along n between. Four are kept of more: the outermost of the deepest, the farthest from it, and
//! the farthest off their line on either side.

use super::proximity::{Proximity, of_placed};
use super::shape::Collider;
use soffio_geometry::support::{Placed, RIM_CORNERS};
use soffio_math::{DVec3, Pose};

/// Edges whose directions make a smaller sine lie along each other.
const ALONG: f64 = 0.01;
/// Gaps nearer to each other than this are equal, m: which is deepest must not hang on rounding.
const LEVEL: f64 = 1e-9;
/// Features that miss the nearest gap by more than this do not hold the nearest point, m.
const MISSED: f64 = 1e-7;
/// Corners are kept so far outside the other face, m: where two faces end together, a corner stays the point of contact, and does
/// not jump to where edges cross.
const OUTSIDE: f64 = 1e-6;
/// Points nearer to each other than this are one, m.
const SAME: f64 = 1e-9;

/// Most points of a [`Manifold`]: enough to hold a face on a face.
pub const MANIFOLD_POINTS: usize = 4;

/// One point of a manifold.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ManifoldPoint {
    /// World, midway between the two surfaces, m.
    pub point: DVec3,
    /// Distance of the two surfaces along the manifold's normal there, m; negative where they overlap.
    pub gap: f64,
}

/// Where two colliders that lie on each other touch.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Manifold {
    /// Unit, from the second to the first.
    pub normal: DVec3,
    /// The points; those from `count` on mean nothing.
    pub points: [ManifoldPoint; MANIFOLD_POINTS],
    /// How many there are: one at least.
    pub count: usize,
}

impl Manifold {
    /// The points there are, in an order that stays while the features that touch stay.
    pub fn points(&self) -> &[ManifoldPoint] {
        &self.points[..self.count]
    }
}

/// Room for the features of two colliders and what is clipped of them, kept so that nothing allocates in the step.
#[derive(Clone, Debug, Default)]
pub struct ManifoldBuilder {
    a: Vec<DVec3>,
    b: Vec<DVec3>,
    clipped: Vec<DVec3>,
    spare: Vec<DVec3>,
    points: Vec<ManifoldPoint>,
}

impl ManifoldBuilder {
    /// Room for the largest features of these colliders.
    pub fn new(colliders: &[Collider]) -> Self {
        let most = colliders.iter().map(|c| c.shape.most_corners()).max().unwrap_or(0).max(RIM_CORNERS);
        // Each side plane adds a corner at most.
        let clipped = || Vec::with_capacity(2 * most + 1);
        Self {
            a: Vec::with_capacity(most),
            b: Vec::with_capacity(most),
            clipped: clipped(),
            spare: clipped(),
            points: Vec::with_capacity(2 * most + 1),
        }
    }

    /// Proximity of two colliders with their bodies at these poses.
    pub fn proximity(&self, a: &Collider, pose_a: &Pose, b: &Collider, pose_b: &Pose) -> Proximity {
        super::proximity::proximity(&a.shape, pose_a, &b.shape, pose_b)
    }

    /// Up to four points of contact of two colliders with their bodies at these poses, the deepest among them.
    pub fn manifold(&mut self, a: &Collider, pose_a: &Pose, b: &Collider, pose_b: &Pose) -> Manifold {
        let (radius_a, radius_b) = (a.shape.radius, b.shape.radius);
        let (a, b) = (a.shape.placed(pose_a), b.shape.placed(pose_b));
        let nearest = of_placed(&a, radius_a, &b, radius_b);
        self.points.clear();
        self.collect(&a, &b, nearest.normal);
        let n = nearest.normal;
        for at in &mut self.points {
            at.gap -= radius_a + radius_b;
            at.point += 0.5 * (radius_b - radius_a) * n;
        }
        let least = self.points.iter().map(|p| p.gap).fold(f64::INFINITY, f64::min);
        if least > nearest.gap + MISSED {
            // The features that lie across miss the nearest point, or there is no more than it.
            if self.points.len() < 2 {
                self.points.clear();
            }
            self.points.push(ManifoldPoint { point: nearest.point, gap: nearest.gap });
        }
        four_of(&self.points, n)
    }

    /// Points of the cores that lie across each other along `n`: midway, with the gap of the cores.
    fn collect(&mut self, a: &Placed, b: &Placed, n: DVec3) {
        let normal_a = a.feature(-n, &mut self.a);
        let normal_b = b.feature(n, &mut self.b);
        // Clip what is no face by what is; of two faces the flatter holds the planes.
        let by_a = match (normal_a, normal_b) {
            (Some(of_a), Some(of_b)) => self.a.is_empty() || (!self.b.is_empty() && -of_a.dot(n) > of_b.dot(n) + LEVEL),
            (face, _) => face.is_some(),
        };
        let (face, own, origin) = if by_a { (normal_a, &self.a, a.origin) } else { (normal_b, &self.b, b.origin) };
        let other = if by_a { &self.b } else { &self.a };
        let Some(face) = face else {
            if let ([p, q], [r, s]) = (&self.a[..], &self.b[..]) {
                edges([*p, *q], [*r, *s], n, &mut self.points);
            }
            return;
        };
        if other.len() < 2 {
            return;
        }
        self.clipped.clear();
        self.clipped.extend_from_slice(other);
        // Side planes along n, so that the remainder has the face straight across.
        let up = n * face.dot(n).signum();
        for (k, &p) in own.iter().enumerate() {
            let q = own[(k + 1) % own.len()];
            let inward = up.cross(q - p);
            clip(&self.clipped, p, inward, other.len() == 2, &mut self.spare);
            std::mem::swap(&mut self.clipped, &mut self.spare);
        }
        let through = own.first().copied().unwrap_or(origin);
        for &p in &self.clipped {
            // Straight across along n, in the face's plane.
            let across = p + n * ((through - p).dot(face) / n.dot(face));
            let (pa, pb) = if by_a { (across, p) } else { (p, across) };
            let point = 0.5 * (pa + pb);
            if !self.points.iter().any(|known| known.point.distance_squared(point) < SAME * SAME) {
                self.points.push(ManifoldPoint { point, gap: (pa - pb).dot(n) });
            }
        }
    }
}

/// What of a polygon (or an edge) lies on the inner side of the plane through `p` across `inward`, about.
fn clip(polygon: &[DVec3], p: DVec3, inward: DVec3, edge: bool, left: &mut Vec<DVec3>) {
    left.clear();
    let inside = |q: DVec3| (q - p).dot(inward);
    let out = |at: f64| at < -OUTSIDE * inward.length();
    let last = if edge { polygon.len().saturating_sub(1) } else { polygon.len() };
    for k in 0..last {
        let (q, r) = (polygon[k], polygon[(k + 1) % polygon.len()]);
        let (at_q, at_r) = (inside(q), inside(r));
        if !out(at_q) {
            left.push(q);
        }
        if out(at_q) != out(at_r) && (at_q < 0.0) != (at_r < 0.0) {
            left.push(q + (r - q) * (at_q / (at_q - at_r)));
        }
    }
    if edge
        && let Some(&r) = polygon.last()
        && !out(inside(r))
        && last > 0
    {
        left.push(r);
    }
}

/// Both ends of what two edges share, where they lie along each other.
fn edges([p, q]: [DVec3; 2], [r, s]: [DVec3; 2], n: DVec3, points: &mut Vec<ManifoldPoint>) {
    let (u, v) = (q - p, s - r);
    if u.cross(v).length_squared() > ALONG * ALONG * u.length_squared() * v.length_squared() {
        return;
    }
    // Shares of the first edge at which the second begins and ends.
    let parameter = |x: DVec3| (x - p).dot(u) / u.length_squared();
    let (from, to) = (parameter(r), parameter(s));
    let (low, high) = (from.min(to).max(0.0), from.max(to).min(1.0));
    if high <= low {
        return;
    }
    for at in [low, high] {
        let pa = p + at * u;
        let pb = r + v * ((at - from) / (to - from));
        points.push(ManifoldPoint { point: 0.5 * (pa + pb), gap: (pa - pb).dot(n) });
    }
}

/// The four points that hold best, in the order they came.
fn four_of(points: &[ManifoldPoint], normal: DVec3) -> Manifold {
    let mut manifold = Manifold { normal, ..Manifold::default() };
    let mut keep = |index: &[usize]| {
        let mut index: [usize; super::MANIFOLD_POINTS] =
            std::array::from_fn(|k| index.get(k).copied().unwrap_or(usize::MAX));
        index.sort_unstable();
        for i in index.into_iter().filter(|&i| i < points.len()) {
            manifold.points[manifold.count] = points[i];
            manifold.count += 1;
        }
    };
    if points.len() <= super::MANIFOLD_POINTS {
        keep(&[0, 1, 2, 3]);
        return manifold;
    }
    // The first of equals each time.
    let best = |of: &dyn Fn(&ManifoldPoint) -> f64, margin: f64| {
        (1..points.len()).fold(0, |best, i| if of(&points[i]) > of(&points[best]) + margin { i } else { best })
    };
    // Of two squares that lie on each other almost as one, corners rather than where edges cross.
    let least = points.iter().fold(f64::INFINITY, |least, p| least.min(p.gap));
    let middle = points.iter().map(|p| p.point).sum::<DVec3>() / points.len() as f64;
    let first = best(&|p| if p.gap <= least + LEVEL { p.point.distance(middle) } else { -1.0 }, LEVEL);
    let from = points[first].point;
    let second = best(&|p| p.point.distance(from), LEVEL);
    let line = points[second].point - from;
    let beside = |p: &ManifoldPoint| line.cross(p.point - from).dot(normal);
    let area = LEVEL * line.length();
    let (third, fourth) = (best(&|p| beside(p), area), best(&|p| -beside(p), area));
    let mut chosen = [first, second, usize::MAX, usize::MAX];
    if beside(&points[third]) > area {
        chosen[2] = third;
    }
    if -beside(&points[fourth]) > area {
        chosen[3] = fourth;
    }
    keep(&chosen);
    manifold
}

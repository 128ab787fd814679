//! Distance of two shapes: closed forms where there are good ones, else support maps.
//!
//! All is about cores; the balls come off at the end. `d` is the signed distance of the cores along the unit normal
//! n from B to A, and `a`, `b` the points of the cores that realise it: a − b = d n.
//!
//! | pair of cores | apart | overlapping |
//! |---|---|---|
//! | any – half-space | support map of the other | the same |
//! | point – point, segment, box, cylinder | clamping in the other's frame | nearest face |
//! | segment – segment | Ericson 2005, 5.1.9 | – |
//! | cylinder – cylinder or segment, axes parallel | radial and axial gaps | the lesser overlap |
//! | box – box or segment | GJK | separating axes (Gottschalk et al. 1996) |
//! | all others | GJK | expanding polytope |

use super::shape::Shape;
use soffio_geometry::convex::{self, Closest};
use soffio_geometry::penetration;
use soffio_geometry::support::{Core, Placed, Support};
use soffio_math::{DVec3, Pose, tangents};

/// Cores nearer than this have no direction between them, m.
const COINCIDENT: f64 = 1e-9;
/// Axes whose cross product is shorter than this are parallel: over a metre they part by a nanometre.
const PARALLEL: f64 = 1e-9;
/// An edge–edge axis must beat the face axes by this share of the overlap: faces carry more points.
const FACE_PREFERENCE: f64 = 1e-6;

/// How two colliders lie to each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Proximity {
    /// Distance of the two surfaces, m; negative where they overlap.
    pub gap: f64,
    /// Unit, from the second to the first.
    pub normal: DVec3,
    /// Between the two surfaces, world, m.
    pub point: DVec3,
}

/// Signed distance of cores.
#[derive(Clone, Copy, Debug)]
struct Near {
    d: f64,
    normal: DVec3,
    a: DVec3,
    b: DVec3,
}

impl Near {
    fn flipped(self) -> Self {
        Self { d: self.d, normal: -self.normal, a: self.b, b: self.a }
    }

    /// From two points with a way between; a coincident pair parts along `else_along`.
    fn points(a: DVec3, b: DVec3, else_along: DVec3) -> Self {
        let d = a.distance(b);
        let normal = if d > COINCIDENT { (a - b) / d } else { else_along };
        Self { d, normal, a, b }
    }
}

/// Proximity of two shapes with their bodies at these poses.
pub fn proximity(a: &Shape, pose_a: &Pose, b: &Shape, pose_b: &Pose) -> Proximity {
    of_placed(&a.placed(pose_a), a.radius, &b.placed(pose_b), b.radius)
}

/// Proximity of two placed cores with balls of these radii (m) around.
pub(super) fn of_placed(a: &Placed, radius_a: f64, b: &Placed, radius_b: f64) -> Proximity {
    let Near { d, normal, a, b } = near(a, b);
    let point = 0.5 * ((a - radius_a * normal) + (b + radius_b * normal));
    Proximity { gap: d - radius_a - radius_b, normal, point }
}

fn near(a: &Placed, b: &Placed) -> Near {
    match (a.core, b.core) {
        (Core::HalfSpace, Core::HalfSpace) => {
            // Both stand still: never a pair. Whatever is asked, they do not meet.
            Near { d: f64::INFINITY, normal: DVec3::Y, a: a.origin, b: b.origin }
        }
        (_, Core::HalfSpace) => on_half_space(a, b),
        (Core::HalfSpace, _) => on_half_space(b, a).flipped(),
        (Core::Point, Core::Point) => Near::points(a.origin, b.origin, DVec3::Y),
        (Core::Point, Core::Segment { .. } | Core::Box { .. } | Core::Cylinder { .. }) => of_point(a.origin, b),
        (Core::Segment { .. } | Core::Box { .. } | Core::Cylinder { .. }, Core::Point) => {
            of_point(b.origin, a).flipped()
        }
        (&Core::Segment { half: h }, &Core::Segment { half: k }) => segments(a, h, b, k),
        _ => {
            if let (Some(first), Some(second)) = (round(a.core), round(b.core))
                && a.axes.y_axis.cross(b.axes.y_axis).length_squared() <= PARALLEL * PARALLEL
            {
                return parallel_cylinders((a, first), (b, second));
            }
            let Closest { distance, a: near_a, b: near_b } = convex::closest(a, b);
            if distance > COINCIDENT {
                return Near { d: distance, normal: (near_a - near_b) / distance, a: near_a, b: near_b };
            }
            match (edges(a.core), edges(b.core)) {
                (Some(half_a), Some(half_b)) => boxes(a, half_a, b, half_b),
                _ => {
                    let found = penetration::penetration(a, b);
                    Near { d: -found.depth, normal: found.normal, a: found.a, b: found.b }
                }
            }
        }
    }
}

/// Half height and radius of what is round about Y.
fn round(core: &Core) -> Option<(f64, f64)> {
    match *core {
        Core::Segment { half } => Some((half, 0.0)),
        Core::Cylinder { half, radius } => Some((half, radius)),
        _ => None,
    }
}

/// Half edges of what is a box, or one without width.
fn edges(core: &Core) -> Option<DVec3> {
    match *core {
        Core::Segment { half } => Some(DVec3::Y * half),
        Core::Box { half } => Some(half),
        _ => None,
    }
}

fn on_half_space(a: &Placed, plane: &Placed) -> Near {
    let normal = plane.axes.y_axis;
    let deepest = a.support(-normal);
    let d = (deepest - plane.origin).dot(normal);
    Near { d, normal, a: deepest, b: deepest - d * normal }
}

/// A point against a core with a frame: clamped onto it from outside, to the nearest face from inside.
fn of_point(p: DVec3, b: &Placed) -> Near {
    let l = b.local(p - b.origin);
    let sign = |x: f64| if x < 0.0 { -1.0 } else { 1.0 };
    // The nearest point of the core, and the way out through the nearest face and how far it is (negative outside).
    let (foot, depth, out) = match *b.core {
        Core::Box { half } => {
            let depths = half - l.abs();
            let k = if depths.min_element() >= 0.0 { depths.min_position() } else { depths.abs().min_position() };
            let mut out = DVec3::ZERO;
            out[k] = sign(l[k]);
            (l.clamp(-half, half), depths.min_element(), out)
        }
        Core::Cylinder { half, radius } => {
            let across = (l.x * l.x + l.z * l.z).sqrt();
            let outward = if across > 0.0 { DVec3::new(l.x, 0.0, l.z) / across } else { DVec3::X };
            let (side, end) = (radius - across, half - l.y.abs());
            let foot = outward * across.min(radius) + DVec3::Y * l.y.clamp(-half, half);
            let sideways = if side.min(end) >= 0.0 { side < end } else { side.abs() < end.abs() };
            (foot, side.min(end), if sideways { outward } else { DVec3::Y * sign(l.y) })
        }
        Core::Segment { half } => (DVec3::Y * l.y.clamp(-half, half), -1.0, DVec3::X),
        _ => (DVec3::ZERO, -1.0, DVec3::Y),
    };
    let out = b.axes * out;
    if depth >= 0.0 {
        Near { d: -depth, normal: out, a: p, b: p + depth * out }
    } else {
        Near::points(p, b.world(foot), out)
    }
}

/// Two segments: the interior minimum, clamped. Parallel ones meet in the middle of what they share.
fn segments(a: &Placed, half_a: f64, b: &Placed, half_b: f64) -> Near {
    let (u, v, c) = (a.axes.y_axis, b.axes.y_axis, a.origin - b.origin);
    let (cu, cv, uv) = (c.dot(u), c.dot(v), u.dot(v));
    let cross = u.cross(v);
    let sine2 = cross.length_squared();
    let (s, t);
    if sine2 <= PARALLEL * PARALLEL {
        // On the axis of B: A covers cv ± half_a, B ± half_b.
        let (low, high) = ((cv - half_a).max(-half_b), (cv + half_a).min(half_b));
        let middle = (0.5 * (low + high)).clamp(-half_b, half_b);
        t = middle;
        s = ((middle - cv) * uv.signum()).clamp(-half_a, half_a);
    } else {
        let first = ((uv * cv - cu) / sine2).clamp(-half_a, half_a);
        let other = cv + first * uv;
        t = other.clamp(-half_b, half_b);
        s = if t == other { first } else { (t * uv - cu).clamp(-half_a, half_a) };
    }
    let apart = cross.try_normalize().unwrap_or_else(|| tangents(u).0);
    Near::points(a.origin + s * u, b.origin + t * v, apart)
}

/// Two cylinders with parallel axes: their gaps across and along.
fn parallel_cylinders((a, (half_a, ra)): (&Placed, (f64, f64)), (b, (half_b, rb)): (&Placed, (f64, f64))) -> Near {
    let axis = a.axes.y_axis;
    let c = a.origin - b.origin;
    let h = c.dot(axis);
    let lateral = c - h * axis;
    let l = lateral.length();
    let out = if l > 0.0 { lateral / l } else { tangents(axis).0 };
    let up = if h < 0.0 { -1.0 } else { 1.0 };
    let (across, along) = (l - ra - rb, h.abs() - half_a - half_b);
    // Middles of what they share on either coordinate, from B's centre.
    let shared = |at: f64, own: f64, other: f64| 0.5 * ((at - own).max(-other) + (at + own).min(other));
    let (beside, level) = (shared(l, ra, rb), shared(h, half_a, half_b));
    let place = |r: f64, z: f64| b.origin + r * out + z * axis;
    if across > 0.0 && along > 0.0 {
        let (pa, pb) = (place(l - ra, h - up * half_a), place(rb, up * half_b));
        Near::points(pa, pb, out)
    } else if across >= along {
        Near { d: across, normal: out, a: place(l - ra, level), b: place(rb, level) }
    } else {
        Near { d: along, normal: up * axis, a: place(beside, h - up * half_a), b: place(beside, up * half_b) }
    }
}

/// Two boxes that overlap: the axis of least overlap among their face normals and the products of their edges.
fn boxes(a: &Placed, half_a: DVec3, b: &Placed, half_b: DVec3) -> Near {
    let c = a.origin - b.origin;
    let extent = |axes: &soffio_math::DMat3, half: DVec3, n: DVec3| {
        half.x * axes.x_axis.dot(n).abs() + half.y * axes.y_axis.dot(n).abs() + half.z * axes.z_axis.dot(n).abs()
    };
    let overlap = |n: DVec3| extent(&a.axes, half_a, n) + extent(&b.axes, half_b, n) - c.dot(n).abs();
    let mut best = (f64::INFINITY, DVec3::Y);
    for axis in [b.axes, a.axes].iter().flat_map(|m| [m.x_axis, m.y_axis, m.z_axis]) {
        let depth = overlap(axis);
        if depth < best.0 {
            best = (depth, axis);
        }
    }
    let mut crossing: Option<(usize, usize)> = None;
    for i in 0..3 {
        for j in 0..3 {
            let Some(axis) = cross_axis(a.axes.col(i), b.axes.col(j)) else { continue };
            let depth = overlap(axis);
            if depth < best.0 - FACE_PREFERENCE * best.0.abs() {
                best = (depth, axis);
                crossing = Some((i, j));
            }
        }
    }
    let (depth, axis) = best;
    let normal = if c.dot(axis) < 0.0 { -axis } else { axis };
    let (pa, pb) = (a.support(-normal), b.support(normal));
    let (pa, pb) = match crossing {
        // The two edges cross: the nearest points of their lines.
        Some((i, j)) => {
            let (u, v, w) = (a.axes.col(i), b.axes.col(j), pa - pb);
            let uv = u.dot(v);
            let s = (uv * w.dot(v) - w.dot(u)) / (1.0 - uv * uv);
            (pa + s * u, pb + (w.dot(v) + s * uv) * v)
        }
        None => face_points(a, half_a, b, half_b, normal),
    };
    Near { d: -depth, normal, a: pa, b: pb }
}

fn cross_axis(u: DVec3, v: DVec3) -> Option<DVec3> {
    let cross = u.cross(v);
    // Nearly parallel edges give nothing that the faces do not.
    (cross.length_squared() > 1e-12).then(|| cross.normalize())
}

/// A point of each box where a face of one lies on the other: the middle of what both reach of the touching plane.
fn face_points(a: &Placed, half_a: DVec3, b: &Placed, half_b: DVec3, normal: DVec3) -> (DVec3, DVec3) {
    let toward = |p: &Placed, half: DVec3, d: DVec3| {
        // The middle of the corners farthest along d.
        let l = p.local(d);
        p.world(l.map(|x| if x.abs() < 1e-6 { 0.0 } else { x.signum() }) * half)
    };
    let (pa, pb) = (toward(a, half_a, -normal), toward(b, half_b, normal));
    // The box whose feature is the smaller says where, the other how far.
    let clamped = |p: &Placed, half: DVec3, at: DVec3| p.world(p.local(at - p.origin).clamp(-half, half));
    let at = if half_a.length_squared() <= half_b.length_squared() {
        clamped(b, half_b, pa)
    } else {
        clamped(a, half_a, pb)
    };
    (at + (pa - at).dot(normal) * normal, at + (pb - at).dot(normal) * normal)
}

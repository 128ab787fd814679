//! Reachable volumes of colliders: bounds from how their bodies are joined, found once at load.
//!
//! A body with a world anchor p keeps every collider in a ball about p, of the collider's largest distance from p.
//! Its other joints stay in balls about p too, and bodies attached to them in balls larger by their own arms. The
//! least radius of each joint point is a shortest path (E. Dijkstra 1959) whose steps are the distances of joint
//! points on one body. A body that only rotates about a fixed line keeps to a ring about it, which is the better
//! bound, and its joints keep to circles.
//!
//! Two colliders whose bounds are apart never meet. A joint that is open at the start, or that may be released, bounds
//! nothing: leave it out.

use super::proximity::proximity;
use super::shape::{Collider, Shape};
use soffio_geometry::support::Support;
use soffio_math::{DVec3, Pose};

/// Joints that are farther apart than this at the start do not hold yet, m.
const CLOSED: f64 = 1e-6;
/// What joints give while they hold, and more, m.
const SLACK: f64 = 1e-5;
/// Axes whose cross product is shorter than this are parallel.
const PARALLEL: f64 = 1e-9;

/// A point of a body's node frame, or of the world, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointEnd {
    /// Index of the body; `None` is the world.
    pub body: Option<usize>,
    /// A point of the volume, m.
    pub point: DVec3,
}

/// Two points that stay together for good.
pub type JointPoint = [JointEnd; 2];

/// A body that only turns about a fixed line of the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FixedAxis {
    /// Index of the body.
    pub body: usize,
    /// A point of the line, world, m.
    pub point: DVec3,
    /// Unit direction of the line, world.
    pub direction: DVec3,
}

/// A part of space that a collider never leaves.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Volume {
    /// Where it stands.
    Static,
    /// A ball.
    Ball { center: DVec3, radius: f64 },
    /// About a line through `point`: so far along it, and between these distances from it.
    Ring { point: DVec3, axis: DVec3, along: [f64; 2], across: [f64; 2] },
}

/// Bounds of all colliders of a mechanism.
#[derive(Clone, Debug, Default)]
pub struct ReachableVolumes {
    /// All bounds known of each collider; none where it may go anywhere.
    volumes: Vec<Vec<Volume>>,
    static_shapes: Vec<Option<Shape>>,
}

/// A joint's point is held in a ball about a fixed centre.
struct AnchoredPoint {
    center: DVec3,
    joint: usize,
    radius: f64,
}

impl ReachableVolumes {
    /// Bounds from the bodies' start poses, the joints that always hold, and the bodies held on a line.
    pub fn new(colliders: &[Collider], poses: &[Pose], joints: &[JointPoint], axes: &[FixedAxis]) -> Self {
        let world = |end: &JointEnd| end.body.map_or(end.point, |body| poses[body].point(end.point));
        let closed: Vec<JointPoint> =
            joints.iter().copied().filter(|[a, b]| world(a).distance(world(b)) <= CLOSED).collect();
        let mut volumes: Vec<Vec<Volume>> = colliders
            .iter()
            .map(|collider| match collider.body {
                None => vec![Volume::Static],
                Some(body) => {
                    let about = axes.iter().filter(|axis| axis.body == body);
                    about.map(|axis| ring(&collider.shape, &poses[body], axis)).collect()
                }
            })
            .collect();
        for anchored in anchored_points(&closed, axes, &world) {
            let radii = radii(&closed, &anchored);
            for (collider, volumes) in colliders.iter().zip(&mut volumes) {
                let Some(body) = collider.body else { continue };
                let extent = |end: &JointEnd| collider.shape.bounding_radius(end.point) + collider.shape.radius;
                let of_joint = |(joint, radius): (&JointPoint, &f64)| {
                    let own = joint.iter().find(|end| end.body == Some(body))?;
                    Some(radius + extent(own))
                };
                let radius = closed.iter().zip(&radii).filter_map(of_joint).fold(f64::INFINITY, f64::min);
                if radius.is_finite() {
                    volumes.push(Volume::Ball { center: anchored.center, radius });
                }
            }
        }
        let static_shapes = colliders.iter().map(|c| c.body.is_none().then(|| c.shape.clone())).collect();
        Self { volumes, static_shapes }
    }

    /// How far apart two colliders stay for ever at least, m; zero or less where they may meet.
    pub fn clearance(&self, a: usize, b: usize) -> f64 {
        let mut widest = f64::NEG_INFINITY;
        let none = Vec::new();
        for first in self.volumes.get(a).unwrap_or(&none) {
            for second in self.volumes.get(b).unwrap_or(&none) {
                widest = widest.max(self.apart((a, first), (b, second)));
            }
        }
        widest - SLACK
    }

    fn apart(&self, (a, first): (usize, &Volume), (b, second): (usize, &Volume)) -> f64 {
        match (*first, *second) {
            (Volume::Static, Volume::Static) => f64::NEG_INFINITY,
            (Volume::Static, other) => self.distance_to_static(a, other.ball()),
            (other, Volume::Static) => self.distance_to_static(b, other.ball()),
            (Volume::Ring { .. }, Volume::Ball { center, radius }) => first.distance_to_ring(center) - radius,
            (Volume::Ball { center, radius }, Volume::Ring { .. }) => second.distance_to_ring(center) - radius,
            (
                Volume::Ring { point: p, axis, along: [a0, a1], across: [r0, r1] },
                Volume::Ring { point: q, axis: other, along: [b0, b1], across: [s0, s1] },
            ) if axis.cross(other).length_squared() <= PARALLEL * PARALLEL => {
                let offset = q - p;
                let shift = offset.dot(axis);
                let (b0, b1) = if axis.dot(other) > 0.0 { (b0 + shift, b1 + shift) } else { (shift - b1, shift - b0) };
                let between = (offset - shift * axis).length();
                // Above or below each other; beside; one within the other's hole.
                let along = (b0 - a1).max(a0 - b1);
                along.max(between - r1 - s1).max(r0 - between - s1).max(s0 - between - r1)
            }
            _ => {
                let ((p, r), (q, s)) = (first.ball(), second.ball());
                p.distance(q) - r - s
            }
        }
    }

    fn distance_to_static(&self, static_shapes: usize, (center, radius): (DVec3, f64)) -> f64 {
        let Some(Some(shape)) = self.static_shapes.get(static_shapes) else { return f64::NEG_INFINITY };
        proximity(&Shape::sphere(center, radius), &Pose::IDENTITY, shape, &Pose::IDENTITY).gap
    }
}

impl Volume {
    /// A ball around it.
    fn ball(&self) -> (DVec3, f64) {
        match *self {
            Self::Static => (DVec3::ZERO, f64::INFINITY),
            Self::Ball { center, radius } => (center, radius),
            Self::Ring { point, axis, along: [low, high], across: [_, far] } => {
                let half = 0.5 * (high - low);
                (point + 0.5 * (low + high) * axis, (half * half + far * far).sqrt())
            }
        }
    }

    /// Distance of a point from a ring, m.
    fn distance_to_ring(&self, p: DVec3) -> f64 {
        let Self::Ring { point, axis, along: [low, high], across: [near, far] } = *self else {
            return f64::NEG_INFINITY;
        };
        let z = (p - point).dot(axis);
        let r = (p - point - z * axis).length();
        let off = |x: f64, low: f64, high: f64| (low - x).max(x - high).max(0.0);
        let (u, v) = (off(z, low, high), off(r, near, far));
        (u * u + v * v).sqrt()
    }
}

/// The ring of a collider that turns about a line.
fn ring(shape: &Shape, pose: &Pose, axis: &FixedAxis) -> Volume {
    let placed = shape.placed(pose);
    let n = axis.direction;
    let z = |p: DVec3| (p - axis.point).dot(n);
    let along = if shape.is_plane() {
        [f64::NEG_INFINITY, f64::INFINITY]
    } else {
        [z(placed.support(-n)) - shape.radius, z(placed.support(n)) + shape.radius]
    };
    let middle = pose.point(shape.middle());
    let r = (middle - axis.point - z(middle) * n).length();
    let size = shape.bounding_radius(shape.middle()) + shape.radius;
    Volume::Ring { point: axis.point, axis: n, along, across: [(r - size).max(0.0), r + size] }
}

/// Joint points that the world holds: nails, and the joints of bodies on a fixed line.
fn anchored_points(
    joints: &[JointPoint],
    axes: &[FixedAxis],
    world: &dyn Fn(&JointEnd) -> DVec3,
) -> Vec<AnchoredPoint> {
    let mut out = Vec::new();
    for (joint, ends) in joints.iter().enumerate() {
        if let Some(world_anchor) = ends.iter().find(|end| end.body.is_none()) {
            out.push(AnchoredPoint { center: world_anchor.point, joint, radius: 0.0 });
        }
        for axis in axes {
            let Some(end) = ends.iter().find(|end| end.body == Some(axis.body)) else { continue };
            let at = world(end);
            let center = axis.point + (at - axis.point).dot(axis.direction) * axis.direction;
            out.push(AnchoredPoint { center, joint, radius: at.distance(center) });
        }
    }
    out
}

/// Least radius of the ball about a source's centre in which each joint's point stays.
fn radii(joints: &[JointPoint], anchored: &AnchoredPoint) -> Vec<f64> {
    let mut radii = vec![f64::INFINITY; joints.len()];
    radii[anchored.joint] = anchored.radius;
    let mut done = vec![false; joints.len()];
    loop {
        let open = (0..joints.len()).filter(|&j| !done[j] && radii[j].is_finite());
        let Some(nearest) = open.min_by(|&i, &j| radii[i].total_cmp(&radii[j])) else { return radii };
        done[nearest] = true;
        for next in 0..joints.len() {
            for from in &joints[nearest] {
                for to in &joints[next] {
                    if from.body.is_some() && from.body == to.body {
                        radii[next] = radii[next].min(radii[nearest] + from.point.distance(to.point));
                    }
                }
            }
        }
    }
}

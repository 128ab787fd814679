//! Convex cores as support maps: which point of a body lies farthest along a direction, and which edge or face.
//!
//! A convex set is known by its support map s(d), the point that maximises p·d. Distance (`convex`) and overlap
//! (`penetration`) need nothing else, so round bodies are as exact as angular ones: a cylinder is a cylinder.
//! Contact of faces needs more than a point: [`Placed::feature`] gives the edge or face that lies across d.

use super::hull::Hull;
use soffio_math::{DMat3, DVec3, PI, Pose, cos, sin, tangents};

/// An edge or face that leans by less than this against the touching plane (sine of the angle) lies on it.
const LEAN: f64 = 0.03;
/// Corners that stand for the rim of a cylinder's end.
pub const RIM_CORNERS: usize = 16;

/// A convex set in its own frame, m.
#[derive(Clone, Debug, PartialEq)]
pub enum Core {
    /// The origin.
    Point,
    /// From −half to half on Y.
    Segment {
        /// Half its length.
        half: f64,
    },
    /// A box about the origin.
    Box {
        /// Half its edges.
        half: DVec3,
    },
    /// A cylinder along Y about the origin.
    Cylinder {
        /// Half its height.
        half: f64,
        /// Its radius.
        radius: f64,
    },
    /// All points with y ≤ 0.
    HalfSpace,
    /// The convex hull of corners; a flat one is a polygon.
    Hull(Hull),
}

impl Core {
    /// Farthest distance of its points from a point of its frame, m; infinite for the half-space.
    #[inline]
    pub fn bounding_radius(&self, from: DVec3) -> f64 {
        match self {
            Self::Point => from.length(),
            Self::Segment { half } => DVec3::new(from.x, from.y.abs() + half, from.z).length(),
            Self::Box { half } => (from.abs() + *half).length(),
            Self::Cylinder { half, radius } => {
                let across = (from.x * from.x + from.z * from.z).sqrt() + radius;
                let along = from.y.abs() + half;
                (across * across + along * along).sqrt()
            }
            Self::HalfSpace => f64::INFINITY,
            Self::Hull(hull) => hull.corners().iter().fold(0.0, |r: f64, p| r.max(p.distance(from))),
        }
    }

    /// A middle point.
    #[inline]
    pub fn middle(&self) -> DVec3 {
        match self {
            Self::Hull(hull) => hull.middle(),
            _ => DVec3::ZERO,
        }
    }
}

/// What has a support map in the world.
pub trait Support {
    /// A point that lies farthest along `d`.
    fn support(&self, d: DVec3) -> DVec3;
    /// A point inside.
    fn middle(&self) -> DVec3;
}

/// The hull of corners in the world (one at least).
impl Support for [DVec3] {
    #[inline]
    fn support(&self, d: DVec3) -> DVec3 {
        self[farthest(self, d)]
    }

    #[inline]
    fn middle(&self) -> DVec3 {
        self.iter().sum::<DVec3>() / self.len() as f64
    }
}

/// Index of the farthest corner along `d`; the first of equals, so that the answer does not depend on rounding order.
#[inline]
pub fn farthest(corners: &[DVec3], d: DVec3) -> usize {
    let mut best = 0;
    let mut far = f64::NEG_INFINITY;
    for (i, p) in corners.iter().enumerate() {
        let along = p.dot(d);
        if along > far {
            far = along;
            best = i;
        }
    }
    best
}

/// A core at a place in the world.
#[derive(Clone, Copy, Debug)]
pub struct Placed<'a> {
    /// The core.
    pub core: &'a Core,
    /// Its axes in the world.
    pub axes: DMat3,
    /// Its origin in the world, m.
    pub origin: DVec3,
}

impl<'a> Placed<'a> {
    /// The core with its frame at a pose.
    #[inline]
    pub fn new(core: &'a Core, pose: &Pose) -> Self {
        Self { core, axes: DMat3::from_quat(pose.rotation), origin: pose.position }
    }

    /// A world vector in the core's axes.
    #[inline]
    pub fn local(&self, v: DVec3) -> DVec3 {
        DVec3::new(self.axes.x_axis.dot(v), self.axes.y_axis.dot(v), self.axes.z_axis.dot(v))
    }

    /// World place of a point of the core's frame.
    #[inline]
    pub fn world(&self, p: DVec3) -> DVec3 {
        self.origin + self.axes * p
    }

    /// The corners of the edge or face that lies across `d`, farthest along it, into `out` (one where it is a
    /// point); returns the outward normal where it is a face. Corners of a face go counter-clockwise about it. The
    /// half-space has a face without corners. Corners of a cylinder's end stand on its rim, the farthest first.
    pub fn feature(&self, d: DVec3, out: &mut Vec<DVec3>) -> Option<DVec3> {
        out.clear();
        let l = self.local(d);
        match self.core {
            Core::Point => out.push(self.origin),
            Core::Segment { half } => {
                let end = self.axes.y_axis * *half;
                if l.y.abs() <= LEAN {
                    out.extend([self.origin - end, self.origin + end]);
                } else {
                    out.push(self.origin + end * l.y.signum());
                }
            }
            Core::Box { half } => return self.box_feature(*half, l, out),
            Core::Cylinder { half, radius } => {
                let across = (l.x * l.x + l.z * l.z).sqrt();
                let end = self.axes.y_axis * *half;
                let outward = if across > 0.0 {
                    (self.axes.x_axis * l.x + self.axes.z_axis * l.z) / across
                } else {
                    self.axes.x_axis
                };
                if across <= LEAN {
                    let normal = self.axes.y_axis * l.y.signum();
                    let other = normal.cross(outward);
                    let middle = self.origin + end * l.y.signum();
                    out.extend((0..RIM_CORNERS).map(|i| {
                        let angle = 2.0 * PI * i as f64 / RIM_CORNERS as f64;
                        middle + *radius * (cos(angle) * outward + sin(angle) * other)
                    }));
                    return Some(normal);
                }
                let side = self.origin + *radius * outward;
                if l.y.abs() <= LEAN {
                    out.extend([side - end, side + end]);
                } else {
                    out.push(side + end * l.y.signum());
                }
            }
            Core::HalfSpace => return Some(self.axes.y_axis),
            Core::Hull(hull) => {
                let (indices, normal) = hull.feature(l, LEAN);
                out.extend(indices.iter().map(|&i| self.world(hull.corners()[i])));
                return normal.map(|n| self.axes * n);
            }
        }
        None
    }

    fn box_feature(&self, half: DVec3, l: DVec3, out: &mut Vec<DVec3>) -> Option<DVec3> {
        let sign = |x: f64| if x < 0.0 { -1.0 } else { 1.0 };
        let corner = l.map(sign) * half;
        let lies = |k: usize| l[k].abs() <= LEAN;
        // The face whose two edges lie across d; else the edge that does.
        for k in 0..3 {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            if lies(i) && lies(j) && !lies(k) {
                let up = sign(l[k]);
                for (u, v) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
                    let mut p = corner;
                    // Counter-clockwise about the outward normal.
                    p[i] = u * up * half[i];
                    p[j] = v * half[j];
                    out.push(self.world(p));
                }
                return Some(self.axes.col(k) * up);
            }
        }
        out.push(self.world(corner));
        if let Some(k) = (0..3).find(|&k| lies(k)) {
            let mut other = corner;
            other[k] = -other[k];
            out.push(self.world(other));
        }
        None
    }

    /// Half extents along the world's axes about [`Support::middle`], m; infinite for the half-space.
    #[inline]
    pub fn extents(&self) -> DVec3 {
        let axes = [self.axes.x_axis.abs(), self.axes.y_axis.abs(), self.axes.z_axis.abs()];
        match self.core {
            Core::Point => DVec3::ZERO,
            Core::Segment { half } => axes[1] * *half,
            Core::Box { half } => axes[0] * half.x + axes[1] * half.y + axes[2] * half.z,
            Core::Cylinder { half, radius } => {
                axes[1] * *half + axes[1].map(|y| radius * (1.0 - y * y).max(0.0).sqrt())
            }
            Core::HalfSpace => DVec3::INFINITY,
            Core::Hull(hull) => {
                let middle = hull.middle();
                hull.corners().iter().fold(DVec3::ZERO, |most, p| most.max((self.axes * (*p - middle)).abs()))
            }
        }
    }
}

impl Support for Placed<'_> {
    #[inline]
    fn support(&self, d: DVec3) -> DVec3 {
        let l = self.local(d);
        let sign = |x: f64| if x < 0.0 { -1.0 } else { 1.0 };
        let p = match self.core {
            Core::Point => return self.origin,
            Core::Segment { half } => return self.origin + self.axes.y_axis * (half * sign(l.y)),
            Core::Box { half } => l.map(sign) * *half,
            Core::Cylinder { half, radius } => {
                let across = (l.x * l.x + l.z * l.z).sqrt();
                let r = if across > 0.0 { radius / across } else { 0.0 };
                DVec3::new(r * l.x, half * sign(l.y), r * l.z)
            }
            // Bounded along its normal alone: the foot of the direction stands for all points as far.
            Core::HalfSpace => DVec3::ZERO,
            Core::Hull(hull) => hull.corners()[farthest(hull.corners(), l)],
        };
        self.world(p)
    }

    #[inline]
    fn middle(&self) -> DVec3 {
        self.world(self.core.middle())
    }
}

/// A rotation that turns Y onto a unit direction.
#[inline]
pub fn along(direction: DVec3) -> soffio_math::DQuat {
    let (t, b) = tangents(direction);
    // Columns x, y, z: (b, t, n) is left-handed, (t, n, −b) right-handed.
    soffio_math::DQuat::from_mat3(&DMat3::from_cols(t, direction, -b)).normalize()
}

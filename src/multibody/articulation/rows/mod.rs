//! Constraints as stacks of one-DOF rows: C, J, and the parts of Ċ and C̈ that do not depend on what is solved for.
//!
//! Symbols: x centre of mass, r = R p world vector from the centre to a body point p, v and ω velocities. A row
//! multiplies the coordinates (v, ω) of the bodies that it touches; a given function of time f(t) may be asked of it:
//!
//! ```text
//! C = q(x) − f      Ċ = J ẋ − ḟ      C̈ = J ẍ + J̇ẋ − f̈
//! ```
//!
//! Each kind has its derivation at the head of its file.

pub mod coupling;
pub mod friction;
pub mod orientation;
pub mod plane;
pub mod point;

use super::{Anchor, Axis, Constraint, ConstraintKind};
use soffio_geometry::bodies::RigidBody;
use soffio_math::spatial::{Vec6, vec6};
use soffio_math::{DMat3, DVec3};

/// One row between two bodies, or a body and the world.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JacobianRow {
    /// J on the constraint's first body.
    pub a: Vec6,
    /// J on its second body; meaningless where that is the world.
    pub b: Vec6,
    /// C, m or rad.
    pub value: f64,
    /// ḟ, m/s or rad/s.
    pub prescribed_rate: f64,
    /// J̇ẋ − f̈, m/s² or rad/s².
    pub bias: f64,
    /// Is C a length (else an angle)?
    pub length: bool,
}

/// The bodies' state with their rotations as matrices.
#[derive(Clone, Copy, Debug)]
pub struct BodyStates<'a> {
    /// States.
    pub bodies: &'a [RigidBody],
    /// Node axes to world axes.
    pub frames: &'a [DMat3],
    /// Seconds since reset.
    pub time: f64,
}

/// A point of a body or the world, in motion.
#[derive(Clone, Copy, Debug)]
pub struct Point {
    /// World position of the point, m.
    pub position: DVec3,
    /// From the centre of mass, m; zero for the world.
    pub arm: DVec3,
    /// Velocity of the point, m/s.
    pub velocity: DVec3,
    /// ω × (ω × r), m/s².
    pub centripetal: DVec3,
}

/// A direction of a body or the world, in motion.
#[derive(Clone, Copy, Debug)]
pub struct Direction {
    /// Direction of the axis, unit, world axes.
    pub n: DVec3,
    /// ω of its body, rad/s.
    pub spin: DVec3,
}

impl BodyStates<'_> {
    /// Where an anchor is, m.
    pub fn place(&self, anchor: &Anchor) -> DVec3 {
        let Some(index) = anchor.body else { return anchor.point };
        let body = &self.bodies[index];
        body.position + self.frames[index] * (anchor.point - body.properties.center)
    }

    /// Where an anchor is, and how it moves.
    #[inline(always)]
    pub fn point(&self, anchor: &Anchor) -> Point {
        let Some(index) = anchor.body else {
            return Point { position: anchor.point, arm: DVec3::ZERO, velocity: DVec3::ZERO, centripetal: DVec3::ZERO };
        };
        let body = &self.bodies[index];
        let arm = self.frames[index] * (anchor.point - body.properties.center);
        let rotational_velocity = body.angular_velocity.cross(arm);
        Point {
            position: body.position + arm,
            arm,
            velocity: body.velocity + rotational_velocity,
            centripetal: body.angular_velocity.cross(rotational_velocity),
        }
    }

    /// Where an axis points.
    #[inline(always)]
    pub fn direction(&self, axis: &Axis) -> Direction {
        match axis.body {
            Some(index) => {
                Direction { n: self.frames[index] * axis.direction, spin: self.bodies[index].angular_velocity }
            }
            None => Direction { n: axis.direction, spin: DVec3::ZERO },
        }
    }

    /// Angular velocity of a body; zero for the world.
    #[inline(always)]
    pub fn spin(&self, body: Option<usize>) -> DVec3 {
        body.map_or(DVec3::ZERO, |index| self.bodies[index].angular_velocity)
    }
}

/// Block of a force along `e` at the arm `r`.
#[inline(always)]
pub fn at(e: DVec3, r: DVec3) -> Vec6 {
    vec6(e, r.cross(e))
}

/// The opposite block.
#[inline(always)]
pub fn negated(v: Vec6) -> Vec6 {
    v.map(|x| -x)
}

impl Constraint {
    /// The two bodies it connects, in its own order; `None` for couplings, which may touch more.
    pub fn link(&self) -> Option<(Option<usize>, Option<usize>)> {
        match &self.kind {
            ConstraintKind::PointToPoint { a, b } => Some((a.body, b.body)),
            ConstraintKind::Orientation { a, b, .. } => Some((a.body, b.body)),
            ConstraintKind::PointOnPlane { point, plane, .. } => Some((point.body, plane.body)),
            ConstraintKind::Coupling { .. } => None,
        }
    }

    /// How many DOFs it holds.
    pub fn row_count(&self) -> usize {
        match self.kind {
            ConstraintKind::PointToPoint { .. } => 3,
            _ => 1,
        }
    }
}

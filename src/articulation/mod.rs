//! Bodies joined: constraints as stacks of one-DOF rows, and the tree factor that motion of either kind solves with.

use crate::math::DVec3;

pub mod block;
mod loops;
pub mod rows;
mod system;
pub mod tree;

pub use system::System;

/// A point fixed in a body's node frame, or in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Anchor {
    /// Index of the body; `None` is the world.
    pub body: Option<usize>,
    /// Node frame of the body (world frame for the world), m.
    pub point: DVec3,
}

/// A direction fixed in a body's node frame, or in the world; unit length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axis {
    /// Index of the body; `None` is the world.
    pub body: Option<usize>,
    /// Unit vector in the node frame (world frame for the world).
    pub direction: DVec3,
}

/// What a constraint holds.
#[derive(Clone, Debug, PartialEq)]
pub enum ConstraintKind {
    /// Two points coincide (3 rows). With a world anchor this is a nail.
    PointToPoint {
        /// The point of the first body.
        a: Anchor,
        /// The point of the second body, or of the world.
        b: Anchor,
    },
    /// Two directions stay perpendicular (1 row): C = T · N.
    Orientation {
        /// T.
        a: Axis,
        /// N.
        b: Axis,
    },
}

/// Dry friction of a pivot: a torque that opposes relative rotation, at most `coefficient · |load| · radius`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PivotFriction {
    /// Coulomb coefficient μ.
    pub coefficient: f64,
    /// Effective lever arm, m (a hook in a loop: 0.2–0.5 mm).
    pub radius: f64,
}

/// One named constraint of an exhibit.
#[derive(Clone, Debug, PartialEq)]
pub struct Constraint {
    /// Unique in the exhibit.
    pub name: String,
    /// Which rows it holds.
    pub kind: ConstraintKind,
    /// Friction of the pivot; `None` turns freely.
    pub friction: Option<PivotFriction>,
    /// Largest tilt of `axis` of the first body away from `axis` of the second, rad; `None` is free.
    pub tilt_limit: Option<TiltLimit>,
}

/// A one-sided cone: the angle between an axis of the first body and one of the second (or the world) stays below
/// `angle`. The rim of a cup on its point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TiltLimit {
    /// Axis of the tilting body.
    pub a: Axis,
    /// Axis it tilts from.
    pub b: Axis,
    /// rad.
    pub angle: f64,
    /// Coefficient of restitution at the rim.
    pub restitution: f64,
}

/// A linear spring and damper between two points.
#[derive(Clone, Debug, PartialEq)]
pub struct Spring {
    /// Unique in the exhibit.
    pub name: String,
    /// One end.
    pub a: Anchor,
    /// Other end.
    pub b: Anchor,
    /// m.
    pub rest_length: f64,
    /// N/m.
    pub stiffness: f64,
    /// N s/m.
    pub damping: f64,
}

//! Articulated-body dynamics with Lagrange multipliers, in linear time for trees (D. Baraff, Linear-time dynamics
//! using Lagrange multipliers, SIGGRAPH 1996).
//!
//! A constraint is a stack of one-DOF Jacobian rows (`rows`). A tree factor (`tree.rs`), sparse factors of closed
//! loops (`loops`) and gear trains (`trains`) solve all rows. Constrained dynamics and position-based motion share
//! the factor.

use soffio_math::{DVec3, Function};

mod activity;

pub mod ball_elimination;
mod ball_joints;
mod cholesky;
mod dense;
mod disjoint_sets;
pub mod lane_blocks;
mod loops;
mod partial_rows;
pub mod rows;
mod schedule;
mod system;
mod topology;
mod trains;
pub mod tree;
mod tree_sweeps;

pub use activity::{Activity, Break, Load, LoadKind};
pub use cholesky::Cholesky;
pub use disjoint_sets::DisjointSets;
pub use schedule::{Breaking, Schedule, Trigger, Window};
pub use system::{Joint, LinearSolver, RowState, System, TrainRow};

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

/// Kind of a constraint. Every usual joint is a stack of these: a hinge is a point and two orientations, a slider
/// three orientations and two planes, a line two planes, a weld a point and three orientations.
#[derive(Clone, Debug, PartialEq)]
pub enum ConstraintKind {
    /// Two points coincide (3 rows): a world anchor where one point is the world's, a prescribed path where one body
    /// is kinematic.
    PointToPoint {
        /// The point of the first body.
        a: Anchor,
        /// The point of the second body, or of the world.
        b: Anchor,
    },
    /// A point stays in a plane, or at a given height above it (1 row): N · (P − S) = offset.
    PointOnPlane {
        /// P.
        point: Anchor,
        /// S, a point of the plane.
        plane: Anchor,
        /// N, in the frame of S's body.
        normal: DVec3,
        /// Height above the plane, m.
        offset: Function,
    },
    /// Two directions stay at a right angle, or at a given angle from it (1 row): asin(T · N) = angle.
    Orientation {
        /// T.
        a: Axis,
        /// N.
        b: Axis,
        /// Angle of T above the plane across N, rad.
        angle: Function,
    },
    /// Rotations and displacements stay in proportion (1 row): Σ coefficient · q = const. Gears, drums and cords,
    /// racks, screws, differentials.
    Coupling {
        /// At least two coupled coordinates; or one rotation against another body, for a clutch.
        terms: Vec<Term>,
    },
}

/// One coordinate of a coupling and its coefficient.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Term {
    /// What is measured.
    pub measure: Measure,
    /// Radius with its sign (m), number of teeth, or 1 for a displacement.
    pub coefficient: f64,
}

/// A scalar coordinate of one body against another or the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Measure {
    /// Right-handed angle of a body about an axis fixed in it, against `frame`, since the start, not wrapped, rad.
    Angle {
        /// Axis of the turning body, node frame.
        axis: Axis,
        /// Body that carries the axle; `None` is the world.
        frame: Option<usize>,
    },
    /// Displacement of a point along a direction fixed in `direction.body` (or the world), since the start, m.
    Displacement {
        /// The moving point.
        point: Anchor,
        /// Unit direction.
        direction: Axis,
    },
}

/// Dry friction of a pivot: a torque that opposes relative rotation, at most `coefficient · |load| · radius`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PivotFriction {
    /// Coulomb coefficient μ.
    pub coefficient: f64,
    /// Effective radius of the bearing, m (a hook in a loop: 0.2–0.5 mm).
    pub radius: f64,
}

/// One named constraint of an exhibit.
#[derive(Clone, Debug, PartialEq)]
pub struct Constraint {
    /// Unique in the exhibit; parts of a combination share its name with `/part` after it.
    pub name: String,
    /// Which rows it holds.
    pub kind: ConstraintKind,
    /// When it acts.
    pub schedule: Schedule,
    /// Load at which it breaks, if any; constraints of one combination break together.
    pub breaking: Option<Breaking>,
    /// Friction of the pivot; `None` turns freely.
    pub friction: Option<PivotFriction>,
    /// Torque above which a clutch slips, N m; it sticks again once both sides turn alike. `None`: not a clutch.
    pub slips: Option<f64>,
    /// 1/ω₀ of its own Baumgarte stabilisation, s; `None` uses the articulation's.
    pub stabilization_time: Option<f64>,
}

impl Constraint {
    /// One that always acts, never breaks and turns freely.
    pub fn new(name: &str, kind: ConstraintKind) -> Self {
        Self {
            name: name.to_owned(),
            kind,
            schedule: Schedule::default(),
            breaking: None,
            friction: None,
            slips: None,
            stabilization_time: None,
        }
    }

    /// Name of its combination: the part of the name before the `/`.
    pub fn group(&self) -> &str {
        self.name.split('/').next().unwrap_or(&self.name)
    }
}

/// A unilateral constraint: a coordinate stays within bounds.
#[derive(Clone, Debug, PartialEq)]
pub struct Limit {
    /// Name of the constraint that it belongs to, or its own.
    pub name: String,
    /// What is bounded.
    pub kind: LimitKind,
    /// Coefficient of restitution at the bound, 0 … 1.
    pub restitution: f64,
}

/// Bounded coordinate of a limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LimitKind {
    /// The angle between an axis of the first body and one of the second stays below `max`: a cup's rim on its point.
    Tilt {
        /// Axis of the tilting body.
        a: Axis,
        /// Axis it tilts from.
        b: Axis,
        /// rad.
        max: f64,
    },
    /// A rotation or displacement since the start stays between two bounds (rad or m): stops of a hinge or a slider.
    Range {
        /// What is bounded.
        measure: Measure,
        /// Least value; may be −∞.
        min: f64,
        /// Greatest value; may be ∞.
        max: f64,
    },
    /// The distance of two points stays between two bounds: a slack cord (min 0), a strut.
    Distance {
        /// One point.
        a: Anchor,
        /// The other.
        b: Anchor,
        /// m.
        min: f64,
        /// m; may be ∞.
        max: f64,
    },
    /// A rotation in one direction only: a pawl on a wheel. It can fall back to the last tooth that it passed.
    Ratchet {
        /// The rotation; free to grow.
        measure: Measure,
        /// Angle from tooth to tooth (m for a rack); 0 catches anywhere.
        pitch: f64,
    },
    /// Two coordinates stay in proportion except for some play: |c₁ q₁ + c₂ q₂| ≤ play/2. The backlash of a gear:
    /// inside it the wheels are independent, at either end a flank of a tooth rests on the other wheel's.
    Play {
        /// What is coupled.
        terms: [Term; 2],
        /// In the unit of c q.
        play: f64,
    },
}

/// A spring and damper.
#[derive(Clone, Debug, PartialEq)]
pub struct Spring {
    /// Unique in the exhibit.
    pub name: String,
    /// What it acts on.
    pub kind: SpringKind,
    /// Length (m) or angle (rad) at which the spring is relaxed.
    pub rest_length: Function,
    /// N/m or N m/rad.
    pub stiffness: Function,
    /// N s/m or N m s/rad.
    pub damping: Function,
    /// When it acts; the activation scales the force.
    pub schedule: Schedule,
    /// Load at which it breaks.
    pub breaking: Option<Breaking>,
}

/// What a spring acts on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SpringKind {
    /// The distance of two points.
    Linear {
        /// One end.
        a: Anchor,
        /// Other end.
        b: Anchor,
    },
    /// A rotation about an axis (or a displacement along one), since the start.
    Angular {
        /// What is measured.
        measure: Measure,
    },
}

impl Measure {
    /// The measured body and the reference body; `None` is the world.
    pub fn bodies(&self) -> (Option<usize>, Option<usize>) {
        match self {
            Self::Angle { axis, frame } => (axis.body, *frame),
            Self::Displacement { point, direction } => (point.body, direction.body),
        }
    }
}

impl ConstraintKind {
    /// Does it act on this body?
    pub fn acts_on(&self, body: usize) -> bool {
        let either = |(a, b): (Option<usize>, Option<usize>)| a == Some(body) || b == Some(body);
        match self {
            Self::PointToPoint { a, b } => either((a.body, b.body)),
            Self::PointOnPlane { point, plane, .. } => either((point.body, plane.body)),
            Self::Orientation { a, b, .. } => either((a.body, b.body)),
            Self::Coupling { terms } => terms.iter().any(|term| either(term.measure.bodies())),
        }
    }
}

impl LimitKind {
    /// The bodies that it acts between; `None` is the world.
    pub fn bodies(&self) -> [Option<usize>; 2] {
        match self {
            Self::Tilt { a, b, .. } => [a.body, b.body],
            Self::Range { measure, .. } | Self::Ratchet { measure, .. } => measure.bodies().into(),
            Self::Distance { a, b, .. } => [a.body, b.body],
            Self::Play { terms, .. } => terms.map(|term| term.measure.bodies().0),
        }
    }

    /// Does it act on this body?
    pub fn acts_on(&self, body: usize) -> bool {
        let either = |(a, b): (Option<usize>, Option<usize>)| a == Some(body) || b == Some(body);
        match self {
            Self::Tilt { a, b, .. } => either((a.body, b.body)),
            Self::Range { measure, .. } | Self::Ratchet { measure, .. } => either(measure.bodies()),
            Self::Distance { a, b, .. } => either((a.body, b.body)),
            Self::Play { terms, .. } => terms.iter().any(|term| either(term.measure.bodies())),
        }
    }
}

impl SpringKind {
    /// Does it act on this body?
    pub fn acts_on(&self, body: usize) -> bool {
        let (a, b) = match self {
            Self::Linear { a, b } => (a.body, b.body),
            Self::Angular { measure } => measure.bodies(),
        };
        a == Some(body) || b == Some(body)
    }
}

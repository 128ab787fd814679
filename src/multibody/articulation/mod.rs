//! Bodies joined: constraints as stacks of one-DOF rows, and the tree factor that motion of either kind solves with.

use soffio_math::{DVec3, Function};

mod activity;
pub mod ball;
pub mod block;
mod cholesky;
mod dense;
mod groups;
mod hang;
mod hung;
mod loops;
pub mod quads;
pub mod rows;
mod schedule;
mod share;
mod sweeps;
mod system;
mod trains;
pub mod tree;

pub use activity::{Activity, Break};
pub use cholesky::Cholesky;
pub use groups::Groups;
pub use schedule::{Breaking, Schedule, Trigger, Window};
pub use system::{Geared, Joint, Method, RowState, System};

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

/// What a constraint holds. Every joint of the field is a stack of these: a hinge is a point and two orientations, a
/// slider three orientations and two planes, a line two planes, a weld a point and three orientations.
#[derive(Clone, Debug, PartialEq)]
pub enum ConstraintKind {
    /// Two points coincide (3 rows). With a world anchor this is a nail; on a driven body it is a moving nail.
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
    /// Turns and ways stay in proportion (1 row): Σ coefficient · q = const. Gears, drums and cords, racks, screws,
    /// differentials.
    Coupling {
        /// What is coupled: two at least, or one turn against another body, which a clutch holds.
        terms: Vec<Term>,
    },
}

/// A turn or a way, and how much it counts in a coupling.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Term {
    /// What is measured.
    pub measure: Measure,
    /// Its weight: radius with its sign (m), tooth count, or 1 for a way.
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
    /// Way of a point along a direction fixed in `direction.body` (or the world), since the start, m.
    Way {
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
    /// Effective lever arm, m (a hook in a loop: 0.2–0.5 mm).
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
    /// When it gives way; constraints of one combination break together.
    pub breaking: Option<Breaking>,
    /// Friction of the pivot; `None` turns freely.
    pub friction: Option<PivotFriction>,
    /// A coupling that gives way where it carries more than this, N m, and holds again where it comes to rest.
    pub slips: Option<f64>,
    /// 1/ω₀ of its own stabiliser, s; `None` has the figure's.
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

    /// Name of the combination it belongs to: what stands before the `/`.
    pub fn group(&self) -> &str {
        self.name.split('/').next().unwrap_or(&self.name)
    }
}

/// A one-sided constraint: something stays within bounds.
#[derive(Clone, Debug, PartialEq)]
pub struct Limit {
    /// Name of the constraint that it belongs to, or its own.
    pub name: String,
    /// What is bounded.
    pub kind: LimitKind,
    /// Coefficient of restitution at the bound, 0 … 1.
    pub restitution: f64,
}

/// What a limit bounds.
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
    /// A turn or way since the start stays between two bounds (rad or m): stops of a hinge or a slider.
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
    /// A turn goes one way only: a pawl on a wheel. It can fall back to the last tooth that it passed.
    Ratchet {
        /// What turns; free where it grows.
        measure: Measure,
        /// Angle from tooth to tooth (m for a rack); 0 catches anywhere.
        pitch: f64,
    },
    /// Two turns or ways stay in proportion but for some play: |c₁ q₁ + c₂ q₂| ≤ play/2. The backlash of a gear: within
    /// it the wheels are free of each other, at either end of it a flank of a tooth lies on the other wheel's.
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
    /// Value without force: m or rad.
    pub rest: Function,
    /// N/m or N m/rad.
    pub stiffness: Function,
    /// N s/m or N m s/rad.
    pub damping: Function,
    /// When it acts; its share scales the force.
    pub schedule: Schedule,
    /// When it gives way.
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
    /// A turn about an axis (or a way along one), counted from the start.
    Angular {
        /// What is measured.
        measure: Measure,
    },
}

impl Measure {
    /// The body that is measured, and the body it is measured against.
    pub fn bodies(&self) -> (Option<usize>, Option<usize>) {
        match self {
            Self::Angle { axis, frame } => (axis.body, *frame),
            Self::Way { point, direction } => (point.body, direction.body),
        }
    }
}

impl ConstraintKind {
    /// Does it act on this body?
    pub fn touches(&self, body: usize) -> bool {
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
    pub fn touches(&self, body: usize) -> bool {
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
    pub fn touches(&self, body: usize) -> bool {
        let (a, b) = match self {
            Self::Linear { a, b } => (a.body, b.body),
            Self::Angular { measure } => measure.bodies(),
        };
        a == Some(body) || b == Some(body)
    }
}

//! Random mechanisms: bodies in any motion, joined by every kind of row.

use soffio_geometry::bodies::{MassProperties, RigidBody};
use soffio_math::Function;
use soffio_math::noise::Random;
use soffio_math::spatial::{Vec6, vec6};
use soffio_math::{DMat3, DVec3, Pose, rotation};
use soffio_multibody::articulation::{
    Anchor, Axis, Constraint, ConstraintKind, Measure, PivotFriction, Schedule, Term, Window,
};

pub fn vector(random: &mut Random) -> DVec3 {
    DVec3::new(random.signed(), random.signed(), random.signed())
}

pub fn unit(random: &mut Random) -> DVec3 {
    loop {
        let v = vector(random);
        if v.length_squared() > 0.1 && v.length_squared() < 1.0 {
            return v.normalize();
        }
    }
}

pub fn below(random: &mut Random, n: usize) -> usize {
    (random.word() % n as u64) as usize
}

pub fn wrench(random: &mut Random) -> Vec6 {
    vec6(vector(random), vector(random))
}

/// A body of about 1 kg and 1 kg m², anywhere, in motion: arms of about a metre give rows of one size.
pub fn body(random: &mut Random) -> RigidBody {
    let pose = Pose { rotation: rotation(2.0 * vector(random)), position: vector(random) };
    let rotated = DMat3::from_quat(rotation(vector(random)));
    let moments = DMat3::from_diagonal(DVec3::new(0.3, 0.4, 0.5) * random.range(0.5, 1.5));
    let inertia = rotated * moments * rotated.transpose();
    let properties = MassProperties { mass: random.range(0.5, 2.0), center: 0.1 * vector(random), inertia };
    RigidBody { velocity: vector(random), angular_velocity: vector(random), ..RigidBody::at_rest(properties, pose) }
}

pub fn anchor(random: &mut Random, body: Option<usize>) -> Anchor {
    Anchor { body, point: vector(random) }
}

pub fn axis(random: &mut Random, body: Option<usize>) -> Axis {
    Axis { body, direction: unit(random) }
}

/// A wave: both its derivatives are never zero together.
pub fn function(random: &mut Random) -> Function {
    if random.unit() < 0.3 {
        return Function::Constant(0.2 * random.signed());
    }
    let (mean, amplitude) = (0.2 * random.signed(), random.range(0.1, 0.3));
    Function::Wave { mean, amplitude, period: random.range(2.0, 5.0), phase: 3.0 * random.signed() }
}

pub fn point(random: &mut Random, a: Option<usize>, b: Option<usize>) -> ConstraintKind {
    ConstraintKind::PointToPoint { a: anchor(random, a), b: anchor(random, b) }
}

pub fn plane(random: &mut Random, a: Option<usize>, b: Option<usize>) -> ConstraintKind {
    let (point, plane) = (anchor(random, a), anchor(random, b));
    ConstraintKind::PointOnPlane { point, plane, normal: unit(random), offset: function(random) }
}

pub fn orientation(random: &mut Random, a: Option<usize>, b: Option<usize>) -> ConstraintKind {
    ConstraintKind::Orientation { a: axis(random, a), b: axis(random, b), angle: function(random) }
}

/// A turn or a way of a body against a frame.
pub fn measure(random: &mut Random, body: Option<usize>, frame: Option<usize>) -> Measure {
    if random.unit() < 0.5 {
        Measure::Angle { axis: axis(random, body), frame }
    } else {
        Measure::Displacement { point: anchor(random, body), direction: axis(random, frame) }
    }
}

/// Two or three turns and ways of any bodies against any frames.
pub fn coupling(random: &mut Random, bodies: usize) -> ConstraintKind {
    let count = 2 + below(random, 2);
    let terms = (0..count)
        .map(|_| {
            let body = below(random, bodies);
            let other = below(random, bodies + 1);
            let frame = (other < bodies && other != body).then_some(other);
            Term { measure: measure(random, Some(body), frame), coefficient: random.range(0.5, 2.0) }
        })
        .collect();
    ConstraintKind::Coupling { terms }
}

/// A mechanism with what else a solve needs.
pub struct RandomMechanism {
    pub bodies: Vec<RigidBody>,
    pub kinematic: Vec<bool>,
    pub constraints: Vec<Constraint>,
    /// Moment at which windows and functions are asked.
    pub time: f64,
}

/// What a mechanism may hold.
#[derive(Clone, Copy)]
pub struct Kinds {
    pub loops: bool,
    pub partial_rows: bool,
    pub friction: bool,
}

/// A tree of joints of every combination, some of its bodies driven, then rows that close loops and couplings.
pub fn mechanism(random: &mut Random, kinds: Kinds) -> RandomMechanism {
    let count = 2 + below(random, 7);
    let time = random.range(0.0, 3.0);
    let mut kinematic = vec![false; count];
    if random.unit() < 0.3 {
        kinematic[below(random, count)] = true;
    }
    let mut constraints: Vec<Constraint> = Vec::new();
    let add = |constraints: &mut Vec<Constraint>, random: &mut Random, kind| {
        let mut constraint = Constraint::new(&format!("row-{}", constraints.len()), kind);
        if kinds.friction && random.unit() < 0.5 && constraint.link().is_some() {
            constraint.friction = Some(PivotFriction { coefficient: 0.3, radius: 0.05 });
        }
        constraint.schedule = schedule(random, time, kinds.partial_rows);
        constraints.push(constraint);
    };
    for body in 0..count {
        let parent = if body == 0 { None } else { Some(below(random, body)) };
        // A mechanism may float, and either end may come first.
        if body == 0 && random.unit() < 0.2 {
            continue;
        }
        let (a, b) = if random.unit() < 0.5 || parent.is_none() { (Some(body), parent) } else { (parent, Some(body)) };
        // Points, planes, orientations: ball, hinge, universal, weld, slider, line and plane, orientation, point alone.
        let (points, planes, rotations) =
            [(1, 0, 0), (1, 0, 2), (1, 0, 1), (1, 0, 3), (0, 2, 3), (0, 2, 0), (0, 1, 1), (1, 0, 0)][below(random, 8)];
        for _ in 0..points {
            let kind = point(random, a, b);
            add(&mut constraints, random, kind);
        }
        for _ in 0..planes {
            let kind = plane(random, a, b);
            add(&mut constraints, random, kind);
        }
        for _ in 0..rotations {
            let kind = orientation(random, a, b);
            add(&mut constraints, random, kind);
        }
    }
    if kinds.loops {
        for _ in 0..below(random, 4) {
            let (a, b) = (below(random, count), below(random, count + 1));
            let b = (b < count && b != a).then_some(b);
            let kind = match below(random, 4) {
                0 => point(random, Some(a), b),
                1 => plane(random, Some(a), b),
                2 => orientation(random, b, Some(a)),
                _ => coupling(random, count),
            };
            add(&mut constraints, random, kind);
        }
    }
    let bodies = (0..count).map(|_| body(random)).collect();
    RandomMechanism { bodies, kinematic, constraints, time }
}

/// Mostly always; else a window that is open, over, or half way up its ramp at `time`.
fn schedule(random: &mut Random, time: f64, partial_rows: bool) -> Schedule {
    let window = |start, end| Schedule { windows: vec![Window { start, end }], ..Schedule::default() };
    match below(random, 8) {
        0 => window(time - 0.5, time + 0.5),
        1 => window(time - 1.0, time - 0.5),
        2 | 3 if partial_rows => Schedule { ramp_in: random.range(0.6, 5.0), ..window(time - 0.5, time + 9.0) },
        _ => Schedule::default(),
    }
}

/// A body's (or the world's) point that is at a place of the world now.
pub fn world_anchor(bodies: &[RigidBody], body: Option<usize>, place: DVec3) -> Anchor {
    Anchor { body, point: body.map_or(place, |i| bodies[i].pose().inverse_point(place)) }
}

/// A body's (or the world's) axis that points somewhere now.
pub fn world_axis(bodies: &[RigidBody], body: Option<usize>, direction: DVec3) -> Axis {
    Axis { body, direction: body.map_or(direction, |i| bodies[i].pose().inverse_vector(direction)) }
}

/// Where an anchor is.
pub fn world_point(bodies: &[RigidBody], anchor: &Anchor) -> DVec3 {
    anchor.body.map_or(anchor.point, |i| bodies[i].pose().point(anchor.point))
}

//! Motion against formulas: every joint, gear, spring, window and kinematic body, through `Dynamics::step` and by both
//! integrators that exhibits use.

mod clutches;
mod gears;
mod joints;
mod jumps;
mod loops;
mod pendulums;
mod reference;
mod springs;
mod swaps;
mod timing;
mod trajectories;

use soffio_geometry::bodies::{MassProperties, RigidBody};
use soffio_math::Function;
use soffio_math::Interpolation;
use soffio_math::{DMat3, DQuat, DVec3, PI, Pose, rotation};
use soffio_multibody::articulation::{Anchor, Axis, Constraint, ConstraintKind, Spring};
use soffio_multibody::dynamics::forces::Damping;
use soffio_multibody::dynamics::{Articulation, Dynamics, Integrator, KeyframeMotion, KinematicBody, Settings, Solver};

pub const G: f64 = 9.81;
pub const DT: f64 = 1.0 / 240.0;
/// ω₀ of the stabiliser, 1/s.
pub const OMEGA: f64 = 25.0;
/// The two integrators that exhibits use.
pub const INTEGRATORS: [Integrator; 2] = [Integrator::RungeKutta, Integrator::Precise];
/// Rounding error of an exact formula after some hundred steps, in m, rad, m/s and rad/s.
pub const ROUNDING: f64 = 1e-11;
/// Gap of a joint of a metre-sized mechanism: rounding of its coordinates.
pub const CLOSED: f64 = 1e-12;

/// An articulation and the world it moves in.
#[derive(Clone)]
pub struct World {
    pub bodies: Vec<RigidBody>,
    pub constraints: Vec<Constraint>,
    pub springs: Vec<Spring>,
    pub kinematic_bodies: Vec<KinematicBody>,
    pub damping: Damping,
    pub gravity: DVec3,
    pub solver: Solver,
}

impl World {
    /// These bodies under gravity, without joints.
    pub fn new(bodies: Vec<RigidBody>) -> Self {
        Self {
            bodies,
            constraints: Vec::new(),
            springs: Vec::new(),
            kinematic_bodies: Vec::new(),
            damping: Damping::default(),
            gravity: DVec3::NEG_Y * G,
            solver: Solver::Sparse,
        }
    }

    pub fn start(&self, integrator: Integrator) -> Dynamics {
        let articulation = Articulation {
            bodies: self.bodies.clone(),
            damping: vec![self.damping; self.bodies.len()],
            constraints: &self.constraints,
            limits: &[],
            springs: &self.springs,
            kinematic_bodies: &self.kinematic_bodies,
            colliders: &[],
            pairs: Vec::new(),
        };
        Dynamics::new(articulation, self.settings(integrator))
    }

    pub fn settings(&self, integrator: Integrator) -> Settings {
        Settings {
            gravity: self.gravity,
            // It switches damping alone: no pivot has friction.
            friction: self.damping != Damping::default(),
            stabilization_time: 1.0 / OMEGA,
            integrator,
            solver: self.solver,
        }
    }

    pub fn add(&mut self, name: &str, kind: ConstraintKind) {
        self.constraints.push(Constraint::new(name, kind));
    }

    /// Ball joint at `place` between `a` and `b` (or the world).
    pub fn pin(&mut self, name: &str, a: usize, b: Option<usize>, place: DVec3) {
        let kind = ConstraintKind::PointToPoint { a: self.anchor(Some(a), place), b: self.anchor(b, place) };
        self.add(name, kind);
    }

    /// Constant angle between directions of `a` and `b`, given as world axes.
    pub fn across(&mut self, name: &str, a: usize, t: DVec3, b: Option<usize>, n: DVec3) {
        let angle = Function::Constant(t.dot(n).asin());
        let kind = ConstraintKind::Orientation { a: self.axis(Some(a), t), b: self.axis(b, n), angle };
        self.add(name, kind);
    }

    /// Hinge of `a` about `axis` at `place`: a ball joint and two orientations.
    pub fn hinge(&mut self, name: &str, a: usize, b: Option<usize>, place: DVec3, axis: DVec3) {
        self.pin(&format!("{name}/nail"), a, b, place);
        let (u, v) = soffio_math::tangents(axis);
        self.across(&format!("{name}/across-1"), a, axis, b, u);
        self.across(&format!("{name}/across-2"), a, axis, b, v);
    }

    /// No relative rotation of `a` and `b`: three orientations.
    pub fn fix_turn(&mut self, name: &str, a: usize, b: Option<usize>) {
        for (k, (t, n)) in [(DVec3::X, DVec3::Y), (DVec3::Y, DVec3::Z), (DVec3::Z, DVec3::X)].into_iter().enumerate() {
            self.across(&format!("{name}/turn-{k}"), a, t, b, n);
        }
    }

    /// The point of `a` at `place` stays in a plane of `b` through it.
    pub fn plane(&mut self, name: &str, a: usize, b: Option<usize>, place: DVec3, normal: DVec3) {
        let (point, plane) = (self.anchor(Some(a), place), self.anchor(b, place));
        let normal = self.axis(b, normal).direction;
        self.add(name, ConstraintKind::PointOnPlane { point, plane, normal, offset: Function::default() });
    }

    /// The point stays on a straight wire: two planes.
    pub fn wire(&mut self, name: &str, a: usize, b: Option<usize>, place: DVec3, along: DVec3) {
        let (u, v) = soffio_math::tangents(along);
        self.plane(&format!("{name}/plane-1"), a, b, place, u);
        self.plane(&format!("{name}/plane-2"), a, b, place, v);
    }

    /// `a` slides along a direction without rotation.
    pub fn slider(&mut self, name: &str, a: usize, b: Option<usize>, along: DVec3) {
        self.fix_turn(name, a, b);
        self.wire(name, a, b, self.bodies[a].position, along);
    }

    /// Anchor of the body (or the world) at a world point.
    pub fn anchor(&self, body: Option<usize>, place: DVec3) -> Anchor {
        Anchor { body, point: body.map_or(place, |i| self.bodies[i].pose().inverse_point(place)) }
    }

    /// Axis of the body (or the world) along a world direction.
    pub fn axis(&self, body: Option<usize>, direction: DVec3) -> Axis {
        Axis { body, direction: body.map_or(direction, |i| self.bodies[i].pose().inverse_vector(direction)) }
    }
}

/// A body with its node frame at its centre of mass.
pub fn body(mass: f64, inertia: DVec3, position: DVec3) -> RigidBody {
    let properties = MassProperties { mass, center: DVec3::ZERO, inertia: DMat3::from_diagonal(inertia) };
    RigidBody::at_rest(properties, Pose { rotation: DQuat::IDENTITY, position })
}

/// A wheel with its axle along z.
pub fn wheel(mass: f64, inertia: f64, position: DVec3) -> RigidBody {
    body(mass, DVec3::new(0.6, 0.6, 1.0) * inertia, position)
}

/// A thin rod between two points.
pub fn rod(mass: f64, from: DVec3, to: DVec3) -> RigidBody {
    let separation = to - from;
    let l = separation.length();
    let across = mass * l * l / 12.0;
    let mut rod = body(mass, DVec3::new(across, 1e-3 * across, across), 0.5 * (from + to));
    rod.rotation = DQuat::from_rotation_arc(DVec3::NEG_Y, separation / l);
    rod
}

/// Steps without external forces. Returns the time that it took.
pub fn run(dynamics: &mut Dynamics, seconds: f64, dt: f64) {
    let no_wrenches = vec![[0.0; 6]; dynamics.bodies.len()];
    for _ in 0..(seconds / dt).round() as usize {
        step(dynamics, dt, &no_wrenches);
    }
}

pub fn step(dynamics: &mut Dynamics, dt: f64, external: &[[f64; 6]]) {
    assert_eq!(dynamics.step(dt, external, &mut Vec::new()), None, "bad numbers");
}

/// A kinematic body with constant acceleration from rest at the origin, until t = 20 s: splines through points of a parabola
/// are that parabola.
pub fn accelerated(body: usize, acceleration: DVec3) -> KinematicBody {
    let key = |i: i32| {
        let t = f64::from(i);
        (t, Pose { rotation: DQuat::IDENTITY, position: 0.5 * t * t * acceleration })
    };
    let keys = (-2..=22).map(key).collect();
    KinematicBody { body, motion: KeyframeMotion { keys, interpolation: Interpolation::Spline, repeat: false } }
}

/// A kinematic body that rotates about an axis through the origin at a constant rate, by 100 rad.
pub fn turning(body: usize, rate: DVec3) -> KinematicBody {
    let key = |i: i32| {
        let t = f64::from(i) / rate.length();
        (t, Pose { rotation: rotation(t * rate), position: DVec3::ZERO })
    };
    let keys = (-1..=100).map(key).collect();
    KinematicBody { body, motion: KeyframeMotion { keys, interpolation: Interpolation::Linear, repeat: false } }
}

/// Period of a physical pendulum with ω² = `square` at small swings, released at `angle`: T = (2π/ω)/agm(1, cos θ₀/2).
pub fn elliptic_period(square: f64, angle: f64) -> f64 {
    let (mut a, mut g) = (1.0, (0.5 * angle).cos());
    for _ in 0..8 {
        (a, g) = (0.5 * (a + g), (a * g).sqrt());
    }
    2.0 * PI / square.sqrt() / a
}

/// Mean time between upward zeros of a coordinate over `seconds`; the zeros are those of cubics through its values and
/// rates.
pub fn period(dynamics: &mut Dynamics, seconds: f64, dt: f64, read: impl Fn(&Dynamics) -> (f64, f64)) -> f64 {
    let no_wrenches = vec![[0.0; 6]; dynamics.bodies.len()];
    let mut zeros = Vec::new();
    let mut before = read(dynamics);
    for index in 0..(seconds / dt).round() as usize {
        step(dynamics, dt, &no_wrenches);
        let after = read(dynamics);
        if before.0 < 0.0 && after.0 >= 0.0 {
            let ((p, v), (q, w)) = (before, after);
            let cubic = |s: f64| {
                let r = 1.0 - s;
                r * r * ((1.0 + 2.0 * s) * p + s * dt * v) + s * s * ((1.0 + 2.0 * r) * q - r * dt * w)
            };
            let (mut low, mut high) = (0.0, 1.0);
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                if cubic(middle) < 0.0 { low = middle } else { high = middle }
            }
            zeros.push((index as f64 + low) * dt);
        }
        before = after;
    }
    assert!(zeros.len() > 1, "it does not swing");
    (zeros[zeros.len() - 1] - zeros[0]) / (zeros.len() - 1) as f64
}

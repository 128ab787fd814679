//! Motion against formulas: pendulums, conservation, friction, impacts, contact.

use soffio_geometry::bodies::{MassProperties, RigidBody};
use soffio_math::{DMat3, DQuat, DVec3, PI, Pose, rotation, sqrt};
use soffio_multibody::articulation::{Anchor, Constraint, ConstraintKind, PivotFriction};
use soffio_multibody::collision::{Collider, ReachableVolumes, Shape, pairs};
use soffio_multibody::dynamics::forces::Damping;
use soffio_multibody::dynamics::{
    Articulation, Dynamics, Impact, ImpactKind, Integrator, RollingResistance, Settings, Solver, SurfacePair,
};

const G: f64 = 9.81;
const DT: f64 = 1.0 / 240.0;
/// Bar of the joints, m; the rounding of a metre-sized mechanism is a thousand times less.
const JOINT_ERROR: f64 = 1e-9;

fn settings(friction: bool) -> Settings {
    Settings {
        gravity: DVec3::new(0.0, -G, 0.0),
        friction,
        stabilization_time: 0.04,
        integrator: Integrator::RungeKutta,
        solver: Solver::Sparse,
    }
}

fn body(mass: f64, inertia: DVec3, position: DVec3) -> RigidBody {
    let properties = MassProperties { mass, center: DVec3::ZERO, inertia: DMat3::from_diagonal(inertia) };
    RigidBody::at_rest(properties, Pose { rotation: DQuat::IDENTITY, position })
}

fn joint(name: &str, a: (Option<usize>, DVec3), b: (Option<usize>, DVec3)) -> Constraint {
    let anchor = |(body, point)| Anchor { body, point };
    Constraint::new(name, ConstraintKind::PointToPoint { a: anchor(a), b: anchor(b) })
}

fn articulation<'a>(bodies: Vec<RigidBody>, constraints: &'a [Constraint]) -> Articulation<'a> {
    let damping = vec![Damping::default(); bodies.len()];
    Articulation {
        bodies,
        damping,
        constraints,
        limits: &[],
        springs: &[],
        kinematic_bodies: &[],
        colliders: &[],
        pairs: Vec::new(),
    }
}

fn run(dynamics: &mut Dynamics, seconds: f64) -> Vec<Impact> {
    let no_wrenches = vec![[0.0; 6]; dynamics.bodies.len()];
    let mut impacts = Vec::new();
    for _ in 0..(seconds / DT).round() as usize {
        assert_eq!(dynamics.step(DT, &no_wrenches, &mut impacts), None, "bad numbers");
    }
    impacts
}

/// A rod pendulum of length `l` released at `angle` about z.
fn pendulum(l: f64, angle: f64) -> (Vec<RigidBody>, Vec<Constraint>) {
    let inertia = DVec3::new(1.0, 0.01, 1.0) * (0.1 * l * l / 12.0);
    let orientation = rotation(DVec3::Z * angle);
    let mut rod = body(0.1, inertia, orientation * DVec3::new(0.0, -0.5 * l, 0.0));
    rod.rotation = orientation;
    (vec![rod], vec![joint("nail", (Some(0), DVec3::new(0.0, 0.5 * l, 0.0)), (None, DVec3::ZERO))])
}

#[test]
fn a_pendulum_keeps_the_elliptic_period() {
    // T = (2π/ω₀) / agm(1, cos(θ₀/2)), ω₀² = m g (l/2) / (m l²/3).
    const PERIOD: f64 = 1e-6;
    let (l, angle) = (0.4, 0.5);
    let (bodies, constraints) = pendulum(l, angle);
    let mut dynamics = Dynamics::new(articulation(bodies, &constraints), settings(false));
    let no_wrenches = vec![[0.0; 6]];
    let mut crossings = Vec::new();
    let mut before = dynamics.bodies[0].position.x;
    for step in 0..240 * 20 {
        dynamics.step(DT, &no_wrenches, &mut Vec::new());
        let x = dynamics.bodies[0].position.x;
        if before < 0.0 && x >= 0.0 {
            crossings.push((f64::from(step) + before / (before - x)) * DT);
        }
        before = x;
    }
    let found = (crossings[crossings.len() - 1] - crossings[0]) / (crossings.len() - 1) as f64;
    let (mut a, mut g) = (1.0, (0.5 * angle).cos());
    for _ in 0..8 {
        (a, g) = (0.5 * (a + g), (a * g).sqrt());
    }
    let expected = 2.0 * PI / sqrt(1.5 * G / l) / a;
    assert!((found / expected - 1.0).abs() < PERIOD, "{found} s against {expected} s");
    assert!(dynamics.joint_error() < JOINT_ERROR);
}

/// A chain of rods swinging out of the plane.
fn chain(n: usize) -> (Vec<RigidBody>, Vec<Constraint>) {
    let l = 0.1;
    let mut bodies = Vec::new();
    let mut constraints = Vec::new();
    for i in 0..n {
        let mut rod = body(0.02, DVec3::new(1.7e-5, 1e-6, 1.7e-5), DVec3::new(0.0, -l * (i as f64 + 0.5), 0.0));
        rod.angular_velocity = DVec3::ZERO;
        // A rigid rotation about the nail: the joints' velocities agree.
        let spin = DVec3::new(0.6, 0.3, 1.2);
        rod.velocity = spin.cross(rod.position);
        rod.angular_velocity += spin;
        bodies.push(rod);
        let above = if i == 0 { (None, DVec3::ZERO) } else { (Some(i - 1), DVec3::new(0.0, -0.5 * l, 0.0)) };
        constraints.push(joint(&format!("link-{i}"), (Some(i), DVec3::new(0.0, 0.5 * l, 0.0)), above));
    }
    (bodies, constraints)
}

#[test]
fn energy_is_kept_without_wind_and_friction() {
    // The bar of the product: 1e-6 of the motion's energy over a minute.
    const DRIFT: f64 = 1e-6;
    let (bodies, constraints) = chain(4);
    let mut dynamics = Dynamics::new(articulation(bodies, &constraints), settings(false));
    let start = dynamics.energy();
    let scale: f64 = dynamics.bodies.iter().map(RigidBody::kinetic_energy).sum();
    let mut worst: f64 = 0.0;
    for _ in 0..60 {
        run(&mut dynamics, 1.0);
        worst = worst.max((dynamics.energy() - start).abs() / scale);
        assert!(dynamics.joint_error() < JOINT_ERROR);
    }
    assert!(worst < DRIFT, "energy drifted by {worst} of {scale} J");
}

#[test]
fn pivot_friction_stops_a_wheel_when_coulomb_says() {
    // A disc on a nail at its centre, spinning about the vertical: dω/dt = −μ m g r / I, then still for good.
    const SPREAD: f64 = 0.01;
    let (mass, inertia, mu, r, spin) = (0.5, 1e-3, 0.3, 0.001, 2.0);
    let mut disc = body(mass, DVec3::new(5e-4, inertia, 5e-4), DVec3::ZERO);
    disc.angular_velocity = DVec3::Y * spin;
    let mut nail = joint("nail", (Some(0), DVec3::new(0.0, 0.01, 0.0)), (None, DVec3::new(0.0, 0.01, 0.0)));
    nail.friction = Some(PivotFriction { coefficient: mu, radius: r });
    let constraints = [nail];
    let mut dynamics = Dynamics::new(articulation(vec![disc], &constraints), settings(true));
    let rate = mu * mass * G * r / inertia;
    run(&mut dynamics, 0.5 * spin / rate);
    let half = dynamics.bodies[0].angular_velocity.y;
    assert!((half / (0.5 * spin) - 1.0).abs() < SPREAD, "{half} rad/s halfway");
    run(&mut dynamics, 0.6 * spin / rate);
    assert!(dynamics.bodies[0].angular_velocity.length() < 1e-5, "still turning");
}

#[test]
fn a_scattered_articulation_closes_its_joints() {
    let (mut bodies, constraints) = chain(3);
    for (i, rod) in bodies.iter_mut().enumerate() {
        rod.velocity = DVec3::ZERO;
        rod.angular_velocity = DVec3::ZERO;
        rod.position += DVec3::new(0.2, 0.1, -0.15) * (1.0 + i as f64);
    }
    let mut dynamics = Dynamics::new(articulation(bodies, &constraints), settings(false));
    run(&mut dynamics, 3.0);
    assert!(dynamics.joint_error() < JOINT_ERROR, "{} m apart", dynamics.joint_error());
}

fn disc_collider(body: usize, radius: f64, thickness: f64) -> Collider {
    let corner = |i: usize| {
        let angle = 2.0 * PI * i as f64 / 24.0;
        DVec3::new(radius * angle.cos(), radius * angle.sin(), 0.0)
    };
    Collider {
        body: Some(body),
        shape: Shape::plate(&(0..24).map(corner).collect::<Vec<_>>(), 0.5 * thickness),
        material: 0,
        node: String::new(),
    }
}

fn surfaces(colliders: &[Collider], restitution: f64, friction: f64) -> Vec<SurfacePair> {
    pairs(colliders, &[], &ReachableVolumes::default())
        .meet
        .into_iter()
        .map(|pair| SurfacePair {
            pair,
            restitution,
            friction,
            full_slip: 0.0,
            resistance: RollingResistance::default(),
        })
        .collect()
}

#[test]
fn thin_plates_at_speed_never_pass_through_each_other() {
    // Half a millimetre of sheet at 5 … 40 m/s moves 20 … 170 mm a step.
    let (r, t) = (0.05, 5e-4);
    for (trial, speed) in [5.0, 10.0, 20.0, 40.0].into_iter().enumerate() {
        let inertia = DVec3::new(1.0, 1.0, 2.0) * (0.25 * 0.02 * r * r);
        let mut flying = body(0.02, inertia, DVec3::new(0.01, 0.005 * trial as f64, 0.3));
        flying.velocity = DVec3::new(0.0, 0.0, -speed);
        flying.angular_velocity = DVec3::new(3.0, -2.0, 1.0);
        let standing = body(0.02, inertia, DVec3::ZERO);
        let colliders = [disc_collider(0, r, t), disc_collider(1, r, t)];
        let mut articulation = articulation(vec![flying, standing], &[]);
        articulation.colliders = &colliders;
        articulation.pairs = surfaces(&colliders, 0.5, 0.3);
        let settings = Settings { gravity: DVec3::ZERO, ..settings(true) };
        let mut dynamics = Dynamics::new(articulation, settings);
        let momentum = |d: &Dynamics| d.bodies.iter().map(|b| b.properties.mass * b.velocity).sum::<DVec3>();
        let spin = |d: &Dynamics| {
            d.bodies
                .iter()
                .map(|b| b.properties.mass * b.position.cross(b.velocity) + b.inertia_world() * b.angular_velocity)
                .sum::<DVec3>()
        };
        let (p, l, e) = (momentum(&dynamics), spin(&dynamics), dynamics.energy());
        let impacts = run(&mut dynamics, 0.1);
        assert!(!impacts.is_empty(), "trial {trial}: passed through");
        // Momentum and angular momentum: rounding through impacts, and RK4 on the free spin,
        // 3e-10 a step at 160 rad/s.
        assert!((momentum(&dynamics) - p).length() < 1e-12, "trial {trial}");
        let turned = (spin(&dynamics) - l).length();
        println!("{speed} m/s: turned by {turned:e}");
        assert!(turned < 1e-8, "trial {trial}: {turned} of {}", l.length());
        assert!(dynamics.energy() <= e * (1.0 + 1e-9), "trial {trial}: energy rose");
    }
}

#[test]
fn two_pendulums_trade_their_speed_as_newton_says() {
    // Equal balls on nails, e = 1, central: the moving one stops and the other leaves with its speed.
    const TRADED: f64 = 1e-3;
    let r = 0.02;
    let ball = |x: f64| body(0.1, DVec3::splat(0.4 * 0.1 * r * r), DVec3::new(x, 0.0, 0.0));
    let sphere =
        |b: usize| Collider { body: Some(b), shape: Shape::sphere(DVec3::ZERO, r), material: 0, node: "".into() };
    let mut bodies = vec![ball(0.0), ball(2.0 * r)];
    let hang = |i: usize, x: f64| {
        joint(&format!("nail-{i}"), (Some(i), DVec3::new(0.0, 0.5, 0.0)), (None, DVec3::new(x, 0.5, 0.0)))
    };
    let constraints = [hang(0, 0.0), hang(1, 2.0 * r)];
    let angle = -0.3;
    bodies[0].position = DVec3::new(0.0, 0.5, 0.0) + rotation(DVec3::Z * angle) * DVec3::new(0.0, -0.5, 0.0);
    bodies[0].rotation = rotation(DVec3::Z * angle);
    let colliders = [sphere(0), sphere(1)];
    let mut articulation = articulation(bodies, &constraints);
    articulation.colliders = &colliders;
    articulation.pairs = surfaces(&colliders, 1.0, 0.0);
    let mut dynamics = Dynamics::new(articulation, settings(false));
    let no_wrenches = vec![[0.0; 6]; 2];
    let mut impacts: Vec<Impact> = Vec::new();
    while impacts.is_empty() {
        dynamics.step(DT, &no_wrenches, &mut impacts);
    }
    assert_eq!(impacts[0].kind, ImpactKind::Impact);
    let left = dynamics.bodies[0].velocity.length();
    let gone = dynamics.bodies[1].velocity.length();
    // Energy: m g l (1 − cos θ) = ½ (m l² + I) ω².
    let (m, l, i) = (0.1, 0.5, 0.4 * 0.1 * r * r);
    let expected = l * sqrt(2.0 * m * G * l * (1.0 - angle.cos()) / (m * l * l + i));
    assert!((gone / expected - 1.0).abs() < TRADED, "{gone} against {expected} m/s");
    // Gravity gives it that speed in the remainder of the step.
    assert!(left < 0.02 * expected, "kept {left} m/s");
    assert!((impacts[0].speed / expected - 1.0).abs() < TRADED);
    assert!(dynamics.joint_error() < JOINT_ERROR);
}

#[test]
fn a_plate_that_leans_on_another_rests_without_jitter_or_sinking() {
    // A hanging rod drawn against a fixed ball by its own weight, for ten seconds.
    let (mut bodies, constraints) = pendulum(0.4, 0.35);
    bodies[0].angular_velocity = DVec3::ZERO;
    let rod = Collider {
        body: Some(0),
        shape: Shape::capsule(DVec3::new(0.0, -0.2, 0.0), DVec3::new(0.0, 0.2, 0.0), 0.002),
        material: 0,
        node: String::new(),
    };
    let ends = [-0.05, 0.05].map(|z| DVec3::new(0.06, -0.3, z));
    let peg = Collider { body: None, shape: Shape::capsule(ends[0], ends[1], 0.01), material: 0, node: "".into() };
    let colliders = [rod, peg];
    let mut articulation = articulation(bodies, &constraints);
    articulation.colliders = &colliders;
    articulation.pairs = surfaces(&colliders, 0.4, 0.3);
    let mut dynamics = Dynamics::new(articulation, settings(true));
    let hits = run(&mut dynamics, 6.0);
    assert!(hits.iter().any(|i| i.kind == ImpactKind::RestingContact), "it never came to rest: {hits:?}");
    let place = dynamics.bodies[0].position;
    let later = run(&mut dynamics, 4.0);
    assert!(later.is_empty(), "{later:?}");
    // It sinks by no more than rounding. Along the peg it creeps: friction acts on speeds at the end of each substep,
    // so a held body slips by half its acceleration times the substep squared, a few micrometres a second.
    const SINK: f64 = 1e-9;
    const CREEP: f64 = 2e-5;
    let displacement = dynamics.bodies[0].position - place;
    assert!(displacement.x.hypot(displacement.y) < SINK && displacement.z.abs() < CREEP, "moved by {displacement}");
    assert!(dynamics.bodies[0].velocity.length() < 1e-4);
}

//! Contacts against formulas: rest, sliding, rolling, hits of several points, limits.

use soffio::articulation::Constraint;
use soffio::bodies::{MassProperties, RigidBody};
use soffio::collision::{Collider, Shape, pairs};
use soffio::dynamics::forces::Damping;
use soffio::dynamics::{Dynamics, Figure, Impact, ImpactKind, Integrator, Settings, Solver, SurfacePair};
use soffio::math::{DMat3, DQuat, DVec3, Pose, rotation};

const G: f64 = 9.81;
const DT: f64 = 1.0 / 240.0;
/// What rests stays: a minute's way and the speed at its end.
const STAYS: f64 = 1e-6;
const STILL: f64 = 1e-5;

fn settings() -> Settings {
    Settings {
        gravity: DVec3::new(0.0, -G, 0.0),
        friction: true,
        stabilization_time: 0.04,
        integrator: Integrator::RungeKutta,
        solver: Solver::Sparse,
    }
}

fn body(mass: f64, inertia: DVec3, position: DVec3) -> RigidBody {
    let properties = MassProperties { mass, center: DVec3::ZERO, inertia: DMat3::from_diagonal(inertia) };
    RigidBody::at_rest(properties, Pose { rotation: DQuat::IDENTITY, position })
}

fn ball(mass: f64, radius: f64, position: DVec3) -> RigidBody {
    body(mass, DVec3::splat(0.4 * mass * radius * radius), position)
}

fn cube(mass: f64, half: DVec3, position: DVec3) -> RigidBody {
    let s = half * half;
    body(mass, mass / 3.0 * DVec3::new(s.y + s.z, s.x + s.z, s.x + s.y), position)
}

fn collider(body: Option<usize>, shape: Shape) -> Collider {
    Collider { body, shape, material: 0, node: String::new() }
}

fn sphere(body: usize, radius: f64) -> Collider {
    collider(Some(body), Shape::sphere(DVec3::ZERO, radius))
}

/// A box of these half extents, its edges rounded by a millimetre.
fn block(body: usize, half: DVec3) -> Collider {
    collider(Some(body), Shape::cuboid(Pose::IDENTITY, half, 1e-3))
}

/// The floor y = 0.
fn floor() -> Collider {
    collider(None, Shape::plane(DVec3::ZERO, DVec3::Y))
}

struct Scene {
    bodies: Vec<RigidBody>,
    constraints: Vec<Constraint>,
    colliders: Vec<Collider>,
    restitution: f64,
    friction: f64,
    gravity: DVec3,
}

impl Scene {
    fn new(bodies: Vec<RigidBody>, colliders: Vec<Collider>) -> Self {
        let gravity = settings().gravity;
        Self { bodies, constraints: Vec::new(), colliders, restitution: 0.3, friction: 0.5, gravity }
    }

    fn dynamics(&self) -> Dynamics {
        let surfaces = pairs(&self.colliders, &[])
            .into_iter()
            .map(|pair| SurfacePair { pair, restitution: self.restitution, friction: self.friction })
            .collect();
        let figure = Figure {
            bodies: self.bodies.clone(),
            damping: vec![Damping::default(); self.bodies.len()],
            constraints: &self.constraints,
            limits: &[],
            springs: &[],
            drives: &[],
            colliders: &self.colliders,
            pairs: surfaces,
        };
        Dynamics::new(figure, Settings { gravity: self.gravity, ..settings() })
    }
}

fn run(dynamics: &mut Dynamics, seconds: f64) -> Vec<Impact> {
    let still = vec![[0.0; 6]; dynamics.bodies.len()];
    let mut impacts = Vec::new();
    for _ in 0..(seconds / DT).round() as usize {
        assert_eq!(dynamics.step(DT, &still, &mut impacts), 0, "bad numbers");
    }
    impacts
}

/// Runs for this long and asserts that nothing moves.
fn assert_stays(dynamics: &mut Dynamics, seconds: f64) {
    let before = dynamics.bodies.clone();
    let began = std::time::Instant::now();
    let impacts = run(dynamics, seconds);
    let each = began.elapsed().as_secs_f64() * DT / seconds * 1e6;
    let mut worst: (f64, f64) = (0.0, 0.0);
    for (now, then) in dynamics.bodies.iter().zip(&before) {
        let turn = now.rotation.angle_between(then.rotation);
        worst.0 = worst.0.max(now.position.distance(then.position)).max(0.1 * turn);
        worst.1 = worst.1.max(now.velocity.length()).max(0.1 * now.angular_velocity.length());
    }
    println!("stayed within {:e} m, {:e} m/s; {each:.1} µs a step", worst.0, worst.1);
    assert!(impacts.is_empty(), "{impacts:?}");
    assert!(worst.0 < STAYS && worst.1 < STILL, "moved by {} m, {} m/s", worst.0, worst.1);
}

/// Gravity as it is seen from an incline of this angle, which falls towards +x.
fn inclined(angle: f64) -> DVec3 {
    rotation(DVec3::Z * angle) * DVec3::new(0.0, -G, 0.0)
}

#[test]
fn a_ball_rolls_down_an_incline_at_five_sevenths() {
    // The ball rides within the touching layer of 2 µm, halfway of which its point of contact lies.
    const RATE: f64 = 5e-5;
    let (angle, r) = (0.2f64, 0.02);
    let mut scene = Scene::new(vec![ball(0.1, r, DVec3::new(0.0, r, 0.0))], vec![sphere(0, r), floor()]);
    scene.gravity = inclined(angle);
    scene.restitution = 0.0;
    let mut dynamics = scene.dynamics();
    run(&mut dynamics, 0.1);
    let v = dynamics.bodies[0].velocity.x;
    let began = std::time::Instant::now();
    run(&mut dynamics, 1.0);
    println!("{:.1} µs a step", began.elapsed().as_secs_f64() / 240.0 * 1e6);
    let ball = dynamics.bodies[0];
    let found = ball.velocity.x - v;
    let expected = 5.0 / 7.0 * G * angle.sin();
    assert!((found / expected - 1.0).abs() < RATE, "{found} m/s² against {expected}");
    assert!((ball.velocity.x + r * ball.angular_velocity.z).abs() < RATE * ball.velocity.x, "it slips");
    assert!((ball.position.y - r).abs() < 3e-6, "off the plane by {}", ball.position.y - r);
}

#[test]
fn a_ball_thrown_flat_slides_until_it_rolls() {
    // μ g t slows it, (5/2) μ g t/r spins it: rolls at v = 5/7 v₀, after t = 2 v₀/(7 μ g).
    // Half the touching layer of 2 µm over the radius.
    const RATE: f64 = 5e-5;
    let (r, v0, mu) = (0.02, 1.0, 0.3);
    let mut thrown = ball(0.1, r, DVec3::new(0.0, r, 0.0));
    thrown.velocity.x = v0;
    let mut scene = Scene::new(vec![thrown], vec![sphere(0, r), floor()]);
    (scene.friction, scene.restitution) = (mu, 0.0);
    let mut dynamics = scene.dynamics();
    let slides = 2.0 * v0 / (7.0 * mu * G);
    run(&mut dynamics, 0.5 * slides);
    let half = dynamics.bodies[0].velocity.x;
    let time = (0.5 * slides / DT).round() * DT;
    assert!((half - (v0 - mu * G * time)).abs() < 1e-3, "{half} m/s halfway");
    run(&mut dynamics, slides);
    let ball = dynamics.bodies[0];
    assert!((ball.velocity.x / (5.0 / 7.0 * v0) - 1.0).abs() < RATE, "{} m/s", ball.velocity.x);
    let rolls = ball.velocity.x;
    run(&mut dynamics, 1.0);
    assert!((dynamics.bodies[0].velocity.x - rolls).abs() < 1e-9, "rolling loses nothing");
}

#[test]
fn a_block_sticks_below_the_angle_of_friction_and_slides_above() {
    const RATE: f64 = 1e-6;
    let half = DVec3::new(0.05, 0.02, 0.04);
    let mu: f64 = 0.4;
    let on = |angle: f64| {
        let mut scene = Scene::new(vec![cube(0.3, half, DVec3::Y * half.y)], vec![block(0, half), floor()]);
        scene.gravity = inclined(angle);
        (scene.friction, scene.restitution) = (mu, 0.0);
        scene.dynamics()
    };
    let mut sticks = on(mu.atan() - 0.01);
    run(&mut sticks, 0.5);
    assert_stays(&mut sticks, 60.0);
    let angle = mu.atan() + 0.1;
    let mut slides = on(angle);
    run(&mut slides, 0.1);
    let v = slides.bodies[0].velocity.x;
    run(&mut slides, 0.5);
    let found = (slides.bodies[0].velocity.x - v) / 0.5;
    let expected = G * (angle.sin() - mu * angle.cos());
    assert!((found / expected - 1.0).abs() < RATE, "{found} against {expected} m/s²");
}

#[test]
fn a_stack_of_boxes_stays() {
    let half = DVec3::new(0.05, 0.03, 0.05);
    let bodies = (0..5)
        .map(|i| {
            cube(0.2, half, DVec3::new(0.003 * (i % 2) as f64, (2 * i + 1) as f64 * half.y + 1e-4 * i as f64, 0.0))
        })
        .collect();
    let mut colliders: Vec<_> = (0..5).map(|i| block(i, half)).collect();
    colliders.push(floor());
    let mut dynamics = Scene::new(bodies, colliders).dynamics();
    let landed = run(&mut dynamics, 2.0);
    assert!(landed.iter().any(|i| i.kind == ImpactKind::Rest));
    assert_stays(&mut dynamics, 60.0);
}

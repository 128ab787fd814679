//! Contacts against formulas: resting, sliding, rolling, impacts at several points, limits.

mod asleep;
mod loaded;
mod many;
mod tyres;

use assert_no_alloc::assert_no_alloc;
use soffio_geometry::bodies::{MassProperties, RigidBody};
use soffio_math::{DMat3, DQuat, DVec3, PI, Pose, rotation};
use soffio_multibody::articulation::{Anchor, Axis, Constraint, ConstraintKind, Limit, LimitKind, Measure};
use soffio_multibody::collision::{Collider, ReachableVolumes, Shape, pairs};
use soffio_multibody::dynamics::forces::Damping;
use soffio_multibody::dynamics::{
    Articulation, Dynamics, Impact, ImpactKind, Integrator, RollingResistance, Settings, Solver, SurfacePair,
};

const G: f64 = 9.81;
const DT: f64 = 1.0 / 240.0;
/// Resting bodies move by no more than this in a minute, m.
const STAYS: f64 = 1e-6;
/// And are no faster than this at its end, m/s.
const STILL_SPEED: f64 = 1e-5;

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
    limits: Vec<Limit>,
    colliders: Vec<Collider>,
    restitution: f64,
    friction: f64,
    full_slip: f64,
    gravity: DVec3,
    damping: f64,
}

impl Scene {
    fn new(bodies: Vec<RigidBody>, colliders: Vec<Collider>) -> Self {
        let gravity = settings().gravity;
        Self {
            bodies,
            constraints: Vec::new(),
            limits: Vec::new(),
            colliders,
            restitution: 0.3,
            friction: 0.5,
            full_slip: 0.0,
            gravity,
            damping: 0.0,
        }
    }

    fn dynamics(&self) -> Dynamics {
        let surfaces = pairs(&self.colliders, &[], &ReachableVolumes::default())
            .meet
            .into_iter()
            .map(|pair| SurfacePair {
                pair,
                restitution: self.restitution,
                friction: self.friction,
                full_slip: self.full_slip,
                resistance: RollingResistance::default(),
            })
            .collect();
        let articulation = Articulation {
            bodies: self.bodies.clone(),
            damping: vec![Damping { linear: self.damping, angular: self.damping }; self.bodies.len()],
            constraints: &self.constraints,
            limits: &self.limits,
            springs: &[],
            kinematic_bodies: &[],
            colliders: &self.colliders,
            pairs: surfaces,
        };
        Dynamics::new(articulation, Settings { gravity: self.gravity, ..settings() })
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

/// Runs for this long and asserts that nothing moves.
fn assert_stays(dynamics: &mut Dynamics, seconds: f64) {
    let before = dynamics.bodies.clone();
    let began = std::time::Instant::now();
    let impacts = run(dynamics, seconds);
    let each = began.elapsed().as_secs_f64() * DT / seconds * 1e6;
    let mut worst: (f64, f64) = (0.0, 0.0);
    for (now, then) in dynamics.bodies.iter().zip(&before) {
        let angle = now.rotation.angle_between(then.rotation);
        worst.0 = worst.0.max(now.position.distance(then.position)).max(0.1 * angle);
        worst.1 = worst.1.max(now.velocity.length()).max(0.1 * now.angular_velocity.length());
    }
    println!("stayed within {:e} m, {:e} m/s; {each:.1} µs a step", worst.0, worst.1);
    assert!(impacts.is_empty(), "{impacts:?}");
    assert!(worst.0 < STAYS && worst.1 < STILL_SPEED, "moved by {} m, {} m/s", worst.0, worst.1);
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
    let report = dynamics.contact_reports().next().expect("it rolls on the plane");
    assert!(report.slip.length() < RATE * ball.velocity.x, "{report:?}");
    for roll in report.roll {
        assert!((roll.length() / ball.velocity.x - 1.0).abs() < 1e-2, "{report:?} at {} m/s", ball.velocity.x);
    }
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
    // Once it has found its place in the touching layer, rolling loses nothing.
    run(&mut dynamics, 0.5);
    let rolls = dynamics.bodies[0].velocity.x;
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
    // All its corners together bear its weight, each slides as fast as it does, and none moves over the block itself.
    let reports: Vec<_> = slides.contact_reports().collect();
    let pressed: f64 = reports.iter().map(|t| t.normal_force).sum();
    assert!((pressed / (0.3 * G * angle.cos()) - 1.0).abs() < RATE, "{pressed} N");
    let speed = slides.bodies[0].velocity.x;
    for report in reports {
        assert!((report.slip.length() / speed - 1.0).abs() < RATE, "{report:?} at {speed} m/s");
        let scraped = report.roll.map(|roll| roll.length() / speed);
        assert!(scraped[0].min(scraped[1]) < 1e-3 && (scraped[0].max(scraped[1]) - 1.0).abs() < 1e-3, "{report:?}");
    }
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
    assert!(landed.iter().any(|i| i.kind == ImpactKind::RestingContact));
    assert_stays(&mut dynamics, 60.0);
}

#[test]
fn a_light_box_under_a_heavy_one_holds() {
    // 1 : 100, the light one below.
    let half = DVec3::new(0.05, 0.03, 0.05);
    let bodies = vec![cube(1e-3, half, DVec3::Y * half.y), cube(0.1, half, DVec3::Y * 3.0 * half.y)];
    let colliders = vec![block(0, half), block(1, half), floor()];
    let mut dynamics = Scene::new(bodies, colliders).dynamics();
    run(&mut dynamics, 2.0);
    assert_stays(&mut dynamics, 10.0);
    let sunk = 3.0 * half.y - dynamics.bodies[1].position.y;
    assert!(sunk.abs() < 1e-5, "sunk by {sunk} m");
}

#[test]
fn a_ring_rests_on_a_hook_and_a_ball_in_a_cup() {
    // Ring of twelve rods about a peg along z, a little aside; and a ball among three pegs.
    let (r, n) = (0.02, 12);
    let corner = |i: usize| rotation(DVec3::Z * (2.0 * PI * i as f64 / n as f64)) * DVec3::Y * r;
    let mut ring = body(0.02, DVec3::new(2e-6, 2e-6, 4e-6), DVec3::Y * (0.5 - r + 0.0015));
    ring.rotation = rotation(DVec3::Z * 0.05);
    let mut colliders: Vec<_> =
        (0..n).map(|i| collider(Some(0), Shape::capsule(corner(i), corner(i + 1), 1e-3))).collect();
    let peg = |z: f64| DVec3::new(0.0, 0.5 - 0.0015, z);
    colliders.push(collider(None, Shape::capsule(peg(-0.02), peg(0.02), 1.5e-3)));
    colliders.push(sphere(1, 0.01));
    for i in 0..3 {
        let out = rotation(DVec3::Y * (2.0 * PI / 3.0 * i as f64)) * DVec3::X * 0.008;
        colliders.push(collider(None, Shape::capsule(out + DVec3::X * 0.2, out + DVec3::new(0.2, -0.05, 0.0), 2e-3)));
    }
    let mut scene = Scene::new(vec![ring, ball(0.01, 0.01, DVec3::new(0.201, 0.012, 0.0005))], colliders);
    // Rolling loses nothing: the air must.
    scene.damping = 3.0;
    let mut dynamics = scene.dynamics();
    run(&mut dynamics, 20.0);
    assert!(dynamics.bodies.iter().all(|b| b.position.y > -0.01), "fell: {:?}", dynamics.bodies);
    assert_stays(&mut dynamics, 60.0);
}

#[test]
fn a_box_that_lands_flat_does_not_spin() {
    const FLAT: f64 = 1e-9;
    let half = DVec3::new(0.05, 0.03, 0.04);
    let mut scene = Scene::new(vec![cube(0.2, half, DVec3::Y * 0.1)], vec![block(0, half), floor()]);
    scene.restitution = 0.5;
    let mut dynamics = scene.dynamics();
    let no_wrenches = vec![[0.0; 6]];
    let mut impacts: Vec<Impact> = Vec::new();
    while impacts.is_empty() {
        dynamics.step(DT, &no_wrenches, &mut impacts);
    }
    let impact = impacts[0];
    let landed = dynamics.bodies[0];
    let speed = (2.0 * G * (0.1 - half.y)).sqrt();
    assert!((impact.speed / speed - 1.0).abs() < 1e-4, "{} against {speed} m/s", impact.speed);
    assert!((impact.impulse / (1.5 * 0.2 * impact.speed) - 1.0).abs() < 1e-6, "{} N s", impact.impulse);
    assert!(landed.angular_velocity.length() < FLAT, "spins at {}", landed.angular_velocity);
    let expected = 0.5 * impact.speed - G * (DT - impact.time);
    assert!((landed.velocity.y - expected).abs() < 1e-6, "{} against {expected} m/s", landed.velocity.y);
    assert_eq!(impacts.len(), 1, "one landing is one impact");
}

#[test]
fn of_a_cradle_of_balls_as_many_leave_as_come() {
    // Equal balls in contact, e = 1: impacts pass from ball to ball (Newton's cradle). Those left in touch find their
    // place in the touching layer at micrometres in hundredths of a second.
    const PASSED: f64 = 1e-4;
    let r = 0.02;
    for coming in 1..=2 {
        let mut bodies: Vec<_> = (0..5).map(|i| ball(0.1, r, DVec3::X * (2.0 * r * i as f64))).collect();
        for thrown in &mut bodies[..coming] {
            thrown.position.x -= 0.01;
            thrown.velocity.x = 1.0;
        }
        let mut scene = Scene::new(bodies, (0..5).map(|i| sphere(i, r)).collect());
        (scene.restitution, scene.friction, scene.gravity) = (1.0, 0.0, DVec3::ZERO);
        let mut dynamics = scene.dynamics();
        run(&mut dynamics, 0.1);
        for (i, ball) in dynamics.bodies.iter().enumerate() {
            let expected = if i >= 5 - coming { 1.0 } else { 0.0 };
            assert!((ball.velocity.x - expected).abs() < PASSED, "{coming} came, ball {i}: {}", ball.velocity.x);
        }
    }
}

#[test]
fn numbers_stay_finite_between_closing_walls() {
    // A ball of a gram between blocks of a tonne; then one that overlaps both of two fixed walls.
    let half = DVec3::new(0.1, 0.1, 0.1);
    let mut left = cube(1e3, half, DVec3::X * -0.2);
    let mut right = cube(1e3, half, DVec3::X * 0.2);
    (left.velocity.x, right.velocity.x) = (0.3, -0.3);
    let mut scene = Scene::new(
        vec![ball(1e-3, 0.02, DVec3::new(0.0, 0.01, 0.0)), left, right],
        vec![sphere(0, 0.02), block(1, half), block(2, half)],
    );
    scene.gravity = DVec3::ZERO;
    let mut dynamics = scene.dynamics();
    let before = dynamics.energy();
    run(&mut dynamics, 3.0);
    assert!(dynamics.energy() <= before * (1.0 + 1e-9), "{} of {before} J", dynamics.energy());
    let wall =
        |x: f64| collider(None, Shape::cuboid(Pose { rotation: DQuat::IDENTITY, position: DVec3::X * x }, half, 1e-3));
    let scene = Scene::new(vec![ball(1e-3, 0.02, DVec3::ZERO)], vec![sphere(0, 0.02), wall(0.119), wall(-0.119)]);
    let mut dynamics = scene.dynamics();
    run(&mut dynamics, 3.0);
    assert!(dynamics.bodies[0].is_finite() && dynamics.bodies[0].velocity.length() < 50.0);
}

#[test]
fn a_warm_step_allocates_nothing() {
    let half = DVec3::new(0.05, 0.03, 0.05);
    let mut bodies: Vec<_> = (0..3).map(|i| cube(0.2, half, DVec3::Y * (0.061 * i as f64 + 0.031))).collect();
    bodies.push(ball(0.05, 0.02, DVec3::new(0.0, 0.8, 0.0)));
    let mut colliders: Vec<_> = (0..3).map(|i| block(i, half)).collect();
    colliders.extend([sphere(3, 0.02), floor()]);
    let mut dynamics = Scene::new(bodies, colliders).dynamics();
    let no_wrenches = vec![[0.0; 6]; 4];
    let mut impacts = Vec::with_capacity(10_000);
    for _ in 0..24 {
        dynamics.step(DT, &no_wrenches, &mut impacts);
    }
    let before = impacts.len();
    assert_no_alloc(|| {
        for _ in 0..480 {
            dynamics.step(DT, &no_wrenches, &mut impacts);
        }
    });
    assert!(impacts.len() > before, "there was no impact");
}

fn anchor(body: Option<usize>, point: DVec3) -> Anchor {
    Anchor { body, point }
}

fn hinge(body: usize, at: DVec3, local: DVec3) -> Vec<Constraint> {
    let axis = |body, direction| Axis { body, direction };
    let across = |n| ConstraintKind::Orientation { a: axis(Some(body), DVec3::Z), b: axis(None, n), angle: 0.0.into() };
    let point = ConstraintKind::PointToPoint { a: anchor(Some(body), local), b: anchor(None, at) };
    vec![
        Constraint::new("hinge/point", point),
        Constraint::new("hinge/x", across(DVec3::X)),
        Constraint::new("hinge/y", across(DVec3::Y)),
    ]
}

fn angle_about_z(body: usize) -> Measure {
    Measure::Angle { axis: Axis { body: Some(body), direction: DVec3::Z }, frame: None }
}

#[test]
fn a_hinge_stops_at_its_range_bounces_and_rests_there() {
    // A rod falls from level about its end on to a stop at −0.5 rad: ω² = 3 g sin(0.5)/l there.
    const SPEED: f64 = 1e-6;
    let l = 0.3;
    let rod = body(0.1, DVec3::new(1e-6, 1.0, 1.0) * (0.1 * l * l / 12.0), DVec3::X * 0.5 * l);
    let mut scene = Scene::new(vec![rod], Vec::new());
    scene.constraints = hinge(0, DVec3::ZERO, DVec3::X * -0.5 * l);
    let kind = LimitKind::Range { measure: angle_about_z(0), min: -0.5, max: f64::INFINITY };
    scene.limits = vec![Limit { name: "stop".into(), kind, restitution: 0.4 }];
    let mut dynamics = scene.dynamics();
    let impacts = run(&mut dynamics, 4.0);
    let expected = (3.0 * G * 0.5f64.sin() / l).sqrt();
    assert_eq!((impacts[0].kind, impacts[0].colliders), (ImpactKind::Stop, None));
    assert!((impacts[0].speed / expected - 1.0).abs() < SPEED, "{} against {expected} rad/s", impacts[0].speed);
    // From bounce to bounce the speed falls by e.
    let ratio = impacts[1].speed / impacts[0].speed;
    assert!((ratio - 0.4).abs() < 1e-3, "bounced with {ratio}");
    assert_eq!(impacts[impacts.len() - 1].kind, ImpactKind::RestingContact);
    assert_stays(&mut dynamics, 10.0);
    assert!(dynamics.joint_error() < 1e-9);
}

#[test]
fn a_cord_goes_taut_and_holds() {
    // A ball falls on a slack cord of 0.2 m, aside of its nail: it is caught, then swings as a pendulum.
    const LENGTH: f64 = 1e-5;
    let mut scene = Scene::new(vec![ball(0.1, 0.01, DVec3::new(0.05, 0.0, 0.0))], Vec::new());
    let kind =
        LimitKind::Distance { a: anchor(Some(0), DVec3::ZERO), b: anchor(None, DVec3::ZERO), min: 0.0, max: 0.2 };
    scene.limits = vec![Limit { name: "cord".into(), kind, restitution: 0.0 }];
    let mut dynamics = scene.dynamics();
    let caught = run(&mut dynamics, 0.5);
    assert!(!caught.is_empty());
    let energy = dynamics.energy();
    let mut longest: f64 = 0.0;
    for _ in 0..240 * 5 {
        run(&mut dynamics, DT);
        longest = longest.max(dynamics.bodies[0].position.length());
    }
    assert!((longest - 0.2).abs() < LENGTH, "{longest} m");
    let lost = (energy - dynamics.energy()) / (0.1 * G * 0.01);
    // A cord's force is constant over a substep: second order, because its rotation is extrapolated.
    assert!(lost.abs() < 5e-3, "the taut cord lost or gave {lost} of the swing");
}

#[test]
fn a_ratchet_falls_back_to_the_last_tooth_and_no_farther() {
    let mut scene = Scene::new(vec![body(0.1, DVec3::splat(1e-4), DVec3::ZERO)], Vec::new());
    scene.gravity = DVec3::ZERO;
    scene.constraints = hinge(0, DVec3::ZERO, DVec3::ZERO);
    let pitch = 2.0 * PI / 24.0;
    let kind = LimitKind::Ratchet { measure: angle_about_z(0), pitch };
    scene.limits = vec![Limit { name: "pawl".into(), kind, restitution: 0.2 }];
    let mut dynamics = scene.dynamics();
    let mut impacts = Vec::new();
    let mut push = |dynamics: &mut Dynamics, torque: f64, seconds: f64| {
        for _ in 0..(seconds / DT) as usize {
            dynamics.step(DT, &[[0.0, 0.0, 0.0, 0.0, 0.0, torque]], &mut impacts);
        }
        2.0 * dynamics.bodies[0].rotation.z.atan2(dynamics.bodies[0].rotation.w)
    };
    // Forward through a full turn and a half, then back: it is held at a tooth.
    let forward = push(&mut dynamics, 2e-4, 3.0);
    let turned: f64 = 0.5 * 2.0 * 3.0 * 3.0;
    assert!((forward - turned + 2.0 * PI).rem_euclid(2.0 * PI) < 1e-3, "{forward}");
    let stopped = push(&mut dynamics, -2e-4, 8.0);
    let teeth = stopped / pitch;
    assert!((teeth - teeth.round()).abs() < 1e-4, "held at {teeth} teeth");
    // Pushed back at 6 rad/s it went on for as long again: 18 rad, and back by less than a tooth.
    let fell = (2.0 * turned - stopped).rem_euclid(2.0 * PI);
    assert!(fell < pitch + 1e-3, "fell back by {fell} rad");
    assert!(dynamics.bodies[0].angular_velocity.length() < STILL_SPEED);
}

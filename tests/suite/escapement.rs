//! A clock's escapement by nothing but contact: pointed teeth, an anchor on a pendulum, friction and bounce.
//!
//! # Geometry
//!
//! All in the plane z = 0, the wheel's axle at the origin, turning clockwise. N = 30 teeth end in small balls whose
//! centres go round on the radius R. The anchor spans 7.5 teeth, 90°, so its pallets work at E and X, 45° to the
//! left and right of the top, and the pendulum's axle O lies where the tangents there meet, at R √2 above the wheel's,
//! at the distance a = R from both. With n the outward radius and t the way of the teeth (clockwise) at either place:
//!
//! ```text
//! face of a pallet   from its tip along f = −sin γ t + cos γ n, towards the teeth m = −cos γ t − sin γ n
//! lift               the tip lies at E (X) when the pendulum has carried it out by the angle +ψ (−ψ)
//! a tooth at E means teeth half a pitch, π R/N, before and behind X
//! drop δ             a tooth that leaves a tip falls by δ on the other side; while one face works the teeth
//!                    go on by s = π R/N − δ and the pallet out by p = 2 ψ a, and s = p tan γ
//! ```
//!
//! so that N = 30, R = 22.5 mm, δ = 0.5 mm and 2 ψ = 6° give γ = 38°. Beyond ±ψ the face goes on pushing: the wheel
//! recoils. Pallets are 0.6 mm thick: a tooth that has left runs clear of the back by δ and more.
//!
//! # Energy
//!
//! The drive's torque M does the work M · 2π/N per tooth, two beats. A pendulum of quality Q loses 2 π E/Q a period.

use soffio::articulation::{Anchor, Axis, Constraint, ConstraintKind};
use soffio::bodies::{MassProperties, RigidBody};
use soffio::collision::{Collider, Shape, pairs};
use soffio::dynamics::forces::Damping;
use soffio::dynamics::{Dynamics, Figure, Impact, Integrator, Settings, Solver, SurfacePair};
use soffio::math::{DMat3, DQuat, DVec3, PI, Pose, rotation};

const G: f64 = 9.81;
const DT: f64 = 1.0 / 240.0;
const TEETH: usize = 30;
const RADIUS: f64 = 0.0225;
const DROP: f64 = 0.5e-3;
/// ψ: half the angle through which a pallet is pushed.
const LIFT: f64 = 3.0 * PI / 180.0;
/// Balls at the ends of teeth, and round the pallets.
const TOOTH: f64 = 0.1e-3;
const PALLET: f64 = 0.05e-3;
const THICKNESS: f64 = 0.6e-3;
const FACE: f64 = 5.5e-3;
/// Bob on a light rod.
const LENGTH: f64 = 0.25;
const BOB: f64 = 0.1;
const QUALITY: f64 = 150.0;
const TORQUE: f64 = 4e-4;
const WHEEL: usize = 0;
const PENDULUM: usize = 1;

fn hinge(name: &str, body: usize, at: DVec3, local: DVec3) -> Vec<Constraint> {
    let anchor = |body, point| Anchor { body, point };
    let across = |n: DVec3| ConstraintKind::Orientation {
        a: Axis { body: Some(body), direction: DVec3::Z },
        b: Axis { body: None, direction: n },
        angle: 0.0.into(),
    };
    vec![
        Constraint::new(
            &format!("{name}/point"),
            ConstraintKind::PointToPoint { a: anchor(Some(body), local), b: anchor(None, at) },
        ),
        Constraint::new(&format!("{name}/x"), across(DVec3::X)),
        Constraint::new(&format!("{name}/y"), across(DVec3::Y)),
    ]
}

fn collider(body: usize, shape: Shape) -> Collider {
    Collider { body: Some(body), shape, material: 0, node: String::new() }
}

/// A pallet in the frame of the anchor, its axle at the origin, at rest. `side` is −1 at E, +1 at X.
fn pallet(side: f64) -> Collider {
    let n = DVec3::new(side, 1.0, 0.0) / 2f64.sqrt();
    let t = DVec3::new(n.y, -n.x, 0.0);
    let advance = PI * RADIUS / TEETH as f64 - DROP;
    let gamma = (advance / (2.0 * LIFT * RADIUS)).atan();
    let m = -gamma.cos() * t - gamma.sin() * n;
    let f = -gamma.sin() * t + gamma.cos() * n;
    let tip = n * RADIUS - DVec3::Y * RADIUS * 2f64.sqrt() - m * (TOOTH + PALLET);
    // Carried out by ψ: clockwise at E, counterclockwise at X. Undo it.
    let back = rotation(DVec3::Z * (-side * LIFT));
    let mut core = Vec::new();
    for z in [-1.5e-3, 1.5e-3] {
        for corner in [tip, tip + FACE * f, tip + FACE * f - THICKNESS * m, tip - THICKNESS * (m - f)] {
            core.push(back * corner + DVec3::Z * z);
        }
    }
    collider(PENDULUM, Shape::hull(&core, PALLET))
}

fn clock(swing: f64) -> Dynamics {
    let wheel =
        MassProperties { mass: 5e-3, center: DVec3::ZERO, inertia: DMat3::from_diagonal(DVec3::new(1e-6, 1e-6, 2e-6)) };
    let center = DVec3::new(0.0, -LENGTH, 0.0);
    let pendulum = MassProperties { mass: BOB, center, inertia: DMat3::from_diagonal(DVec3::splat(1e-5)) };
    let axle = DVec3::Y * RADIUS * 2f64.sqrt();
    let bodies = vec![
        RigidBody::at_rest(wheel, Pose::IDENTITY),
        RigidBody::at_rest(pendulum, Pose { rotation: rotation(DVec3::Z * swing), position: axle }),
    ];
    let mut constraints = hinge("wheel", WHEEL, DVec3::ZERO, DVec3::ZERO);
    constraints.extend(hinge("pendulum", PENDULUM, axle, DVec3::ZERO));
    let mut colliders: Vec<_> = (0..TEETH)
        .map(|i| {
            let out = rotation(DVec3::Z * (2.0 * PI * (i as f64 + 0.25) / TEETH as f64)) * DVec3::Y;
            collider(WHEEL, Shape::capsule(0.8 * RADIUS * out, RADIUS * out, TOOTH))
        })
        .collect();
    colliders.extend([pallet(-1.0), pallet(1.0)]);
    let pairs = pairs(&colliders, &[]).into_iter().map(|pair| SurfacePair { pair, restitution: 0.2, friction: 0.1 });
    let rate = (G / LENGTH).sqrt() / QUALITY;
    let figure = Figure {
        bodies,
        damping: vec![Damping::default(), Damping { linear: rate, angular: rate }],
        constraints: &constraints,
        limits: &[],
        springs: &[],
        drives: &[],
        pairs: pairs.collect(),
        colliders: &colliders,
    };
    let settings = Settings {
        gravity: DVec3::new(0.0, -G, 0.0),
        friction: true,
        stabilization_time: 0.04,
        integrator: Integrator::RungeKutta,
        solver: Solver::Sparse,
    };
    Dynamics::new(figure, settings)
}

/// Angle about z, rad.
fn angle(q: DQuat) -> f64 {
    2.0 * q.z.atan2(q.w)
}

/// What a run shows.
#[derive(Debug, Default)]
struct Run {
    /// Passages of the pendulum through the vertical.
    beats: usize,
    /// Turn of the wheel, rad, clockwise.
    turn: f64,
    /// Largest angle of each swing.
    swings: Vec<f64>,
    /// Work of the drive, loss to the air, J.
    drive: f64,
    damped: f64,
    hits: usize,
    passes: u64,
}

fn run(clock: &mut Dynamics, seconds: f64, mut watch: impl FnMut(f64, &Dynamics, &[Impact])) -> Run {
    let mut run = Run::default();
    let external = [[0.0, 0.0, 0.0, 0.0, 0.0, -TORQUE], [0.0; 6]];
    let rate = (G / LENGTH).sqrt() / QUALITY;
    let mut impacts = Vec::new();
    let (mut before, mut largest) = (angle(clock.bodies[PENDULUM].rotation), 0f64);
    let mut wheel = angle(clock.bodies[WHEEL].rotation);
    for step in 0..(seconds / DT).round() as usize {
        impacts.clear();
        let loss = |clock: &Dynamics| 2.0 * rate * clock.bodies[PENDULUM].kinetic_energy();
        run.damped += 0.5 * DT * loss(clock);
        assert_eq!(clock.step(DT, &external, &mut impacts), 0, "bad numbers");
        run.damped += 0.5 * DT * loss(clock);
        run.hits += impacts.len();
        let now = angle(clock.bodies[PENDULUM].rotation);
        largest = largest.max(now.abs());
        if before * now < 0.0 {
            run.beats += 1;
            run.swings.push(largest);
            largest = 0.0;
        }
        before = now;
        let turned = angle(clock.bodies[WHEEL].rotation);
        let way = turned - wheel;
        run.turn -= way - 2.0 * PI * (way / (2.0 * PI)).round();
        wheel = turned;
        watch((step + 1) as f64 * DT, clock, &impacts);
    }
    run.drive = TORQUE * run.turn;
    run
}

#[test]
fn an_anchor_keeps_a_pendulum_going_tooth_by_tooth() {
    let mut clock = clock(0.075);
    let began = std::time::Instant::now();
    let start = clock.energy();
    for minute in 0..5 {
        let run = run(&mut clock, 60.0, |_, _, _| {});
        let tail = &run.swings[run.swings.len() - 4..];
        println!(
            "minute {minute}: beats {} teeth {:.3} swings {:?} drive {:.4e} damped {:.4e} energy {:.4e} hits {}",
            run.beats,
            run.turn / (2.0 * PI) * TEETH as f64,
            tail.iter().map(|x| x.to_degrees()).collect::<Vec<_>>(),
            run.drive,
            run.damped,
            clock.energy() - start,
            run.hits
        );
    }
    println!("{:.2} µs a step", began.elapsed().as_secs_f64() / 300.0 / 240.0 * 1e6);
}

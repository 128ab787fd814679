//! An anchor escapement by contact alone: pointed teeth, an anchor on a pendulum, friction and restitution.
//!
//! # Geometry
//!
//! All is in the plane z = 0. The wheel's axle is at the origin; it turns clockwise. N = 30 teeth end in small balls whose
//! centres move on the radius R. The anchor spans 7.5 teeth, 90°, so its pallets work at E and X, 45° to the left and
//! right of the top. The pendulum's axle O is where the tangents there meet: R √2 above the wheel's, at the distance
//! a = R from both. With n the outward radius and t the direction of the teeth (clockwise) at either point:
//!
//! ```text
//! face of a pallet   from its tip along f = −sin γ t + cos γ n, towards the teeth m = −cos γ t − sin γ n
//! lift               the tip is at E (X) when the pendulum has moved it outwards by the angle +ψ (−ψ)
//! a tooth at E means teeth half a pitch, π R/N, before and behind X
//! drop δ             a tooth that leaves a tip falls by δ on the other side; while one face works the teeth
//!                    advance by s = π R/N − δ and the pallet moves out by p = 2 ψ a, and s = p tan γ
//! ```
//!
//! N = 30, R = 22.5 mm, δ = 0.5 mm and 2 ψ = 6° then give γ = 38°. Beyond ±ψ the face keeps pushing: the wheel
//! recoils. Pallets are 0.6 mm thick: a tooth that has left clears the back by δ and more.
//!
//! # Energy
//!
//! The drive's torque M does the work M · 2π/N per tooth, two beats. A pendulum of quality Q loses 2 π E/Q a period.

use soffio_geometry::bodies::{MassProperties, RigidBody};
use soffio_math::{DMat3, DQuat, DVec3, PI, Pose, rotation};
use soffio_multibody::articulation::{Anchor, Axis, Constraint, ConstraintKind};
use soffio_multibody::collision::{Collider, ReachableVolumes, Shape, pairs};
use soffio_multibody::dynamics::forces::Damping;
use soffio_multibody::dynamics::{
    Articulation, Dynamics, Impact, Integrator, RollingResistance, Settings, Solver, SurfacePair,
};

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
    let pairs = pairs(&colliders, &[], &ReachableVolumes::default()).meet.into_iter().map(|pair| SurfacePair {
        pair,
        restitution: 0.2,
        friction: 0.1,
        full_slip: 0.0,
        resistance: RollingResistance::default(),
    });
    let rate = (G / LENGTH).sqrt() / QUALITY;
    let articulation = Articulation {
        bodies,
        damping: vec![Damping::default(), Damping { linear: rate, angular: rate }],
        constraints: &constraints,
        limits: &[],
        springs: &[],
        kinematic_bodies: &[],
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
    Dynamics::new(articulation, settings)
}

/// Angle about z, rad.
fn angle(q: DQuat) -> f64 {
    2.0 * q.z.atan2(q.w)
}

/// Measurements of a run.
#[derive(Debug, Default)]
struct Record {
    /// Angle of the wheel at each passage of the pendulum through the vertical, rad, clockwise.
    beats: Vec<f64>,
    /// Largest angle of the pendulum before each passage, rad.
    swings: Vec<f64>,
    /// Total angle of the wheel, rad.
    wheel_angle: f64,
    /// Loss to the air, J.
    damped: f64,
    impacts: Vec<Impact>,
}

fn run(clock: &mut Dynamics, seconds: f64) -> Record {
    let mut run = Record::default();
    let external = [[0.0, 0.0, 0.0, 0.0, 0.0, -TORQUE], [0.0; 6]];
    let rate = (G / LENGTH).sqrt() / QUALITY;
    let (mut before, mut largest) = (angle(clock.bodies[PENDULUM].rotation), 0f64);
    let mut wheel = angle(clock.bodies[WHEEL].rotation);
    for _ in 0..(seconds / DT).round() as usize {
        // The damping's power is c (m v² + ω·I ω); the trapezoid rule is nearly exact over whole swings.
        let loss = |clock: &Dynamics| 2.0 * rate * clock.bodies[PENDULUM].kinetic_energy();
        run.damped += 0.5 * DT * loss(clock);
        run.impacts.clear();
        assert_eq!(clock.step(DT, &external, &mut run.impacts), None, "bad numbers");
        run.damped += 0.5 * DT * loss(clock);
        let turned = angle(clock.bodies[WHEEL].rotation);
        let step_angle = turned - wheel;
        run.wheel_angle -= step_angle - 2.0 * PI * (step_angle / (2.0 * PI)).round();
        wheel = turned;
        let now = angle(clock.bodies[PENDULUM].rotation);
        largest = largest.max(now.abs());
        if before * now < 0.0 {
            run.beats.push(run.wheel_angle);
            run.swings.push(largest);
            largest = 0.0;
        }
        before = now;
    }
    run
}

/// Runs for some minutes and asserts regular beats, swings and an energy balance.
fn assert_keeps_going(swing: f64, settles: f64, minutes: usize) {
    /// Error of a tooth from beat to beat of the same side, relative to the pitch: the wheel slides along the pallet.
    const TOOTH_BY_TOOTH: f64 = 0.02;
    /// Relative difference of the swings of one side after the start.
    const STEADY: f64 = 0.01;
    /// Error of the energy balance, relative to the drive's work: moving sunken teeth out by micrometres, and the
    /// trapezoid rule at impacts.
    const BALANCE: f64 = 1e-5;
    let mut clock = clock(swing);
    run(&mut clock, settles);
    let (mut least, mut most) = ([f64::INFINITY; 2], [0f64; 2]);
    let pitch = 2.0 * PI / TEETH as f64;
    let mut worst: (f64, f64) = (0.0, 0.0);
    let began = std::time::Instant::now();
    let (mut drive, mut damped, mut beats) = (0.0, 0.0, 0);
    let (start, contact) = (clock.energy(), clock.contact_work());
    for minute in 0..minutes {
        let run = run(&mut clock, 60.0);
        assert!((118..=122).contains(&run.beats.len()), "minute {minute}: {} beats", run.beats.len());
        for pair in run.beats.windows(3) {
            worst.0 = worst.0.max(((pair[2] - pair[0]) / pitch - 1.0).abs());
        }
        // The first swing of a minute is cut.
        for (side, swing) in run.swings.iter().enumerate().skip(1) {
            let side = (beats + side) % 2;
            (least[side], most[side]) = (least[side].min(*swing), most[side].max(*swing));
        }
        beats += run.beats.len();
        drive += TORQUE * run.wheel_angle;
        damped += run.damped;
    }
    let each = began.elapsed().as_secs_f64() / (minutes as f64 * 60.0 / DT) * 1e6;
    let lost = contact - clock.contact_work();
    worst.1 = (drive - damped - lost - (clock.energy() - start)).abs() / drive;
    println!(
        "{beats} beats, worst tooth {:.2e}, swings {:.3?} to {:.3?} deg; drive {drive:.4e} J = air {damped:.4e} + contact \
         {lost:.4e} + gain {:.1e}, missing {:.1e}; {each:.1} µs a step",
        worst.0,
        least.map(f64::to_degrees),
        most.map(f64::to_degrees),
        clock.energy() - start,
        worst.1
    );
    assert!(worst.0 < TOOTH_BY_TOOTH, "a tooth was late or early by {} of the pitch", worst.0);
    for side in 0..2 {
        assert!(most[side] - least[side] < STEADY * most[side], "swings from {least:?} to {most:?} rad");
        assert!(least[side] > 1.2 * LIFT, "swings of {} rad are near to stopping", least[side]);
    }
    assert!(worst.1 < BALANCE, "{} of the drive's work is missing", worst.1);
}

#[test]
fn an_anchor_keeps_a_pendulum_going_tooth_by_tooth() {
    assert_keeps_going(0.088, 120.0, 1);
}

#[test]
#[ignore = "an hour of the clock: minutes of the machine"]
fn an_anchor_keeps_a_pendulum_going_for_an_hour() {
    // From a swing that barely frees a tooth; it settles for six time constants of the pendulum, 2 Q/ω₀.
    assert_keeps_going(0.06, 300.0, 60);
}

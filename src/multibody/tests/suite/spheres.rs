//! Balls: sliding, rolling and both at once, rolling resistance, spin, impacts on balls and cushions; by constrained dynamics and
//! position-based motion, against closed forms.
//!
//! Symbols: r radius, k = I/(m r²), μ friction, b and d the lengths of rolling and spin resistance, u the slip of the
//! contact point. Under Coulomb's law û stands still, so that v̇ = −μ g û, u̇ = −(1 + 1/k) μ g û until u = 0.

use assert_no_alloc::assert_no_alloc;
use soffio_geometry::bodies::RigidBody;
use soffio_math::DVec3;
use soffio_multibody::collision::{Collider, Shape};
use soffio_multibody::dynamics::{Dynamics, Impact, RollingResistance};
use soffio_multibody::procedural::{PositionSolver, Procedural, Settings};

use crate::motion::{DT, G, World, body};
use crate::procedural::{Extras, dynamics_of};

const R: f64 = 0.02;
const MASS: f64 = 0.1;
/// Solid, and hollow.
const SOLID: f64 = 0.4;
const HOLLOW: f64 = 2.0 / 3.0;
/// A resting ball stands within a layer of 2 µm; constrained dynamics puts the contact point in its middle: half of it over the
/// radius, as a share of speeds and forces.
const LAYER: f64 = 5e-5;
/// What places leave after some hundred steps of rounding, m/s.
const ROUNDING: f64 = 1e-9;

/// The motion of the balls.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Mover {
    Dynamics,
    /// In position-based motion with Coulomb's law, and with the source's.
    PositionBased,
    Source,
}

const ALL: [Mover; 3] = [Mover::Dynamics, Mover::PositionBased, Mover::Source];
const COULOMB: [Mover; 2] = [Mover::Dynamics, Mover::PositionBased];

/// Balls on what they roll on.
struct Table {
    mover: Mover,
    dynamics: Dynamics,
    procedural: Procedural,
    impacts: Vec<Impact>,
    static_wrenches: Vec<[f64; 6]>,
}

fn ball(k: f64, position: DVec3) -> RigidBody {
    body(MASS, DVec3::splat(k * MASS * R * R), position)
}

fn static_wrenches(shape: Shape) -> Collider {
    Collider { body: None, shape, material: 0, node: String::new() }
}

fn floor() -> Collider {
    static_wrenches(Shape::plane(DVec3::ZERO, DVec3::Y))
}

fn surfaces(friction: f64, restitution: f64, rolling: f64, spinning: f64) -> Extras {
    Extras { friction, restitution, resistance: RollingResistance { rolling, spinning }, ..Extras::default() }
}

impl Table {
    fn new(mover: Mover, bodies: Vec<RigidBody>, gravity: DVec3, mut extras: Extras, around: Vec<Collider>) -> Self {
        let mut world = World::new(bodies);
        world.gravity = gravity;
        let sphere = |body| Collider { body: Some(body), shape: Shape::sphere(DVec3::ZERO, R), ..floor() };
        extras.colliders = (0..world.bodies.len()).map(sphere).chain(around).collect();
        let dynamics = dynamics_of(&world, &extras);
        let method = if mover == Mover::Source { PositionSolver::Relaxation } else { PositionSolver::TreeSolve };
        Self {
            mover,
            procedural: Procedural::new(&dynamics, Settings { method, ..Settings::default() }),
            dynamics,
            impacts: Vec::with_capacity(1000),
            static_wrenches: vec![[0.0; 6]; world.bodies.len()],
        }
    }

    /// One ball that has come to rest on the floor, then starts.
    fn one(mover: Mover, k: f64, extras: Extras, (v, w): (DVec3, DVec3)) -> Self {
        let start = ball(k, DVec3::Y * R);
        let mut table = Self::new(mover, vec![start], DVec3::NEG_Y * G, extras, vec![floor()]);
        table.run(48);
        let at = &mut table.dynamics.bodies[0];
        assert!(at.velocity.length() < 1e-5, "{mover:?}: it does not lie still: {}", at.velocity);
        (at.position.x, at.position.z) = (0.0, 0.0);
        (at.velocity, at.angular_velocity) = (v, w);
        table.dynamics.disturb();
        table
    }

    fn step(&mut self) {
        let Self { dynamics, impacts, static_wrenches, .. } = self;
        let bad = match self.mover {
            Mover::Dynamics => dynamics.step(DT, static_wrenches, impacts),
            _ => self.procedural.step(dynamics, DT, static_wrenches, &[], impacts),
        };
        assert_eq!(bad, None, "bad numbers");
    }

    fn run(&mut self, steps: usize) {
        (0..steps).for_each(|_| self.step());
    }

    fn ball(&self) -> RigidBody {
        self.dynamics.bodies[0]
    }
}

/// Slip of a ball's lowest point.
fn slip(v: DVec3, w: DVec3) -> DVec3 {
    (v + w.cross(DVec3::NEG_Y * R)).with_y(0.0)
}

/// Coulomb's law: velocity, spin and way after a time.
fn coulomb(k: f64, mu: f64, (v0, w0): (DVec3, DVec3), t: f64) -> (DVec3, DVec3, DVec3) {
    let u = slip(v0, w0);
    let along = u.normalize_or_zero();
    let slides = u.length() / ((1.0 + 1.0 / k) * mu * G);
    let s = t.min(slides);
    let v = v0 - mu * G * s * along;
    // The couple of friction −μ m g û at −r y: r y × μ m g û.
    let w = w0 + (mu * G * s / (k * R)) * DVec3::Y.cross(along);
    (v, w, v0 * s - 0.5 * mu * G * s * s * along + v * (t - s))
}

#[test]
fn a_ball_slides_then_rolls_as_coulombs_law_says() {
    /// The laws' place in the layer, m.
    const WAY: f64 = 2e-5;
    let starts = [
        ("no spin", DVec3::X, DVec3::ZERO),
        ("back spin", DVec3::X, DVec3::Z * 60.0),
        ("top spin", DVec3::X, DVec3::Z * -120.0),
        ("massé", DVec3::X * 1.5, DVec3::new(70.0, 0.0, 40.0)),
    ];
    for mover in COULOMB {
        for (name, v0, w0) in starts {
            for k in [SOLID, HOLLOW] {
                let mu = 0.2;
                let mut table = Table::one(mover, k, surfaces(mu, 0.3, 0.0, 0.0), (v0, w0));
                let (energy, work) = (table.dynamics.energy(), table.dynamics.contact_work());
                let mut worst: [f64; 3] = [0.0; 3];
                for step in 1..=240 {
                    table.step();
                    let (v, w, x) = coulomb(k, mu, (v0, w0), step as f64 * DT);
                    let ball = table.ball();
                    let far = ball.position.with_y(0.0).distance(x);
                    let off = [ball.velocity.with_y(0.0).distance(v), R * ball.angular_velocity.distance(w), far];
                    worst = std::array::from_fn(|i| worst[i].max(off[i]));
                }
                let [v, w, x] = worst;
                println!("{mover:?}, {name}, k {k:.2}: off by {v:.1e}, {w:.1e} m/s, {x:.1e} m");
                // In position-based motion v goes before x: off by ½ Δt Δv.
                let late = 0.5 * DT * (slip(v0, w0) * (k / (1.0 + k))).length();
                let (speed, displacement) =
                    if mover == Mover::Dynamics { (LAYER * 3.0, WAY) } else { (ROUNDING, 1.01 * late) };
                assert!(
                    worst[0] < speed && worst[1] < speed && worst[2] < displacement,
                    "{mover:?}, {name}: {worst:?}"
                );
                // What friction took is k/(1 + k) of the slip's energy.
                let lost = energy - table.dynamics.energy();
                let u = slip(v0, w0).length();
                let expected = 0.5 * MASS * u * u * k / (1.0 + k);
                let ledger = lost + table.dynamics.contact_work() - work;
                if mover == Mover::Dynamics {
                    println!("    ledger {ledger:.1e} J of {lost:.4} J");
                    assert!(ledger.abs() < 1e-6 * expected, "{name}: {ledger} J of {lost} J");
                }
                assert!((lost / expected - 1.0).abs() < 2.0 * LAYER, "{mover:?}, {name}: {lost} J, not {expected}");
            }
        }
    }
}

/// The source's law by itself: v and r ω of a solid ball, by the classical method with a fine step.
fn by_ratio(mu: f64, (mut v, mut w): (DVec3, DVec3), t: f64, k: f64) -> (DVec3, DVec3) {
    const FINE: f64 = 1e-5;
    let rate = |v: DVec3, w: DVec3| {
        let u = slip(v, w);
        let pull = u * (-mu * G / u.length().max(v.length()).max(1e-300));
        (pull, DVec3::NEG_Y.cross(pull) / (k * R))
    };
    let count = (t / FINE).ceil();
    let h = t / count;
    for _ in 0..count as usize {
        let (a1, b1) = rate(v, w);
        let (a2, b2) = rate(v + 0.5 * h * a1, w + 0.5 * h * b1);
        let (a3, b3) = rate(v + 0.5 * h * a2, w + 0.5 * h * b2);
        let (a4, b4) = rate(v + h * a3, w + h * b3);
        v += h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
        w += h / 6.0 * (b1 + 2.0 * b2 + 2.0 * b3 + b4);
    }
    (v, w)
}

#[test]
fn by_the_sources_law_friction_fades_with_the_slip_ratio() {
    /// Four pieces a step by the midpoint rule, of the speed.
    const PIECES: f64 = 1e-5;
    let mu = 0.2;
    let starts = [
        ("no spin", DVec3::X, DVec3::ZERO),
        ("back spin", DVec3::X, DVec3::Z * 60.0),
        ("top spin", DVec3::X, DVec3::Z * -80.0),
        ("massé", DVec3::X * 1.5, DVec3::new(70.0, 0.0, 40.0)),
    ];
    for (name, v0, w0) in starts {
        let mut table = Table::one(Mover::Source, SOLID, surfaces(mu, 0.3, 0.0, 0.0), (v0, w0));
        let (mut v, mut w) = (v0, w0);
        let mut worst: f64 = 0.0;
        for _ in 0..360 {
            table.step();
            (v, w) = by_ratio(mu, (v, w), DT, SOLID);
            let ball = table.ball();
            let off = ball.velocity.with_y(0.0).distance(v).max(R * ball.angular_velocity.distance(w));
            worst = worst.max(off / v0.length());
        }
        println!("{name}: off by {worst:.1e} of the speed");
        assert!(worst < PIECES, "{name}: {worst}");
        let end = table.ball();
        let rolls = v0 - slip(v0, w0) * (SOLID / (1.0 + SOLID));
        assert!((end.velocity.with_y(0.0) - rolls).length() < 1e-4, "{name}: {} for {rolls}", end.velocity);
    }
    // Without spin there is a closed form: the time at which a speed is reached.
    let mut table = Table::one(Mover::Source, SOLID, surfaces(mu, 0.3, 0.0, 0.0), (DVec3::X, DVec3::ZERO));
    let rolls = 5.0 / 7.0;
    for step in 1..=120 {
        table.step();
        let v = table.ball().velocity.x;
        let t = (1.0 - v + rolls * ((1.0 - rolls) / (v - rolls)).ln()) / (3.5 * mu * G);
        let off = t - step as f64 * DT;
        // Late in the fade a speed says little of the time.
        let sharp = 1e-5 / (3.5 * mu * G * (v - rolls) / v);
        assert!(off.abs() < sharp, "{v} m/s at {t} s, off by {off}");
    }
}

#[test]
fn a_rolling_ball_slows_down_stops_and_stays() {
    let (b, mu, v0) = (2e-4, 0.2, 0.3);
    for mover in ALL {
        for k in [SOLID, HOLLOW] {
            let start = (DVec3::X * v0, DVec3::Z * (-v0 / R));
            let mut table = Table::one(mover, k, surfaces(mu, 0.3, b, 0.0), start);
            let rate = b * G / (R * (1.0 + k));
            let (energy, work) = (table.dynamics.energy(), table.dynamics.contact_work());
            let mut worst: f64 = 0.0;
            let stops = v0 / rate;
            for step in 1..=(1.5 * stops / DT) as usize {
                table.step();
                let v = (v0 - rate * step as f64 * DT).max(0.0);
                let ball = table.ball();
                worst = worst.max((ball.velocity.x - v).abs()).max((ball.angular_velocity.z * R + v).abs());
            }
            let ball = table.ball();
            let displacement = 0.5 * v0 * v0 / rate;
            println!("{mover:?}, k {k:.2}: off by {worst:.1e} m/s, way {} for {displacement}", ball.position.x);
            // At the end of the step in which it stops all is known again.
            let speed = if mover == Mover::Dynamics { 2.0 * LAYER * v0 } else { ROUNDING };
            assert!(worst < speed, "{mover:?}: {worst} m/s");
            // In position-based motion v goes before x: half a step's way.
            let half_step = if mover == Mover::Dynamics { 0.0 } else { v0 * DT };
            assert!(
                (ball.position.x - displacement).abs() < half_step + 3.0 * LAYER * displacement,
                "{mover:?}: {}",
                ball.position.x
            );
            if mover == Mover::Dynamics {
                let ledger = energy - table.dynamics.energy() + table.dynamics.contact_work() - work;
                assert!(ledger.abs() < 1e-5 * energy, "{ledger} J of {energy} J");
            }
            let stopped = ball;
            table.run(2400);
            let travelled = table.ball().position.distance(stopped.position);
            let turned = table.ball().rotation.angle_between(stopped.rotation);
            assert!(travelled < 1e-8 && turned < 1e-6, "{mover:?}: then it moved by {travelled} m, {turned} rad");
        }
    }
}

#[test]
fn a_spinning_ball_spins_down_in_place() {
    let (d, w0) = (1e-4, 30.0);
    for mover in ALL {
        let mut table = Table::one(mover, SOLID, surfaces(0.2, 0.3, 0.0, d), (DVec3::ZERO, DVec3::Y * w0));
        let rate = d * G / (SOLID * R * R);
        let mut worst: f64 = 0.0;
        for step in 1..=1440 {
            table.step();
            let w = (w0 - rate * step as f64 * DT).max(0.0);
            worst = worst.max((table.ball().angular_velocity - DVec3::Y * w).length());
        }
        println!("{mover:?}: off by {worst:.1e} rad/s of {w0}");
        assert!(w0 / rate < 1440.0 * DT, "it is to stop");
        assert!(worst < LAYER * w0, "{mover:?}: {worst} rad/s");
        assert!(table.ball().position.with_y(0.0).length() < 1e-6, "{mover:?}: it wandered");
    }
}

#[test]
fn on_an_incline_resistance_holds_a_ball_or_slows_it() {
    let (b, mu) = (4e-4, 0.4);
    for mover in ALL {
        for angle in [0.5 * b / R, 3.0 * b / R] {
            let (sin, cos) = angle.sin_cos();
            let start = ball(SOLID, DVec3::Y * R);
            let gravity = G * DVec3::new(sin, -cos, 0.0);
            let mut table = Table::new(mover, vec![start], gravity, surfaces(mu, 0.0, b, 0.0), vec![floor()]);
            table.run(24);
            let before = table.ball();
            table.run(240);
            let after = table.ball();
            let expected = (G * (sin - b / R * cos) / (1.0 + SOLID)).max(0.0);
            let found = after.velocity.x - before.velocity.x;
            println!("{mover:?}: {found} m/s² for {expected}");
            if expected == 0.0 {
                assert!(after.velocity.length() < 1e-9, "{mover:?}: {}", after.velocity);
                // In position-based motion a resting ball yields by a step's fall each step.
                let creeps = if mover == Mover::Dynamics { 1e-8 } else { 240.0 * G * sin * DT * DT };
                assert!(after.position.distance(before.position) <= creeps, "{mover:?}: creeps");
            } else {
                // By the source's law friction needs slip, and resistance is less by its ratio.
                let off = if mover == Mover::Source { 4e-2 } else { 5e-4 };
                assert!((found / expected - 1.0).abs() < off, "{mover:?}: {found} for {expected} m/s²");
            }
        }
    }
}

/// Two balls in space: the first comes at `v` along x, the second lies `aside` off its line.
fn pair(mover: Mover, v: f64, aside: f64, extras: Extras) -> Table {
    let apart = (4.0 * R * R - aside * aside).sqrt() + 0.01;
    let mut cue = ball(SOLID, DVec3::X * -apart);
    cue.velocity.x = v;
    let object = ball(SOLID, DVec3::Z * aside);
    Table::new(mover, vec![cue, object], DVec3::ZERO, extras, Vec::new())
}

#[test]
fn balls_part_as_restitution_says() {
    for mover in ALL {
        for e in [0.0, 0.6, 0.95, 1.0] {
            let mut table = pair(mover, 1.0, 0.0, surfaces(0.1, e, 0.0, 0.0));
            table.run(12);
            let [cue, object] = [0, 1].map(|i| table.dynamics.bodies[i]);
            assert!((cue.velocity.x - 0.5 * (1.0 - e)).abs() < 1e-12, "{mover:?}, e {e}: {}", cue.velocity);
            assert!((object.velocity.x - 0.5 * (1.0 + e)).abs() < 1e-12, "{mover:?}, e {e}: {}", object.velocity);
            let momentum = cue.velocity + object.velocity - DVec3::X;
            assert!(momentum.length() < 1e-14, "{mover:?}: {momentum}");
        }
    }
}

#[test]
fn equal_balls_part_at_a_right_angle() {
    /// The laws find the moment to the touching layer, which turns the line of centres by so much.
    const LINE: f64 = 2e-4;
    for mover in ALL {
        let mut table = pair(mover, 1.0, R, surfaces(0.0, 1.0, 0.0, 0.0));
        table.run(12);
        let [cue, object] = [0, 1].map(|i| table.dynamics.bodies[i].velocity);
        let cosine = cue.dot(object) / (cue.length() * object.length());
        println!("{mover:?}: cosine {cosine:.1e}; object leaves at {}°", object.z.atan2(object.x).to_degrees());
        assert!(cosine.abs() < 1e-12, "{mover:?}: {cosine}");
        assert!((cue + object - DVec3::X).length() < 1e-14, "{mover:?}: momentum");
        if mover == Mover::Dynamics {
            // Half a ball aside: the object leaves at 30°, the cue at 60°.
            let wanted = DVec3::new(0.75, 0.0, 0.75f64.sqrt() * 0.5);
            assert!(object.distance(wanted) < LINE, "{object} for {wanted}");
            assert!(cue.distance(DVec3::X - wanted) < LINE, "{cue}");
        }
    }
}

/// Momentum and angular momentum about the origin.
fn momenta(bodies: &[RigidBody]) -> (DVec3, DVec3) {
    bodies.iter().fold((DVec3::ZERO, DVec3::ZERO), |(p, l), ball| {
        let own = MASS * ball.velocity;
        (p + own, l + ball.position.cross(own) + SOLID * MASS * R * R * ball.angular_velocity)
    })
}

#[test]
fn rubbing_balls_throw_each_other_and_keep_what_they_must() {
    // Side spin on the cue: the object is thrown aside by friction, and takes some of the spin.
    for mover in ALL {
        let mut table = pair(mover, 1.0, 0.0, surfaces(0.06, 0.95, 0.0, 0.0));
        table.dynamics.bodies[0].angular_velocity = DVec3::Y * 50.0;
        table.dynamics.disturb();
        let (p, l) = momenta(&table.dynamics.bodies);
        table.run(12);
        let (q, m) = momenta(&table.dynamics.bodies);
        assert!((p - q).length() < 1e-14, "{mover:?}: {p} {q}");
        // In position-based motion the hit is answered at the step's end.
        let tolerance = if mover == Mover::Dynamics { 1e-9 } else { 1e-5 };
        assert!((l - m).length() < tolerance, "{mover:?}: {l} {m}");
        let object = table.dynamics.bodies[1].velocity;
        // It slides throughout: Coulomb's throw of tan⁻¹ μ.
        assert!((object.z.abs() / object.x - 0.06).abs() < 1e-9, "{mover:?}: {object}");
    }
}

#[test]
fn a_cushion_answers_with_coulombs_impulse() {
    // The sphere's K is diagonal, (7/2, 7/2, 1)/m: P_n = (1 + e) m v_n, P_T = −2/7 m u_T where it sticks, else −μ P_n û.
    let (v0, cushion) = (DVec3::new(1.2, 0.0, 0.7), static_wrenches(Shape::plane(DVec3::X * 0.1, DVec3::NEG_X)));
    for mover in ALL {
        for (name, mu, e, w0) in [
            ("sticks", 0.6, 0.8, DVec3::new(0.0, 10.0, 0.0)),
            ("slides", 0.1, 0.8, DVec3::new(0.0, -40.0, 30.0)),
            ("running side", 0.2, 0.7, DVec3::new(5.0, 90.0, 0.0)),
        ] {
            let mut start = ball(SOLID, DVec3::ZERO);
            (start.velocity, start.angular_velocity) = (v0, w0);
            let extras = surfaces(mu, e, 0.0, 0.0);
            let mut table = Table::new(mover, vec![start], DVec3::ZERO, extras, vec![cushion.clone()]);
            table.run(36);
            let normal = (1.0 + e) * MASS * v0.x;
            let u = (v0 + w0.cross(DVec3::X * R)).with_x(0.0);
            let stick = -2.0 / 7.0 * MASS * u;
            let friction = if stick.length() <= mu * normal { stick } else { -mu * normal * u.normalize() };
            let p = friction - DVec3::X * normal;
            let v = v0 + p / MASS;
            let w = w0 + (DVec3::X * R).cross(p) / (SOLID * MASS * R * R);
            let after = table.ball();
            let off = after.velocity.distance(v).max(R * after.angular_velocity.distance(w));
            println!("{mover:?}, {name}: off by {off:.1e} m/s");
            // The laws' contact point lies in the middle of the touching layer.
            assert!(off < if mover == Mover::Dynamics { 3.0 * LAYER } else { ROUNDING }, "{mover:?}, {name}: {off}");
        }
    }
}

#[test]
fn a_table_full_of_balls_gains_nothing_ends_still_and_allocates_nothing() {
    for mover in ALL {
        let place = |i: usize| DVec3::new(0.07 * (i % 3) as f64, R, 0.06 * (i / 3) as f64);
        let mut bodies: Vec<_> = (0..9).map(|i| ball(SOLID, place(i))).collect();
        for (i, ball) in bodies.iter_mut().enumerate() {
            ball.velocity = DVec3::new(0.3 * ((i * 5 % 7) as f64 - 3.0), 0.0, 0.25 * ((i * 3 % 5) as f64 - 2.0));
            ball.angular_velocity = DVec3::new(0.0, 10.0 * (i as f64 - 4.0), 5.0);
        }
        let wall = |p: DVec3, n: DVec3| static_wrenches(Shape::plane(p, n));
        let around = vec![
            floor(),
            wall(DVec3::X * -0.1, DVec3::X),
            wall(DVec3::X * 0.3, DVec3::NEG_X),
            wall(DVec3::Z * -0.1, DVec3::Z),
            wall(DVec3::Z * 0.3, DVec3::NEG_Z),
        ];
        let mut table = Table::new(mover, bodies, DVec3::NEG_Y * G, surfaces(0.15, 0.9, 2e-4, 1e-4), around);
        table.run(24);
        let mut energy = table.dynamics.energy();
        let began = std::time::Instant::now();
        for step in 0..240 * 12 {
            assert_no_alloc(|| table.step());
            let now = table.dynamics.energy();
            // In position-based motion a ball that falls and is moved out again gains and loses a step's fall.
            let slack = if mover == Mover::Dynamics { 1e-9 } else { 9.0 * MASS * G * 2.0 * G * DT * DT };
            assert!(now <= energy + slack, "{mover:?}, step {step}: {now} after {energy} J");
            energy = energy.min(now);
            table.impacts.clear();
        }
        println!("{mover:?}: {:.1} µs a step", began.elapsed().as_secs_f64() / 2880.0 * 1e6);
        for ball in &table.dynamics.bodies {
            assert!(ball.velocity.length() < 1e-6 && ball.angular_velocity.length() < 1e-4, "{mover:?}: {ball:?}");
            assert!(ball.position.x > -0.1 && ball.position.x < 0.3 && ball.position.y < 2.0 * R, "{mover:?}");
        }
    }
}

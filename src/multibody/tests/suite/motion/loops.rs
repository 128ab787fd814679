//! Closed loops: a four-bar linkage, a chain between two walls, and scattered linkages that close their joints.

use assert_no_alloc::assert_no_alloc;
use soffio_math::noise::Random;
use soffio_math::{DVec3, rotation};
use soffio_multibody::dynamics::forces::Damping;
use soffio_multibody::dynamics::{Integrator, Solver};

use super::{CLOSED, DT, G, INTEGRATORS, World, rod, run, step};

/// A crank, a coupler and a rocker in a plane, hinged to the ground at both ends.
fn four_bar() -> World {
    let pins = [DVec3::ZERO, DVec3::new(-0.05, 0.2, 0.0), DVec3::new(0.5, 0.35, 0.0), DVec3::new(0.4, 0.0, 0.0)];
    let mut world = World::new((0..3).map(|i| rod(0.2 + 0.1 * i as f64, pins[i], pins[i + 1])).collect());
    for (i, pin) in pins.into_iter().enumerate() {
        let (a, b) = if i < 3 { (i, i.checked_sub(1)) } else { (2, None) };
        world.hinge(&format!("hinge-{i}"), a, b, pin, DVec3::Z);
    }
    world
}

#[test]
fn a_four_bar_linkage_keeps_its_energy_and_its_pins() {
    for (integrator, solver) in INTEGRATORS.into_iter().flat_map(|i| [(i, Solver::Sparse), (i, Solver::Dense)]) {
        let mut world = four_bar();
        world.solver = solver;
        let mut dynamics = world.start(integrator);
        let energy = dynamics.energy();
        let no_wrenches = [[0.0; 6]; 3];
        let (mut lost, mut apart, mut scale) = (0.0_f64, 0.0_f64, 0.0_f64);
        for _ in 0..720 {
            step(&mut dynamics, DT, &no_wrenches);
            lost = lost.max((dynamics.energy() - energy).abs());
            apart = apart.max(dynamics.joint_error());
            scale = scale.max(dynamics.bodies[0].kinetic_energy() + dynamics.bodies[2].kinetic_energy());
            assert!(dynamics.bodies.iter().all(|b| (b.rotation * DVec3::Z).dot(DVec3::Z) > 1.0 - 1e-14));
        }
        // Four hinges of five rows constrain seventeen of eighteen degrees of freedom.
        assert_eq!(dynamics.system().redundant_rows().len(), 3, "{solver:?}");
        let lost = lost / scale;
        println!("four-bar, {integrator:?}, {solver:?}: energy off by {lost:.1e}, pins by {apart:.1e} m");
        let allowed = if integrator == Integrator::Precise { 1e-8 } else { 1e-4 };
        assert!(lost < allowed, "{integrator:?}, {solver:?}: energy off by {lost:e}");
        assert!(apart < CLOSED, "{integrator:?}, {solver:?}: {apart:e} m apart");
    }
}

/// Length and mass of the rods of ladders and nets.
const ROD: f64 = 0.1;
const LIGHT: f64 = 0.05;

/// A ladder of so many loops, tilted: two rails of rods, a rung between each two of their joints, all hinged; its rails hang from the
/// world.
fn ladder(loops: usize) -> World {
    let place =
        |row: usize, side: usize| rotation(DVec3::Z * 0.3) * DVec3::new(ROD * side as f64, -ROD * row as f64, 0.0);
    let side = |row: usize, side: usize| rod(LIGHT, place(row, side), place(row + 1, side));
    let rung = |row: usize| rod(LIGHT, place(row + 1, 0), place(row + 1, 1));
    let mut world = World::new((0..loops).flat_map(|row| [side(row, 0), side(row, 1), rung(row)]).collect());
    for row in 0..loops {
        for side in 0..2 {
            let (own, above) = (3 * row + side, row.checked_sub(1).map(|above| 3 * above + side));
            world.hinge(&format!("rail-{row}-{side}"), own, above, place(row, side), DVec3::Z);
            world.hinge(&format!("rung-{row}-{side}"), 3 * row + 2, Some(own), place(row + 1, side), DVec3::Z);
        }
    }
    world
}

/// A net of n × n knots, rods between neighbours with ball joints; it sags between its fixed corners. Its knots are the
/// sums of two lines of equal steps, so that all rods have one length.
fn net(n: usize) -> World {
    let step = |k: usize| 0.6 * ((2 * k + 1) as f64 / (n - 1) as f64 - 1.0);
    let line = |i: usize| (0..i).fold((0.0, 0.0), |(x, y), k| (x + ROD * step(k).cos(), y + ROD * step(k).sin()));
    let place = |knot: usize| {
        let (along, across) = (line(knot % n), line(knot / n));
        DVec3::new(along.0, along.1 + across.1, across.0)
    };
    let knot = |k: usize| super::body(0.02, DVec3::splat(1e-6), place(k));
    let mut world = World::new((0..n * n).map(knot).collect());
    for k in 0..n * n {
        let right = (k % n + 1 < n).then_some(k + 1);
        let up = (k + n < n * n).then_some(k + n);
        for other in [right, up].into_iter().flatten() {
            world.bodies.push(rod(LIGHT, place(k), place(other)));
            let own = world.bodies.len() - 1;
            world.pin(&format!("begin-{own}"), own, Some(k), place(k));
            world.pin(&format!("end-{own}"), own, Some(other), place(other));
        }
    }
    for corner in [0, n - 1, n * n - n, n * n - 1] {
        world.pin(&format!("corner-{corner}"), corner, None, place(corner));
    }
    world
}

#[test]
fn ladders_and_nets_stay_closed_and_keep_their_energy() {
    /// Relative to the largest kinetic energy: the method's own error over a second.
    const KEPT: f64 = 1e-5;
    for (name, world) in [("ladder", ladder(20)), ("net", net(5))] {
        let mut dynamics = world.start(Integrator::Auto);
        let energy = dynamics.energy();
        let no_wrenches = vec![[0.0; 6]; world.bodies.len()];
        let (mut lost, mut apart, mut scale) = (0.0_f64, 0.0_f64, 0.0_f64);
        for _ in 0..240 {
            assert_no_alloc(|| step(&mut dynamics, DT, &no_wrenches));
            lost = lost.max((dynamics.energy() - energy).abs());
            apart = apart.max(dynamics.joint_error());
            scale = scale.max(dynamics.bodies.iter().map(|body| body.kinetic_energy()).sum());
        }
        println!("{name}: energy off by {:.1e}, joints by {apart:.1e} m", lost / scale);
        assert!(lost < KEPT * scale, "{name}: energy off by {:e}", lost / scale);
        assert!(apart < CLOSED, "{name}: {apart:e} m apart");
        // Each loop of hinges in a plane has three redundant rows, a net's rods have none.
        let expected = if name == "ladder" { 60 } else { 0 };
        assert_eq!(dynamics.system().redundant_rows().len(), expected, "{name}");
    }
}

#[test]
fn the_factor_of_a_ladder_grows_with_its_loops_and_no_faster() {
    // The first and the last loops are a little cheaper than those between.
    const EVEN: f64 = 1.25;
    let numbers = |loops: usize| ladder(loops).start(Integrator::Auto).system().loop_factor_len() as f64 / loops as f64;
    let few = numbers(5);
    for loops in [10, 20, 40, 80, 160] {
        let more = numbers(loops);
        assert!((1.0 / EVEN..EVEN).contains(&(more / few)), "{loops} loops: {more} numbers each, {few} in 5");
    }
    // A net's factor is about n^1.5 knots: four times the knots, eight times the numbers, where a dense one has sixteen.
    let knots = |n: usize| net(n).start(Integrator::Auto).system().loop_factor_len() as f64;
    assert!(knots(12) / knots(6) < 9.0, "{} numbers and {}", knots(6), knots(12));
}

/// Links of the chain, their length and mass.
const LINKS: usize = 40;
const LENGTH: f64 = 0.05;
const MASS: f64 = 0.02;

/// Equilibrium positions of the chain's joints under a horizontal tension of `pull` N: every rod lies along the mean of the
/// forces on its two ends.
fn resting(pull: f64) -> Vec<DVec3> {
    let mut places = vec![DVec3::ZERO];
    for i in 0..LINKS {
        let up = MASS * G * (i as f64 + 0.5 - 0.5 * LINKS as f64);
        let along = DVec3::new(pull, up, 0.0).normalize();
        places.push(places[i] + LENGTH * along);
    }
    places
}

/// Horizontal tension at which the chain spans `span` (m), N.
fn pull_for(span: f64) -> f64 {
    let (mut low, mut high) = (1e-3, 1e3);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if resting(middle)[LINKS].x < span { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// The chain with its joints at these positions, pinned at both ends.
fn chain(places: &[DVec3]) -> World {
    let mut world = World::new((0..LINKS).map(|i| rod(MASS, places[i], places[i + 1])).collect());
    for i in 0..LINKS {
        world.pin(&format!("link-{i}"), i, i.checked_sub(1), places[i]);
    }
    world.pin("end", LINKS - 1, None, places[LINKS]);
    world
}

#[test]
fn a_chain_between_two_walls_bears_the_tension_of_the_catenary() {
    // Rods: the discrete chain is exact; the smooth catenary differs by (length of a link / length of the chain)².
    const SMOOTH: f64 = 2e-3;
    const EXACT: f64 = 1e-9;
    let span = 1.2;
    let pull = pull_for(span);
    // Analytic: s/2 = a sinh(span/2a), H = w a.
    let length = LINKS as f64 * LENGTH;
    let (mut low, mut high) = (0.05, 100.0);
    for _ in 0..200 {
        let a: f64 = 0.5 * (low + high);
        if 2.0 * a * (0.5 * span / a).sinh() > length { low = a } else { high = a }
    }
    let smooth = MASS / LENGTH * G * low;
    assert!((pull / smooth - 1.0).abs() < SMOOTH, "{pull} N against {smooth} N");
    let mut dynamics = chain(&resting(pull)).start(Integrator::RungeKutta);
    run(&mut dynamics, 0.1, DT);
    let mut worst = 0.0_f64;
    for i in 0..=LINKS {
        let up = MASS * G * (i as f64 - 0.5 * LINKS as f64);
        let found = dynamics.system().constraint_load(i).force;
        worst = worst.max((found / pull.hypot(up) - 1.0).abs());
    }
    println!("catenary: tension off by {worst:.1e}, from the smooth one by {:.1e}", (pull / smooth - 1.0).abs());
    assert!(worst < EXACT, "tension off by {worst:e}");
    assert!(dynamics.joint_error() < CLOSED);
}

#[test]
fn a_chain_hung_askew_comes_to_rest_as_a_catenary() {
    // Another shape of the same length and span at the start: a tent. Damped, it comes to rest.
    const SETTLED: f64 = 1e-4;
    let span = 1.2;
    let half = 0.5 * LINKS as f64 * LENGTH;
    let sag = (half * half - 0.25 * span * span).sqrt();
    let side = DVec3::new(0.5 * span, -sag, 0.0) / (0.5 * LINKS as f64);
    let mut places = vec![DVec3::ZERO];
    for i in 0..LINKS {
        let offset = if i < LINKS / 2 { side } else { DVec3::new(side.x, -side.y, 0.0) };
        places.push(places[i] + offset);
    }
    let mut world = chain(&places);
    world.damping = Damping { linear: 8.0, angular: 8.0 };
    let mut dynamics = world.start(Integrator::RungeKutta);
    run(&mut dynamics, 5.0, DT);
    assert!(dynamics.joint_error() < CLOSED);
    // Its loads at rest, without damping, whose last solve was for an impulse.
    world.bodies = dynamics.bodies;
    world.damping = Damping::default();
    let mut dynamics = world.start(Integrator::RungeKutta);
    run(&mut dynamics, DT, DT);
    let pull = pull_for(span);
    let mut worst = 0.0_f64;
    for i in 0..=LINKS {
        let up = MASS * G * (i as f64 - 0.5 * LINKS as f64);
        let found = dynamics.system().constraint_load(i).force;
        worst = worst.max((found / pull.hypot(up) - 1.0).abs());
    }
    println!("chain hung askew: tension off by {worst:.1e}");
    assert!(worst < SETTLED, "tension off by {worst:e}");
}

#[test]
fn scattered_linkages_close_their_joints() {
    const TOGETHER: f64 = 1e-9;
    for seed in 0..6 {
        for (name, mut world) in [("linkage", four_bar()), ("chain", branches())] {
            let mut random = Random::new(seed);
            let mut vector = || DVec3::new(random.signed(), random.signed(), random.signed());
            world.gravity = DVec3::ZERO;
            // The stabiliser's remaining work would spin thin rods for ever.
            world.damping = Damping { linear: 3.0, angular: 3.0 };
            for body in &mut world.bodies {
                let spread = if name == "linkage" { 0.1 } else { 0.5 };
                body.position += spread * vector();
                body.rotation = rotation(2.0 * spread * vector()) * body.rotation;
            }
            let mut dynamics = world.start(Integrator::RungeKutta);
            let before = dynamics.joint_error();
            let no_wrenches = vec![[0.0; 6]; world.bodies.len()];
            let mut fastest = 0.0_f64;
            for _ in 0..720 {
                step(&mut dynamics, DT, &no_wrenches);
                fastest = dynamics.bodies.iter().fold(fastest, |s, b| s.max(b.velocity.length()));
            }
            let after = dynamics.joint_error();
            assert!(before > 0.01 && after < TOGETHER, "seed {seed}, {name}: {before} m, then {after} m apart");
            assert!(fastest < 50.0, "seed {seed}, {name}: as fast as {fastest} m/s");
            assert!(dynamics.system().largest_error() < TOGETHER, "seed {seed}, {name}: an angle is off");
        }
    }
}

/// A trunk with two arms and a hand, on a nail, with ball joints and hinges.
fn branches() -> World {
    let joints = [DVec3::ZERO, DVec3::NEG_Y * 0.4, DVec3::NEG_Y * 0.4, DVec3::new(0.3, -0.6, 0.0)];
    let ends =
        [DVec3::NEG_Y * 0.4, DVec3::new(0.3, -0.6, 0.0), DVec3::new(-0.3, -0.6, 0.1), DVec3::new(0.5, -0.7, 0.2)];
    let mut world = World::new((0..4).map(|i| rod(0.2, joints[i], ends[i])).collect());
    world.pin("nail", 0, None, joints[0]);
    world.pin("shoulder", 1, Some(0), joints[1]);
    world.hinge("other shoulder", 2, Some(0), joints[2], DVec3::Z);
    world.hinge("wrist", 3, Some(1), joints[3], DVec3::new(0.6, 0.0, 0.8));
    world
}

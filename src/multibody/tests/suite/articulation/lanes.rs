//! Four bodies at a time and one at a time: the same to the bit, on any processor.

use fearless_simd::{Level, dispatch};
use soffio_geometry::bodies::RigidBody;
use soffio_math::lanes::{All, Lanes, One, Quat};
use soffio_math::noise::Random;
use soffio_math::spatial::Vec6;
use soffio_math::{DQuat, DVec3, product, renormalized, rotation};
use soffio_multibody::articulation::lane_blocks::gather;
use soffio_multibody::articulation::{Breaking, Constraint, LinearSolver, System};

use super::mechanisms::{Kinds, below, body, mechanism, point, vector, wrench};

/// How many random mechanisms of each kind.
const MECHANISMS: u64 = 200;
/// Of the largest unknown: two eliminations of mechanisms whose condition numbers stay below some 10⁴.
const SOLVED: f64 = 1e-10;

/// The levels that this processor has, the plainest first.
fn levels() -> Vec<Level> {
    let best = Level::new();
    let mut levels = vec![Level::baseline()];
    #[cfg(target_arch = "x86_64")]
    levels.extend([best.as_sse4_2().map(Level::Sse4_2), best.as_avx2().map(Level::Avx2)].into_iter().flatten());
    levels.push(best);
    levels
}

/// Bodies that hang by points in a tree as bushy as it comes, the first on the world.
fn bush(random: &mut Random) -> (Vec<RigidBody>, Vec<Constraint>) {
    let count = 1 + below(random, 40);
    let bodies: Vec<RigidBody> = (0..count).map(|_| body(random)).collect();
    // Parents from the last few bodies make chains, from all make bushes.
    let distance = 1 + below(random, count);
    let joint = |i: usize, random: &mut Random| {
        let parent = i.checked_sub(1 + below(random, distance.min(i + 1)));
        let turned = parent.is_some() && random.unit() < 0.5;
        let kind = if turned { point(random, parent, Some(i)) } else { point(random, Some(i), parent) };
        Constraint::new(&format!("point-{i}"), kind)
    };
    let constraints = (0..count).map(|i| joint(i, random)).collect();
    (bodies, constraints)
}

/// Accelerations and multipliers under random forces and wanted rows, and the rates that a velocity solve undoes; the
/// mechanism may be one that is still being stabilised.
fn solved(system: &mut System, bodies: &[RigidBody], stabilised: bool, random: &mut Random) -> (Vec<Vec6>, Vec<f64>) {
    system.evaluate(bodies);
    if stabilised {
        system.classify_rows();
    }
    system.factor();
    for i in 0..bodies.len() {
        (system.b[i], system.a[i]) = (wrench(random), wrench(random));
    }
    let count = system.g.len();
    system.g = (0..count).map(|_| random.signed()).collect();
    system.solve();
    let (mut a, mut lambda) = (system.a.clone(), system.lambda.clone());
    system.solve_velocity(bodies);
    system.copy_ball_joint_multipliers();
    a.extend(&system.a);
    lambda.extend(&system.lambda);
    for wrench in &mut system.b {
        *wrench = [0.0, -1.0, 0.0, 0.1, 0.0, 0.0];
    }
    system.solve_acceleration(bodies, 10.0);
    system.copy_ball_joint_multipliers();
    a.extend(&system.a);
    lambda.extend(&system.lambda);
    (a, lambda)
}

fn bits((a, lambda): &(Vec<Vec6>, Vec<f64>)) -> Vec<u64> {
    a.iter().flatten().chain(lambda).map(|x| x.to_bits()).collect()
}

#[test]
fn every_processor_finds_the_same_bits() {
    for seed in 0..MECHANISMS {
        let mut random = Random::new(seed);
        let (bodies, kinematic, constraints) = if seed % 2 == 0 {
            let (bodies, constraints) = bush(&mut random);
            (bodies.clone(), bodies.iter().map(|_| random.unit() < 0.05).collect(), constraints)
        } else {
            let kinds = Kinds { loops: seed % 3 > 0, partial_rows: false, friction: false };
            let mechanism = mechanism(&mut random, kinds);
            (mechanism.bodies, mechanism.kinematic, mechanism.constraints)
        };
        let found = levels().into_iter().map(|level| {
            let mut system = System::at_level(level, &bodies, &kinematic, &constraints, LinearSolver::Sparse);
            bits(&solved(&mut system, &bodies, seed % 4 < 2, &mut Random::new(seed)))
        });
        let found: Vec<Vec<u64>> = found.collect();
        assert!(found.windows(2).all(|pair| pair[0] == pair[1]), "seed {seed}: {} levels differ", found.len());
    }
}

#[test]
fn four_bodies_at_a_time_come_out_as_one_by_one() {
    for seed in 0..MECHANISMS {
        let (bodies, constraints) = bush(&mut Random::new(seed));
        let kinematic = vec![false; bodies.len()];
        // What could break is no point for ever, and so goes by itself.
        let mut alone = constraints.clone();
        for constraint in &mut alone {
            let never = f64::INFINITY;
            constraint.breaking = Some(Breaking { force: never, torque: never, impulse: never, restore: never });
        }
        let [together, alone] = [&constraints, &alone].map(|constraints| {
            let mut system = System::new(&bodies, &kinematic, constraints, LinearSolver::Sparse);
            solved(&mut system, &bodies, seed % 2 == 0, &mut Random::new(seed))
        });
        assert!(bits(&together) == bits(&alone), "seed {seed}");
    }
}

#[test]
fn four_bodies_at_a_time_obey_the_dense_equations() {
    let mut worst = 0.0_f64;
    for seed in 0..MECHANISMS {
        let (bodies, constraints) = bush(&mut Random::new(seed));
        let kinematic = vec![false; bodies.len()];
        let [tree, dense] = [LinearSolver::Sparse, LinearSolver::Dense].map(|method| {
            let mut system = System::new(&bodies, &kinematic, &constraints, method);
            // While it gathers the dense rows yield a little, and those of the tree do not.
            solved(&mut system, &bodies, false, &mut Random::new(seed))
        });
        let largest = |(a, lambda): &(Vec<Vec6>, Vec<f64>)| {
            a.iter().flatten().chain(lambda).fold(0.0_f64, |most, x| most.max(x.abs()))
        };
        let scale = largest(&dense);
        let accelerations = tree.0.iter().flatten().zip(dense.0.iter().flatten());
        let off =
            accelerations.chain(tree.1.iter().zip(&dense.1)).fold(0.0_f64, |most, (x, y)| most.max((x - y).abs()));
        assert!(off < SOLVED * scale, "seed {seed}: off by {:e}", off / scale);
        worst = worst.max(off / scale);
    }
    println!("off by {worst:.1e} at most");
}

#[test]
fn turns_of_lanes_are_the_turns_of_bodies() {
    let mut random = Random::new(7);
    for case in 0..1000 {
        // All three ways to calculate a turn.
        let size = [1e-3, 0.03, 0.3, 3.0][case % 4];
        // Every now and then one of the four turns by much more than the others.
        let sizes = [size, size, size, if case % 5 == 0 { 1.0 } else { size }];
        let rotations = sizes.map(|size| size * vector(&mut random));
        let from = [0; 4].map(|_| rotation(vector(&mut random)));
        let found = dispatch!(Level::new(), simd => turned(All(simd), &rotations, &from));
        for (k, found) in found.into_iter().enumerate() {
            let expected = renormalized(product(rotation(rotations[k]), from[k])).to_array();
            assert_eq!(found, expected, "turn {}", rotations[k]);
            assert_eq!(turned(One(k), &rotations, &from)[k], expected, "turn {} alone", rotations[k]);
        }
    }
}

#[inline(always)]
fn turned<L: Lanes>(lanes: L, rotations: &[DVec3; 4], from: &[DQuat; 4]) -> [[f64; 4]; 4] {
    let start = Quat::gather(lanes, |k| from[k]);
    let q = Quat::of_turn(lanes, gather(lanes, |k| &rotations[k])).times(start).renormalized();
    let mut out = [[0.0; 4]; 4];
    lanes.scatter(4, &[q.v.x, q.v.y, q.v.z, q.w], |lane, q| out[lane] = *q);
    out
}

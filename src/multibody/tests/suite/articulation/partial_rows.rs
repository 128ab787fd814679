//! The share of a row: it carries that part of the force that would hold it, whatever hangs on it, in either solver.

use soffio_geometry::bodies::RigidBody;
use soffio_math::DVec3;
use soffio_math::noise::Random;
use soffio_math::spatial::{Vec6, angular, linear};
use soffio_multibody::articulation::{Constraint, ConstraintKind, LinearSolver, Schedule, System, Window};

use super::mechanisms::{body, orientation, point, world_anchor, wrench};

/// Of the hard force; two solves stand between the shares and it.
const CARRIED: f64 = 1e-9;

fn ramp(seconds: f64) -> Schedule {
    Schedule { windows: vec![Window { start: 0.0, end: 100.0 }], ramp_in: seconds, ..Schedule::default() }
}

/// Multipliers and accelerations under some forces when `ramp`s of a second stand at `activation`.
fn solve(
    bodies: &[RigidBody],
    constraints: &[Constraint],
    method: LinearSolver,
    activation: f64,
) -> (System, Vec<Vec6>) {
    let mut system = System::new(bodies, &vec![false; bodies.len()], constraints, method);
    system.activity.update_activations(activation);
    system.evaluate(bodies);
    system.factor();
    let mut random = Random::new(bodies.len() as u64);
    system.b.iter_mut().for_each(|b| *b = wrench(&mut random));
    system.g.fill(0.0);
    system.solve();
    let a = system.a.clone();
    (system, a)
}

/// A chain of five bodies at odd angles, hanging from the world by the first; also one whose root floats.
fn chain(seed: u64, ball_joints: bool) -> (Vec<RigidBody>, Vec<Constraint>) {
    let mut random = Random::new(seed);
    let bodies: Vec<RigidBody> = (0..5).map(|_| body(&mut random)).collect();
    let mut constraints = Vec::new();
    for i in 0..5_usize {
        let parent = i.checked_sub(1);
        if parent.is_some() || ball_joints {
            constraints.push(Constraint::new(&format!("point-{i}"), point(&mut random, Some(i), parent)));
        }
    }
    constraints.push(Constraint::new("turn", orientation(&mut random, Some(3), Some(1))));
    (bodies, constraints)
}

#[test]
fn a_joint_of_share_s_carries_s_of_the_hard_force() {
    let mut worst = 0.0_f64;
    for seed in 0..40 {
        for method in [LinearSolver::Sparse, LinearSolver::Dense] {
            let (bodies, constraints) = chain(seed, seed % 4 > 0);
            // The orientation closes a loop; the others are at the root, inside and at the end of the chain.
            for fading in 0..constraints.len() {
                let mut faded = constraints.clone();
                faded[fading].schedule = ramp(1.0);
                let (hard, _) = solve(&bodies, &constraints, method, 1.0);
                let scale = hard.lambda.iter().fold(0.0_f64, |s, x| s.max(x.abs()));
                for activation in [0.01, 0.3, 0.9] {
                    let (soft, _) = solve(&bodies, &faded, method, activation);
                    for row in soft.acting_rows().into_iter().filter(|&row| soft.compliance(row, row) > 0.0) {
                        let error = (soft.lambda[row] - activation * hard.lambda[row]).abs() / scale;
                        worst = worst.max(error);
                        let at = format!("seed {seed}, {method:?}, constraint {fading}, share {activation}");
                        assert!(error < CARRIED, "{at}: carries {} of {}", soft.lambda[row], hard.lambda[row]);
                    }
                }
            }
        }
    }
    println!("a share's force is off by {worst:.1e} of the largest");
}

#[test]
fn crossing_shares_lead_from_one_joint_to_the_other() {
    for seed in 0..20 {
        let mut random = Random::new(seed);
        let bodies = vec![body(&mut random)];
        let places = [DVec3::new(0.3, 0.8, 0.1), DVec3::new(-0.5, 0.6, 0.2)];
        let nail = |name: &str, place: DVec3, schedule: Schedule| {
            let kind = ConstraintKind::PointToPoint {
                a: world_anchor(&bodies, Some(0), place),
                b: world_anchor(&bodies, None, place),
            };
            Constraint { schedule, ..Constraint::new(name, kind) }
        };
        let falling =
            Schedule { windows: vec![Window { start: -9.0, end: 1.0 }], ramp_out: 1.0, ..Schedule::default() };
        let both = [nail("from", places[0], falling), nail("to", places[1], ramp(1.0))];
        for method in [LinearSolver::Sparse, LinearSolver::Dense] {
            for (activation, alone) in [(1e-9, &both[0]), (1.0 - 1e-9, &both[1])] {
                let alone = [Constraint { schedule: Schedule::default(), ..alone.clone() }];
                let (_, expected) = solve(&bodies, &alone, method, 0.0);
                let (_, found) = solve(&bodies, &both, method, activation);
                let off = (linear(&found[0]) - linear(&expected[0])).length()
                    + (angular(&found[0]) - angular(&expected[0])).length();
                // A billionth of the other is left.
                assert!(off < 1e-6, "seed {seed}, {method:?} at {activation}: off by {off}");
            }
        }
    }
}

#[test]
fn a_share_of_a_row_that_repeats_a_hard_one_changes_nothing() {
    let (bodies, mut constraints) = chain(3, true);
    let (_, expected) = solve(&bodies, &constraints, LinearSolver::Sparse, 1.0);
    let again = Constraint { name: "again".into(), schedule: ramp(1.0), ..constraints[2].clone() };
    constraints.push(again);
    for method in [LinearSolver::Sparse, LinearSolver::Dense] {
        let (_, found) = solve(&bodies, &constraints, method, 0.4);
        for (found, expected) in found.iter().zip(&expected) {
            assert!((0..6).all(|k| (found[k] - expected[k]).abs() < 1e-8), "{method:?}: {found:?} {expected:?}");
        }
    }
    // Said twice with one share, neither is hard.
    constraints[2].schedule = ramp(1.0);
    for method in [LinearSolver::Sparse, LinearSolver::Dense] {
        let (system, found) = solve(&bodies, &constraints, method, 0.4);
        assert!((0..6).any(|k| (found[2][k] - expected[2][k]).abs() > 1e-3), "{method:?}: still hard");
        assert!(system.lambda.iter().all(|x| x.is_finite()));
    }
}

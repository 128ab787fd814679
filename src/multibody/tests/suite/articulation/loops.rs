//! Closed loops of any shape: the sparse elimination against the whole system, with rows that repeat others, soft rows, driven
//! bodies and sleepers.

use soffio_geometry::bodies::RigidBody;
use soffio_math::noise::Random;
use soffio_math::{DVec3, Function, rotation};
use soffio_multibody::articulation::{Constraint, ConstraintKind, LinearSolver, Schedule, System, Window};

use super::kkt::independent;
use super::mechanisms::{RandomMechanism, below, body, vector, world_anchor, world_axis};
use super::solvers::{LEAST, Posed, SOLVED, largest, off, prepare};

/// How many mechanisms of each kind.
const MECHANISMS: usize = 60;
/// A row within a billionth of the others repeats them.
const REPEATS: f64 = 1e-9;

/// What is special about a mechanism.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    /// Points in space.
    Balls,
    /// Hinges across one plane: each loop has three rows too many.
    Hinges,
    /// Points; one body is kinematic.
    Kinematic,
    /// Points, some of them in part only.
    Soft,
    /// Points that leave the whole afloat.
    Floating,
}

/// Bodies in a closed mechanism of several loops: joined where they are, each to one before it and some to others.
fn mechanism(random: &mut Random, kind: Kind) -> RandomMechanism {
    let count = 4 + below(random, 9);
    let bodies: Vec<RigidBody> = (0..count).map(|_| body(random)).collect();
    let rotated = rotation(3.0 * vector(random));
    let mut constraints: Vec<Constraint> = Vec::new();
    let mut join = |random: &mut Random, a: usize, b: Option<usize>| {
        let joint = constraints.len();
        let flat = if kind == Kind::Hinges { DVec3::new(1.0, 1.0, 0.0) } else { DVec3::ONE };
        let place = rotated * (vector(random) * flat);
        let point = |body| world_anchor(&bodies, body, place);
        let mut point = Constraint::new(
            &format!("joint-{joint}/point"),
            ConstraintKind::PointToPoint { a: point(Some(a)), b: point(b) },
        );
        if kind == Kind::Soft && random.unit() < 0.3 {
            let windows = vec![Window { start: -0.5, end: 9.0 }];
            point.schedule = Schedule { windows, ramp_in: random.range(0.6, 5.0), ..Schedule::default() };
        }
        constraints.push(point);
        if kind == Kind::Hinges {
            let axis = |body, direction| world_axis(&bodies, body, direction);
            for across in [rotated * DVec3::X, rotated * DVec3::Y] {
                let (a, b) = (axis(Some(a), rotated * DVec3::Z), axis(b, across));
                let kind = ConstraintKind::Orientation { a, b, angle: Function::default() };
                constraints.push(Constraint::new(&format!("joint-{joint}/across"), kind));
            }
        }
    };
    if kind != Kind::Floating {
        join(random, 0, None);
    }
    for body in 1..count {
        let parent = below(random, body);
        join(random, body, Some(parent));
    }
    for _ in 0..1 + below(random, count / 2) {
        let a = below(random, count);
        let b = (a + 1 + below(random, count - 1)) % count;
        join(random, a, Some(b));
    }
    let mut kinematic = vec![false; count];
    if kind == Kind::Kinematic {
        kinematic[below(random, count)] = true;
    }
    RandomMechanism { bodies, kinematic, constraints, time: 0.0 }
}

#[test]
fn loops_of_any_shape_are_solved_as_by_elimination() {
    let mut worst = 0.0_f64;
    for kind in [Kind::Balls, Kind::Hinges, Kind::Kinematic, Kind::Soft, Kind::Floating] {
        let (mut done, mut seed, mut repeated) = (0, 0, 0);
        while done < MECHANISMS {
            let mechanism = mechanism(&mut Random::new(seed), kind);
            seed += 1;
            let systems = [LinearSolver::Sparse, LinearSolver::Dense].map(|method| prepare(&mechanism, method, false));
            let rows = systems[0].acting_rows();
            let (kept, least) = independent(&systems[0], &mechanism.bodies, &rows, REPEATS);
            if least < LEAST || (kind == Kind::Soft && kept.len() < rows.len()) {
                continue;
            }
            done += 1;
            repeated += rows.len() - kept.len();
            for system in systems {
                assert_eq!(system.redundant_rows().len(), rows.len() - kept.len(), "{kind:?}, seed {seed}");
                let left_out = system.redundant_rows();
                let mut posed = Posed::new(system, &mut Random::new(seed));
                posed.solve();
                let expected = posed.reference(&mechanism.bodies, &kept);
                let error = off(&posed.system.a, &expected.a) / largest(&expected).max(1.0);
                assert!(error < SOLVED, "{kind:?}, seed {seed}: off by {error:e}");
                assert!(left_out.iter().all(|(_, row)| posed.system.lambda[*row] == 0.0), "{kind:?}, seed {seed}");
                worst = worst.max(error);
            }
        }
        // Each mechanism of hinges has a loop at least.
        assert!(kind != Kind::Hinges || repeated >= 3 * MECHANISMS, "{repeated} rows repeat others");
    }
    println!("loops of any shape: off by {worst:.1e} at most");
}

#[test]
fn loops_that_sleep_are_left_out_and_change_nothing_else() {
    for seed in 0..20 {
        let mut random = Random::new(seed);
        let [first, second] = [(); 2].map(|()| mechanism(&mut random, Kind::Balls));
        let count = first.bodies.len();
        let bodies = [first.bodies, second.bodies].concat();
        let others = second.constraints.iter().map(|constraint| shifted(constraint, count));
        let constraints = first.constraints.into_iter().chain(others).collect();
        let both = RandomMechanism { kinematic: vec![false; bodies.len()], bodies, constraints, time: 0.0 };
        let mut awake = Posed::new(prepare(&both, LinearSolver::Sparse, false), &mut Random::new(seed));
        awake.solve();
        let mut system = System::new(&both.bodies, &both.kinematic, &both.constraints, LinearSolver::Sparse);
        let asleep: Vec<bool> = (0..both.bodies.len()).map(|body| body >= count).collect();
        system.evaluate(&both.bodies);
        system.let_sleep(&asleep, &both.bodies);
        system.evaluate(&both.bodies);
        system.factor();
        let mut half = Posed::new(system, &mut Random::new(seed));
        half.solve();
        assert_eq!(half.system.a[..count], awake.system.a[..count], "seed {seed}");
        assert!(half.system.a[count..].iter().all(|a| *a == [0.0; 6]), "seed {seed}");
    }
}

/// A joint of bodies that are counted from another one on.
fn shifted(constraint: &Constraint, by: usize) -> Constraint {
    let mut shifted = constraint.clone();
    if let ConstraintKind::PointToPoint { a, b } = &mut shifted.kind {
        for anchor in [a, b] {
            anchor.body = anchor.body.map(|body| body + by);
        }
    }
    shifted
}

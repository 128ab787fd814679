//! Both solvers against the reference: 1,000 random mechanisms, and mechanisms whose rows repeat each other.

use soffio_geometry::bodies::RigidBody;
use soffio_math::Function;
use soffio_math::noise::Random;
use soffio_math::spatial::Vec6;
use soffio_math::{DVec3, rotation};
use soffio_multibody::articulation::{Constraint, ConstraintKind, LinearSolver, System};

use super::kkt::{Solution, independent, reference, well_posed};
use super::mechanisms::{Kinds, RandomMechanism, below, body, mechanism, plane, point, vector, wrench};

/// Of the largest unknown. Rows that lean on each other by less than `LEAST` are drawn again: condition numbers stay
/// below some 10⁵, so that a solver that loses no more than they cost is four digits better than this.
pub const SOLVED: f64 = 1e-10;
/// Least share of itself that a row of a random mechanism adds to the rows before it.
pub const LEAST: f64 = 0.03;
/// How many systems, and how many for mechanisms whose rows repeat each other.
const SYSTEMS: u64 = 1000;
const REPEATING: u64 = 100;

/// A solver ready to solve, with the right-hand side it was given.
pub struct Posed {
    pub system: System,
    b: Vec<Vec6>,
    g: Vec<f64>,
    given: Vec<Vec6>,
}

pub fn prepare(mechanism: &RandomMechanism, method: LinearSolver, friction: bool) -> System {
    let mut system = System::new(&mechanism.bodies, &mechanism.kinematic, &mechanism.constraints, method);
    system.activity.update_activations(mechanism.time);
    system.activity.set_time(mechanism.time);
    system.evaluate(&mechanism.bodies);
    if friction {
        let loads = vec![10.0; system.joints().len()];
        system.add_friction(&mechanism.bodies, &loads, 0.004);
    }
    system.factor();
    system
}

impl Posed {
    /// Random forces, driven accelerations, and wanted J a (of random accelerations, so that they can be had).
    pub fn new(system: System, random: &mut Random) -> Self {
        let n = system.kinematic().len();
        let b: Vec<Vec6> = (0..n).map(|_| wrench(random)).collect();
        let wanted: Vec<Vec6> = (0..n).map(|_| wrench(random)).collect();
        let given: Vec<Vec6> = (0..n).map(|i| if system.kinematic()[i] { wanted[i] } else { [0.0; 6] }).collect();
        let mut g = vec![0.0; system.g.len()];
        for row in system.acting_rows() {
            g[row] = product(&system, row, &wanted);
        }
        Self { system, b, g, given }
    }

    pub fn solve(&mut self) {
        self.system.b.copy_from_slice(&self.b);
        self.system.g.copy_from_slice(&self.g);
        self.system.a.copy_from_slice(&self.given);
        self.system.solve();
    }

    pub fn reference(&self, bodies: &[RigidBody], rows: &[usize]) -> Solution {
        reference(&self.system, bodies, rows, (&self.b, &self.g, &self.given))
    }
}

/// J a of one row.
fn product(system: &System, row: usize, a: &[Vec6]) -> f64 {
    system.jacobian(row).iter().map(|(body, j)| (0..6).map(|k| j[k] * a[*body][k]).sum::<f64>()).sum()
}

pub fn largest(solution: &Solution) -> f64 {
    let a = solution.a.iter().flatten().fold(0.0_f64, |s, x| s.max(x.abs()));
    solution.lambda.iter().fold(a, |s, x| s.max(x.abs()))
}

pub fn off(found: &[Vec6], expected: &[Vec6]) -> f64 {
    found.iter().flatten().zip(expected.iter().flatten()).fold(0.0_f64, |worst, (x, y)| worst.max((x - y).abs()))
}

#[test]
fn both_solvers_match_elimination_in_a_thousand_random_mechanisms() {
    let (mut worst, mut seed) = (0.0_f64, 0);
    let mut done = [0; 5];
    while done[0] < SYSTEMS {
        let kinds = Kinds { loops: seed % 3 > 0, partial_rows: seed % 4 == 1, friction: seed % 4 == 2 };
        let mechanism = mechanism(&mut Random::new(seed), kinds);
        let sparse = prepare(&mechanism, LinearSolver::Sparse, kinds.friction);
        let rows = sparse.acting_rows();
        let soft = rows.iter().any(|&row| sparse.compliance(row, row) > 0.0);
        // Friction's soft rows repeat hard ones, so the hard ones must be independent.
        let loaded: Vec<usize> = if kinds.friction {
            rows.iter().copied().filter(|&row| sparse.compliance(row, row) == 0.0).collect()
        } else {
            rows.clone()
        };
        if !well_posed(&sparse, &mechanism.bodies, &loaded, LEAST) {
            seed += 1;
            continue;
        }
        let dense = prepare(&mechanism, LinearSolver::Dense, kinds.friction);
        let mut solutions: Vec<Vec<Vec6>> = Vec::new();
        for (method, system) in [("sparse", sparse), ("dense", dense)] {
            let mut posed = Posed::new(system, &mut Random::new(seed));
            posed.solve();
            let expected = posed.reference(&mechanism.bodies, &rows);
            let scale = largest(&expected).max(1.0);
            let mut error = off(&posed.system.a, &expected.a) / scale;
            for (index, &row) in rows.iter().enumerate() {
                error = error.max((posed.system.lambda[row] - expected.lambda[index]).abs() / scale);
            }
            assert!(error < SOLVED, "seed {seed}, {method}: off by {error:e}");
            worst = worst.max(error);
            solutions.push(posed.system.a.clone());
            if let [sparse, dense] = &solutions[..] {
                let error = off(sparse, dense) / scale;
                assert!(error < SOLVED, "seed {seed}: the solvers differ by {error:e}");
            }
        }
        let couples = mechanism.constraints.iter().any(|c| matches!(c.kind, ConstraintKind::Coupling { .. }));
        for (count, seen) in
            done.iter_mut().zip([true, kinds.loops, couples, soft, mechanism.kinematic.contains(&true)])
        {
            *count += u64::from(seen);
        }
        seed += 1;
    }
    println!("{done:?} systems (all, loops, couplings, soft rows, driven), {seed} seeds: off by {worst:.1e} at most");
    assert!(done.into_iter().all(|count| count > SYSTEMS / 10), "too few of a kind: {done:?}");
}

/// A ring of hinges in a plane somewhere in space: three of its rows repeat others.
fn planar_ring(random: &mut Random) -> RandomMechanism {
    let count = 3 + below(random, 4);
    let rotated = rotation(3.0 * vector(random));
    let normal = rotated * DVec3::Z;
    let bodies: Vec<RigidBody> = (0..count).map(|_| body(random)).collect();
    let mut constraints: Vec<Constraint> = Vec::new();
    let pins: Vec<DVec3> =
        (0..count + 1).map(|_| rotated * DVec3::new(random.signed(), random.signed(), 0.0)).collect();
    for pin in 0..=count {
        let (a, b) = ((pin < count).then_some(pin), pin.checked_sub(1));
        let (Some(first), second) = (if a.is_some() { (a, b) } else { (b, None) }) else { continue };
        let anchor = |body: Option<usize>| super::mechanisms::world_anchor(&bodies, body, pins[pin]);
        let kind = ConstraintKind::PointToPoint { a: anchor(Some(first)), b: anchor(second) };
        constraints.push(Constraint::new(&format!("pin-{pin}/point"), kind));
        for across in [rotated * DVec3::X, rotated * DVec3::Y] {
            let axis = |body, v| super::mechanisms::world_axis(&bodies, body, v);
            let (a, b) = (axis(Some(first), normal), axis(second, across));
            let kind = ConstraintKind::Orientation { a, b, angle: Function::default() };
            constraints.push(Constraint::new(&format!("pin-{pin}/across"), kind));
        }
    }
    RandomMechanism { kinematic: vec![false; bodies.len()], bodies, constraints, time: 0.0 }
}

/// A tree in which one joint's rows are said again in other words.
fn said_twice(random: &mut Random) -> RandomMechanism {
    let bodies: Vec<RigidBody> = (0..3).map(|_| body(random)).collect();
    let mut constraints = Vec::new();
    for (index, link) in [(Some(0), None), (Some(1), Some(0)), (Some(1), Some(2))].into_iter().enumerate() {
        constraints.push(Constraint::new(&format!("point-{index}"), point(random, link.0, link.1)));
    }
    // The point of bodies 1 and 2 again, as a plane through it.
    let ConstraintKind::PointToPoint { a, b } = constraints[2].kind.clone() else { return said_twice(random) };
    if let ConstraintKind::PointOnPlane { normal, .. } = plane(random, a.body, b.body) {
        // Where the two points coincide the plane's row lies among the point's.
        let kind = ConstraintKind::PointOnPlane { point: a, plane: b, normal, offset: Function::default() };
        constraints.push(Constraint::new("again", kind));
    }
    let mut mechanism = RandomMechanism { kinematic: vec![false; 3], bodies, constraints, time: 0.0 };
    let gap =
        super::mechanisms::world_point(&mechanism.bodies, &a) - super::mechanisms::world_point(&mechanism.bodies, &b);
    mechanism.bodies[1].position -= gap;
    mechanism
}

#[test]
fn rows_that_repeat_others_are_found_and_leave_the_motion_as_it_is() {
    // A row within a billionth of the others counts as redundant: rounding leaves a thousandth of that.
    const REPEATS: f64 = 1e-9;
    let mut worst = 0.0_f64;
    let mut seed = 0;
    let mut done = 0;
    while done < REPEATING {
        let mut random = Random::new(seed);
        let mechanism = if seed % 2 == 0 { planar_ring(&mut random) } else { said_twice(&mut random) };
        for method in [LinearSolver::Sparse, LinearSolver::Dense] {
            let system = prepare(&mechanism, method, false);
            let rows = system.acting_rows();
            let (kept, least) = independent(&system, &mechanism.bodies, &rows, REPEATS);
            if least < LEAST {
                continue;
            }
            assert!(kept.len() < rows.len());
            assert_eq!(system.redundant_rows().len(), rows.len() - kept.len(), "seed {seed}, {method:?}");
            let mut posed = Posed::new(system, &mut Random::new(seed));
            posed.solve();
            let expected = posed.reference(&mechanism.bodies, &kept);
            let error = off(&posed.system.a, &expected.a) / largest(&expected).max(1.0);
            assert!(error < SOLVED, "seed {seed}, {method:?}: off by {error:e}");
            worst = worst.max(error);
            done += 1;
        }
        seed += 1;
    }
    println!("{done} systems with rows that repeat others, {seed} seeds: off by {worst:.1e} at most");
}

//! The tree factor against a dense solve of the same equations, on random figures with and without loops.

use soffio::articulation::block::{angular, linear, vec6};
use soffio::articulation::{Anchor, Axis, Constraint, ConstraintKind, Function, Method, System};
use soffio::bodies::{MassProperties, RigidBody};
use soffio::math::{DMat3, DVec3, Pose, rotation};
use soffio::noise::Random;

/// A few hundred roundings at condition numbers below 10⁶.
const SOLVED: f64 = 1e-8;

fn random_vector(random: &mut Random) -> DVec3 {
    DVec3::new(random.signed(), random.signed(), random.signed())
}

fn random_body(random: &mut Random) -> RigidBody {
    let pose = Pose { rotation: rotation(2.0 * random_vector(random)), position: random_vector(random) };
    let inertia = DMat3::from_diagonal(DVec3::new(0.3, 0.4, 0.5) * random.range(0.1, 1.0));
    let properties = MassProperties { mass: random.range(0.2, 3.0), center: 0.1 * random_vector(random), inertia };
    RigidBody {
        velocity: random_vector(random),
        angular_velocity: random_vector(random),
        ..RigidBody::at_rest(properties, pose)
    }
}

fn point(random: &mut Random, name: usize, a: Option<usize>, b: Option<usize>) -> Constraint {
    let anchor = |body, random: &mut Random| Anchor { body, point: random_vector(random) };
    let kind = ConstraintKind::PointToPoint { a: anchor(a, random), b: anchor(b, random) };
    Constraint::new(&format!("point-{name}"), kind)
}

fn orientation(random: &mut Random, name: usize, a: Option<usize>, b: Option<usize>) -> Constraint {
    let axis = |body, random: &mut Random| Axis { body, direction: random_vector(random).normalize() };
    let kind = ConstraintKind::Orientation { a: axis(a, random), b: axis(b, random), angle: Function::default() };
    Constraint::new(&format!("orientation-{name}"), kind)
}

/// A random figure: a tree hung from the world, every third joint with an orientation row, and `loops` extra joints.
fn figure(random: &mut Random, bodies: usize, loops: usize) -> (Vec<RigidBody>, Vec<Constraint>) {
    let all = (0..bodies).map(|_| random_body(random)).collect();
    let mut constraints = Vec::new();
    for body in 0..bodies {
        let parent = (body > 0).then(|| (random.word() % body as u64) as usize);
        // Either order of the two ends.
        let (a, b) = if body % 2 == 0 { (Some(body), parent) } else { (parent, Some(body)) };
        constraints.push(point(random, body, a, b));
        if body % 3 == 0 {
            constraints.push(orientation(random, body, a, b));
        }
    }
    // Loops between pairs that have no joint yet: a second point between the same pair would repeat a row.
    let mut free: Vec<_> = (0..bodies).flat_map(|a| (0..a).map(move |b| (a, b))).collect();
    free.retain(|&(a, b)| {
        !constraints
            .iter()
            .any(|c: &Constraint| c.link() == Some((Some(a), Some(b))) || c.link() == Some((Some(b), Some(a))))
    });
    for (extra, &(a, b)) in free.iter().take(loops).enumerate() {
        constraints.push(point(random, bodies + extra, Some(a), Some(b)));
    }
    (all, constraints)
}

/// Gaussian elimination with row pivoting.
fn dense_solve(mut m: Vec<Vec<f64>>, mut rhs: Vec<f64>) -> Vec<f64> {
    let n = rhs.len();
    for k in 0..n {
        let pivot = (k..n).max_by(|&i, &j| m[i][k].abs().total_cmp(&m[j][k].abs())).expect("rows remain");
        m.swap(k, pivot);
        rhs.swap(k, pivot);
        for i in k + 1..n {
            let s = m[i][k] / m[k][k];
            for j in k..n {
                m[i][j] -= s * m[k][j];
            }
            rhs[i] -= s * rhs[k];
        }
    }
    for k in (0..n).rev() {
        for j in k + 1..n {
            rhs[k] -= m[k][j] * rhs[j];
        }
        rhs[k] /= m[k][k];
    }
    rhs
}

/// The whole system [M −Jᵀ; J Γ] as one matrix, from the rows alone.
fn dense(system: &System, bodies: &[RigidBody], b: &[[f64; 6]], g: &[f64]) -> Vec<f64> {
    let rows = system.acting_rows();
    let n = 6 * bodies.len() + rows.len();
    let mut m = vec![vec![0.0; n]; n];
    let mut rhs = vec![0.0; n];
    for (i, body) in bodies.iter().enumerate() {
        let inertia = body.inertia_world();
        for k in 0..3 {
            m[6 * i + k][6 * i + k] = body.properties.mass;
            for l in 0..3 {
                m[6 * i + 3 + k][6 * i + 3 + l] = inertia.col(l)[k];
            }
        }
        rhs[6 * i..6 * i + 6].copy_from_slice(&b[i]);
    }
    for (index, &row) in rows.iter().enumerate() {
        let at = 6 * bodies.len() + index;
        for (body, block) in system.jacobian(row) {
            for c in 0..6 {
                m[at][6 * body + c] = block[c];
                m[6 * body + c][at] = -block[c];
            }
        }
        m[at][at] = system.softness(row).0;
        rhs[at] = g[row];
    }
    dense_solve(m, rhs)
}

#[test]
fn tree_and_loops_solve_as_the_dense_matrix_does() {
    for seed in 0..60 {
        for method in [Method::Sparse, Method::Dense] {
            let mut random = Random::new(seed);
            let bodies = 2 + (seed % 7) as usize;
            let loops = (seed % 3) as usize;
            let (bodies, constraints) = figure(&mut random, bodies, loops);
            let mut system = System::new(&bodies, &vec![false; bodies.len()], &constraints, method);
            system.evaluate(&bodies);
            if seed % 2 == 1 {
                let loads = vec![1.0; system.joints().len()];
                system.add_friction(&bodies, &loads, 0.01);
            }
            system.factor();
            let b: Vec<_> =
                bodies.iter().map(|_| vec6(random_vector(&mut random), random_vector(&mut random))).collect();
            let g: Vec<_> = system.g.iter().map(|_| random.signed()).collect();
            system.b.copy_from_slice(&b);
            system.g.copy_from_slice(&g);
            system.solve();
            let reference = dense(&system, &bodies, &b, &g);
            let scale = reference.iter().fold(1.0_f64, |s, x| s.max(x.abs()));
            for (i, a) in system.a.iter().enumerate() {
                for k in 0..6 {
                    let error = (a[k] - reference[6 * i + k]).abs() / scale;
                    assert!(error < SOLVED, "seed {seed}, {method:?}, body {i}: off by {error}");
                }
            }
            for (index, &row) in system.acting_rows().iter().enumerate() {
                let error = (system.lambda[row] - reference[6 * bodies.len() + index]).abs() / scale;
                assert!(error < SOLVED, "seed {seed}, {method:?}, row {row}: off by {error}");
            }
        }
    }
}

#[test]
fn a_row_said_twice_is_found_and_harmless() {
    let mut random = Random::new(7);
    let (bodies, mut constraints) = figure(&mut random, 2, 0);
    let ConstraintKind::PointToPoint { .. } = constraints[0].kind else { panic!("the first joint is a point") };
    let twice = Constraint { name: "twice".into(), ..constraints[0].clone() };
    constraints.insert(1, twice);
    for method in [Method::Sparse, Method::Dense] {
        let mut system = System::new(&bodies, &[false; 2], &constraints, method);
        system.evaluate(&bodies);
        system.factor();
        assert_eq!(system.redundant_rows().len(), 3, "three rows repeat three others");
        system.solve_velocity(&bodies);
        let mut after = bodies.clone();
        system.apply_velocity(&mut after);
        system.evaluate(&after);
        for row in system.acting_rows() {
            let rate: f64 = system
                .jacobian(row)
                .iter()
                .map(|(body, j)| linear(j).dot(after[*body].velocity) + angular(j).dot(after[*body].angular_velocity))
                .sum();
            // What is far apart is not projected but gathers.
            let gathers = system.states()[row].value.abs() > 1e-4;
            assert!(gathers || rate.abs() < SOLVED, "row {row} still runs at {rate}");
        }
        assert!(system.a.iter().all(|a| linear(a).is_finite() && angular(a).is_finite()));
    }
}

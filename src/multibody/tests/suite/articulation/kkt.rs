//! The reference: the whole system [M −Jᵀ; J Γ] as one matrix, by Gaussian elimination with full row pivoting.

use soffio_geometry::bodies::RigidBody;
use soffio_math::spatial::Vec6;
use soffio_multibody::articulation::{Constraint, ConstraintKind, System};

/// Gaussian elimination with row pivoting, then one step of refinement with the residual of the matrix as given.
fn solve(matrix: &[Vec<f64>], rhs: &[f64]) -> Vec<f64> {
    let n = rhs.len();
    let mut m = matrix.to_vec();
    let mut order: Vec<usize> = (0..n).collect();
    for k in 0..n {
        let pivot = (k..n).max_by(|&i, &j| m[i][k].abs().total_cmp(&m[j][k].abs())).expect("rows remain");
        m.swap(k, pivot);
        order.swap(k, pivot);
        let (done, remaining) = m.split_at_mut(k + 1);
        let row = &done[k];
        for below in remaining {
            let s = below[k] / row[k];
            below[k] = s;
            for j in k + 1..n {
                below[j] -= s * row[j];
            }
        }
    }
    let substitute = |rhs: &[f64]| {
        let mut x: Vec<f64> = order.iter().map(|&i| rhs[i]).collect();
        for k in 0..n {
            x[k] -= (0..k).map(|j| m[k][j] * x[j]).sum::<f64>();
        }
        for k in (0..n).rev() {
            x[k] = (x[k] - (k + 1..n).map(|j| m[k][j] * x[j]).sum::<f64>()) / m[k][k];
        }
        x
    };
    let mut x = substitute(rhs);
    let left: Vec<f64> = (0..n).map(|i| rhs[i] - (0..n).map(|j| matrix[i][j] * x[j]).sum::<f64>()).collect();
    for (x, correction) in x.iter_mut().zip(substitute(&left)) {
        *x += correction;
    }
    x
}

/// What the reference finds: accelerations, and multipliers of the rows asked for.
pub struct Solution {
    pub a: Vec<Vec6>,
    pub lambda: Vec<f64>,
}

/// Solves M a − Jᵀλ = b, J a + Γ λ = g for these rows; a driven body's a is given in `given`.
pub fn reference(
    system: &System,
    bodies: &[RigidBody],
    rows: &[usize],
    (b, g, given): (&[Vec6], &[f64], &[Vec6]),
) -> Solution {
    let n = 6 * bodies.len() + rows.len();
    let mut m = vec![vec![0.0; n]; n];
    let mut rhs = vec![0.0; n];
    for (i, body) in bodies.iter().enumerate() {
        let inertia = body.inertia_world();
        for k in 0..6 {
            let at = 6 * i + k;
            if system.kinematic()[i] {
                (m[at][at], rhs[at]) = (1.0, given[i][k]);
            } else if k < 3 {
                (m[at][at], rhs[at]) = (body.properties.mass, b[i][k]);
            } else {
                (0..3).for_each(|l| m[at][6 * i + 3 + l] = inertia.col(l)[k - 3]);
                rhs[at] = b[i][k];
            }
        }
    }
    for (index, &row) in rows.iter().enumerate() {
        let at = 6 * bodies.len() + index;
        for (body, block) in system.jacobian(row) {
            for c in 0..6 {
                m[at][6 * body + c] += block[c];
                if !system.kinematic()[body] {
                    m[6 * body + c][at] -= block[c];
                }
            }
        }
        for (other, &column) in rows.iter().enumerate() {
            m[at][6 * bodies.len() + other] = system.compliance(row, column);
        }
        rhs[at] = g[row];
    }
    let x = solve(&m, &rhs);
    let (a, lambda) = x.split_at(6 * bodies.len());
    Solution { a: a.chunks_exact(6).map(|c| [c[0], c[1], c[2], c[3], c[4], c[5]]).collect(), lambda: lambda.to_vec() }
}

/// The rows among these that do not repeat earlier ones, and the smallest share of itself that any of them adds: by
/// Gram and Schmidt, twice, on rows weighed by M^(-1/2). Of the bodies only those count that `counts`.
fn spread(
    system: &System,
    bodies: &[RigidBody],
    rows: &[usize],
    least: f64,
    counts: impl Fn(usize) -> bool,
) -> (Vec<usize>, f64) {
    let mut basis: Vec<Vec<f64>> = Vec::new();
    let (mut kept, mut smallest) = (Vec::new(), 1.0_f64);
    for &row in rows {
        let mut v = vec![0.0; 6 * bodies.len()];
        for (body, block) in system.jacobian(row).into_iter().filter(|(body, _)| counts(*body)) {
            let properties = &bodies[body].properties;
            // About one inertia: the rows' angles matter here, not their exact weights.
            let inertia = bodies[body].inertia_world();
            let mean = (inertia.x_axis.x + inertia.y_axis.y + inertia.z_axis.z) / 3.0;
            for c in 0..6 {
                v[6 * body + c] += block[c] / if c < 3 { properties.mass } else { mean }.sqrt();
            }
        }
        let length = |v: &[f64]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
        let whole = length(&v);
        for _ in 0..2 {
            for e in &basis {
                let s: f64 = e.iter().zip(&v).map(|(x, y)| x * y).sum();
                v.iter_mut().zip(e).for_each(|(x, y)| *x -= s * y);
            }
        }
        let left = length(&v);
        if whole > 0.0 && left > least * whole {
            smallest = smallest.min(left / whole);
            v.iter_mut().for_each(|x| *x /= left);
            basis.push(v);
            kept.push(row);
        }
    }
    (kept, smallest)
}

/// The rows among these that do not repeat earlier ones, and the smallest share of itself that any of them adds.
pub fn independent(system: &System, bodies: &[RigidBody], rows: &[usize], least: f64) -> (Vec<usize>, f64) {
    spread(system, bodies, rows, least, |body| !system.kinematic()[body])
}

/// Do these rows stand by themselves, and those of every joint on either of its bodies alone? Two points between one
/// pair of bodies do not: once they have met, the second repeats one row of the first, so a tree may say that it does.
/// For the same reason, do the rows of whatever hangs on one body alone, with that body held?
pub fn well_posed(system: &System, bodies: &[RigidBody], rows: &[usize], least: f64) -> bool {
    let alone = |body: usize, own: &[usize]| {
        system.kinematic()[body] || spread(system, bodies, own, least, |b| b == body).0.len() == own.len()
    };
    system.joints().iter().all(|joint| {
        let own: Vec<usize> = (joint.at..joint.at + joint.hard).filter(|row| rows.contains(row)).collect();
        alone(joint.link.a, &own) && joint.link.b.is_none_or(|b| alone(b, &own))
    }) && independent(system, bodies, rows, least).0.len() == rows.len()
        && (0..bodies.len()).all(|top| {
            let hanging = hanging(system, bodies.len(), top);
            let acts_on_some =
                |row: &usize, of: &dyn Fn(usize) -> bool| system.jacobian(*row).iter().any(|(body, _)| of(*body));
            let own: Vec<usize> = rows.iter().copied().filter(|row| acts_on_some(row, &|body| hanging[body])).collect();
            spread(system, bodies, &own, least, |body| hanging[body]).0.len() == own.len()
        })
}

/// The bodies that constraints join to the rest, and to the ground, through this body alone.
fn hanging(system: &System, count: usize, top: usize) -> Vec<bool> {
    let touched = |constraint: &Constraint| {
        let ends: Vec<Option<usize>> = match (&constraint.kind, constraint.link()) {
            (ConstraintKind::Coupling { terms }, _) => {
                terms.iter().flat_map(|term| <[_; 2]>::from(term.measure.bodies())).collect()
            }
            (_, link) => link.map_or(Vec::new(), |(a, b)| vec![a, b]),
        };
        let vertex = |end: &Option<usize>| end.filter(|&body| !system.kinematic()[body]).unwrap_or(count);
        ends.iter().map(vertex).filter(|&vertex| vertex != top).collect::<Vec<_>>()
    };
    // Whatever is met from the ground, as long as there is more of it.
    let mut reached = vec![false; count + 1];
    reached[count] = true;
    for _ in 0..count {
        for constraint in system.constraints() {
            let touched = touched(constraint);
            if touched.iter().any(|&vertex| reached[vertex]) {
                touched.iter().for_each(|&vertex| reached[vertex] = true);
            }
        }
    }
    (0..count).map(|body| !reached[body] && body != top).collect()
}

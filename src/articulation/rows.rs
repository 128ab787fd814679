//! Constraints as stacks of one-DOF rows: C, J, and the part J̇ẋ of C̈ that does not depend on accelerations.
//!
//! Symbols: x centre of mass, r = R p world vector from the centre to a body point p, v and ω velocities, e a unit
//! vector of the world. A row multiplies the coordinates (v, ω) of two bodies: Ċ = J_a (v_a, ω_a) + J_b (v_b, ω_b).
//!
//! **Point-to-point** (3 rows, e = x, y, z): C = (x₁ + r₁) − (x₂ + r₂)
//!
//! ```text
//! Ċ = v₁ + ω₁×r₁ − v₂ − ω₂×r₂            e·(ω×r) = (r×e)·ω, so J₁ = (e, r₁×e), J₂ = −(e, r₂×e)
//! J̇ẋ = ω₁×(ω₁×r₁) − ω₂×(ω₂×r₂)
//! ```
//!
//! A nail is the same with the world for the second body.
//!
//! **Orientation** (1 row): C = T·N, T and N directions fixed in two bodies or in the world
//!
//! ```text
//! Ċ = (ω_T×T)·N + T·(ω_N×N) = (T×N)·(ω_T − ω_N)          J_T = (0, T×N), J_N = −(0, T×N)
//! J̇ẋ = (ω_T×(ω_T×T))·N + T·(ω_N×(ω_N×N)) + 2 (ω_T×T)·(ω_N×N)
//! ```
//!
//! **Pivot friction** (3 soft rows): J = (0, e) and −(0, e) with compliance Γ = 1/(h c) give the impulse
//! −h c ω_rel', a viscous torque taken at the *end* of the time h. With c = μ|λ|r / |ω_rel| its size is Coulomb's
//! μ|λ|r while the pivot turns, and the same rows hold it when it stops, at any step length.

use super::block::{MAX_ROWS, RowVec, vec6};
use super::tree::{JointRows, Link};
use super::{Anchor, Axis, Constraint, ConstraintKind};
use crate::bodies::RigidBody;
use crate::math::DVec3;

/// Slowest rotation that friction tells from rest, rad/s: below it a pivot creeps by at most this.
const STICTION_RATE: f64 = 1e-7;
/// Smallest friction coefficient c of a soft row, N m s: keeps an unloaded pivot's compliance finite.
const LEAST_VISCOSITY: f64 = 1e-15;

/// All constraints between one pair of bodies, and their rows at the present configuration.
#[derive(Clone, Debug)]
pub struct Joint {
    /// The pair.
    pub link: Link,
    /// Indices of its constraints.
    pub constraints: Vec<usize>,
    /// C of each row, m or rad.
    pub value: RowVec,
    /// J̇ẋ of each row, m/s² or rad/s².
    pub bias: RowVec,
    /// Rows that are held (friction rows come after them).
    pub hard: usize,
    /// Of those, which are lengths: bit k for row k.
    pub lengths: u32,
}

/// World arm, velocity and spin of an anchor's body; the world itself stands still.
struct Point {
    position: DVec3,
    arm: DVec3,
    spin: DVec3,
}

fn point(anchor: &Anchor, bodies: &[RigidBody]) -> Point {
    match anchor.body {
        Some(index) => {
            let body = &bodies[index];
            let arm = body.arm(anchor.point);
            Point { position: body.position + arm, arm, spin: body.angular_velocity }
        }
        None => Point { position: anchor.point, arm: DVec3::ZERO, spin: DVec3::ZERO },
    }
}

fn direction(axis: &Axis, bodies: &[RigidBody]) -> (DVec3, DVec3) {
    match axis.body {
        Some(index) => (bodies[index].rotation * axis.direction, bodies[index].angular_velocity),
        None => (axis.direction, DVec3::ZERO),
    }
}

impl Constraint {
    /// The bodies it connects, in its own order.
    pub fn bodies(&self) -> (Option<usize>, Option<usize>) {
        match &self.kind {
            ConstraintKind::PointToPoint { a, b } => (a.body, b.body),
            ConstraintKind::Orientation { a, b, .. } => (a.body, b.body),
            ConstraintKind::PointOnPlane { point, plane, .. } => (point.body, plane.body),
            ConstraintKind::Coupling { .. } => (None, None),
        }
    }

    /// How many DOFs it holds.
    pub fn row_count(&self) -> usize {
        match self.kind {
            ConstraintKind::PointToPoint { .. } => 3,
            _ => 1,
        }
    }
}

/// Distance between the two points of a point constraint, m; 0 for constraints that hold no points together.
pub fn gap(constraint: &Constraint, bodies: &[RigidBody]) -> f64 {
    match &constraint.kind {
        ConstraintKind::PointToPoint { a, b } => point(a, bodies).position.distance(point(b, bodies).position),
        _ => 0.0,
    }
}

/// Groups constraints by the pair of bodies they connect.
pub fn joints(constraints: &[Constraint]) -> Vec<Joint> {
    let mut joints: Vec<Joint> = Vec::new();
    for (index, constraint) in constraints.iter().enumerate() {
        let link = match constraint.bodies() {
            (Some(a), b) => Link { a, b },
            (None, Some(b)) => Link { a: b, b: None },
            (None, None) => continue,
        };
        let same =
            |joint: &&mut Joint| joint.link == link || (Some(joint.link.a) == link.b && joint.link.b == Some(link.a));
        match joints.iter_mut().find(same) {
            Some(joint) => joint.constraints.push(index),
            None => joints.push(Joint {
                link,
                constraints: vec![index],
                value: [0.0; MAX_ROWS],
                bias: [0.0; MAX_ROWS],
                hard: 0,
                lengths: 0,
            }),
        }
    }
    joints
}

impl Joint {
    /// Fills `rows` and this joint's C and J̇ẋ for the bodies' present state.
    pub fn evaluate(&mut self, constraints: &[Constraint], bodies: &[RigidBody], rows: &mut JointRows) {
        rows.rows = 0;
        self.lengths = 0;
        for index in 0..self.constraints.len() {
            match &constraints[self.constraints[index]].kind {
                ConstraintKind::PointToPoint { a, b } => {
                    let (p1, p2) = (point(a, bodies), point(b, bodies));
                    let c = p1.position - p2.position;
                    let bias = p1.spin.cross(p1.spin.cross(p1.arm)) - p2.spin.cross(p2.spin.cross(p2.arm));
                    for (k, e) in [DVec3::X, DVec3::Y, DVec3::Z].into_iter().enumerate() {
                        self.lengths |= 1 << rows.rows;
                        let (ja, jb) = (vec6(e, p1.arm.cross(e)), vec6(-e, -p2.arm.cross(e)));
                        self.push(rows, a.body, ja, jb, c[k], bias[k]);
                    }
                }
                ConstraintKind::Orientation { a, b, .. } => {
                    let ((t, wt), (n, wn)) = (direction(a, bodies), direction(b, bodies));
                    let (dt, dn) = (wt.cross(t), wn.cross(n));
                    let bias = wt.cross(dt).dot(n) + t.dot(wn.cross(dn)) + 2.0 * dt.dot(dn);
                    let j = t.cross(n);
                    self.push(rows, a.body, vec6(DVec3::ZERO, j), vec6(DVec3::ZERO, -j), t.dot(n), bias);
                }
                _ => {}
            }
        }
        self.hard = rows.rows;
    }

    /// Adds a row whose first block belongs to `first`; the joint's own order decides which side it goes to.
    fn push(&mut self, rows: &mut JointRows, first: Option<usize>, ja: [f64; 6], jb: [f64; 6], c: f64, bias: f64) {
        let k = rows.rows;
        debug_assert!(k < MAX_ROWS, "more than {MAX_ROWS} rows between one pair of bodies");
        let own = first == Some(self.link.a);
        (rows.a[k], rows.b[k]) = if own { (ja, jb) } else { (jb, ja) };
        rows.compliance[k] = 0.0;
        self.value[k] = c;
        self.bias[k] = bias;
        rows.rows = k + 1;
    }

    /// Adds the soft rows of pivot friction after the hard ones, for a time `h` (s); `load` is the size of the force
    /// that the joint carries, N.
    pub fn add_friction(
        &self,
        constraints: &[Constraint],
        bodies: &[RigidBody],
        load: f64,
        h: f64,
        rows: &mut JointRows,
    ) {
        let spin = |body: Option<usize>| body.map_or(DVec3::ZERO, |b| bodies[b].angular_velocity);
        let rate = (spin(Some(self.link.a)) - spin(self.link.b)).length().max(STICTION_RATE);
        for &index in &self.constraints {
            let Some(friction) = constraints[index].friction else { continue };
            let viscosity = (friction.coefficient * load * friction.radius / rate).max(LEAST_VISCOSITY);
            for e in [DVec3::X, DVec3::Y, DVec3::Z] {
                let k = rows.rows;
                rows.a[k] = vec6(DVec3::ZERO, e);
                rows.b[k] = vec6(DVec3::ZERO, -e);
                rows.compliance[k] = 1.0 / (h * viscosity);
                rows.rows = k + 1;
            }
        }
    }
}

//! The articulated figure: joints, their rows, and one factor that all solves share.
//!
//! Used in this order: [`System::evaluate`] at a configuration, [`System::factor`], then any number of solves:
//! accelerations, displacements, velocity changes, responses to a unit impulse.

use super::Constraint;
use super::block::{MAX_ROWS, Mat6, RowVec, Vec6, add_scaled, dot, mass_matrix};
use super::loops::Loops;
use super::rows::{self, Joint};
use super::tree::{JointRows, Tree};
use crate::bodies::RigidBody;
use crate::math::DVec3;

/// Joints, rows and factor of an articulated figure. Nothing here allocates after [`System::new`].
#[derive(Clone, Debug)]
pub struct System {
    constraints: Vec<Constraint>,
    joints: Vec<Joint>,
    rows: Vec<JointRows>,
    tree: Tree,
    loops: Loops,
    masses: Vec<Mat6>,
    /// Right-hand side per body: force (N, N m) or impulse; used up by a solve.
    pub b: Vec<Vec6>,
    /// Wanted J a per joint row.
    pub g: Vec<RowVec>,
    /// Answer per body: acceleration, velocity change or displacement.
    pub a: Vec<Vec6>,
    /// Answer per joint row: force or impulse.
    pub lambda: Vec<RowVec>,
}

impl System {
    /// The figure of `bodies` bodies joined by `constraints`.
    pub fn new(bodies: usize, constraints: &[Constraint]) -> Self {
        let joints = rows::joints(constraints);
        let links: Vec<_> = joints.iter().map(|joint| joint.link).collect();
        let tree = Tree::new(bodies, &links);
        let loops = Loops::new(bodies, &links, &tree);
        Self {
            constraints: constraints.to_vec(),
            rows: vec![JointRows::default(); joints.len()],
            tree,
            loops,
            masses: vec![[[0.0; 6]; 6]; bodies],
            b: vec![[0.0; 6]; bodies],
            g: vec![[0.0; MAX_ROWS]; joints.len()],
            a: vec![[0.0; 6]; bodies],
            lambda: vec![[0.0; MAX_ROWS]; joints.len()],
            joints,
        }
    }

    /// The joints, in the order of `g` and `lambda`.
    pub fn joints(&self) -> &[Joint] {
        &self.joints
    }

    /// The rows at the configuration last evaluated.
    pub fn rows(&self) -> &[JointRows] {
        &self.rows
    }

    /// The tree: its loops and redundant rows.
    pub fn tree(&self) -> &Tree {
        &self.tree
    }

    /// Evaluates all rows and mass matrices for the bodies' state.
    pub fn evaluate(&mut self, bodies: &[RigidBody]) {
        for (joint, rows) in self.joints.iter_mut().zip(&mut self.rows) {
            joint.evaluate(&self.constraints, bodies, rows);
        }
        for (mass, body) in self.masses.iter_mut().zip(bodies) {
            *mass = mass_matrix(body.properties.mass, &body.inertia_world());
        }
    }

    /// Adds the soft rows of pivot friction for a time `h` (s), with the loads (N) that the joints carry.
    pub fn add_friction(&mut self, bodies: &[RigidBody], loads: &[f64], h: f64) {
        for ((joint, rows), &load) in self.joints.iter().zip(&mut self.rows).zip(loads) {
            joint.add_friction(&self.constraints, bodies, load, h, rows);
        }
    }

    /// Factors the system at the configuration last evaluated.
    pub fn factor(&mut self) {
        self.tree.factor(&self.masses, &self.rows);
        self.loops.factor(&self.tree, &self.rows);
    }

    /// Solves for `a` and `lambda` from `b` and `g`.
    pub fn solve(&mut self) {
        self.tree.solve(&self.rows, &mut self.b, &self.g, &mut self.a, &mut self.lambda);
        self.loops.correct(&self.rows, &self.g, &mut self.a, &mut self.lambda);
    }

    /// Solves for the displacement that closes the joints' position error: J δ = −C, least in kinetic energy.
    pub fn solve_displacement(&mut self) {
        self.b.fill([0.0; 6]);
        for ((g, joint), rows) in self.g.iter_mut().zip(&self.joints).zip(&self.rows) {
            for k in 0..rows.rows {
                g[k] = -joint.value[k];
            }
        }
        self.solve();
    }

    /// Solves for the velocity change that makes J (v + δ) + Γ λ = 0: joints hold, soft rows resist.
    pub fn solve_velocity(&mut self, bodies: &[RigidBody]) {
        self.b.fill([0.0; 6]);
        for j in 0..self.joints.len() {
            for k in 0..self.rows[j].rows {
                self.g[j][k] = -self.rate(bodies, j, k);
            }
        }
        self.solve();
    }

    /// Solves for the velocity change after impulses `b`, joints held: J δ = 0.
    pub fn solve_impulse(&mut self) {
        for g in &mut self.g {
            g.fill(0.0);
        }
        self.solve();
    }

    /// J v of one row.
    pub fn rate(&self, bodies: &[RigidBody], joint: usize, row: usize) -> f64 {
        let along = |block: &Vec6, body: usize| {
            let body = &bodies[body];
            dot(block, &super::block::vec6(body.velocity, body.angular_velocity))
        };
        let (rows, link) = (&self.rows[joint], self.joints[joint].link);
        along(&rows.a[row], link.a) + link.b.map_or(0.0, |b| along(&rows.b[row], b))
    }

    /// Adds the answer `a` to the bodies' velocities.
    pub fn apply_velocity(&self, bodies: &mut [RigidBody]) {
        for (body, a) in bodies.iter_mut().zip(&self.a) {
            body.velocity += super::block::linear(a);
            body.angular_velocity += super::block::angular(a);
        }
    }

    /// Adds the answer `a` to the bodies' places.
    pub fn apply_displacement(&self, bodies: &mut [RigidBody]) {
        for (body, a) in bodies.iter_mut().zip(&self.a) {
            body.displace(super::block::linear(a), super::block::angular(a));
        }
    }

    /// Adds `s` times a row's transposed blocks to the right-hand side.
    pub fn push_impulse(&mut self, body: usize, block: &Vec6, s: f64) {
        add_scaled(&mut self.b[body], s, block);
    }

    /// Largest |C| of any held row of the last evaluation (m or rad).
    pub fn largest_error(&self) -> f64 {
        self.joints.iter().flat_map(|j| &j.value[..j.hard]).fold(0.0, |worst, c| worst.max(c.abs()))
    }

    /// Largest distance between the two points of any point constraint now, m.
    pub fn largest_gap(&self, bodies: &[RigidBody]) -> f64 {
        self.constraints.iter().fold(0.0, |worst: f64, constraint| worst.max(rows::gap(constraint, bodies)))
    }

    /// The force that a joint's length rows carried in the last solve of forces, N.
    pub fn load(&self, joint: usize) -> f64 {
        let j = &self.joints[joint];
        let mut sum = 0.0;
        for k in (0..j.hard).filter(|k| j.lengths >> k & 1 == 1) {
            sum += self.lambda[joint][k] * self.lambda[joint][k];
        }
        sum.sqrt()
    }

    /// World arms from each joint's bodies to its first point constraint, for stiffness estimates, m.
    pub fn arms(&self, joint: usize, bodies: &[RigidBody]) -> (DVec3, DVec3) {
        let link = self.joints[joint].link;
        for &index in &self.joints[joint].constraints {
            if let super::ConstraintKind::PointToPoint { a, b } = &self.constraints[index].kind {
                let (mine, other) = if a.body == Some(link.a) { (a, b) } else { (b, a) };
                let arm = |anchor: &super::Anchor| anchor.body.map_or(DVec3::ZERO, |i| bodies[i].arm(anchor.point));
                return (arm(mine), arm(other));
            }
        }
        (DVec3::ZERO, DVec3::ZERO)
    }
}

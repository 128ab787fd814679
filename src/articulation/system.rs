//! The articulated figure: joints, their rows, and one factor that all solves share.
//!
//! Used in this order: [`System::evaluate`] at a configuration, [`System::factor`], then any number of solves:
//! accelerations, displacements, velocity changes, responses to a unit impulse.

mod closing;

use std::collections::BTreeMap;

use fearless_simd::Level;

use super::activity::Activity;
use super::block::{MAX_ROWS, RowSquare, RowVec, Vec6, add_scaled, angular, dot, linear, vec6};
use super::dense::Dense;
use super::hung::Hung;
use super::loops::{LoopRow, Loops};
use super::quads::Quads;
use super::rows::coupling::{self, Gauge};
use super::rows::{Row, Scene, friction, orientation, plane, point};
use super::spatial::{matrix, response};
use super::tree::{Form, JointRows, Link, Tree};
use super::{Constraint, ConstraintKind};
use crate::bodies::RigidBody;
use crate::math::{DMat3, DVec3};

/// Joints farther apart than this are drawn together by the stabiliser, not snapped by projection, m or rad.
pub(super) const PROJECTION_REACH: f64 = 1e-4;

/// Most held rows of a pair of bodies, twice over; three of friction may come after them.
const HELD: usize = MAX_ROWS - 3;

/// Which linear solver finds the multipliers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Method {
    /// The tree factor, linear in the number of bodies.
    #[default]
    Sparse,
    /// One dense matrix of all rows: the reference.
    Dense,
}

/// All constraints between one pair of bodies.
#[derive(Clone, Debug)]
pub struct Joint {
    /// The pair.
    pub link: Link,
    /// Indices of its constraints.
    pub constraints: Vec<usize>,
    /// Where its numbers begin in `g`, `lambda` and the other lists of rows.
    pub at: usize,
    /// Most rows that it can have.
    capacity: usize,
    /// Rows at the last evaluation, friction included.
    pub rows: usize,
    /// Of those, rows that are held.
    pub hard: usize,
    /// Where it is one point: that point from the two bodies' centres of mass in their node axes (in the world for
    /// the world), m.
    point: Option<(DVec3, DVec3)>,
    /// World arms of the two bodies where it is one point, hard, at the last evaluation; the tree has those of `hangs`.
    arms: Option<(DVec3, DVec3)>,
    /// The body that hangs by it, where it is always one point.
    hangs: Option<usize>,
    /// Its block rows, where it is ever more than a point.
    block: Option<usize>,
    /// First of its rows among the loops', where it closes one (or the solver is dense).
    outside: Option<usize>,
}

/// A constraint that couples turns and ways.
#[derive(Clone, Debug)]
struct Coupling {
    constraint: usize,
    at: usize,
    terms: Vec<(Gauge, f64)>,
    /// Index among the loops' rows.
    outside: usize,
}

/// Numbers of a row beside its blocks.
#[derive(Clone, Copy, Debug, Default)]
pub struct RowState {
    /// C, m or rad.
    pub value: f64,
    /// ḟ.
    feed: f64,
    /// J̇ẋ − f̈.
    pub(super) bias: f64,
    /// Is C a length?
    length: bool,
    /// Constraint that it belongs to.
    pub(super) constraint: usize,
    /// Share of the force that would hold it.
    pub(super) share: f64,
    /// Is it drawn together by the stabiliser: far from closed, or held in part only?
    gathers: bool,
}

/// Joints, rows and factor of an articulated figure. Nothing here allocates after [`System::new`].
#[derive(Clone, Debug)]
pub struct System {
    constraints: Vec<Constraint>,
    /// Is any row being drawn together?
    gathering: bool,
    /// What acts now.
    pub activity: Activity,
    joints: Vec<Joint>,
    /// Joints that are not always one point by which a body hangs.
    various: Vec<usize>,
    couplings: Vec<Coupling>,
    blocks: Vec<JointRows>,
    states: Vec<RowState>,
    tree: Tree,
    hung: Hung,
    /// Do the rows' numbers hold the values of the last evaluation?
    told: bool,
    loops: Loops,
    dense: Option<Dense>,
    quads: Quads,
    /// Rotation matrices, where a row asks for them.
    frames: Vec<DMat3>,
    driven: Vec<bool>,
    /// Right-hand side per body: force (N, N m) or impulse; used up by a solve.
    pub b: Vec<Vec6>,
    /// Wanted J a per row.
    pub g: Vec<f64>,
    /// Answer per body: acceleration, velocity change or displacement. Of driven bodies it is given.
    pub a: Vec<Vec6>,
    /// Answer per row: force or impulse.
    pub lambda: Vec<f64>,
}

impl System {
    /// The figure of `bodies` at its start, joined by `constraints`; `driven` says whose motion is given.
    pub fn new(bodies: &[RigidBody], driven: &[bool], constraints: &[Constraint], method: Method) -> Self {
        Self::at_level(Level::new(), bodies, driven, constraints, method)
    }

    /// The same for a processor of this level; what it finds does not depend on it.
    pub fn at_level(
        level: Level,
        bodies: &[RigidBody],
        driven: &[bool],
        constraints: &[Constraint],
        method: Method,
    ) -> Self {
        let (mut joints, mut count) = joints(constraints);
        let links: Vec<Link> = joints.iter().map(|joint| joint.link).collect();
        let at: Vec<usize> = joints.iter().map(|joint| joint.at).collect();
        let points: Vec<bool> = joints
            .iter()
            .map(|joint| method == Method::Sparse && joint.constraints.iter().all(|&c| is_only_point(&constraints[c])))
            .zip(&joints)
            .map(|(all, joint)| all && joint.constraints.len() == 1)
            .collect();
        let tree = Tree::new(level, driven, &links, &at, &points);
        let mut blocks = Vec::new();
        let mut outside: Vec<LoopRow> = Vec::new();
        for (index, joint) in joints.iter_mut().enumerate() {
            joint.point = lone_point(joint, constraints, bodies);
            let closes = tree.loops().contains(&index);
            if closes || method == Method::Dense {
                joint.outside = Some(outside.len());
                let parts: Vec<_> = [Some(joint.link.a), joint.link.b].into_iter().flatten().collect();
                for k in 0..joint.capacity {
                    outside.push(blank_row(joint.at + k, k, &parts));
                }
            }
            if !points[index] || closes {
                joint.block = Some(blocks.len());
                blocks.push(JointRows::default());
            }
        }
        let mut couplings = Vec::new();
        for (index, constraint) in constraints.iter().enumerate() {
            let ConstraintKind::Coupling { terms } = &constraint.kind else { continue };
            let terms: Vec<_> = terms.iter().map(|t| (Gauge::new(t.measure, bodies), t.coefficient)).collect();
            let mut parts: Vec<usize> = Vec::new();
            for body in terms.iter().flat_map(|(gauge, _)| [gauge.bodies().0, gauge.bodies().1]).flatten() {
                if !parts.contains(&body) {
                    parts.push(body);
                }
            }
            couplings.push(Coupling { constraint: index, at: count, terms, outside: outside.len() });
            outside.push(blank_row(count, 0, &parts));
            count += 1;
        }
        let (loop_rows, dense) = match method {
            Method::Sparse => (outside, None),
            Method::Dense => (Vec::new(), Some(Dense::new(outside, driven))),
        };
        let n = bodies.len();
        for &body in tree.order() {
            if let Some(joint) = tree.joint_of(body).filter(|&joint| points[joint] && !driven[body]) {
                joints[joint].hangs = Some(body);
            }
        }
        let ends = |body: usize| {
            let joint = tree.joint_of(body).map(|joint| &joints[joint]).filter(|joint| joint.hangs == Some(body))?;
            joint.point.map(|(a, b)| if joint.link.a == body { (a, b) } else { (b, a) })
        };
        let hung = Hung::new(&tree, ends);
        let various: Vec<usize> = (0..joints.len()).filter(|&joint| joints[joint].hangs.is_none()).collect();
        let asked = !(various.is_empty() && couplings.is_empty());
        let mut states = vec![RowState::default(); count];
        for joint in joints.iter_mut().filter(|joint| joint.hangs.is_some()) {
            (joint.rows, joint.hard) = (3, 3);
            for state in &mut states[joint.at..joint.at + 3] {
                (state.length, state.constraint, state.share) = (true, joint.constraints[0], 1.0);
            }
        }
        Self {
            gathering: false,
            activity: Activity::new(constraints),
            loops: Loops::new(loop_rows, &tree, driven, count),
            constraints: constraints.to_vec(),
            joints,
            couplings,
            blocks,
            states,
            quads: Quads::new(level, tree.members(), bodies),
            tree,
            hung,
            told: false,
            various,
            dense,
            frames: vec![DMat3::IDENTITY; if asked { n } else { 0 }],
            driven: driven.to_vec(),
            b: vec![[0.0; 6]; n],
            g: vec![0.0; count],
            a: vec![[0.0; 6]; n],
            lambda: vec![0.0; count],
        }
    }

    /// The constraints, in the order given.
    pub fn constraints(&self) -> &[Constraint] {
        &self.constraints
    }

    /// The joints between pairs of bodies.
    pub fn joints(&self) -> &[Joint] {
        &self.joints
    }

    /// Numbers of all rows.
    pub fn states(&self) -> &[RowState] {
        &self.states
    }

    /// Whose motion is given?
    pub fn driven(&self) -> &[bool] {
        &self.driven
    }

    /// The coupling's row at an index, if there is one.
    pub(super) fn coupling_row(&self, index: usize) -> Option<usize> {
        self.couplings.get(index).map(|coupling| coupling.at)
    }

    /// What the bodies of a row answer to it, each alone.
    pub(super) fn response(&self, row: usize) -> f64 {
        response(&self.jacobian(row), &self.driven, &self.quads)
    }

    /// The bodies by fours, as they stood at the last evaluation.
    pub fn quads(&self) -> &Quads {
        &self.quads
    }

    /// The same, to be moved before an evaluation.
    pub fn quads_mut(&mut self) -> &mut Quads {
        &mut self.quads
    }

    /// Is there any joint that looks at the bodies themselves?
    pub fn asks_bodies(&self) -> bool {
        !self.frames.is_empty()
    }

    /// Evaluates all rows and mass matrices for the bodies' state at the activity's time.
    pub fn evaluate(&mut self, bodies: &[RigidBody]) {
        self.quads.look(bodies);
        self.evaluate_quads(bodies);
        self.tell_values();
    }

    /// The same for bodies whose state the quads have. Only where [`System::asks_bodies`] are the bodies looked at.
    pub fn evaluate_quads(&mut self, bodies: &[RigidBody]) {
        self.hung.evaluate(self.quads.all(), &mut self.tree);
        self.told = false;
        for (body, frame) in self.frames.iter_mut().enumerate() {
            *frame = self.quads.frame(body);
        }
        let scene = Scene { bodies, frames: &self.frames, time: self.activity.time() };
        let outside = self.dense.as_mut().map_or(&mut self.loops.rows, |dense| &mut dense.rows);
        for &index in &self.various {
            let joint = &mut self.joints[index];
            joint.evaluate(&scene, &self.constraints, &self.activity, &mut self.blocks, &mut self.states);
            joint.write_outside(&self.blocks, outside);
        }
        for coupling in &mut self.couplings {
            let share = self.activity.share(coupling.constraint);
            let slot = &mut outside[coupling.outside];
            slot.active = share > 0.0;
            slot.compliance[0] = 0.0;
            let row = coupling::row(&scene, &coupling.terms, &mut slot.parts);
            self.states[coupling.at].set(&row, coupling.constraint, share);
        }
        // Whoever draws open joints together, or lets them yield, asks how far they are open.
        if self.gathering {
            self.tell_values();
        }
    }

    /// Adds the soft rows of pivot friction for a time `h` (s), with the loads (N) that the joints carry.
    pub fn add_friction(&mut self, bodies: &[RigidBody], loads: &[f64], h: f64) {
        let outside = self.dense.as_mut().map_or(&mut self.loops.rows, |dense| &mut dense.rows);
        for (joint, &load) in self.joints.iter_mut().zip(loads) {
            joint.add_friction(&self.constraints, bodies, load, h, &mut self.blocks, &mut self.states);
            joint.write_outside(&self.blocks, outside);
        }
    }

    /// Factors the system at the configuration last evaluated.
    pub fn factor(&mut self) {
        self.factor_rows();
        if self.activity.is_partial() {
            self.soften();
            self.factor_rows();
        }
    }

    /// Factors the rows as they are.
    fn factor_rows(&mut self) {
        if let Some(dense) = &mut self.dense {
            dense.factor(&self.quads, self.gathering);
            return;
        }
        let (joints, blocks) = (&self.joints, &self.blocks);
        self.tree.factor(self.quads.all(), |index| {
            let joint = &joints[index];
            match (joint.arms, joint.block) {
                (Some((a, b)), _) => Form::Point(a, b),
                (None, Some(block)) => Form::Rows(&blocks[block]),
                (None, None) => unreachable!("a joint is a point or has a block"),
            }
        });
        self.loops.factor(&self.tree, &self.quads, self.gathering);
    }

    /// Solves for `a` and `lambda` from `b` and `g`.
    pub fn solve(&mut self) {
        if let Some(dense) = &mut self.dense {
            dense.solve(&mut self.b, &self.g, &mut self.a, &mut self.lambda);
            return;
        }
        self.tree.sweep_up(&mut self.b, &self.g, &mut self.lambda);
        self.loops.correct(&self.tree, &mut self.b, &self.g, &self.a, &mut self.lambda);
        self.tree.sweep_down(&self.b, &self.g, &mut self.lambda, &mut self.a);
    }

    /// C of the point joints into their rows' numbers, if it is not there yet.
    fn tell_values(&mut self) {
        if !self.told {
            self.hung.tell_values(&self.tree, &mut self.states);
            self.told = true;
        }
    }

    /// Notes which rows are so far from closed that the stabiliser must draw them together; from the last evaluation.
    /// So does it rows of a share below 1. The others are closed by projection: their errors at an integrator's inner stages belong to the method.
    pub fn look_for_gaps(&mut self) {
        self.tell_values();
        self.gathering = false;
        for state in &mut self.states {
            state.gathers = state.value.abs() > PROJECTION_REACH || state.share < 1.0;
            self.gathering |= state.gathers;
        }
    }

    /// Solves for accelerations under the forces in `b`: J a = −J̇ẋ, and − ω₀² C − 2 ω₀ Ċ where rows gather. The
    /// accelerations of driven bodies stand in `a`.
    pub fn solve_acceleration(&mut self, bodies: &[RigidBody], omega0: f64) {
        if self.gathering {
            self.hung.tell_biases(&self.tree, &mut self.states);
            self.rates(bodies);
            for (g, state) in self.g.iter_mut().zip(&self.states) {
                let omega0 = self.constraints[state.constraint].stabilization_time.map_or(omega0, f64::recip);
                let drawn = if state.gathers { omega0 * (omega0 * state.value + 2.0 * *g) } else { 0.0 };
                *g = -state.bias - drawn;
            }
        } else {
            self.hung.want_still(&self.tree, &mut self.g);
            let various = self.various.iter().map(|&joint| &self.joints[joint]);
            let rows = various.flat_map(|joint| joint.at..joint.at + joint.rows);
            for row in rows.chain(self.couplings.iter().map(|coupling| coupling.at)) {
                self.g[row] = -self.states[row].bias;
            }
        }
        self.solve();
    }

    /// Solves for the displacement that closes the joints' position error: J δ = −C, least in kinetic energy.
    pub fn solve_displacement(&mut self) {
        self.tell_values();
        self.b.fill([0.0; 6]);
        self.still();
        for (g, state) in self.g.iter_mut().zip(&self.states) {
            *g = if state.gathers { 0.0 } else { -state.value };
        }
        self.solve();
    }

    /// Solves for the velocity change that makes J (v + δ) + Γ λ = ḟ: joints hold, soft rows resist. What is still
    /// being drawn together keeps its speed.
    pub fn solve_velocity(&mut self, bodies: &[RigidBody]) {
        self.quads.look(bodies);
        self.solve_velocity_quads(bodies);
    }

    /// The same for bodies whose velocities the quads have, see [`System::evaluate_quads`].
    pub fn solve_velocity_quads(&mut self, bodies: &[RigidBody]) {
        self.b.fill([0.0; 6]);
        self.still();
        self.rates(bodies);
        for (g, state) in self.g.iter_mut().zip(&self.states) {
            *g = if state.gathers { 0.0 } else { -*g };
        }
        self.solve();
    }

    /// Solves for the velocity change after impulses `b`, joints held: J δ = 0.
    pub fn solve_impulse(&mut self) {
        self.g.fill(0.0);
        self.still();
        self.solve();
    }

    /// Driven bodies do not give way.
    fn still(&mut self) {
        for (a, &driven) in self.a.iter_mut().zip(&self.driven) {
            if driven {
                *a = [0.0; 6];
            }
        }
    }

    /// Ċ of every row into `g`.
    fn rates(&mut self, bodies: &[RigidBody]) {
        let coordinates = |body: usize| vec6(bodies[body].velocity, bodies[body].angular_velocity);
        self.hung.rates(self.quads.all(), &self.tree, &mut self.g);
        for joint in self.various.iter().map(|&joint| &self.joints[joint]) {
            let at = joint.at;
            match (joint.arms, joint.block) {
                (Some((r, s)), _) => {
                    let a = &bodies[joint.link.a];
                    let mut rate = a.velocity + a.angular_velocity.cross(r);
                    if let Some(b) = joint.link.b {
                        rate -= bodies[b].velocity + bodies[b].angular_velocity.cross(s);
                    }
                    self.g[at..at + 3].copy_from_slice(&rate.to_array());
                }
                (None, Some(block)) => {
                    let rows = &self.blocks[block];
                    let a = coordinates(joint.link.a);
                    let b = joint.link.b.map(coordinates);
                    for k in 0..joint.rows {
                        let against = b.as_ref().map_or(0.0, |b| dot(&rows.b[k], b));
                        self.g[at + k] = dot(&rows.a[k], &a) + against - self.states[at + k].feed;
                    }
                }
                (None, None) => {}
            }
        }
        for coupling in &self.couplings {
            let rows = self.dense.as_ref().map_or(&self.loops.rows, |dense| &dense.rows);
            let parts = &rows[coupling.outside].parts;
            let rate: f64 = parts.iter().map(|(body, block)| dot(block, &coordinates(*body))).sum();
            self.g[coupling.at] = rate - self.states[coupling.at].feed;
        }
    }

    /// Adds the answer `a` to the bodies' velocities.
    pub fn apply_velocity(&self, bodies: &mut [RigidBody]) {
        for (body, a) in bodies.iter_mut().zip(&self.a) {
            body.velocity += linear(a);
            body.angular_velocity += angular(a);
        }
    }

    /// Adds the answer `a` to the quads' velocities.
    pub fn apply_velocity_quads(&mut self) {
        self.quads.push(&self.a);
    }

    /// Closes the joints: adds the answer of [`System::solve_displacement`] to the quads' places.
    pub fn close_quads(&mut self) {
        self.quads.displace(&self.a);
        for state in self.states.iter_mut().filter(|state| !state.gathers) {
            state.value = 0.0;
        }
    }

    /// Writes Γ = D K D among these rows of one joint or of a coupling, D diagonal.
    pub(super) fn set_compliance(&mut self, rows: &[usize], k: &RowSquare, d: &RowVec) {
        let outside = self.dense.as_mut().map_or(&mut self.loops.rows, |dense| &mut dense.rows);
        if let Some(joint) = self.joints.iter().find(|joint| (joint.at..joint.at + joint.hard).contains(&rows[0])) {
            let Some(block) = joint.block else { return };
            for (i, &row) in rows.iter().enumerate() {
                for (j, &other) in rows[..=i].iter().enumerate() {
                    self.blocks[block].compliance[row - joint.at][other - joint.at] = d[i] * d[j] * k[i][j];
                }
            }
            joint.write_outside(&self.blocks, outside);
        } else if let Some(coupling) = self.couplings.iter().find(|coupling| coupling.at == rows[0]) {
            outside[coupling.outside].compliance[0] = d[0] * d[0] * k[0][0];
        }
    }

    /// World arms of a joint that is one point now.
    fn arms_of(&self, joint: &Joint) -> Option<(DVec3, DVec3)> {
        joint.hangs.map_or(joint.arms, |body| Some(self.tree.arms(body)))
    }

    /// Rows outside the tree.
    fn outside_rows(&self) -> &[LoopRow] {
        self.dense.as_ref().map_or(&self.loops.rows, |dense| &dense.rows)
    }

    /// Adds `s` times a row's transposed blocks to the right-hand side.
    pub fn push_impulse(&mut self, body: usize, block: &Vec6, s: f64) {
        add_scaled(&mut self.b[body], s, block);
    }

    /// Counts the turns of couplings up to this state; once a step.
    pub fn count_turns(&mut self, bodies: &[RigidBody]) {
        for coupling in &mut self.couplings {
            for (gauge, _) in &mut coupling.terms {
                gauge.count(bodies);
            }
        }
    }

    /// The joint that a row belongs to.
    fn joint_of(&self, row: usize) -> Option<&Joint> {
        self.joints.iter().find(|joint| (joint.at..joint.at + joint.rows).contains(&row))
    }

    /// J of one row as blocks of the bodies it touches (for tests and reports).
    pub fn jacobian(&self, row: usize) -> Vec<(usize, Vec6)> {
        if let Some(joint) = self.joint_of(row) {
            let k = row - joint.at;
            let (a, b) = match (self.arms_of(joint), joint.block) {
                (Some((r, s)), _) => {
                    let e = DVec3::AXES[k];
                    (vec6(e, r.cross(e)), vec6(-e, -s.cross(e)))
                }
                (None, Some(block)) => (self.blocks[block].a[k], self.blocks[block].b[k]),
                (None, None) => return Vec::new(),
            };
            return [Some((joint.link.a, a)), joint.link.b.map(|body| (body, b))].into_iter().flatten().collect();
        }
        let coupling = self.couplings.iter().find(|coupling| coupling.at == row);
        coupling.map_or(Vec::new(), |coupling| self.outside_rows()[coupling.outside].parts.clone())
    }

    /// Γ between two rows at the last factorisation.
    pub fn compliance(&self, row: usize, other: usize) -> f64 {
        let (low, high) = (row.min(other), row.max(other));
        if let Some(joint) = self.joints.iter().find(|joint| (joint.at..joint.at + joint.rows).contains(&low)) {
            let inside = high < joint.at + joint.rows && joint.arms.is_none();
            let block = joint.block.filter(|_| inside);
            return block.map_or(0.0, |block| self.blocks[block].compliance[high - joint.at][low - joint.at]);
        }
        let coupling = self.couplings.iter().find(|coupling| coupling.at == row && row == other);
        coupling.map_or(0.0, |coupling| self.outside_rows()[coupling.outside].compliance[0])
    }

    /// Rows that act now, as indices into `g` and `lambda`.
    pub fn acting_rows(&self) -> Vec<usize> {
        let mut rows: Vec<usize> = self.joints.iter().flat_map(|joint| joint.at..joint.at + joint.rows).collect();
        rows.extend(self.couplings.iter().filter(|c| self.activity.share(c.constraint) > 0.0).map(|c| c.at));
        rows
    }

    /// Rows found to repeat others at the last factorisation: (constraint, row's index).
    pub fn redundant_rows(&self) -> Vec<(usize, usize)> {
        let mut out = Vec::new();
        let outside = |index: usize| match &self.dense {
            Some(dense) => dense.is_redundant(index),
            None => self.loops.is_redundant(index),
        };
        let mut child_of = vec![None; self.joints.len()];
        for &body in self.tree.order() {
            if let Some(joint) = self.tree.joint_of(body) {
                child_of[joint] = Some(body);
            }
        }
        for (index, joint) in self.joints.iter().enumerate() {
            for k in 0..joint.rows {
                let repeats = match (joint.outside, child_of[index]) {
                    (Some(first), _) => outside(first + k),
                    (None, Some(body)) => self.tree.redundant(body) >> k & 1 == 1,
                    (None, None) => false,
                };
                if repeats {
                    out.push((self.states[joint.at + k].constraint, joint.at + k));
                }
            }
        }
        for coupling in self.couplings.iter().filter(|coupling| outside(coupling.outside)) {
            out.push((coupling.constraint, coupling.at));
        }
        out
    }

    /// Largest |C| of any held row of the last evaluation (m or rad).
    pub fn largest_error(&self) -> f64 {
        let joints = self.joints.iter().flat_map(|joint| &self.states[joint.at..joint.at + joint.hard]);
        joints.fold(0.0, |worst, state| worst.max(state.value.abs()))
    }

    /// Largest error of any length that is held, at these bodies' state, m: gaps of points, heights over planes,
    /// slips of couplings.
    pub fn largest_gap(&self, bodies: &[RigidBody]) -> f64 {
        let frames: Vec<DMat3> = bodies.iter().map(|body| matrix(body.rotation)).collect();
        let scene = Scene { bodies, frames: &frames, time: self.activity.time() };
        let mut worst: f64 = 0.0;
        for (index, constraint) in self.constraints.iter().enumerate() {
            if self.activity.share(index) < 1.0 || self.activity.mends(index) {
                continue;
            }
            worst = worst.max(match &constraint.kind {
                ConstraintKind::PointToPoint { a, b } => scene.point(a).position.distance(scene.point(b).position),
                ConstraintKind::PointOnPlane { point, plane, normal, offset } => {
                    plane::row(&scene, point, plane, *normal, offset).value.abs()
                }
                ConstraintKind::Orientation { .. } | ConstraintKind::Coupling { .. } => 0.0,
            });
        }
        for coupling in self.couplings.iter().filter(|c| self.activity.share(c.constraint) == 1.0) {
            let mut parts = self.outside_rows()[coupling.outside].parts.clone();
            worst = worst.max(coupling::row(&scene, &coupling.terms, &mut parts).value.abs());
        }
        worst
    }

    /// The force that a joint's length rows carried in the last solve of forces, N.
    pub fn load(&self, joint: usize) -> f64 {
        let j = &self.joints[joint];
        if j.hangs.is_some() {
            return linear_length(&self.lambda[j.at..j.at + 3]);
        }
        let mut sum = 0.0;
        for row in (j.at..j.at + j.hard).filter(|&row| self.states[row].length) {
            sum += self.lambda[row] * self.lambda[row];
        }
        sum.sqrt()
    }

    /// World arms from a joint's bodies to its point at the last evaluation, for stiffness estimates, m.
    pub fn arms(&self, joint: usize) -> (DVec3, DVec3) {
        let joint = &self.joints[joint];
        if let Some(arms) = self.arms_of(joint) {
            return arms;
        }
        // The arm of a length row (e, r × e) is at least |r × e|: three rows of a point give r.
        let Some(block) = joint.block else { return (DVec3::ZERO, DVec3::ZERO) };
        let rows = &self.blocks[block];
        let longest = |blocks: &[Vec6]| {
            let mut best = DVec3::ZERO;
            for k in (0..joint.hard).filter(|&k| self.states[joint.at + k].length) {
                let arm = linear(&blocks[k]).cross(angular(&blocks[k]));
                if arm.length_squared() > best.length_squared() {
                    best = arm;
                }
            }
            best
        };
        (longest(&rows.a), longest(&rows.b))
    }

    /// Is a constraint closed, or so nearly that projection keeps it so?
    pub fn is_together(&self, constraint: usize) -> bool {
        let apart = |state: &RowState| state.constraint == constraint && state.gathers;
        let held = self.joints.iter().flat_map(|joint| &self.states[joint.at..joint.at + joint.hard]);
        !held.chain(self.couplings.iter().map(|c| &self.states[c.at])).any(apart)
    }

    /// What a constraint carried in the last solve: of its lengths, of its angles. The stabiliser's pull on what is far
    /// apart is no load.
    pub fn carried(&self, constraint: usize) -> (f64, f64) {
        let (mut force, mut torque) = (0.0, 0.0);
        let joints = self.joints.iter().filter(|joint| joint.constraints.contains(&constraint));
        let rows = joints.flat_map(|joint| joint.at..joint.at + joint.hard);
        let couplings = self.couplings.iter().filter(|c| c.constraint == constraint).map(|c| c.at);
        let couplings = couplings.filter(|_| self.activity.share(constraint) > 0.0);
        let own = |&row: &usize| {
            let state = &self.states[row];
            state.constraint == constraint && state.value.abs() <= PROJECTION_REACH
        };
        for row in rows.chain(couplings).filter(own) {
            let square = self.lambda[row] * self.lambda[row];
            if self.states[row].length { force += square } else { torque += square }
        }
        (force.sqrt(), torque.sqrt())
    }
}

impl RowState {
    /// Takes over a row's numbers.
    fn set(&mut self, row: &Row, constraint: usize, share: f64) {
        let gathers = self.gathers;
        let Row { value, feed, bias, length, .. } = *row;
        *self = Self { value, feed, bias, length, constraint, share, gathers };
    }
}

impl Joint {
    /// Fills this joint's rows for the scene.
    fn evaluate(
        &mut self,
        scene: &Scene,
        constraints: &[Constraint],
        activity: &Activity,
        blocks: &mut [JointRows],
        states: &mut [RowState],
    ) {
        self.arms = None;
        if let (Some((p, q)), None) = (self.point, self.outside)
            && activity.share(self.constraints[0]) == 1.0
        {
            let a = &scene.bodies[self.link.a];
            let r = scene.frames[self.link.a] * p;
            let turn = a.angular_velocity.cross(r);
            let (mut c, mut bias) = (a.position + r, a.angular_velocity.cross(turn));
            let mut s = DVec3::ZERO;
            if let Some(index) = self.link.b {
                let b = &scene.bodies[index];
                s = scene.frames[index] * q;
                c -= b.position + s;
                bias -= b.angular_velocity.cross(b.angular_velocity.cross(s));
            } else {
                c -= q;
            }
            for k in 0..3 {
                let state = &mut states[self.at + k];
                (state.value, state.feed, state.bias) = (c[k], 0.0, bias[k]);
                (state.length, state.constraint, state.share) = (true, self.constraints[0], 1.0);
            }
            (self.rows, self.hard) = (3, 3);
            self.arms = Some((r, s));
            return;
        }
        let Some(block) = self.block else { return };
        let rows = &mut blocks[block];
        rows.rows = 0;
        for i in 0..self.constraints.len() {
            let index = self.constraints[i];
            let share = activity.share(index);
            if share <= 0.0 {
                continue;
            }
            let constraint = &constraints[index];
            let own = constraint.link().is_some_and(|(a, _)| a == Some(self.link.a));
            let mut push = |row: Row| {
                let k = rows.rows;
                if k == HELD {
                    // Six rows hold all there is to hold: more can only repeat.
                    return;
                }
                (rows.a[k], rows.b[k]) = if own { (row.a, row.b) } else { (row.b, row.a) };
                rows.compliance[k] = [0.0; MAX_ROWS];
                states[self.at + k].set(&row, index, share);
                rows.rows = k + 1;
            };
            match &constraint.kind {
                ConstraintKind::PointToPoint { a, b } => point::rows(scene, a, b).into_iter().for_each(&mut push),
                ConstraintKind::PointOnPlane { point, plane, normal, offset } => {
                    push(plane::row(scene, point, plane, *normal, offset));
                }
                ConstraintKind::Orientation { a, b, angle } => {
                    let others = || self.constraints.iter().filter(|&&c| c != index && activity.share(c) > 0.0);
                    let held = || others().find_map(|&c| orientation_axis(scene, &constraints[c]));
                    push(orientation::row(scene, a, b, angle, held));
                }
                ConstraintKind::Coupling { .. } => {}
            }
        }
        (self.rows, self.hard) = (rows.rows, rows.rows);
    }

    /// Adds friction rows after the hard ones.
    fn add_friction(
        &mut self,
        constraints: &[Constraint],
        bodies: &[RigidBody],
        load: f64,
        h: f64,
        blocks: &mut [JointRows],
        states: &mut [RowState],
    ) {
        let Some(block) = self.block else { return };
        if !self.constraints.iter().any(|&index| constraints[index].friction.is_some()) {
            return;
        }
        let rows = &mut blocks[block];
        if let Some((r, s)) = self.arms.take() {
            rows.rows = 3;
            for (k, e) in DVec3::AXES.into_iter().enumerate() {
                (rows.a[k], rows.b[k]) = (vec6(e, r.cross(e)), vec6(-e, -s.cross(e)));
                rows.compliance[k] = [0.0; MAX_ROWS];
            }
        }
        let spin = |body: Option<usize>| body.map_or(DVec3::ZERO, |b| bodies[b].angular_velocity);
        let rate = (spin(Some(self.link.a)) - spin(self.link.b)).length();
        for &index in &self.constraints {
            let Some(pivot) = constraints[index].friction else { continue };
            for row in friction::rows() {
                let k = rows.rows;
                if k == self.capacity {
                    break;
                }
                (rows.a[k], rows.b[k]) = (row.a, row.b);
                rows.compliance[k] = [0.0; MAX_ROWS];
                rows.compliance[k][k] = friction::compliance(pivot.coefficient * load * pivot.radius, rate, h);
                // It holds no place, and where it stands another row may have stood before.
                states[self.at + k] = RowState { constraint: index, share: 1.0, ..RowState::default() };
                rows.rows = k + 1;
            }
        }
        self.rows = rows.rows;
    }

    /// Copies the rows to where the loops' (or the dense) solver reads them.
    fn write_outside(&self, blocks: &[JointRows], outside: &mut [LoopRow]) {
        let (Some(block), Some(first)) = (self.block, self.outside) else { return };
        let rows = &blocks[block];
        for (k, row) in outside[first..first + self.capacity].iter_mut().enumerate() {
            row.active = k < rows.rows;
            row.parts[0].1 = rows.a[k];
            if let Some(second) = row.parts.get_mut(1) {
                second.1 = rows.b[k];
            }
            row.compliance = rows.compliance[k];
        }
    }
}

/// Groups constraints by the pair of bodies they connect; also how many numbers their rows need.
fn joints(constraints: &[Constraint]) -> (Vec<Joint>, usize) {
    let mut joints: Vec<Joint> = Vec::new();
    let mut of_pair: BTreeMap<(usize, Option<usize>), usize> = BTreeMap::new();
    for (index, constraint) in constraints.iter().enumerate() {
        let link = match constraint.link() {
            Some((Some(a), b)) => Link { a, b },
            Some((None, Some(b))) => Link { a: b, b: None },
            _ => continue,
        };
        let turned = link.b.map(|b| (b, Some(link.a)));
        let known = of_pair.get(&(link.a, link.b)).or_else(|| turned.and_then(|pair| of_pair.get(&pair)));
        if let Some(&joint) = known {
            joints[joint].constraints.push(index);
        } else {
            of_pair.insert((link.a, link.b), joints.len());
            joints.push(Joint {
                link,
                constraints: vec![index],
                at: 0,
                capacity: 0,
                rows: 0,
                hard: 0,
                point: None,
                arms: None,
                hangs: None,
                block: None,
                outside: None,
            });
        }
    }
    let mut at = 0;
    for joint in &mut joints {
        joint.at = at;
        joint.capacity = capacity(joint, constraints);
        at += joint.capacity;
    }
    (joints, at)
}

/// The axis about which an orientation holds its bodies.
fn orientation_axis(scene: &Scene, constraint: &Constraint) -> Option<DVec3> {
    match &constraint.kind {
        ConstraintKind::Orientation { a, b, .. } => orientation::axis(scene, a, b),
        _ => None,
    }
}

/// Both ends of a joint that is one point, as [`Joint::point`] has them.
fn lone_point(joint: &Joint, constraints: &[Constraint], bodies: &[RigidBody]) -> Option<(DVec3, DVec3)> {
    let [index] = joint.constraints[..] else { return None };
    let ConstraintKind::PointToPoint { a, b } = &constraints[index].kind else { return None };
    let local =
        |anchor: &super::Anchor| anchor.point - anchor.body.map_or(DVec3::ZERO, |i| bodies[i].properties.center);
    let own = a.body == Some(joint.link.a);
    Some(if own { (local(a), local(b)) } else { (local(b), local(a)) })
}

/// Most rows that a joint can have at once.
fn capacity(joint: &Joint, constraints: &[Constraint]) -> usize {
    let each = |&index: &usize| constraints[index].row_count() + 3 * usize::from(constraints[index].friction.is_some());
    joint.constraints.iter().map(each).sum::<usize>().min(MAX_ROWS)
}

/// |v|.
fn linear_length(v: &[f64]) -> f64 {
    v.iter().fold(0.0, |sum, x| sum + x * x).sqrt()
}

/// Is it a point at all times, and nothing more?
fn is_only_point(constraint: &Constraint) -> bool {
    matches!(constraint.kind, ConstraintKind::PointToPoint { .. })
        && constraint.schedule.is_always()
        && constraint.breaking.is_none()
        && constraint.friction.is_none()
}

fn blank_row(at: usize, place: usize, bodies: &[usize]) -> LoopRow {
    let parts = bodies.iter().map(|&body| (body, [0.0; 6])).collect();
    LoopRow { at, active: false, parts, place, compliance: [0.0; MAX_ROWS] }
}

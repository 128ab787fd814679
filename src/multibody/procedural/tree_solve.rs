//! Newton's method on joint positions with the articulated-body factor (`articulation::tree`): closes all joints at
//! once, O(n) a pass.
//!
//! The update leaves the bodies at x* with joint errors C. A pass applies the displacement that closes the joints to
//! first order and is of least kinetic energy,
//!
//! ```text
//! min ½ δ·M δ      J δ = C* − C(x)        x ← x ⊕ δ
//! ```
//!
//! Two or three passes suffice, as each squares the remaining rotation. A factor is reused while no body has rotated
//! by more than [`FACTOR_REUSE_ROTATION`]: later passes reduce the error by about that rotation, at half the cost.
//! Grabs are extra rows beside the tree. With H the tree's system, δ₀ the displacement that closes the joints alone
//! and G the rows of all grabs (grabbed point = target),
//!
//! ```text
//! (G H⁻¹ Gᵀ + γ diag(G H⁻¹ Gᵀ)) μ = w − G δ₀        H δ = b₀ + Gᵀ μ
//! ```
//!
//! G H⁻¹ Gᵀ involves only the bodies on the paths from the grabs to their roots, three sweeps a grab.
//!
//! γ is small and not zero, since a chain stretched towards an unreachable target has no response along itself.
//! Violated limits are such rows too, but unilateral: a row whose μ would pull is removed and the others are solved
//! again. A pass rotates no body by more than [`MAX_ROTATION`]. The last passes close joints and limits alone, so
//! that they hold and an unreachable grab misses.

use super::grab::{GrabTarget, MAX_GRABS, POSITION_TOLERANCE, SolveReport};
use super::lane_kernels::LaneKernels;
use super::relaxation::largest_grab_error;
use crate::articulation::{Cholesky, System};
use crate::dynamics::{Contacts, MAX_ROW_BODIES, PositionStep};
use soffio_geometry::bodies::RigidBody;
use soffio_math::DVec3;
use soffio_math::spatial::{Vec6, dot, vec6};

/// Most passes with grabs.
pub const MAX_GRAB_PASSES: u32 = 24;
/// Most passes after them, of joints and limits alone.
pub const MAX_FREE_PASSES: usize = 6;
/// Passes after which the largest grab error must have shrunk to [`STALL_RATIO`] of its former value.
const STALL_PASSES: u32 = 3;
const STALL_RATIO: f64 = 0.9;
/// Rotation of a body up to which a factor is reused, rad; and only while the error shrinks to [`FACTOR_REUSE_RATIO`]
/// a pass.
const FACTOR_REUSE_ROTATION: f64 = 0.01;
const FACTOR_REUSE_RATIO: f64 = 0.1;
/// Largest rotation of a body in one pass, rad.
const MAX_ROTATION: f64 = 0.7;
/// Distance from a limit below which it takes part, m or rad.
const LIMIT_MARGIN: f64 = 1e-9;
/// γ, relative softness of the extra rows.
const SOFTNESS: f64 = 1e-4;
/// Error of a row at which Newton's passes end, m or rad: a joint of several rows is then within [`POSITION_TOLERANCE`].
const CLOSED: f64 = 0.3 * POSITION_TOLERANCE;
/// Rows of a grab, and most extra rows.
const GRAB_ROWS: usize = 3;
const MAX_EXTRA_ROWS: usize = GRAB_ROWS * MAX_GRABS + 12;

/// Newton solver of joint positions.
#[derive(Clone, Debug)]
pub(super) struct TreeSolve {
    /// Target error of each row, m or rad.
    pub targets: Vec<f64>,
    /// G H⁻¹ Gᵀ, lower triangle.
    grab_response: Box<[[f64; MAX_EXTRA_ROWS]; MAX_EXTRA_ROWS]>,
    /// w − G δ₀.
    shortfall: [f64; MAX_EXTRA_ROWS],
    grab_factor: Cholesky,
    /// Bodies on the paths from grabs and limits to their roots, and a flag a body.
    root_paths: Vec<usize>,
    on_path: Vec<bool>,
    /// Extra rows beside the tree.
    rows: Vec<ExtraRow>,
}

/// An extra row: its blocks, its wanted change, whether it is a limit, whether it is on.
#[derive(Clone, Copy, Debug)]
struct ExtraRow {
    ends: [Option<(usize, Vec6)>; MAX_ROW_BODIES],
    distance: f64,
    limit: bool,
    on: bool,
}

impl ExtraRow {
    fn along(&self, a: &[Vec6]) -> f64 {
        self.ends.iter().flatten().map(|(body, block)| dot(block, &a[*body])).sum()
    }
}

impl TreeSolve {
    /// Room for the joints of a system with so many bodies.
    pub fn new(system: &System, bodies: usize) -> Self {
        Self {
            targets: vec![0.0; system.states().len()],
            grab_response: Box::new([[0.0; MAX_EXTRA_ROWS]; MAX_EXTRA_ROWS]),
            shortfall: [0.0; MAX_EXTRA_ROWS],
            grab_factor: Cholesky::with_room(MAX_EXTRA_ROWS, 0.0),
            root_paths: Vec::with_capacity(bodies),
            on_path: vec![false; bodies],
            rows: Vec::with_capacity(MAX_EXTRA_ROWS),
        }
    }

    /// Closes the joints from the lane blocks' state. Errors that remain come from displacements too long for
    /// linearisation.
    pub fn adjust(&mut self, step: &mut PositionStep, grabs: &[GrabTarget], lane_kernels: &LaneKernels) -> SolveReport {
        let (bodies, system, contacts) = (&mut *step.bodies, &mut *step.system, &*step.contacts);
        let mut report = SolveReport::default();
        let mut before = f64::INFINITY;
        let mut following_grabs = !grabs.is_empty();
        let mut free_passes = 0;
        // Rotation since the factor was made, and the error then.
        let (mut rotated, mut open) = (f64::INFINITY, f64::INFINITY);
        system.evaluate_lane_blocks(bodies);
        system.include_open_rows();
        loop {
            report.residual = system.largest_residual(&self.targets);
            report.beyond = contacts.largest_violation(bodies);
            report.grab_error = largest_grab_error(grabs, bodies);
            // A grab that makes no progress is out of reach: from then on the joints take precedence.
            if following_grabs && report.passes % STALL_PASSES == 0 {
                following_grabs = report.grab_error <= POSITION_TOLERANCE.max(STALL_RATIO * before)
                    && report.passes < MAX_GRAB_PASSES;
                before = report.grab_error;
            }
            let open_now = report.residual.max(report.beyond);
            let worst = open_now.max(if following_grabs { report.grab_error } else { 0.0 });
            if open_now <= CLOSED && (!following_grabs || report.grab_error <= POSITION_TOLERANCE)
                || free_passes == MAX_FREE_PASSES
            {
                return report;
            }
            free_passes += usize::from(!following_grabs);
            report.passes += 1;
            if rotated > FACTOR_REUSE_ROTATION || worst > FACTOR_REUSE_RATIO * open {
                system.factor();
                rotated = 0.0;
            }
            open = worst;
            system.solve_closing(&self.targets);
            self.collect_rows(contacts, bodies, if following_grabs { grabs } else { &[] });
            if !self.rows.is_empty() {
                self.solve_with_rows(system);
            }
            let rotation = largest_rotation(&system.a);
            let fraction = if rotation > MAX_ROTATION { MAX_ROTATION / rotation } else { 1.0 };
            rotated += fraction * rotation;
            lane_kernels.displace(system, bodies, fraction);
            system.evaluate_lane_blocks(bodies);
        }
    }

    /// Collects the extra rows: of these grabs, and of violated limits.
    fn collect_rows(&mut self, contacts: &Contacts, bodies: &[RigidBody], grabs: &[GrabTarget]) {
        self.rows.clear();
        for grab in grabs {
            let at = grab.world_point(bodies);
            let (arm, distance) = (at - bodies[grab.body].position, grab.target - at);
            for (axis, distance) in DVec3::AXES.into_iter().zip(distance.to_array()) {
                let ends = [Some((grab.body, vec6(axis, arm.cross(axis)))), None, None];
                self.rows.push(ExtraRow { ends, distance, limit: false, on: true });
            }
        }
        for bound in 0..contacts.bound_count() {
            if self.rows.len() < MAX_EXTRA_ROWS && contacts.bound_gap(bound, bodies) < LIMIT_MARGIN {
                let (gap, ends) = contacts.bound(bound, bodies);
                self.rows.push(ExtraRow { ends, distance: -gap, limit: true, on: true });
            }
        }
    }

    /// Solves again with the extra rows.
    fn solve_with_rows(&mut self, system: &mut System) {
        let touched = self.rows.iter().flat_map(|row| row.ends.iter().flatten().map(|(body, _)| *body));
        system.root_paths(touched, &mut self.on_path, &mut self.root_paths);
        for (shortfall, row) in self.shortfall.iter_mut().zip(&self.rows) {
            *shortfall = row.distance - row.along(&system.a);
        }
        for (l, row) in self.rows.iter().enumerate() {
            system.respond(&self.root_paths, row.ends.iter().flatten().copied());
            for (k, other) in self.rows.iter().enumerate().skip(l) {
                self.grab_response[k][l] = other.along(&system.a);
            }
        }
        let mut mu = [0.0; MAX_EXTRA_ROWS];
        // Each iteration removes at least one limit.
        for _ in 0..=self.rows.len() {
            self.solve_multipliers(&mut mu);
            let mut pulls = false;
            for (row, mu) in self.rows.iter_mut().zip(&mut mu) {
                if row.on && row.limit && *mu < 0.0 {
                    (row.on, pulls) = (false, true);
                }
            }
            if !pulls {
                break;
            }
        }
        system.b.fill([0.0; 6]);
        for (row, mu) in self.rows.iter().zip(mu).filter(|(row, _)| row.on) {
            for (body, block) in row.ends.iter().flatten() {
                system.push_impulse(*body, block, mu);
            }
        }
        system.solve_closing_under(&self.targets);
    }

    /// Solves for μ of the rows that are on.
    fn solve_multipliers(&mut self, mu: &mut [f64; MAX_EXTRA_ROWS]) {
        let mut on = [0; MAX_EXTRA_ROWS];
        let mut n = 0;
        for (index, _) in self.rows.iter().enumerate().filter(|(_, row)| row.on) {
            on[n] = index;
            n += 1;
        }
        let on = &on[..n];
        self.grab_factor.begin(n);
        let mut right = [0.0; MAX_EXTRA_ROWS];
        for (k, &row) in on.iter().enumerate() {
            for (l, &column) in on[..=k].iter().enumerate() {
                *self.grab_factor.entry(k, l) = self.grab_response[row][column];
            }
            let own = self.softening_scale(row);
            *self.grab_factor.entry(k, k) += SOFTNESS * own;
            self.grab_factor.measure(k, own);
            right[k] = self.shortfall[row];
        }
        self.grab_factor.factor();
        self.grab_factor.solve(&mut right[..n]);
        mu.fill(0.0);
        for (&row, multiplier) in on.iter().zip(right) {
            mu[row] = multiplier;
        }
    }

    /// Scale of a row's softness. The three rows of a grab share one, or the nearest reachable point would depend on
    /// the axes.
    fn softening_scale(&self, row: usize) -> f64 {
        if self.rows[row].limit {
            return self.grab_response[row][row];
        }
        let first = row - row % GRAB_ROWS;
        (first..first + GRAB_ROWS).map(|row| self.grab_response[row][row]).sum::<f64>() / GRAB_ROWS as f64
    }
}

/// Largest rotation of a displacement, rad.
fn largest_rotation(a: &[Vec6]) -> f64 {
    let square = |delta: &Vec6| delta[3] * delta[3] + delta[4] * delta[4] + delta[5] * delta[5];
    a.iter().fold(0.0, |most: f64, delta| most.max(square(delta))).sqrt()
}

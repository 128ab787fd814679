//! Solves of the constraint system: accelerations, displacements, velocity changes.

use fearless_simd::dispatch;

use super::System;
use crate::articulation::ball_elimination::JointTarget;
use crate::articulation::trains::SolveKind;
use soffio_geometry::bodies::RigidBody;
use soffio_math::spatial::{angular, dot, linear, vec6};

impl System {
    /// Solves for `a` and `lambda` from `b` and `g`.
    pub fn solve(&mut self) {
        self.factor.ball_joints.set_targets(&mut self.factor.tree, &self.g);
        self.solve_for(JointTarget::Given);
        self.copy_ball_joint_multipliers();
    }

    /// Copies the multipliers of ball joints of the last solve into `lambda`.
    pub fn copy_ball_joint_multipliers(&mut self) {
        self.factor.ball_joints.write_forces(&self.factor.tree, &mut self.lambda);
    }

    /// Solves without copying the ball joints' multipliers; `wanted` is their target. While rows are being
    /// stabilised, all targets are in `g`.
    fn solve_as(&mut self, wanted: JointTarget) {
        if self.rows.stabilising { self.solve() } else { self.solve_for(wanted) }
    }

    fn solve_for(&mut self, wanted: JointTarget) {
        let Self { factor, lane_blocks, sleep_state, b, g, a, lambda, .. } = self;
        dispatch!(lane_blocks.level(), simd => factor.solve(simd, lane_blocks, (b, g, wanted), (a, lambda)));
        for &body in &sleep_state.tree_bodies {
            a[body] = [0.0; 6];
        }
        factor.solve_kind = SolveKind::Impulse;
    }

    /// Marks the rows that stabilisation must close: those far from closed at the last evaluation, and partially
    /// active ones. The others are closed by projection: their errors at an integrator's inner stages belong to the
    /// method.
    pub fn classify_rows(&mut self) {
        self.rows.classify_rows(&self.factor);
    }

    /// Solves for accelerations under the forces in `b`: J a = −J̇ẋ, with Baumgarte terms − ω₀² C − 2 ω₀ Ċ for
    /// stabilised rows; `omega0` is ω₀, 1/s. The accelerations of kinematic bodies are in `a`.
    pub fn solve_acceleration(&mut self, bodies: &[RigidBody], omega0: f64) {
        self.factor.solve_kind = SolveKind::Acceleration;
        if self.rows.stabilising {
            self.factor.ball_joints.write_biases(&self.factor.tree, &mut self.rows.states);
            self.rates(bodies);
            for (g, state) in self.g.iter_mut().zip(&self.rows.states) {
                let omega0 = self.rows.constraints[state.constraint].stabilization_time.map_or(omega0, f64::recip);
                let drawn = if state.stabilised { omega0 * (omega0 * state.value + 2.0 * *g) } else { 0.0 };
                *g = -state.bias - drawn;
            }
        } else {
            let general_joints =
                self.rows.general_joints[..self.rows.outside_trains].iter().map(|&joint| &self.rows.joints[joint]);
            let rows = general_joints.flat_map(|joint| joint.at..joint.at + joint.rows);
            for row in rows.chain(self.rows.couplings.iter().map(|coupling| coupling.at)) {
                self.g[row] = -self.rows.states[row].bias;
            }
        }
        self.solve_as(JointTarget::ZeroAcceleration);
    }

    /// Solves for the displacement that closes the position errors: J δ = −C, of least kinetic energy.
    pub fn solve_displacement(&mut self) {
        self.factor.solve_kind = SolveKind::Place;
        if self.rows.stabilising {
            self.rows.write_values(&self.factor);
        }
        self.b.fill([0.0; 6]);
        self.hold_kinematic();
        for rows in self.rows.right_hand_rows() {
            for (g, state) in self.g[rows.clone()].iter_mut().zip(&self.rows.states[rows.clone()]) {
                *g = if state.stabilised { 0.0 } else { -state.value };
            }
        }
        self.solve_as(JointTarget::ClosePosition);
    }

    /// Solves for the velocity change with J (v + δ) + Γ λ = ḟ: hard rows hold, soft rows resist. Stabilised rows
    /// keep their speed.
    pub fn solve_velocity(&mut self, bodies: &[RigidBody]) {
        self.b.fill([0.0; 6]);
        self.solve_velocity_under(bodies);
    }

    /// The same with the impulses in `b`.
    pub fn solve_velocity_under(&mut self, bodies: &[RigidBody]) {
        self.lane_blocks.load(bodies);
        self.solve_rates(bodies);
    }

    /// The same for velocities in the lane blocks, see [`System::evaluate_lane_blocks`].
    pub fn solve_velocity_lane_blocks(&mut self, bodies: &[RigidBody]) {
        self.b.fill([0.0; 6]);
        self.solve_rates(bodies);
    }

    fn solve_rates(&mut self, bodies: &[RigidBody]) {
        self.factor.solve_kind = SolveKind::Velocity;
        self.hold_kinematic();
        self.rates(bodies);
        for rows in self.rows.right_hand_rows() {
            for (g, state) in self.g[rows.clone()].iter_mut().zip(&self.rows.states[rows.clone()]) {
                *g = if state.stabilised { 0.0 } else { -*g };
            }
        }
        self.solve_as(JointTarget::Given);
    }

    /// Solves for the velocity change after impulses `b`, joints held: J δ = 0.
    pub fn solve_impulse(&mut self) {
        for rows in self.rows.right_hand_rows() {
            self.g[rows.clone()].fill(0.0);
        }
        self.hold_kinematic();
        self.solve_as(JointTarget::Zero);
    }

    /// Kinematic bodies do not respond.
    pub(super) fn hold_kinematic(&mut self) {
        for (a, &kinematic) in self.a.iter_mut().zip(&self.kinematic) {
            if kinematic {
                *a = [0.0; 6];
            }
        }
    }

    /// Writes Ċ of every row into `g`, and −Ċ of ball joints as their target.
    fn rates(&mut self, bodies: &[RigidBody]) {
        let coordinates = |body: usize| vec6(bodies[body].velocity, bodies[body].angular_velocity);
        self.factor.ball_joints.target_zero_rate(self.lane_blocks.all(), &mut self.factor.tree);
        if self.rows.stabilising {
            self.factor.ball_joints.write_rates(&self.factor.tree, &mut self.g);
        }
        for joint in self.rows.general_joints[..self.rows.outside_trains].iter().map(|&joint| &self.rows.joints[joint])
        {
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
                    let rows = &self.rows.blocks[block];
                    let a = coordinates(joint.link.a);
                    let b = joint.link.b.map(coordinates);
                    for k in 0..joint.rows {
                        let against = b.as_ref().map_or(0.0, |b| dot(&rows.b[k], b));
                        self.g[at + k] = dot(&rows.a[k], &a) + against - self.rows.states[at + k].prescribed_rate;
                    }
                }
                (None, None) => {}
            }
        }
        for coupling in self.rows.couplings.iter().filter(|coupling| !self.factor.trains.owns(coupling.constraint)) {
            let rows = self.factor.outside();
            let parts = &rows[coupling.outside].parts;
            let rate: f64 = parts.iter().map(|(body, block)| dot(block, &coordinates(*body))).sum();
            self.g[coupling.at] = rate - self.rows.states[coupling.at].prescribed_rate;
        }
    }

    /// Adds the solution `a` to the bodies' velocities.
    pub fn apply_velocity(&self, bodies: &mut [RigidBody]) {
        for (body, a) in bodies.iter_mut().zip(&self.a) {
            body.velocity += linear(a);
            body.angular_velocity += angular(a);
        }
    }

    /// Closes the joints: adds the solution of [`System::solve_displacement`] to the lane blocks' poses.
    pub fn close_lane_blocks(&mut self) {
        self.lane_blocks.displace(&self.a);
        self.rows.values_valid = false;
        let stabilising = self.rows.stabilising.then_some(&self.rows.states[..]);
        self.factor.ball_joints.close(&mut self.factor.tree, stabilising);
        for rows in &self.rows.general_rows {
            for state in self.rows.states[rows.clone()].iter_mut().filter(|state| !state.stabilised) {
                state.value = 0.0;
            }
        }
    }
}

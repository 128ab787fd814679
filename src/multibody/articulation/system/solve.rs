//! What the factor is asked: accelerations, displacements, velocity changes.

use fearless_simd::dispatch;

use super::System;
use crate::articulation::ball::Wanted;
use crate::articulation::trains::Asked;
use soffio_geometry::bodies::RigidBody;
use soffio_math::spatial::{angular, dot, linear, vec6};

impl System {
    /// Solves for `a` and `lambda` from `b` and `g`.
    pub fn solve(&mut self) {
        self.factor.hung.want(&mut self.factor.tree, &self.g);
        self.solve_for(Wanted::Told);
        self.tell_multipliers();
    }

    /// Tells `lambda` what points by which bodies hang carry by the last solve.
    pub fn tell_multipliers(&mut self) {
        self.factor.hung.tell_forces(&self.factor.tree, &mut self.lambda);
    }

    /// The same where nobody asks for the `lambda` of points by which bodies hang, and `wanted` is their `g`. While rows are
    /// drawn together all asks are in `g`.
    fn solve_as(&mut self, wanted: Wanted) {
        if self.rows.gathering { self.solve() } else { self.solve_for(wanted) }
    }

    fn solve_for(&mut self, wanted: Wanted) {
        let Self { factor, quads, sleepers, b, g, a, lambda, .. } = self;
        dispatch!(quads.level(), simd => factor.solve(simd, quads, (b, g, wanted), (a, lambda)));
        for &body in &sleepers.still {
            a[body] = [0.0; 6];
        }
        factor.asked = Asked::Impulse;
    }

    /// Notes which rows are so far from closed that the stabiliser must draw them together; from the last evaluation.
    /// So does it rows of a share below 1. The others are closed by projection: their errors at an integrator's inner stages belong to the method.
    pub fn look_for_gaps(&mut self) {
        self.rows.look_for_gaps(&self.factor);
    }

    /// Solves for accelerations under the forces in `b`: J a = −J̇ẋ, and − ω₀² C − 2 ω₀ Ċ where rows gather. The
    /// accelerations of driven bodies stand in `a`.
    pub fn solve_acceleration(&mut self, bodies: &[RigidBody], omega0: f64) {
        self.factor.asked = Asked::Acceleration;
        if self.rows.gathering {
            self.factor.hung.tell_biases(&self.factor.tree, &mut self.rows.states);
            self.rates(bodies);
            for (g, state) in self.g.iter_mut().zip(&self.rows.states) {
                let omega0 = self.rows.constraints[state.constraint].stabilization_time.map_or(omega0, f64::recip);
                let drawn = if state.gathers { omega0 * (omega0 * state.value + 2.0 * *g) } else { 0.0 };
                *g = -state.bias - drawn;
            }
        } else {
            let various = self.rows.various[..self.rows.outside_trains].iter().map(|&joint| &self.rows.joints[joint]);
            let rows = various.flat_map(|joint| joint.at..joint.at + joint.rows);
            for row in rows.chain(self.rows.couplings.iter().map(|coupling| coupling.at)) {
                self.g[row] = -self.rows.states[row].bias;
            }
        }
        self.solve_as(Wanted::Still);
    }

    /// Solves for the displacement that closes the joints' position error: J δ = −C, least in kinetic energy.
    pub fn solve_displacement(&mut self) {
        self.factor.asked = Asked::Place;
        if self.rows.gathering {
            self.rows.tell_values(&self.factor);
        }
        self.b.fill([0.0; 6]);
        self.still();
        for rows in self.rows.asked() {
            for (g, state) in self.g[rows.clone()].iter_mut().zip(&self.rows.states[rows.clone()]) {
                *g = if state.gathers { 0.0 } else { -state.value };
            }
        }
        self.solve_as(Wanted::Closed);
    }

    /// Solves for the velocity change that makes J (v + δ) + Γ λ = ḟ: joints hold, soft rows resist. What is still
    /// being drawn together keeps its speed.
    pub fn solve_velocity(&mut self, bodies: &[RigidBody]) {
        self.b.fill([0.0; 6]);
        self.solve_velocity_under(bodies);
    }

    /// The same where the impulses in `b` act too.
    pub fn solve_velocity_under(&mut self, bodies: &[RigidBody]) {
        self.quads.look(bodies);
        self.solve_rates(bodies);
    }

    /// The same for bodies whose velocities the quads have, see [`System::evaluate_quads`].
    pub fn solve_velocity_quads(&mut self, bodies: &[RigidBody]) {
        self.b.fill([0.0; 6]);
        self.solve_rates(bodies);
    }

    fn solve_rates(&mut self, bodies: &[RigidBody]) {
        self.factor.asked = Asked::Velocity;
        self.still();
        self.rates(bodies);
        for rows in self.rows.asked() {
            for (g, state) in self.g[rows.clone()].iter_mut().zip(&self.rows.states[rows.clone()]) {
                *g = if state.gathers { 0.0 } else { -*g };
            }
        }
        self.solve_as(Wanted::Told);
    }

    /// Solves for the velocity change after impulses `b`, joints held: J δ = 0.
    pub fn solve_impulse(&mut self) {
        for rows in self.rows.asked() {
            self.g[rows.clone()].fill(0.0);
        }
        self.still();
        self.solve_as(Wanted::Nothing);
    }

    /// Driven bodies do not give way.
    pub(super) fn still(&mut self) {
        for (a, &driven) in self.a.iter_mut().zip(&self.driven) {
            if driven {
                *a = [0.0; 6];
            }
        }
    }

    /// Ċ of every row into `g`; points by which bodies hang are told to come to rest.
    fn rates(&mut self, bodies: &[RigidBody]) {
        let coordinates = |body: usize| vec6(bodies[body].velocity, bodies[body].angular_velocity);
        self.factor.hung.want_rest(self.quads.all(), &mut self.factor.tree);
        if self.rows.gathering {
            self.factor.hung.tell_rates(&self.factor.tree, &mut self.g);
        }
        for joint in self.rows.various[..self.rows.outside_trains].iter().map(|&joint| &self.rows.joints[joint]) {
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
                        self.g[at + k] = dot(&rows.a[k], &a) + against - self.rows.states[at + k].feed;
                    }
                }
                (None, None) => {}
            }
        }
        for coupling in self.rows.couplings.iter().filter(|coupling| !self.factor.trains.owns(coupling.constraint)) {
            let rows = self.factor.outside();
            let parts = &rows[coupling.outside].parts;
            let rate: f64 = parts.iter().map(|(body, block)| dot(block, &coordinates(*body))).sum();
            self.g[coupling.at] = rate - self.rows.states[coupling.at].feed;
        }
    }

    /// Adds the answer `a` to the bodies' velocities.
    pub fn apply_velocity(&self, bodies: &mut [RigidBody]) {
        for (body, a) in bodies.iter_mut().zip(&self.a) {
            body.velocity += linear(a);
            body.angular_velocity += angular(a);
        }
    }

    /// Closes the joints: adds the answer of [`System::solve_displacement`] to the quads' places.
    pub fn close_quads(&mut self) {
        self.quads.displace(&self.a);
        self.rows.told = false;
        let gathering = self.rows.gathering.then_some(&self.rows.states[..]);
        self.factor.hung.close(&mut self.factor.tree, gathering);
        for rows in &self.rows.aside {
            for state in self.rows.states[rows.clone()].iter_mut().filter(|state| !state.gathers) {
                state.value = 0.0;
            }
        }
    }
}

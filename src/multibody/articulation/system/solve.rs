//! What the factor is asked: accelerations, displacements, velocity changes.

use fearless_simd::{Simd, dispatch};

use super::{PROJECTION_REACH, System};
use crate::articulation::trains::Asked;
use soffio_geometry::bodies::RigidBody;
use soffio_math::spatial::{angular, dot, linear, vec6};

impl System {
    /// Solves for `a` and `lambda` from `b` and `g`.
    pub fn solve(&mut self) {
        dispatch!(self.quads.level(), simd => self.solve_in(simd));
    }

    /// All of it in one piece, by the best instructions there are.
    #[inline(always)]
    fn solve_in<S: Simd>(&mut self, simd: S) {
        if let Some(dense) = &mut self.dense {
            dense.solve(&mut self.b, &self.g, &mut self.a, &mut self.lambda);
            return;
        }
        self.trains.solve(self.asked, &self.quads, &self.b, &mut self.a);
        self.tree.sweep_up(simd, &mut self.b, &self.g, &mut self.lambda);
        self.loops.correct(&self.tree, &mut self.b, &self.g, &self.a, &mut self.lambda);
        self.tree.sweep_down(simd, &self.b, &self.g, &mut self.lambda, &mut self.a);
        self.trains.push(self.loops.pushes(), &mut self.a);
        for &body in &self.still {
            self.a[body] = [0.0; 6];
        }
        self.asked = Asked::Impulse;
    }

    /// C of the point joints into their rows' numbers, if it is not there yet.
    pub(super) fn tell_values(&mut self) {
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
        for rows in &self.rows {
            for state in &mut self.states[rows.clone()] {
                state.gathers = state.value.abs() > PROJECTION_REACH || state.share < 1.0;
                self.gathering |= state.gathers;
            }
        }
    }

    /// Solves for accelerations under the forces in `b`: J a = −J̇ẋ, and − ω₀² C − 2 ω₀ Ċ where rows gather. The
    /// accelerations of driven bodies stand in `a`.
    pub fn solve_acceleration(&mut self, bodies: &[RigidBody], omega0: f64) {
        self.asked = Asked::Acceleration;
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
            let various = self.various[..self.outside_trains].iter().map(|&joint| &self.joints[joint]);
            let rows = various.flat_map(|joint| joint.at..joint.at + joint.rows);
            for row in rows.chain(self.couplings.iter().map(|coupling| coupling.at)) {
                self.g[row] = -self.states[row].bias;
            }
        }
        self.solve();
    }

    /// Solves for the displacement that closes the joints' position error: J δ = −C, least in kinetic energy.
    pub fn solve_displacement(&mut self) {
        self.asked = Asked::Place;
        self.tell_values();
        self.b.fill([0.0; 6]);
        self.still();
        for rows in &self.rows {
            for (g, state) in self.g[rows.clone()].iter_mut().zip(&self.states[rows.clone()]) {
                *g = if state.gathers { 0.0 } else { -state.value };
            }
        }
        self.solve();
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
        self.asked = Asked::Velocity;
        self.still();
        self.rates(bodies);
        for rows in &self.rows {
            for (g, state) in self.g[rows.clone()].iter_mut().zip(&self.states[rows.clone()]) {
                *g = if state.gathers { 0.0 } else { -*g };
            }
        }
        self.solve();
    }

    /// Solves for the velocity change after impulses `b`, joints held: J δ = 0.
    pub fn solve_impulse(&mut self) {
        for rows in &self.rows {
            self.g[rows.clone()].fill(0.0);
        }
        self.still();
        self.solve();
    }

    /// Driven bodies do not give way.
    pub(super) fn still(&mut self) {
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
        for joint in self.various[..self.outside_trains].iter().map(|&joint| &self.joints[joint]) {
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
        for coupling in self.couplings.iter().filter(|coupling| !self.trains.owns(coupling.constraint)) {
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
        for rows in &self.rows {
            for state in self.states[rows.clone()].iter_mut().filter(|state| !state.gathers) {
                state.value = 0.0;
            }
        }
    }
}

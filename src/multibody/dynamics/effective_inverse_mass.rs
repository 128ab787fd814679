//! How a figure answers pushes at its points and turns of its bodies, its joints held.

use super::step::Dynamics;
use soffio_geometry::bodies::RigidBody;
use soffio_math::spatial::{angular, linear, vec6};
use soffio_math::{DMat3, DVec3};

impl Dynamics {
    /// How points of the figure (body, world place, m) answer impulses, joints held: block i n + j is the velocity of point
    /// i for an impulse at point j, 1/kg.
    pub fn effective_inverse_mass(&mut self, points: &[(usize, DVec3)], out: &mut [DMat3]) {
        points.iter().for_each(|point| self.wake(point.0));
        self.equations.prepare_impulses(&self.bodies);
        let n = points.len();
        let arm = |(body, point): (usize, DVec3), bodies: &[RigidBody]| point - bodies[body].position;
        for (j, &pushed) in points.iter().enumerate() {
            let lever = arm(pushed, &self.bodies);
            for axis in 0..3 {
                let push = DVec3::AXES[axis];
                self.equations.system.b.fill([0.0; 6]);
                self.equations.system.b[pushed.0] = vec6(push, lever.cross(push));
                self.equations.system.solve_impulse();
                for (i, &asked) in points.iter().enumerate() {
                    let answer = &self.equations.system.a[asked.0];
                    let velocity = linear(answer) + angular(answer).cross(arm(asked, &self.bodies));
                    *out[i * n + j].col_mut(axis) = velocity;
                }
            }
        }
    }

    /// Does a clutch of this body slip?
    pub fn clutch_slips(&self, body: usize) -> bool {
        self.contacts.clutches().slips(&self.equations.system, body)
    }

    /// How a body answers a unit of angular impulse about a world axis, joints held: rad/s about it, 1/(kg m²).
    pub fn angular_response(&mut self, body: usize, axis: DVec3) -> f64 {
        self.wake(body);
        self.equations.prepare_impulses(&self.bodies);
        self.equations.system.b.fill([0.0; 6]);
        self.equations.system.b[body] = vec6(DVec3::ZERO, axis);
        self.equations.system.solve_impulse();
        angular(&self.equations.system.a[body]).dot(axis)
    }
}

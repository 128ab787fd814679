//! Effective inverse mass: the velocity response of an articulation to unit impulses, joints held.

use super::step::Dynamics;
use soffio_geometry::bodies::RigidBody;
use soffio_math::spatial::{angular, linear, vec6};
use soffio_math::{DMat3, DVec3};

impl Dynamics {
    /// Effective inverse mass of points (body, world position in m), 1/kg: writes n² blocks to `out`. Block i n + j is the velocity of
    /// point i for a unit impulse at point j. Wakes the bodies.
    pub fn effective_inverse_mass(&mut self, points: &[(usize, DVec3)], out: &mut [DMat3]) {
        points.iter().for_each(|point| self.wake(point.0));
        self.equations.prepare_impulses(&self.bodies);
        let n = points.len();
        let arm = |(body, point): (usize, DVec3), bodies: &[RigidBody]| point - bodies[body].position;
        for (j, &pushed) in points.iter().enumerate() {
            let pushed_arm = arm(pushed, &self.bodies);
            for axis in 0..3 {
                let push = DVec3::AXES[axis];
                self.equations.system.b.fill([0.0; 6]);
                self.equations.system.b[pushed.0] = vec6(push, pushed_arm.cross(push));
                self.equations.system.solve_impulse();
                for (i, &point) in points.iter().enumerate() {
                    let response = &self.equations.system.a[point.0];
                    let velocity = linear(response) + angular(response).cross(arm(point, &self.bodies));
                    *out[i * n + j].col_mut(axis) = velocity;
                }
            }
        }
    }

    /// Does a clutch between this body (index) and another one slip in the present step?
    pub fn clutch_slips(&self, body: usize) -> bool {
        self.contacts.clutches().slips(&self.equations.system, body)
    }

    /// Angular response of a body: its angular velocity about a world axis for a unit angular impulse about that axis, joints held,
    /// 1/(kg m²). Wakes the body.
    pub fn angular_response(&mut self, body: usize, axis: DVec3) -> f64 {
        self.wake(body);
        self.equations.prepare_impulses(&self.bodies);
        self.equations.system.b.fill([0.0; 6]);
        self.equations.system.b[body] = vec6(DVec3::ZERO, axis);
        self.equations.system.solve_impulse();
        angular(&self.equations.system.a[body]).dot(axis)
    }
}

//! Jacobian rows of contacts: how one scalar of a contact depends on the velocities of its bodies.

use soffio_geometry::bodies::RigidBody;
use soffio_math::spatial::{Vec6, add_scaled, dot, vec6};
use soffio_math::{DVec3, tangents};

/// Most bodies that a Jacobian row acts on: the two wheels of a gear and the carrier of their axles.
pub const MAX_ROW_BODIES: usize = 3;

/// One Jacobian row J: the block of each body that it acts on, (linear, angular).
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::dynamics) struct JacobianRow {
    /// Each body that it touches, with the block of J on it.
    pub ends: [Option<(usize, Vec6)>; MAX_ROW_BODIES],
}

impl JacobianRow {
    /// Adds `scale` times the block of a body; nothing for the world.
    pub fn add(&mut self, body: Option<usize>, scale: f64, block: &Vec6) {
        let Some(body) = body else { return };
        let own = |end: &&mut Option<(usize, Vec6)>| end.is_none_or(|(other, _)| other == body);
        if let Some(end) = self.ends.iter_mut().find(own) {
            let mut sum = end.map_or([0.0; 6], |(_, block)| block);
            add_scaled(&mut sum, scale, block);
            *end = Some((body, sum));
        }
    }

    /// J times one vector per body.
    pub fn along(&self, a: &[Vec6]) -> f64 {
        self.ends.iter().flatten().fold(0.0, |sum, (body, block)| sum + dot(block, &a[*body]))
    }

    /// J v: the rate of the scalar, m/s or rad/s.
    pub fn rate(&self, bodies: &[RigidBody]) -> f64 {
        let along = |(body, block): &(usize, Vec6)| {
            let body = &bodies[*body];
            dot(block, &vec6(body.velocity, body.angular_velocity))
        };
        self.ends.iter().flatten().map(along).sum()
    }
}

/// Rows of a contact point between two bodies: normal, then two tangents.
pub(super) fn point_rows(
    point: DVec3,
    normal: DVec3,
    [a, b]: [Option<usize>; 2],
    bodies: &[RigidBody],
) -> [JacobianRow; 3] {
    let (t, u) = tangents(normal);
    [normal, t, u].map(|axis| {
        let end = |body: Option<usize>, sign: f64| {
            let along = sign * axis;
            body.map(|i| (i, vec6(along, (point - bodies[i].position).cross(along))))
        };
        JacobianRow { ends: [end(a, 1.0), end(b, -1.0), None] }
    })
}

/// Rows of the relative rotation of two bodies: about the normal, then about two tangents.
pub(super) fn rolling_resistance_rows(normal: DVec3, [a, b]: [Option<usize>; 2]) -> [JacobianRow; 3] {
    let (t, u) = tangents(normal);
    [normal, t, u].map(|axis| {
        let end = |body: Option<usize>, sign: f64| body.map(|i| (i, vec6(DVec3::ZERO, sign * axis)));
        JacobianRow { ends: [end(a, 1.0), end(b, -1.0), None] }
    })
}

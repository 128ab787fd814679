//! One row of a contact problem: how a touch or a bound acts on its bodies.

use soffio_geometry::bodies::RigidBody;
use soffio_math::spatial::{Vec6, add_scaled, dot, vec6};
use soffio_math::{DVec3, tangents};

/// Most bodies that a Jacobian row acts on: the two wheels of a gear and the carrier of their axles.
pub const MAX_ROW_BODIES: usize = 3;

/// One row: the blocks of the bodies it acts on.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::dynamics) struct JacobianRow {
    pub ends: [Option<(usize, Vec6)>; MAX_ROW_BODIES],
}

impl JacobianRow {
    /// Adds `scale` times a block of a body; nothing for the world.
    pub fn add(&mut self, body: Option<usize>, scale: f64, block: &Vec6) {
        let Some(body) = body else { return };
        let own = |end: &&mut Option<(usize, Vec6)>| end.is_none_or(|(other, _)| other == body);
        if let Some(slot) = self.ends.iter_mut().find(own) {
            let mut sum = slot.map_or([0.0; 6], |(_, block)| block);
            add_scaled(&mut sum, scale, block);
            *slot = Some((body, sum));
        }
    }

    /// Row times the bodies' coordinates.
    pub fn along(&self, a: &[Vec6]) -> f64 {
        self.ends.iter().flatten().fold(0.0, |sum, (body, block)| sum + dot(block, &a[*body]))
    }

    /// Row times the bodies' velocities.
    pub fn rate(&self, bodies: &[RigidBody]) -> f64 {
        let along = |(body, block): &(usize, Vec6)| {
            let body = &bodies[*body];
            dot(block, &vec6(body.velocity, body.angular_velocity))
        };
        self.ends.iter().flatten().map(along).sum()
    }
}

/// Rows of a point contact: normal, then two tangents.
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

/// Rows of a couple between two bodies: about the normal, then about two tangents.
pub(super) fn rolling_resistance_rows(normal: DVec3, [a, b]: [Option<usize>; 2]) -> [JacobianRow; 3] {
    let (t, u) = tangents(normal);
    [normal, t, u].map(|axis| {
        let end = |body: Option<usize>, sign: f64| body.map(|i| (i, vec6(DVec3::ZERO, sign * axis)));
        JacobianRow { ends: [end(a, 1.0), end(b, -1.0), None] }
    })
}

//! Which bodies a joint joins.

use soffio_multibody::articulation::ConstraintKind;

/// Two bodies; `None` is the world.
pub(crate) type BodyPair = (Option<usize>, Option<usize>);

/// The pairs of bodies that a constraint joins.
pub(crate) fn pairs(kind: &ConstraintKind) -> Vec<BodyPair> {
    match kind {
        ConstraintKind::PointToPoint { a, b } => vec![(a.body, b.body)],
        ConstraintKind::Orientation { a, b, .. } => vec![(a.body, b.body)],
        ConstraintKind::PointOnPlane { point, plane, .. } => vec![(point.body, plane.body)],
        ConstraintKind::Coupling { terms } => {
            let measured: Vec<_> = terms.iter().map(|term| term.measure.bodies().0).collect();
            measured.windows(2).map(|pair| (pair[0], pair[1])).collect()
        }
    }
}

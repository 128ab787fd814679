//! Collider pairs that can touch, from the joints of an exhibit and the reachable volumes of
//! `soffio_multibody::collision`.

use super::exhibit::Exhibit;
use soffio_math::Function;
use soffio_math::{DVec3, Pose};
use soffio_multibody::articulation::{Anchor, Axis, Constraint, ConstraintKind};
use soffio_multibody::collision::reachable_volume::{FixedAxis, JointEnd, JointPoint};
use soffio_multibody::collision::{ColliderPairs, ReachableVolumes, pairs};

/// Directions whose angle has a smaller sine count as parallel.
const SAME: f64 = 1e-9;

impl Exhibit {
    /// ColliderPairs of colliders that can touch, and the other pairs with the reasons why they cannot.
    pub fn collider_pairs(&self) -> ColliderPairs {
        let is_kinematic = |body: Option<usize>| self.drives.iter().any(|drive| Some(drive.body) == body);
        // A constraint that is scheduled or can break limits nothing for good.
        let holds = |c: &&Constraint| c.schedule.is_always() && c.breaking.is_none();
        let joints: Vec<JointPoint> = self
            .constraints
            .iter()
            .filter(holds)
            .filter_map(|c| match c.kind {
                ConstraintKind::PointToPoint { a, b } if !is_kinematic(a.body) && !is_kinematic(b.body) => {
                    Some([end(a), end(b)])
                }
                _ => None,
            })
            .collect();
        let poses: Vec<Pose> = self.bodies.iter().map(|body| body.pose).collect();
        let axes: Vec<FixedAxis> = (0..self.bodies.len()).filter_map(|body| self.fixed_axis(body, &joints)).collect();
        pairs(&self.colliders, &self.excluded_pairs, &ReachableVolumes::new(&self.colliders, &poses, &joints, &axes))
    }

    /// The only axis about which a body can rotate: through a nail, along the direction that two orientations hold.
    fn fixed_axis(&self, body: usize, joints: &[JointPoint]) -> Option<FixedAxis> {
        let nail = joints.iter().find_map(|[a, b]| match (a.body, b.body) {
            (Some(i), None) if i == body => Some(b.point),
            (None, Some(i)) if i == body => Some(a.point),
            _ => None,
        })?;
        // (body direction, world direction) of each right angle to the world.
        let held: Vec<(DVec3, DVec3)> = self
            .constraints
            .iter()
            .filter(|c| c.schedule.is_always() && c.breaking.is_none())
            .filter_map(|c| match &c.kind {
                ConstraintKind::Orientation { a, b, angle: Function::Constant(0.0) } => of_world(body, a, b),
                _ => None,
            })
            .collect();
        let pose = self.bodies[body].pose;
        for (i, (own, world)) in held.iter().enumerate() {
            for (other_own, other_world) in &held[i + 1..] {
                // One body direction perpendicular to two world directions, or two to one.
                let direction = if own.cross(*other_own).length() < SAME {
                    world.cross(*other_world).try_normalize()
                } else if world.cross(*other_world).length() < SAME {
                    Some(*world)
                } else {
                    None
                };
                let Some(direction) = direction else { continue };
                // Only constraints that already hold at the start, not those still to be assembled.
                let right = |(t, n): (&DVec3, &DVec3)| pose.vector(*t).dot(*n).abs() < 1e-6;
                if right((own, world)) && right((other_own, other_world)) {
                    return Some(FixedAxis { body, point: nail, direction });
                }
            }
        }
        None
    }
}

fn end(anchor: Anchor) -> JointEnd {
    JointEnd { body: anchor.body, point: anchor.point }
}

fn of_world(body: usize, a: &Axis, b: &Axis) -> Option<(DVec3, DVec3)> {
    match (a.body, b.body) {
        (Some(i), None) if i == body => Some((a.direction, b.direction)),
        (None, Some(i)) if i == body => Some((b.direction, a.direction)),
        _ => None,
    }
}

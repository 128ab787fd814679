//! Which colliders of an exhibit can meet: its joints told to the bounds of `collision::reach`.

use super::exhibit::Exhibit;
use soffio_math::Function;
use soffio_math::{DVec3, Pose};
use soffio_multibody::articulation::{Anchor, Axis, Constraint, ConstraintKind};
use soffio_multibody::collision::reach::{FixedAxis, JointEnd, JointPoint};
use soffio_multibody::collision::{Pairs, Reach, pairs};

/// Directions that make a smaller sine are one.
const SAME: f64 = 1e-9;

impl Exhibit {
    /// Pairs of colliders that can meet, and the others with their reasons.
    pub fn pairs(&self) -> Pairs {
        let driven = |body: Option<usize>| self.drives.iter().any(|drive| Some(drive.body) == body);
        // What comes and goes, or breaks, holds nothing for good.
        let holds = |c: &&Constraint| c.schedule.is_always() && c.breaking.is_none();
        let joints: Vec<JointPoint> = self
            .constraints
            .iter()
            .filter(holds)
            .filter_map(|c| match c.kind {
                ConstraintKind::PointToPoint { a, b } if !driven(a.body) && !driven(b.body) => Some([end(a), end(b)]),
                _ => None,
            })
            .collect();
        let poses: Vec<Pose> = self.bodies.iter().map(|body| body.pose).collect();
        let axes: Vec<FixedAxis> = (0..self.bodies.len()).filter_map(|body| self.fixed_axis(body, &joints)).collect();
        pairs(&self.colliders, &self.excluded_pairs, &Reach::new(&self.colliders, &poses, &joints, &axes))
    }

    /// The line about which alone a body turns: through a nail, along the direction that two orientations hold.
    fn fixed_axis(&self, body: usize, joints: &[JointPoint]) -> Option<FixedAxis> {
        let nail = joints.iter().find_map(|[a, b]| match (a.body, b.body) {
            (Some(i), None) if i == body => Some(b.point),
            (None, Some(i)) if i == body => Some(a.point),
            _ => None,
        })?;
        // (own direction, world direction) of each right angle to the world.
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
                // One own direction across two of the world, or two across one of the world.
                let direction = if own.cross(*other_own).length() < SAME {
                    world.cross(*other_world).try_normalize()
                } else if world.cross(*other_world).length() < SAME {
                    Some(*world)
                } else {
                    None
                };
                let Some(direction) = direction else { continue };
                // Held already at the start, not only drawn there.
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

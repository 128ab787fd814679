//! Joint loads, and the frequencies of the tension modes that they cause.

use crate::articulation::{Constraint, System};
use soffio_geometry::bodies::RigidBody;
use soffio_math::{DMat3, DVec3};

/// Loads of the joints of an articulation.
#[derive(Clone)]
pub(super) struct JointLoads {
    /// Force of each joint when last recorded, N.
    loads: Vec<f64>,
    /// Stiffness of each joint's tension mode: ω² per N of load, 1/(kg m).
    tension_stiffness: Vec<f64>,
    /// Some pivot has friction.
    pub has_friction: bool,
    /// Pivot friction or breaking joints need the loads at a substep's end. Else the first stage of the next substep gives them,
    /// under its own forces.
    pub needed_at_substep_end: bool,
}

impl JointLoads {
    /// No loads, of joints that are evaluated at the start; without `friction` no pivot has any.
    pub fn new(system: &System, bodies: &[RigidBody], constraints: &[Constraint], friction: bool) -> Self {
        let has_friction = friction && constraints.iter().any(|constraint| constraint.friction.is_some());
        Self {
            loads: vec![0.0; system.joints().len()],
            tension_stiffness: tension_stiffness(system, bodies),
            has_friction,
            needed_at_substep_end: has_friction || constraints.iter().any(|constraint| constraint.breaking.is_some()),
        }
    }

    /// Records the loads of the last solve.
    pub fn record(&mut self, system: &System) {
        system.record_joint_loads(&mut self.loads);
    }

    /// Sets all loads to zero.
    pub fn clear(&mut self) {
        self.loads.fill(0.0);
    }

    /// Load of each joint, N.
    pub fn all(&self) -> &[f64] {
        &self.loads
    }

    /// ω² of the stiffest tension mode, 1/s²: a body that hangs by the arm r under the load λ swings about it with
    /// ω² = |λ| |r| / I⊥.
    pub fn stiffest(&self) -> f64 {
        self.loads
            .iter()
            .zip(&self.tension_stiffness)
            .fold(0.0, |max: f64, (load, stiffness)| max.max(load * stiffness))
    }
}

/// ω² per N of load of each joint's tension mode: the greatest |r| / I⊥ of its bodies at the start, 1/(kg m). Arms and
/// inertias rotate with their body, so it is constant.
fn tension_stiffness(system: &System, bodies: &[RigidBody]) -> Vec<f64> {
    let stiffness = |body: usize, arm: DVec3| arm.length() / least_inertia_across(&bodies[body].inertia_world(), arm);
    let of_joint = |index: usize| {
        let (arm_a, arm_b) = system.arms(index);
        let link = system.joints()[index].link;
        let own = |body: usize, arm| if system.kinematic()[body] { 0.0 } else { stiffness(body, arm) };
        own(link.a, arm_a).max(link.b.map_or(0.0, |b| own(b, arm_b)))
    };
    (0..system.joints().len()).map(of_joint).collect()
}

/// Smallest moment of inertia about an axis across `arm`, kg m².
pub(super) fn least_inertia_across(inertia: &DMat3, arm: DVec3) -> f64 {
    let Some(n) = arm.try_normalize() else { return f64::INFINITY };
    let (t, b) = soffio_math::tangents(n);
    let (tt, bb, tb) = (t.dot(*inertia * t), b.dot(*inertia * b), t.dot(*inertia * b));
    0.5 * (tt + bb) - (0.25 * (tt - bb) * (tt - bb) + tb * tb).sqrt()
}

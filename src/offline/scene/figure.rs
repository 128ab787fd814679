//! A scene as bodies and rows of the field.
//!
//! ```text
//! spherical   a point on a point                                                        3 rows
//! hinge       a point on a point; t₁ and t₂, across the axis in a, at right angles to the axis in b     5 rows
//! slider      b's point in two planes of a, across t₁ and t₂; t₁, t₂ ⟂ the axis in b; t₁ ⟂ u₂     5 rows
//! ```
//!
//! (t₁, t₂, axis) is a right-handed frame of the parent; u₂ is t₂ as the child sees it at the start, which holds the
//! last rotation of a slider.

use super::format::{Joint, JointKind, Scene};
use soffio_geometry::bodies::{MassProperties, RigidBody};
use soffio_math::Function;
use soffio_math::{DMat3, DQuat, DVec3, tangents};
use soffio_multibody::articulation::{Anchor, Axis, Constraint, ConstraintKind, Measure, Term};
use soffio_multibody::dynamics::forces::Damping;
use soffio_multibody::dynamics::{Dynamics, Figure, Integrator, Settings, Solver};

/// Time in which the field draws a drifted joint together, as exhibits have it, s.
const STABILIZATION_TIME: f64 = 0.04;

impl Scene {
    /// The bodies at their start.
    pub fn rigid_bodies(&self) -> Vec<RigidBody> {
        let body = |body: &super::Body| {
            let inertia = DMat3::from_diagonal(DVec3::from_array(body.inertia));
            let state = body.state();
            RigidBody {
                properties: MassProperties { mass: body.mass, center: DVec3::ZERO, inertia },
                position: state.position,
                rotation: state.rotation,
                velocity: state.velocity,
                angular_velocity: state.angular_velocity,
            }
        };
        self.bodies.iter().map(body).collect()
    }

    /// The joints and couplings as constraints.
    pub fn constraints(&self) -> Vec<Constraint> {
        let joints = self.joints.iter().enumerate().flat_map(|(index, joint)| {
            self.joint_rows(joint)
                .into_iter()
                .enumerate()
                .map(move |(part, kind)| Constraint::new(&format!("joint-{index}/{part}"), kind))
        });
        let couplings = self.couplings.iter().enumerate().map(|(index, coupling)| {
            let term = |&(joint, coefficient)| Term { measure: measure(&self.joints[joint]), coefficient };
            let terms = coupling.terms.iter().map(term).collect();
            Constraint::new(&format!("coupling-{index}"), ConstraintKind::Coupling { terms })
        });
        joints.chain(couplings).collect()
    }

    /// The scene in motion, without friction.
    pub fn dynamics(&self, integrator: Integrator, solver: Solver) -> Dynamics {
        let bodies = self.rigid_bodies();
        let figure = Figure {
            damping: vec![Damping::default(); bodies.len()],
            bodies,
            constraints: &self.constraints(),
            limits: &[],
            springs: &[],
            drives: &[],
            colliders: &[],
            pairs: Vec::new(),
        };
        let settings = Settings {
            gravity: DVec3::from_array(self.gravity),
            friction: false,
            stabilization_time: STABILIZATION_TIME,
            integrator,
            solver,
        };
        Dynamics::new(figure, settings)
    }

    fn joint_rows(&self, joint: &Joint) -> Vec<ConstraintKind> {
        let (a, b) = anchors(joint);
        let point = ConstraintKind::PointToPoint { a, b };
        let Some((axis_a, axis_b)) = joint.axes() else { return vec![point] };
        let (t1, t2) = tangents(axis_a);
        let square = |t, n| ConstraintKind::Orientation {
            a: Axis { body: a.body, direction: t },
            b: Axis { body: b.body, direction: n },
            angle: Function::default(),
        };
        let across = [square(t1, axis_b), square(t2, axis_b)];
        if joint.kind == JointKind::Hinge {
            return [point].into_iter().chain(across).collect();
        }
        let parent = joint.parent().map_or(DQuat::IDENTITY, |body| self.bodies[body].state().rotation);
        let u2 = self.bodies[joint.b].state().rotation.conjugate() * (parent * t2);
        let plane = |normal| ConstraintKind::PointOnPlane { point: b, plane: a, normal, offset: Function::default() };
        [plane(t1), plane(t2)].into_iter().chain(across).chain([square(t1, u2)]).collect()
    }
}

fn anchors(joint: &Joint) -> (Anchor, Anchor) {
    let anchor = |body, point| Anchor { body, point: DVec3::from_array(point) };
    (anchor(joint.parent(), joint.anchor_a), anchor(Some(joint.b), joint.anchor_b))
}

/// The coordinate of a hinge or slider.
fn measure(joint: &Joint) -> Measure {
    let (a, b) = anchors(joint);
    let (axis_a, axis_b) = joint.axes().expect("a coupled joint has an axis");
    match joint.kind {
        JointKind::Slider => Measure::Way { point: b, direction: Axis { body: a.body, direction: axis_a } },
        _ => Measure::Angle { axis: Axis { body: b.body, direction: axis_b }, frame: a.body },
    }
}

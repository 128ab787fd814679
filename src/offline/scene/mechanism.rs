//! Converts a scene to rigid bodies, constraint rows, limits and colliders.
//!
//! ```text
//! spherical   point on point                                                        3 rows
//! hinge       point on point; t₁ and t₂, perpendicular to the axis in a, ⟂ the axis in b     5 rows
//! slider      b's point in two planes of a, normals t₁ and t₂; t₁, t₂ ⟂ the axis in b; t₁ ⟂ u₂     5 rows
//! ```
//!
//! (t₁, t₂, axis) is a right-handed frame of the parent; u₂ is t₂ in the child's frame at the start, which fixes the
//! last rotation of a slider. Limits are inelastic stops on a hinge's angle or a slider's displacement.

use super::format::{JointKind, PhysicsScene, SceneJoint};
use super::shape::{ContactSurface, PairProperties};
use soffio_geometry::bodies::{MassProperties, RigidBody};
use soffio_math::Function;
use soffio_math::{DMat3, DQuat, DVec3, Pose, tangents};
use soffio_multibody::articulation::{Anchor, Axis, Constraint, ConstraintKind, Limit, LimitKind, Measure, Term};
use soffio_multibody::collision::reachable_volume::JointEnd;
use soffio_multibody::collision::{Collider, Excluded, Exclusion, ReachableVolumes, pairs};
use soffio_multibody::dynamics::forces::Damping;
use soffio_multibody::dynamics::{Articulation, Dynamics, Integrator, Settings, Solver, SurfacePair};

/// Time constant of the constraint stabilisation, as in exhibits, s.
const STABILIZATION_TIME: f64 = 0.04;

impl PhysicsScene {
    /// The bodies in their start state.
    pub fn rigid_bodies(&self) -> Vec<RigidBody> {
        let body = |body: &super::SceneBody| {
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

    /// The joints' limits.
    pub fn limits(&self) -> Vec<Limit> {
        let limit = |(index, joint): (usize, &SceneJoint)| {
            let [min, max] = joint.limits?;
            let kind = LimitKind::Range { measure: measure(joint), min, max };
            Some(Limit { name: format!("limit-{index}"), kind, restitution: 0.0 })
        };
        self.joints.iter().enumerate().filter_map(limit).collect()
    }

    /// The colliders: shapes of bodies and of the world, each with a material of its own; none without a surface.
    pub fn colliders(&self) -> Vec<Collider> {
        if self.surface.is_none() {
            return Vec::new();
        }
        let body = |(index, body): (usize, &super::SceneBody)| {
            let shape = body.solid()?.shape(Pose::IDENTITY);
            Some(Collider { body: Some(index), shape, material: index, node: body.name.clone() })
        };
        let n = self.bodies.len();
        let statics = self.statics.iter().enumerate().map(|(index, fixed)| fixed.collider(index, n + index));
        self.bodies.iter().enumerate().filter_map(body).chain(statics).collect()
    }

    /// Pairs of colliders that can touch; bodies that a joint connects do not collide.
    pub fn surface_pairs(&self, colliders: &[Collider]) -> Vec<SurfacePair> {
        let Some(surface) = self.surface else { return Vec::new() };
        let material = |index: usize| -> ContactSurface {
            let body = self.bodies.get(index).map(|body| body.surface);
            body.unwrap_or_else(|| self.statics[index - self.bodies.len()].surface).unwrap_or(surface)
        };
        let joined = |joint: &SceneJoint| Exclusion { bodies: (joint.parent(), Some(joint.b)), why: Excluded::Joined };
        let excluded: Vec<_> = self.joints.iter().map(joined).collect();
        let poses: Vec<_> = self
            .bodies
            .iter()
            .map(|body| body.state())
            .map(|state| Pose { rotation: state.rotation, position: state.position })
            .collect();
        let end = |anchor: Anchor| JointEnd { body: anchor.body, point: anchor.point };
        let held = self.joints.iter().filter(|joint| joint.kind != JointKind::Slider);
        let points: Vec<_> = held.map(anchors).map(|(a, b)| [end(a), end(b)]).collect();
        let reach = ReachableVolumes::new(colliders, &poses, &points, &[]);
        let meet = pairs(colliders, &excluded, &reach).meet.into_iter();
        meet.map(|pair| {
            let [a, b] = [pair.a, pair.b].map(|collider| material(colliders[collider].material));
            let PairProperties { restitution, friction, resistance } = a.with(&b);
            SurfacePair { pair, restitution, friction, full_slip: 0.0, resistance }
        })
        .collect()
    }

    /// The dynamics of the scene, with frictionless pivots.
    pub fn dynamics(&self, integrator: Integrator, solver: Solver) -> Dynamics {
        let bodies = self.rigid_bodies();
        let colliders = self.colliders();
        let mechanism = Articulation {
            damping: vec![Damping::default(); bodies.len()],
            bodies,
            constraints: &self.constraints(),
            limits: &self.limits(),
            springs: &[],
            kinematic_bodies: &[],
            pairs: self.surface_pairs(&colliders),
            colliders: &colliders,
        };
        let settings = Settings {
            gravity: DVec3::from_array(self.gravity),
            friction: false,
            stabilization_time: STABILIZATION_TIME,
            integrator,
            solver,
        };
        Dynamics::new(mechanism, settings)
    }

    fn joint_rows(&self, joint: &SceneJoint) -> Vec<ConstraintKind> {
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

fn anchors(joint: &SceneJoint) -> (Anchor, Anchor) {
    let anchor = |body, point| Anchor { body, point: DVec3::from_array(point) };
    (anchor(joint.parent(), joint.anchor_a), anchor(Some(joint.b), joint.anchor_b))
}

/// The coordinate of a hinge or slider.
fn measure(joint: &SceneJoint) -> Measure {
    let (a, b) = anchors(joint);
    let (axis_a, axis_b) = joint.axes().expect("a coupled joint has an axis");
    match joint.kind {
        JointKind::Slider => Measure::Displacement { point: b, direction: Axis { body: a.body, direction: axis_a } },
        _ => Measure::Angle { axis: Axis { body: b.body, direction: axis_b }, frame: a.body },
    }
}

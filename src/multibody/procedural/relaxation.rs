//! Joint-by-joint position relaxation (the source's compulsive motion, method 3.4, 3.5): Gauss–Seidel sweeps outwards
//! from fixed points, akin to CCD and FABRIK.
//!
//! A traversal closes each joint by moving the body beyond it, which stands for its group: its own shape, the mass of
//! everything behind it. One traversal closes a tree with a single anchor. A piece with several anchors (a ground
//! joint and a grab, two ground joints) is traversed from each in turn, ignoring the others, until all hold. The root
//! i of a free piece is placed first: each neighbour j and i alone would join at a common point, which gives i a
//! position; the root takes the mean of those positions, weighted with the groups' masses.
//!
//! Couplings, loop-closing joints, and limits between unconnected bodies are spread over their bodies by mass in each
//! sweep. Sweeps end when everything is closed, when they stall (the targets are impossible), or after
//! [`MAX_SWEEPS`]. The last traversal starts at the ground, so that ground joints hold and an unreachable grab is
//! missed.

use super::grab::{GrabTarget, MAX_GRABS, POSITION_TOLERANCE, SolveReport};
use super::joint_closure::Configuration;
use super::two_body_rule::{RotationRule, common_point};
use super::walk::{Start, Walk, Walks};
use crate::articulation::{Joint, System};
use crate::dynamics::{Contacts, Dynamics, PositionStep, SweptContact};
use soffio_geometry::bodies::RigidBody;
use soffio_math::spatial::matrix;
use soffio_math::{DMat3, DVec3, tangents};

/// Most relaxation sweeps.
pub const MAX_SWEEPS: usize = 200;
/// Sweeps after which the largest error must have shrunk to [`STALL_RATIO`] of its former value, or relaxation has
/// stalled.
const STALL_SWEEPS: usize = 16;
const STALL_RATIO: f64 = 0.98;
/// Rotation of the perturbation of a stalled piece, rad.
const PERTURBATION: f64 = 0.2;

/// Relaxation solver.
#[derive(Clone, Debug)]
pub(super) struct Relaxation {
    walks: Walks,
    frames: Vec<DMat3>,
    /// Limits between the two bodies of each joint, and all others.
    joint_limits: Vec<Vec<usize>>,
    free_limits: Vec<usize>,
}

impl Relaxation {
    /// Room for the joints and limits of these dynamics.
    pub fn new(dynamics: &Dynamics) -> Self {
        let (system, contacts) = (dynamics.system_without_trains(), dynamics.contacts());
        let mut joint_limits = vec![Vec::new(); system.joints().len()];
        let mut free_limits = Vec::new();
        for bound in 0..contacts.bound_count() {
            let [a, b] = contacts.bound_bodies(bound);
            let between = |joint: &Joint| {
                let link = (Some(joint.link.a), joint.link.b);
                link == (a, b) || link == (b, a)
            };
            match system.joints().iter().position(between) {
                Some(joint) => joint_limits[joint].push(bound),
                None => free_limits.push(bound),
            }
        }
        Self {
            walks: Walks::new(system, dynamics.bodies.len(), MAX_GRABS),
            frames: vec![DMat3::IDENTITY; dynamics.bodies.len()],
            joint_limits,
            free_limits,
        }
    }

    /// Closes the joints after an update. With a `control`, the first sweep uses the compulsive rotation.
    pub fn adjust(
        &mut self,
        step: &mut PositionStep,
        grabs: &[GrabTarget],
        targets: &[f64],
        control: Option<f64>,
    ) -> SolveReport {
        let (bodies, system, contacts) = (&mut *step.bodies, &mut *step.system, &*step.contacts);
        self.walks.rebuild(system, |body| bodies[body].properties.mass, grabs.iter().map(|grab| grab.body));
        for (frame, body) in self.frames.iter_mut().zip(bodies.iter()) {
            *frame = matrix(body.rotation);
        }
        let mut report = SolveReport::default();
        let (mut before, mut perturbed) = (f64::INFINITY, false);
        for sweep in 0..MAX_SWEEPS {
            let rotation_rule = control.filter(|_| sweep == 0).map_or(RotationRule::Aim, RotationRule::Compulsive);
            self.sweep(bodies, system, contacts, grabs, targets, rotation_rule);
            system.evaluate(bodies);
            report = SolveReport {
                passes: sweep as u32 + 1,
                residual: system.largest_residual(targets),
                grab_error: largest_grab_error(grabs, bodies),
            };
            let open = report.residual.max(report.grab_error).max(self.limit_violation(contacts, bodies));
            if open <= POSITION_TOLERANCE {
                break;
            }
            if sweep % STALL_SWEEPS == STALL_SWEEPS - 1 {
                let stuck = open > STALL_RATIO * before;
                if stuck && perturbed {
                    break;
                }
                if stuck {
                    self.perturb(bodies);
                    perturbed = true;
                }
                before = open;
            }
        }
        report
    }

    /// Separates a penetrating contact along its normal: two free bodies in inverse proportion to their masses. A
    /// violated limit is closed by its row.
    pub fn separate_directly(
        &mut self,
        contact: &SweptContact,
        system: &System,
        contacts: &Contacts,
        bodies: &mut [RigidBody],
    ) {
        let masses =
            contact.bodies.map(|body| body.filter(|&b| !system.kinematic()[b]).map(|b| bodies[b].properties.mass));
        if contact.colliders.is_none() {
            let mut configuration = Configuration { bodies, frames: &mut self.frames, system, contacts, targets: &[] };
            configuration.spread(contact.ends.into_iter().flatten(), contact.depth);
            return;
        }
        let weights = match masses {
            [Some(a), Some(b)] => [b / (a + b), -a / (a + b)],
            [a, b] => [f64::from(a.is_some()), -f64::from(b.is_some())],
        };
        for (body, weight) in contact.bodies.into_iter().zip(weights) {
            if let Some(body) = body {
                bodies[body].position += weight * contact.depth * contact.normal;
            }
        }
    }

    /// Largest violation of the limits between unconnected bodies, m or rad.
    fn limit_violation(&self, contacts: &Contacts, bodies: &[RigidBody]) -> f64 {
        self.free_limits.iter().fold(0.0, |most: f64, &bound| most.max(-contacts.bound(bound, bodies).0))
    }

    /// Perturbs the bodies of each walk by alternating rotations. Collinear bodies are pulled along their arms, which
    /// rotates nothing, so a straight chain pushed from both ends would never bend.
    fn perturb(&mut self, bodies: &mut [RigidBody]) {
        for walk in &self.walks.walks {
            let visits = self.walks.visits(walk);
            let root = bodies[visits[0].body].position;
            for (k, visit) in visits.iter().enumerate() {
                let body = &mut bodies[visit.body];
                let (t, b) = tangents((body.position - root).try_normalize().unwrap_or(DVec3::NEG_Y));
                let alternating = if k % 2 == 0 { PERTURBATION } else { -PERTURBATION };
                body.displace(DVec3::ZERO, alternating * (t + b));
                self.frames[visit.body] = matrix(body.rotation);
            }
        }
    }

    /// One sweep: couplings, free limits and loops, then traversals from every anchor, grabs first.
    fn sweep(
        &mut self,
        bodies: &mut [RigidBody],
        system: &mut System,
        contacts: &Contacts,
        grabs: &[GrabTarget],
        targets: &[f64],
        rotation_rule: RotationRule,
    ) {
        if system.coupled().next().is_some() {
            system.evaluate(bodies);
        }
        let system = &*system;
        let mut configuration = Configuration { bodies, frames: &mut self.frames, system, contacts, targets };
        for (value, parts) in system.coupled() {
            configuration.spread(parts.iter().copied(), -value);
        }
        for &bound in &self.free_limits {
            let (gap, ends) = contacts.bound(bound, configuration.bodies);
            if gap < 0.0 {
                configuration.spread(ends.into_iter().flatten(), -gap);
            }
        }
        for &joint in &self.walks.loops {
            close_loop(&mut configuration, joint, rotation_rule, &self.joint_limits[joint]);
        }
        let (walks, joint_limits) = (&self.walks, &self.joint_limits);
        let grab = |walk: &&Walk| matches!(walk.start, Start::Grab(_));
        for walk in walks.walks.iter().filter(grab).chain(walks.walks.iter().filter(|walk| !grab(walk))) {
            traverse(&mut configuration, walks, walk, grabs, rotation_rule, joint_limits);
        }
    }
}

/// Largest distance of a grabbed point from its target, m.
pub(super) fn largest_grab_error(grabs: &[GrabTarget], bodies: &[RigidBody]) -> f64 {
    grabs.iter().fold(0.0, |most: f64, grab| most.max(grab.error(bodies)))
}

/// Traverses a walk and closes its joints.
fn traverse(
    configuration: &mut Configuration,
    walks: &Walks,
    walk: &Walk,
    grabs: &[GrabTarget],
    rotation_rule: RotationRule,
    joint_limits: &[Vec<usize>],
) {
    let visits = walks.visits(walk);
    let first = visits[0];
    match walk.start {
        Start::Ground { joint } => {
            configuration.close(joint, first.body, (rotation_rule, first.group_mass), &joint_limits[joint])
        }
        Start::Grab(index) => {
            let grab = &grabs[index];
            let at = grab.world_point(configuration.bodies);
            let arm = at - configuration.bodies[first.body].position;
            configuration.pull(first.body, (arm, grab.target - at), (rotation_rule, first.group_mass), &[]);
        }
        Start::Free => place_root(configuration, walks, walk, rotation_rule),
    }
    for visit in &visits[1..] {
        if let Some(joint) = visit.joint {
            configuration.close(joint, visit.body, (rotation_rule, visit.group_mass), &joint_limits[joint]);
        }
    }
}

/// Places the root of a free piece: the mean of its positions joined with each neighbour alone.
fn place_root(configuration: &mut Configuration, walks: &Walks, walk: &Walk, rotation_rule: RotationRule) {
    let visits = walks.visits(walk);
    let root = visits[0].body;
    let start = configuration.bodies[root];
    let (mut displacement, mut rotation, mut weight) = (DVec3::ZERO, DVec3::ZERO, 0.0);
    for visit in &visits[1..] {
        let Some(joint) = visit.joint.map(|joint| &configuration.system.joints()[joint]) else { continue };
        if joint.link.a != root && joint.link.b != Some(root) {
            continue;
        }
        let mass = start.properties.mass;
        if let Some((r, s)) = configuration.first_pull(joint, root) {
            let at = start.position + r;
            let common = common_point((mass, at), (visit.group_mass, at + s));
            configuration.pull(root, (r, common - at), (rotation_rule, mass), &[]);
        }
        let there = configuration.bodies[root];
        displacement += visit.group_mass * (there.position - start.position);
        rotation += visit.group_mass * rotation_between(&start, &there);
        weight += visit.group_mass;
        configuration.bodies[root] = start;
        configuration.frames[root] = matrix(start.rotation);
    }
    if weight > 0.0 {
        configuration.displace(root, displacement / weight, rotation / weight);
    }
}

/// Rotation vector from one state of a body to another, the shorter way, rad.
fn rotation_between(from: &RigidBody, to: &RigidBody) -> DVec3 {
    let rotation = to.rotation * from.rotation.conjugate();
    soffio_math::rotation_vector(if rotation.w < 0.0 { -rotation } else { rotation })
}

/// Closes a joint between two free bodies at their common point.
fn close_loop(configuration: &mut Configuration, joint: usize, rotation_rule: RotationRule, joint_limits: &[usize]) {
    let system = configuration.system;
    let link = system.joints()[joint].link;
    let Some(b) = link.b else { return };
    let masses = [link.a, b].map(|body| configuration.bodies[body].properties.mass);
    if let Some((r, s)) = configuration.first_pull(&system.joints()[joint], link.a) {
        let at = configuration.bodies[link.a].position + r;
        let common = common_point((masses[0], at), (masses[1], at + s));
        configuration.pull(link.a, (r, common - at), (rotation_rule, masses[0]), &[]);
    }
    configuration.close(joint, b, (rotation_rule, masses[1]), joint_limits);
}

//! Joint-by-joint closing (the source's compulsive motion, method 3.4, 3.5), akin to CCD and FABRIK.
//!
//! A traversal closes each joint by moving the body beyond it, which stands for its group: its own shape, with the mass of everything
//! behind it where that hangs on it ([`Group`]). One traversal closes a tree with a single anchor. The root i of a free piece is placed
//! first: each neighbour j and i alone would join at a common point, which gives i a position; the root takes the mean of those
//! positions, weighted with the groups' masses. Then the piece moves as one, so that closing gives it no momentum.
//!
//! A piece with several anchors (a ground joint and a grab, two ground joints) can be relaxed: sweeps traverse it from each in turn,
//! ignoring the others, until all hold. Couplings, loop-closing joints, and limits between unconnected bodies are spread over their
//! bodies by mass in each sweep. Sweeps end when everything is closed, when they stall (the targets are impossible), or after
//! [`MAX_SWEEPS`]. The last traversal starts at the ground, so that ground joints hold and an unreachable grab is missed. Sweeps
//! are many, and what they open elsewhere becomes speed: they are for what Newton's method cannot close.

use super::grab::{GrabTarget, MAX_GRABS, POSITION_TOLERANCE, SolveReport};
use super::joint_closure::Configuration;
use super::settings::DEFAULT_CONTROL;
use super::two_body_rule::{Group, common_point};
use super::walk::{Start, Visit, Walk, Walks};
use crate::articulation::{Joint, System};
use crate::dynamics::{Contacts, Dynamics, PositionStep};
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
    /// No limits of any joint.
    no_limits: Vec<Vec<usize>>,
    /// Bodies after the update.
    update: Vec<RigidBody>,
    /// Pieces that the rule would bring beyond a limit.
    beyond: Vec<bool>,
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
            no_limits: vec![Vec::new(); joint_limits.len()],
            joint_limits,
            free_limits,
            update: dynamics.bodies.clone(),
            beyond: vec![false; dynamics.bodies.len()],
        }
    }

    /// Closes by the rule, with the control c, the joints of each piece that is held in one place: one traversal. A piece
    /// that is held in several places, or would go beyond a limit, is left as it is.
    pub fn adjust_by_rule(
        &mut self,
        step: &mut PositionStep,
        grabs: &[GrabTarget],
        targets: &[f64],
        control: f64,
    ) -> SolveReport {
        self.begin(step, grabs);
        self.update.copy_from_slice(step.bodies);
        let (bodies, system, contacts) = (&mut *step.bodies, &mut *step.system, &*step.contacts);
        let mut configuration = Configuration { bodies, frames: &mut self.frames, system, contacts, targets, control };
        for walk in self.walks.lone() {
            traverse(&mut configuration, &self.walks, walk, grabs, &self.no_limits);
            if walk.start == Start::Free {
                keep_momentum(&mut configuration, self.walks.visits(walk), &self.update);
            }
        }
        self.beyond.fill(false);
        for bound in 0..contacts.bound_count() {
            let (gap, ends) = contacts.bound(bound, bodies);
            if gap < -POSITION_TOLERANCE {
                let free = ends.iter().flatten().filter(|(body, _)| !system.kinematic()[*body]);
                free.for_each(|(body, _)| self.beyond[self.walks.piece(*body)] = true);
            }
        }
        for (body, state) in bodies.iter_mut().enumerate() {
            if !system.kinematic()[body] && self.beyond[self.walks.piece(body)] {
                *state = self.update[body];
            }
        }
        system.evaluate(bodies);
        SolveReport {
            passes: 1,
            residual: system.largest_residual(targets),
            beyond: contacts.largest_violation(bodies),
            grab_error: largest_grab_error(grabs, bodies),
        }
    }

    /// Walks and frames of the present state.
    fn begin(&mut self, step: &PositionStep, grabs: &[GrabTarget]) {
        let mass = |body: usize| step.bodies[body].properties.mass;
        self.walks.rebuild(step.system, mass, grabs.iter().map(|grab| grab.body));
        for (frame, body) in self.frames.iter_mut().zip(step.bodies.iter()) {
            *frame = matrix(body.rotation);
        }
    }

    /// Closes the joints after an update by sweeps from every anchor in turn.
    pub fn adjust(&mut self, step: &mut PositionStep, grabs: &[GrabTarget], targets: &[f64]) -> SolveReport {
        self.begin(step, grabs);
        let (bodies, system, contacts) = (&mut *step.bodies, &mut *step.system, &*step.contacts);
        let mut report = SolveReport::default();
        let (mut before, mut perturbed) = (f64::INFINITY, false);
        for sweep in 0..MAX_SWEEPS {
            self.sweep(bodies, system, contacts, grabs, targets);
            system.evaluate(bodies);
            report = SolveReport {
                passes: sweep as u32 + 1,
                residual: system.largest_residual(targets),
                beyond: contacts.largest_violation(bodies),
                grab_error: largest_grab_error(grabs, bodies),
            };
            let open = report.residual.max(report.beyond).max(report.grab_error);
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

    /// Does a hand hold a piece that nothing else holds?
    pub fn has_lone_grab(&mut self, step: &PositionStep, grabs: &[GrabTarget]) -> bool {
        self.begin(step, grabs);
        self.walks.lone().any(|walk| matches!(walk.start, Start::Grab(_)))
    }

    /// The bodies that the rule has placed, but for those that a hand alone holds: its speed is in their displacement.
    pub fn closed_by_rule(&self) -> impl Iterator<Item = usize> {
        let placed = |walk: &&Walk| !matches!(walk.start, Start::Grab(_)) && !self.beyond[walk.piece];
        self.walks.lone().filter(placed).flat_map(|walk| self.walks.visits(walk)).map(|visit| visit.body)
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
    ) {
        if system.coupled().next().is_some() {
            system.evaluate(bodies);
        }
        let system = &*system;
        let mut configuration =
            Configuration { bodies, frames: &mut self.frames, system, contacts, targets, control: DEFAULT_CONTROL };
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
            close_loop(&mut configuration, joint, &self.joint_limits[joint]);
        }
        let (walks, joint_limits) = (&self.walks, &self.joint_limits);
        let grab = |walk: &&Walk| matches!(walk.start, Start::Grab(_));
        for walk in walks.walks.iter().filter(grab).chain(walks.walks.iter().filter(|walk| !grab(walk))) {
            traverse(&mut configuration, walks, walk, grabs, joint_limits);
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
    joint_limits: &[Vec<usize>],
) {
    let visits = walks.visits(walk);
    let first = visits[0];
    match walk.start {
        Start::Ground { joint } => {
            let group = group(configuration, visits, &first);
            configuration.close(joint, first.body, &group, &joint_limits[joint]);
        }
        Start::Grab(index) => {
            let grab = &grabs[index];
            let at = grab.world_point(configuration.bodies);
            let group = group(configuration, visits, &first);
            configuration.pull(first.body, (at, grab.target - at), &group, &[]);
        }
        Start::Free => place_root(configuration, walks, walk),
    }
    for visit in &visits[1..] {
        if let Some(joint) = visit.joint {
            let group = group(configuration, visits, visit);
            configuration.close(joint, visit.body, &group, &joint_limits[joint]);
        }
    }
}

/// The group of a visit: its body, with the mass of each group beyond at the point of its joint.
fn group(configuration: &Configuration, visits: &[Visit], visit: &Visit) -> Group {
    let (from, until) = visit.next;
    let load = |group: Group, next: &Visit| {
        let joint = next.joint.map(|joint| &configuration.system.joints()[joint]);
        let pull = joint.and_then(|joint| configuration.first_pull(joint, visit.body));
        group.with_load(next.group_mass, pull.map_or(configuration.bodies[next.body].position, |(at, _)| at))
    };
    visits[from..until].iter().fold(configuration.alone(visit.body), load)
}

/// Places the root of a free piece: the mean of its positions joined with each neighbour alone.
fn place_root(configuration: &mut Configuration, walks: &Walks, walk: &Walk) {
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
        if let Some((at, s)) = configuration.first_pull(joint, root) {
            let common = common_point((mass, at), (visit.group_mass, at + s));
            configuration.pull(root, (at, common - at), &configuration.alone(root), &[]);
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

/// Moves a free piece as one rigid body so that the displacements since the update have neither momentum nor angular momentum: its own
/// joints can give it none.
fn keep_momentum(configuration: &mut Configuration, visits: &[Visit], update: &[RigidBody]) {
    let point = |visit: &Visit| {
        let body = &configuration.bodies[visit.body];
        (body.properties.mass, body.position)
    };
    let (mass, center) = point(&visits[0]);
    let first = Group { mass, center, inertia: DMat3::ZERO };
    let whole = visits[1..].iter().map(point).fold(first, |group, (mass, point)| group.with_load(mass, point));
    let (mut inertia, mut momentum, mut angular_momentum) = (whole.inertia, DVec3::ZERO, DVec3::ZERO);
    for visit in visits {
        let (before, after) = (&update[visit.body], &configuration.bodies[visit.body]);
        let (own, displacement) = (configuration.inertia(visit.body), after.position - before.position);
        inertia += own;
        momentum += after.properties.mass * displacement;
        angular_momentum += after.properties.mass * (after.position - whole.center).cross(displacement)
            + own * rotation_between(before, after);
    }
    let (shift, rotation_vector) = (-momentum / whole.mass, -(inertia.inverse() * angular_momentum));
    // Points on one line have no inertia about it, and cannot rotate there.
    let rotation_vector = if rotation_vector.is_finite() { rotation_vector } else { DVec3::ZERO };
    let rotation = matrix(soffio_math::rotation(rotation_vector));
    for visit in visits {
        let arm = configuration.bodies[visit.body].position - whole.center;
        configuration.displace(visit.body, shift + rotation * arm - arm, rotation_vector);
    }
}

/// Rotation vector from one state of a body to another, the shorter way, rad.
fn rotation_between(from: &RigidBody, to: &RigidBody) -> DVec3 {
    let rotation = to.rotation * from.rotation.conjugate();
    soffio_math::rotation_vector(if rotation.w < 0.0 { -rotation } else { rotation })
}

/// Closes a joint between two free bodies at their common point.
fn close_loop(configuration: &mut Configuration, joint: usize, joint_limits: &[usize]) {
    let system = configuration.system;
    let link = system.joints()[joint].link;
    let Some(b) = link.b else { return };
    let masses = [link.a, b].map(|body| configuration.bodies[body].properties.mass);
    if let Some((at, s)) = configuration.first_pull(&system.joints()[joint], link.a) {
        let common = common_point((masses[0], at), (masses[1], at + s));
        configuration.pull(link.a, (at, common - at), &configuration.alone(link.a), &[]);
    }
    configuration.close(joint, b, &configuration.alone(b), joint_limits);
}

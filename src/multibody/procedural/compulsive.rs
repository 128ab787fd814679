//! The source's adjustment of a whole figure (method 3.4, 3.5): passes from what is fixed, outwards, joint by joint.
//!
//! A pass closes each joint by moving the body beyond it, which stands for its group: its own shape, the mass of
//! everything behind it. So one pass closes a tree that is held in one place. Held in several places (an anchor and a
//! hand, two nails) a piece is passed from each in turn, ignoring the others, until all hold. What is held free is placed
//! first: each neighbour j and the root i alone would meet at a common point, which gives i a place; the root takes the
//! mean of those places, weighted with the groups' masses.
//!
//! Couplings, joints that close loops, and limits between bodies that no joint connects are spread over their bodies
//! by mass after each round of passes. Rounds end when everything is closed, when they no longer help (what is asked is
//! impossible), or after [`MOST_ROUNDS`]; the last pass starts at the ground, so that what is nailed stays so and a
//! grip out of reach is missed by the rest.

use super::grip::{Grip, MOST_GRIPS, REACHED, Reach};
use super::pair::Stage;
use super::rule::{Turning, common_point};
use super::walk::{Start, Walk, Walks};
use crate::articulation::{Joint, System};
use crate::dynamics::{Contacts, Dynamics, PositionStep, SweptContact};
use soffio_geometry::bodies::RigidBody;
use soffio_math::spatial::matrix;
use soffio_math::{DMat3, DVec3, tangents};

/// Rounds of relaxation at most.
pub const MOST_ROUNDS: usize = 200;
/// Rounds after which the farthest miss must have shrunk to [`LEAST_GAIN`] of what it was, or else it never will be met.
const PATIENCE: usize = 16;
const LEAST_GAIN: f64 = 0.98;
/// A nudge, rad.
const NUDGE: f64 = 0.2;

/// The source's way to close joints.
#[derive(Clone, Debug)]
pub(super) struct Compulsive {
    walks: Walks,
    frames: Vec<DMat3>,
    /// Limits between the two bodies of each joint, and the others.
    bounds: Vec<Vec<usize>>,
    strays: Vec<usize>,
}

impl Compulsive {
    pub fn new(dynamics: &Dynamics) -> Self {
        let (system, contacts) = (dynamics.system_without_trains(), dynamics.contacts());
        let mut bounds = vec![Vec::new(); system.joints().len()];
        let mut strays = Vec::new();
        for bound in 0..contacts.bound_count() {
            let [a, b] = contacts.bound_bodies(bound);
            let between = |joint: &Joint| {
                let link = (Some(joint.link.a), joint.link.b);
                link == (a, b) || link == (b, a)
            };
            match system.joints().iter().position(between) {
                Some(joint) => bounds[joint].push(bound),
                None => strays.push(bound),
            }
        }
        Self {
            walks: Walks::new(system, dynamics.bodies.len(), MOST_GRIPS),
            frames: vec![DMat3::IDENTITY; dynamics.bodies.len()],
            bounds,
            strays,
        }
    }

    /// Closes the joints of bodies where an update left them; with a first round by the source's rule where it has a
    /// control.
    pub fn adjust(&mut self, moved: &mut PositionStep, grips: &[Grip], left: &[f64], control: Option<f64>) -> Reach {
        let (bodies, system, contacts) = (&mut *moved.bodies, &mut *moved.system, &*moved.contacts);
        self.walks.lay_out(system, |body| bodies[body].properties.mass, grips.iter().map(|grip| grip.body));
        for (frame, body) in self.frames.iter_mut().zip(bodies.iter()) {
            *frame = matrix(body.rotation);
        }
        let mut reach = Reach::default();
        let (mut before, mut nudged) = (f64::INFINITY, false);
        for round in 0..MOST_ROUNDS {
            let turning = control.filter(|_| round == 0).map_or(Turning::Reach, Turning::Compulsive);
            self.round(bodies, system, contacts, grips, left, turning);
            system.evaluate(bodies);
            reach = Reach { passes: round as u32 + 1, residual: system.open_by(left), missed: farthest(grips, bodies) };
            let open = reach.residual.max(reach.missed).max(self.passed(contacts, bodies));
            if open <= REACHED {
                break;
            }
            if round % PATIENCE == PATIENCE - 1 {
                let stuck = open > LEAST_GAIN * before;
                if stuck && nudged {
                    break;
                }
                if stuck {
                    self.nudge(bodies);
                    nudged = true;
                }
                before = open;
            }
        }
        reach
    }

    /// Moves what met out along the normal: the bodies themselves, two free ones in inverse proportion to their masses; a
    /// limit by its row.
    pub fn back_up(&mut self, met: &SweptContact, system: &System, contacts: &Contacts, bodies: &mut [RigidBody]) {
        let masses = met.bodies.map(|body| body.filter(|&b| !system.driven()[b]).map(|b| bodies[b].properties.mass));
        if met.colliders.is_none() {
            let mut stage = Stage { bodies, frames: &mut self.frames, system, contacts, left: &[] };
            stage.spread(met.ends.into_iter().flatten(), met.depth);
            return;
        }
        let shares = match masses {
            [Some(a), Some(b)] => [b / (a + b), -a / (a + b)],
            [a, b] => [f64::from(a.is_some()), -f64::from(b.is_some())],
        };
        for (body, share) in met.bodies.into_iter().zip(shares) {
            if let Some(body) = body {
                bodies[body].position += share * met.depth * met.normal;
            }
        }
    }

    /// How far the worst limit that no joint keeps is passed, m or rad.
    fn passed(&self, contacts: &Contacts, bodies: &[RigidBody]) -> f64 {
        self.strays.iter().fold(0.0, |most: f64, &bound| most.max(-contacts.bound(bound, bodies).0))
    }

    /// Turns the bodies of each walk by little, to and fro: what lies along one line is pulled along its arms, which turns
    /// nothing, so that a straight chain pushed from both ends would never bend.
    fn nudge(&mut self, bodies: &mut [RigidBody]) {
        for walk in &self.walks.walks {
            let visits = self.walks.visits(walk);
            let root = bodies[visits[0].body].position;
            for (k, visit) in visits.iter().enumerate() {
                let body = &mut bodies[visit.body];
                let (t, b) = tangents((body.position - root).try_normalize().unwrap_or(DVec3::NEG_Y));
                let to_and_fro = if k % 2 == 0 { NUDGE } else { -NUDGE };
                body.displace(DVec3::ZERO, to_and_fro * (t + b));
                self.frames[visit.body] = matrix(body.rotation);
            }
        }
    }

    /// A pass from everything that is fixed, grips first, and what no pass closes.
    fn round(
        &mut self,
        bodies: &mut [RigidBody],
        system: &mut System,
        contacts: &Contacts,
        grips: &[Grip],
        left: &[f64],
        turning: Turning,
    ) {
        if system.coupled().next().is_some() {
            system.evaluate(bodies);
        }
        let system = &*system;
        let mut stage = Stage { bodies, frames: &mut self.frames, system, contacts, left };
        for (value, parts) in system.coupled() {
            stage.spread(parts.iter().copied(), -value);
        }
        for &bound in &self.strays {
            let (gap, ends) = contacts.bound(bound, stage.bodies);
            if gap < 0.0 {
                stage.spread(ends.into_iter().flatten(), -gap);
            }
        }
        for &joint in &self.walks.loops {
            meet(&mut stage, joint, turning, &self.bounds[joint]);
        }
        let (walks, bounds) = (&self.walks, &self.bounds);
        let grip = |walk: &&Walk| matches!(walk.start, Start::Grip(_));
        for walk in walks.walks.iter().filter(grip).chain(walks.walks.iter().filter(|walk| !grip(walk))) {
            pass(&mut stage, walks, walk, grips, turning, bounds);
        }
    }
}

/// How far the farthest grip is from its place, m.
pub(super) fn farthest(grips: &[Grip], bodies: &[RigidBody]) -> f64 {
    grips.iter().fold(0.0, |most: f64, grip| most.max(grip.missed(bodies)))
}

/// One pass along a walk.
fn pass(stage: &mut Stage, walks: &Walks, walk: &Walk, grips: &[Grip], turning: Turning, bounds: &[Vec<usize>]) {
    let visits = walks.visits(walk);
    let first = visits[0];
    match walk.start {
        Start::Ground { joint } => stage.close(joint, first.body, (turning, first.group), &bounds[joint]),
        Start::Grip(index) => {
            let grip = &grips[index];
            let at = grip.point_of(stage.bodies);
            let arm = at - stage.bodies[first.body].position;
            stage.pull(first.body, (arm, grip.place - at), (turning, first.group), &[]);
        }
        Start::Free => place_root(stage, walks, walk, turning),
    }
    for visit in &visits[1..] {
        if let Some(joint) = visit.joint {
            stage.close(joint, visit.body, (turning, visit.group), &bounds[joint]);
        }
    }
}

/// Places the root of a free piece: the mean of the places that it would take with each neighbour alone.
fn place_root(stage: &mut Stage, walks: &Walks, walk: &Walk, turning: Turning) {
    let visits = walks.visits(walk);
    let root = visits[0].body;
    let start = stage.bodies[root];
    let (mut way, mut turn, mut weight) = (DVec3::ZERO, DVec3::ZERO, 0.0);
    for visit in &visits[1..] {
        let Some(joint) = visit.joint.map(|joint| &stage.system.joints()[joint]) else { continue };
        if joint.link.a != root && joint.link.b != Some(root) {
            continue;
        }
        let mass = start.properties.mass;
        if let Some((r, s)) = stage.first_pull(joint, root) {
            let at = start.position + r;
            let common = common_point((mass, at), (visit.group, at + s));
            stage.pull(root, (r, common - at), (turning, mass), &[]);
        }
        let there = stage.bodies[root];
        way += visit.group * (there.position - start.position);
        turn += visit.group * turn_of(&start, &there);
        weight += visit.group;
        stage.bodies[root] = start;
        stage.frames[root] = matrix(start.rotation);
    }
    if weight > 0.0 {
        stage.displace(root, way / weight, turn / weight);
    }
}

/// Rotation vector from one state of a body to another, the shorter way round, rad.
fn turn_of(from: &RigidBody, to: &RigidBody) -> DVec3 {
    let turn = to.rotation * from.rotation.conjugate();
    soffio_math::rotation_vector(if turn.w < 0.0 { -turn } else { turn })
}

/// Closes a joint between two free bodies: both go to their common point.
fn meet(stage: &mut Stage, joint: usize, turning: Turning, bounds: &[usize]) {
    let system = stage.system;
    let link = system.joints()[joint].link;
    let Some(b) = link.b else { return };
    let masses = [link.a, b].map(|body| stage.bodies[body].properties.mass);
    if let Some((r, s)) = stage.first_pull(&system.joints()[joint], link.a) {
        let at = stage.bodies[link.a].position + r;
        let common = common_point((masses[0], at), (masses[1], at + s));
        stage.pull(link.a, (r, common - at), (turning, masses[0]), &[]);
    }
    stage.close(joint, b, (turning, masses[1]), bounds);
}

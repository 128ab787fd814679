//! Bodies that move by a kind of their own, and bodies that one grab drags together.

use super::super::behavior::Motion;
use super::super::bodies::Body;
use super::super::diagnostic::Diagnostic;
use super::super::{codes, sidecar};
use super::context::Context;
use soffio_multibody::articulation::{Constraint, Limit, Spring};
use soffio_multibody::procedural::PositionSolver;

/// Largest rotation between the starts of bodies that are dragged together, as the distance of unit quaternions from ±1.
const ALIKE: f64 = 1e-6;

/// Everything that connects the bodies of an exhibit.
pub(super) struct Joined<'a> {
    pub constraints: &'a [Constraint],
    pub limits: &'a [Limit],
    pub springs: &'a [Spring],
}

/// The kind of motion of one body.
pub(super) fn own_motion(given: sidecar::OwnMotion) -> Motion {
    match given {
        sidecar::OwnMotion::Dynamics => Motion::Dynamics,
        sidecar::OwnMotion::Procedural => Motion::PositionBased(PositionSolver::Relaxation),
        sidecar::OwnMotion::PositionBased => Motion::PositionBased(PositionSolver::TreeSolve),
    }
}

/// The kind as the sidecar writes it.
fn written(kind: Option<Motion>) -> &'static str {
    match kind {
        Some(Motion::PositionBased(PositionSolver::Relaxation)) => "moved_by = \"procedural\"",
        Some(Motion::PositionBased(PositionSolver::TreeSolve)) => "moved_by = \"position-based\"",
        Some(_) => "moved_by = \"dynamics\"",
        None => "no moved_by",
    }
}

impl Context<'_> {
    /// Checks that joined bodies move by one kind, and that each kind knows their constraints.
    pub(super) fn check_kinds(&mut self, bodies: &[Body], joined: &Joined) {
        if bodies.iter().all(|body| body.moved_by.is_none()) {
            return;
        }
        self.check_own_kinds(bodies, joined);
        let Joined { constraints, limits, springs } = *joined;
        let constraints = constraints
            .iter()
            .map(|c| (c.name.as_str(), Box::new(|b| c.kind.acts_on(b)) as Box<dyn Fn(usize) -> bool>));
        let limits =
            limits.iter().map(|l| (l.name.as_str(), Box::new(|b| l.kind.acts_on(b)) as Box<dyn Fn(usize) -> bool>));
        let springs =
            springs.iter().map(|s| (s.name.as_str(), Box::new(|b| s.kind.acts_on(b)) as Box<dyn Fn(usize) -> bool>));
        let mut reported: Vec<String> = Vec::new();
        for (name, acts_on) in constraints.chain(limits).chain(springs) {
            let mut free = (0..bodies.len()).filter(|&body| acts_on(body) && !self.is_kinematic(body));
            let Some(first) = free.next() else { continue };
            let Some(other) = free.find(|&other| bodies[other].moved_by != bodies[first].moved_by) else { continue };
            let at = self.place(name);
            if reported.contains(&at) {
                continue;
            }
            let [a, b] = [first, other].map(|body| {
                let Body { name, moved_by, .. } = &bodies[body];
                format!("\"{name}\" ({})", written(*moved_by))
            });
            let problem = Diagnostic::new(codes::MIXED_KINDS, format!("{a} and {b} are joined"));
            self.report(&at, problem.help("bodies that are joined move by one kind: give both the same moved_by"));
            reported.push(at);
        }
    }

    /// Checks each body that has a kind of its own.
    fn check_own_kinds(&mut self, bodies: &[Body], joined: &Joined) {
        for (entry, given) in self.sidecar.body.iter().enumerate() {
            let at = format!("/body/{entry}/moved_by");
            if given.moved_by.is_none() {
                continue;
            }
            let node = self.nodes_named(&given.node).first().copied();
            let Some(body) = self.body_nodes.iter().position(|&own| Some(own) == node) else {
                continue;
            };
            if self.is_kinematic(body) {
                let message = format!("body \"{}\" follows its path or animation, whatever moved_by says", given.node);
                self.report(&at, Diagnostic::new(codes::UNUSED, message).help("leave it out"));
                continue;
            }
            let own = joined.constraints.iter().filter(|constraint| constraint.kind.acts_on(body));
            let springs = joined.springs.iter().filter(|spring| spring.kind.acts_on(body));
            if let Some(Motion::PositionBased(_)) = bodies[body].moved_by
                && let Some(why) = Motion::refusal(own, springs, &[])
            {
                let message = format!("body \"{}\" moves by dynamics alone: {why}", given.node);
                let problem = Diagnostic::new(codes::DYNAMICS_ONLY, message);
                self.report(&at, problem.help("write moved_by = \"dynamics\", or leave it out"));
            }
        }
    }

    /// The lists of bodies that one grab drags.
    pub(super) fn together(&mut self, bodies: &[Body]) -> Vec<Vec<usize>> {
        let sidecar = self.sidecar;
        let mut lists: Vec<Vec<usize>> = Vec::new();
        for (i, names) in sidecar.touch.together.iter().enumerate() {
            let mut list: Vec<usize> = Vec::new();
            for (k, name) in names.iter().enumerate() {
                let at = format!("/touch/together/{i}/{k}");
                let Some(body) = self.draggable(name, &at) else { continue };
                if lists.iter().flatten().chain(&list).any(|&other| other == body) {
                    let problem = Diagnostic::new(codes::DUPLICATE_BODY, format!("\"{name}\" is in a list already"));
                    self.report(&at, problem.help("name each body once"));
                    continue;
                }
                let turned = list.first().is_some_and(|&first| {
                    let dot = bodies[first].pose.rotation.dot(bodies[body].pose.rotation);
                    1.0 - dot.abs() > ALIKE
                });
                if turned {
                    let problem =
                        Diagnostic::new(codes::RANGE, format!("\"{name}\" is turned against \"{}\"", names[0]));
                    self.report(&at, problem.help("bodies that are dragged together stand alike at the start"));
                }
                list.push(body);
            }
            lists.push(list);
        }
        lists
    }

    /// The moving body of this node that a hand may drag.
    fn draggable(&mut self, name: &str, at: &str) -> Option<usize> {
        let body = self.moving_body(name, at, "bodies that are dragged together")?;
        if !self.is_kinematic(body) {
            return Some(body);
        }
        let problem = Diagnostic::new(codes::UNKNOWN_BODY, format!("\"{name}\" follows its path: no hand moves it"));
        self.report(at, problem.help("leave it out"));
        None
    }

    /// The moving body of this node.
    pub(super) fn moving_body(&mut self, name: &str, at: &str, used_for: &str) -> Option<usize> {
        let node = self.node(name, at, used_for)?;
        let body = self.owner[node];
        if body.is_none() {
            let message = format!("node \"{name}\" is not a moving body");
            let problem = Diagnostic::new(codes::UNKNOWN_BODY, message).label(format!("needed for {used_for}"));
            self.report(at, problem.help("make it a [[body]], or name one that moves"));
        }
        body
    }
}

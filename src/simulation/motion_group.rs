//! Bodies that move by a kind of their own (`moved_by` in the sidecar).
//!
//! Each kind has dynamics of its own, of the whole exhibit under the same numbers. Bodies of other kinds stand in it where they
//! began, and no group depends on another: no joint connects two kinds, which is checked when an exhibit is loaded, and no
//! colliders of two kinds are a pair. After a step the exhibit's bodies take over the state of each kind's own.

use super::input::{MotionMode, Settings};
use super::pointer_grabs::PointerGrabs;
use super::rate::DT;
use super::start::start_dynamics_of;
use soffio_exhibit::{Exhibit, Motion};
use soffio_geometry::bodies::RigidBody;
use soffio_math::spatial::Vec6;
use soffio_multibody::articulation::Constraint;
use soffio_multibody::dynamics::{Dynamics, Impact};
use soffio_multibody::procedural::{self, PositionSolver, Procedural};

/// Bodies that move by one kind, with their dynamics.
#[derive(Clone)]
pub(crate) struct MotionGroup {
    mode: MotionMode,
    /// Whether each body is one of the group.
    own: Vec<bool>,
    /// Of the whole exhibit, in which only the group's bodies move.
    pub dynamics: Dynamics,
    procedural: Procedural,
}

impl MotionGroup {
    /// The groups of an exhibit at its start, one for each kind that some of its bodies have.
    pub fn all(exhibit: &Exhibit, settings: &Settings) -> Vec<Self> {
        let mut kinds: Vec<Motion> = Vec::new();
        for kind in exhibit.bodies.iter().filter_map(|body| body.moved_by) {
            if !kinds.contains(&kind) {
                kinds.push(kind);
            }
        }
        kinds.into_iter().map(|kind| Self::new(kind, exhibit, settings)).collect()
    }

    fn new(kind: Motion, exhibit: &Exhibit, settings: &Settings) -> Self {
        let own: Vec<bool> = exhibit.bodies.iter().map(|body| body.moved_by == Some(kind)).collect();
        let dynamics = start_dynamics_of(exhibit, settings, &own);
        let procedural = Procedural::new(&dynamics, procedural::Settings::default());
        Self { mode: MotionMode::by(kind), own, dynamics, procedural }
    }

    /// Whether a body is one of the group.
    pub fn has(&self, body: usize) -> bool {
        self.own[body]
    }

    /// Whether a constraint acts on a body of the group.
    pub fn is_joined_by(&self, constraint: &Constraint) -> bool {
        (0..self.own.len()).any(|body| self.own[body] && constraint.kind.acts_on(body))
    }

    /// Moves the group's bodies for a step, and writes their state to `bodies`. Where that was changed from outside, the group
    /// begins from there. Returns the first body with invalid numbers, if any; the group is then as before.
    pub fn advance(
        &mut self,
        bodies: &mut [RigidBody],
        grabs: &mut PointerGrabs,
        wrenches: &mut [Vec6],
        impacts: &mut Vec<Impact>,
    ) -> Option<usize> {
        let own = |(index, _): &(usize, _)| self.own[*index];
        if bodies.iter().enumerate().filter(own).any(|(index, body)| *body != self.dynamics.bodies[index]) {
            for (index, body) in bodies.iter().enumerate().filter(own) {
                self.dynamics.bodies[index] = *body;
            }
            self.dynamics.disturb();
        }
        let Self { mode, own, dynamics, procedural } = self;
        if *mode == MotionMode::Dynamic {
            grabs.apply_forces(own, dynamics, DT, wrenches);
        }
        let fault = advance(*mode, own, (dynamics, procedural), grabs, wrenches, impacts);
        for (index, body) in bodies.iter_mut().enumerate().filter(|(index, _)| own[*index]) {
            *body = dynamics.bodies[index];
        }
        fault
    }
}

/// Moves the bodies that are `own` by one kind of motion for a step, under wrenches that contain the forces of grabs where it is
/// dynamics. Returns the first body with invalid numbers, if any.
pub(crate) fn advance(
    mode: MotionMode,
    own: &[bool],
    (dynamics, procedural): (&mut Dynamics, &mut Procedural),
    grabs: &mut PointerGrabs,
    wrenches: &[Vec6],
    impacts: &mut Vec<Impact>,
) -> Option<usize> {
    let method = match mode {
        MotionMode::Dynamic => return dynamics.step(DT, wrenches, impacts),
        MotionMode::Procedural => PositionSolver::Relaxation,
        MotionMode::PositionBased => PositionSolver::TreeSolve,
    };
    procedural.settings_mut().method = method;
    let targets = grabs.position_targets(own, &dynamics.bodies, DT);
    procedural.step(dynamics, DT, wrenches, targets, impacts)
}

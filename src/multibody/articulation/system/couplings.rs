//! Constraints that couple turns and ways, from step to step: what trains go on from, clutches that slip and hold, counted turns.

use super::System;
use crate::articulation::{Axis, Measure};
use soffio_geometry::bodies::RigidBody;
use soffio_math::spatial::Vec6;

/// A coupling's row, as a clutch asks for it.
#[derive(Clone, Copy, Debug)]
pub struct Coupled<'a> {
    /// λ: 0 where it does not act.
    pub multiplier: f64,
    /// J by bodies.
    pub parts: &'a [(usize, Vec6)],
}

impl System {
    /// Lets trains go on from where these bodies were put.
    pub fn begin_trains(&mut self, bodies: &[RigidBody]) {
        if !self.has_trains() {
            return;
        }
        self.quads.look(bodies);
        self.factor.trains.begin(&self.quads);
        for (gauge, _) in self.rows.couplings.iter().flat_map(|coupling| &coupling.terms) {
            if let Measure::Angle { axis: Axis { body: Some(body), direction }, frame: None } = gauge.measure {
                self.factor.trains.turned(body, bodies[body].rotation * direction, gauge.total(bodies));
            }
        }
        self.factor.trains.go_on(&self.quads);
        // What was turned by more than half a turn in a step has been miscounted.
        for (gauge, _) in self.rows.couplings.iter_mut().flat_map(|coupling| &mut coupling.terms) {
            if let Measure::Angle { axis: Axis { body: Some(body), direction }, frame: None } = gauge.measure
                && let Some(turn) = self.factor.trains.turn_of(body, bodies[body].rotation * direction)
            {
                gauge.expect(bodies, turn);
            }
        }
    }

    /// Takes over what another system of the same constraints knows of its run: windows and breaks, and counted turns.
    pub fn exchange_run(&mut self, other: &mut Self) {
        std::mem::swap(&mut self.activity, &mut other.activity);
        for (own, others) in self.rows.couplings.iter_mut().zip(&mut other.rows.couplings) {
            std::mem::swap(&mut own.terms, &mut others.terms);
            std::mem::swap(&mut own.offset, &mut others.offset);
        }
    }

    /// What a coupling was found to be at the last evaluation, and carried in the last solve.
    ///
    /// # Panics
    /// Where the constraint is no coupling.
    pub fn coupling(&self, constraint: usize) -> Coupled<'_> {
        let found = self.rows.couplings.iter().find(|coupling| coupling.constraint == constraint);
        let Some(coupling) = found else { panic!("constraint {constraint} is no coupling") };
        let multiplier = if self.activity.share(constraint) > 0.0 { self.lambda[coupling.at] } else { 0.0 };
        Coupled { multiplier, parts: &self.factor.outside()[coupling.outside].parts }
    }

    /// Lets a clutch slip.
    pub fn let_slip(&mut self, constraint: usize) {
        self.activity.slip(constraint, true);
    }

    /// Lets a clutch hold where the bodies are.
    pub fn take_hold(&mut self, constraint: usize, bodies: &[RigidBody]) {
        self.activity.slip(constraint, false);
        for coupling in self.rows.couplings.iter_mut().filter(|coupling| coupling.constraint == constraint) {
            coupling.offset = coupling.terms.iter().map(|(gauge, c)| c * gauge.total(bodies)).sum();
        }
    }

    /// Counts the turns of couplings up to this state; once a step.
    pub fn count_turns(&mut self, bodies: &[RigidBody]) {
        let outside = self.factor.outside();
        for coupling in &mut self.rows.couplings {
            if outside[coupling.outside].sleeps(&self.sleepers.bodies) {
                continue;
            }
            for (gauge, _) in &mut coupling.terms {
                gauge.count(bodies);
            }
        }
    }
}

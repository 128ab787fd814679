//! State of couplings from step to step: train angles, clutches, counted revolutions.

use super::System;
use crate::articulation::{Axis, Measure};
use soffio_geometry::bodies::RigidBody;
use soffio_math::spatial::Vec6;

/// Row of a coupling.
#[derive(Clone, Copy, Debug)]
pub struct Coupled<'a> {
    /// λ; 0 where it is inactive.
    pub multiplier: f64,
    /// J: each body that it touches, with the block on it.
    pub parts: &'a [(usize, Vec6)],
}

impl System {
    /// Starts gear trains from the state of these bodies.
    pub fn start_trains(&mut self, bodies: &[RigidBody]) {
        if !self.has_trains() {
            return;
        }
        self.lane_blocks.load(bodies);
        self.factor.trains.start_at(&self.lane_blocks);
        for (gauge, _) in self.rows.couplings.iter().flat_map(|coupling| &coupling.terms) {
            if let Measure::Angle { axis: Axis { body: Some(body), direction }, frame: None } = gauge.measure {
                self.factor.trains.set_angle(body, bodies[body].rotation * direction, gauge.total(bodies));
            }
        }
        self.factor.trains.resume_count(&self.lane_blocks);
        // A rotation of more than half a revolution in one step has been miscounted.
        for (gauge, _) in self.rows.couplings.iter_mut().flat_map(|coupling| &mut coupling.terms) {
            if let Measure::Angle { axis: Axis { body: Some(body), direction }, frame: None } = gauge.measure
                && let Some(angle) = self.factor.trains.angle_of(body, bodies[body].rotation * direction)
            {
                gauge.set_nearest_count(bodies, angle);
            }
        }
    }

    /// Swaps the history with another system of the same constraints: schedules, breaks and counted revolutions.
    pub fn swap_history(&mut self, other: &mut Self) {
        std::mem::swap(&mut self.activity, &mut other.activity);
        for (own, others) in self.rows.couplings.iter_mut().zip(&mut other.rows.couplings) {
            std::mem::swap(&mut own.terms, &mut others.terms);
            std::mem::swap(&mut own.offset, &mut others.offset);
        }
    }

    /// Row of a coupling at the last evaluation, and its multiplier of the last solve.
    ///
    /// # Panics
    /// Where the constraint is no coupling.
    pub fn coupling(&self, constraint: usize) -> Coupled<'_> {
        let found = self.rows.couplings.iter().find(|coupling| coupling.constraint == constraint);
        let Some(coupling) = found else { panic!("constraint {constraint} is no coupling") };
        let multiplier = if self.activity.activation(constraint) > 0.0 { self.lambda[coupling.at] } else { 0.0 };
        Coupled { multiplier, parts: &self.factor.outside()[coupling.outside].parts }
    }

    /// Lets a clutch slip: its row is inactive.
    pub fn let_slip(&mut self, constraint: usize) {
        self.activity.set_slipping(constraint, true);
    }

    /// Lets a clutch stick at the bodies' present state.
    pub fn let_stick(&mut self, constraint: usize, bodies: &[RigidBody]) {
        self.activity.set_slipping(constraint, false);
        for coupling in self.rows.couplings.iter_mut().filter(|coupling| coupling.constraint == constraint) {
            coupling.offset = coupling.terms.iter().map(|(gauge, c)| c * gauge.total(bodies)).sum();
        }
    }

    /// Counts the revolutions of couplings up to this state; once a step.
    pub fn count_revolutions(&mut self, bodies: &[RigidBody]) {
        let outside = self.factor.outside();
        for coupling in &mut self.rows.couplings {
            if outside[coupling.outside].sleeps(&self.sleep_state.bodies) {
                continue;
            }
            for (gauge, _) in &mut coupling.terms {
                gauge.count(bodies);
            }
        }
    }
}

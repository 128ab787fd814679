//! What of a figure sleeps (`dynamics/sleep.rs`), as its system sees it.

use crate::articulation::Constraint;
use crate::articulation::trains::Trains;
use soffio_math::DMat3;

/// Bodies and constraints that are left out.
#[derive(Clone, Debug)]
pub(super) struct Sleepers {
    /// Which bodies sleep, and those of them that the tree may go through all the same.
    pub bodies: Vec<bool>,
    pub still: Vec<usize>,
    /// Which constraints are between such, and the largest error of a length among them, m.
    pub constraints: Vec<bool>,
    pub gap: f64,
    /// Room for that search: a matrix a body.
    pub frames: Vec<DMat3>,
}

impl Sleepers {
    /// Nobody sleeps.
    pub fn new(bodies: usize, constraints: usize) -> Self {
        Self {
            bodies: vec![false; bodies],
            still: Vec::with_capacity(bodies),
            constraints: vec![false; constraints],
            gap: 0.0,
            frames: vec![DMat3::IDENTITY; bodies],
        }
    }

    /// Sets which bodies sleep.
    pub fn set(&mut self, asleep: &[bool], constraints: &[Constraint], trains: &Trains) {
        self.bodies.copy_from_slice(asleep);
        for (idle, constraint) in self.constraints.iter_mut().zip(constraints) {
            *idle = (0..asleep.len()).any(|body| asleep[body] && constraint.kind.touches(body));
        }
        self.still.clear();
        self.still.extend((0..asleep.len()).filter(|&body| asleep[body] && !trains.has(body)));
    }
}

//! Sleeping bodies and constraints, as the system sees them (`dynamics/sleep.rs`).

use crate::articulation::Constraint;
use crate::articulation::trains::Trains;
use soffio_math::DMat3;

/// Sleeping bodies and constraints, which evaluation and solves skip.
#[derive(Clone, Debug)]
pub(super) struct SleepState {
    /// Does each body sleep?
    pub bodies: Vec<bool>,
    /// The sleeping bodies that tree sweeps may still visit.
    pub tree_bodies: Vec<usize>,
    /// Does each constraint sleep?
    pub constraints: Vec<bool>,
    /// Largest position error of the sleeping constraints, m.
    pub gap: f64,
    /// Scratch for that error: a matrix a body.
    pub frames: Vec<DMat3>,
}

impl SleepState {
    /// All awake.
    pub fn new(bodies: usize, constraints: usize) -> Self {
        Self {
            bodies: vec![false; bodies],
            tree_bodies: Vec::with_capacity(bodies),
            constraints: vec![false; constraints],
            gap: 0.0,
            frames: vec![DMat3::IDENTITY; bodies],
        }
    }

    /// Sets which bodies sleep.
    pub fn set(&mut self, asleep: &[bool], constraints: &[Constraint], trains: &Trains) {
        self.bodies.copy_from_slice(asleep);
        for (sleeps, constraint) in self.constraints.iter_mut().zip(constraints) {
            *sleeps = (0..asleep.len()).any(|body| asleep[body] && constraint.kind.acts_on(body));
        }
        self.tree_bodies.clear();
        self.tree_bodies.extend((0..asleep.len()).filter(|&body| asleep[body] && !trains.has(body)));
    }
}

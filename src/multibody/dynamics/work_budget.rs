//! Work budget: bounds the operations of a step, so that it always ends in time.
//!
//! Event-driven impacts and resting contacts ask for further passes over the bodies; with many contacts these would not end. So a
//! step counts its operations. When a further substep would exceed the budget, the rest of the step is integrated by Moreau's time
//! stepping (`contacts/time_stepping.rs`): one pass a substep, as long as the joints' error and the spin allow.
//!
//! Operations are counted instead of time, so that a run is the same on every machine. The costs below were measured by counting
//! instructions of towers, heaps and pegs; they need to be right to a factor of two. One solve of the contact problem has bounds of
//! its own (`contacts/contact_solver.rs`).

/// Operations of a step, except for the substep that exceeds them: one to two milliseconds of a processor of 2020.
const STEP_OPERATIONS: u64 = 3_000_000;
/// Operations of a pass over one body with its joints.
const BODY_OPERATIONS: u64 = 4_000;
/// Operations to assemble one contact.
pub(super) const CONTACT_OPERATIONS: u64 = 2_500;
/// Operations of one contact in a Newton step, without the factorization.
pub(super) const NEWTON_CONTACT_OPERATIONS: u64 = 1_500;
/// Operations of one contact in a Gauss–Seidel sweep.
pub(super) const SWEEP_CONTACT_OPERATIONS: u64 = 500;
/// Passes of a substep with contacts, about: one to find the forces, one under them, one cut at an impact.
const PASSES: u64 = 3;

/// Operations of the present step.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct WorkBudget {
    spent: u64,
    /// Of the last pass; at first half of the largest one of the step before.
    pass: u64,
    largest_pass: u64,
}

impl WorkBudget {
    /// Begins a step.
    pub fn begin_step(&mut self) {
        *self = Self { spent: 0, pass: self.largest_pass.max(self.pass) / 2, largest_pass: 0 };
    }

    /// Records a pass over so many bodies with so many operations of contacts.
    pub fn record_pass(&mut self, bodies: usize, contact_operations: u64) {
        self.pass = bodies as u64 * BODY_OPERATIONS + contact_operations;
        self.largest_pass = self.largest_pass.max(self.pass);
        self.spent += self.pass;
    }

    /// Operations of the step so far.
    pub fn spent(&self) -> u64 {
        self.spent
    }

    /// Whether a further substep with all its passes would exceed the budget.
    pub fn is_exhausted(&self) -> bool {
        self.spent + PASSES * self.pass > STEP_OPERATIONS
    }
}

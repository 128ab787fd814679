//! How much a step has done, so that it never does too much.
//!
//! A step follows every impact at its own time and every contact until its forces are right: each asks for another pass over the
//! bodies. Where many things touch, that would have no end. So a step counts its work, and when a pass more would be too
//! much the rest of it goes in substeps in which impacts and resting contact are solved together (`contacts/together.rs`), each
//! gone through once and as long as the joints' error and the spin allow.
//!
//! Work is counted in operations, not in time: the same run takes the same way on every machine. The numbers were measured by
//! counting instructions of towers, heaps and pegs; they need to be right to a factor of two. One solve of the contact problem
//! has bounds of its own (`contacts/newton.rs`).

/// Operations of a step, at most, but for the substep that ends it: one to two milliseconds of a processor of 2020.
const STEP_OPERATIONS: u64 = 3_000_000;
/// Operations of a pass over one body with its joints, of a touch with its points, of a touch in a step of Newton's method beside the factor, and
/// in a sweep.
const BODY_OPERATIONS: u64 = 4_000;
pub(super) const CONTACT_OPERATIONS: u64 = 2_500;
pub(super) const NEWTON_CONTACT_OPERATIONS: u64 = 1_500;
pub(super) const SWEEP_CONTACT_OPERATIONS: u64 = 500;
/// Passes that a substep with contacts takes, about: it is looked at, put right, and cut at an impact.
const PASSES: u64 = 3;

/// The work of a step.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct WorkBudget {
    spent: u64,
    /// Of the last pass, and of the dearest one of the step before.
    pass: u64,
    largest_pass: u64,
}

impl WorkBudget {
    /// Begins a step.
    pub fn begin_step(&mut self) {
        *self = Self { spent: 0, pass: self.largest_pass.max(self.pass) / 2, largest_pass: 0 };
    }

    /// Notes a pass over so many bodies, and so many operations of contacts.
    pub fn record_pass(&mut self, bodies: usize, contacts: u64) {
        self.pass = bodies as u64 * BODY_OPERATIONS + contacts;
        self.largest_pass = self.largest_pass.max(self.pass);
        self.spent += self.pass;
    }

    /// Operations of the step so far.
    pub fn spent(&self) -> u64 {
        self.spent
    }

    /// Would a substep with all its passes be too much?
    pub fn is_exhausted(&self) -> bool {
        self.spent + PASSES * self.pass > STEP_OPERATIONS
    }
}

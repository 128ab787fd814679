//! Events: what happened at a moment, for logs, sounds and triggers.

use crate::math::DVec3;

/// Kind of an event.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EventKind {
    /// Two bodies hit.
    Impact,
    /// Two bodies come to lie against each other.
    Rest,
    /// Bad numbers were found and the figure restored.
    Fault,
}

impl EventKind {
    /// Its name in event logs.
    pub fn name(self) -> &'static str {
        match self {
            Self::Impact => "impact",
            Self::Rest => "rest",
            Self::Fault => "fault",
        }
    }
}

/// What happened at a moment.
#[derive(Clone, Debug, PartialEq)]
pub struct Event {
    /// Seconds since the run began.
    pub t: f64,
    /// round(48000 t).
    pub sample: u64,
    /// Kind.
    pub kind: EventKind,
    /// Bodies by index; `None` is the world.
    pub bodies: [Option<usize>; 2],
    /// World, m.
    pub point: DVec3,
    /// Unit, from the second body to the first.
    pub normal: DVec3,
    /// N s.
    pub impulse: f64,
    /// Approach speed, m/s.
    pub speed: f64,
}

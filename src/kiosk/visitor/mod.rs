//! The visitor: pointer, touch and keys as aim, breath, hands and requests, and what this visitor needs otherwise.
//!
//! Pure state machines: they never draw, never read a device and never keep anything about a person beyond the visit.

pub mod dwell;
pub mod gesture;
pub(crate) mod given;
pub mod input;
pub mod needs;
pub mod orbit;

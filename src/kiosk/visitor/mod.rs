//! The visitor: pointer, touch and keys become aim, breath, grabs and requests. Also the visitor's accessibility settings.
//!
//! Pure state machines: they never draw, never read a device, and store nothing about a person beyond the visit.

pub mod accessibility;
pub(crate) mod breath_time;
pub mod dwell;
pub mod gesture;
pub mod input;
pub mod orbit;

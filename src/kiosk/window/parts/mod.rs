//! Parts of the window thread's state, one for each concern, independent of each other.

pub(super) mod desk;
pub(super) mod exhibits;
pub(super) mod graphics;
pub(super) mod lifecycle;
pub(super) mod overlays;
pub(super) mod pacing;
pub(super) mod setup;
pub(super) mod visit;

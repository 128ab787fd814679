//! What the window thread owns, each concern a part of its own: none of them knows another.

pub(super) mod desk;
pub(super) mod graphics;
pub(super) mod life;
pub(super) mod overlaid;
pub(super) mod pacing;
pub(super) mod setup;
pub(super) mod visit;
pub(super) mod works;

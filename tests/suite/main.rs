//! The test suite: one binary, one module per room.

mod architecture;
mod articulation;
mod blow;
mod dynamics;
mod forge;
mod kiosk;
#[cfg(feature = "kiosk")]
mod pictures;
#[cfg(feature = "kiosk")]
mod shaders;
mod sound;

//! The test suite: one binary, one module per room.

#[cfg(feature = "kiosk")]
mod pictures;
#[cfg(feature = "kiosk")]
mod shaders;

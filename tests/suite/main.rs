//! The test suite: one binary, one module per room.

mod architecture;
mod articulation;
mod blow;
mod cli;
mod collision;
mod dynamics;
mod exhibit;
mod forge;
mod kiosk;
mod motion;
#[cfg(feature = "kiosk")]
mod pictures;
mod realtime;
mod scene;
#[cfg(feature = "kiosk")]
mod shaders;
mod sound;
mod steel_fish;
mod wind;

//! The test suite: one binary, one module per room.

mod architecture;
mod articulation;
mod blow;
mod cabinet;
mod chimes;
mod cli;
mod clock;
mod collision;
mod contacts;
mod curator;
#[cfg(feature = "kiosk")]
mod details;
mod dynamics;
mod escapement;
mod exhibit;
mod exhibits_in_motion;
mod expected;
mod exports;
mod forge;
mod fuzz;
mod gather;
mod hands;
mod hits;
mod kiosk;
mod loudness;
mod mobiles;
mod modal;
mod models;
mod motion;
#[cfg(feature = "kiosk")]
mod penumbrae;
#[cfg(feature = "kiosk")]
mod picture_bars;
#[cfg(feature = "kiosk")]
mod pictures;
mod privacy;
mod procedural;
mod realtime;
#[cfg(feature = "kiosk")]
mod rehearsal;
mod repeatable;
mod robust;
mod scene;
#[cfg(feature = "kiosk")]
mod shaders;
mod shapes;
#[cfg(feature = "kiosk")]
mod skins;
mod sound;
mod space;
mod spheres;
mod steel_fish;
mod systems;
mod wind;

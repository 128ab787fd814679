//! The test suite: one binary, one module per subject.

mod architecture;
mod assembly;
mod breath_command;
mod budget;
mod cabinet;
mod cart;
mod chimes;
mod cli;
mod clock;
mod cloth;
mod curator;
#[cfg(feature = "kiosk")]
mod details;
mod documents;
mod exhibit;
mod exhibits_in_motion;
mod exports;
mod expressions;
mod finishes;
mod fuzz;
mod geared;
mod harp;
mod kiosk;
mod loudness;
mod mobiles;
mod models;
mod old_names;
#[cfg(feature = "kiosk")]
mod penumbrae;
#[cfg(feature = "kiosk")]
mod picture_bars;
#[cfg(feature = "kiosk")]
mod pictures;
mod pointer_grabs;
mod privacy;
mod procedural;
mod realtime;
#[cfg(feature = "kiosk")]
mod rehearsal;
#[cfg(feature = "kiosk")]
mod require;
mod robust;
mod scene;
#[cfg(feature = "kiosk")]
mod shaders;
mod shapes;
#[cfg(feature = "kiosk")]
mod skins;
mod sound;
mod steel_fish;
mod systems;
mod three_motions;
mod untrusted;
mod walker;
mod wind;

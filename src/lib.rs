//! Soffio: sculptures that hang in virtual air and answer a visitor's breath.
//!
//! The modules in order of knowledge; each may import only what stands above it (a test scans for this):
//!
//! ```text
//! math, noise → geometry → bodies → collision, articulation → dynamics | wind | sound → procedural → exhibit → simulation
//!             → config → audio_io | controllers | render → offline → kiosk → rehearsal → commands
//! ```
//!
//! Everything down to `simulation` is pure and deterministic: no clock, file (but `exhibit`'s loader), device,
//! environment or hash-ordered map. Live and offline differ only in who fills [`simulation::StepInput`] and who
//! calls [`sound::Synth::render`].

pub mod articulation;
pub mod bodies;
pub mod collision;
pub mod commands;
pub mod config;
pub mod dynamics;
pub mod exhibit;
pub mod geometry;
pub mod math;
pub mod noise;
pub mod offline;
pub mod procedural;
pub mod simulation;
pub mod sound;
pub mod wind;

#[cfg(feature = "kiosk")]
pub mod audio_io;
#[cfg(feature = "kiosk")]
pub mod controllers;
#[cfg(feature = "kiosk")]
pub mod kiosk;
#[cfg(feature = "kiosk")]
pub mod rehearsal;
#[cfg(feature = "kiosk")]
pub mod render;

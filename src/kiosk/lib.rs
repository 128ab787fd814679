//! The live kiosk: window, visitor, attract mode, staff.
//!
//! Two threads. The simulation thread ([`live`]) owns everything that moves and keeps the time; the window
//! ([`window`]) draws the latest two moments and passes on what the visitor does. What a step does is in [`stage`],
//! which knows no clock and no device, so that tests and recordings run exactly what visitors see.

pub mod aloud;
pub mod attract;
pub mod bidi;
pub mod breaths;
pub mod captions;
pub mod care;
pub mod chirp;
pub mod chirping;
pub mod drift;
pub mod dwell;
pub mod edit;
pub mod events;
pub mod fleet;
pub mod fonts;
pub mod gesture;
pub mod given;
pub mod governor;
pub mod groups;
pub mod house;
pub mod input;
pub mod kept;
pub mod languages;
pub mod live;
pub mod log;
pub mod loudness;
pub mod menu;
pub mod metrics;
pub mod microphone;
pub mod moments;
pub mod mqtt;
pub mod needs;
pub mod orbit;
pub mod overlay;
pub mod pace;
pub mod page;
pub mod pointing;
pub mod recording;
pub mod rest;
pub mod rhythm;
pub mod screen;
pub mod shelf;
pub mod site;
pub mod speech;
pub mod spoken;
pub mod staff;
pub mod stage;
pub mod tiers;
pub mod timing;
pub mod visits;
pub mod voice;
#[cfg(target_os = "linux")]
pub mod watchdog;
pub mod window;
pub mod words;
pub mod workbench;
pub mod writer;

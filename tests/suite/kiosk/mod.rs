//! The kiosk without its window: configuration, pace, visitor, attract mode, reloading, words.

#[cfg(feature = "kiosk")]
mod accessibility;
#[cfg(feature = "kiosk")]
mod aloud;
#[cfg(feature = "kiosk")]
mod attract;
#[cfg(feature = "kiosk")]
mod bidi;
#[cfg(feature = "kiosk")]
mod camera_sway;
mod captions;
#[cfg(feature = "kiosk")]
mod catalog;
mod configuration;
mod configuration_files;
#[cfg(feature = "kiosk")]
mod contrast;
mod doctor;
#[cfg(feature = "kiosk")]
mod dwell;
#[cfg(feature = "kiosk")]
mod edit;
mod feed;
#[cfg(feature = "kiosk")]
mod flashes;
#[cfg(feature = "kiosk")]
mod fleet;
#[cfg(feature = "kiosk")]
mod frame_pacing;
#[cfg(feature = "kiosk")]
mod glass;
#[cfg(feature = "kiosk")]
mod hearing_loop;
#[cfg(feature = "kiosk")]
mod idle_rendering;
#[cfg(feature = "kiosk")]
mod instance;
#[cfg(feature = "kiosk")]
mod instruments;
mod modules;
mod opening;
#[cfg(feature = "kiosk")]
mod orbit;
#[cfg(feature = "kiosk")]
mod pages;
mod pin;
#[cfg(feature = "kiosk")]
mod quality_tiers;
#[cfg(feature = "kiosk")]
mod record;
#[cfg(feature = "kiosk")]
mod screens;
#[cfg(feature = "kiosk")]
mod self_test;
#[cfg(feature = "kiosk")]
mod site;
#[cfg(feature = "kiosk")]
mod staff;
#[cfg(feature = "kiosk")]
mod stage;
#[cfg(feature = "kiosk")]
mod step_scheduler;
#[cfg(feature = "kiosk")]
mod ui_strings;
#[cfg(feature = "kiosk")]
mod venue_state;
#[cfg(feature = "kiosk")]
mod visitor_input;

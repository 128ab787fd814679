//! The blow detector on generated sounds: requirements for any microphone, and for the kiosk's own output.

use assert_no_alloc::AllocDisabler;

mod breaths;
mod echo;
mod timeout;

#[global_allocator]
static ALLOCATOR: AllocDisabler = AllocDisabler;

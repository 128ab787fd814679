//! The blow detector on generated sounds: what must hold for any microphone, and the kiosk's own output.

use assert_no_alloc::AllocDisabler;

mod breaths;
mod latch;
mod own_voice;

#[global_allocator]
static ALLOCATOR: AllocDisabler = AllocDisabler;

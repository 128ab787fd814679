//! Sound synthesis against formulas and published tables: the synthesizer, its bank of partials, and the reverberation.

use assert_no_alloc::AllocDisabler;

mod modal;
mod space;
mod synth;

#[global_allocator]
static ALLOCATOR: AllocDisabler = AllocDisabler;

//! Wind: forces against formulas, and what the lips see against a depth buffer.

use assert_no_alloc::AllocDisabler;

mod bodies;
mod depth_buffer;
mod forces;
mod sight;
mod sight_by_each;

#[global_allocator]
static ALLOCATOR: AllocDisabler = AllocDisabler;

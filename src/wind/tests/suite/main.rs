//! Wind: forces against formulas, and visibility from the lips against a depth buffer.

use assert_no_alloc::AllocDisabler;

mod bodies;
mod depth_buffer;
mod forces;
mod sight;
mod sight_by_each;

#[global_allocator]
static ALLOCATOR: AllocDisabler = AllocDisabler;

//! Multibody dynamics against formulas, hand calculation and solvers of the tests' own. No exhibit is loaded here.

use assert_no_alloc::AllocDisabler;

mod articulation;
mod collision;
mod contacts;
mod dynamics;
mod escapement;
mod hits;
mod motion;
mod procedural;
mod spheres;

#[global_allocator]
static ALLOCATOR: AllocDisabler = AllocDisabler;

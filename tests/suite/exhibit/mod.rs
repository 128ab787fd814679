//! Exhibits: good ones load with the numbers that formulas give; bad ones are refused with the right code and line.

mod collection;
mod constraints;
mod example;
pub mod glb;
mod mass;
mod model;
mod motion;
mod shape;
mod shipped;
mod sidecar;
mod timing;

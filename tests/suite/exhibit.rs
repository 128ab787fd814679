//! Exhibits: good ones load with the numbers that formulas give; bad ones are refused with the right code and line.

mod glb;
mod mass;
mod model;
mod shipped;
mod sidecar;

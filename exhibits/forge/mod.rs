//! The forge: makes every shipped model from stated dimensions.
//!
//! `exhibits/` never holds geometry that nobody can remake: each `.glb` and each recorded breath there comes from
//! this code, byte for byte. Invariant: no clock, no randomness without a stated seed, software transcendentals.

pub mod glb;
pub mod mobile;
pub mod outline;
pub mod piece;
pub mod solid;
pub mod steel_fish;

/// A file that the forge makes.
#[derive(Debug)]
pub struct Artifact {
    /// Below `exhibits/`, with forward slashes.
    pub path: &'static str,
    /// What it holds.
    pub bytes: Vec<u8>,
}

/// Makes everything.
pub fn artifacts() -> Vec<Artifact> {
    let (_, model) = steel_fish::glb();
    vec![Artifact { path: "steel-fish/steel-fish.glb", bytes: model }]
}

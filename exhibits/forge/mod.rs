//! The forge: generates every shipped model from stated dimensions.
//!
//! Each `.glb` and each breath in `exhibits/` comes from this code, byte for byte. Invariant: no clock, no unseeded
//! randomness, software transcendentals. The code shared with `soffio new` (sheet, wire, balance, glTF) is
//! `soffio_authoring`.
//!
//! Lengths, positions, angles and masses are those of each exhibit's drawing. Where a constant names no other reason or
//! source, the drawing's author chose it by eye. `MM` and `GRAM` turn the drawing's units into SI.

use soffio_authoring::chimes;

pub mod axis_wheel;
pub mod billiards;
pub mod blown_together;
pub mod breaking_chain;
pub mod breath_clock;
pub mod breaths;
pub mod cart;
pub mod chains;
pub mod gear_train;
pub mod hang_it;
pub mod harp;
pub mod lobster_tree;
pub mod loose_nail;
pub mod marionette;
pub mod moving_path;
pub mod noise_mobile;
pub mod pendulum;
pub mod pennant;
pub mod plates;
pub mod scratch_board;
pub mod sloped_bed;
pub mod snow;
pub mod steel_fish;
pub mod strikers;
pub mod terry_case;
pub mod terry_clock;
pub mod terry_layout;
pub mod terry_strike;
pub mod three_motions;
pub mod twelve_moons;
pub mod universal_joint;
pub mod walker;
pub mod windmill;
pub mod windy_corner;

/// A generated file.
#[derive(Debug)]
pub struct Artifact {
    /// Path below `exhibits/`, with forward slashes.
    pub path: &'static str,
    /// Contents.
    pub bytes: Vec<u8>,
}

/// Generates all files.
///
/// # Errors
/// A sound file cannot be encoded.
pub fn artifacts() -> Result<Vec<Artifact>, hound::Error> {
    let (_, model) = steel_fish::glb();
    // Speeds at the lips of a gentle, a normal and a strong breath; the seeds make them differ.
    Ok(vec![
        Artifact { path: "axis-wheel/axis-wheel.glb", bytes: axis_wheel::glb() },
        Artifact { path: "billiards/billiards.glb", bytes: billiards::glb() },
        Artifact { path: "breaking-chain/breaking-chain.glb", bytes: breaking_chain::glb() },
        Artifact { path: "breath-clock/breath-clock.glb", bytes: breath_clock::glb() },
        Artifact { path: "cart/cart.glb", bytes: cart::glb() },
        Artifact { path: "chain-heavy/chain-heavy.glb", bytes: chains::heavy_glb() },
        Artifact { path: "chain-light/chain-light.glb", bytes: chains::light_glb() },
        Artifact { path: "chains/chains.glb", bytes: chains::glb() },
        Artifact { path: "gear-train/gear-train.glb", bytes: gear_train::glb() },
        Artifact { path: "harp/harp.glb", bytes: harp::glb() },
        Artifact { path: "lobster-tree/lobster-tree.glb", bytes: lobster_tree::glb().1 },
        Artifact { path: "marionette/marionette.glb", bytes: marionette::glb() },
        Artifact { path: "noise-mobile/noise-mobile.glb", bytes: noise_mobile::glb().1 },
        Artifact { path: "pendulum/pendulum.glb", bytes: pendulum::glb() },
        Artifact { path: "pennant/pennant.glb", bytes: pennant::glb() },
        Artifact { path: "plates/plates.glb", bytes: plates::glb().1 },
        Artifact { path: "terry-clock/terry-clock.glb", bytes: terry_clock::glb() },
        Artifact { path: "snow/snow.glb", bytes: snow::glb().1 },
        Artifact { path: "twelve-moons/twelve-moons.glb", bytes: twelve_moons::glb().1 },
        Artifact { path: "wind-chimes/wind-chimes.glb", bytes: chimes::glb(&chimes::ALUMINIUM) },
        Artifact { path: "wind-chimes-bamboo/wind-chimes-bamboo.glb", bytes: chimes::glb(&chimes::BAMBOO) },
        Artifact { path: "wind-chimes-glass/wind-chimes-glass.glb", bytes: chimes::glb(&chimes::GLASS) },
        Artifact { path: "wind-chimes-metals/wind-chimes-metals.glb", bytes: chimes::glb(&chimes::METALS) },
        Artifact { path: "blown-together/blown-together.glb", bytes: blown_together::glb() },
        Artifact { path: "hang-it/hang-it.glb", bytes: hang_it::glb() },
        Artifact { path: "loose-nail/loose-nail.glb", bytes: loose_nail::glb() },
        Artifact { path: "moving-path/moving-path.glb", bytes: moving_path::glb() },
        Artifact { path: "scratch-board/scratch-board.glb", bytes: scratch_board::glb() },
        Artifact { path: "strikers/strikers.glb", bytes: strikers::glb() },
        Artifact { path: "universal-joint/universal-joint.glb", bytes: universal_joint::glb() },
        Artifact { path: "three-motions/three-motions.glb", bytes: three_motions::glb() },
        Artifact { path: "walker/walker.glb", bytes: walker::glb() },
        Artifact { path: "windmill/windmill.glb", bytes: windmill::glb() },
        Artifact { path: "windy-corner/windy-corner.glb", bytes: windy_corner::glb().1 },
        Artifact { path: "steel-fish/steel-fish.glb", bytes: model },
        Artifact { path: "steel-fish/breaths/gentle.wav", bytes: breaths::wav(3.8, 2.4, 1)? },
        Artifact { path: "steel-fish/breaths/normal.wav", bytes: breaths::wav(8.9, 1.8, 2)? },
        Artifact { path: "steel-fish/breaths/strong.wav", bytes: breaths::wav(13.3, 1.2, 3)? },
    ])
}

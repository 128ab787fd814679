//! What instruments of one synth have in common: an exhibit has many equal plates and surfaces, and each takes
//! milliseconds to find.

use std::sync::Arc;

use super::graph::Pyramid;
use super::modes::{PlateMode, free_plate_modes};
use super::timbre::Texture;
use super::{SoundBody, SoundMaterial};

/// Everything that was found for earlier instruments.
#[derive(Default)]
pub(super) struct Shared {
    plates: Vec<(SoundBody, SoundMaterial, Vec<PlateMode>)>,
    textures: Vec<(Texture, Arc<Pyramid>)>,
}

impl Shared {
    /// [`free_plate_modes`].
    pub fn plate_modes(&mut self, body: &SoundBody, material: &SoundMaterial) -> Vec<PlateMode> {
        if let Some((_, _, modes)) = self.plates.iter().find(|(b, m, _)| (b, m) == (body, material)) {
            return modes.clone();
        }
        let modes = free_plate_modes(body, material);
        self.plates.push((*body, *material, modes.clone()));
        modes
    }

    /// [`Pyramid::of_texture`].
    pub fn texture(&mut self, texture: &Texture) -> Arc<Pyramid> {
        if let Some((_, line)) = self.textures.iter().find(|(known, _)| known == texture) {
            return line.clone();
        }
        let line = Arc::new(Pyramid::of_texture(texture));
        self.textures.push((*texture, line.clone()));
        line
    }
}

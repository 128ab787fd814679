//! How surfaces look, and the textures on them.

/// How a surface looks: the metallic–roughness model of glTF 2.0 and the layers that ratified extensions add.
///
/// It has 25 fields, because it is a plain table that mirrors the file format: one field for each factor and texture that a
/// glTF material has.
#[derive(Clone, Debug)]
pub struct Appearance {
    /// Name.
    pub name: String,
    /// Linear RGBA.
    pub base_color: [f32; 4],
    /// Multiplies it.
    pub base_color_texture: Option<TextureUse>,
    /// 0…1.
    pub metallic: f32,
    /// Perceptual, 0…1.
    pub roughness: f32,
    /// Green roughness, blue metallic.
    pub metallic_roughness_texture: Option<TextureUse>,
    /// With its scale.
    pub normal_texture: Option<(TextureUse, f32)>,
    /// With its strength.
    pub occlusion_texture: Option<(TextureUse, f32)>,
    /// Linear RGB, strength included.
    pub emissive: [f32; 3],
    /// Multiplies it.
    pub emissive_texture: Option<TextureUse>,
    /// How alpha is used.
    pub alpha: AlphaMode,
    /// Drawn from both sides.
    pub double_sided: bool,
    /// The base colour as it is, whatever the light (KHR_materials_unlit).
    pub unlit: bool,
    /// Index of refraction (KHR_materials_ior).
    pub ior: f32,
    /// Strength of what is not metal's mirror (KHR_materials_specular), and its linear colour.
    pub specular: f32,
    /// Linear RGB.
    pub specular_color: [f32; 3],
    /// Part of the light below the surface that goes through (KHR_materials_transmission), 0…1.
    pub transmission: f32,
    /// Of the wall of what is transparent (KHR_materials_volume), m.
    pub thickness: f32,
    /// Way in it after which white has become the attenuation colour, m; may be infinite.
    pub attenuation_distance: f32,
    /// Linear RGB.
    pub attenuation_color: [f32; 3],
    /// Strength of the clear coat (KHR_materials_clearcoat), 0…1.
    pub coat: f32,
    /// Perceptual.
    pub coat_roughness: f32,
    /// Linear RGB of a cloth's sheen (KHR_materials_sheen).
    pub sheen: [f32; 3],
    /// Perceptual.
    pub sheen_roughness: f32,
    /// Textures of these layers.
    pub details: Details,
}

/// Textures of the extensions' layers: each multiplies the factor of its name, by the channels that the extension says.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Details {
    /// Red.
    pub transmission: Option<TextureUse>,
    /// Green.
    pub thickness: Option<TextureUse>,
    /// Alpha.
    pub specular: Option<TextureUse>,
    /// Colour.
    pub specular_color: Option<TextureUse>,
    /// Red.
    pub coat: Option<TextureUse>,
    /// Green.
    pub coat_roughness: Option<TextureUse>,
    /// Of the coat alone, with its scale.
    pub coat_normal: Option<(TextureUse, f32)>,
    /// Colour.
    pub sheen: Option<TextureUse>,
    /// Alpha.
    pub sheen_roughness: Option<TextureUse>,
}

impl Details {
    /// All of them, in the order of `forward.wgsl`.
    pub fn all(&self) -> [Option<TextureUse>; 9] {
        [
            self.transmission,
            self.thickness,
            self.specular,
            self.specular_color,
            self.coat,
            self.coat_roughness,
            self.coat_normal.map(|(texture, _)| texture),
            self.sheen,
            self.sheen_roughness,
        ]
    }

    /// Are there none?
    pub fn is_empty(&self) -> bool {
        self.all().iter().all(Option::is_none)
    }
}

impl Default for Appearance {
    fn default() -> Self {
        Self {
            name: String::new(),
            base_color: [1.0; 4],
            base_color_texture: None,
            metallic: 1.0,
            roughness: 1.0,
            metallic_roughness_texture: None,
            normal_texture: None,
            occlusion_texture: None,
            emissive: [0.0; 3],
            emissive_texture: None,
            alpha: AlphaMode::Opaque,
            double_sided: false,
            unlit: false,
            ior: 1.5,
            specular: 1.0,
            specular_color: [1.0; 3],
            transmission: 0.0,
            thickness: 0.0,
            attenuation_distance: f32::INFINITY,
            attenuation_color: [1.0; 3],
            coat: 0.0,
            coat_roughness: 0.0,
            sheen: [0.0; 3],
            sheen_roughness: 0.0,
            details: Details::default(),
        }
    }
}

/// An image on a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TextureUse {
    /// Index of the image.
    pub image: usize,
    /// Which set of texture coordinates it lies on: 0 or 1.
    pub set: usize,
    /// Rows that take (u, v, 1) to its own coordinates (KHR_texture_transform).
    pub transform: [[f32; 3]; 2],
    /// How it is read.
    pub sampler: Sampler,
}

impl TextureUse {
    /// The image as it is on the first set.
    pub fn of(image: usize) -> Self {
        Self { image, set: 0, transform: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], sampler: Sampler::default() }
    }
}

/// How an image is read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Sampler {
    /// What lies beyond its edges, along u and v.
    pub wrap: [Wrap; 2],
    /// Blend neighbours when magnified.
    pub smooth_near: bool,
    /// Blend neighbours when minified.
    pub smooth_far: bool,
    /// Smaller levels: none, the nearest, or two blended.
    pub levels: Levels,
}

impl Default for Sampler {
    fn default() -> Self {
        Self { wrap: [Wrap::Repeat; 2], smooth_near: true, smooth_far: true, levels: Levels::Blended }
    }
}

/// What lies beyond an image's edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Wrap {
    /// The image again.
    Repeat,
    /// The image mirrored.
    Mirror,
    /// Its edge.
    Clamp,
}

/// Use of an image's smaller levels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Levels {
    /// Only the image itself.
    None,
    /// The level that fits best.
    Nearest,
    /// The two that fit best, blended.
    Blended,
}

/// How alpha is used.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AlphaMode {
    /// Ignored.
    Opaque,
    /// Cut at a threshold.
    Mask(f32),
    /// Blended.
    Blend,
}

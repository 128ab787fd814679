//! Materials for rendering: metallic–roughness factors and textures.

use crate::finish::Finish;

/// Surface appearance: the metallic–roughness model of glTF 2.0 with its ratified extensions.
///
/// It has 26 fields because it mirrors the file format: one field for each factor and texture of a glTF material, and its finish.
#[derive(Clone, Debug)]
pub struct Appearance {
    /// Name.
    pub name: String,
    /// Base colour, linear RGBA.
    pub base_color: [f32; 4],
    /// Multiplies the base colour.
    pub base_color_texture: Option<TextureUse>,
    /// Metalness, 0…1.
    pub metallic: f32,
    /// Perceptual roughness, 0…1.
    pub roughness: f32,
    /// Roughness in the green channel, metalness in the blue one.
    pub metallic_roughness_texture: Option<TextureUse>,
    /// Normal map with its scale.
    pub normal_texture: Option<ScaledTexture>,
    /// Occlusion map with its strength.
    pub occlusion_texture: Option<ScaledTexture>,
    /// Emitted colour, linear RGB, strength included.
    pub emissive: [f32; 3],
    /// Multiplies the emitted colour.
    pub emissive_texture: Option<TextureUse>,
    /// Use of the alpha channel.
    pub alpha: AlphaMode,
    /// Are both sides drawn?
    pub double_sided: bool,
    /// Is the base colour drawn without lighting (KHR_materials_unlit)?
    pub unlit: bool,
    /// Index of refraction (KHR_materials_ior).
    pub ior: f32,
    /// Strength of the dielectric reflection (KHR_materials_specular).
    pub specular: f32,
    /// Colour of the dielectric reflection, linear RGB.
    pub specular_color: [f32; 3],
    /// Fraction of the refracted light that is transmitted (KHR_materials_transmission), 0…1.
    pub transmission: f32,
    /// Wall thickness of a transparent body (KHR_materials_volume), m.
    pub thickness: f32,
    /// Distance in the material after which white light has the attenuation colour, m; may be infinite.
    pub attenuation_distance: f32,
    /// Attenuation colour, linear RGB.
    pub attenuation_color: [f32; 3],
    /// Strength of the clear coat (KHR_materials_clearcoat), 0…1.
    pub coat: f32,
    /// Perceptual roughness of the clear coat.
    pub coat_roughness: f32,
    /// Sheen colour of cloth, linear RGB (KHR_materials_sheen).
    pub sheen: [f32; 3],
    /// Perceptual roughness of the sheen.
    pub sheen_roughness: f32,
    /// Textures of the extensions.
    pub details: Details,
    /// The finish that its extras name: `{"soffio_finish": "oak"}`.
    pub finish: Option<&'static Finish>,
}

/// Textures of the material extensions: each multiplies the factor of its name.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Details {
    /// Red channel.
    pub transmission: Option<TextureUse>,
    /// Green channel.
    pub thickness: Option<TextureUse>,
    /// Alpha channel.
    pub specular: Option<TextureUse>,
    /// Colour.
    pub specular_color: Option<TextureUse>,
    /// Red channel.
    pub coat: Option<TextureUse>,
    /// Green channel.
    pub coat_roughness: Option<TextureUse>,
    /// Normal map of the coat alone, with its scale.
    pub coat_normal: Option<ScaledTexture>,
    /// Colour.
    pub sheen: Option<TextureUse>,
    /// Alpha channel.
    pub sheen_roughness: Option<TextureUse>,
}

/// A texture whose effect has a strength.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScaledTexture {
    /// The texture.
    pub texture: TextureUse,
    /// Scale of a normal map, strength of an occlusion map; 1 is the image as it is.
    pub scale: f32,
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
            self.coat_normal.map(|map| map.texture),
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
            finish: None,
        }
    }
}

/// A texture as a material uses it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TextureUse {
    /// Index of the image.
    pub image: usize,
    /// Index of its set of texture coordinates: 0 or 1.
    pub set: usize,
    /// Rows of the 2 × 3 matrix that maps (u, v, 1) to its coordinates (KHR_texture_transform).
    pub transform: [[f32; 3]; 2],
    /// Filter and wrapping.
    pub sampler: Sampler,
}

impl TextureUse {
    /// The image without a transform on the first set of coordinates.
    pub fn of(image: usize) -> Self {
        Self { image, set: 0, transform: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], sampler: Sampler::default() }
    }
}

/// Filter and wrapping of a texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Sampler {
    /// Wrapping along u and v.
    pub wrap: [Wrap; 2],
    /// Linear filter when magnified; otherwise the nearest texel.
    pub smooth_near: bool,
    /// Linear filter when minified; otherwise the nearest texel.
    pub smooth_far: bool,
    /// Which mip levels are read when the texture is minified.
    pub levels: Levels,
}

impl Default for Sampler {
    fn default() -> Self {
        Self { wrap: [Wrap::Repeat; 2], smooth_near: true, smooth_far: true, levels: Levels::Blended }
    }
}

/// Wrapping of texture coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Wrap {
    /// The image repeats.
    Repeat,
    /// The image repeats mirrored.
    Mirror,
    /// The edge continues.
    Clamp,
}

/// Use of an image's mip levels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Levels {
    /// The full image alone.
    None,
    /// The nearest level.
    Nearest,
    /// Two levels, interpolated.
    Blended,
}

/// Use of the alpha channel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AlphaMode {
    /// Ignored.
    Opaque,
    /// Alpha test with this threshold.
    Mask(f32),
    /// Alpha blending.
    Blend,
}

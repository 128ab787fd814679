//! Converts glTF materials and their extensions to [`Appearance`].
//!
//! Extensions are read as JSON. A number that is missing or of the wrong type takes its default.

use gltf::json::Value;
use gltf::material::AlphaMode as GltfAlpha;
use gltf::texture::{MagFilter, MinFilter, WrappingMode};

use super::appearance::{AlphaMode, Appearance, Details, Levels, Sampler, ScaledTexture, TextureUse, Wrap};
use crate::diagnostic::quoted;
use crate::finish::{self, Finish};
use soffio_math as math;

/// Material extensions that are not drawn.
const IGNORED: [&str; 4] = [
    "KHR_materials_anisotropy",
    "KHR_materials_iridescence",
    "KHR_materials_dispersion",
    "KHR_materials_diffuse_transmission",
];

/// The appearance of a glTF material of `document`; `note` receives what is not drawn.
pub fn appearance(material: &gltf::Material, document: &gltf::Document, note: impl FnMut(String)) -> Appearance {
    let name = material.name().unwrap_or_default().to_owned();
    let mut textures = Textures { material, document, name: &name, note };
    let surface = material.pbr_metallic_roughness();
    let strength = material.emissive_strength().unwrap_or(1.0);
    let base_color_texture = surface.base_color_texture().and_then(|i| textures.info(&i));
    let metallic_roughness_texture = surface.metallic_roughness_texture().and_then(|i| textures.info(&i));
    let emissive_texture = material.emissive_texture().and_then(|i| textures.info(&i));
    let normal_texture = material
        .normal_texture()
        .map(|t| (textures.texture(t.texture(), t.tex_coord(), t.extension_value(TEXTURE_TRANSFORM)), t.scale()))
        .and_then(|(texture, scale)| Some(ScaledTexture { texture: texture?, scale }));
    let occlusion_texture = material
        .occlusion_texture()
        .map(|t| (textures.texture(t.texture(), t.tex_coord(), t.extension_value(TEXTURE_TRANSFORM)), t.strength()))
        .and_then(|(texture, scale)| Some(ScaledTexture { texture: texture?, scale }));
    let details = textures.details();
    for extension in IGNORED.iter().filter(|extension| material.extension_value(extension).is_some()) {
        (textures.note)(format!("material \"{name}\": {extension} is not drawn"));
    }
    let finish = finish_of(material, |what| (textures.note)(what));
    let share = |x: f32| x.clamp(0.0, 1.0);
    let number = |extension: &str, key: &str, default: f64| number(material, extension, key, default);
    let color = |extension: &str, key: &str, default: f64| color(material, extension, key, default);
    Appearance {
        base_color: surface.base_color_factor(),
        base_color_texture,
        metallic: surface.metallic_factor(),
        roughness: surface.roughness_factor(),
        metallic_roughness_texture,
        normal_texture,
        occlusion_texture,
        emissive: material.emissive_factor().map(|c| c * strength),
        emissive_texture,
        alpha: match material.alpha_mode() {
            GltfAlpha::Opaque => AlphaMode::Opaque,
            GltfAlpha::Mask => AlphaMode::Mask(material.alpha_cutoff().unwrap_or(0.5)),
            GltfAlpha::Blend => AlphaMode::Blend,
        },
        double_sided: material.double_sided(),
        unlit: material.extension_value("KHR_materials_unlit").is_some(),
        ior: number("ior", "ior", 1.5).max(1.0),
        specular: share(number("specular", "specularFactor", 1.0)),
        specular_color: color("specular", "specularColorFactor", 1.0),
        transmission: share(number("transmission", "transmissionFactor", 0.0)),
        thickness: number("volume", "thicknessFactor", 0.0).max(0.0),
        attenuation_distance: Some(number("volume", "attenuationDistance", 0.0))
            .filter(|d| *d > 0.0)
            .unwrap_or(f32::INFINITY),
        attenuation_color: color("volume", "attenuationColor", 1.0),
        coat: share(number("clearcoat", "clearcoatFactor", 0.0)),
        coat_roughness: share(number("clearcoat", "clearcoatRoughnessFactor", 0.0)),
        sheen: color("sheen", "sheenColorFactor", 0.0),
        sheen_roughness: share(number("sheen", "sheenRoughnessFactor", 0.0)),
        details,
        finish,
        name,
    }
}

/// The finish that a material's extras name.
fn finish_of(material: &gltf::Material, note: impl FnOnce(String)) -> Option<&'static Finish> {
    let extras: Value = gltf::json::deserialize::from_str(material.extras().as_ref()?.get()).ok()?;
    let name = extras.get(FINISH)?.as_str()?;
    let known = finish::named(name);
    if known.is_none() {
        let (material, names) = (material.name().unwrap_or_default(), finish::names().collect::<Vec<_>>());
        note(format!("material \"{material}\": no finish is named \"{name}\"; there are {}", quoted(&names)));
    }
    known
}

/// Key of a finish in the extras of a material.
pub const FINISH: &str = "soffio_finish";

/// Name of the texture-transform extension.
const TEXTURE_TRANSFORM: &str = "KHR_texture_transform";

/// Reads the textures of a material and reports what is not drawn.
struct Textures<'a, N> {
    material: &'a gltf::Material<'a>,
    document: &'a gltf::Document,
    name: &'a str,
    note: N,
}

impl<N: FnMut(String)> Textures<'_, N> {
    /// A texture on a set of coordinates, with `transform` as KHR_texture_transform.
    fn texture(&mut self, texture: gltf::Texture, set: u32, transform: Option<&Value>) -> Option<TextureUse> {
        let Some(image) = texture.source() else {
            let (name, index) = (self.name, texture.index());
            (self.note)(format!("material \"{name}\": textures[{index}] has no PNG or JPEG; it is not drawn"));
            return None;
        };
        let set = transform.and_then(|t| t.get("texCoord")?.as_u64()).unwrap_or(u64::from(set));
        if set > 1 {
            let name = self.name;
            (self.note)(format!("material \"{name}\" uses texture coordinates {set}; the second set is drawn instead"));
        }
        Some(TextureUse {
            image: image.index(),
            set: set.min(1) as usize,
            transform: transform.map_or(TextureUse::of(0).transform, rows),
            sampler: sampler(&texture.sampler()),
        })
    }

    fn info(&mut self, info: &gltf::texture::Info) -> Option<TextureUse> {
        self.texture(info.texture(), info.tex_coord(), info.extension_value(TEXTURE_TRANSFORM))
    }

    /// A texture of an extension, with its scale; `None` where the file has no such texture.
    fn detail(&mut self, extension: &str, key: &str) -> Option<ScaledTexture> {
        let info = self.material.extension_value(&format!("KHR_materials_{extension}")).and_then(|e| e.get(key))?;
        let index = info.get("index")?.as_u64()? as usize;
        let set = info.get("texCoord").and_then(Value::as_u64).unwrap_or(0) as u32;
        let moved = info.get("extensions").and_then(|e| e.get(TEXTURE_TRANSFORM));
        let scale = info.get("scale").and_then(Value::as_f64).unwrap_or(1.0) as f32;
        Some(ScaledTexture { texture: self.texture(self.document.textures().nth(index)?, set, moved)?, scale })
    }

    /// The textures of all extensions.
    fn details(&mut self) -> Details {
        let coat_normal = self.detail("clearcoat", "clearcoatNormalTexture");
        let mut detail = |extension: &str, key: &str| self.detail(extension, key).map(|map| map.texture);
        let details = Details {
            transmission: detail("transmission", "transmissionTexture"),
            thickness: detail("volume", "thicknessTexture"),
            specular: detail("specular", "specularTexture"),
            specular_color: detail("specular", "specularColorTexture"),
            coat: detail("clearcoat", "clearcoatTexture"),
            coat_roughness: detail("clearcoat", "clearcoatRoughnessTexture"),
            coat_normal,
            sheen: detail("sheen", "sheenColorTexture"),
            sheen_roughness: detail("sheen", "sheenRoughnessTexture"),
        };
        let mut samplers = details.all().into_iter().flatten().map(|texture| texture.sampler);
        if samplers.next().is_some_and(|first| samplers.any(|other| other != first)) {
            let name = self.name;
            (self.note)(format!(
                "material \"{name}\": the textures of its extensions are all wrapped and filtered like the first"
            ));
        }
        details
    }
}

/// A finite number of an extension, or `default`.
fn number(material: &gltf::Material, extension: &str, key: &str, default: f64) -> f32 {
    let value = material.extension_value(&format!("KHR_materials_{extension}")).and_then(|e| e.get(key)?.as_f64());
    value.filter(|v| v.is_finite()).unwrap_or(default) as f32
}

/// A colour of an extension; missing components are `default`.
fn color(material: &gltf::Material, extension: &str, key: &str, default: f64) -> [f32; 3] {
    let list = material.extension_value(&format!("KHR_materials_{extension}")).and_then(|e| e.get(key)?.as_array());
    std::array::from_fn(|i| list.and_then(|l| l.get(i)?.as_f64()).unwrap_or(default) as f32)
}

/// Translation · rotation · scale of KHR_texture_transform; it rotates counter-clockwise with v down.
fn rows(transform: &Value) -> [[f32; 3]; 2] {
    let number = |value: Option<&Value>, default: f64| value.and_then(Value::as_f64).unwrap_or(default);
    let pair = |key: &str, default: f64| [0, 1].map(|i| number(transform.get(key).and_then(|v| v.get(i)), default));
    let ([x, y], [w, h]) = (pair("offset", 0.0), pair("scale", 1.0));
    let angle = number(transform.get("rotation"), 0.0);
    let (s, c) = (math::sin(angle), math::cos(angle));
    [[c * w, s * h, x], [-s * w, c * h, y]].map(|row| row.map(|x| x as f32))
}

fn sampler(source: &gltf::texture::Sampler) -> Sampler {
    let wrap = |mode| match mode {
        WrappingMode::Repeat => Wrap::Repeat,
        WrappingMode::MirroredRepeat => Wrap::Mirror,
        WrappingMode::ClampToEdge => Wrap::Clamp,
    };
    let (smooth_far, levels) = match source.min_filter() {
        Some(MinFilter::Nearest) => (false, Levels::None),
        Some(MinFilter::Linear) => (true, Levels::None),
        Some(MinFilter::NearestMipmapNearest) => (false, Levels::Nearest),
        Some(MinFilter::LinearMipmapNearest) => (true, Levels::Nearest),
        Some(MinFilter::NearestMipmapLinear) => (false, Levels::Blended),
        Some(MinFilter::LinearMipmapLinear) | None => (true, Levels::Blended),
    };
    Sampler {
        wrap: [wrap(source.wrap_s()), wrap(source.wrap_t())],
        smooth_near: source.mag_filter() != Some(MagFilter::Nearest),
        smooth_far,
        levels,
    }
}

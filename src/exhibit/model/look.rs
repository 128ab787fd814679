//! Appearances of a glTF file, and flat normals where it has none.
//!
//! Extensions are read as plain JSON, all in one way; a number that is missing or of the wrong type has its default.

use gltf::json::Value;
use gltf::material::AlphaMode as GltfAlpha;
use gltf::texture::{MagFilter, MinFilter, WrappingMode};

use super::{AlphaMode, Appearance, Details, Levels, Primitive, Sampler, TextureUse, Wrap};
use soffio_math::{self as math, DVec3};

/// Layers of a surface that are not drawn at all.
const IGNORED: [&str; 4] = [
    "KHR_materials_anisotropy",
    "KHR_materials_iridescence",
    "KHR_materials_dispersion",
    "KHR_materials_diffuse_transmission",
];

/// The metallic–roughness appearance of a glTF material of `document`; `note` is told what is not drawn.
pub fn appearance(material: &gltf::Material, document: &gltf::Document, mut note: impl FnMut(String)) -> Appearance {
    let surface = material.pbr_metallic_roughness();
    let strength = material.emissive_strength().unwrap_or(1.0);
    let name = material.name().unwrap_or_default().to_owned();
    let mut texture = |texture: gltf::Texture, set: u32, transform: Option<&Value>| {
        let set = transform.and_then(|t| t.get("texCoord")?.as_u64()).unwrap_or(u64::from(set));
        if set > 1 {
            note(format!("material \"{name}\" uses texture coordinates {set}; the second set is drawn instead"));
        }
        TextureUse {
            image: texture.source().index(),
            set: set.min(1) as usize,
            transform: transform.map_or(TextureUse::of(0).transform, rows),
            sampler: sampler(&texture.sampler()),
        }
    };
    const MOVED: &str = "KHR_texture_transform";
    let info = |i: gltf::texture::Info, texture: &mut dyn FnMut(gltf::Texture, u32, Option<&Value>) -> TextureUse| {
        texture(i.texture(), i.tex_coord(), i.extension_value(MOVED))
    };
    let base_color_texture = surface.base_color_texture().map(|i| info(i, &mut texture));
    let metallic_roughness_texture = surface.metallic_roughness_texture().map(|i| info(i, &mut texture));
    let emissive_texture = material.emissive_texture().map(|i| info(i, &mut texture));
    let normal_texture =
        material.normal_texture().map(|t| (texture(t.texture(), t.tex_coord(), t.extension_value(MOVED)), t.scale()));
    let occlusion_texture = material
        .occlusion_texture()
        .map(|t| (texture(t.texture(), t.tex_coord(), t.extension_value(MOVED)), t.strength()));
    // Textures of extensions are named by index: one that does not exist is none.
    let mut detail = |extension: &str, key: &str| {
        let info = material.extension_value(&format!("KHR_materials_{extension}")).and_then(|e| e.get(key))?;
        let index = info.get("index")?.as_u64()? as usize;
        let set = info.get("texCoord").and_then(Value::as_u64).unwrap_or(0) as u32;
        let moved = info.get("extensions").and_then(|e| e.get(MOVED));
        let scale = info.get("scale").and_then(Value::as_f64).unwrap_or(1.0) as f32;
        Some((texture(document.textures().nth(index)?, set, moved), scale))
    };
    let coat_normal = detail("clearcoat", "clearcoatNormalTexture");
    let mut detail = |extension: &str, key: &str| detail(extension, key).map(|(texture, _)| texture);
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
        note(format!(
            "material \"{name}\": the textures of its extensions are all wrapped and filtered like the first"
        ));
    }
    let number = |extension: &str, key: &str, default: f64| {
        let value = material.extension_value(&format!("KHR_materials_{extension}")).and_then(|e| e.get(key)?.as_f64());
        value.filter(|v| v.is_finite()).unwrap_or(default) as f32
    };
    let color = |extension: &str, key: &str, default: f64| {
        let list = material.extension_value(&format!("KHR_materials_{extension}")).and_then(|e| e.get(key)?.as_array());
        std::array::from_fn(|i| list.and_then(|l| l.get(i)?.as_f64()).unwrap_or(default) as f32)
    };
    let share = |x: f32| x.clamp(0.0, 1.0);
    for extension in IGNORED.iter().filter(|extension| material.extension_value(extension).is_some()) {
        note(format!("material \"{name}\": {extension} is not drawn"));
    }
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
        name: name.clone(),
    }
}

/// Translation · rotation · scale of KHR_texture_transform; it turns against the clock, v down.
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

/// Gives a primitive without normals flat ones, as glTF 2.0 asks (3.7.2.1): each triangle gets corners of its own.
pub fn flatten(primitive: &mut Primitive) {
    let positions = std::mem::take(&mut primitive.positions);
    let pick = |list: &mut Vec<[f32; 2]>, indices: &[u32]| {
        *list = if list.is_empty() { Vec::new() } else { indices.iter().map(|&i| list[i as usize]).collect() };
    };
    let indices = std::mem::take(&mut primitive.indices);
    pick(&mut primitive.uvs, &indices);
    pick(&mut primitive.second_uvs, &indices);
    let colors = std::mem::take(&mut primitive.colors);
    if !colors.is_empty() {
        primitive.colors = indices.iter().map(|&i| colors[i as usize]).collect();
    }
    let influences = std::mem::take(&mut primitive.influences);
    if !influences.is_empty() {
        primitive.influences = indices.iter().map(|&i| influences[i as usize]).collect();
    }
    for target in &mut primitive.targets {
        (target.normals, target.tangents) = (Vec::new(), Vec::new());
        target.positions = match target.positions.as_slice() {
            [] => Vec::new(),
            shared => indices.iter().map(|&i| shared[i as usize]).collect(),
        };
    }
    primitive.flat = true;
    // Tangents without normals mean nothing (3.7.2.1).
    primitive.tangents.clear();
    primitive.positions = indices.iter().map(|&i| positions[i as usize]).collect();
    primitive.normals = Vec::with_capacity(primitive.positions.len());
    for corner in primitive.positions.chunks_exact(3) {
        let [a, b, c] = [corner[0], corner[1], corner[2]].map(|p| DVec3::from(p.map(f64::from)));
        let normal = (b - a).cross(c - a).try_normalize().unwrap_or(DVec3::Y).as_vec3().to_array();
        primitive.normals.extend([normal; 3]);
    }
    primitive.indices = (0..primitive.positions.len() as u32).collect();
}

//! Writes materials: values that differ from glTF's defaults, with their extensions.

use std::io::Cursor;

use image::ImageFormat;
use serde_json::{Value, json};

use super::Writer;
use soffio_exhibit::model::{AlphaMode, Appearance, FINISH, Levels, Model, Sampler, TextureUse, Wrap};
use soffio_math::{atan2, sqrt};

impl Writer {
    /// Writes all materials, with the images that they use.
    pub(super) fn materials(&mut self, model: &Model) -> Vec<Value> {
        // Images are written once, when they are first used.
        let mut images = vec![None; model.images.len()];
        model.materials.iter().map(|look| self.material(model, look, &mut images)).collect()
    }

    fn material(&mut self, model: &Model, look: &Appearance, images: &mut [Option<usize>]) -> Value {
        let mut texture = |at: Option<TextureUse>| at.and_then(|at| self.texture(model, at, images));
        let mut surface = json!({
            "baseColorFactor": look.base_color.map(|c| c.clamp(0.0, 1.0)),
            "metallicFactor": look.metallic,
            "roughnessFactor": look.roughness,
        });
        if let Some(info) = texture(look.base_color_texture) {
            surface["baseColorTexture"] = info;
        }
        if let Some(info) = texture(look.metallic_roughness_texture) {
            surface["metallicRoughnessTexture"] = info;
        }
        let mut out = json!({ "pbrMetallicRoughness": surface });
        if let Some((mut info, scale)) =
            look.normal_texture.and_then(|map| Some((texture(Some(map.texture))?, map.scale)))
        {
            info["scale"] = json!(scale);
            out["normalTexture"] = info;
        }
        if let Some((mut info, strength)) =
            look.occlusion_texture.and_then(|map| Some((texture(Some(map.texture))?, map.scale)))
        {
            info["strength"] = json!(strength);
            out["occlusionTexture"] = info;
        }
        if let Some(info) = texture(look.emissive_texture) {
            out["emissiveTexture"] = info;
        }
        if !look.name.is_empty() {
            out["name"] = json!(look.name);
        }
        if let Some(finish) = &look.finish {
            out["extras"] = json!({ FINISH: finish.name });
        }
        match look.alpha {
            AlphaMode::Opaque => {}
            AlphaMode::Mask(cutoff) => {
                out["alphaMode"] = json!("MASK");
                out["alphaCutoff"] = json!(cutoff);
            }
            AlphaMode::Blend => out["alphaMode"] = json!("BLEND"),
        }
        if look.double_sided {
            out["doubleSided"] = json!(true);
        }
        let strength = look.emissive.iter().fold(1.0, |m: f32, x| m.max(*x));
        if look.emissive != [0.0; 3] {
            out["emissiveFactor"] = json!(look.emissive.map(|c| c / strength));
        }
        for (name, mut value) in extensions(look, strength) {
            for (key, at, scale) in details(look, name) {
                let Some(mut info) = self.texture(model, at, images) else { continue };
                if let Some(scale) = scale {
                    info["scale"] = json!(scale);
                }
                value[key] = info;
            }
            out["extensions"][name] = value;
            self.used.push(name);
        }
        out
    }

    fn texture(&mut self, model: &Model, at: TextureUse, images: &mut [Option<usize>]) -> Option<Value> {
        let source = match *images.get(at.image)? {
            Some(written) => written,
            None => {
                let image = &model.images[at.image];
                let mut png = Cursor::new(Vec::new());
                let (rgba, color) = (&image.rgba, image::ExtendedColorType::Rgba8);
                // Only an image without pixels cannot be written.
                image::write_buffer_with_format(&mut png, rgba, image.width, image.height, color, ImageFormat::Png)
                    .ok()?;
                let view = self.view(&png.into_inner());
                self.images.push(json!({ "bufferView": view, "mimeType": "image/png" }));
                images[at.image] = Some(self.images.len() - 1);
                self.images.len() - 1
            }
        };
        let sampler = one_of(&mut self.samplers, sampler(at.sampler));
        let texture = one_of(&mut self.textures, json!({ "source": source, "sampler": sampler }));
        let mut info = json!({ "index": texture });
        if at.set != 0 {
            info["texCoord"] = json!(at.set);
        }
        if at.transform != TextureUse::of(0).transform {
            info["extensions"] = json!({ "KHR_texture_transform": moved(at.transform) });
            self.used.push("KHR_texture_transform");
        }
        Some(info)
    }
}

/// Index of an equal value in the list, which is added if missing.
fn one_of(list: &mut Vec<Value>, value: Value) -> usize {
    list.iter().position(|other| *other == value).unwrap_or_else(|| {
        list.push(value);
        list.len() - 1
    })
}

fn sampler(sampler: Sampler) -> Value {
    let wrap = sampler.wrap.map(|wrap| match wrap {
        Wrap::Repeat => 10497,
        Wrap::Mirror => 33648,
        Wrap::Clamp => 33071,
    });
    let far = match (sampler.smooth_far, sampler.levels) {
        (false, Levels::None) => 9728,
        (true, Levels::None) => 9729,
        (false, Levels::Nearest) => 9984,
        (true, Levels::Nearest) => 9985,
        (false, Levels::Blended) => 9986,
        (true, Levels::Blended) => 9987,
    };
    let near = if sampler.smooth_near { 9729 } else { 9728 };
    json!({ "wrapS": wrap[0], "wrapT": wrap[1], "minFilter": far, "magFilter": near })
}

/// Rows [c w, s h, x], [−s w, c h, y] as offset, rotation and scale.
fn moved([u, v]: [[f32; 3]; 2]) -> Value {
    let [[a, b, x], [c, d, y]] = [u, v].map(|row| row.map(f64::from));
    let (width, height) = (sqrt(a * a + c * c), sqrt(b * b + d * d));
    // A mirrored transform has a negative height.
    let height = if a * d - b * c < 0.0 { -height } else { height };
    json!({ "offset": [x, y], "rotation": atan2(-c, a), "scale": [width, height] })
}

/// Textures of an extension, by their names there; normal maps with their scale.
fn details(look: &Appearance, extension: &str) -> Vec<(&'static str, TextureUse, Option<f32>)> {
    let of = &look.details;
    let named: Vec<(&'static str, Option<TextureUse>)> = match extension {
        "KHR_materials_transmission" => vec![("transmissionTexture", of.transmission)],
        "KHR_materials_volume" => vec![("thicknessTexture", of.thickness)],
        "KHR_materials_specular" => vec![("specularTexture", of.specular), ("specularColorTexture", of.specular_color)],
        "KHR_materials_clearcoat" => {
            vec![("clearcoatTexture", of.coat), ("clearcoatRoughnessTexture", of.coat_roughness)]
        }
        "KHR_materials_sheen" => vec![("sheenColorTexture", of.sheen), ("sheenRoughnessTexture", of.sheen_roughness)],
        _ => Vec::new(),
    };
    let normal = of.coat_normal.filter(|_| extension == "KHR_materials_clearcoat");
    let normal = normal.map(|map| ("clearcoatNormalTexture", map.texture, Some(map.scale)));
    named.into_iter().filter_map(|(key, at)| Some((key, at?, None))).chain(normal).collect()
}

/// The extensions of a material.
fn extensions(look: &Appearance, strength: f32) -> Vec<(&'static str, Value)> {
    let mut out = Vec::new();
    if look.unlit {
        // This extension excludes all others.
        return vec![("KHR_materials_unlit", json!({}))];
    }
    let plain = Appearance::default();
    if strength > 1.0 {
        out.push(("KHR_materials_emissive_strength", json!({ "emissiveStrength": strength })));
    }
    if look.ior != plain.ior {
        out.push(("KHR_materials_ior", json!({ "ior": look.ior })));
    }
    let tinted = look.details.specular.or(look.details.specular_color).is_some();
    if tinted || look.specular != plain.specular || look.specular_color != plain.specular_color {
        let (factor, color) = (look.specular, look.specular_color);
        out.push(("KHR_materials_specular", json!({ "specularFactor": factor, "specularColorFactor": color })));
    }
    if look.transmission > 0.0 {
        out.push(("KHR_materials_transmission", json!({ "transmissionFactor": look.transmission })));
        if look.thickness > 0.0 {
            let mut volume = json!({ "thicknessFactor": look.thickness, "attenuationColor": look.attenuation_color });
            if look.attenuation_distance.is_finite() {
                volume["attenuationDistance"] = json!(look.attenuation_distance);
            }
            out.push(("KHR_materials_volume", volume));
        }
    }
    if look.coat > 0.0 {
        let coat = json!({ "clearcoatFactor": look.coat, "clearcoatRoughnessFactor": look.coat_roughness });
        out.push(("KHR_materials_clearcoat", coat));
    }
    if look.sheen != plain.sheen {
        let sheen = json!({ "sheenColorFactor": look.sheen, "sheenRoughnessFactor": look.sheen_roughness });
        out.push(("KHR_materials_sheen", sheen));
    }
    out
}

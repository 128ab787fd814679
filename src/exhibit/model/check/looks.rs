//! Cameras, lights, images, textures and materials.

use std::collections::BTreeSet;

use serde_json::Value;

use super::super::fault::{Cause, Fault};
use super::buffers::Use;
use super::tables::{GREATEST_FOV, LEAST_FOV, PUNCTUAL};
use super::{Check, whole};

/// Greatest intensity of a light, cd or lx: ten thousand times full sunlight, which has 10⁵ lx.
const MAX_INTENSITY: f64 = 1e9;
/// Greatest factor of an emitted colour; the brightest lamps are some 10⁷ times as bright as white paper in a room.
const MAX_EMISSION: f64 = 1e9;
/// Remedy for both.
const DIM: &str = "give it the brightness of a real lamp in the program that made the model, and export again";

/// Every texture reference below a value: its path and its object.
fn textures<'v>(value: &'v Value, place: &str, found: &mut Vec<(String, &'v Value)>) {
    for (key, held) in value.as_object().into_iter().flatten().filter(|(key, _)| *key != "extras") {
        let at = format!("{place}.{key}");
        if key.ends_with("Texture") && held.get("index").is_some() {
            found.push((at, held));
        } else {
            textures(held, &at, found);
        }
    }
}

impl Check<'_> {
    pub(super) fn looks(&mut self) {
        for (index, camera) in self.list("cameras").iter().enumerate() {
            self.camera(camera, &format!("cameras[{index}]"));
        }
        let lights = self.root["extensions"][PUNCTUAL]["lights"].as_array();
        for (index, light) in lights.into_iter().flatten().enumerate() {
            self.light(light, &format!("extensions.{PUNCTUAL}.lights[{index}]"));
        }
        for (index, image) in self.list("images").iter().enumerate() {
            self.image(image, &format!("images[{index}]"));
        }
        for (index, material) in self.list("materials").iter().enumerate() {
            let ior = material["extensions"]["KHR_materials_ior"]["ior"].as_f64();
            if let Some(ior) = ior.filter(|ior| *ior > 0.0 && *ior < 1.0) {
                let place = format!("materials[{index}].extensions.KHR_materials_ior.ior");
                self.faults.add(Cause::Range, place, format_args!("is {ior}; it must be 0, or at least 1"));
            }
        }
        for (index, material) in self.list("materials").iter().enumerate() {
            let strength = material["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"].as_f64();
            if let Some(strength) = strength.filter(|strength| *strength > MAX_EMISSION) {
                let place = format!("materials[{index}].extensions.KHR_materials_emissive_strength.emissiveStrength");
                let what = format_args!("is {strength:e}; the limit is {MAX_EMISSION:e}");
                self.faults.push(Fault::at(Cause::Size, place, what).remedy(DIM));
            }
        }
        for (m, mesh) in self.list("meshes").iter().enumerate() {
            for (p, primitive) in mesh["primitives"].as_array().into_iter().flatten().enumerate() {
                self.variants(primitive, &format!("meshes[{m}].primitives[{p}].extensions.KHR_materials_variants"));
            }
        }
        for (index, animation) in self.list("animations").iter().enumerate() {
            self.pointers(animation, index);
        }
    }

    fn camera(&mut self, camera: &Value, place: &str) {
        let kind = camera["type"].as_str().unwrap_or_default();
        if camera.get(kind).is_none() {
            self.faults.add(Cause::Missing, format_args!("{place}.{kind}"), "is missing");
        }
        let other = if kind == "perspective" { "orthographic" } else { "perspective" };
        if camera.get(other).is_some() {
            self.warn(format_args!("{place}.{other}"), format_args!("is ignored: the camera's type is {kind}"));
        }
        let lens = &camera[kind];
        let number = |key: &str| lens[key].as_f64();
        if let (Some(near), Some(far)) = (number("znear"), number("zfar"))
            && far <= near
        {
            self.warn(
                format_args!("{place}.{kind}.zfar"),
                format_args!("is {far}, not above znear {near}; neither is used"),
            );
        }
        for key in ["xmag", "ymag"] {
            if number(key) == Some(0.0) {
                self.warn(format_args!("{place}.{kind}.{key}"), "is 0; it is not used");
            }
        }
        if let Some(fov) = number("yfov").filter(|fov| !(LEAST_FOV..=GREATEST_FOV).contains(fov)) {
            let what = format_args!("is {fov}; a picture is made for {LEAST_FOV} to {GREATEST_FOV:.2} rad");
            self.faults.add(Cause::Skipped, format_args!("{place}.{kind}.yfov"), what);
        }
    }

    fn light(&mut self, light: &Value, place: &str) {
        if let Some(intensity) = light["intensity"].as_f64().filter(|intensity| *intensity > MAX_INTENSITY) {
            let what = format_args!("is {intensity:e}; a light has at most {MAX_INTENSITY:e} cd or lx");
            self.faults.push(Fault::at(Cause::Size, format_args!("{place}.intensity"), what).remedy(DIM));
        }
        if light["type"] != "spot" {
            return;
        }
        let Some(spot) = light.get("spot") else {
            self.faults.add(Cause::Missing, format_args!("{place}.spot"), "is missing: a spot has its angles there");
            return;
        };
        let inner = spot["innerConeAngle"].as_f64().unwrap_or(0.0);
        let outer = spot["outerConeAngle"].as_f64().unwrap_or(std::f64::consts::FRAC_PI_4);
        if outer <= inner {
            let what = format_args!("is {outer}; it must be above innerConeAngle {inner}");
            self.faults.add(Cause::Range, format_args!("{place}.spot.outerConeAngle"), what);
        }
    }

    fn image(&mut self, image: &Value, place: &str) {
        match (image.get("uri"), whole(image, "bufferView")) {
            (None, None) => self.faults.add(Cause::Missing, place, "has neither a uri nor a bufferView"),
            (Some(_), Some(_)) => self.faults.add(Cause::Conflict, place, "has both a uri and a bufferView"),
            (None, Some(view)) => {
                self.used(view, Use::Other("an image"), &format!("{place}.bufferView"));
                if image.get("mimeType").is_none() {
                    self.warn(format_args!("{place}.mimeType"), "is missing; the image's own bytes say what it is");
                }
            }
            (Some(_), None) => {}
        }
    }

    fn variants(&mut self, primitive: &Value, place: &str) {
        let mappings = &primitive["extensions"]["KHR_materials_variants"]["mappings"];
        let mut seen: BTreeSet<u64> = BTreeSet::new();
        for (index, mapping) in mappings.as_array().into_iter().flatten().enumerate() {
            for variant in mapping["variants"].as_array().into_iter().flatten().filter_map(Value::as_u64) {
                if !seen.insert(variant) {
                    self.warn(format_args!("{place}.mappings[{index}]"), format_args!("names variant {variant} again"));
                }
            }
        }
    }

    fn pointers(&mut self, animation: &Value, index: usize) {
        for (c, channel) in animation["channels"].as_array().into_iter().flatten().enumerate() {
            if channel["target"]["extensions"].get("KHR_animation_pointer").is_some() {
                let what = "has a pointer beside its node; the node's property is moved";
                self.warn(format_args!("animations[{index}].channels[{c}].target"), what);
            }
        }
    }

    /// Textures read coordinates that the primitive has; normal maps and anisotropy want tangents.
    pub(super) fn texture_coordinates(
        &mut self,
        primitive: &Value,
        attributes: &serde_json::Map<String, Value>,
        place: &str,
    ) {
        let Some(material) = whole(primitive, "material") else { return };
        let mut found = Vec::new();
        textures(&self.list("materials")[material], &format!("materials[{material}]"), &mut found);
        for (at, info) in &found {
            let moved = whole(&info["extensions"]["KHR_texture_transform"], "texCoord");
            let set = moved.or(whole(info, "texCoord")).unwrap_or(0);
            if !attributes.contains_key(&format!("TEXCOORD_{set}")) {
                let what = format_args!("has no TEXCOORD_{set}, which {at} reads; the texture is not seen");
                self.faults.add(Cause::Harmless, format_args!("{place}.attributes"), what);
            }
        }
        let wants = |key: &str| found.iter().any(|(at, _)| at.ends_with(key));
        let tangents = attributes.contains_key("TANGENT") && attributes.contains_key("NORMAL");
        let space = wants(".anisotropyTexture") || wants(".clearcoatNormalTexture");
        if space && !tangents && !wants("].normalTexture") {
            self.warn(format_args!("{place}.material"), "needs tangents, which the primitive does not have");
        }
    }
}

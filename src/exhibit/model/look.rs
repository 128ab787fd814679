//! Appearances of a glTF file, and flat normals where it has none.

use gltf::material::AlphaMode as GltfAlpha;

use super::{AlphaMode, Appearance, Primitive};
use crate::math::DVec3;

/// The metallic–roughness appearance of a glTF material.
pub fn appearance(material: &gltf::Material) -> Appearance {
    let surface = material.pbr_metallic_roughness();
    let strength = material.emissive_strength().unwrap_or(1.0);
    let image = |info: gltf::texture::Info| info.texture().source().index();
    Appearance {
        name: material.name().unwrap_or_default().to_owned(),
        base_color: surface.base_color_factor(),
        base_color_texture: surface.base_color_texture().map(image),
        metallic: surface.metallic_factor(),
        roughness: surface.roughness_factor(),
        metallic_roughness_texture: surface.metallic_roughness_texture().map(image),
        normal_texture: material.normal_texture().map(|t| (t.texture().source().index(), t.scale())),
        occlusion_texture: material.occlusion_texture().map(|t| (t.texture().source().index(), t.strength())),
        emissive: material.emissive_factor().map(|c| c * strength),
        emissive_texture: material.emissive_texture().map(image),
        alpha: match material.alpha_mode() {
            GltfAlpha::Opaque => AlphaMode::Opaque,
            GltfAlpha::Mask => AlphaMode::Mask(material.alpha_cutoff().unwrap_or(0.5)),
            GltfAlpha::Blend => AlphaMode::Blend,
        },
        double_sided: material.double_sided(),
    }
}

/// Gives a primitive without normals flat ones, as glTF 2.0 asks (3.7.2.1): each triangle gets corners of its own.
pub fn flatten(primitive: &mut Primitive, positions: Vec<[f32; 3]>) {
    let pick = |list: &mut Vec<[f32; 2]>, indices: &[u32]| {
        *list = if list.is_empty() { Vec::new() } else { indices.iter().map(|&i| list[i as usize]).collect() };
    };
    let indices = std::mem::take(&mut primitive.indices);
    pick(&mut primitive.uvs, &indices);
    let colors = std::mem::take(&mut primitive.colors);
    if !colors.is_empty() {
        primitive.colors = indices.iter().map(|&i| colors[i as usize]).collect();
    }
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

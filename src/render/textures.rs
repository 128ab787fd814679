//! Materials: uniforms, textures and their mip maps.
//!
//! Colour images are averaged in linear light for the smaller levels; data images (roughness, normals) as they are.

use std::collections::BTreeMap;

use bytemuck::{Pod, Zeroable};
use wgpu::util::DeviceExt;

use super::fixtures::Fixtures;
use super::{Gpu, details};
use soffio_exhibit::model::{AlphaMode, Appearance, Image, Levels, Model, Sampler, TextureUse, Wrap};

/// `Material` of `forward.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct MaterialUniform {
    base_color: [f32; 4],
    emissive: [f32; 3],
    metallic: f32,
    roughness: f32,
    normal_scale: f32,
    occlusion: f32,
    cutoff: f32,
    f0: [f32; 3],
    f90: f32,
    absorption: [f32; 3],
    thickness: f32,
    sheen: [f32; 3],
    sheen_roughness: f32,
    transmission: f32,
    ior: f32,
    coat: f32,
    coat_roughness: f32,
    unlit: f32,
    coat_normal_scale: f32,
    spare: [f32; 2],
    uv: [[f32; 4]; 2 * PLACES],
}

/// Textures that have a place of their own on a surface.
const PLACES: usize = 5 + 9;

/// Bind groups of all appearances of a model, and last of the default one.
pub(super) fn materials(gpu: &Gpu, model: &Model, fixtures: &mut Fixtures) -> Vec<wgpu::BindGroup> {
    let Fixtures { layouts, white, no_details, samplers, .. } = fixtures;
    let mut textures = Textures { gpu, images: &model.images, made: BTreeMap::new(), samplers };
    let default = Appearance { metallic: 0.0, roughness: 0.6, ..Appearance::default() };
    model
        .materials
        .iter()
        .chain([&default])
        .map(|look| {
            let uses = uses(look);
            let color = [true, false, false, false, true];
            let views: Vec<_> =
                uses.iter().zip(color).map(|(t, srgb)| textures.view(t.map(|t| t.image), srgb, white)).collect();
            let samplers: Vec<_> =
                uses.iter().map(|t| textures.sampler(t.map_or(Sampler::default(), |t| t.sampler))).collect();
            let uniform = gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: Some(&look.name),
                contents: bytemuck::bytes_of(&uniform(look)),
                usage: wgpu::BufferUsages::UNIFORM,
            });
            let detail_views = details::views(gpu, &model.images, &look.details, no_details);
            let first = look.details.all().into_iter().flatten().next();
            let detail_sampler = textures.sampler(first.map_or(Sampler::default(), |texture| texture.sampler));
            let entries: Vec<_> = std::iter::once(uniform.as_entire_binding())
                .chain(views.iter().map(wgpu::BindingResource::TextureView))
                .chain(samplers.iter().map(wgpu::BindingResource::Sampler))
                .chain(detail_views.iter().map(wgpu::BindingResource::TextureView))
                .chain([wgpu::BindingResource::Sampler(&detail_sampler)])
                .zip(0..)
                .map(|(resource, binding)| wgpu::BindGroupEntry { binding, resource })
                .collect();
            gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some(&look.name),
                layout: &layouts.material,
                entries: &entries,
            })
        })
        .collect()
}

/// One white texel.
pub(super) fn white(gpu: &Gpu) -> wgpu::TextureView {
    upload(gpu, &Image { width: 1, height: 1, rgba: vec![255; 4] }, false)
}

/// The images of an appearance in the order of the bindings.
fn uses(look: &Appearance) -> [Option<TextureUse>; 5] {
    [
        look.base_color_texture,
        look.metallic_roughness_texture,
        look.normal_texture.map(|t| t.0),
        look.occlusion_texture.map(|t| t.0),
        look.emissive_texture,
    ]
}

fn uniform(look: &Appearance) -> MaterialUniform {
    let mut base_color = look.base_color;
    if look.alpha == AlphaMode::Opaque {
        // Coverage is the affair of the other modes.
        base_color[3] = 1.0;
    }
    // Schlick's F0 of a boundary to air, and KHR_materials_specular's tint of it.
    let mirror = (look.ior - 1.0) / (look.ior + 1.0);
    let f0 = look.specular_color.map(|c| (mirror * mirror * c).min(1.0) * look.specular);
    let absorption = look.attenuation_color.map(|c| -c.clamp(1e-4, 1.0).ln() / look.attenuation_distance);
    let mut uv = [[0.0; 4]; 2 * PLACES];
    for (i, texture) in uses(look).iter().chain(&look.details.all()).enumerate() {
        let TextureUse { transform: [u, v], set, .. } = texture.unwrap_or(TextureUse::of(0));
        uv[2 * i] = [u[0], u[1], u[2], set as f32];
        uv[2 * i + 1] = [v[0], v[1], v[2], 0.0];
    }
    MaterialUniform {
        base_color,
        emissive: look.emissive,
        metallic: look.metallic,
        roughness: look.roughness,
        normal_scale: look.normal_texture.map_or(0.0, |t| t.1),
        occlusion: look.occlusion_texture.map_or(0.0, |t| t.1),
        cutoff: if let AlphaMode::Mask(cutoff) = look.alpha { cutoff.max(1e-6) } else { 0.0 },
        f0,
        f90: look.specular,
        absorption,
        thickness: look.thickness,
        sheen: look.sheen,
        sheen_roughness: look.sheen_roughness,
        transmission: look.transmission,
        ior: look.ior,
        coat: look.coat,
        coat_roughness: look.coat_roughness,
        unlit: if look.unlit { 1.0 } else { 0.0 },
        coat_normal_scale: look.details.coat_normal.map_or(0.0, |(_, scale)| scale),
        spare: [0.0; 2],
        uv,
    }
}

/// Uploads each image once for each use.
struct Textures<'a> {
    gpu: &'a Gpu,
    images: &'a [Image],
    made: BTreeMap<(usize, bool), wgpu::TextureView>,
    samplers: &'a mut BTreeMap<Sampler, wgpu::Sampler>,
}

impl Textures<'_> {
    fn sampler(&mut self, sampler: Sampler) -> wgpu::Sampler {
        let wrap = |mode| match mode {
            Wrap::Repeat => wgpu::AddressMode::Repeat,
            Wrap::Mirror => wgpu::AddressMode::MirrorRepeat,
            Wrap::Clamp => wgpu::AddressMode::ClampToEdge,
        };
        let filter = |smooth| if smooth { wgpu::FilterMode::Linear } else { wgpu::FilterMode::Nearest };
        let smooth = sampler.smooth_near && sampler.smooth_far && sampler.levels == Levels::Blended;
        let make = || {
            self.gpu.device.create_sampler(&wgpu::SamplerDescriptor {
                label: Some("material"),
                address_mode_u: wrap(sampler.wrap[0]),
                address_mode_v: wrap(sampler.wrap[1]),
                mag_filter: filter(sampler.smooth_near),
                min_filter: filter(sampler.smooth_far),
                mipmap_filter: match sampler.levels {
                    Levels::Blended => wgpu::MipmapFilterMode::Linear,
                    Levels::Nearest | Levels::None => wgpu::MipmapFilterMode::Nearest,
                },
                lod_max_clamp: if sampler.levels == Levels::None { 0.0 } else { 32.0 },
                // Painted sheets are often seen edge on.
                anisotropy_clamp: if smooth && !self.gpu.is_software() { 8 } else { 1 },
                ..Default::default()
            })
        };
        self.samplers.entry(sampler).or_insert_with(make).clone()
    }

    fn view(&mut self, image: Option<usize>, srgb: bool, white: &wgpu::TextureView) -> wgpu::TextureView {
        let Some((index, image)) = image.and_then(|i| Some((i, self.images.get(i)?))) else { return white.clone() };
        // An image that no adapter could hold is shown as white rather than not at all.
        let limit = self.gpu.device.limits().max_texture_dimension_2d;
        if image.width == 0 || image.height == 0 || image.width.max(image.height) > limit {
            tracing::warn!("image {index} is {}x{}, beyond 1 to {limit}: left white", image.width, image.height);
            return white.clone();
        }
        if let Some(view) = self.made.get(&(index, srgb)) {
            return view.clone();
        }
        let view = upload(self.gpu, image, srgb);
        self.made.insert((index, srgb), view.clone());
        view
    }
}

/// An image and its smaller levels.
fn upload(gpu: &Gpu, image: &Image, srgb: bool) -> wgpu::TextureView {
    texture(gpu, std::slice::from_ref(image), srgb).create_view(&Default::default())
}

/// Images of one size as the layers of a texture, each with its smaller levels.
pub(super) fn texture(gpu: &Gpu, layers: &[Image], srgb: bool) -> wgpu::Texture {
    let chains: Vec<Vec<Vec<u8>>> = layers.iter().map(|image| mip_chain(image, srgb)).collect();
    let (width, height) = layers.first().map_or((1, 1), |image| (image.width, image.height));
    gpu.device.create_texture_with_data(
        &gpu.queue,
        &wgpu::TextureDescriptor {
            label: Some("material image"),
            size: wgpu::Extent3d { width, height, depth_or_array_layers: layers.len() as u32 },
            mip_level_count: chains.first().map_or(1, |levels| levels.len() as u32),
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: if srgb { wgpu::TextureFormat::Rgba8UnormSrgb } else { wgpu::TextureFormat::Rgba8Unorm },
            usage: wgpu::TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        },
        wgpu::util::TextureDataOrder::LayerMajor,
        &chains.concat().concat(),
    )
}

/// The image and its halves down to one pixel, each the box average of the one before.
fn mip_chain(image: &Image, srgb: bool) -> Vec<Vec<u8>> {
    let (mut width, mut height) = (image.width as usize, image.height as usize);
    let mut levels = vec![image.rgba.clone()];
    levels[0].resize(width * height * 4, 255);
    let decode: Vec<f32> =
        (0..=255).map(|c| if srgb { to_linear(c as f32 / 255.0) } else { c as f32 / 255.0 }).collect();
    while width > 1 || height > 1 {
        let above = &levels[levels.len() - 1];
        let (w, h) = ((width / 2).max(1), (height / 2).max(1));
        let mut level = Vec::with_capacity(w * h * 4);
        for y in 0..h {
            for x in 0..w {
                for channel in 0..4 {
                    let mut sum = 0.0;
                    for (dx, dy) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
                        let (sx, sy) = ((2 * x + dx).min(width - 1), (2 * y + dy).min(height - 1));
                        let code = above[(sy * width + sx) * 4 + channel];
                        sum += if channel < 3 { decode[code as usize] } else { code as f32 / 255.0 };
                    }
                    let mean = 0.25 * sum;
                    let value = if srgb && channel < 3 { to_srgb(mean) } else { mean };
                    level.push((value * 255.0 + 0.5) as u8);
                }
            }
        }
        levels.push(level);
        (width, height) = (w, h);
    }
    levels
}

/// sRGB code (0 … 1) to linear light.
pub(super) fn to_linear(c: f32) -> f32 {
    if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
}

/// Linear light to sRGB code (0 … 1).
pub(super) fn to_srgb(c: f32) -> f32 {
    if c <= 0.003_130_8 { 12.92 * c } else { 1.055 * c.powf(1.0 / 2.4) - 0.055 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_are_averaged_in_linear_light_and_data_as_it_is() {
        let image = Image { width: 2, height: 1, rgba: vec![0, 0, 0, 255, 255, 255, 255, 255] };
        // Half the light of white is the sRGB code 188.
        assert_eq!(mip_chain(&image, true)[1], [188, 188, 188, 255]);
        assert_eq!(mip_chain(&image, false)[1], [128, 128, 128, 255]);
        let odd = Image { width: 5, height: 3, rgba: vec![7; 60] };
        assert_eq!(mip_chain(&odd, false).iter().map(Vec::len).collect::<Vec<_>>(), [60, 8, 4]);
    }
}

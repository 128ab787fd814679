//! Materials: uniforms, textures and their mip maps.
//!
//! Colour images are averaged in linear light for the smaller levels; data images (roughness, normals) as they are.

use std::collections::BTreeMap;

use bytemuck::{Pod, Zeroable};
use wgpu::util::DeviceExt;

use super::Gpu;
use crate::exhibit::model::{AlphaMode, Appearance, Image, Model};

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
    spare: [f32; 4],
}

/// Bind groups of all appearances of a model, and last of the default one.
pub(super) fn materials(gpu: &Gpu, model: &Model, layout: &wgpu::BindGroupLayout) -> Vec<wgpu::BindGroup> {
    let mut textures = Textures { gpu, images: &model.images, made: BTreeMap::new() };
    let white = textures.upload(&Image { width: 1, height: 1, rgba: vec![255; 4] }, false);
    let sampler = gpu.device.create_sampler(&wgpu::SamplerDescriptor {
        label: Some("material"),
        address_mode_u: wgpu::AddressMode::Repeat,
        address_mode_v: wgpu::AddressMode::Repeat,
        mag_filter: wgpu::FilterMode::Linear,
        min_filter: wgpu::FilterMode::Linear,
        mipmap_filter: wgpu::MipmapFilterMode::Linear,
        // Painted sheets are often seen edge on.
        anisotropy_clamp: if gpu.is_software() { 1 } else { 8 },
        ..Default::default()
    });
    let default = Appearance { metallic: 0.0, roughness: 0.6, ..Appearance::default() };
    model
        .materials
        .iter()
        .chain([&default])
        .map(|look| {
            let views = [
                textures.view(look.base_color_texture, true, &white),
                textures.view(look.metallic_roughness_texture, false, &white),
                textures.view(look.normal_texture.map(|t| t.0), false, &white),
                textures.view(look.occlusion_texture.map(|t| t.0), false, &white),
                textures.view(look.emissive_texture, true, &white),
            ];
            let uniform = gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: Some(&look.name),
                contents: bytemuck::bytes_of(&uniform(look)),
                usage: wgpu::BufferUsages::UNIFORM,
            });
            let mut entries = vec![
                wgpu::BindGroupEntry { binding: 0, resource: uniform.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::Sampler(&sampler) },
            ];
            entries.extend((2..).zip(&views).map(|(binding, view)| wgpu::BindGroupEntry {
                binding,
                resource: wgpu::BindingResource::TextureView(view),
            }));
            gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some(&look.name),
                layout,
                entries: &entries,
            })
        })
        .collect()
}

fn uniform(look: &Appearance) -> MaterialUniform {
    let mut base_color = look.base_color;
    if look.alpha != AlphaMode::Blend {
        // Coverage is the mask's affair; what remains is opaque.
        base_color[3] = if matches!(look.alpha, AlphaMode::Mask(_)) { base_color[3] } else { 1.0 };
    }
    MaterialUniform {
        base_color,
        emissive: look.emissive,
        metallic: look.metallic,
        roughness: look.roughness,
        normal_scale: look.normal_texture.map_or(0.0, |t| t.1),
        occlusion: look.occlusion_texture.map_or(0.0, |t| t.1),
        cutoff: if let AlphaMode::Mask(cutoff) = look.alpha { cutoff.max(1e-6) } else { 0.0 },
        spare: [0.0; 4],
    }
}

/// Uploads each image once for each use.
struct Textures<'a> {
    gpu: &'a Gpu,
    images: &'a [Image],
    made: BTreeMap<(usize, bool), wgpu::TextureView>,
}

impl Textures<'_> {
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
        let view = self.upload(image, srgb);
        self.made.insert((index, srgb), view.clone());
        view
    }

    fn upload(&self, image: &Image, srgb: bool) -> wgpu::TextureView {
        let levels = mip_chain(image, srgb);
        let format = if srgb { wgpu::TextureFormat::Rgba8UnormSrgb } else { wgpu::TextureFormat::Rgba8Unorm };
        let texture = self.gpu.device.create_texture_with_data(
            &self.gpu.queue,
            &wgpu::TextureDescriptor {
                label: Some("material image"),
                size: wgpu::Extent3d { width: image.width, height: image.height, depth_or_array_layers: 1 },
                mip_level_count: levels.len() as u32,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: wgpu::TextureUsages::TEXTURE_BINDING,
                view_formats: &[],
            },
            wgpu::util::TextureDataOrder::LayerMajor,
            &levels.concat(),
        );
        texture.create_view(&Default::default())
    }
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
fn to_linear(c: f32) -> f32 {
    if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
}

/// Linear light to sRGB code (0 … 1).
fn to_srgb(c: f32) -> f32 {
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

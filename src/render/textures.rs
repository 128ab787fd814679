//! Textures and mip maps.
//!
//! Colour images are averaged in linear light for the smaller levels; data images (roughness, normals) are averaged as
//! stored.

use wgpu::util::DeviceExt;

use super::Gpu;
use soffio_exhibit::model::Image;

/// What the codes of an image mean.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum ColorSpace {
    /// Colours in the sRGB transfer function.
    Srgb,
    /// Numbers as they are: roughness, normals.
    Linear,
}

/// One white texel.
pub(super) fn white(gpu: &Gpu) -> wgpu::TextureView {
    upload(gpu, &Image { width: 1, height: 1, rgba: vec![255; 4] }, ColorSpace::Linear)
}

/// A texture of an image with all its mip levels.
pub(super) fn upload(gpu: &Gpu, image: &Image, space: ColorSpace) -> wgpu::TextureView {
    texture(gpu, std::slice::from_ref(image), space).create_view(&Default::default())
}

/// An array texture of images of one size, each with all its mip levels.
pub(super) fn texture(gpu: &Gpu, layers: &[Image], space: ColorSpace) -> wgpu::Texture {
    let chains: Vec<Vec<Vec<u8>>> = layers.iter().map(|image| mip_chain(image, space)).collect();
    let (width, height) = layers.first().map_or((1, 1), |image| (image.width, image.height));
    gpu.device.create_texture_with_data(
        &gpu.queue,
        &wgpu::TextureDescriptor {
            label: Some("material image"),
            size: wgpu::Extent3d { width, height, depth_or_array_layers: layers.len() as u32 },
            mip_level_count: chains.first().map_or(1, |levels| levels.len() as u32),
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: match space {
                ColorSpace::Srgb => wgpu::TextureFormat::Rgba8UnormSrgb,
                ColorSpace::Linear => wgpu::TextureFormat::Rgba8Unorm,
            },
            usage: wgpu::TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        },
        wgpu::util::TextureDataOrder::LayerMajor,
        &chains.concat().concat(),
    )
}

/// All mip levels down to one pixel, each the box average of the one before.
fn mip_chain(image: &Image, space: ColorSpace) -> Vec<Vec<u8>> {
    let is_srgb = space == ColorSpace::Srgb;
    let (mut width, mut height) = (image.width as usize, image.height as usize);
    let mut levels = vec![image.rgba.clone()];
    levels[0].resize(width * height * 4, 255);
    let decode: Vec<f32> =
        (0..=255).map(|c| if is_srgb { to_linear(c as f32 / 255.0) } else { c as f32 / 255.0 }).collect();
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
                    let value = if is_srgb && channel < 3 { to_srgb(mean) } else { mean };
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
        assert_eq!(mip_chain(&image, ColorSpace::Srgb)[1], [188, 188, 188, 255]);
        assert_eq!(mip_chain(&image, ColorSpace::Linear)[1], [128, 128, 128, 255]);
        let odd = Image { width: 5, height: 3, rgba: vec![7; 60] };
        assert_eq!(mip_chain(&odd, ColorSpace::Linear).iter().map(Vec::len).collect::<Vec<_>>(), [60, 8, 4]);
    }
}

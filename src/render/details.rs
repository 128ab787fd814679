//! Packed textures of glTF material extensions. A fragment shader can read 16 textures, and nine for extensions would
//! be too many beside the five of the core and the eight of the light.
//!
//! Each extension reads certain channels, so its textures share the layers of two texture arrays:
//!
//! ```text
//! colours (sRGB)   0: specular colour, specular strength in alpha      1: sheen colour, sheen roughness in alpha
//! data (linear)    0: transmission, thickness, coat, coat roughness      1: coat normal
//! ```
//!
//! Each texture keeps its own coordinates (set and transform), since it is sampled by itself. Smaller images are
//! enlarged to the largest of their array, which changes only which four pixels are blended.

use std::sync::Arc;

use super::Gpu;
use super::textures::{ColorSpace, texture};
use soffio_exhibit::model::{Details, Image, TextureUse};

/// Source of a channel: a texture, its first channel, and the first channel it fills.
type Fill = (Option<TextureUse>, usize, usize, usize);

/// The texture arrays of an appearance: colours and data; unused channels are white.
pub(super) fn views(
    gpu: &Gpu,
    images: &[Arc<Image>],
    of: &Details,
    none: &[wgpu::TextureView; 2],
) -> [wgpu::TextureView; 2] {
    // Texture, first channel there, first channel here, number of channels.
    let colors: [&[Fill]; 2] = [
        &[(of.specular_color, 0, 0, 3), (of.specular, 3, 3, 1)],
        &[(of.sheen, 0, 0, 3), (of.sheen_roughness, 3, 3, 1)],
    ];
    let data: [&[Fill]; 2] = [
        &[(of.transmission, 0, 0, 1), (of.thickness, 1, 1, 1), (of.coat, 0, 2, 1), (of.coat_roughness, 1, 3, 1)],
        &[(of.coat_normal.map(|map| map.texture), 0, 0, 3)],
    ];
    let limit = gpu.device.limits().max_texture_dimension_2d;
    [(colors, ColorSpace::Srgb), (data, ColorSpace::Linear)].map(|(layers, space)| match pack(images, &layers, limit) {
        Some(packed) => array(gpu, &packed, space),
        None => none[space as usize].clone(),
    })
}

/// Arrays without effect.
pub(super) fn none(gpu: &Gpu) -> [wgpu::TextureView; 2] {
    let white = Image { width: 1, height: 1, rgba: vec![255; 4] };
    [ColorSpace::Srgb, ColorSpace::Linear].map(|space| array(gpu, &[white.clone(), white.clone()], space))
}

fn array(gpu: &Gpu, layers: &[Image], space: ColorSpace) -> wgpu::TextureView {
    texture(gpu, layers, space).create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(wgpu::TextureViewDimension::D2Array),
        ..Default::default()
    })
}

/// The packed layers, as large as the largest image in them; `None` where no texture is used.
fn pack(images: &[Arc<Image>], layers: &[&[Fill]], limit: u32) -> Option<Vec<Image>> {
    let image = |of: &Fill| {
        let image = images.get(of.0?.image)?;
        (image.width > 0 && image.height > 0 && image.width.max(image.height) <= limit).then_some(&**image)
    };
    let used: Vec<&Image> = layers.iter().flat_map(|layer| layer.iter().filter_map(image)).collect();
    let (width, height) = (used.iter().map(|i| i.width).max()?, used.iter().map(|i| i.height).max()?);
    let fill = |layer: &&[Fill]| {
        let mut rgba = vec![255; width as usize * height as usize * 4];
        for of in *layer {
            let (Some(source), (_, from, to, count)) = (image(of), *of) else { continue };
            let pixels = rgba.chunks_exact_mut(4).enumerate();
            for (i, pixel) in pixels {
                let (x, y) = (i as u32 % width, i as u32 / width);
                for channel in 0..count {
                    pixel[to + channel] = stretched(source, (x, y), (width, height), from + channel);
                }
            }
        }
        Image { width, height, rgba }
    };
    Some(layers.iter().map(fill).collect())
}

/// A channel of an image resampled bilinearly to a larger size.
fn stretched(image: &Image, (x, y): (u32, u32), (width, height): (u32, u32), channel: usize) -> u8 {
    let along = |at: u32, size: u32, own: u32| {
        let place = ((at as f32 + 0.5) * own as f32 / size as f32 - 0.5).clamp(0.0, (own - 1) as f32);
        (place as u32, (place as u32 + 1).min(own - 1), place.fract())
    };
    let (x0, x1, fx) = along(x, width, image.width);
    let (y0, y1, fy) = along(y, height, image.height);
    let at = |x: u32, y: u32| f32::from(image.rgba[(y * image.width + x) as usize * 4 + channel]);
    let row = |y: u32| at(x0, y) + (at(x1, y) - at(x0, y)) * fx;
    (row(y0) + (row(y1) - row(y0)) * fy + 0.5) as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn channels_go_where_they_are_read_and_small_images_are_stretched() {
        let one = Image { width: 1, height: 1, rgba: vec![10, 20, 30, 40] };
        let two = Image { width: 2, height: 1, rgba: vec![0, 100, 0, 0, 200, 50, 0, 0] };
        let of = |image: usize| Some(TextureUse::of(image));
        let layers: [&[Fill]; 2] = [&[(of(0), 1, 0, 1), (of(1), 0, 2, 1)], &[(None, 0, 0, 3), (of(9), 0, 3, 1)]];
        let packed = pack(&[Arc::new(one), Arc::new(two)], &layers, 8).expect("two images");
        assert_eq!((packed[0].width, packed[0].height), (2, 1));
        assert_eq!(packed[0].rgba, [20, 255, 0, 255, 20, 255, 200, 255]);
        assert_eq!(packed[1].rgba, [255; 8], "what is not there changes nothing");
        assert!(pack(&[], &layers, 8).is_none());
        let wide = Image { width: 2, height: 1, rgba: vec![0, 0, 0, 0, 100, 0, 0, 0] };
        let row: Vec<u8> = (0..4).map(|x| stretched(&wide, (x, 0), (4, 1), 0)).collect();
        assert_eq!(row, [0, 25, 75, 100]);
    }
}

//! Textures of the materials, read at a point.
//!
//! The nearest texel or the bilinear mean of four, of the full image: many samples per pixel replace the mip levels.
//! Wrapping, transform and set of coordinates are those of the file. Colours are decoded from sRGB before they are
//! interpolated, as graphics devices do.

use std::sync::Arc;

use glam::{Vec2, Vec4};

use super::super::textures::{ColorSpace, to_linear};
use soffio_exhibit::model::{Image, TextureUse, Wrap};

/// The images of a model, with the decoding tables of their codes.
pub(super) struct Textures<'a> {
    images: &'a [Arc<Image>],
    /// Value of each code: colours, then numbers.
    decode: [[f32; 256]; 2],
}

/// A texture as a material reads it.
#[derive(Clone, Copy)]
pub(super) struct Map {
    of: TextureUse,
    space: ColorSpace,
}

impl Map {
    /// The texture, whose codes mean this.
    pub fn new(of: TextureUse, space: ColorSpace) -> Self {
        Self { of, space }
    }

    /// Its coordinates, from both sets.
    pub fn place(&self, uv: [f32; 4]) -> Vec2 {
        let at = if self.of.set > 0 { [uv[2], uv[3]] } else { [uv[0], uv[1]] };
        Vec2::from_array(self.of.transform.map(|row| row[0] * at[0] + row[1] * at[1] + row[2]))
    }

    /// Difference of its coordinates for a difference of both sets.
    pub fn difference(&self, uv: [f32; 4]) -> Vec2 {
        self.place(uv) - self.place([0.0; 4])
    }
}

impl<'a> Textures<'a> {
    /// The textures of these images.
    pub fn new(images: &'a [Arc<Image>]) -> Self {
        let number = std::array::from_fn(|code| code as f32 / 255.0);
        Self { images, decode: [number.map(to_linear), number] }
    }

    /// Value of a texture at a vertex's coordinates; white where there is no texture.
    pub fn read(&self, map: Option<&Map>, uv: [f32; 4]) -> Vec4 {
        let image = map.and_then(|map| Some((map, self.images.get(map.of.image)?)));
        let Some((map, image)) = image.filter(|(_, image)| image.width > 0 && image.height > 0) else {
            return Vec4::ONE;
        };
        let at = map.place(uv) * Vec2::new(image.width as f32, image.height as f32);
        let at = if at.is_finite() { at } else { Vec2::ZERO };
        if !map.of.sampler.smooth_near {
            return self.texel(image, map, at.floor());
        }
        let corner = (at - 0.5).floor();
        let part = at - 0.5 - corner;
        let row = |y: f32| {
            let left = self.texel(image, map, corner + Vec2::new(0.0, y));
            left.lerp(self.texel(image, map, corner + Vec2::new(1.0, y)), part.x)
        };
        row(0.0).lerp(row(1.0), part.y)
    }

    /// Decoded texel in a column and row that may lie outside the image.
    fn texel(&self, image: &Image, map: &Map, at: Vec2) -> Vec4 {
        let inside = |at: f32, size: u32, wrap: Wrap| {
            let (at, size) = (at as i64, i64::from(size));
            match wrap {
                Wrap::Repeat => at.rem_euclid(size),
                Wrap::Clamp => at.clamp(0, size - 1),
                Wrap::Mirror => {
                    let turn = at.rem_euclid(2 * size);
                    turn.min(2 * size - 1 - turn)
                }
            }
        };
        let [x, y] = [0, 1].map(|k| inside(at[k], [image.width, image.height][k], map.of.sampler.wrap[k]));
        let first = 4 * (y as usize * image.width as usize + x as usize);
        // An image shorter than its size says is white there.
        let Some(codes) = image.rgba.get(first..first + 4) else { return Vec4::ONE };
        let table = &self.decode[map.space as usize];
        let color = [0, 1, 2].map(|k| table[usize::from(codes[k])]);
        Vec4::new(color[0], color[1], color[2], f32::from(codes[3]) / 255.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use soffio_exhibit::model::Sampler;

    #[test]
    fn texels_are_blended_wrapped_and_decoded() {
        // Single precision of numbers up to one.
        const ROUNDING: f32 = 1e-6;
        let images = [Arc::new(Image { width: 2, height: 1, rgba: vec![0, 0, 0, 255, 255, 188, 0, 51] })];
        let textures = Textures::new(&images);
        let read = |u: f32, wrap: Wrap, smooth_near: bool, space: ColorSpace| {
            let sampler = Sampler { wrap: [wrap; 2], smooth_near, ..Sampler::default() };
            let map = Map::new(TextureUse { sampler, ..TextureUse::of(0) }, space);
            textures.read(Some(&map), [u, 0.5, 0.0, 0.0])
        };
        use ColorSpace::{Linear, Srgb};
        assert!((read(0.5, Wrap::Clamp, true, Linear).x - 0.5).abs() < ROUNDING, "half way between the texels");
        assert!((read(0.5, Wrap::Clamp, true, Linear).w - 0.6).abs() < ROUNDING, "alpha is a number");
        assert!((read(0.75, Wrap::Clamp, true, Srgb).y - to_linear(188.0 / 255.0)).abs() < ROUNDING);
        assert_eq!(read(0.9, Wrap::Clamp, true, Linear).x, 1.0);
        assert!((read(1.0, Wrap::Repeat, true, Linear).x - 0.5).abs() < ROUNDING, "it repeats");
        assert_eq!(read(1.2, Wrap::Mirror, true, Linear).x, 1.0);
        assert_eq!(read(-0.2, Wrap::Mirror, false, Linear).x, 0.0);
        assert_eq!(read(-0.2, Wrap::Repeat, false, Linear).x, 1.0);
        assert_eq!(textures.read(None, [0.0; 4]), Vec4::ONE);
    }

    #[test]
    fn a_transform_and_the_second_set_are_used() {
        let of = TextureUse { set: 1, transform: [[0.0, 2.0, 0.5], [-1.0, 0.0, 0.25]], ..TextureUse::of(0) };
        let map = Map::new(of, ColorSpace::Linear);
        assert_eq!(map.place([9.0, 9.0, 0.5, 0.25]), Vec2::new(1.0, -0.25));
        assert_eq!(map.difference([9.0, 9.0, 0.5, 0.25]), Vec2::new(0.5, -0.5));
    }
}

//! Surface profile of a body, read along a line by sliding contacts: from its normal map, or else from the lightness of
//! its colour texture.
//!
//! The line covers the picture in adjacent strokes and reverses at each edge, like a rubbing hand. So it is metres long
//! on a picture of a hand's breadth, has no seam, and returns to its start.
//!
//! ```text
//! x = fold(i, w),  y = fold(i/w · h/rows, h)      i = 0 … 2 w rows − 1;  fold goes there and back
//! ```
//!
//! A needle that follows heights h(s) responds to their slope; a normal map contains it, −∂h/∂x = n_x/n_z, and the
//! direction of motion decides its sign. The width of the picture on the body follows from its triangles.

use super::context::Context;
use crate::model::{Image, Primitive};
use soffio_math::{DMat4, DVec3};
use soffio_sound::SurfaceLine;

/// Most points of a line: half of the synthesiser's limit, since the line runs in both directions.
const MAX_SAMPLES: usize = 1 << 17;
/// Least width of a picture, pixels.
const MIN_SAMPLES: usize = 4;
/// Steepest slope read from a normal map.
const MAX_SLOPE: f32 = 4.0;

impl Context<'_> {
    /// The line over the largest picture on a node and the nodes below it; `None` where they have no picture.
    pub(super) fn surface_line(&self, node: usize) -> Option<SurfaceLine> {
        let model = self.model;
        let mut largest: Option<(f64, SurfaceLine)> = None;
        for part in self.subtree(node, &[]) {
            let of = &model.nodes[part];
            for primitive in of.mesh.map_or(&[][..], |mesh| &model.meshes[mesh].primitives) {
                let Some(look) = primitive.material.map(|m| &model.materials[m]) else { continue };
                let (image, read): (usize, fn([u8; 4]) -> f32) = match (look.normal_texture, look.base_color_texture) {
                    (Some(map), _) => (map.texture.image, slope),
                    (None, Some(texture)) => (texture.image, lightness),
                    (None, None) => continue,
                };
                let [area, width] = size(primitive, &of.world);
                if !(width.is_finite() && width > 0.0) || largest.as_ref().is_some_and(|(most, _)| *most >= area) {
                    continue;
                }
                let line = wind(&model.images[image], read, look.normal_texture.is_some(), width);
                largest = line.map(|line| (area, line)).or(largest);
            }
        }
        largest.map(|(_, line)| line)
    }
}

/// n_x/n_z of a normal map's pixel.
fn slope([x, _, z, _]: [u8; 4]) -> f32 {
    let part = |c: u8| f32::from(c) / 127.5 - 1.0;
    (part(x) / part(z).max(1e-3)).clamp(-MAX_SLOPE, MAX_SLOPE)
}

/// Luma of an sRGB colour (ITU-R BT.709).
fn lightness([r, g, b, _]: [u8; 4]) -> f32 {
    (0.2126 * f32::from(r) + 0.7152 * f32::from(g) + 0.0722 * f32::from(b)) / 255.0
}

/// Area of the triangles, m², and mean length on them of the picture's width, m: ∂P/∂u = (v₂ e₁ − v₁ e₂)/(u₁ v₂ − u₂
/// v₁) for the edges e with texture differences (u, v).
fn size(primitive: &Primitive, world: &DMat4) -> [f64; 2] {
    let (mut area, mut width) = (0.0, 0.0);
    for &[a, b, c] in primitive.indices.as_chunks::<3>().0 {
        let corner = |i: u32| {
            let (place, uv) = (primitive.positions.get(i as usize)?, primitive.uvs.get(i as usize)?);
            Some((world.transform_point3(DVec3::from(place.map(f64::from))), uv.map(f64::from)))
        };
        let (Some(a), Some(b), Some(c)) = (corner(a), corner(b), corner(c)) else { continue };
        let (e1, e2) = (b.0 - a.0, c.0 - a.0);
        let ([u1, v1], [u2, v2]) = ([b.1[0] - a.1[0], b.1[1] - a.1[1]], [c.1[0] - a.1[0], c.1[1] - a.1[1]]);
        let (own, turned) = (0.5 * e1.cross(e2).length(), u1 * v2 - u2 * v1);
        if turned != 0.0 {
            area += own;
            width += own * ((v2 * e1 - v1 * e2) / turned).length();
        }
    }
    [area, if area > 0.0 { width / area } else { 0.0 }]
}

/// The line over an image that is `width` metres wide; slopes change sign on the strokes back.
fn wind(image: &Image, read: fn([u8; 4]) -> f32, slopes: bool, width: f64) -> Option<SurfaceLine> {
    let (w, h) = (image.width as usize, image.height as usize);
    let pixels = image.rgba.as_chunks::<4>().0;
    if w.min(h) < MIN_SAMPLES || pixels.len() != w * h || w > MAX_SAMPLES {
        return None;
    }
    let rows = h.min(MAX_SAMPLES / w);
    let value = |i: usize| {
        let stroke = i / w;
        let back = stroke % 2 == 1;
        let x = if back { w - 1 - i % w } else { i % w };
        let down = i as f64 / w as f64 / rows as f64;
        let y = (if down <= 1.0 { down } else { 2.0 - down }) * (h - 1) as f64;
        let (row, t) = (y as usize, (y - (y as usize) as f64) as f32);
        let at = |row: usize| read(pixels[row.min(h - 1) * w + x]);
        let value = at(row) + t * (at(row + 1) - at(row));
        if slopes && back { -value } else { value }
    };
    Some(SurfaceLine { values: (0..2 * w * rows).map(value).collect(), spacing: width / w as f64 })
}

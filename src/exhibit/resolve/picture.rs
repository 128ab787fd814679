//! Surface of a body for sliding contacts: its picture, from its normal map, or else from the lightness of its colour
//! texture, laid over its two largest half extents. So the pixels that are seen are the ones that a nib reads.
//!
//! A needle that follows heights responds to their slope; a normal map contains it, −∂h/∂x = n_x/n_z.
//!
//! Each triangle whose face lies within 60° of the plane of both extents is drawn into the grid; where an upper and a lower face
//! cover the same place, the upper one counts: things are scraped from above.

use super::super::ImpactFrame;
use super::context::Context;
use crate::model::{Image, Primitive};
use soffio_math::{DMat4, DVec3};
use soffio_sound::SurfaceRelief;

/// Most pixels along one side of the grid: 0.2 mm on a board of 40 cm, finer than a nib.
const MOST: usize = 2048;
/// Least pixels along one side.
const FEWEST: usize = 8;
/// Steepest slope read from a normal map.
const MAX_SLOPE: f32 = 4.0;
/// Cosine of the greatest angle between a face and the plane of the grid: 60°.
const FACING: f64 = 0.5;

/// One primitive with a picture.
struct Pictured<'a> {
    primitive: &'a Primitive,
    image: &'a Image,
    read: fn([u8; 4]) -> f32,
    to_world: DMat4,
}

/// Values over −1…1 in both directions, and how high the face that gave each lies.
struct Grid {
    width: usize,
    height: usize,
    values: Vec<f32>,
    upward: Vec<f64>,
}

impl Context<'_> {
    /// Picture over the half extents (m) of a node and the nodes below it, for the sound at a place of the sidecar; `None` where
    /// they have no picture.
    pub(super) fn surface_relief(
        &mut self,
        node: usize,
        frame: &ImpactFrame,
        half: [f64; 2],
        at: &str,
    ) -> Option<SurfaceRelief> {
        let model = self.model;
        let mut pictured: Vec<Pictured> = Vec::new();
        for part in self.subtree(node, &[]) {
            let of = &model.nodes[part];
            for primitive in of.mesh.map_or(&[][..], |mesh| &model.meshes[mesh].primitives) {
                let Some(look) = primitive.material.map(|m| &model.materials[m]) else { continue };
                let (image, read): (usize, fn([u8; 4]) -> f32) = match (look.normal_texture, look.base_color_texture) {
                    (Some(map), _) => (map.texture.image, slope),
                    (None, Some(texture)) => (texture.image, lightness),
                    (None, None) => continue,
                };
                let image = &model.images[image];
                if image.rgba.len() == 4 * image.width as usize * image.height as usize
                    && image.width > 1
                    && image.height > 1
                {
                    pictured.push(Pictured { primitive, image, read, to_world: of.world });
                }
            }
        }
        let finest = pictured.iter().map(Pictured::pixel).filter(|pixel| *pixel > 0.0).reduce(f64::min)?;
        let [width, height] = half.map(|half| ((2.0 * half / finest).round() as usize).clamp(FEWEST, MOST));
        let count = width * height;
        if !self.afford(count as u64 * size_of::<f32>() as u64, "the surface that is scraped", at) {
            return None;
        }
        let mut grid = Grid { width, height, values: vec![0.0; count], upward: vec![f64::NEG_INFINITY; count] };
        let to_node = model.nodes[node].world.inverse();
        for picture in &pictured {
            grid.draw(picture, &to_node, frame, half);
        }
        grid.finished()
    }
}

impl Grid {
    fn draw(&mut self, picture: &Pictured, to_node: &DMat4, frame: &ImpactFrame, half: [f64; 2]) {
        let across = frame.longest.cross(frame.middle);
        for &[a, b, c] in picture.primitive.indices.as_chunks::<3>().0 {
            let [Some(a), Some(b), Some(c)] = [a, b, c].map(|i| picture.corner(i)) else { continue };
            let normal = (b.0 - a.0).cross(c.0 - a.0).normalize_or_zero();
            if to_node.transform_vector3(normal).normalize_or_zero().dot(across).abs() < FACING {
                continue;
            }
            let place = |world: DVec3| {
                let local = to_node.transform_point3(world) - frame.center;
                let on = |axis: DVec3, half: f64, n: usize| (0.5 * (local.dot(axis) / half + 1.0)) * n as f64 - 0.5;
                [on(frame.longest, half[0], self.width), on(frame.middle, half[1], self.height)]
            };
            let corners = [a, b, c].map(|(world, uv)| (place(world), uv));
            self.fill(corners, normal.y, picture);
        }
    }

    /// Fills the pixels of a triangle: places in pixels with texture coordinates.
    fn fill(&mut self, [(a, ta), (b, tb), (c, tc)]: [([f64; 2], [f64; 2]); 3], upward: f64, picture: &Pictured) {
        let area = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
        if area == 0.0 {
            return;
        }
        let range = |k: usize, n: usize| {
            let (low, high) = (a[k].min(b[k]).min(c[k]).ceil().max(0.0), a[k].max(b[k]).max(c[k]).floor());
            low as usize..(high.min(n as f64 - 1.0) + 1.0).max(0.0) as usize
        };
        for j in range(1, self.height) {
            for i in range(0, self.width) {
                let (x, y) = (i as f64 - a[0], j as f64 - a[1]);
                let second = (x * (c[1] - a[1]) - (c[0] - a[0]) * y) / area;
                let third = ((b[0] - a[0]) * y - x * (b[1] - a[1])) / area;
                let inside = second >= -1e-9 && third >= -1e-9 && second + third <= 1.0 + 1e-9;
                let index = j * self.width + i;
                if inside && upward > self.upward[index] {
                    let uv = std::array::from_fn(|k| ta[k] + second * (tb[k] - ta[k]) + third * (tc[k] - ta[k]));
                    (self.values[index], self.upward[index]) = (picture.sample(uv), upward);
                }
            }
        }
    }

    /// The relief; what no face covers has the mean of the rest.
    fn finished(mut self) -> Option<SurfaceRelief> {
        let covered = self.upward.iter().filter(|upward| upward.is_finite()).count();
        if covered == 0 {
            return None;
        }
        let mean = (self.values.iter().map(|value| f64::from(*value)).sum::<f64>() / covered as f64) as f32;
        for (value, upward) in self.values.iter_mut().zip(&self.upward) {
            if !upward.is_finite() {
                *value = mean;
            }
        }
        Some(SurfaceRelief { values: self.values, width: self.width })
    }
}

impl Pictured<'_> {
    /// World position and texture coordinates of a vertex.
    fn corner(&self, index: u32) -> Option<(DVec3, [f64; 2])> {
        let i = index as usize;
        let (place, uv) = (self.primitive.positions.get(i)?, self.primitive.uvs.get(i)?);
        Some((self.to_world.transform_point3(DVec3::from(place.map(f64::from))), uv.map(f64::from)))
    }

    /// Mean length of a pixel on the body, m: ∂P/∂u = (v₂ e₁ − v₁ e₂)/(u₁ v₂ − u₂ v₁) for the edges e with texture differences
    /// (u, v), over the picture's width; 0 where nothing is drawn.
    fn pixel(&self) -> f64 {
        let (mut area, mut width) = (0.0, 0.0);
        for &[a, b, c] in self.primitive.indices.as_chunks::<3>().0 {
            let [Some(a), Some(b), Some(c)] = [a, b, c].map(|i| self.corner(i)) else { continue };
            let (e1, e2) = (b.0 - a.0, c.0 - a.0);
            let ([u1, v1], [u2, v2]) = ([b.1[0] - a.1[0], b.1[1] - a.1[1]], [c.1[0] - a.1[0], c.1[1] - a.1[1]]);
            let (own, turned) = (0.5 * e1.cross(e2).length(), u1 * v2 - u2 * v1);
            if turned != 0.0 {
                area += own;
                width += own * ((v2 * e1 - v1 * e2) / turned).length();
            }
        }
        let width = if area > 0.0 { width / area } else { 0.0 };
        if width.is_finite() { width / f64::from(self.image.width) } else { 0.0 }
    }

    /// The value at texture coordinates, between four pixels; the picture repeats.
    fn sample(&self, uv: [f64; 2]) -> f32 {
        let (w, h) = (self.image.width as usize, self.image.height as usize);
        let pixels = self.image.rgba.as_chunks::<4>().0;
        let [x, y] = [uv[0] * w as f64 - 0.5, uv[1] * h as f64 - 0.5];
        let wrapped = |value: f64, n: usize| (value.rem_euclid(n as f64) as usize).min(n - 1);
        let at = |x: f64, y: f64| (self.read)(pixels[wrapped(y, h) * w + wrapped(x, w)]);
        let (left, up) = (x.floor(), y.floor());
        let (s, t) = ((x - left) as f32, (y - up) as f32);
        let row = |y: f64| at(left, y) + s * (at(left + 1.0, y) - at(left, y));
        row(up) + t * (row(up + 1.0) - row(up))
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

//! From the structure of a material to the three maps of a glTF material.
//!
//! A structure is given as three fields: how much brighter or darker than its mean the material is, how much rougher, and its
//! height h. The maps multiply what the material says, so each must have a known mean:
//!
//! - *Colour*: c_k = max(1 + κ_k b, floor) for the channels k, where b is the brightness and κ the tint: a wood that darkens
//!   becomes redder. Divided by the largest value, in the sRGB transfer function. The mean in linear light, of the codes as they
//!   are rounded, is kept, so that base colour over mean, times the map, has the base colour as its mean.
//! - *Roughness* in the green channel: 1 + r over its largest value, with its mean.
//! - *Normals*: (−∂h/∂u, −∂h/∂w, 1), where w = −v points up in the image (glTF 2.0, 3.9.3). Slopes of a surface that looks smooth
//!   are some thousandths, less than an 8-bit code. So the map stores slopes K times as steep, and the material's normal scale is
//!   1/K: glTF multiplies x and y by it, which gives the slope back.

use std::sync::Arc;

use super::noise::{Field, SIDE};
use crate::model::Image;
use soffio_math::pow;

/// Structure of a material over one tile.
pub struct Structure {
    /// Difference of the brightness from its mean, relative.
    pub brightness: Field,
    /// How much each channel follows it.
    pub tint: [f32; 3],
    /// Difference of the roughness from its mean, relative.
    pub roughness: Field,
    /// Height, m.
    pub height: Field,
}

/// The maps of a finish.
#[derive(Debug)]
pub struct Maps {
    /// Factors of the base colour, sRGB.
    pub color: Arc<Image>,
    /// Mean of the factors, linear.
    pub color_mean: [f32; 3],
    /// Factors of the roughness in the green channel; the blue one, of the metalness, is full.
    pub roughness: Arc<Image>,
    /// Mean of the factors.
    pub roughness_mean: f32,
    /// Normals.
    pub normal: Arc<Image>,
    /// Scale of the normals.
    pub normal_scale: f32,
}

/// Smallest factor of a colour or of a roughness: a twentieth, so that no pore is a hole.
const FLOOR: f32 = 0.05;
/// Steepest slope that a normal map stores: 27°.
const STEEPEST: f32 = 0.5;

impl Maps {
    /// The maps of a structure whose tile is so long along u and v, m.
    pub fn of(structure: &Structure, tile: [f64; 2]) -> Self {
        let factor = |value: f32| (1.0 + value).max(FLOOR);
        let brightest = structure.brightness.0.iter().copied().fold(f32::NEG_INFINITY, f32::max);
        let peak = structure.tint.map(|k| factor(k * brightest)).into_iter().fold(FLOOR, f32::max);
        let codes = Codes::new();
        let mut sums = [0.0; 3];
        let color = image(&structure.brightness.0, |b, _| {
            let [r, g, b] = structure.tint.map(|k| codes.of(factor(k * b) / peak));
            [r, g, b].iter().zip(&mut sums).for_each(|(code, sum)| *sum += codes.linear[usize::from(*code)]);
            [r, g, b, u8::MAX]
        });
        let roughest = structure.roughness.0.iter().copied().fold(f32::NEG_INFINITY, f32::max);
        let mut sum = 0.0;
        let roughness = image(&structure.roughness.0, |r, _| {
            let code = rounded(factor(r) / factor(roughest));
            sum += f64::from(code) / 255.0;
            [u8::MAX, code, u8::MAX, u8::MAX]
        });
        let count = (SIDE * SIDE) as f64;
        let (normal, normal_scale) = normals(&structure.height, tile);
        Self {
            color: Arc::new(color),
            color_mean: sums.map(|sum| (sum / count) as f32),
            roughness: Arc::new(roughness),
            roughness_mean: (sum / count) as f32,
            normal: Arc::new(normal),
            normal_scale,
        }
    }
}

/// The normal map of heights, and its scale.
fn normals(height: &Field, tile: [f64; 2]) -> (Image, f32) {
    // Central differences over two texels.
    let [du, dv] = tile.map(|length| (2.0 * length / SIDE as f64) as f32);
    let next = |index: usize| (index + 1) % SIDE;
    let before = |index: usize| (index + SIDE - 1) % SIDE;
    let slope = |index: usize| {
        let (x, y) = (index % SIDE, index / SIDE);
        let at = |x: usize, y: usize| height.0[y * SIDE + x];
        [(at(next(x), y) - at(before(x), y)) / du, (at(x, next(y)) - at(x, before(y))) / dv]
    };
    let steepest = (0..SIDE * SIDE).map(|i| slope(i).map(f32::abs)).fold(0.0, |most: f32, [x, y]| most.max(x).max(y));
    let steeper = if steepest > 0.0 { STEEPEST / steepest } else { 1.0 };
    let map = image(&height.0, |_, index| {
        let [along, down] = slope(index).map(|s| s * steeper);
        let length = (along * along + down * down + 1.0).sqrt();
        let [x, y, z] = [-along, down, 1.0].map(|n| rounded(0.5 + 0.5 * n / length));
        [x, y, z, u8::MAX]
    });
    (map, 1.0 / steeper)
}

fn image(values: &[f32], mut texel: impl FnMut(f32, usize) -> [u8; 4]) -> Image {
    let mut rgba = Vec::with_capacity(4 * values.len());
    for (index, value) in values.iter().enumerate() {
        rgba.extend_from_slice(&texel(*value, index));
    }
    Image { width: SIDE as u32, height: SIDE as u32, rgba }
}

fn rounded(share: f32) -> u8 {
    (share.clamp(0.0, 1.0) * 255.0 + 0.5) as u8
}

/// The sRGB transfer function (IEC 61966-2-1) both ways, as tables.
struct Codes {
    /// Linear value of each code.
    linear: [f64; 256],
    /// Code of each of so many linear values.
    code: Vec<u8>,
}

impl Codes {
    /// Steps of the table: near white a code is 1/112 of linear light, so a step is a thirtieth of a code.
    const STEPS: usize = 4096;

    fn new() -> Self {
        let linear = std::array::from_fn(|code| to_linear(code as f64 / 255.0));
        let mut code = Vec::with_capacity(Self::STEPS + 1);
        let mut now: usize = 0;
        for step in 0..=Self::STEPS {
            let value = step as f64 / Self::STEPS as f64;
            // The next code, as soon as it is nearer.
            while now < 255 && to_linear((now as f64 + 0.5) / 255.0) < value {
                now += 1;
            }
            code.push(now as u8);
        }
        Self { linear, code }
    }

    fn of(&self, linear: f32) -> u8 {
        self.code[(linear.clamp(0.0, 1.0) * Self::STEPS as f32 + 0.5) as usize]
    }
}

/// Linear value of an sRGB value.
pub fn to_linear(srgb: f64) -> f64 {
    if srgb <= 0.04045 { srgb / 12.92 } else { pow((srgb + 0.055) / 1.055, 2.4) }
}

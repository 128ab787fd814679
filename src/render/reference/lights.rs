//! The lights, as a path samples them: lamps, luminous rectangles, punctual lights, and the sky.
//!
//! - A lamp of intensity I and cone S(θ) is a disc of area A with the radiance L(θ) = I S(θ) / (A cos θ). So the
//!   irradiance of each of its points is that of a small lamp of the same cone, as in the live picture.
//! - Rectangles (fields of the gallery, the scenario's area light) have the same radiance in all directions of one side.
//! - The sky is the environment's cube. A texel is chosen by its light, and a point of it evenly.
//!
//! Densities are per solid angle: p = d² / (A cos θ) for a point of a surface at distance d. One light is chosen at each
//! vertex, in proportion to an estimate of its irradiance. The estimate is 0 only where the light is: a lamp's cone and
//! the horizon are widened by its size.

use std::f32::consts::PI;
use std::sync::Arc;

use glam::Vec3;

use super::super::AreaLight;
use super::super::environment::{Environment, face_direction, face_of};
use super::super::gallery::Lamp;
use super::super::punctual::PunctualUniform;
use super::bsdf::disc;

/// Most lights; the gallery has seven, a scenario two, and a model at most eight.
pub(super) const MAX_LIGHTS: usize = 20;
/// Probability with which a texel of the sky is chosen evenly instead of by its light, so that none is missed that
/// rounding leaves dark.
const EVENLY: f32 = 0.1;

/// A light.
pub(super) enum Light {
    /// A disc with a cone.
    Lamp(Lamp),
    /// A one-sided rectangle.
    Rectangle(Rectangle),
    /// A light without a size.
    Punctual(PunctualUniform),
    /// The light from all around.
    Sky(Sky),
}

/// A one-sided rectangle.
pub(super) struct Rectangle {
    /// Centre, sides and radiance.
    pub of: AreaLight,
    /// Unit, the side to which it shines.
    normal: Vec3,
    /// m².
    pub area: f32,
}

impl Rectangle {
    /// The rectangle of an area light.
    pub fn new(of: AreaLight) -> Self {
        let side = of.half_width.cross(of.half_height);
        Self { of, normal: side.normalize_or_zero(), area: 4.0 * side.length() }
    }
}

/// A light as seen from a point.
pub(super) struct Sample {
    /// Unit direction to the light.
    pub direction: Vec3,
    /// Distance, m; infinite for the sky.
    pub distance: f32,
    /// Radiance divided by the density.
    pub weighted: Vec3,
    /// Density per solid angle; `None` for a light without a size.
    pub density: Option<f32>,
}

impl Light {
    /// Estimate of the irradiance at a point with a normal, without shadows.
    pub fn estimate(&self, point: Vec3, normal: Vec3) -> f32 {
        match self {
            Self::Lamp(lamp) => {
                let to = lamp.position - point;
                let d2 = to.length_squared().max(1e-12);
                let to = to / d2.sqrt();
                let spread = lamp.radius / d2.sqrt();
                let lit = cone(lamp, (spread - to.dot(lamp.axis)).min(1.0));
                let above = (to.dot(normal) + spread).clamp(0.0, 1.0);
                lamp.intensity.element_sum() * lit * above / d2
            }
            Self::Rectangle(Rectangle { of, normal: shines, area }) => {
                let to = of.center - point;
                let height = -to.dot(*shines);
                let edges = of.half_width.dot(normal).abs() + of.half_height.dot(normal).abs();
                let above = to.dot(normal) + edges;
                if height <= 0.0 || above <= 0.0 {
                    return 0.0;
                }
                // At least the rectangle's own size away, so that near points are not preferred without bound.
                let d2 = to.length_squared() + 0.25 * area;
                of.radiance.element_sum() * area * height * above / (d2 * d2)
            }
            Self::Punctual(light) => match punctual(light, point) {
                Some((to, _, strength)) => light.color.element_sum() * strength * to.dot(normal).max(0.0),
                None => 0.0,
            },
            Self::Sky(sky) => PI * sky.mean,
        }
    }

    /// A direction to the light by two numbers in 0 … 1; `None` where no light comes from there.
    pub fn draw(&self, point: Vec3, [u, v]: [f32; 2]) -> Option<Sample> {
        match self {
            Self::Lamp(lamp) => {
                let at = disc([u, v]) * lamp.radius;
                let (x, y) = lamp.axis.any_orthonormal_pair();
                let to = lamp.position + x * at.x + y * at.y - point;
                let d2 = to.length_squared();
                let direction = to / d2.sqrt();
                let cosine = -direction.dot(lamp.axis);
                let lit = if cosine > 0.0 { cone(lamp, cosine) } else { 0.0 };
                (lit > 0.0).then(|| Sample {
                    direction,
                    distance: d2.sqrt(),
                    weighted: lamp.intensity * (lit / d2),
                    density: Some(d2 / (PI * lamp.radius * lamp.radius * cosine)),
                })
            }
            Self::Rectangle(Rectangle { of, normal, area }) => {
                let to = of.center + of.half_width * (2.0 * u - 1.0) + of.half_height * (2.0 * v - 1.0) - point;
                let d2 = to.length_squared();
                let direction = to / d2.sqrt();
                let seen = -direction.dot(*normal) * area;
                (seen > 0.0 && d2 > 0.0).then(|| Sample {
                    direction,
                    distance: d2.sqrt(),
                    weighted: of.radiance * (seen / d2),
                    density: Some(d2 / seen),
                })
            }
            Self::Punctual(light) => punctual(light, point).map(|(direction, distance, strength)| Sample {
                direction,
                distance,
                weighted: light.color * strength,
                density: None,
            }),
            Self::Sky(sky) => {
                let (direction, density) = sky.draw([u, v]);
                let radiance = sky.radiance(direction);
                let sample =
                    Sample { direction, distance: f32::INFINITY, weighted: radiance / density, density: Some(density) };
                (radiance != Vec3::ZERO).then_some(sample)
            }
        }
    }

    /// Radiance of a lamp or rectangle where a ray crosses it within `far`, the density of [`Self::draw`] there relative
    /// to a distance of one, and the distance.
    pub fn crossed(&self, origin: Vec3, direction: Vec3, far: f32) -> Option<(Vec3, f32, f32)> {
        match self {
            Self::Lamp(lamp) => {
                let cosine = -direction.dot(lamp.axis);
                let t = -(lamp.position - origin).dot(lamp.axis) / cosine;
                if !(cosine > 0.0 && t > 0.0 && t < far) {
                    return None;
                }
                let off = origin + direction * t - lamp.position;
                let area = PI * lamp.radius * lamp.radius;
                let lit = cone(lamp, cosine);
                (off.length_squared() < lamp.radius * lamp.radius && lit > 0.0)
                    .then(|| (lamp.intensity * (lit / (area * cosine)), 1.0 / (area * cosine), t))
            }
            Self::Rectangle(Rectangle { of, normal, area }) => {
                let seen = -direction.dot(*normal);
                let t = -(of.center - origin).dot(*normal) / seen;
                if !(seen > 0.0 && t > 0.0 && t < far) {
                    return None;
                }
                let off = origin + direction * t - of.center;
                let inside = |half: Vec3| off.dot(half).abs() <= half.length_squared();
                (inside(of.half_width) && inside(of.half_height)).then(|| (of.radiance, 1.0 / (area * seen), t))
            }
            Self::Punctual(_) | Self::Sky(_) => None,
        }
    }
}

/// Brightness of a lamp's cone, 0 … 1: the shaders' smooth step.
fn cone(lamp: &Lamp, cosine: f32) -> f32 {
    let t = ((cosine - lamp.cos_outer) / (lamp.cos_inner - lamp.cos_outer)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Direction to a punctual light, its distance (m), and its irradiance per unit of colour and cosine; as
/// `punctual_light` in `lighting.wgsl`. `None` where it is dark.
fn punctual(light: &PunctualUniform, point: Vec3) -> Option<(Vec3, f32, f32)> {
    if light.kind < 0.5 {
        return Some((-light.axis, f32::INFINITY, 1.0));
    }
    let to = light.position - point;
    let d2 = to.length_squared().max(1e-8);
    let direction = to / d2.sqrt();
    let mut strength = 1.0 / d2;
    if light.range > 0.0 {
        let r2 = light.range * light.range;
        strength *= (1.0 - d2 * d2 / (r2 * r2)).clamp(0.0, 1.0);
    }
    if light.kind > 1.5 {
        let a = (-direction.dot(light.axis) - light.cone.y) / (light.cone.x - light.cone.y).max(1e-4);
        strength *= a.clamp(0.0, 1.0) * a.clamp(0.0, 1.0);
    }
    (strength > 0.0).then_some((direction, d2.sqrt(), strength))
}

/// The environment's cube as a light.
pub(super) struct Sky {
    environment: Arc<Environment>,
    intensity: f32,
    /// Texels along an edge.
    size: usize,
    /// Sums of the texels' probabilities.
    sums: Vec<f32>,
    /// Mean radiance, summed over the channels.
    mean: f32,
}

impl Sky {
    /// The sky of an environment whose radiance is multiplied by `intensity`.
    pub fn new(environment: Arc<Environment>, intensity: f32) -> Self {
        let texels = &environment.levels[0];
        let size = ((texels.len() / 6) as f32).sqrt() as usize;
        let angles: Vec<f32> = (0..texels.len()).map(|i| solid_angle(i, size)).collect();
        let light: Vec<f32> = (0..texels.len()).map(|i| mean_over(texels, i, size) * angles[i]).collect();
        let (all, whole) = (light.iter().sum::<f32>().max(1e-20), angles.iter().sum::<f32>());
        let mut sum = 0.0;
        let sums = light.iter().zip(&angles).map(|(l, angle)| {
            sum += (1.0 - EVENLY) * l / all + EVENLY * angle / whole;
            sum
        });
        Self { sums: sums.collect(), mean: intensity * all / whole, environment, intensity, size }
    }

    /// Radiance from a unit direction: bilinear within a face.
    pub fn radiance(&self, direction: Vec3) -> Vec3 {
        let (face, s, t) = face_of(direction);
        let texels = &self.environment.levels[0][face * self.size * self.size..];
        let place = |x: f32| {
            let at = (x * self.size as f32 - 0.5).clamp(0.0, (self.size - 1) as f32);
            (at as usize, (at as usize + 1).min(self.size - 1), at.fract())
        };
        let ((x0, x1, fx), (y0, y1, fy)) = (place(s), place(t));
        let row = |y: usize| texels[y * self.size + x0].lerp(texels[y * self.size + x1], fx);
        self.intensity * row(y0).lerp(row(y1), fy)
    }

    /// Density with which a unit direction is drawn.
    pub fn density(&self, direction: Vec3) -> f32 {
        let (face, s, t) = face_of(direction);
        let place = |x: f32| ((x * self.size as f32) as usize).min(self.size - 1);
        self.density_in((face * self.size + place(t)) * self.size + place(s), direction)
    }

    /// The density in a texel: dω = ds dt / |(s, t, 1)|³ over a face of 2 × 2.
    fn density_in(&self, texel: usize, direction: Vec3) -> f32 {
        let before = if texel > 0 { self.sums[texel - 1] } else { 0.0 };
        let whole = self.sums[self.sums.len() - 1];
        let nearest = direction.abs().max_element();
        let texels = (self.size * self.size) as f32;
        (self.sums[texel] - before) / whole * texels / 4.0 / (nearest * nearest * nearest)
    }

    fn draw(&self, [u, v]: [f32; 2]) -> (Vec3, f32) {
        let whole = self.sums[self.sums.len() - 1];
        let texel = self.sums.partition_point(|&sum| sum <= u * whole).min(self.sums.len() - 1);
        let before = if texel > 0 { self.sums[texel - 1] } else { 0.0 };
        let s = ((u * whole - before) / (self.sums[texel] - before)).clamp(0.0, 1.0);
        let (face, row, column) = place_of(texel, self.size);
        let at = |k: usize, part: f32| 2.0 * (k as f32 + part) / self.size as f32 - 1.0;
        let direction = face_direction(face, at(column, s), at(row, v)).normalize();
        (direction, self.density_in(texel, direction))
    }
}

/// Mean over a texel of the bilinear light, summed over the channels: along each axis three quarters of its own, and an
/// eighth of each neighbour's.
fn mean_over(texels: &[Vec3], texel: usize, size: usize) -> f32 {
    let (face, row, column) = place_of(texel, size);
    let mut sum = 0.0;
    for (dy, wy) in [(0, 0.125), (1, 0.75), (2, 0.125)] {
        for (dx, wx) in [(0, 0.125), (1, 0.75), (2, 0.125)] {
            let inside = |k: usize, d: usize| (k + d).saturating_sub(1).min(size - 1);
            sum += wx * wy * texels[(face * size + inside(row, dy)) * size + inside(column, dx)].element_sum();
        }
    }
    sum
}

/// Face, row and column of a texel.
fn place_of(texel: usize, size: usize) -> (usize, usize, usize) {
    (texel / (size * size), texel / size % size, texel % size)
}

/// Solid angle of a texel, relative.
fn solid_angle(texel: usize, size: usize) -> f32 {
    let (face, row, column) = place_of(texel, size);
    let at = |k: usize| (2 * k + 1) as f32 / size as f32 - 1.0;
    let d = face_direction(face, at(column), at(row));
    d.length_recip() / d.length_squared()
}

//! Image-based lighting: a radiance for every direction, prefiltered for diffuse and glossy surfaces.
//!
//! - Irradiance: nine spherical-harmonic coefficients (Ramamoorthi and Hanrahan 2001), folded with the cosine lobe.
//! - Reflections: a cube whose mip `m` holds the radiance filtered by the GGX lobe of perceptual roughness
//!   `m / (mips − 1)`, view along the normal (Karis 2013). Each texel is a sum over the same Hammersley points; a
//!   sample reads the mip whose texel is as large as its share of the sphere, so few are enough (Křivánek and
//!   Colbert 2008).
//! - Split-sum table: specular albedo A · F0 + B by cosine and roughness, and the albedo of a cloth's sheen.
//!
//! All on the CPU, once, so that every driver gets the same numbers; it takes a fraction of a second.

use std::f32::consts::PI;

use glam::Vec3;

/// Texels along an edge of the sharpest cube level: 1.4° each, sharper than any material here mirrors.
pub const CUBE_SIZE: u32 = 64;
/// Roughness levels of the cube, mirror to rough; the coarsest has two texels along an edge.
pub const CUBE_MIPS: u32 = 6;
/// Texels along an edge of the split-sum table. It is smooth, so linear interpolation between them suffices.
pub const TABLE_SIZE: u32 = 48;
/// Filter samples of each texel of the rough levels; few suffice, as each reads a mip of its own size (Křivánek and
/// Colbert 2008).
const FILTER_SAMPLES: u32 = 48;
/// Samples of each entry of the table: noise below 1 % (a test checks it).
const TABLE_SAMPLES: u32 = 96;

/// Environment light, prefiltered for the GPU.
#[derive(Clone, Debug)]
pub struct Environment {
    /// Spherical-harmonic irradiance in the order 1, y, z, x, xy, yz, 3z²−1, xz, x²−y², constants included.
    pub irradiance: [Vec3; 9],
    /// Level by level, face by face (+X −X +Y −Y +Z −Z), row by row.
    pub levels: Vec<Vec<Vec3>>,
}

/// A cube of radiance with its box-filtered mips.
struct Cube {
    levels: Vec<Vec<Vec3>>,
}

impl Environment {
    /// Prefilters the light with radiance `radiance` in each unit direction.
    pub fn new(radiance: impl Fn(Vec3) -> Vec3 + Sync) -> Self {
        let source = Cube::new(CUBE_SIZE, &radiance);
        let irradiance = source.irradiance();
        let levels = (0..CUBE_MIPS).map(|level| source.filtered(level)).collect();
        Self { irradiance, levels }
    }

    /// Radiance from a unit direction, at this roughness level of the cube.
    pub fn radiance(&self, direction: Vec3, level: usize) -> Vec3 {
        let texels = &self.levels[level];
        let size = ((texels.len() / 6) as f32).sqrt();
        let (face, s, t) = face_of(direction);
        let at = |c: f32| ((c * size) as usize).min(size as usize - 1);
        texels[(face * size as usize + at(t)) * size as usize + at(s)]
    }

    /// Irradiance of a surface with normal `n`, as `sh_irradiance` in `lighting.wgsl`.
    pub fn irradiance_at(&self, n: Vec3) -> Vec3 {
        let basis = [1.0, n.y, n.z, n.x, n.x * n.y, n.y * n.z, 3.0 * n.z * n.z - 1.0, n.x * n.z, n.x * n.x - n.y * n.y];
        self.irradiance.iter().zip(basis).map(|(c, b)| *c * b).sum::<Vec3>().max(Vec3::ZERO)
    }

    /// Prefilters an equirectangular image: u = atan2(z, x)/2π + ½, v = 0 at +Y.
    pub fn from_equirectangular(image: &image::Rgb32FImage) -> Self {
        let (width, height) = (image.width() as i64, image.height() as i64);
        let texel = |x: i64, y: i64| {
            let p = image.get_pixel(x.rem_euclid(width) as u32, y.clamp(0, height - 1) as u32);
            // The brightest suns of photographs still fit a 16-bit float.
            Vec3::from_array(p.0).clamp(Vec3::ZERO, Vec3::splat(6e4))
        };
        // Image texels under one cube texel are averaged, so that a small sun is not missed between samples.
        let per_side = ((width as f32 / (4.0 * CUBE_SIZE as f32)).ceil() as i64).clamp(1, 8);
        Self::new(|d| {
            let u = (d.z.atan2(d.x) / (2.0 * PI) + 0.5) * width as f32 - 0.5;
            let v = d.y.clamp(-1.0, 1.0).acos() / PI * height as f32 - 0.5;
            let mut sum = Vec3::ZERO;
            for j in 0..per_side {
                for i in 0..per_side {
                    let spread = |k: i64| (k as f32 + 0.5) - 0.5 * per_side as f32;
                    let (x, y) = (u + spread(i), v + spread(j));
                    let (x0, y0) = (x.floor(), y.floor());
                    let (fx, fy) = (x - x0, y - y0);
                    let (x0, y0) = (x0 as i64, y0 as i64);
                    let top = texel(x0, y0).lerp(texel(x0 + 1, y0), fx);
                    sum += top.lerp(texel(x0, y0 + 1).lerp(texel(x0 + 1, y0 + 1), fx), fy);
                }
            }
            sum / (per_side * per_side) as f32
        })
    }
}

/// Direction through a point (s, t ∈ −1 … 1, t downwards) of a cube face, not normalised.
pub(super) fn face_direction(face: usize, s: f32, t: f32) -> Vec3 {
    match face {
        0 => Vec3::new(1.0, -t, -s),
        1 => Vec3::new(-1.0, -t, s),
        2 => Vec3::new(s, 1.0, t),
        3 => Vec3::new(s, -1.0, -t),
        4 => Vec3::new(s, -t, 1.0),
        _ => Vec3::new(-s, -t, -1.0),
    }
}

/// Face and its coordinates (0 … 1) of a direction.
pub(super) fn face_of(d: Vec3) -> (usize, f32, f32) {
    let a = d.abs();
    let (face, m, s, t) = if a.x >= a.y && a.x >= a.z {
        if d.x > 0.0 { (0, a.x, -d.z, -d.y) } else { (1, a.x, d.z, -d.y) }
    } else if a.y >= a.z {
        if d.y > 0.0 { (2, a.y, d.x, d.z) } else { (3, a.y, d.x, -d.z) }
    } else if d.z > 0.0 {
        (4, a.z, d.x, -d.y)
    } else {
        (5, a.z, -d.x, -d.y)
    };
    (face, 0.5 * s / m + 0.5, 0.5 * t / m + 0.5)
}

/// Evaluates `texel` for each texel of a cube level on two threads; the result does not depend on them.
fn cube_level(size: u32, texel: impl Fn(Vec3) -> Vec3 + Sync) -> Vec<Vec3> {
    let n = size as usize;
    let mut level = vec![Vec3::ZERO; 6 * n * n];
    let threads = std::thread::available_parallelism().map_or(1, |n| n.get()).min(6);
    let chunk = (6 * n).div_ceil(threads) * n;
    std::thread::scope(|scope| {
        for (part, texels) in level.chunks_mut(chunk).enumerate() {
            let texel = &texel;
            scope.spawn(move || {
                for (i, out) in texels.iter_mut().enumerate() {
                    let index = part * chunk + i;
                    let (face, row, column) = (index / (n * n), index / n % n, index % n);
                    let at = |k: usize| (2 * k + 1) as f32 / n as f32 - 1.0;
                    *out = texel(face_direction(face, at(column), at(row)).normalize());
                }
            });
        }
    });
    level
}

impl Cube {
    fn new(size: u32, radiance: &(impl Fn(Vec3) -> Vec3 + Sync)) -> Self {
        let mut levels = vec![cube_level(size, radiance)];
        let mut n = size as usize;
        while n > 1 {
            let above = &levels[levels.len() - 1];
            let half = n / 2;
            let mut level = Vec::with_capacity(6 * half * half);
            for face in 0..6 {
                for row in 0..half {
                    for column in 0..half {
                        let at = |r: usize, c: usize| above[face * n * n + (2 * row + r) * n + 2 * column + c];
                        level.push(0.25 * (at(0, 0) + at(0, 1) + at(1, 0) + at(1, 1)));
                    }
                }
            }
            levels.push(level);
            n = half;
        }
        Self { levels }
    }

    /// Bilinear in the face, nearest level.
    fn sample(&self, direction: Vec3, lod: f32) -> Vec3 {
        let level = (lod.round().max(0.0) as usize).min(self.levels.len() - 1);
        let texels = &self.levels[level];
        let n = ((texels.len() / 6) as f32).sqrt() as usize;
        let (face, s, t) = face_of(direction);
        let (x, y) = (s * n as f32 - 0.5, t * n as f32 - 0.5);
        let (fx, fy) = (x - x.floor(), y - y.floor());
        let at = |dx: f32, dy: f32| {
            let clamp = |k: f32| (k.max(0.0) as usize).min(n - 1);
            texels[face * n * n + clamp(y.floor() + dy) * n + clamp(x.floor() + dx)]
        };
        at(0.0, 0.0).lerp(at(1.0, 0.0), fx).lerp(at(0.0, 1.0).lerp(at(1.0, 1.0), fx), fy)
    }

    /// Projection on the nine harmonics, times the cosine lobe's π, 2π/3, π/4.
    fn irradiance(&self) -> [Vec3; 9] {
        let level = &self.levels[1];
        let n = ((level.len() / 6) as f32).sqrt() as usize;
        let mut out = [Vec3::ZERO; 9];
        let mut whole = 0.0;
        for (index, &radiance) in level.iter().enumerate() {
            let at = |k: usize| (2 * k + 1) as f32 / n as f32 - 1.0;
            let d = face_direction(index / (n * n), at(index % n), at(index / n % n));
            // Solid angle of a texel ∝ |d|⁻³.
            let weight = d.length_recip() / d.length_squared();
            whole += weight;
            let d = d.normalize();
            for (c, basis) in out.iter_mut().zip(basis(d)) {
                *c += radiance * (basis * weight);
            }
        }
        // Y² constants (1/4π, 3/4π, 15/4π, 5/16π, 15/16π) times the lobe, so that the shader only multiplies.
        let lobe = [PI, 2.0 * PI / 3.0, PI / 4.0];
        let y2 = |k: f32| k / (4.0 * PI);
        let factor = [
            y2(1.0) * lobe[0],
            y2(3.0) * lobe[1],
            y2(3.0) * lobe[1],
            y2(3.0) * lobe[1],
            y2(15.0) * lobe[2],
            y2(15.0) * lobe[2],
            y2(1.25) * lobe[2],
            y2(15.0) * lobe[2],
            y2(3.75) * lobe[2],
        ];
        for (c, f) in out.iter_mut().zip(factor) {
            *c *= f * 4.0 * PI / whole;
        }
        out
    }

    /// One roughness level, GGX-filtered.
    fn filtered(&self, level: u32) -> Vec<Vec3> {
        let size = CUBE_SIZE >> level;
        if level == 0 {
            return self.levels[0].clone();
        }
        let roughness = level as f32 / (CUBE_MIPS - 1) as f32;
        let alpha = roughness * roughness;
        let texel_angle = 4.0 * PI / (6.0 * (CUBE_SIZE * CUBE_SIZE) as f32);
        // Directions about +Z, weight n·l, and the level each reads.
        let samples: Vec<(Vec3, f32)> = (0..FILTER_SAMPLES)
            .filter_map(|i| {
                let h = ggx_half_vector(hammersley(i, FILTER_SAMPLES), alpha);
                let l = 2.0 * h.z * h - Vec3::Z;
                let d = ggx_distribution(h.z, alpha);
                // pdf of l is D (n·h) / (4 v·h) = D / 4 for v = n.
                let share = 4.0 / (FILTER_SAMPLES as f32 * d);
                (l.z > 0.0).then(|| (l, 0.5 * (share / texel_angle).log2() + 0.5))
            })
            .collect();
        cube_level(size, |normal| {
            let (t, b) = normal.any_orthonormal_pair();
            let mut sum = Vec3::ZERO;
            let mut weight = 0.0;
            for &(l, lod) in &samples {
                sum += self.sample(t * l.x + b * l.y + normal * l.z, lod) * l.z;
                weight += l.z;
            }
            sum / weight
        })
    }
}

/// 1, y, z, x, xy, yz, 3z²−1, xz, x²−y².
fn basis(d: Vec3) -> [f32; 9] {
    [1.0, d.y, d.z, d.x, d.x * d.y, d.y * d.z, 3.0 * d.z * d.z - 1.0, d.x * d.z, d.x * d.x - d.y * d.y]
}

/// Point i of n of the Hammersley set.
fn hammersley(i: u32, n: u32) -> (f32, f32) {
    ((i as f32 + 0.5) / n as f32, i.reverse_bits() as f32 / 4_294_967_296.0)
}

/// Half vector about +Z with density D (n·h) (Walter et al. 2007).
fn ggx_half_vector((u, v): (f32, f32), alpha: f32) -> Vec3 {
    let cosine = ((1.0 - u) / (1.0 + (alpha * alpha - 1.0) * u)).sqrt();
    let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
    let phi = 2.0 * PI * v;
    Vec3::new(sine * phi.cos(), sine * phi.sin(), cosine)
}

/// GGX distribution of normals.
fn ggx_distribution(nh: f32, alpha: f32) -> f32 {
    let a2 = alpha * alpha;
    let t = nh * nh * (a2 - 1.0) + 1.0;
    a2 / (PI * t * t)
}

/// Split-sum table, columns cosine, rows roughness: specular albedo = F0 · A + B, then the albedo of a white sheen.
pub fn split_sum_table() -> Vec<[f32; 3]> {
    let n = TABLE_SIZE;
    let mut table = Vec::with_capacity((n * n) as usize);
    for row in 0..n {
        let roughness = (row as f32 + 0.5) / n as f32;
        for column in 0..n {
            let cosine = (column as f32 + 0.5) / n as f32;
            let [a, b] = split_sum(cosine, roughness);
            table.push([a, b, sheen_albedo(cosine, roughness)]);
        }
    }
    table
}

/// (A, B) by sampling the half vector: the estimator is G₂ (v·h) / (n·h n·v) with Fresnel split off.
fn split_sum(nv: f32, roughness: f32) -> [f32; 2] {
    let alpha = (roughness * roughness).max(0.002);
    let a2 = alpha * alpha;
    let v = Vec3::new((1.0 - nv * nv).sqrt(), 0.0, nv);
    let (mut a, mut b) = (0.0, 0.0);
    for i in 0..TABLE_SAMPLES {
        let h = ggx_half_vector(hammersley(i, TABLE_SAMPLES), alpha);
        let vh = v.dot(h).max(0.0);
        let nl = (2.0 * vh * h - v).z;
        if nl <= 0.0 {
            continue;
        }
        let smith = 0.5 / (nl * (nv * nv * (1.0 - a2) + a2).sqrt() + nv * (nl * nl * (1.0 - a2) + a2).sqrt());
        let weight = 4.0 * smith * nl * vh / h.z;
        let x = 1.0 - vh;
        let fresnel = x * x * x * x * x;
        a += (1.0 - fresnel) * weight;
        b += fresnel * weight;
    }
    [a / TABLE_SAMPLES as f32, b / TABLE_SAMPLES as f32]
}

/// Albedo of Charlie's sheen distribution with Neubelt's visibility (Estevez and Kulla 2017), integrated over
/// directions spread evenly over the hemisphere.
fn sheen_albedo(nv: f32, roughness: f32) -> f32 {
    let inverse = 1.0 / (roughness * roughness).max(0.005);
    let v = Vec3::new((1.0 - nv * nv).sqrt(), 0.0, nv);
    let mut sum = 0.0;
    for i in 0..TABLE_SAMPLES {
        let (nl, turn) = hammersley(i, TABLE_SAMPLES);
        let (sine, phi) = ((1.0 - nl * nl).sqrt(), 2.0 * PI * turn);
        let l = Vec3::new(sine * phi.cos(), sine * phi.sin(), nl);
        let nh = (v + l).normalize().z;
        let d = (2.0 + inverse) * (1.0 - nh * nh).max(1e-4).powf(0.5 * inverse) / (2.0 * PI);
        sum += d * nl / (4.0 * (nl + nv - nl * nv));
    }
    (2.0 * PI * sum / TABLE_SAMPLES as f32).min(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_white_sky_gives_pi_everywhere_and_stays_white_at_any_roughness() {
        // Weights sum to one up to single-precision rounding of a few thousand terms.
        const TOLERANCE: f32 = 2e-4;
        let white = Environment::new(|_| Vec3::ONE);
        for d in [Vec3::X, Vec3::NEG_Y, Vec3::new(0.6, 0.0, 0.8)] {
            let e: Vec3 = white.irradiance.iter().zip(basis(d)).map(|(c, b)| *c * b).sum();
            assert!((e.x / PI - 1.0).abs() < TOLERANCE, "{e}");
        }
        for texel in white.levels.iter().flatten() {
            assert!((*texel - Vec3::ONE).abs().max_element() < TOLERANCE, "{texel}");
        }
    }

    #[test]
    fn a_lamp_overhead_lights_what_looks_up() {
        let sky = Environment::new(|d| Vec3::splat(if d.y > 0.9 { 10.0 } else { 0.0 }));
        let e = |d: Vec3| sky.irradiance.iter().zip(basis(d)).map(|(c, b)| c.x * b).sum::<f32>();
        // The cap's own irradiance is π · 10 · (1 − 0.9²); nine harmonics reproduce it within a tenth.
        let exact = PI * 10.0 * (1.0 - 0.81);
        assert!((e(Vec3::Y) / exact - 1.0).abs() < 0.1, "{} {exact}", e(Vec3::Y));
        assert!(e(Vec3::NEG_Y).abs() < 0.15 * exact);
    }

    #[test]
    fn directions_and_faces_are_inverse() {
        for face in 0..6 {
            for (s, t) in [(0.3, -0.7), (-0.9, 0.2), (0.0, 0.0)] {
                let (back, u, v) = face_of(face_direction(face, s, t).normalize());
                assert!(back == face && (2.0 * u - 1.0 - s).abs() < 1e-6 && (2.0 * v - 1.0 - t).abs() < 1e-6);
            }
        }
    }

    #[test]
    fn smooth_metal_returns_all_light_and_rough_metal_loses_some() {
        // F0 = 1: A + B. Sampling noise of that many points.
        const TOLERANCE: f32 = 0.01;
        let [a, b] = split_sum(0.7, 0.05);
        assert!((a + b - 1.0).abs() < TOLERANCE, "{a} {b}");
        // At roughness 1 and normal incidence D = 1/π and V = 1/(2 (1 + n·l)), so A + B = ∫ μ/(1 + μ) dμ = 1 − ln 2.
        let [a, b] = split_sum(0.999, 1.0);
        assert!((a + b - (1.0 - std::f32::consts::LN_2)).abs() < TOLERANCE, "{a} {b}");
    }
}

//! ꟻLIP: the difference that a viewer sees when two pictures alternate (Andersson et al. 2020), for pictures of 8 bits.
//!
//! For each pixel, with both pictures at a given number of pixels per degree of the field of view:
//!
//! 1. Colours, in Y Cx Cz, are blurred by the contrast sensitivity of the eye: sums of Gaussians a √(π/b) exp(−π² r² / b), r in degrees.
//! 2. Their distance in L*a*b*, chroma scaled by lightness (Hunt), is HyAB: |ΔL| + √(Δa² + Δb²). Raised to q_c and mapped
//!    to 0 … 1, it is ΔE_c.
//! 3. Edges and points of the unblurred lightness are found by first and second derivatives of a Gaussian. The larger of
//!    both differences, over √2 and raised to q_f, is ΔE_f.
//! 4. ꟻLIP = ΔE_c^(1 − ΔE_f), 0 where the pictures are equal, 1 at most.
//!
//! Pictures continue beyond their borders as at them. Constants are those of the paper.

use glam::{Mat3, Vec2, Vec3};
use image::RgbaImage;

use super::textures::to_linear;

/// Pixels per degree of a viewer 0.7 m from a screen 0.7 m wide of 3840 pixels, the paper's default.
pub const PIXELS_PER_DEGREE: f32 = 67.0;

/// White of D65 in X Y Z, by the matrix below.
const WHITE: Vec3 = Vec3::new(0.950_428_5, 1.0, 1.088_900_4);
/// Linear RGB to X Y Z, column by column.
const XYZ: [f32; 9] =
    [0.412_386_6, 0.212_636_8, 0.019_330_6, 0.357_591_5, 0.715_183, 0.119_197_2, 0.180_450_5, 0.072_180_2, 0.950_372_6];
/// Weights a and widths b (degrees²) of the two Gaussians of each channel's contrast sensitivity: lightness, red–green,
/// blue–yellow.
const SENSITIVITY: [[(f32, f32); 2]; 3] =
    [[(1.0, 0.0047), (0.0, 1e-5)], [(1.0, 0.0053), (0.0, 1e-5)], [(34.1, 0.04), (13.5, 0.025)]];
/// Exponents q_c and q_f.
const EXPONENTS: [f32; 2] = [0.7, 0.5];
/// The part P_c of the largest colour distance that is mapped to P_t.
const KNEE: [f32; 2] = [0.4, 0.95];
/// Width of a feature that the eye finds best, degrees.
const FEATURE_WIDTH: f32 = 0.082;

/// A picture of one number or colour per pixel.
struct Plane<T> {
    width: usize,
    height: usize,
    values: Vec<T>,
}

impl<T: Copy> Plane<T> {
    fn map<U>(&self, f: impl Fn(T) -> U) -> Plane<U> {
        Plane { width: self.width, height: self.height, values: self.values.iter().map(|&v| f(v)).collect() }
    }

    /// Sums along rows, then down columns; `step` adds a value with the weight at an offset.
    fn filtered<U: Copy + Default, V: Copy + Default>(
        &self,
        radius: i32,
        across: impl Fn(U, T, usize) -> U,
        down: impl Fn(V, U, usize) -> V,
    ) -> Plane<V> {
        let (w, h) = (self.width as i32, self.height as i32);
        let mut rows = Vec::with_capacity(self.values.len());
        for y in 0..h {
            let row = &self.values[(y * w) as usize..((y + 1) * w) as usize];
            rows.extend((0..w).map(|x| {
                (-radius..=radius).fold(U::default(), |sum, k| {
                    across(sum, row[(x + k).clamp(0, w - 1) as usize], (k + radius) as usize)
                })
            }));
        }
        let mut values = Vec::with_capacity(self.values.len());
        for y in 0..h {
            values.extend((0..w).map(|x| {
                (-radius..=radius).fold(V::default(), |sum, k| {
                    down(sum, rows[((y + k).clamp(0, h - 1) * w + x) as usize], (k + radius) as usize)
                })
            }));
        }
        Plane { width: self.width, height: self.height, values }
    }
}

/// Mean of ꟻLIP over two pictures of one size, 0 … 1; `None` where the sizes differ or there are no pixels.
/// `pixels_per_degree` is usually [`PIXELS_PER_DEGREE`].
pub fn mean(reference: &RgbaImage, test: &RgbaImage, pixels_per_degree: f32) -> Option<f32> {
    let differences = differences(reference, test, pixels_per_degree)?;
    let sum: f64 = differences.iter().map(|&d| f64::from(d)).sum();
    Some((sum / differences.len() as f64) as f32)
}

/// ꟻLIP of each pixel, row by row; `None` as in [`mean`].
pub fn differences(reference: &RgbaImage, test: &RgbaImage, pixels_per_degree: f32) -> Option<Vec<f32>> {
    if reference.dimensions() != test.dimensions() || reference.is_empty() {
        return None;
    }
    let [a, b] = [reference, test].map(opponent);
    let [blurred_a, blurred_b] = [&a, &b].map(|picture| blurred(picture, pixels_per_degree));
    let [features_a, features_b] = [&a, &b].map(|picture| features(picture, pixels_per_degree));
    let largest = hyab(hunt(lab(Vec3::Y)), hunt(lab(Vec3::Z))).powf(EXPONENTS[0]);
    let colors = blurred_a.values.iter().zip(&blurred_b.values);
    let features = features_a.iter().zip(&features_b);
    let one = |((&a, &b), (&fa, &fb)): ((&Vec3, &Vec3), (&Vec2, &Vec2))| {
        let color = mapped(hyab(a, b).powf(EXPONENTS[0]), largest);
        let feature = ((fa - fb).abs().max_element() / std::f32::consts::SQRT_2).powf(EXPONENTS[1]);
        color.powf(1.0 - feature.min(1.0))
    };
    Some(colors.zip(features).map(one).collect())
}

/// Y Cx Cz of each pixel.
fn opponent(picture: &RgbaImage) -> Plane<Vec3> {
    let linear: [f32; 256] = std::array::from_fn(|code| to_linear(code as f32 / 255.0));
    let values = picture.pixels().map(|p| {
        let t = xyz(Vec3::new(linear[p.0[0] as usize], linear[p.0[1] as usize], linear[p.0[2] as usize]));
        Vec3::new(116.0 * t.y - 16.0, 500.0 * (t.x - t.y), 200.0 * (t.y - t.z))
    });
    Plane { width: picture.width() as usize, height: picture.height() as usize, values: values.collect() }
}

/// X Y Z relative to white, of a linear RGB colour.
fn xyz(rgb: Vec3) -> Vec3 {
    Mat3::from_cols_array(&XYZ) * rgb / WHITE
}

/// L*a*b* of a linear RGB colour.
fn lab(rgb: Vec3) -> Vec3 {
    const KNEE: f32 = 6.0 / 29.0;
    let f = xyz(rgb).map(|t| if t > KNEE * KNEE * KNEE { t.cbrt() } else { t / (3.0 * KNEE * KNEE) + 4.0 / 29.0 });
    Vec3::new(116.0 * f.y - 16.0, 500.0 * (f.x - f.y), 200.0 * (f.y - f.z))
}

/// Chroma scaled by lightness.
fn hunt(lab: Vec3) -> Vec3 {
    Vec3::new(lab.x, 0.01 * lab.x * lab.y, 0.01 * lab.x * lab.z)
}

fn hyab(a: Vec3, b: Vec3) -> f32 {
    let d = a - b;
    d.x.abs() + d.y.hypot(d.z)
}

/// A colour distance mapped to 0 … 1.
fn mapped(distance: f32, largest: f32) -> f32 {
    let knee = KNEE[0] * largest;
    if distance < knee {
        distance * KNEE[1] / knee
    } else {
        KNEE[1] + (distance - knee) / (largest - knee) * (1.0 - KNEE[1])
    }
}

/// Colours as the eye resolves them, in L*a*b* with the chroma scaled.
fn blurred(picture: &Plane<Vec3>, pixels_per_degree: f32) -> Plane<Vec3> {
    use std::f32::consts::PI;
    // Three standard deviations of the widest Gaussian.
    let widest = SENSITIVITY.iter().flatten().map(|g| g.1).fold(0.0, f32::max);
    let radius = (3.0 * (widest / (2.0 * PI * PI)).sqrt() * pixels_per_degree).ceil() as i32;
    // A Gaussian of r² is the product of one along the rows and one down the columns. The sum of two is not, so each is filtered by itself.
    let weights = |gaussian: usize| -> Vec<Vec3> {
        let at = |k: i32| {
            let r = k as f32 / pixels_per_degree;
            Vec3::from_array(SENSITIVITY.map(|of| (-PI * PI * r * r / of[gaussian].1).exp()))
        };
        (-radius..=radius).map(at).collect()
    };
    let one = |gaussian: usize| {
        let kernel = weights(gaussian);
        let height = Vec3::from_array(SENSITIVITY.map(|of| of[gaussian].0 * (PI / of[gaussian].1).sqrt()));
        let sum: Vec3 = kernel.iter().sum();
        let blurred = picture.filtered(
            radius,
            |sum: Vec3, value, k| sum + kernel[k] * value,
            |sum: Vec3, value, k| sum + kernel[k] * value,
        );
        (blurred, height, sum * sum * height)
    };
    let ((first, height, whole), (second, height2, whole2)) = (one(0), one(1));
    let values = first.values.iter().zip(&second.values).map(|(a, b)| {
        let Vec3 { x, y, z } = (*a * height + *b * height2) / (whole + whole2);
        // Y Cx Cz back to linear RGB.
        let t = (x + 16.0) / 116.0;
        let relative = Vec3::new(t + y / 500.0, t, t - z / 200.0);
        let rgb = Mat3::from_cols_array(&XYZ).inverse() * (relative * WHITE);
        hunt(lab(rgb.clamp(Vec3::ZERO, Vec3::ONE)))
    });
    Plane { width: picture.width, height: picture.height, values: values.collect() }
}

/// Strength of the edge and of the point at each pixel.
fn features(picture: &Plane<Vec3>, pixels_per_degree: f32) -> Vec<Vec2> {
    let lightness = picture.map(|c| (c.x + 16.0) / 116.0);
    let deviation = 0.5 * FEATURE_WIDTH * pixels_per_degree;
    let radius = (3.0 * deviation).ceil() as i32;
    let gaussian: Vec<f32> =
        (-radius..=radius).map(|k| (-(k * k) as f32 / (2.0 * deviation * deviation)).exp()).collect();
    let derivative = |of: &dyn Fn(f32) -> f32| -> Vec<f32> {
        let raw: Vec<f32> = (-radius..=radius).zip(&gaussian).map(|(k, g)| of(k as f32) * g).collect();
        // Positive and negative weights add up to one each.
        let sum = |sign: f32| raw.iter().map(|w| (w * sign).max(0.0)).sum::<f32>();
        let (plus, minus) = (sum(1.0), sum(-1.0));
        raw.iter().map(|w| if *w > 0.0 { w / plus } else { w / minus }).collect()
    };
    let edge = derivative(&|k| -k);
    let point = derivative(&|k| k * k / (deviation * deviation) - 1.0);
    let whole: f32 = gaussian.iter().sum();
    let strength = |kernel: &[f32]| {
        lightness
            .filtered(
                radius,
                |sum: Vec2, value, k| sum + value * Vec2::new(kernel[k], gaussian[k] / whole),
                |sum: Vec2, value: Vec2, k| sum + value * Vec2::new(gaussian[k] / whole, kernel[k]),
            )
            .map(Vec2::length)
    };
    let (edges, points) = (strength(&edge), strength(&point));
    edges.values.iter().zip(&points.values).map(|(&e, &p)| Vec2::new(e, p)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plain(color: [u8; 3]) -> RgbaImage {
        let [r, g, b] = color;
        RgbaImage::from_pixel(24, 16, image::Rgba([r, g, b, 255]))
    }

    fn between(a: &RgbaImage, b: &RgbaImage) -> f32 {
        mean(a, b, PIXELS_PER_DEGREE).expect("one size")
    }

    #[test]
    fn equal_pictures_do_not_differ_and_the_order_does_not_matter() {
        let noise = |seed: u32| {
            RgbaImage::from_fn(32, 20, |x, y| {
                let h = (x * 7919 + y * 104_729 + seed).wrapping_mul(2_654_435_761);
                image::Rgba([(h >> 8) as u8, (h >> 16) as u8, (h >> 24) as u8, 255])
            })
        };
        assert_eq!(between(&noise(1), &noise(1)), 0.0);
        assert_eq!(between(&noise(1), &noise(2)), between(&noise(2), &noise(1)));
        assert!(mean(&noise(1), &plain([0; 3]), PIXELS_PER_DEGREE).is_none(), "another size");
    }

    #[test]
    fn black_and_white_green_and_blue_have_their_published_distances() {
        // Single precision and digits of the matrix.
        const TOLERANCE: f32 = 1e-3;
        // Green and blue are the farthest apart by definition.
        assert!((between(&plain([0, 255, 0]), &plain([0, 0, 255])) - 1.0).abs() < TOLERANCE);
        // The authors' program gives 0.967387: HyAB of black and white is 100. Green is L*a*b* (87.737, −86.185, 83.181) and blue (32.297, 79.188, −107.860);
        // their HyAB with the chroma scaled is 203.2. 0.95 + 0.05 ((100/203.2)^0.7 − 0.4) / 0.6 = 0.9674.
        let d = between(&plain([0; 3]), &plain([255; 3]));
        assert!((d - 0.9674).abs() < TOLERANCE, "{d}");
    }

    #[test]
    fn a_fine_pattern_differs_less_from_the_grey_of_its_own_light_than_a_coarse_one() {
        let stripes = |width: u32| {
            RgbaImage::from_fn(64, 64, |x, _| {
                let c = if (x / width).is_multiple_of(2) { 148 } else { 220 };
                image::Rgba([c, c, c, 255])
            })
        };
        let grey = RgbaImage::from_pixel(64, 64, image::Rgba([188, 188, 188, 255]));
        // Values of the authors' program (flip-evaluator 1.7), at 67.02 pixels per degree.
        const TOLERANCE: f32 = 1e-3;
        for (width, published) in [(1, 0.040_868), (8, 0.524_728)] {
            let d = between(&grey, &stripes(width));
            assert!((d - published).abs() < TOLERANCE, "{d} instead of {published}");
        }
    }
}

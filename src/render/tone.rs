//! Tone curves: linear radiance to a linear display value, which the picture encodes as sRGB. The same curves as in
//! `common.wgsl`, for pictures that are not drawn by the graphics device.

use glam::{Mat3, Vec3};

use super::Tonemap;

/// Display value of a radiance that is multiplied by the exposure already, linear RGB, 0 … 1.
pub(super) fn tone_mapped(radiance: Vec3, curve: Tonemap) -> Vec3 {
    let c = radiance.max(Vec3::ZERO);
    let shown = match curve {
        Tonemap::Neutral => neutral(c),
        Tonemap::Aces => aces(c),
        Tonemap::Agx => agx(c),
        Tonemap::Clamp => c,
    };
    shown.clamp(Vec3::ZERO, Vec3::ONE)
}

/// Khronos PBR Neutral (specification of 2024).
fn neutral(c: Vec3) -> Vec3 {
    // Peak above which highlights are compressed, and the reflectance of a dielectric at normal incidence.
    const START: f32 = 0.8 - 0.04;
    const DESATURATION: f32 = 0.15;
    let x = c.min_element();
    let offset = if x < 0.08 { x - 6.25 * x * x } else { 0.04 };
    let color = c - offset;
    let peak = color.max_element();
    if peak < START {
        return color;
    }
    let d = 1.0 - START;
    let new_peak = 1.0 - d * d / (peak + d - START);
    let grey = 1.0 - 1.0 / (DESATURATION * (peak - new_peak) + 1.0);
    (color * (new_peak / peak)).lerp(Vec3::splat(new_peak), grey)
}

/// ACES reference and output transform, in Hill's fit.
fn aces(c: Vec3) -> Vec3 {
    let inset =
        Mat3::from_cols_array(&[0.59719, 0.07600, 0.02840, 0.35458, 0.90834, 0.13383, 0.04823, 0.01566, 0.83777]);
    let outset =
        Mat3::from_cols_array(&[1.60475, -0.10208, -0.00327, -0.53108, 1.10813, -0.07276, -0.07367, -0.00605, 1.07602]);
    let v = inset * c;
    outset * ((v * (v + 0.024_578_6) - 0.000_090_537) / (v * (0.983_729 * v + 0.432_951) + 0.238_081))
}

/// AgX (Sobotka), basic contrast, with Wrensch's sixth-order fit of its contrast curve.
fn agx(c: Vec3) -> Vec3 {
    // Range of the curve in stops.
    const LOWEST: f32 = -12.473_93;
    const HIGHEST: f32 = 4.026_069;
    let inset = Mat3::from_cols_array(&[
        0.842_479, 0.042_328, 0.042_376, 0.078_434, 0.878_469, 0.078_434, 0.079_224, 0.079_166, 0.879_143,
    ]);
    let outset = Mat3::from_cols_array(&[
        1.196_879, -0.052_897, -0.052_972, -0.098_021, 1.151_903, -0.098_043, -0.099_030, -0.098_961, 1.151_074,
    ]);
    let v = (inset * c).max(Vec3::splat(1e-10)).map(f32::log2);
    let x = ((v - LOWEST) / (HIGHEST - LOWEST)).clamp(Vec3::ZERO, Vec3::ONE);
    let (x2, x4) = (x * x, x * x * x * x);
    let y = 15.5 * x4 * x2 - 40.14 * x4 * x + 31.96 * x4 - 6.868 * x2 * x + 0.4298 * x2 + 0.1191 * x - 0.00232;
    (outset * y).max(Vec3::ZERO).map(|c| c.powf(2.2))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_neutral_curve_keeps_colours_below_its_start_and_is_continuous_there() {
        // Single precision of numbers about one.
        const ROUNDING: f32 = 1e-6;
        // Above a reflectance of 0.08 only the dielectric's own 0.04 is taken off.
        let paint = Vec3::new(0.5, 0.3, 0.2);
        assert!((tone_mapped(paint, Tonemap::Neutral) - (paint - 0.04)).abs().max_element() < ROUNDING);
        let at = |x: f32| tone_mapped(Vec3::splat(x), Tonemap::Neutral).x;
        assert!((at(0.8 + ROUNDING) - at(0.8 - ROUNDING)).abs() < 4.0 * ROUNDING);
        assert!(at(100.0) < 1.0 && at(100.0) > at(2.0) && at(0.0) == 0.0);
    }

    #[test]
    fn grey_stays_grey_and_grows_under_every_curve() {
        // Digits of the published matrices.
        const DIGITS: f32 = 2e-3;
        for curve in [Tonemap::Neutral, Tonemap::Aces, Tonemap::Agx, Tonemap::Clamp] {
            let mut before = -1.0;
            for step in 0..20 {
                let shown = tone_mapped(Vec3::splat(step as f32 * 0.1), curve);
                assert!((shown - shown.x).abs().max_element() < DIGITS, "{curve:?} {shown}");
                assert!(shown.x >= before, "{curve:?} at {step}");
                before = shown.x;
            }
        }
        assert_eq!(tone_mapped(Vec3::splat(0.5), Tonemap::Clamp), Vec3::splat(0.5));
    }
}

//! A GGX lobe, and the table of albedos that its energy is compensated by.
//!
//! With n = +z, v the view, l the light, h their half vector, α the squared roughness:
//!
//! ```text
//! D = α² / (π (sin²θ_h + α² cos²θ_h)²)
//! V = ½ / (l_z √(v_z² (1 − α²) + α²) + v_z √(l_z² (1 − α²) + α²))     height-correlated Smith (Heitz 2014)
//! F = F0 + (F90 − F0) (1 − v·h)⁵                                      Schlick 1994
//! m = 1 + F0 (1/E − 1)                                                several scatterings (Turquin 2019)
//! ```
//!
//! Half vectors are drawn among the visible normals (Heitz 2018), as points of a spherical cap (Dupuy and Benyoub 2023). The
//! density of l is then D / (2 (v_z + √(v_z² (1 − α²) + α²))).

use std::f32::consts::PI;

use glam::Vec3;

use super::super::environment::{TABLE_SIZE, split_sum_table};

/// Smallest GGX α, as in `lighting.wgsl`.
const SMALLEST_ALPHA: f32 = 0.002;
/// The split-sum table: A, B, and the albedo of a white sheen, by cosine and roughness.
pub(super) struct AlbedoTable(Vec<Vec3>);

impl AlbedoTable {
    /// The table of the live picture.
    pub fn new() -> Self {
        Self(split_sum_table().into_iter().map(Vec3::from_array).collect())
    }

    /// Bilinear, as the sampler of the shaders.
    pub fn read(&self, cosine: f32, roughness: f32) -> Vec3 {
        let last = TABLE_SIZE as usize - 1;
        let place = |x: f32| {
            let at = (x * TABLE_SIZE as f32 - 0.5).clamp(0.0, last as f32);
            (at as usize, (at as usize + 1).min(last), at.fract())
        };
        let ((x0, x1, fx), (y0, y1, fy)) = (place(cosine), place(roughness));
        let row = |y: usize| self.0[y * (last + 1) + x0].lerp(self.0[y * (last + 1) + x1], fx);
        row(y0).lerp(row(y1), fy)
    }
}

/// A GGX lobe.
#[derive(Clone, Copy)]
pub(super) struct Gloss {
    alpha: f32,
    f0: Vec3,
    f90: f32,
    /// m.
    pub energy: Vec3,
}

impl Gloss {
    /// A lobe between two reflectances; `ab` is the table's entry for the view.
    pub fn new(f0: Vec3, f90: f32, roughness: f32, ab: Vec3) -> Self {
        let energy = 1.0 + f0 * (1.0 / (ab.x + ab.y).max(1e-3) - 1.0);
        Self { alpha: (roughness * roughness).max(SMALLEST_ALPHA), f0, f90, energy }
    }

    /// Reflectance times the cosine, and the density of `draw`; all in the frame of the normal.
    pub fn value(&self, v: Vec3, l: Vec3) -> (Vec3, f32) {
        let Some(h) = (v + l).try_normalize() else { return (Vec3::ZERO, 0.0) };
        let a2 = self.alpha * self.alpha;
        // sin² + α² cos²: no difference of nearly equal numbers where the lobe is narrow.
        let t = h.x * h.x + h.y * h.y + a2 * h.z * h.z;
        let d = a2 / (PI * t * t);
        let widened = (v.z * v.z * (1.0 - a2) + a2).sqrt();
        let visibility = 0.5 / (l.z * widened + v.z * (l.z * l.z * (1.0 - a2) + a2).sqrt()).max(1e-7);
        let x = 1.0 - v.dot(h).clamp(0.0, 1.0);
        let fresnel = self.f0 + (self.f90 - self.f0) * (x * x * x * x * x);
        (fresnel * self.energy * (d * visibility * l.z), d / (2.0 * (v.z + widened)))
    }

    /// A direction by the visible normals.
    pub fn draw(&self, v: Vec3, [u, w]: [f32; 2]) -> Vec3 {
        let stretched = Vec3::new(v.x * self.alpha, v.y * self.alpha, v.z).normalize();
        let phi = 2.0 * PI * u;
        let z = (1.0 - w) * (1.0 + stretched.z) - stretched.z;
        let sine = (1.0 - z * z).max(0.0).sqrt();
        let cap = Vec3::new(sine * phi.cos(), sine * phi.sin(), z) + stretched;
        let h = Vec3::new(cap.x * self.alpha, cap.y * self.alpha, cap.z).normalize_or(Vec3::Z);
        2.0 * v.dot(h) * h - v
    }
}

#[cfg(test)]
mod tests {
    use super::super::sequence::Sobol;
    use super::*;

    #[test]
    fn white_metal_has_the_albedo_of_the_table() {
        // The table has 96 samples for each entry: at grazing views it is up to 3 % too bright.
        const TABLE_NOISE: f32 = 0.016;
        let table = AlbedoTable::new();
        let sobol = Sobol::new(4096);
        for roughness in [0.1, 0.3, 0.6, 0.9] {
            for cosine in [0.25, 0.6, 0.95_f32] {
                let ab = table.read(cosine, roughness);
                let gloss = Gloss { energy: Vec3::ONE, ..Gloss::new(Vec3::splat(0.5), 1.0, roughness, ab) };
                let v = Vec3::new((1.0 - cosine * cosine).sqrt(), 0.0, cosine);
                let one = |i| {
                    let [a, b, ..] = sobol.sequence((3, 5), i).next();
                    let l = gloss.draw(v, [a, b]);
                    let (f, p) = gloss.value(v, l);
                    if l.z > 0.0 { f.x / p } else { 0.0 }
                };
                let exact = (0..4096).map(one).sum::<f32>() / 4096.0;
                let of_table = 0.5 * ab.x + ab.y;
                assert!((exact - of_table).abs() < TABLE_NOISE, "{roughness} {cosine}: {exact} instead of {of_table}");
            }
        }
    }
}

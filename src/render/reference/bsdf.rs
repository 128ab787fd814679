//! Reflection of a surface: the port of `lighting.wgsl` without its approximations of the light.
//!
//! With l the direction to the light, v the view, h their half vector, n the normal, the reflectance times the cosine is
//!
//! ```text
//! f = (1 − c E_c) [ (1 − s E_s) ( ρ_d n·l / π + D V F m n·l ) + sheen ] + c coat
//! ```
//!
//! - D, V: GGX with the height-correlated Smith term (Heitz 2014), F: Schlick's Fresnel term of F0 and F90.
//! - m = 1 + F0 (1/E − 1): the energy of several scatterings (Turquin 2019); E from the split-sum table.
//! - ρ_d: the base colour of what is neither metal nor transparent, less the specular albedo.
//! - Sheen: Charlie's distribution with Neubelt's visibility (Estevez and Kulla 2017), s its strength, E_s its albedo.
//! - Coat: another GGX lobe with F0 = 0.04, strength c and albedo E_c.
//!
//! Directions are drawn from a mixture of three densities: the cosine for matte and sheen, and the distributions of visible
//! normals of both GGX lobes (Heitz 2018, by spherical caps, Dupuy and Benyoub 2023). Its weights are the
//! albedos. Roughness is never below α = 0.002, so there are no delta lobes. Light below the triangle's
//! own plane is not reflected, whatever the interpolated normal says.

use std::f32::consts::PI;

use glam::{Vec2, Vec3};

use super::gloss::{AlbedoTable, Gloss};
use super::material::Surface;

/// Specular reflectance of a clear coat at normal incidence: a refractive index of 1.5.
const COAT_F0: f32 = 0.04;
/// Smallest cosine between view and interpolated normal, as in `lighting.wgsl`.
const SMALLEST_COSINE: f32 = 1e-3;

/// Axes of a normal, and the view in them.
#[derive(Clone, Copy)]
struct Frame {
    x: Vec3,
    y: Vec3,
    z: Vec3,
    /// Unit; at least slightly above the surface.
    view: Vec3,
}

impl Frame {
    fn new(normal: Vec3, view: Vec3) -> Self {
        let (x, y) = normal.any_orthonormal_pair();
        let local = Vec3::new(view.dot(x), view.dot(y), view.dot(normal).max(SMALLEST_COSINE));
        Self { x, y, z: normal, view: local.normalize() }
    }

    fn local(&self, d: Vec3) -> Vec3 {
        Vec3::new(d.dot(self.x), d.dot(self.y), d.dot(self.z))
    }

    fn world(&self, d: Vec3) -> Vec3 {
        self.x * d.x + self.y * d.y + self.z * d.z
    }
}

/// A clear coat.
#[derive(Clone, Copy)]
struct Coat {
    frame: Frame,
    gloss: Gloss,
    strength: f32,
}

/// Reflection at a point towards one view.
pub(super) struct Bsdf {
    frame: Frame,
    /// Normal of the geometry, unit, towards the view.
    pub facing: Vec3,
    /// ρ_d, times what the layers above let through.
    diffuse: Vec3,
    gloss: Option<(Gloss, f32)>,
    sheen: Option<(Vec3, f32)>,
    coat: Option<Coat>,
    /// Weights of the cosine and of both GGX densities; they add up to 1.
    weights: [f32; 3],
    /// Albedo of all layers together, roughly.
    pub albedo: f32,
}

impl Bsdf {
    /// A matte surface.
    pub fn matte(normal: Vec3, view: Vec3, albedo: Vec3) -> Self {
        let frame = Frame::new(normal, view);
        let weights = [1.0, 0.0, 0.0];
        let (gloss, sheen, coat) = (None, None, None);
        Self { frame, facing: normal, diffuse: albedo, gloss, sheen, coat, weights, albedo: albedo.max_element() }
    }

    /// A matte surface under varnish of the floor of the gallery, whose gloss takes its part of the light as in `gallery.wgsl`.
    pub fn varnished(normal: Vec3, view: Vec3, albedo: Vec3, roughness: f32, table: &AlbedoTable) -> Self {
        let mut bsdf = Self::matte(normal, view, albedo);
        let ab = table.read(bsdf.frame.view.z, roughness);
        let mut gloss = Gloss::new(Vec3::splat(COAT_F0), 1.0, roughness, ab);
        gloss.energy = Vec3::ONE;
        bsdf.diffuse *= 1.0 - (COAT_F0 * ab.x + ab.y);
        bsdf.gloss = Some((gloss, 1.0));
        bsdf.weigh(albedo.max_element(), COAT_F0 * ab.x + ab.y, 0.0);
        bsdf
    }

    /// Reflection of a surface towards `view` (unit).
    pub fn new(s: &Surface, view: Vec3, table: &AlbedoTable) -> Self {
        let frame = Frame::new(s.normal, view);
        let f0 = s.f0.lerp(s.albedo, s.metallic);
        let f90 = s.f90 + (1.0 - s.f90) * s.metallic;
        let ab = table.read(frame.view.z, s.roughness);
        let gloss = Gloss::new(f0, f90, s.roughness, ab);
        let specular = (f0 * ab.x + f90 * ab.y) * gloss.energy;
        let diffuse = s.albedo * ((1.0 - s.metallic) * (1.0 - s.transmission)) * (1.0 - specular).max(Vec3::ZERO);
        let mut bsdf = Self { diffuse, gloss: None, ..Self::matte(s.normal, view, Vec3::ZERO) };
        (bsdf.frame, bsdf.facing) = (frame, s.facing);
        let mut below = 1.0;
        let mut coat_albedo = 0.0;
        if s.coat > 0.0 {
            let frame = Frame::new(s.coat_normal, view);
            let ab = table.read(frame.view.z, s.coat_roughness);
            let gloss = Gloss::new(Vec3::splat(COAT_F0), 1.0, s.coat_roughness, ab);
            coat_albedo = s.coat * (COAT_F0 * ab.x + ab.y);
            below -= coat_albedo;
            bsdf.coat = Some(Coat { frame, gloss, strength: s.coat });
        }
        let mut sheen_albedo = 0.0;
        let mut base = below;
        if s.sheen.max_element() > 0.0 {
            let white = table.read(bsdf.frame.view.z, s.sheen_roughness).z;
            sheen_albedo = below * white * s.sheen.max_element();
            base *= 1.0 - white * s.sheen.max_element();
            bsdf.sheen = Some((s.sheen * below, 1.0 / (s.sheen_roughness * s.sheen_roughness).max(0.005)));
        }
        bsdf.diffuse *= base;
        bsdf.gloss = Some((gloss, base));
        bsdf.weigh(bsdf.diffuse.max_element() + sheen_albedo, base * specular.max_element(), coat_albedo);
        bsdf
    }

    /// Sets the weights of the densities in proportion to the albedos.
    fn weigh(&mut self, cosine: f32, gloss: f32, coat: f32) {
        let sum = cosine + gloss + coat;
        let weights = if sum > 1e-6 { [cosine / sum, gloss / sum, coat / sum] } else { [1.0, 0.0, 0.0] };
        (self.weights, self.albedo) = (weights, sum);
    }

    /// Reflectance times the cosine to the unit direction `l`, and the density of [`Self::draw`] per solid angle.
    pub fn value(&self, l: Vec3) -> (Vec3, f32) {
        if l.dot(self.facing) <= 0.0 {
            return (Vec3::ZERO, 0.0);
        }
        let local = self.frame.local(l);
        let (mut sum, mut density) = (Vec3::ZERO, 0.0);
        if local.z > 0.0 {
            sum += self.diffuse * (local.z / PI);
            density += self.weights[0] * local.z / PI;
            if let Some((gloss, share)) = &self.gloss {
                let (f, p) = gloss.value(self.frame.view, local);
                sum += f * *share;
                density += self.weights[1] * p;
            }
            if let Some((color, inverse)) = self.sheen {
                sum += color * sheen(self.frame.view, local, inverse);
            }
        }
        if let Some(coat) = &self.coat {
            let local = coat.frame.local(l);
            if local.z > 0.0 {
                let (f, p) = coat.gloss.value(coat.frame.view, local);
                sum += f * coat.strength;
                density += self.weights[2] * p;
            }
        }
        (sum, density)
    }

    /// A direction by three numbers in 0 … 1.
    pub fn draw(&self, [choice, u, v]: [f32; 3]) -> Vec3 {
        if choice < self.weights[0] {
            return self.frame.world(cosine_direction([u, v]));
        }
        match (&self.gloss, &self.coat) {
            (_, Some(coat)) if choice >= self.weights[0] + self.weights[1] => {
                coat.frame.world(coat.gloss.draw(coat.frame.view, [u, v]))
            }
            (Some((gloss, _)), _) => self.frame.world(gloss.draw(self.frame.view, [u, v])),
            _ => self.frame.world(cosine_direction([u, v])),
        }
    }
}

/// Reflectance of a white sheen times the cosine.
fn sheen(v: Vec3, l: Vec3, inverse: f32) -> f32 {
    let nh = (v + l).normalize_or(Vec3::Z).z;
    let d = (2.0 + inverse) * (1.0 - nh * nh).max(1e-4).powf(0.5 * inverse) / (2.0 * PI);
    d * l.z / (4.0 * (l.z + v.z - l.z * v.z).max(1e-3))
}

/// A direction about +z with density cos/π, by a point of the unit disc (Shirley and Chiu 1997).
fn cosine_direction([u, v]: [f32; 2]) -> Vec3 {
    let p = disc([u, v]);
    Vec3::new(p.x, p.y, (1.0 - p.length_squared()).max(0.0).sqrt())
}

/// A point of the unit disc, evenly distributed; neighbours stay neighbours (Shirley and Chiu 1997).
pub(super) fn disc([u, v]: [f32; 2]) -> Vec2 {
    let (a, b) = (2.0 * u - 1.0, 2.0 * v - 1.0);
    if a == 0.0 && b == 0.0 {
        return Vec2::ZERO;
    }
    let (r, angle) = if a.abs() > b.abs() { (a, PI / 4.0 * (b / a)) } else { (b, PI / 2.0 - PI / 4.0 * (a / b)) };
    r * Vec2::new(angle.cos(), angle.sin())
}

#[cfg(test)]
mod tests {
    use super::super::sequence::Sobol;
    use super::*;

    /// Mean of value / density over `draw`, and the mean of the density over the sphere of directions.
    fn albedo(bsdf: &Bsdf, count: u32) -> Vec3 {
        let sobol = Sobol::new(count);
        let mean = |i| {
            let [a, b, c, _] = sobol.sequence((3, 5), i).next();
            let (f, p) = bsdf.value(bsdf.draw([a, b, c]));
            if p > 0.0 { f / p } else { Vec3::ZERO }
        };
        (0..count).map(mean).sum::<Vec3>() / count as f32
    }

    fn view(cosine: f32) -> Vec3 {
        Vec3::new((1.0 - cosine * cosine).sqrt(), 0.0, cosine)
    }

    #[test]
    fn the_density_of_directions_integrates_to_one_and_is_that_of_the_draws() {
        // Noise of 65 536 stratified directions; directions below the surface are lost.
        const NOISE: f32 = 0.02;
        let table = AlbedoTable::new();
        let surface = Surface {
            coat: 0.8,
            coat_roughness: 0.25,
            sheen: Vec3::new(0.5, 0.2, 0.1),
            sheen_roughness: 0.5,
            ..Surface::plain(Vec3::Z, Vec3::new(0.7, 0.5, 0.3), 0.2, 0.35)
        };
        let bsdf = Bsdf::new(&surface, view(0.8), &table);
        let count = 1 << 16;
        let sobol = Sobol::new(count);
        let (mut whole, mut reflected, mut near, mut drawn) = (0.0, Vec3::ZERO, 0.0, 0.0);
        let mirror = Vec3::new(-0.6, 0.0, 0.8);
        for i in 0..count {
            let [u, v, choice, w] = sobol.sequence((1, 1), i).next();
            let phi = 2.0 * PI * u;
            let sine = (1.0 - v * v).sqrt();
            let l = Vec3::new(sine * phi.cos(), sine * phi.sin(), v);
            let (f, p) = bsdf.value(l);
            let share = 2.0 * PI / count as f32;
            whole += p * share;
            reflected += f * share;
            near += if l.dot(mirror) > 0.95 { p * share } else { 0.0 };
            drawn += if bsdf.draw([choice, v, w]).dot(mirror) > 0.95 { 1.0 / count as f32 } else { 0.0 };
        }
        assert!((whole - 1.0).abs() < NOISE, "{whole}");
        assert!((near - drawn).abs() < NOISE, "{near} {drawn}");
        let by_draws = albedo(&bsdf, 1 << 14);
        assert!((by_draws - reflected).abs().max_element() < NOISE, "{by_draws} {reflected}");
    }

    #[test]
    fn white_paint_and_white_metal_return_all_light() {
        // Where the table is too bright, too little is compensated.
        const TABLE_NOISE: f32 = 0.045;
        let table = AlbedoTable::new();
        for metallic in [0.0, 1.0] {
            for roughness in [0.2, 0.5, 1.0] {
                for cosine in [0.3, 0.9] {
                    let surface = Surface::plain(Vec3::Z, Vec3::ONE, metallic, roughness);
                    let white = albedo(&Bsdf::new(&surface, view(cosine), &table), 4096);
                    assert!(
                        (white - 1.0).abs().max_element() < TABLE_NOISE,
                        "{metallic} {roughness} {cosine}: {white}"
                    );
                }
            }
        }
    }

    #[test]
    fn points_of_the_disc_fill_equal_areas() {
        let sobol = Sobol::new(1024);
        let inner = (0..1024).filter(|&i| {
            let [u, v, ..] = sobol.sequence((0, 0), i).next();
            disc([u, v]).length_squared() < 0.25
        });
        // A (0, 2) sequence counts an area within a few cells of its boundary.
        assert!((inner.count() as f32 / 1024.0 - 0.25).abs() < 0.01);
    }
}

//! Materials at a point of the exhibit: the port of `seen` and `tint_fragment` of `forward.wgsl`.
//!
//! Left out is what only helps a picture of few samples: ambient occlusion, and lobes that widen where normals vary
//! within a pixel. Without tangents in the file, the frame of a normal map follows from the triangle: +x is the
//! direction in which u grows, +y the one in which v falls, since v grows down the image (glTF 2.0, 3.9.3).

use glam::{Vec2, Vec3, Vec4};

use super::super::materials::{MaterialUniform, default_appearance, uniform, uses};
use super::super::textures::ColorSpace::{Linear, Srgb};
use super::texture::{Map, Textures};
use soffio_exhibit::model::Model;

/// Smallest perceptual roughness of a mesh, as in `forward.wgsl`.
const SMOOTHEST: f32 = 0.045;

/// A point of a triangle, interpolated between its corners, in the world.
pub(super) struct Point {
    /// Normal of the vertices, unit.
    pub normal: Vec3,
    /// Normal of the triangle, unit, towards the viewer.
    pub facing: Vec3,
    /// Tangent and the sign of the bitangent; 0 without one.
    pub tangent: Vec4,
    /// Both sets of texture coordinates.
    pub uv: [f32; 4],
    /// Vertex colour, linear RGBA.
    pub color: Vec4,
    /// Two edges of the triangle, m, and the differences of both sets of coordinates along them.
    pub edges: [(Vec3, [f32; 4]); 2],
}

/// The optical properties at a point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Surface {
    /// Unit, towards the viewer.
    pub normal: Vec3,
    /// Normal of the geometry, unit, towards the viewer.
    pub facing: Vec3,
    /// Base colour, linear RGB.
    pub albedo: Vec3,
    /// Alpha.
    pub alpha: f32,
    /// 0 … 1.
    pub metallic: f32,
    /// Perceptual.
    pub roughness: f32,
    /// Specular reflectance at normal incidence, of what is not metal.
    pub f0: Vec3,
    /// The same at grazing incidence.
    pub f90: f32,
    /// Transmitted fraction of the refracted light.
    pub transmission: f32,
    /// Linear RGB.
    pub sheen: Vec3,
    /// Perceptual.
    pub sheen_roughness: f32,
    /// Strength of the clear coat, 0 … 1.
    pub coat: f32,
    /// Perceptual.
    pub coat_roughness: f32,
    /// Unit, towards the viewer.
    pub coat_normal: Vec3,
    /// Emitted radiance, linear RGB.
    pub glow: Vec3,
    /// Is the base colour shown without lighting?
    pub unlit: bool,
    /// 1/m.
    pub absorption: Vec3,
    /// m.
    pub thickness: f32,
    /// Refractive index.
    pub ior: f32,
}

impl Surface {
    /// Paint or metal without a texture, as `plain_surface` of `lighting.wgsl`.
    pub fn plain(normal: Vec3, albedo: Vec3, metallic: f32, roughness: f32) -> Self {
        Self {
            normal,
            facing: normal,
            albedo,
            alpha: 1.0,
            metallic,
            roughness,
            f0: Vec3::splat(0.04),
            f90: 1.0,
            transmission: 0.0,
            sheen: Vec3::ZERO,
            sheen_roughness: 1.0,
            coat: 0.0,
            coat_roughness: 1.0,
            coat_normal: normal,
            glow: Vec3::ZERO,
            unlit: false,
            absorption: Vec3::ZERO,
            thickness: 0.0,
            ior: 1.5,
        }
    }

    /// Fraction of the light that one crossing of the surface transmits, per channel; `view` is the unit direction to the
    /// viewer. The base colour is that of a whole pane, two crossings.
    pub fn transmittance(&self, view: Vec3) -> Vec3 {
        let nv = self.normal.dot(view).clamp(0.0, 1.0);
        let x = 1.0 - nv;
        let fresnel = self.f0 + (self.f90 - self.f0) * (x * x * x * x * x);
        // Path length through the wall by Snell's law, limited where a curved wall is seen along itself.
        let refracted = (1.0 - (1.0 - nv * nv) / (self.ior * self.ior)).max(0.05).sqrt();
        let path = 1.0 / refracted + 4.0 * x * x * x;
        let color = self.albedo.max(Vec3::splat(1e-3)).map(|c| c.powf(0.5 * path));
        let absorbed = (-self.absorption * self.thickness * path).exp();
        self.transmission * (1.0 - self.metallic) * (1.0 - fresnel) * color * absorbed
    }
}

/// A material of the model.
struct Material {
    of: MaterialUniform,
    /// Base colour, metallic and roughness, normal, occlusion, emission.
    maps: [Option<Map>; 5],
    /// In the order of `Details::all`.
    details: [Option<Map>; 9],
}

/// All materials of a model, and last the default one.
pub(super) struct Materials<'a> {
    textures: Textures<'a>,
    list: Vec<Material>,
}

impl<'a> Materials<'a> {
    /// The materials of a model.
    pub fn new(model: &'a Model) -> Self {
        let default = default_appearance();
        let of = |appearance: &_| Material {
            of: uniform(appearance),
            maps: [0, 1, 2, 3, 4].map(|i| {
                let space = if i == 0 || i == 4 { Srgb } else { Linear };
                uses(appearance)[i].map(|of| Map::new(of, space))
            }),
            details: std::array::from_fn(|i| {
                // Specular strength and colour, sheen and its roughness are stored with colours.
                let space = if matches!(i, 2 | 3 | 7 | 8) { Srgb } else { Linear };
                appearance.details.all()[i].map(|of| Map::new(of, space))
            }),
        };
        let list = model.materials.iter().chain([&default]).map(of).collect();
        Self { textures: Textures::new(&model.images), list }
    }

    /// Does the material let light through where its alpha is below a threshold?
    pub fn has_holes(&self, material: usize) -> bool {
        self.list[material].of.cutoff > 0.0
    }

    /// Is a material's alpha at these coordinates below its threshold?
    pub fn is_hole(&self, material: usize, uv: [f32; 4], color: Vec4) -> bool {
        let of = &self.list[material];
        self.base(of, uv, color).w < of.of.cutoff
    }

    fn base(&self, material: &Material, uv: [f32; 4], color: Vec4) -> Vec4 {
        Vec4::from_array(material.of.base_color) * color * self.textures.read(material.maps[0].as_ref(), uv)
    }

    /// The properties of a material at a point.
    pub fn surface(&self, material: usize, point: &Point) -> Surface {
        let Material { of, maps, details } = &self.list[material];
        let read = |map: &Option<Map>| self.textures.read(map.as_ref(), point.uv);
        let base = self.base(&self.list[material], point.uv, point.color);
        let metal_rough = read(&maps[1]);
        let n = (point.normal + point.facing * 1e-6).normalize_or(point.facing);
        let smooth = if n.dot(point.facing) >= 0.0 { n } else { -n };
        let bent = |map: &Option<Map>, scale: f32| match map {
            Some(map) if scale != 0.0 => {
                let bump = self.textures.read(Some(map), point.uv).truncate() * 2.0 - 1.0;
                bent(point, smooth, map, bump, scale)
            }
            _ => smooth,
        };
        let [transmission, thickness, strength, tint, coat, coat_rough, coat_normal, sheen, sheen_rough] = details;
        let strength = read(strength).w;
        let roughness = |r: f32| r.clamp(SMOOTHEST, 1.0);
        Surface {
            normal: bent(&maps[2], of.normal_scale),
            facing: point.facing,
            albedo: base.truncate(),
            alpha: base.w,
            metallic: (of.metallic * metal_rough.z).clamp(0.0, 1.0),
            roughness: roughness(of.roughness * metal_rough.y),
            f0: Vec3::from_array(of.f0) * read(tint).truncate() * strength,
            f90: of.f90 * strength,
            transmission: of.transmission * read(transmission).x,
            sheen: Vec3::from_array(of.sheen) * read(sheen).truncate(),
            sheen_roughness: of.sheen_roughness * read(sheen_rough).w,
            coat: of.coat * read(coat).x,
            coat_roughness: roughness(of.coat_roughness * read(coat_rough).y),
            coat_normal: bent(coat_normal, of.coat_normal_scale),
            glow: Vec3::from_array(of.emissive) * read(&maps[4]).truncate(),
            unlit: of.unlit > 0.5,
            absorption: Vec3::from_array(of.absorption),
            thickness: of.thickness * read(thickness).y,
            ior: of.ior,
        }
    }
}

/// Normal n perturbed by a normal map.
pub(super) fn bent(point: &Point, n: Vec3, map: &Map, bump: Vec3, scale: f32) -> Vec3 {
    let (t, b) = if point.tangent.w != 0.0 {
        let t = point.tangent.truncate();
        (t, n.cross(t) * point.tangent.w)
    } else {
        // Gradients of u and v over the surface (Schüler 2006).
        let [(e1, uv1), (e2, uv2)] = point.edges;
        let [d1, d2]: [Vec2; 2] = [map.difference(uv1), map.difference(uv2)];
        let (x, y) = (n.cross(e1), e2.cross(n));
        let side = n.dot(e1.cross(e2)).signum();
        let (t, b) = (side * (y * d1.x + x * d2.x), -side * (y * d1.y + x * d2.y));
        let longest = t.length_squared().max(b.length_squared()).max(1e-30);
        (t / longest.sqrt(), b / longest.sqrt())
    };
    (t * bump.x * scale + b * bump.y * scale + n * bump.z).normalize_or(n)
}

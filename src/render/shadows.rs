//! Shadow receivers of the gallery, and the camera of the shadow map.
//!
//! A plane's texture covers the part of the wall or floor that the exhibit's shadow can reach from either lamp. For
//! this the exhibit is taken as the box that its bounds sweep when it rotates about the vertical.

use glam::{Mat4, Vec2, Vec3, Vec4};

use super::gallery::Gallery;
use super::{Lighting, ShadowQuality};
use soffio_exhibit::Exhibit;

/// Format of the plane shadows: covered fraction of each lamp.
pub(super) const PLANE_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rg16Float;
/// Depth of the shadow map while it is drawn.
pub(super) const MAP_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;
/// The same depth as three bytes, for reading.
pub(super) const BLOCKER_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// Part of a wall or floor that receives a shadow.
#[derive(Clone, Copy, Debug)]
pub(super) struct ReceivingPlane {
    /// Corner at texture coordinates (0, 0), world, m.
    pub origin: Vec3,
    /// Unit vectors along texture u and v.
    pub u: Vec3,
    /// Unit vector along texture v.
    pub v: Vec3,
    /// Unit normal, towards the exhibit.
    pub normal: Vec3,
    /// Size along u and v, m.
    pub size: Vec2,
    /// Texels along u and v.
    pub texels: (u32, u32),
}

impl ReceivingPlane {
    /// The wall and the floor of a gallery, limited to where the exhibit's shadow can fall.
    pub fn of_gallery(gallery: &Gallery, exhibit: &Exhibit, quality: ShadowQuality) -> [Self; 2] {
        let (wall, floor) = match quality {
            ShadowQuality::Light => (560, 400),
            ShadowQuality::Full => (1024, 720),
        };
        let corner = gallery.to_world(-gallery.half);
        [
            Self::reached(
                gallery,
                exhibit,
                corner + Vec3::Y * (2.0 * gallery.half.y),
                gallery.x,
                -Vec3::Y,
                gallery.z,
                wall,
            ),
            Self::reached(gallery, exhibit, corner, gallery.x, gallery.z, Vec3::Y, floor),
        ]
    }

    /// The rectangle of the plane through `corner` that the box's shadow reaches, with `resolution` texels along its
    /// longer side.
    fn reached(
        gallery: &Gallery,
        exhibit: &Exhibit,
        corner: Vec3,
        u: Vec3,
        v: Vec3,
        normal: Vec3,
        resolution: u32,
    ) -> Self {
        let bounds = exhibit.bounds();
        let half = if bounds.is_empty() { Vec3::splat(0.5) } else { (0.5 * (bounds.max - bounds.min)).as_vec3() };
        let swept = half.with_y(0.0).length();
        let half = Vec3::new(swept, half.y, swept) * 1.08;
        let (mut low, mut high) = (Vec2::INFINITY, Vec2::NEG_INFINITY);
        for lamp in &gallery.lamps {
            let light = lamp.position - corner;
            let d = light.dot(normal);
            for i in 0..8 {
                let sign = |bit: u32| if i & bit == 0 { -1.0 } else { 1.0 };
                let p = gallery.exhibit_center + half * Vec3::new(sign(1), sign(2), sign(4)) - corner;
                // Below 0.8 of the lamp's height; a number that is none counts as 0.
                let h = p.dot(normal).max(0.0).min((0.8 * d).max(0.0));
                let foot = light + (p - light) * (d / (d - h));
                let penumbra = lamp.radius * h / (d - h) * 1.5;
                let at = Vec2::new(foot.dot(u), foot.dot(v));
                low = low.min(at - penumbra);
                high = high.max(at + penumbra);
            }
        }
        let face = Vec2::new(
            (gallery.half * gallery_axis(gallery, u)).length(),
            (gallery.half * gallery_axis(gallery, v)).length(),
        ) * 2.0;
        let (low, high) = (low.max(Vec2::ZERO), high.min(face));
        let size = (high - low).max(Vec2::splat(1e-3));
        let texel = size.max_element() / resolution as f32;
        let texels = |side: f32| ((side / texel).ceil() as u32).clamp(1, resolution);
        let origin = corner + u * low.x + v * low.y;
        Self { origin, u, v, normal, size, texels: (texels(size.x), texels(size.y)) }
    }
}

/// Absolute components of a world axis in the gallery's frame.
fn gallery_axis(gallery: &Gallery, axis: Vec3) -> Vec3 {
    Vec3::new(axis.dot(gallery.x), axis.y, axis.dot(gallery.z)).abs()
}

/// The shadow-map camera at the light that shades the exhibit itself.
#[derive(Clone, Copy, Debug)]
pub(super) struct ShadowMapCamera {
    /// View and projection of the light.
    pub clip_from_world: Mat4,
    /// Radius of the light, m.
    pub light_radius: f32,
    /// Size of a texel at distance 1.
    pub texel: f32,
    /// Distances of reversed depth 1 and 0, m.
    pub near: f32,
    /// Distance of reversed depth 0, m.
    pub far: f32,
}

impl ShadowMapCamera {
    /// Texels along a side of the map.
    pub fn size(quality: ShadowQuality) -> u32 {
        if quality == ShadowQuality::Light { 768 } else { 1024 }
    }

    /// Position and radius of the light that casts the map, m: the area light if there is one, the key lamp otherwise.
    pub fn light(gallery: &Gallery, lighting: &Lighting) -> (Vec3, f32) {
        match &lighting.area_light {
            Some(area) => {
                let surface = 4.0 * area.half_width.cross(area.half_height).length();
                (area.center, (surface / std::f32::consts::PI).sqrt())
            }
            None => (gallery.lamps[0].position, gallery.lamps[0].radius),
        }
    }

    /// The camera at that light. It covers everything the exhibit may sweep; in a static scene its casters alone, where there
    /// are any.
    pub fn new(gallery: &Gallery, lighting: &Lighting, quality: ShadowQuality, casters: &[Vec3]) -> Self {
        let (eye, light_radius) = Self::light(gallery, lighting);
        let offset = gallery.exhibit_center - eye;
        let distance = offset.length().max(1.05 * gallery.radius);
        let low = casters.iter().copied().fold(Vec3::INFINITY, Vec3::min);
        let high = casters.iter().copied().fold(Vec3::NEG_INFINITY, Vec3::max);
        let aim = if casters.is_empty() { offset } else { 0.5 * (low + high) - eye };
        let forward = aim.normalize_or(Vec3::NEG_Z);
        let (right, up) = forward.any_orthonormal_pair();
        let sine = (1.02 * gallery.radius / distance).min(0.97);
        let widest = sine / (1.0 - sine * sine).sqrt();
        // The volume that the exhibit sweeps lies between these.
        let far = distance + 1.02 * gallery.radius;
        let nearest = 0.02 * distance;
        let (half, near) = if casters.is_empty() {
            (widest, distance - 1.02 * gallery.radius)
        } else {
            let seen = casters.iter().map(|&p| p - eye).filter(|p| p.dot(forward) > nearest);
            seen.fold((0.0_f32, far), |(half, near), p| {
                let w = p.dot(forward);
                (half.max(p.dot(right).abs().max(p.dot(up).abs()) / w), near.min(w))
            })
        };
        let (half, near) = ((1.02 * half).clamp(1e-3, 4.0), (0.99 * near).max(nearest));
        let f = 1.0 / half;
        let row = |axis: Vec3, scale: f32| (axis * scale).extend(-axis.dot(eye) * scale);
        // z = n (f − w) / (f − n), over w.
        let depth = row(forward, -near / (far - near)) + Vec4::W * (near * far / (far - near));
        let clip_from_world = Mat4::from_cols(row(right, f), row(up, f), depth, row(forward, 1.0)).transpose();
        let size = Self::size(quality);
        Self { clip_from_world, light_radius, texel: 2.0 * half / size as f32, near, far }
    }
}

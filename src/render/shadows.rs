//! Where shadows fall: the two receiving planes of the room and the camera of the shadow map.
//!
//! A plane's texture covers the part of the wall or floor that the work's shadow can reach from either lamp, whatever
//! its parts do: the work is taken as the box that its bounds sweep when it turns about the vertical.

use glam::{Mat4, Vec2, Vec3, Vec4};

use super::gallery::Room;
use super::{Look, Quality};
use soffio_exhibit::Exhibit;

/// Format of the plane shadows: blocked fraction of either lamp.
pub(super) const PLANE_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rg16Float;
/// Depths of the shadow map, while it is drawn.
pub(super) const MAP_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;
/// The same depths as three bytes, to be read.
pub(super) const BLOCKER_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// Part of a wall or floor that receives a shadow.
#[derive(Clone, Copy, Debug)]
pub(super) struct ReceivingPlane {
    /// Corner at texture coordinates (0, 0), world, m.
    pub origin: Vec3,
    /// Unit, along texture u and v.
    pub u: Vec3,
    pub v: Vec3,
    pub normal: Vec3,
    /// m along u and v.
    pub size: Vec2,
    /// Texels along u and v.
    pub texels: (u32, u32),
}

impl ReceivingPlane {
    /// The wall and the floor of a room, cut to where the exhibit's shadow can fall.
    pub fn of_room(room: &Room, exhibit: &Exhibit, quality: Quality) -> [Self; 2] {
        let (wall, floor) = match quality {
            Quality::Light => (560, 400),
            Quality::Full => (1024, 720),
        };
        let corner = room.to_world(-room.half);
        [
            Self::reached(room, exhibit, corner + Vec3::Y * (2.0 * room.half.y), room.x, -Vec3::Y, room.z, wall),
            Self::reached(room, exhibit, corner, room.x, room.z, Vec3::Y, floor),
        ]
    }

    /// The rectangle of the plane through `corner` that the box's shadow reaches, `resolution` texels at its longer
    /// side.
    fn reached(room: &Room, exhibit: &Exhibit, corner: Vec3, u: Vec3, v: Vec3, normal: Vec3, resolution: u32) -> Self {
        let bounds = exhibit.bounds(false);
        let half = if bounds.is_empty() { Vec3::splat(0.5) } else { (0.5 * (bounds.max - bounds.min)).as_vec3() };
        let swept = half.with_y(0.0).length();
        let half = Vec3::new(swept, half.y, swept) * 1.08;
        let (mut low, mut high) = (Vec2::INFINITY, Vec2::NEG_INFINITY);
        for lamp in &room.lamps {
            let light = lamp.position - corner;
            let d = light.dot(normal);
            for i in 0..8 {
                let sign = |bit: u32| if i & bit == 0 { -1.0 } else { 1.0 };
                let p = room.work + half * Vec3::new(sign(1), sign(2), sign(4)) - corner;
                let h = p.dot(normal).clamp(0.0, 0.8 * d);
                let foot = light + (p - light) * (d / (d - h));
                let penumbra = lamp.radius * h / (d - h) * 1.5;
                let at = Vec2::new(foot.dot(u), foot.dot(v));
                low = low.min(at - penumbra);
                high = high.max(at + penumbra);
            }
        }
        let face =
            Vec2::new((room.half * room_axis(room, u)).length(), (room.half * room_axis(room, v)).length()) * 2.0;
        let (low, high) = (low.max(Vec2::ZERO), high.min(face));
        let size = (high - low).max(Vec2::splat(1e-3));
        let texel = size.max_element() / resolution as f32;
        let texels = ((size.x / texel).ceil() as u32, (size.y / texel).ceil() as u32);
        Self { origin: corner + u * low.x + v * low.y, u, v, normal, size, texels: (texels.0.max(1), texels.1.max(1)) }
    }
}

/// A world axis in the room's frame, without sign.
fn room_axis(room: &Room, axis: Vec3) -> Vec3 {
    Vec3::new(axis.dot(room.x), axis.y, axis.dot(room.z)).abs()
}

/// The camera at the light that shades the work itself.
#[derive(Clone, Copy, Debug)]
pub(super) struct MapCamera {
    pub clip_from_world: Mat4,
    /// Radius of the light, m.
    pub light_radius: f32,
    /// Size of a texel at distance 1.
    pub texel: f32,
    /// Where the reversed depth is 1, and where it is 0, m.
    pub near: f32,
    pub far: f32,
}

impl MapCamera {
    /// Texels along a side of the map.
    pub fn size(quality: Quality) -> u32 {
        if quality == Quality::Light { 768 } else { 1024 }
    }

    /// From the area light if there is one, from the key lamp otherwise, around everything the work may sweep; in a still
    /// scene around its casters alone, where there are any.
    pub fn new(room: &Room, look: &Look, quality: Quality, casters: impl FnOnce(Vec3) -> Vec<Vec3>) -> Self {
        let (eye, light_radius) = match &look.area_light {
            Some(area) => {
                let surface = 4.0 * area.half.0.cross(area.half.1).length();
                (area.center, (surface / std::f32::consts::PI).sqrt())
            }
            None => (room.lamps[0].position, room.lamps[0].radius),
        };
        let offset = room.work - eye;
        let distance = offset.length().max(1.05 * room.radius);
        let casters = casters(eye);
        let low = casters.iter().copied().fold(Vec3::INFINITY, Vec3::min);
        let high = casters.iter().copied().fold(Vec3::NEG_INFINITY, Vec3::max);
        let aim = if casters.is_empty() { offset } else { 0.5 * (low + high) - eye };
        let forward = aim.normalize_or(Vec3::NEG_Z);
        let (right, up) = forward.any_orthonormal_pair();
        let sine = (1.02 * room.radius / distance).min(0.97);
        let widest = sine / (1.0 - sine * sine).sqrt();
        // All that the work sweeps lies between these.
        let far = distance + 1.02 * room.radius;
        let nearest = 0.02 * distance;
        let (half, near) = if casters.is_empty() {
            (widest, distance - 1.02 * room.radius)
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

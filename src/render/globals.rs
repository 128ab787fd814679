//! Uniforms of a frame, in the layout of `common.wgsl`.

use bytemuck::{Pod, Zeroable};
use glam::{Mat4, Vec2, Vec3, Vec4};

use super::gallery::{FACES, FLOOR_ALBEDO, Gallery, PANELS, WALL_ALBEDO};
use super::punctual::{MAX_PUNCTUAL, Punctual, PunctualUniform};
use super::shadows::{ReceivingPlane, ShadowMapCamera};
use super::{FrameInput, Lighting, ShadowQuality, Tonemap};
use soffio_exhibit::View;

/// Taps of the blocker search of the shadow map, by shadow quality: chosen by eye against noise in penumbrae. Its
/// filter has three times as many.
const SHADOW_TAPS: [f32; 2] = [24.0, 32.0];

/// A disc lamp.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct LampUniform {
    position: Vec3,
    radius: f32,
    color: Vec3,
    cos_outer: f32,
    axis: Vec3,
    cos_inner: f32,
}

/// A receiving plane.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct PlaneUniform {
    origin: Vec3,
    width: f32,
    u: Vec3,
    height: f32,
    v: Vec3,
    spare: f32,
    normal: Vec3,
    spare2: f32,
}

/// A rectangle of another reflectance on a face of the gallery.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct PanelUniform {
    center: Vec2,
    half: Vec2,
    albedo: Vec3,
    /// Index of the face, as in `gallery.wgsl`.
    face: f32,
}

/// `Globals` of `common.wgsl`, field by field. It has 37 fields, because it is the layout of the shaders' uniform block.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub(super) struct Globals {
    /// View and projection of the camera.
    pub clip_from_world: Mat4,
    shadow_from_world: Mat4,
    /// Position of the camera, world, m.
    pub eye: Vec3,
    exposure: f32,
    right: Vec3,
    /// Size of a pixel at distance 1.
    pub pixel_angle: f32,
    up: Vec3,
    shadow_taps: f32,
    gallery_center: Vec3,
    dither: f32,
    gallery_half: Vec3,
    dust_radius: f32,
    gallery_x: Vec3,
    env_intensity: f32,
    gallery_z: Vec3,
    env_lods: f32,
    wall_albedo: Vec3,
    lamp_count: u32,
    floor_albedo: Vec3,
    /// Number of punctual lights in use.
    pub punctual_count: u32,
    area_center: Vec3,
    shadow_radius: f32,
    area_x: Vec3,
    shadow_texel: f32,
    area_y: Vec3,
    shadow_samples: f32,
    area_radiance: Vec3,
    shadow_near: f32,
    background: Vec3,
    shadow_far: f32,
    environment_origin: Vec3,
    spare: f32,
    irradiance: [Vec4; 9],
    lamps: [LampUniform; 2],
    planes: [PlaneUniform; 2],
    panels: [PanelUniform; PANELS.len()],
    /// Punctual lights, world frame.
    pub punctual: [PunctualUniform; MAX_PUNCTUAL],
}

impl Globals {
    /// The uniforms that do not change from frame to frame.
    pub fn new(
        lighting: &Lighting,
        gallery: &Gallery,
        irradiance: &[Vec3; 9],
        map: &ShadowMapCamera,
        planes: &[ReceivingPlane; 2],
        (quality, shadow_samples): (ShadowQuality, u32),
    ) -> Self {
        let mut g = Self::zeroed();
        // Without a tone curve the picture is a measurement, so it is not dithered.
        g.dither = if lighting.tonemap == Tonemap::Clamp { 0.0 } else { 1.0 };
        (g.gallery_center, g.gallery_half, g.gallery_x, g.gallery_z) =
            (gallery.center, gallery.half, gallery.x, gallery.z);
        g.dust_radius = 0.004 * gallery.radius.clamp(0.2, 1.0);
        g.env_intensity = lighting.env_intensity;
        g.env_lods = (super::environment::CUBE_MIPS - 1) as f32;
        (g.wall_albedo, g.floor_albedo) = (WALL_ALBEDO, FLOOR_ALBEDO);
        g.lamp_count = if lighting.background.is_some() { 0 } else { gallery.lamps.len() as u32 };
        g.background = lighting.background.unwrap_or_default();
        if let Some(area) = lighting.area_light {
            (g.area_center, g.area_radiance) = (area.center, area.radiance);
            (g.area_x, g.area_y) = (area.half_width, area.half_height);
        }
        g.shadow_from_world = map.clip_from_world;
        (g.shadow_radius, g.shadow_texel) = (map.light_radius, map.texel);
        (g.shadow_near, g.shadow_far) = (map.near, map.far);
        let taps = SHADOW_TAPS[(quality == ShadowQuality::Full) as usize];
        (g.shadow_samples, g.shadow_taps) = (shadow_samples as f32, taps);
        g.environment_origin = gallery.exhibit_center;
        for (to, from) in g.irradiance.iter_mut().zip(irradiance) {
            *to = from.extend(0.0);
        }
        for (to, panel) in g.panels.iter_mut().zip(&PANELS) {
            let face = FACES.iter().position(|face| *face == panel.face).unwrap_or(0);
            *to = PanelUniform { center: panel.center, half: panel.half, albedo: panel.albedo, face: face as f32 };
        }
        for (to, lamp) in g.lamps.iter_mut().zip(&gallery.lamps) {
            *to = LampUniform {
                position: lamp.position,
                radius: lamp.radius,
                color: lamp.intensity,
                cos_outer: lamp.cos_outer,
                axis: lamp.axis,
                cos_inner: lamp.cos_inner,
            };
        }
        for (to, plane) in g.planes.iter_mut().zip(planes) {
            *to = PlaneUniform {
                origin: plane.origin,
                width: plane.size.x,
                u: plane.u,
                height: plane.size.y,
                v: plane.v,
                spare: 0.0,
                normal: plane.normal,
                spare2: 0.0,
            };
        }
        g
    }

    /// Sets the uniforms of a frame.
    pub fn set_frame(&mut self, frame: &FrameInput, radius: f32) {
        let (width, height) = (frame.size.0.max(1) as f64, frame.size.1.max(1) as f64);
        let (right, up, _) = frame.view.axes();
        // The exhibit is metres away from the camera; a near plane at a fiftieth of its size loses nothing (reversed
        // depth).
        self.clip_from_world = clip_from_world(&frame.view, width / height, 0.02 * f64::from(radius)).as_mat4();
        (self.eye, self.right, self.up) = (frame.view.eye.as_vec3(), right.as_vec3(), up.as_vec3());
        self.pixel_angle = (2.0 * (0.5 * frame.view.fovy).tan() / height) as f32;
        self.exposure = frame.exposure;
    }

    /// Sets the punctual lights at their present positions.
    pub fn set_lights(&mut self, lights: &[Punctual], place: impl Fn(usize) -> Mat4) {
        self.punctual_count = lights.len() as u32;
        for (to, light) in self.punctual.iter_mut().zip(lights) {
            *to = light.uniform(place(light.frame));
        }
    }
}

/// Reversed infinite perspective: depth 1 at `near`, 0 at infinity, which uses the precision of a 32-bit float best.
pub(super) fn clip_from_world(view: &View, aspect: f64, near: f64) -> glam::DMat4 {
    let (right, up, forward) = view.axes();
    let f = 1.0 / (0.5 * view.fovy).tan();
    let rows = [
        right.extend(-right.dot(view.eye)) * (f / aspect),
        up.extend(-up.dot(view.eye)) * f,
        glam::DVec4::W * near,
        forward.extend(-forward.dot(view.eye)),
    ];
    glam::DMat4::from_cols(rows[0], rows[1], rows[2], rows[3]).transpose()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_matrix_agrees_with_the_view_and_depth_runs_backwards() {
        // Rounding of a few double-precision operations.
        const ROUNDING: f64 = 1e-12;
        let view = View {
            eye: glam::DVec3::new(1.0, 2.0, 3.0),
            target: glam::DVec3::new(0.0, 1.0, -1.0),
            up: glam::DVec3::Y,
            fovy: 0.6,
        };
        let m = clip_from_world(&view, 1.5, 0.01);
        for p in [glam::DVec3::ZERO, glam::DVec3::new(0.3, 0.9, -2.0)] {
            let c = m * p.extend(1.0);
            let at = view.project(p, 1.5).expect("in front");
            assert!(
                (0.5 + 0.5 * c.x / c.w - at[0]).abs() < ROUNDING && (0.5 - 0.5 * c.y / c.w - at[1]).abs() < ROUNDING
            );
        }
        let depth = |distance: f64| {
            let c = m * (view.eye + view.axes().2 * distance).extend(1.0);
            c.z / c.w
        };
        assert!((depth(0.01) - 1.0).abs() < ROUNDING && depth(1.0) > depth(2.0) && depth(1e6) > 0.0);
    }
}

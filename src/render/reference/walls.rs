//! The gallery's box as a path meets it: walls, floor, luminous fields.
//!
//! A ray leaves the box through the nearest of the three planes ahead. From outside, the walls are transparent. Paint,
//! boards and the gap at the foot of the walls are those of `gallery.wgsl`, at a point instead of over a pixel. A test
//! compares the numbers.

use glam::{Vec2, Vec3};

use super::super::AreaLight;
use super::super::gallery::{FLOOR_ALBEDO, Face, Gallery, reflectance};
use super::bsdf::Bsdf;
use super::gloss::AlbedoTable;

/// Perceptual roughness of the floor's varnish.
const FLOOR_ROUGHNESS: f32 = 0.42;
/// Contrast of the grain of each size.
const GRAIN: f32 = 0.16;
/// Width of a board, m.
const BOARD: f32 = 0.14;
/// Width of the groove between two boards, m.
const GROOVE: f32 = 0.002;
/// Light that a groove swallows.
const GROOVE_SHADE: f32 = 0.28;
/// Difference between the lightest and the darkest board.
const BOARD_CONTRAST: f32 = 0.07;
/// Height of the shadow gap at the foot of the walls, in half heights of the gallery.
const GAP: f32 = 0.004;
/// Light that the gap swallows.
const GAP_SHADE: f32 = 0.72;

/// Where a ray meets the box.
pub(super) struct WallHit {
    /// Distance, m.
    pub distance: f32,
    /// Inward unit normal, world.
    pub normal: Vec3,
    face: Face,
    /// In the face's coordinates, −1 … 1.
    at: Vec2,
    /// Position in the gallery's frame, m.
    local: Vec3,
}

/// The point where a ray leaves the gallery; `None` where it does not.
pub(super) fn hit(gallery: &Gallery, origin: Vec3, direction: Vec3) -> Option<WallHit> {
    let into = |v: Vec3| Vec3::new(v.dot(gallery.x), v.y, v.dot(gallery.z));
    let (o, d) = (into(origin - gallery.center), into(direction));
    let side = d.map(|c| if c < 0.0 { -1.0 } else { 1.0 });
    let to = (gallery.half * side - o) / (side * d.abs().max(Vec3::splat(1e-9)));
    let distance = to.min_element();
    if distance <= 0.0 {
        return None;
    }
    let local = o + d * distance;
    let part = local / gallery.half;
    // Beyond the edges only where the ray passes the box outside.
    if part.abs().max_element() > 1.0 + 1e-4 {
        return None;
    }
    let (face, at, normal) = if distance == to.x {
        let face = if d.x > 0.0 { Face::Right } else { Face::Left };
        (face, Vec2::new(part.y, part.z), -side.x * gallery.x)
    } else if distance == to.y {
        let face = if d.y > 0.0 { Face::Ceiling } else { Face::Floor };
        (face, Vec2::new(part.x, part.z), -side.y * Vec3::Y)
    } else {
        let face = if d.z > 0.0 { Face::Back } else { Face::Wall };
        (face, Vec2::new(part.x, part.y), -side.z * gallery.z)
    };
    Some(WallHit { distance, normal, face, at, local })
}

/// The luminous fields as rectangles that shine inwards.
pub(super) fn fields(gallery: &Gallery) -> Vec<AreaLight> {
    let rectangle = |field: &super::super::gallery::Field| {
        let [u, v, c] = gallery.face_axes(field.face);
        let world = |local: Vec3| gallery.to_world(local) - gallery.center;
        let inwards = if u.cross(v).dot(c) < 0.0 { 1.0 } else { -1.0 };
        AreaLight {
            center: gallery.to_world(c + u * field.center.x + v * field.center.y),
            half_width: world(u * field.half.x),
            half_height: world(v * field.half.y) * inwards,
            radiance: field.radiance,
        }
    };
    gallery.fields.iter().map(rectangle).collect()
}

impl WallHit {
    /// Indices of the fields that contain the point.
    pub fn fields<'a>(&'a self, gallery: &'a Gallery) -> impl Iterator<Item = usize> + 'a {
        let inside = |f: &super::super::gallery::Field| (self.at - f.center).abs().cmple(f.half).all();
        let here = move |(_, f): &(usize, &super::super::gallery::Field)| f.face == self.face && inside(f);
        gallery.fields.iter().enumerate().filter(here).map(|(i, _)| i)
    }

    /// Reflection towards `view` (unit); the floor has its varnish where there is a table for it.
    pub fn bsdf(&self, view: Vec3, half_height: f32, table: Option<&AlbedoTable>) -> Bsdf {
        let albedo = match self.face {
            Face::Floor => FLOOR_ALBEDO * boards(self.local.x) * grain(self.local.x, self.local.z),
            face => reflectance(face, self.at) * self.shade(half_height),
        };
        match table {
            Some(table) if self.face == Face::Floor => {
                Bsdf::varnished(self.normal, view, albedo, FLOOR_ROUGHNESS, table)
            }
            _ => Bsdf::matte(self.normal, view, albedo),
        }
    }

    /// What the gap leaves of the light of a wall.
    fn shade(&self, half_height: f32) -> f32 {
        let above = self.local.y / half_height + 1.0;
        if matches!(self.face, Face::Floor | Face::Ceiling) || above > GAP { 1.0 } else { 1.0 - GAP_SHADE }
    }
}

/// Shade of the floor's boards at a position across them, m; 1 on average.
fn boards(across: f32) -> f32 {
    let x = across / BOARD;
    let groove = if (x - x.round()).abs() < 0.5 * GROOVE / BOARD { 1.0 - GROOVE_SHADE } else { 1.0 };
    groove * (1.0 + BOARD_CONTRAST * pixel_noise(x.floor() + 4096.0, 77.0))
}

/// Grain of the boards at a place across and along them, m, as in `gallery.wgsl`; 1 on average.
fn grain(across: f32, along: f32) -> f32 {
    let board = (across / BOARD).floor();
    let of = |cell: Vec2| {
        let at = Vec2::new(across, along + 3.7 * board) / cell + 65536.0;
        let low = at.floor();
        let f = at - low;
        let s = f * f * (3.0 - 2.0 * f);
        let noise = |x: f32, y: f32| pixel_noise(low.x + x, low.y + y);
        let near = noise(0.0, 0.0) + (noise(1.0, 0.0) - noise(0.0, 0.0)) * s.x;
        let far = noise(0.0, 1.0) + (noise(1.0, 1.0) - noise(0.0, 1.0)) * s.x;
        GRAIN * (near + (far - near) * s.y)
    };
    1.0 + of(Vec2::new(0.0031, 0.17)) + of(Vec2::new(0.0113, 0.43))
}

/// Noise of a pixel, −½ … ½, as in `common.wgsl` (PCG, Jarzynski 2020).
fn pixel_noise(x: f32, y: f32) -> f32 {
    let h =
        (x as u32).wrapping_mul(1_664_525).wrapping_add((y as u32).wrapping_mul(1_013_904_223)).wrapping_add(12_345);
    let h = ((h >> ((h >> 28) + 4)) ^ h).wrapping_mul(277_803_737);
    let h = (h >> 22) ^ h;
    (h >> 8) as f32 / 16_777_216.0 - 0.5
}

#[cfg(test)]
mod tests {
    use std::f32::consts::PI;

    use super::super::super::gallery::WALL_ALBEDO;
    use super::super::super::scene::Scene;
    use super::super::lights::{Light, Rectangle};
    use super::super::material::Materials;
    use super::super::path::Stage;
    use super::super::sequence::Sobol;
    use super::super::world::World;
    use super::*;
    use soffio_exhibit::Exhibit;

    #[test]
    fn the_numbers_are_those_of_the_shader() {
        let shader = include_str!("../wgsl/gallery.wgsl");
        let number = |before: &str| -> f32 {
            let (_, after) = shader.split_once(before).unwrap_or_else(|| panic!("`{before}` in gallery.wgsl"));
            let end = after.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(after.len());
            after[..end].parse().unwrap_or_else(|error| panic!("{before}: {error}"))
        };
        for (before, here) in [
            ("FLOOR_ROUGHNESS: f32 = ", FLOOR_ROUGHNESS),
            ("BOARD: f32 = ", BOARD),
            ("GROOVE: f32 = ", GROOVE),
            ("GRAIN: f32 = ", GRAIN),
            ("GAP: f32 = ", GAP),
            ("tone * (1.0 - ", GROOVE_SHADE),
            ("return 1.0 + ", BOARD_CONTRAST),
            ("radiance *= 1.0 - ", GAP_SHADE),
        ] {
            assert_eq!(number(before), here, "{before}");
        }
    }

    #[test]
    fn boards_are_as_bright_as_the_floor_on_average() {
        // Grooves take 0.28 × 2 / 140, and the tones of 200 boards differ.
        const TOLERANCE: f32 = 5e-3;
        let count = 100_000;
        let mean = (0..count).map(|i| boards(i as f32 * 28.0 / count as f32 - 14.0)).sum::<f32>() / count as f32;
        assert!((mean - 1.0 + GROOVE_SHADE * GROOVE / BOARD).abs() < TOLERANCE, "{mean}");
    }

    #[test]
    fn the_empty_gallery_agrees_with_its_radiosity() {
        // Noise of 16 384 paths, patches of one brightness each, and a varnish that mirrors as if it were smooth: of what the wall
        // behind the exhibit sends.
        const PATCHES: f32 = 0.01;
        let exhibit = Exhibit::from_model(Default::default());
        let gallery = Gallery::around(&exhibit);
        let mut lights: Vec<Light> =
            fields(&gallery).into_iter().map(|f| Light::Rectangle(Rectangle::new(f))).collect();
        lights.extend(gallery.lamps.map(Light::Lamp));
        let materials = Materials::new(&exhibit.model);
        let stage = Stage {
            world: &World::new(&Scene::default(), Vec::new(), &[], &materials),
            gallery: Some(&gallery),
            lights: &lights,
            wide: gallery.fields.len(),
            sky: None,
            background: Vec3::ZERO,
            table: &AlbedoTable::new(),
            varnish: true,
            scale: gallery.center.abs().max_element() + gallery.half.max_element(),
        };
        let sobol = Sobol::new(16_384);
        let from = gallery.exhibit_center;
        // Behind the exhibit, beside it, at the foot of the wall, on the ceiling.
        for towards in [-gallery.z, gallery.x - gallery.z, -gallery.z - 0.3 * Vec3::Y, Vec3::Y - 0.4 * gallery.z] {
            let towards = towards.normalize();
            let one = |i| stage.radiance(from, towards, &mut sobol.sequence((5, 5), i));
            let seen = (0..16_384).map(one).sum::<Vec3>() / 16_384.0;
            let solved = gallery.radiance(towards);
            let off = (seen - solved).abs() / gallery.radiance(-gallery.z);
            assert!(off.max_element() < PATCHES, "{seen}, by radiosity {solved}");
        }
    }

    #[test]
    fn the_walls_are_painted_and_the_fields_shine_inwards() {
        let gallery = Gallery::around(&Exhibit::from_model(Default::default()));
        for of in fields(&gallery) {
            let inwards = of.half_width.cross(of.half_height);
            assert!(inwards.dot(gallery.center - of.center) > 0.0, "{of:?}");
        }
        let wall = hit(&gallery, gallery.exhibit_center, -gallery.z).expect("the wall");
        assert!(wall.normal.distance(gallery.z) < 1e-6);
        let (f, _) = wall.bsdf(gallery.z, gallery.half.y, None).value(gallery.z);
        assert!((f * PI - WALL_ALBEDO).abs().max_element() < 1e-6, "{f}");
        let outside = gallery.center + gallery.x * 3.0 * gallery.half.x;
        assert!(hit(&gallery, outside, gallery.x).is_none() && hit(&gallery, outside, gallery.z).is_none());
    }
}

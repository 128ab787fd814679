//! Radiosity of the gallery: direct light of fields and lamps, and reflections between the walls.
//!
//! A polygon of radiance L gives a face the irradiance `E = L/2 Σ γᵢ (eᵢ · n)`, γᵢ the angle an edge subtends and eᵢ
//! the normal of its plane through the receiver (Lambert 1760; Arvo 1995). Reflections are the radiosity system `B = ρ
//! (E + Σ F B)` of the faces' patches, each of one radiosity (Goral et al. 1984), so that the light of a lamp goes on from
//! where it falls. A point receives light from the patches by their exact form factors, so the wall darkens towards the
//! floor. The result is the *light map*: the irradiance of a grid of points on each face, without the direct light of the
//! lamps, whose cones and shadows are sharper.

use std::f32::consts::PI;

use glam::{Vec2, Vec3};

use super::gallery::{FACES, Face, Field, Gallery, WALL_ALBEDO, reflectance};
use super::occlusion::in_parallel;

/// Texels along each side of a light map layer; its light has no sharper edges.
pub const LIGHTMAP_SIZE: u32 = 24;
/// Patches along each side of a face: a path tracer agrees to a hundredth of the wall's light.
const PATCHES: u32 = 6;
/// Reflectance of the floor's varnish at normal incidence: of any with the index 1.5.
const VARNISH_F0: f32 = 0.04;
/// The same, mean over all directions by cosine: what its gloss takes from the boards' light.
const VARNISH_MEAN: f32 = 0.08;
/// Reflections; 0.5⁴⁰ is below a millionth of a millionth.
const REFLECTIONS: u32 = 40;
/// Points along each side of a patch whose mean direct light and reflectance it has.
const POINTS: u32 = 4;

/// A patch of a face, gallery frame.
struct Patch {
    corners: [Vec3; 4],
    center: Vec3,
    normal: Vec3,
    albedo: Vec3,
    /// Mean direct irradiance of lamps and of fields.
    of_lamps: Vec3,
    of_fields: Vec3,
}

/// Centres of `count` equal parts of −1 … 1.
fn centers(count: u32) -> impl Iterator<Item = f32> + Clone {
    (0..count).map(move |k| (2 * k + 1) as f32 / count as f32 - 1.0)
}

/// Centres of a grid of `count` by `count` parts, row by row.
fn grid(count: u32) -> impl Iterator<Item = Vec2> {
    centers(count).flat_map(move |y| centers(count).map(move |x| Vec2::new(x, y)))
}

impl Gallery {
    /// Scales the fields until the wall behind the exhibit has its ambient level, whatever the gallery's size, and
    /// solves the reflections. Light is additive, so fields and lamps are solved separately.
    pub(super) fn solve_radiosity(&mut self) {
        let w = self.exhibit_center - self.center;
        let foot = Vec3::new(w.dot(self.x), w.y, -self.half.z);
        let level = |e: Vec3| (WALL_ALBEDO / PI * e).element_sum() / 3.0;
        let patches: Vec<Patch> = FACES.iter().flat_map(|&face| self.patches(face)).collect();
        let factors: Vec<Vec<f32>> =
            patches.iter().map(|to| patches.iter().map(|from| from.factor(to.center, to.normal)).collect()).collect();
        let solve = |direct: fn(&Patch) -> Vec3| {
            let mut light = vec![Vec3::ZERO; patches.len()];
            for _ in 0..REFLECTIONS {
                let received = |row: &Vec<f32>| row.iter().zip(&light).map(|(f, b)| *b * *f).sum::<Vec3>();
                light = patches.iter().zip(&factors).map(|(p, row)| p.albedo * (direct(p) + received(row))).collect();
            }
            light
        };
        let (of_lamps, of_fields) = (solve(|patch| patch.of_lamps), solve(|patch| patch.of_fields));
        let [mirrored_lamps, mirrored_fields] = self.mirrored_irradiance(foot, Vec3::Z);
        let by_lamps = level(reflected_irradiance(&patches, &of_lamps, foot, Vec3::Z) + mirrored_lamps);
        let direct = self.direct_irradiance(foot, Vec3::Z) + mirrored_fields;
        let by_fields = level(reflected_irradiance(&patches, &of_fields, foot, Vec3::Z) + direct);
        // In a very small gallery the lamps' reflections may already suffice; a little window light always stays.
        let gain = (self.wall_ambient - by_lamps).max(0.1 * self.wall_ambient) / by_fields;
        for field in &mut self.fields {
            field.radiance *= gain;
        }
        let light: Vec<Vec3> = of_lamps.iter().zip(&of_fields).map(|(l, f)| *l + *f * gain).collect();
        let points: Vec<(Face, Vec2)> =
            FACES.iter().flat_map(|&face| grid(LIGHTMAP_SIZE).map(move |at| (face, at))).collect();
        self.lightmap = in_parallel(&points, |&(face, at)| {
            let [u, v, c] = self.face_axes(face);
            let (point, normal) = (c + u * at.x + v * at.y, -c.normalize());
            let varnish: Vec3 = self.mirrored_irradiance(point, normal).into_iter().sum();
            let direct = self.direct_irradiance(point, normal) + reflected_irradiance(&patches, &light, point, normal);
            if face == Face::Floor { direct } else { direct + varnish }
        });
    }

    /// The patches of a face, with their direct light.
    fn patches(&self, face: Face) -> impl Iterator<Item = Patch> {
        let [u, v, c] = self.face_axes(face);
        let normal = -c.normalize();
        let part = 1.0 / PATCHES as f32;
        grid(PATCHES).map(move |at| {
            let center = c + u * at.x + v * at.y;
            let (pu, pv) = (u * part, v * part);
            let mean = |of: &dyn Fn(Vec2) -> Vec3| {
                grid(POINTS).map(|within| of(at + within * part)).sum::<Vec3>() / (POINTS * POINTS) as f32
            };
            let point = |at: Vec2| c + u * at.x + v * at.y;
            let world_normal = self.to_world(normal) - self.center;
            Patch {
                corners: [center - pu - pv, center + pu - pv, center + pu + pv, center - pu + pv],
                center,
                normal,
                albedo: mean(&|at| reflectance(face, at)) * if face == Face::Floor { 1.0 - VARNISH_MEAN } else { 1.0 },
                of_lamps: mean(&|at| self.lamp_irradiance(self.to_world(point(at)), world_normal)),
                of_fields: mean(&|at| self.direct_irradiance(point(at), normal)),
            }
        })
    }

    /// Irradiance at a point of a face with its normal (gallery frame) from the fields alone.
    fn direct_irradiance(&self, point: Vec3, normal: Vec3) -> Vec3 {
        self.fields.iter().map(|field| self.field_irradiance_of(field, point, normal)).sum()
    }

    /// The same from one field.
    fn field_irradiance_of(&self, field: &Field, point: Vec3, normal: Vec3) -> Vec3 {
        let [u, v, c] = self.face_axes(field.face);
        // A face does not light itself.
        if c.dot(normal) < -0.99 * c.length() {
            return Vec3::ZERO;
        }
        let c = c + u * field.center.x + v * field.center.y;
        let (u, v) = (u * field.half.x, v * field.half.y);
        field.radiance * PI * polygon_factor(&[c - u - v, c + u - v, c + u + v, c - u + v], point, normal)
    }

    /// Irradiance at a point of a face without the direct light of the lamps, by the light map.
    fn field_irradiance(&self, face: Face, at: Vec2) -> Vec3 {
        let layer = FACES.iter().position(|of| *of == face).unwrap_or(0) * (LIGHTMAP_SIZE * LIGHTMAP_SIZE) as usize;
        let last = LIGHTMAP_SIZE as f32 - 1.0;
        let texel = ((at + 1.0) * (0.5 * LIGHTMAP_SIZE as f32) - 0.5).clamp(Vec2::ZERO, Vec2::splat(last));
        let low = texel.floor().min(Vec2::splat(last - 1.0));
        let share = texel - low;
        let of = |dx: u32, dy: u32| {
            let (x, y) = (low.x as u32 + dx, low.y as u32 + dy);
            self.lightmap[layer + (y * LIGHTMAP_SIZE + x) as usize]
        };
        of(0, 0).lerp(of(1, 0), share.x).lerp(of(0, 1).lerp(of(1, 1), share.x), share.y)
    }

    /// Irradiance at a point of a face (gallery frame) by the mirror images that lamps, and fields, have in the floor's varnish:
    /// what they send to the image of the point, by Fresnel's fraction. The light map is too coarse to show that the varnish
    /// is not quite smooth.
    fn mirrored_irradiance(&self, point: Vec3, normal: Vec3) -> [Vec3; 2] {
        let image = Vec3::new(point.x, -2.0 * self.half.y - point.y, point.z);
        let image_normal = Vec3::new(normal.x, -normal.y, normal.z);
        let reflected = |from: Vec3| {
            let slant = 1.0 - (from - image).normalize_or_zero().y.abs();
            let square = slant * slant;
            VARNISH_F0 + (1.0 - VARNISH_F0) * square * square * slant
        };
        let of_lamps = self.lamps.iter().map(|lamp| {
            let away = lamp.position - self.center;
            let from = Vec3::new(away.dot(self.x), away.y, away.dot(self.z));
            let world_normal = self.to_world(image_normal) - self.center;
            reflected(from) * lamp.irradiance(self.to_world(image), world_normal)
        });
        let of_fields = self.fields.iter().map(|field| {
            let [u, v, c] = self.face_axes(field.face);
            reflected(c + u * field.center.x + v * field.center.y)
                * self.field_irradiance_of(field, image, image_normal)
        });
        [of_lamps.sum(), of_fields.sum()]
    }

    /// Irradiance of the lamps at a world point, without shadows.
    fn lamp_irradiance(&self, point: Vec3, normal: Vec3) -> Vec3 {
        self.lamps.iter().map(|lamp| lamp.irradiance(point, normal)).sum()
    }

    /// Light map of all faces, face by face: RGB irradiance without lamps, A the radiance of a field.
    pub fn lightmap(&self) -> Vec<[f32; 4]> {
        let points = FACES.iter().flat_map(|&face| grid(LIGHTMAP_SIZE).map(move |at| (face, at)));
        let texel =
            |(e, (face, at)): (&Vec3, (Face, Vec2))| [e.x, e.y, e.z, self.glow(face, at).dot(Vec3::splat(1.0 / 3.0))];
        self.lightmap.iter().zip(points).map(texel).collect()
    }

    /// Radiance of the fields at a point of a face, with slightly soft edges.
    fn glow(&self, face: Face, at: Vec2) -> Vec3 {
        self.fields.iter().filter(|f| f.face == face).fold(Vec3::ZERO, |sum, field| {
            let inside = (field.half - (at - field.center).abs()) / 0.03;
            sum + field.radiance * inside.min_element().clamp(0.0, 1.0)
        })
    }

    /// Radiance that reaches the centre of the exhibit from a world direction (unit).
    pub fn radiance(&self, direction: Vec3) -> Vec3 {
        self.radiance_at(self.exhibit_center, direction)
    }

    /// Radiance that reaches a world point from a world direction (unit). A point outside the gallery is moved to its nearest face.
    pub fn radiance_at(&self, point: Vec3, direction: Vec3) -> Vec3 {
        let d = Vec3::new(direction.dot(self.x), direction.y, direction.dot(self.z));
        let w = point - self.center;
        let origin = Vec3::new(w.dot(self.x), w.y, w.dot(self.z)).clamp(-self.half, self.half);
        // The face through which the ray leaves the box: the nearest of the three planes ahead.
        let to = (self.half * Vec3::new(sign(d.x), sign(d.y), sign(d.z)) - origin)
            / d.map(|c| if c.abs() < 1e-9 { 1e-9 } else { c });
        let t = to.min_element();
        let hit = origin + d * t;
        let face = if t == to.x {
            if d.x > 0.0 { Face::Right } else { Face::Left }
        } else if t == to.y {
            if d.y > 0.0 { Face::Ceiling } else { Face::Floor }
        } else if d.z > 0.0 {
            Face::Back
        } else {
            Face::Wall
        };
        let [u, v, c] = self.face_axes(face);
        let at = Vec2::new((hit - c).dot(u) / u.length_squared(), (hit - c).dot(v) / v.length_squared());
        let normal = -c.normalize();
        let world_normal = self.x * normal.x + Vec3::Y * normal.y + self.z * normal.z;
        let irradiance = self.field_irradiance(face, at) + self.lamp_irradiance(self.to_world(hit), world_normal);
        reflectance(face, at) / PI * irradiance + self.glow(face, at)
    }
}

impl Patch {
    /// Form factor of the patch from a point with a normal: the fraction of the point's hemisphere that it fills, by cosine.
    fn factor(&self, point: Vec3, normal: Vec3) -> f32 {
        // A face does not light itself; normals are rounded.
        if self.normal.dot(normal) > 0.99 { 0.0 } else { polygon_factor(&self.corners, point, normal) }
    }
}

/// Irradiance at a point of a face from the patches of the other faces with these radiosities.
fn reflected_irradiance(patches: &[Patch], light: &[Vec3], point: Vec3, normal: Vec3) -> Vec3 {
    patches.iter().zip(light).map(|(patch, b)| *b * patch.factor(point, normal)).sum()
}

/// Sign that is never 0.
fn sign(x: f32) -> f32 {
    if x < 0.0 { -1.0 } else { 1.0 }
}

/// Form factor of a planar polygon seen from `point` with `normal`: (1/2π) Σ γᵢ (eᵢ · n), clipped at the horizon. The
/// winding of its outline does not matter.
pub fn polygon_factor(corners: &[Vec3], point: Vec3, normal: Vec3) -> f32 {
    // Sutherland–Hodgman clipping at the receiver's horizon; a quadrilateral gets at most five corners.
    let mut clipped = [Vec3::ZERO; 8];
    let mut count = 0;
    for (i, &corner) in corners.iter().enumerate() {
        let (a, b) = (corner - point, corners[(i + 1) % corners.len()] - point);
        let (ha, hb) = (a.dot(normal), b.dot(normal));
        if ha >= 0.0 {
            clipped[count] = a;
            count += 1;
        }
        if (ha > 0.0 && hb < 0.0) || (ha < 0.0 && hb > 0.0) {
            clipped[count] = a + (b - a) * (ha / (ha - hb));
            count += 1;
        }
    }
    let mut sum = 0.0;
    for i in 0..count {
        let (a, b) = (clipped[i], clipped[(i + 1) % count]);
        let edge = a.cross(b);
        let sine = edge.length();
        if sine > 1e-12 {
            sum += sine.atan2(a.dot(b)) * edge.dot(normal) / sine;
        }
    }
    (sum / (2.0 * PI)).abs()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_square_overhead_has_the_form_factor_of_the_handbook() {
        // Howell's catalogue B-4, element parallel to a rectangle with one corner over it, a = b = c = 1:
        // F = (1/2π) · 2 · (1/√2) atan(1/√2) = 0.1385; four of them make the square centred overhead.
        const HANDBOOK: f32 = 0.138_532;
        // Single precision and the handbook's digits.
        const TOLERANCE: f32 = 2e-6;
        let square = [
            Vec3::new(-1.0, -1.0, 1.0),
            Vec3::new(1.0, -1.0, 1.0),
            Vec3::new(1.0, 1.0, 1.0),
            Vec3::new(-1.0, 1.0, 1.0),
        ];
        let f = polygon_factor(&square, Vec3::ZERO, Vec3::Z);
        assert!((f - 4.0 * HANDBOOK).abs() < 4.0 * TOLERANCE, "{f}");
        assert_eq!(polygon_factor(&square, Vec3::ZERO, -Vec3::Z), 0.0, "below the horizon");
    }

    #[test]
    fn the_wall_behind_the_work_has_its_level_and_looks_so_from_the_work() {
        // The light map is interpolated between its texels.
        const TOLERANCE: f32 = 3e-3;
        let gallery = Gallery::around(&soffio_exhibit::Exhibit::from_model(Default::default()));
        let w = gallery.exhibit_center - gallery.center;
        let level = |y: f32| {
            let e = gallery.field_irradiance(Face::Wall, Vec2::new(w.dot(gallery.x), y) / gallery.half.truncate());
            (WALL_ALBEDO / PI * e).element_sum() / 3.0
        };
        assert!((level(w.y) / gallery.wall_ambient - 1.0).abs() < TOLERANCE, "{}", level(w.y));
        // The view from the exhibit straight at that point shows the same radiance.
        let seen = gallery.radiance(-gallery.z);
        let lamps =
            gallery.lamp_irradiance(gallery.to_world(Vec3::new(w.dot(gallery.x), w.y, -gallery.half.z)), gallery.z);
        let expected = level(w.y) + (WALL_ALBEDO / PI * lamps).element_sum() / 3.0;
        assert!((seen.element_sum() / 3.0 - expected).abs() < TOLERANCE, "{seen} {expected}");
    }

    #[test]
    fn the_patches_of_an_enclosure_fill_the_hemisphere() {
        // Single precision over a few hundred terms.
        const TOLERANCE: f32 = 1e-3;
        let gallery = Gallery::around(&soffio_exhibit::Exhibit::from_model(Default::default()));
        let patches: Vec<Patch> = FACES.iter().flat_map(|&face| gallery.patches(face)).collect();
        for Patch { center, normal, .. } in &patches {
            let sum: f32 = patches.iter().map(|patch| patch.factor(*center, *normal)).sum();
            assert!((sum - 1.0).abs() < TOLERANCE, "{center} {sum}");
        }
    }
}

//! Radiosity of the gallery: direct light of fields and lamps, and reflections between the walls.
//!
//! A polygon of radiance L gives a face the irradiance `E = L/2 Σ γᵢ (eᵢ · n)`, γᵢ the angle an edge subtends and eᵢ
//! the normal of its plane through the receiver (Lambert 1760; Arvo 1995). Reflections are the radiosity system `B = ρ
//! (E + Σ F B)` of the six faces, each of one mean radiosity (Goral et al. 1984). A point receives light from the faces
//! by their exact form factors, so the wall darkens towards the floor.

use std::f32::consts::PI;

use glam::{Vec2, Vec3};

use super::gallery::{FACES, Face, Gallery, PANELS, WALL_ALBEDO, WALL_AMBIENT, reflectance};

/// Texels along each side of a light map layer; its light has no sharper edges.
pub const LIGHTMAP_SIZE: u32 = 32;

impl Gallery {
    /// Scales the fields until the wall behind the exhibit has its ambient level, whatever the gallery's size, and
    /// solves the reflections. Light is additive, so fields and lamps are solved separately.
    pub(super) fn solve_radiosity(&mut self) {
        let w = self.exhibit_center - self.center;
        let foot = Vec3::new(w.dot(self.x), w.y, -self.half.z);
        let level = |e: Vec3| (WALL_ALBEDO / PI * e).element_sum() / 3.0;
        let of_lamps = self.solve(|gallery, point, normal| {
            let world_normal = gallery.to_world(normal) - gallery.center;
            gallery.lamp_irradiance(gallery.to_world(point), world_normal)
        });
        let of_fields = self.solve(Self::direct_irradiance);
        let by_lamps = level(self.reflected_irradiance(&of_lamps, foot, Vec3::Z));
        let by_fields =
            level(self.reflected_irradiance(&of_fields, foot, Vec3::Z) + self.direct_irradiance(foot, Vec3::Z));
        // In a very small gallery the lamps' reflections may already suffice; a little window light always stays.
        let gain = ((WALL_AMBIENT - by_lamps) / by_fields).max(0.1 * WALL_AMBIENT / by_fields);
        for field in &mut self.fields {
            field.radiance *= gain;
        }
        self.radiosity = std::array::from_fn(|i| of_lamps[i] + of_fields[i] * gain);
    }

    /// Radiosities of the six faces under a direct light, by Jacobi iteration to single precision.
    fn solve(&self, direct: impl Fn(&Self, Vec3, Vec3) -> Vec3) -> [Vec3; 6] {
        // Mean direct irradiance over a few points of each face.
        let steps = [-0.75, -0.25, 0.25, 0.75];
        let direct = FACES.map(|face| {
            let [u, v, c] = self.face_axes(face);
            let normal = -c.normalize();
            let points = steps.iter().flat_map(|&a| steps.iter().map(move |&b| c + u * a + v * b));
            points.map(|point| direct(self, point, normal)).sum::<Vec3>() / 16.0
        });
        let albedo = FACES.map(mean_albedo);
        let mut radiosity = [Vec3::ZERO; 6];
        // Each iteration adds one reflection; 0.8⁶⁰ is below a millionth.
        for _ in 0..60 {
            radiosity = std::array::from_fn(|i| {
                let [_, _, c] = self.face_axes(FACES[i]);
                albedo[i] * (direct[i] + self.reflected_irradiance(&radiosity, c, -c.normalize()))
            });
        }
        radiosity
    }

    /// Irradiance at a point of a face from the other faces.
    fn reflected_irradiance(&self, radiosity: &[Vec3; 6], point: Vec3, normal: Vec3) -> Vec3 {
        FACES.iter().zip(radiosity).fold(Vec3::ZERO, |sum, (&face, &b)| {
            let [u, v, c] = self.face_axes(face);
            if c.dot(normal) < -0.99 * c.length() {
                return sum;
            }
            sum + b * polygon_factor(&[c - u - v, c + u - v, c + u + v, c - u + v], point, normal)
        })
    }

    /// Irradiance at a point of a face with its normal (gallery frame) from the fields alone.
    fn direct_irradiance(&self, point: Vec3, normal: Vec3) -> Vec3 {
        self.fields.iter().fold(Vec3::ZERO, |sum, field| {
            let [u, v, c] = self.face_axes(field.face);
            if c.dot(normal) < -0.99 * c.length() {
                return sum;
            }
            let c = c + u * field.center.x + v * field.center.y;
            let (u, v) = (u * field.half.x, v * field.half.y);
            let corners = [c - u - v, c + u - v, c + u + v, c - u + v];
            sum + field.radiance * PI * polygon_factor(&corners, point, normal)
        })
    }

    /// Irradiance at a point of a face without the direct light of the lamps.
    fn field_irradiance(&self, point: Vec3, normal: Vec3) -> Vec3 {
        self.direct_irradiance(point, normal) + self.reflected_irradiance(&self.radiosity, point, normal)
    }

    /// Irradiance of the lamps at a world point, without shadows.
    fn lamp_irradiance(&self, point: Vec3, normal: Vec3) -> Vec3 {
        self.lamps.iter().map(|lamp| lamp.irradiance(point, normal)).sum()
    }

    /// Light map of all faces, face by face: RGB irradiance without lamps, A the radiance of a field.
    pub fn lightmap(&self) -> Vec<[f32; 4]> {
        let n = LIGHTMAP_SIZE;
        let mut texels = Vec::with_capacity((6 * n * n) as usize);
        for face in FACES {
            let [u, v, c] = self.face_axes(face);
            let normal = -c.normalize();
            for row in 0..n {
                for column in 0..n {
                    let at = Vec2::new(column as f32 + 0.5, row as f32 + 0.5) * (2.0 / n as f32) - 1.0;
                    let e = self.field_irradiance(c + u * at.x + v * at.y, normal);
                    texels.push([e.x, e.y, e.z, self.glow(face, at).dot(Vec3::splat(1.0 / 3.0))]);
                }
            }
        }
        texels
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
        let d = Vec3::new(direction.dot(self.x), direction.y, direction.dot(self.z));
        let w = self.exhibit_center - self.center;
        let origin = Vec3::new(w.dot(self.x), w.y, w.dot(self.z));
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
        let irradiance = self.field_irradiance(hit, normal) + self.lamp_irradiance(self.to_world(hit), world_normal);
        reflectance(face, at) / PI * irradiance + self.glow(face, at)
    }
}

/// Mean reflectance of a face with its panels.
fn mean_albedo(face: Face) -> Vec3 {
    /// Points along each side: a panel's edges then fall between them by a hundredth of the face.
    const STEPS: u32 = 50;
    if !PANELS.iter().any(|panel| panel.face == face) {
        return reflectance(face, Vec2::ZERO);
    }
    let at = |k: u32| (k as f32 + 0.5) * 2.0 / STEPS as f32 - 1.0;
    let points = (0..STEPS * STEPS).map(|k| Vec2::new(at(k % STEPS), at(k / STEPS)));
    points.map(|point| reflectance(face, point)).sum::<Vec3>() / (STEPS * STEPS) as f32
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
    fn the_wall_behind_the_work_has_its_level_and_darkens_towards_the_floor() {
        // Single precision over a few hundred terms.
        const TOLERANCE: f32 = 1e-3;
        let gallery = Gallery::around(&soffio_exhibit::Exhibit::from_model(Default::default()));
        let w = gallery.exhibit_center - gallery.center;
        let level = |y: f32| {
            let e = gallery.field_irradiance(Vec3::new(w.dot(gallery.x), y, -gallery.half.z), Vec3::Z);
            (WALL_ALBEDO / PI * e).element_sum() / 3.0
        };
        assert!((level(w.y) / WALL_AMBIENT - 1.0).abs() < TOLERANCE, "{}", level(w.y));
        assert!(level(-gallery.half.y * 0.99) < level(w.y), "the floor is darker than the walls");
        // The view from the exhibit straight at that point shows the same radiance.
        let seen = gallery.radiance(-gallery.z);
        let lamps =
            gallery.lamp_irradiance(gallery.to_world(Vec3::new(w.dot(gallery.x), w.y, -gallery.half.z)), gallery.z);
        let expected = level(w.y) + (WALL_ALBEDO / PI * lamps).element_sum() / 3.0;
        assert!((seen.element_sum() / 3.0 - expected).abs() < TOLERANCE, "{seen} {expected}");
    }

    #[test]
    fn an_enclosure_of_one_grey_is_an_integrating_sphere() {
        // E = 1 on all faces, one albedo: B = ρ / (1 − ρ) exactly where form factors sum to one.
        const TOLERANCE: f32 = 1e-3;
        let gallery = Gallery::around(&soffio_exhibit::Exhibit::from_model(Default::default()));
        for face in FACES {
            let [_, _, c] = gallery.face_axes(face);
            let sum = gallery.reflected_irradiance(&[Vec3::ONE; 6], c, -c.normalize());
            assert!((sum.x - 1.0).abs() < TOLERANCE, "{face:?} {sum}");
        }
    }
}

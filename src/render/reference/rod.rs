//! A segment of a wire as a solid: a cylinder, with half a sphere where the wire goes on and a disc where it ends.
//!
//! Let m be the ray's origin relative to an end, d its direction, and ⊥ mark the part across the axis. The ray passes the
//! axis at t₀ = −m⊥·d⊥ / d⊥², at the distance p = |m⊥ + t₀ d⊥|. It crosses the cylinder of radius r at
//!
//! ```text
//! t = t₀ ± √((r² − p²) / d⊥²)
//! ```
//!
//! Written this way a wire of a quarter of a millimetre keeps its shape at metres. The distance to the nearest point
//! comes first, so no large squares are subtracted. A sphere is found likewise.

use glam::Vec3;
use obvhs::Boundable;
use obvhs::aabb::Aabb;

use super::super::wires::Segment;

/// A segment of a wire.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rod {
    a: Vec3,
    /// Unit direction from `a` to the other end.
    axis: Vec3,
    /// m.
    length: f32,
    /// m.
    radius: f32,
    /// Does the wire go on at `a` and at the other end?
    goes_on: [bool; 2],
    /// Linear RGB.
    pub color: Vec3,
    /// 0 or 1.
    pub metallic: f32,
    /// Perceptual, as in the file.
    pub roughness: f32,
}

impl Rod {
    /// The solid of a segment; `None` where it has no length.
    pub fn new(segment: &Segment) -> Option<Self> {
        let (a, b) = (segment.a.truncate(), segment.b.truncate());
        let axis = (b - a).try_normalize()?;
        Some(Self {
            a,
            axis,
            length: (b - a).length(),
            radius: segment.a.w,
            goes_on: [segment.cut_a.w < 0.5, segment.cut_b.w < 0.5],
            color: segment.color.truncate(),
            metallic: segment.b.w,
            roughness: segment.color.w,
        })
    }

    /// Distance in `near` … `far` at which a ray first crosses its surface, and the outward unit normal there.
    pub fn hit(&self, origin: Vec3, direction: Vec3, near: f32, far: f32) -> Option<(f32, Vec3)> {
        let m = origin - self.a;
        let (ma, da) = (m.dot(self.axis), direction.dot(self.axis));
        let (across, along) = (m - self.axis * ma, direction - self.axis * da);
        let mut nearest = far;
        let mut normal = None;
        let mut meet = |t: f32, n: Vec3| {
            if t > near && t < nearest {
                (nearest, normal) = (t, Some(n));
            }
        };
        let d2 = along.length_squared();
        if d2 > 1e-12 {
            let t0 = -across.dot(along) / d2;
            let h = self.radius * self.radius - (across + t0 * along).length_squared();
            if h < 0.0 {
                // Spheres and discs are no wider than the cylinder.
                return None;
            }
            let half = (h / d2).sqrt();
            for t in [t0 - half, t0 + half] {
                if (0.0..=self.length).contains(&(ma + t * da)) {
                    meet(t, (across + t * along) / self.radius);
                }
            }
        } else if across.length_squared() > self.radius * self.radius {
            return None;
        }
        for (end, side) in [(0.0, -1.0), (self.length, 1.0)] {
            if self.goes_on[(side > 0.0) as usize] {
                let c = m - self.axis * end;
                let t0 = -c.dot(direction);
                let h = self.radius * self.radius - (c + t0 * direction).length_squared();
                if h >= 0.0 {
                    for t in [t0 - h.sqrt(), t0 + h.sqrt()] {
                        let out = c + t * direction;
                        if side * out.dot(self.axis) > 0.0 {
                            meet(t, out / self.radius);
                        }
                    }
                }
            } else if da.abs() > 1e-9 {
                let t = (end - ma) / da;
                if (across + t * along).length_squared() <= self.radius * self.radius {
                    meet(t, side * self.axis);
                }
            }
        }
        normal.map(|n| (nearest, n))
    }
}

impl Boundable for Rod {
    fn aabb(&self) -> Aabb {
        let b = self.a + self.axis * self.length;
        Aabb::new((self.a.min(b) - self.radius).into(), (self.a.max(b) + self.radius).into())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Single precision of distances about one.
    const ROUNDING: f32 = 2e-6;

    fn rod(goes_on: [bool; 2]) -> Rod {
        Rod {
            a: Vec3::new(0.0, -1.0, 0.0),
            axis: Vec3::Y,
            length: 2.0,
            radius: 0.25,
            goes_on,
            color: Vec3::ONE,
            metallic: 0.0,
            roughness: 0.5,
        }
    }

    #[test]
    fn a_ray_across_enters_at_the_chord_and_leaves_at_its_other_end() {
        let (origin, far) = (Vec3::new(0.15, 0.3, 3.0), f32::INFINITY);
        // The chord at 0.15 of a circle of 0.25 is 2 × 0.2 long.
        let (t, n) = rod([false; 2]).hit(origin, Vec3::NEG_Z, 0.0, far).expect("a hit");
        assert!((t - 2.8).abs() < ROUNDING && n.distance(Vec3::new(0.6, 0.0, 0.8)) < ROUNDING, "{t} {n}");
        let (t, n) = rod([false; 2]).hit(origin, Vec3::NEG_Z, 2.9, far).expect("the far side");
        assert!((t - 3.2).abs() < ROUNDING && n.distance(Vec3::new(0.6, 0.0, -0.8)) < ROUNDING, "{t} {n}");
        assert!(rod([false; 2]).hit(origin, Vec3::NEG_Z, 0.0, 2.7).is_none(), "it is farther");
        assert!(rod([false; 2]).hit(origin + 0.2 * Vec3::X, Vec3::NEG_Z, 0.0, far).is_none(), "beside it");
    }

    #[test]
    fn a_ray_along_the_axis_meets_the_disc_or_the_sphere() {
        let from = Vec3::new(0.15, 4.0, 0.0);
        let (t, n) = rod([true, false]).hit(from, Vec3::NEG_Y, 0.0, f32::INFINITY).expect("the disc");
        assert!((t - 3.0).abs() < ROUNDING && n == Vec3::Y, "{t} {n}");
        let (t, n) = rod([false, true]).hit(from, Vec3::NEG_Y, 0.0, f32::INFINITY).expect("the sphere");
        assert!((t - 2.8).abs() < ROUNDING && n.distance(Vec3::new(0.6, 0.8, 0.0)) < ROUNDING, "{t} {n}");
    }

    #[test]
    fn a_slanting_ray_agrees_with_the_quadratic_equation_and_a_thin_wire_is_found_from_afar() {
        let (origin, direction) = (Vec3::new(1.0, -2.0, 1.5), Vec3::new(-0.4, 0.7, -0.62).normalize());
        let (t, _) = rod([true; 2]).hit(origin, direction, 0.0, f32::INFINITY).expect("a hit");
        // (ox + t dx)² + (oz + t dz)² = r².
        let [ox, oz, dx, dz] = [origin.x, origin.z, direction.x, direction.z].map(f64::from);
        let (a, b, c) = (dx * dx + dz * dz, ox * dx + oz * dz, ox * ox + oz * oz - 0.0625);
        let exact = (-b - (b * b - a * c).sqrt()) / a;
        assert!((f64::from(t) - exact).abs() < f64::from(4.0 * ROUNDING), "{t} {exact}");
        let thin = Rod { radius: 2.5e-4, ..rod([false; 2]) };
        // From 8 m, at half its radius: a chord of √3/2 radii.
        let (t, n) = thin.hit(Vec3::new(1.25e-4, 0.1, 8.0), Vec3::NEG_Z, 0.0, f32::INFINITY).expect("the wire");
        assert!((t - (8.0 - 2.165e-4)).abs() < ROUNDING && (n.x - 0.5).abs() < 1e-3, "{t} {n}");
    }
}

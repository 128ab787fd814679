//! Mass, first and second moments of solids, sheets and wires by one formula.
//!
//! A k-simplex with corners `v₀ … v_k` and content `V` (length, area or volume) has
//!
//! ```text
//! ∫ dV    = V
//! ∫ x dV  = V · s/(k+1)                          s = Σ vᵢ
//! ∫ xxᵀdV = V · (Σ vᵢvᵢᵀ + ssᵀ) / ((k+1)(k+2))
//! ```
//!
//! (barycentric moments: `E[λᵢλⱼ] = (1+δᵢⱼ)/((k+1)(k+2))`). A wire is a sum of segments (k = 1), an open sheet of
//! triangles (k = 2). A closed mesh is a signed sum of tetrahedra that share one apex (k = 3): by the divergence
//! theorem the region outside cancels, so any apex gives the volume integral. It is the same polynomial as in
//! Mirtich, "Fast and Accurate Computation of Polyhedral Mass Properties" (1996), and Eberly, "Polyhedral Mass
//! Properties" (2002), in a form that needs no projection and serves the lower dimensions too.
//!
//! The inertia tensor follows from the second moment about the centre: `I = tr(C)·1 − C`.

use soffio_math::{DMat3, DVec3, outer};

/// Zeroth to second moments of a mass distribution about the origin of its frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moments {
    /// ∫ dm, kg (or m³ where the density is 1).
    pub mass: f64,
    /// ∫ x dm, kg m.
    pub first: DVec3,
    /// ∫ x xᵀ dm, kg m².
    pub second: DMat3,
}

impl Default for Moments {
    /// Nothing. (Written out: the default matrix of glam is the identity.)
    fn default() -> Self {
        Self { mass: 0.0, first: DVec3::ZERO, second: DMat3::ZERO }
    }
}

impl Moments {
    /// Adds a simplex of the mass `mass` (may be negative: a signed tetrahedron) spread evenly over it.
    pub fn add_simplex<const CORNERS: usize>(&mut self, corners: [DVec3; CORNERS], mass: f64) {
        let n = CORNERS as f64;
        let sum: DVec3 = corners.iter().sum();
        let squares = corners.iter().fold(outer(sum, sum), |total, &v| total + outer(v, v));
        self.mass += mass;
        self.first += sum * (mass / n);
        self.second += squares * (mass / (n * (n + 1.0)));
    }

    /// Adds the closed mesh of `triangles` (outward counter-clockwise) filled with `density` kg/m³.
    pub fn add_solid(&mut self, triangles: impl Iterator<Item = [DVec3; 3]>, density: f64) {
        // A corner of the mesh as the apex keeps the tetrahedra small, and so the cancellation.
        let mut apex = None;
        for [a, b, c] in triangles {
            let o = *apex.get_or_insert(a);
            let volume = (a - o).dot((b - o).cross(c - o)) / 6.0;
            self.add_simplex([o, a, b, c], volume * density);
        }
    }

    /// Adds a sheet of `thickness` (m) around `triangles`, of `density` kg/m³.
    pub fn add_sheet(&mut self, triangles: impl Iterator<Item = [DVec3; 3]>, thickness: f64, density: f64) {
        for [a, b, c] in triangles {
            let normal = (b - a).cross(c - a);
            let Some(unit) = normal.try_normalize() else { continue };
            let mass = 0.5 * normal.length() * thickness * density;
            self.add_simplex([a, b, c], mass);
            // The sheet's own depth: ∫ z² dz over ±t/2 is t²/12 per mass.
            self.second += outer(unit, unit) * (mass * thickness * thickness / 12.0);
        }
    }

    /// Adds a round wire of `radius` (m) along `points`, of `density` kg/m³.
    pub fn add_wire(&mut self, points: &[DVec3], radius: f64, density: f64) {
        for pair in points.windows(2) {
            let along = pair[1] - pair[0];
            let Some(unit) = along.try_normalize() else { continue };
            let mass = along.length() * soffio_math::PI * radius * radius * density;
            self.add_simplex([pair[0], pair[1]], mass);
            // The round section: ∫ x² dA over the disc is r²/4 per mass, in both directions across.
            let across = DMat3::IDENTITY - outer(unit, unit);
            self.second += across * (mass * radius * radius / 4.0);
        }
    }

    /// Adds another distribution given in the same frame.
    pub fn add(&mut self, other: &Self) {
        self.mass += other.mass;
        self.first += other.first;
        self.second += other.second;
    }

    /// Centre of mass, m. Zero mass has none: the origin.
    pub fn center(&self) -> DVec3 {
        if self.mass == 0.0 { DVec3::ZERO } else { self.first / self.mass }
    }

    /// Inertia tensor about the centre of mass, kg m².
    pub fn inertia(&self) -> DMat3 {
        let c = self.center();
        let about_center = self.second - outer(c, c) * self.mass;
        let trace = about_center.x_axis.x + about_center.y_axis.y + about_center.z_axis.z;
        DMat3::from_diagonal(DVec3::splat(trace)) - about_center
    }
}

/// Eigenvalues (ascending) and unit eigenvectors (columns, right-handed) of a symmetric matrix, by Jacobi rotations
/// (Golub and Van Loan, Matrix Computations, section 8.5). Converges quadratically; needs no transcendentals.
pub fn principal_axes(matrix: DMat3) -> (DVec3, DMat3) {
    const SWEEPS: usize = 30;
    let mut a = matrix.to_cols_array_2d();
    let mut v = DMat3::IDENTITY.to_cols_array_2d();
    for _ in 0..SWEEPS {
        let off = a[0][1].abs() + a[0][2].abs() + a[1][2].abs();
        let scale = a[0][0].abs() + a[1][1].abs() + a[2][2].abs();
        if off <= f64::EPSILON * 1e-3 * scale {
            break;
        }
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            if a[p][q] == 0.0 {
                continue;
            }
            // The smaller root of t² + 2θt − 1 = 0 is the tangent of the angle that zeroes a[p][q].
            let theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
            let t = theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt());
            let c = 1.0 / (t * t + 1.0).sqrt();
            let s = t * c;
            for k in 0..3 {
                let (kp, kq) = (a[k][p], a[k][q]);
                a[k][p] = c * kp - s * kq;
                a[k][q] = s * kp + c * kq;
            }
            for k in 0..3 {
                let (pk, qk) = (a[p][k], a[q][k]);
                a[p][k] = c * pk - s * qk;
                a[q][k] = s * pk + c * qk;
                let (vp, vq) = (v[p][k], v[q][k]);
                v[p][k] = c * vp - s * vq;
                v[q][k] = s * vp + c * vq;
            }
        }
    }
    let mut order = [0, 1, 2];
    order.sort_by(|&i, &j| a[i][i].total_cmp(&a[j][j]));
    let values = DVec3::new(a[order[0]][order[0]], a[order[1]][order[1]], a[order[2]][order[2]]);
    let (x, y) = (DVec3::from(v[order[0]]), DVec3::from(v[order[1]]));
    (values, DMat3::from_cols(x, y, x.cross(y)))
}

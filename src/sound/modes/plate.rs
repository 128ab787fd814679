//! Vibration modes of a free thin plate: their frequencies, and their shapes, so that the place of a hit is heard.
//!
//! Rayleigh-Ritz (Leissa, "Vibration of Plates", NASA SP-160, 1969): among all w(x, y) = Σ c_i f_i(x, y) the modes make
//! the ratio of bending to kinetic energy stationary. With free edges every boundary condition is natural, so
//! the f_i may be any complete set; here products of Legendre polynomials f = P_m(x/a) P_n(y/b), m + n ≤ [`DEGREE`].
//!
//! ```text
//! K_ij = D ∫∫ f_i,xx f_j,xx + f_i,yy f_j,yy + ν (f_i,xx f_j,yy + f_i,yy f_j,xx) + 2 (1 − ν) f_i,xy f_j,xy dA
//! M_ij = μ ∫∫ f_i f_j dA          K c = ω² M c
//! D = E h³ / (12 (1 − ν²)) N m    μ = mass / area kg/m²
//! ```
//!
//! The outline is the superellipse |x/a|^p + |y/b|^p = 1 with the body's own area: p = 2 is an ellipse, p → ∞ a
//! rectangle. It is symmetric, so the modes fall into four classes by parity, each solved alone over one quadrant.
//! Ritz frequencies are upper bounds; the lower half of each class is accurate (a test compares with published
//! tables), the upper half is thrown away.

use fearless_simd::{Level, dispatch};

use super::eigen::{Matrix, generalised};
use crate::{SoundBody, SoundMaterial};
use soffio_math::{PI, cos, pow};

/// Largest total degree of the Ritz polynomials: the kept half of the modes is then accurate (a test compares with
/// published tables).
pub const DEGREE: usize = 18;

/// Values of the polynomials P_0 … P_DEGREE at one coordinate.
pub(super) type Legendre = [f64; DEGREE + 1];

/// One mode of vibration.
#[derive(Clone, Debug)]
pub struct PlateMode {
    /// Frequency, Hz.
    pub frequency: f64,
    /// Parity of the shape in x and in y: 0 even, 1 odd.
    pub parity: [usize; 2],
    /// Factors of P_m(x) P_n(y) in the order of [`terms`].
    coefficients: Vec<f64>,
}

impl PlateMode {
    /// Mass-normalised displacement at a place, 1/√kg, from the Legendre values of its two coordinates (−1…1).
    pub(super) fn shape(&self, x: &Legendre, y: &Legendre) -> f64 {
        let mut sum = 0.0;
        let mut rest = self.coefficients.as_slice();
        let [px, py] = self.parity;
        // The order of `terms`, without its iterators: this is read for each partial while a contact moves.
        for d in (px + py..=DEGREE).step_by(2) {
            let (here, later) = rest.split_at(((d - px - py) / 2 + 1).min(rest.len()));
            for (k, c) in here.iter().enumerate() {
                let m = px + 2 * k;
                sum += c * x[m] * y[d - m];
            }
            rest = later;
        }
        sum
    }
}

/// Degrees (m, n) of the basis of one parity class, simple ones first.
fn terms(parity: [usize; 2]) -> impl Iterator<Item = (usize, usize)> {
    let [px, py] = parity;
    (px + py..=DEGREE).step_by(2).flat_map(move |d| (px..=d - py).step_by(2).map(move |m| (m, d - m)))
}

/// The modes of a free plate in ascending order of frequency, rigid motions left out.
/// Empty when a number is not positive and finite.
pub fn free_plate_modes(body: &SoundBody, material: &SoundMaterial) -> Vec<PlateMode> {
    let [a, b] = body.half_extents;
    let (h, nu) = (body.thickness, material.poisson);
    let numbers = [a, b, h, body.area, body.mass, material.youngs_modulus];
    let possible = numbers.iter().all(|v| v.is_finite() && *v > 0.0) && nu > -1.0 && nu <= 0.5;
    if !possible {
        return Vec::new();
    }
    let rigidity = material.youngs_modulus * h * h * h / (12.0 * (1.0 - nu * nu));
    let quadrature = Quadrature::new(outline_exponent(body));
    // The quadrature knows the outline's area only to its own rounding; the mass is the body's.
    let mass_per_weight = body.mass / (4.0 * quadrature.points.iter().map(|p| p.weight).sum::<f64>());
    let stiffness_per_weight = rigidity * a * b;
    let mut modes = Vec::new();
    for parity in [[0, 0], [1, 0], [0, 1], [1, 1]] {
        let basis: Vec<(usize, usize)> = terms(parity).collect();
        let per_weight = PerWeight { stiffness: stiffness_per_weight, mass: mass_per_weight };
        // The same sums in the same order, whatever the instructions.
        let RitzMatrices { k, m } =
            dispatch!(Level::new(), _simd => matrices(&quadrature, &basis, [a, b], nu, per_weight));
        // Rigid motions: 1, x and y are the lowest of their classes; xy bends.
        let rigid = usize::from(parity != [1, 1]);
        let solved = generalised(&k, &m);
        let keep = solved.len() / 2;
        modes.extend(solved.into_iter().skip(rigid).take(keep).map(|(omega2, coefficients)| PlateMode {
            frequency: omega2.max(0.0).sqrt() / (2.0 * PI),
            parity,
            coefficients,
        }));
    }
    modes.sort_by(|a, b| a.frequency.total_cmp(&b.frequency));
    modes
}

/// What a weight of the quadrature stands for.
#[derive(Clone, Copy)]
struct PerWeight {
    /// D a b, N m³.
    stiffness: f64,
    /// Mass, kg.
    mass: f64,
}

/// The matrices of K c = ω² M c, of which only the lower triangles are filled.
struct RitzMatrices {
    /// Stiffness, N/m.
    k: Matrix,
    /// Mass, kg.
    m: Matrix,
}

/// K and M of a basis of degrees (m, n) on a plate with half extents a and b, m, and Poisson's ratio ν.
#[inline(always)]
fn matrices(
    quadrature: &Quadrature,
    basis: &[(usize, usize)],
    [a, b]: [f64; 2],
    nu: f64,
    per_weight: PerWeight,
) -> RitzMatrices {
    let n = basis.len();
    let (mut k, mut m) = (Matrix::zero(n), Matrix::zero(n));
    // Of each basis function: w, w,xx, w,yy, w,xy.
    let [mut w, mut xx, mut yy, mut xy] = [(); 4].map(|()| vec![0.0; n]);
    for point in &quadrature.points {
        let (x, y) = (derivatives(point.x), derivatives(point.y));
        for (at, &(i, j)) in basis.iter().enumerate() {
            w[at] = x[0][i] * y[0][j];
            xx[at] = x[2][i] * y[0][j] / (a * a);
            yy[at] = x[0][i] * y[2][j] / (b * b);
            xy[at] = x[1][i] * y[1][j] / (a * b);
        }
        let (wk, wm) = (4.0 * point.weight * per_weight.stiffness, 4.0 * point.weight * per_weight.mass);
        for i in 0..n {
            let by_xx = wk * (xx[i] + nu * yy[i]);
            let by_yy = wk * (yy[i] + nu * xx[i]);
            let by_xy = wk * 2.0 * (1.0 - nu) * xy[i];
            let by_w = wm * w[i];
            let (k, m) = (&mut k.row_mut(i)[..=i], &mut m.row_mut(i)[..=i]);
            let (w, xx, yy, xy) = (&w[..=i], &xx[..=i], &yy[..=i], &xy[..=i]);
            for j in 0..k.len() {
                k[j] += by_xx * xx[j] + by_yy * yy[j] + by_xy * xy[j];
                m[j] += by_w * w[j];
            }
        }
    }
    RitzMatrices { k, m }
}

/// A place (−1…1 each) outside of the outline of exponent `p`, pulled straight towards the centre onto the rim: shapes
/// mean nothing out there, and polynomials grow without bound.
pub(super) fn onto_plate(p: f64, [x, y]: [f64; 2]) -> [f64; 2] {
    let beyond = if p.is_finite() { pow(x.abs(), p) + pow(y.abs(), p) } else { 0.0 };
    if beyond <= 1.0 {
        return [x, y];
    }
    let scale = pow(beyond, -1.0 / p);
    [x * scale, y * scale]
}

/// The exponent p whose superellipse has the body's area; at least 1 (a rhombus), ∞ where 99.5 % of the bounding
/// rectangle are filled.
///
/// Area / 4ab = Γ(1 + 1/p)² / Γ(1 + 2/p), increasing in p: bisection in 1/p.
pub(super) fn outline_exponent(body: &SoundBody) -> f64 {
    let fill = body.area / (4.0 * body.half_extents[0] * body.half_extents[1]);
    let fill_of = |inverse: f64| {
        let g = libm::tgamma(1.0 + inverse);
        g * g / libm::tgamma(1.0 + 2.0 * inverse)
    };
    let (mut low, mut high) = (0.0, 1.0);
    if fill >= 0.995 {
        return f64::INFINITY;
    }
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if fill_of(middle) > fill { low = middle } else { high = middle }
    }
    1.0 / high
}

/// A point of the quadrant with its weight.
struct Point {
    x: f64,
    y: f64,
    weight: f64,
}

/// Integration over the first quadrant of |x|^p + |y|^p ≤ 1.
struct Quadrature {
    points: Vec<Point>,
}

impl Quadrature {
    /// Gauss-Legendre in y up to the rim; in x through x = 1 − (1 − t)², which makes the rim of an ellipse smooth.
    fn new(p: f64) -> Self {
        let (columns, rows) = (gauss_legendre(2 * DEGREE + 2), gauss_legendre(DEGREE + 2));
        let mut points = Vec::with_capacity(columns.len() * rows.len());
        for &(t, wt) in &columns {
            let x = 1.0 - (1.0 - t) * (1.0 - t);
            let rim = if p.is_finite() { pow(1.0 - pow(x, p), 1.0 / p) } else { 1.0 };
            for &(s, ws) in &rows {
                points.push(Point { x, y: s * rim, weight: wt * 2.0 * (1.0 - t) * ws * rim });
            }
        }
        Self { points }
    }
}

/// Nodes and weights on [0, 1], exact for polynomials of degree 2n − 1 (Newton's method on P_n).
fn gauss_legendre(n: usize) -> Vec<(f64, f64)> {
    let value_and_slope = |x: f64| {
        let (mut before, mut value) = (1.0, x);
        for k in 1..n {
            let k = k as f64;
            (before, value) = (value, ((2.0 * k + 1.0) * x * value - k * before) / (k + 1.0));
        }
        (value, n as f64 * (x * value - before) / (x * x - 1.0))
    };
    (0..n)
        .map(|i| {
            let mut x = cos(PI * (i as f64 + 0.75) / (n as f64 + 0.5));
            for _ in 0..8 {
                let (value, slope) = value_and_slope(x);
                x -= value / slope;
            }
            let slope = value_and_slope(x).1;
            (0.5 * (x + 1.0), 1.0 / ((1.0 - x * x) * slope * slope))
        })
        .collect()
}

/// P_0 … P_DEGREE at `x`: (k + 1) P_{k+1} = (2k + 1) x P_k − k P_{k−1}.
pub(super) fn legendre(x: f64) -> Legendre {
    let mut p = [1.0; DEGREE + 1];
    p[1] = x;
    for k in 1..DEGREE {
        let kf = k as f64;
        p[k + 1] = ((2.0 * kf + 1.0) * x * p[k] - kf * p[k - 1]) / (kf + 1.0);
    }
    p
}

/// Values, slopes and second derivatives: P'_{k+1} = P'_{k−1} + (2k + 1) P_k, and its derivative.
fn derivatives(x: f64) -> [Legendre; 3] {
    let p = legendre(x);
    let (mut d, mut dd) = ([0.0; DEGREE + 1], [0.0; DEGREE + 1]);
    d[1] = 1.0;
    for k in 1..DEGREE {
        let factor = 2.0 * k as f64 + 1.0;
        d[k + 1] = d[k - 1] + factor * p[k];
        dd[k + 1] = dd[k - 1] + factor * d[k];
    }
    [p, d, dd]
}

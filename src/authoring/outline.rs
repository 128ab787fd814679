//! Cardinal splines: closed outlines in the plane, wires in space.
//!
//! Both are drawn as cardinal splines (Catmull and Rom, "A class of local interpolating splines", 1974): the curve
//! passes through every point given, and its tangent there is half the chord of the two neighbours. A *corner* has
//! no common tangent: each side leaves it along its own chord.
//!
//! Units are those of the points; the callers use metres and millimetres.

use soffio_math::{DVec2, DVec3, PI, cos, sin};

/// A point of a drawn outline.
#[derive(Clone, Copy, Debug)]
pub enum Knot {
    /// The curve passes smoothly.
    Smooth(f64, f64),
    /// The curve turns sharply.
    Corner(f64, f64),
}

impl Knot {
    fn point(self) -> DVec2 {
        match self {
            Self::Smooth(x, y) | Self::Corner(x, y) => DVec2::new(x, y),
        }
    }

    fn is_corner(self) -> bool {
        matches!(self, Self::Corner(..))
    }
}

/// A closed polygon; counter-clockwise around material, clockwise around a hole.
pub type Polygon = Vec<DVec2>;

/// Samples the closed spline through `knots`, `steps` points per curved span.
pub fn closed_spline(knots: &[Knot], steps: usize) -> Polygon {
    let n = knots.len();
    let at = |i: usize| knots[i % n].point();
    // Half the chord of the neighbours; at a corner, the chord of this span alone.
    let tangent = |i: usize, span_chord: DVec2| {
        if knots[i % n].is_corner() { span_chord } else { 0.5 * (at(i + 1) - at(i + n - 1)) }
    };
    let mut polygon = Vec::with_capacity(n * steps);
    for i in 0..n {
        let (p, q) = (at(i), at(i + 1));
        let (u, v) = (tangent(i, q - p), tangent(i + 1, q - p));
        // Between two corners the curve is a straight line, which needs no intermediate points.
        let straight = knots[i].is_corner() && knots[(i + 1) % n].is_corner();
        polygon.extend((0..if straight { 1 } else { steps }).map(|k| hermite(p, u, q, v, k as f64 / steps as f64)));
    }
    polygon
}

/// Samples the open spline through `knots`, `steps` points per span, both ends included.
pub fn open_spline(knots: &[DVec3], steps: usize) -> Vec<DVec3> {
    let last = knots.len() - 1;
    let tangent = |i: usize| match i {
        0 => knots[1] - knots[0],
        i if i == last => knots[last] - knots[last - 1],
        i => 0.5 * (knots[i + 1] - knots[i - 1]),
    };
    let mut points = Vec::with_capacity(last * steps + 1);
    for i in 0..last {
        let (u, v) = (tangent(i), tangent(i + 1));
        points.extend((0..steps).map(|k| hermite(knots[i], u, knots[i + 1], v, k as f64 / steps as f64)));
    }
    points.push(knots[last]);
    points
}

/// Cubic Hermite curve from `p` with tangent `u` to `q` with tangent `v`, at t in 0…1.
fn hermite<V>(p: V, u: V, q: V, v: V, t: f64) -> V
where
    V: Copy + std::ops::Mul<f64, Output = V> + std::ops::Add<Output = V>,
{
    let (t2, t3) = (t * t, t * t * t);
    p * (2.0 * t3 - 3.0 * t2 + 1.0) + u * (t3 - 2.0 * t2 + t) + q * (3.0 * t2 - 2.0 * t3) + v * (t3 - t2)
}

/// An ellipse as a counter-clockwise polygon of `steps` corners, its first half axis rotated by `turn` rad.
pub fn ellipse(center: DVec2, half_axes: DVec2, turn: f64, steps: usize) -> Polygon {
    let (s, c) = (sin(turn), cos(turn));
    (0..steps)
        .map(|k| {
            let angle = 2.0 * PI * k as f64 / steps as f64;
            let p = DVec2::new(half_axes.x * cos(angle), half_axes.y * sin(angle));
            center + DVec2::new(c * p.x - s * p.y, s * p.x + c * p.y)
        })
        .collect()
}

/// A full circle of wire about `center`, from `center + radius·from` towards `towards`, both ends included. `from` and
/// `towards` are perpendicular unit vectors of the ring's plane.
pub fn ring(center: DVec3, radius: f64, from: DVec3, towards: DVec3, steps: usize) -> Vec<DVec3> {
    (0..=steps)
        .map(|k| {
            // The last point repeats the first exactly: sin(2π) is not 0 in floating point.
            let angle = 2.0 * PI * (k % steps) as f64 / steps as f64;
            center + radius * (cos(angle) * from + sin(angle) * towards)
        })
        .collect()
}

/// The polygon in reverse order, which turns material into a hole.
pub fn reversed(mut polygon: Polygon) -> Polygon {
    polygon.reverse();
    polygon
}

/// Signed area (counter-clockwise positive) and centroid, by the shoelace formula.
pub fn area_and_centroid(polygon: &[DVec2]) -> (f64, DVec2) {
    let mut twice_area = 0.0;
    let mut moment = DVec2::ZERO;
    for (i, &p) in polygon.iter().enumerate() {
        let q = polygon[(i + 1) % polygon.len()];
        let cross = p.perp_dot(q);
        twice_area += cross;
        moment += cross * (p + q);
    }
    (0.5 * twice_area, moment / (3.0 * twice_area))
}

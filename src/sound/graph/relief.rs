//! The picture on a body, read where the contact is.
//!
//! The picture lies over both half extents of the body. Its values are the coefficients of a cubic B-spline, which smooths by about
//! a pixel: its second derivative has no jumps, so that only the picture is audible, not the grid of its pixels.
//!
//! ```text
//! r(x, y) = Σ c_ij β(u − i) β(v − j)      u = (x + 1) w/2 − ½,  v = (y + 1) h/2 − ½
//! ```

use crate::SurfaceRelief;

/// Fewest pixels of a side: the kernel's width.
const FEWEST: usize = 4;
/// Most pixels: a bound on memory, 16 MiB.
const MOST: usize = 1 << 22;

/// A picture with mean 0 and mean square 1.
pub(crate) struct Relief {
    values: Vec<f32>,
    width: usize,
    height: usize,
}

impl Relief {
    /// The relief of a picture.
    ///
    /// # Errors
    /// It has too few or too many pixels, or a number that is not finite.
    pub fn new(picture: &SurfaceRelief) -> Result<Self, String> {
        let width = picture.width;
        let height = picture.values.len().checked_div(width).unwrap_or(0);
        let whole = width * height == picture.values.len() && picture.values.len() <= MOST;
        if !(whole && width.min(height) >= FEWEST && picture.values.iter().all(|v| v.is_finite())) {
            return Err(format!("a picture to scrape needs {FEWEST} to {MOST} pixels a side, in whole rows"));
        }
        let n = picture.values.len() as f64;
        let mean = picture.values.iter().map(|v| f64::from(*v)).sum::<f64>() / n;
        let power = picture.values.iter().map(|v| (f64::from(*v) - mean) * (f64::from(*v) - mean)).sum::<f64>() / n;
        let scale = if power > 1e-18 { 1.0 / power.sqrt() } else { 0.0 };
        let values = picture.values.iter().map(|v| ((f64::from(*v) - mean) * scale) as f32).collect();
        Ok(Self { values, width, height })
    }

    /// r at a place of the body, −1…1 both.
    pub fn at(&self, place: [f64; 2]) -> f32 {
        let (first_x, weights_x) = weights(place[0], self.width);
        let (first_y, weights_y) = weights(place[1], self.height);
        let row = |j: usize| {
            let start = (first_y + j) * self.width + first_x;
            let pixels = &self.values[start..start + 4];
            pixels.iter().zip(&weights_x).map(|(pixel, weight)| pixel * weight).sum::<f32>()
        };
        weights_y.iter().enumerate().map(|(j, weight)| weight * row(j)).sum()
    }
}

/// First of four pixels about a place on a side of `n` pixels, and their weights β. The picture ends half a kernel before its edge.
fn weights(place: f64, n: usize) -> (usize, [f32; 4]) {
    let u = (0.5 * (place + 1.0) * n as f64 - 0.5).clamp(1.0, n as f64 - 2.0 - 1e-9);
    let cell = u as usize;
    let t = (u - cell as f64) as f32;
    let (s, cube) = (1.0 - t, t * t * t);
    let near = 4.0 - 6.0 * t * t + 3.0 * cube;
    let far = 1.0 + 3.0 * t + 3.0 * t * t - 3.0 * cube;
    (cell - 1, [s * s * s / 6.0, near / 6.0, far / 6.0, cube / 6.0])
}

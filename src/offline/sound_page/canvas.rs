//! Raster canvas for charts: lines, discs and text.

use ab_glyph::{Font, FontRef, ScaleFont};
use image::{Rgb, RgbImage};

/// Red, green, blue.
pub type Colour = [u8; 3];

/// Background colour.
pub const PAPER: Colour = [252, 251, 248];
/// Colour of text and axes.
pub const INK: Colour = [42, 44, 48];
/// Colour of secondary text.
pub const PALE: Colour = [120, 122, 126];
/// Colour of grid lines.
pub const GRID: Colour = [226, 225, 220];
/// Colour of the first curve of a chart.
pub const FIRST: Colour = [28, 92, 160];
/// Colour of the second curve.
pub const SECOND: Colour = [208, 110, 28];
/// Colour of the third curve.
pub const THIRD: Colour = [84, 140, 70];

/// Horizontal alignment of text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Align {
    /// The text begins at the position.
    Left,
    /// The text is centred at the position.
    Middle,
    /// The text ends at the position.
    Right,
}

/// A picture being drawn.
pub struct Canvas {
    pixels: RgbImage,
    font: FontRef<'static>,
}

impl Canvas {
    /// An empty canvas.
    pub fn new(width: u32, height: u32) -> Self {
        let font = FontRef::try_from_slice(epaint_default_fonts::UBUNTU_LIGHT).expect("a font that is compiled in");
        Self { pixels: RgbImage::from_pixel(width, height, Rgb(PAPER)), font }
    }

    /// The picture.
    pub fn finish(self) -> RgbImage {
        self.pixels
    }

    /// Blends a colour into one pixel with opacity `share`.
    pub fn dot(&mut self, x: i64, y: i64, colour: Colour, share: f64) {
        let (Ok(x), Ok(y)) = (u32::try_from(x), u32::try_from(y)) else { return };
        if x < self.pixels.width() && y < self.pixels.height() {
            let pixel = self.pixels.get_pixel_mut(x, y);
            for (old, new) in pixel.0.iter_mut().zip(colour) {
                *old = (f64::from(*old) + share * (f64::from(new) - f64::from(*old))).round() as u8;
            }
        }
    }

    /// An antialiased line, its width in pixels.
    pub fn line(&mut self, from: [f64; 2], to: [f64; 2], width: f64, colour: Colour) {
        let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
        let length2 = dx * dx + dy * dy;
        let reach = 0.5 * width + 1.0;
        let (left, right) = (from[0].min(to[0]) - reach, from[0].max(to[0]) + reach);
        let (top, bottom) = (from[1].min(to[1]) - reach, from[1].max(to[1]) + reach);
        for py in top.floor() as i64..=bottom.ceil() as i64 {
            for px in left.floor() as i64..=right.ceil() as i64 {
                let (x, y) = (px as f64 + 0.5 - from[0], py as f64 + 0.5 - from[1]);
                let t = if length2 > 0.0 { ((x * dx + y * dy) / length2).clamp(0.0, 1.0) } else { 0.0 };
                let (ex, ey) = (x - t * dx, y - t * dy);
                let share = (0.5 * width + 0.5 - (ex * ex + ey * ey).sqrt()).clamp(0.0, 1.0);
                if share > 0.0 {
                    self.dot(px, py, colour, share);
                }
            }
        }
    }

    /// A polyline.
    pub fn path(&mut self, points: &[[f64; 2]], width: f64, colour: Colour) {
        for pair in points.windows(2) {
            self.line(pair[0], pair[1], width, colour);
        }
    }

    /// An antialiased disc.
    pub fn disc(&mut self, centre: [f64; 2], radius: f64, colour: Colour, share: f64) {
        let [x, y] = centre;
        for py in (y - radius - 1.0).floor() as i64..=(y + radius + 1.0).ceil() as i64 {
            for px in (x - radius - 1.0).floor() as i64..=(x + radius + 1.0).ceil() as i64 {
                let (ex, ey) = (px as f64 + 0.5 - x, py as f64 + 0.5 - y);
                let inside = (radius + 0.5 - (ex * ex + ey * ey).sqrt()).clamp(0.0, 1.0);
                if inside > 0.0 {
                    self.dot(px, py, colour, inside * share);
                }
            }
        }
    }

    /// Draws text on a baseline and returns its width in pixels.
    pub fn words(&mut self, x: f64, y: f64, size: f32, align: Align, colour: Colour, words: &str) -> f64 {
        let font = self.font.clone();
        let scaled = font.as_scaled(size);
        let width: f32 = words.chars().map(|c| scaled.h_advance(scaled.glyph_id(c))).sum();
        let mut at = x as f32
            - match align {
                Align::Left => 0.0,
                Align::Middle => 0.5 * width,
                Align::Right => width,
            };
        for c in words.chars() {
            let id = scaled.glyph_id(c);
            let glyph = id.with_scale_and_position(size, ab_glyph::point(at, y as f32));
            at += scaled.h_advance(id);
            if let Some(outline) = font.outline_glyph(glyph) {
                let bounds = outline.px_bounds();
                outline.draw(|gx, gy, share| {
                    let (px, py) = (i64::from(gx) + bounds.min.x as i64, i64::from(gy) + bounds.min.y as i64);
                    self.dot(px, py, colour, f64::from(share).min(1.0));
                });
            }
        }
        f64::from(width)
    }
}

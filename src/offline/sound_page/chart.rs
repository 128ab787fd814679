//! Chart axes: frame, grid, ticks, and the position of a value.

use super::canvas::{Align, Canvas, GRID, INK, PALE};
use soffio_math::log10;

/// One axis of a chart.
#[derive(Clone, Copy, Debug)]
pub struct Axis {
    /// Value at the start.
    pub low: f64,
    /// Value at the end.
    pub high: f64,
    /// Is the scale logarithmic? Then both ends are above 0.
    pub logarithmic: bool,
}

impl Axis {
    /// A linear scale.
    pub fn linear(low: f64, high: f64) -> Self {
        Self { low, high, logarithmic: false }
    }

    /// A logarithmic scale.
    pub fn logarithmic(low: f64, high: f64) -> Self {
        Self { low, high, logarithmic: true }
    }

    /// Position of a value, 0…1.
    pub fn at(&self, value: f64) -> f64 {
        if self.logarithmic {
            log10(value / self.low) / log10(self.high / self.low)
        } else {
            (value - self.low) / (self.high - self.low)
        }
    }

    /// Value at a position 0…1.
    pub fn value(&self, at: f64) -> f64 {
        if self.logarithmic {
            self.low * soffio_math::pow(self.high / self.low, at)
        } else {
            self.low + at * (self.high - self.low)
        }
    }

    /// Tick values, and whether each is labelled.
    fn ticks(&self) -> Vec<(f64, bool)> {
        let mut out = Vec::new();
        if self.logarithmic {
            let mut decade = soffio_math::pow(10.0, log10(self.low).floor());
            // 1, 2 and 5 of each decade where there is space.
            let wide = self.high / self.low > 1e4;
            while decade <= self.high {
                for step in 1..10 {
                    let value = decade * f64::from(step);
                    let named = step == 1 || (!wide && (step == 2 || step == 5));
                    if value >= 0.999 * self.low && value <= 1.001 * self.high {
                        out.push((value, named));
                    }
                }
                decade *= 10.0;
            }
            return out;
        }
        let rough = (self.high - self.low) / 6.0;
        let decade = soffio_math::pow(10.0, log10(rough).floor());
        let step = [1.0, 2.0, 5.0, 10.0].into_iter().map(|s| s * decade).find(|s| *s >= rough).unwrap_or(rough);
        let mut i = (self.low / step).ceil();
        while i * step <= self.high * (1.0 + 1e-9) + 1e-12 {
            out.push((i * step, true));
            i += 1.0;
        }
        out
    }
}

/// A short label of a value: 200, 2k, 0.05.
pub fn short(value: f64) -> String {
    let magnitude = value.abs();
    if magnitude >= 1000.0 {
        return format!("{}k", trim(value / 1000.0, 2));
    }
    trim(value, if magnitude >= 10.0 { 1 } else { 4 })
}

fn trim(value: f64, digits: usize) -> String {
    let text = format!("{value:.digits$}");
    let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    if text == "-0" { "0".into() } else { text.replace('-', "−") }
}

/// A chart on the canvas.
#[derive(Clone, Copy, Debug)]
pub struct Chart {
    /// Left edge, top edge, width, height, pixels.
    pub place: [f64; 4],
    /// Horizontal axis.
    pub x: Axis,
    /// Vertical axis.
    pub y: Axis,
}

impl Chart {
    /// Pixel of a pair of values, clamped to the frame.
    pub fn point(&self, x: f64, y: f64) -> [f64; 2] {
        let [left, top, width, height] = self.place;
        [left + width * self.x.at(x).clamp(0.0, 1.0), top + height * (1.0 - self.y.at(y).clamp(0.0, 1.0))]
    }

    /// Draws the frame around a picture, without grid lines over it.
    pub fn frame_over(&self, canvas: &mut Canvas, title: &str, across: &str, up: &str) {
        self.numbers(canvas, false);
        self.titles(canvas, title, across, up);
    }

    /// Draws grid, tick labels and titles.
    pub fn frame(&self, canvas: &mut Canvas, title: &str, across: &str, up: &str) {
        self.numbers(canvas, true);
        self.titles(canvas, title, across, up);
    }

    fn titles(&self, canvas: &mut Canvas, title: &str, across: &str, up: &str) {
        let [left, top, width, height] = self.place;
        self.border(canvas);
        canvas.words(left, top - 12.0, 18.0, Align::Left, INK, title);
        canvas.words(left + width, top + height + 38.0, 14.0, Align::Right, INK, across);
        canvas.words(left + width, top - 11.0, 14.0, Align::Right, PALE, up);
    }

    fn numbers(&self, canvas: &mut Canvas, grid: bool) {
        let [left, top, width, height] = self.place;
        for (value, named) in self.x.ticks() {
            let x = left + width * self.x.at(value);
            if grid {
                canvas.line([x, top], [x, top + height], 1.0, GRID);
            }
            if named {
                canvas.words(x, top + height + 19.0, 14.0, Align::Middle, PALE, &short(value));
            }
        }
        for (value, named) in self.y.ticks() {
            let y = top + height * (1.0 - self.y.at(value));
            if grid {
                canvas.line([left, y], [left + width, y], 1.0, GRID);
            }
            if named {
                canvas.words(left - 7.0, y + 5.0, 14.0, Align::Right, PALE, &short(value));
            }
        }
    }

    /// The four edges.
    fn border(&self, canvas: &mut Canvas) {
        let [left, top, width, height] = self.place;
        let corners =
            [[left, top], [left + width, top], [left + width, top + height], [left, top + height], [left, top]];
        canvas.path(&corners, 1.0, PALE);
    }
}

//! The last seconds of a number, as a line.

use std::collections::VecDeque;

use egui::{Align2, Color32, FontId, Sense, Stroke, Ui, pos2, vec2};

/// How much is shown, s.
pub const SHOWN_S: f64 = 10.0;
/// Height of a plot, points.
const HEIGHT: f32 = 84.0;
/// Least value of a logarithmic plot: below it a joint is closed to rounding.
const LEAST: f64 = 1e-16;

/// A number over time.
#[derive(Debug, Default)]
pub struct TimeSeries {
    values: VecDeque<(f64, f64)>,
}

impl TimeSeries {
    /// Adds a value at a time, s; one that was there already is not added again. A time before the last one, as after a
    /// reset, starts again.
    pub fn push(&mut self, time: f64, value: f64) {
        match self.values.back() {
            Some((last, _)) if *last == time => return,
            Some((last, _)) if *last > time => self.values.clear(),
            _ => {}
        }
        self.values.push_back((time, value));
        while self.values.front().is_some_and(|(first, _)| time - first > SHOWN_S) {
            self.values.pop_front();
        }
    }

    /// The values, the oldest first.
    pub fn values(&self) -> impl Iterator<Item = f64> {
        self.values.iter().map(|(_, value)| *value)
    }

    /// Draws it; `powers` of ten, or as it is.
    pub fn show(&self, ui: &mut Ui, name: &str, unit: &str, powers: bool) {
        let (area, _) = ui.allocate_exact_size(vec2(ui.available_width(), HEIGHT), Sense::hover());
        let painter = ui.painter_at(area);
        painter.rect_filled(area, 2.0, Color32::from_gray(236));
        let scale = |value: f64| if powers { value.abs().max(LEAST).log10() } else { value };
        let (mut low, mut high) = self
            .values()
            .map(scale)
            .filter(|value| value.is_finite())
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
        if low > high {
            (low, high) = (0.0, 1.0);
        }
        // A line that is level lies in the middle, not on the rim.
        let margin = (0.1 * (high - low)).max(if powers { 0.5 } else { 1e-9 * high.abs().max(1e-6) });
        (low, high) = (low - margin, high + margin);
        let now = self.values.back().map_or(0.0, |(time, _)| *time);
        let place = |&(time, value): &(f64, f64)| {
            let x = area.right() - area.width() * ((now - time) / SHOWN_S) as f32;
            let share = ((scale(value) - low) / (high - low)).clamp(0.0, 1.0);
            pos2(x, area.bottom() - area.height() * share as f32)
        };
        painter.line(self.values.iter().map(place).collect(), Stroke::new(1.5, Color32::from_rgb(40, 70, 130)));
        let last = self.values.back().map_or_else(|| "\u{2013}".into(), |(_, value)| format!("{value:.3e} {unit}"));
        let font = FontId::monospace(12.0);
        let ink = Color32::from_gray(30);
        painter.text(area.left_top() + vec2(4.0, 2.0), Align2::LEFT_TOP, format!("{name}: {last}"), font.clone(), ink);
        // What is written below a level line is the same number: above it stands by how much the other end differs.
        let bound = |value: f64| if powers { format!("1e{value:.0}") } else { format!("{value:.3e}") };
        let top = if powers { bound(high) } else { format!("+ {:.1e}", high - low) };
        let soft = Color32::from_gray(90);
        painter.text(area.right_top() + vec2(-4.0, 2.0), Align2::RIGHT_TOP, top, font.clone(), soft);
        painter.text(area.right_bottom() - vec2(4.0, 2.0), Align2::RIGHT_BOTTOM, bound(low), font, soft);
    }
}

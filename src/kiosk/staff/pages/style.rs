//! How the panel looks: its width, its colours, its rows of numbers.

use egui::{Color32, RichText, Ui};

/// Width of the panel, points, and its greatest share of the glass.
const WIDTH: f32 = 500.0;
const WIDTH_SHARE: f32 = 0.6;

/// Height of a row of numbers, points.
pub(crate) const ROW: f32 = 17.0;

/// What is not as it should be.
pub(crate) const BAD: Color32 = Color32::from_rgb(160, 30, 15);
/// What is.
pub(crate) const GOOD: Color32 = Color32::from_rgb(20, 90, 45);

/// Width of the panel, points.
pub(crate) fn width(context: &egui::Context) -> f32 {
    WIDTH.min(WIDTH_SHARE * context.content_rect().width())
}

/// One row of a grid of names and values.
pub(crate) fn row(ui: &mut Ui, name: &str, value: impl AsRef<str>, bad: bool) {
    ui.label(name);
    let text = RichText::new(value.as_ref()).monospace();
    ui.add(egui::Label::new(if bad { text.color(BAD) } else { text }).wrap());
    ui.end_row();
}

//! Where the breath goes: a dot on every patch of the sculpture that feels the wind, and how fast the air is there.

use egui::{Color32, Grid, LayerId, Order, Ui, pos2, vec2};

use super::style::{ROW, width};
use crate::pages::ui_strings::TextId;
use crate::staff::panel_input::PanelInput;
use soffio_simulation::WindSample;

/// Air as fast as this is drawn at its reddest, m/s.
const FULL: f64 = 5.0;

/// Headings of the table of surfaces.
const COLUMNS: [TextId; 4] =
    [TextId::StaffColumnSurface, TextId::StaffColumnHit, TextId::StaffColumnMean, TextId::StaffColumnFastest];

/// Draws the table in the panel and the dots over the picture.
pub fn show(ui: &mut Ui, input: &PanelInput) {
    let texts = input.texts;
    ui.label(texts.get(TextId::StaffWindHelp));
    let Some(seen) = &input.frame.inspection else {
        ui.weak(texts.get(TextId::StaffNoDataYet));
        return;
    };
    dots(ui, input, &seen.wind);
    let exhibit = &input.frame.exhibit;
    Grid::new("surfaces").num_columns(4).min_row_height(ROW).striped(true).spacing([16.0, 2.0]).show(ui, |ui| {
        for name in COLUMNS {
            ui.label(texts.get(name));
        }
        ui.end_row();
        for (index, surface) in exhibit.wind_surfaces.iter().enumerate() {
            let own = || seen.wind.iter().filter(|sample| sample.surface == index);
            let hit = || own().filter(|sample| sample.in_breath);
            let sum = hit().fold(0.0, |sum, sample| sum + sample.speed);
            let mean = sum / hit().count().max(1) as f64;
            let fastest = own().fold(0.0, |most: f64, sample| most.max(sample.speed));
            ui.label(exhibit.bodies.get(surface.body).map_or("?", |body| body.name.as_str()));
            let [hits, all] = [hit().count(), own().count()].map(|count| format!("{count:3}").into());
            ui.monospace(&*texts.format(TextId::StaffHitOf, &[("hit", hits), ("count", all)]));
            ui.monospace(format!("{mean:6.2}"));
            ui.monospace(format!("{fastest:6.2}"));
            ui.end_row();
        }
    });
    let force = format!("{:.4}", input.frame.current.diagnostics.wind_force.length());
    ui.label(&*texts.format(TextId::StaffTotalForce, &[("newtons", force.into())]));
    let speed = format!("{:.2}", input.frame.current.breath.speed);
    ui.label(&*texts.format(TextId::StaffSourceSpeed, &[("speed", speed.into())]));
}

/// The patches over the picture, behind the panel.
fn dots(ui: &Ui, input: &PanelInput, samples: &[WindSample]) {
    let picture = ui.ctx().content_rect();
    let aspect = f64::from(picture.width() / picture.height());
    let layer = LayerId::new(Order::Background, egui::Id::unique("wind samples"));
    let beside = picture.with_max_x(picture.right() - width(ui.ctx()));
    let painter = ui.ctx().layer_painter(layer).with_clip_rect(beside);
    for sample in samples {
        let Some([x, y]) = input.view.project(sample.point, aspect) else { continue };
        let at = picture.lerp_inside(vec2(x as f32, y as f32));
        let share = (sample.speed / FULL).clamp(0.0, 1.0) as f32;
        let color = Color32::from_rgb((60.0 + 195.0 * share) as u8, (90.0 * (1.0 - share)) as u8, 110);
        painter.circle_filled(pos2(at.x, at.y), 2.5, color);
        if sample.in_breath {
            painter.circle_stroke(pos2(at.x, at.y), 4.5, egui::Stroke::new(1.5, color));
        }
    }
}

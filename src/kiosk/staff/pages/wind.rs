//! Where the breath goes: a dot on every patch of the sculpture that feels the wind, and how fast the air is there.

use egui::{Color32, Grid, LayerId, Order, Ui, pos2, vec2};

use super::style::{ROW, width};
use crate::staff::panel_input::PanelInput;
use soffio_simulation::WindSample;

/// Air as fast as this is drawn at its reddest, m/s.
const FULL: f64 = 5.0;

/// Draws the table in the panel and the dots over the picture.
pub fn show(ui: &mut Ui, input: &PanelInput) {
    ui.label("Dots are the patches that feel the wind. Ringed: in the cone of the breath as it is aimed now, seen from the lips. The redder, the faster the air.");
    let Some(seen) = &input.frame.inspection else {
        ui.weak("the simulation has not answered yet");
        return;
    };
    dots(ui, input, &seen.wind);
    let exhibit = &input.frame.exhibit;
    Grid::new("surfaces").num_columns(4).min_row_height(ROW).striped(true).spacing([16.0, 2.0]).show(ui, |ui| {
        for name in ["surface of", "hit", "mean, m/s", "fastest, m/s"] {
            ui.label(name);
        }
        ui.end_row();
        for (index, surface) in exhibit.wind_surfaces.iter().enumerate() {
            let own = || seen.wind.iter().filter(|sample| sample.surface == index);
            let hit = || own().filter(|sample| sample.in_breath);
            let sum = hit().fold(0.0, |sum, sample| sum + sample.speed);
            let mean = sum / hit().count().max(1) as f64;
            let fastest = own().fold(0.0, |most: f64, sample| most.max(sample.speed));
            ui.label(exhibit.bodies.get(surface.body).map_or("?", |body| body.name.as_str()));
            ui.monospace(format!("{:3} of {:3}", hit().count(), own().count()));
            ui.monospace(format!("{mean:6.2}"));
            ui.monospace(format!("{fastest:6.2}"));
            ui.end_row();
        }
    });
    ui.label(format!("force of all winds: {:.4} N", input.frame.current.diagnostics.wind_force.length()));
    ui.label(format!("source of the breath: {:.2} m/s", input.frame.current.breath.speed));
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

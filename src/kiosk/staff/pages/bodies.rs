//! Bodies and joints: how far each joint is from closed, what it carries, and the energy, live.

use egui::{Grid, Ui};

use super::plot::TimeSeries;
use super::style::{BAD, ROW};
use crate::pages::ui_strings::TextId;
use crate::staff::panel_input::PanelInput;
use soffio_simulation::STEPS_PER_SECOND;

/// Joint error from which a joint is listed, m or rad.
const OPEN: f64 = 1e-3;

/// Headings of the table of bodies.
const COLUMNS: [TextId; 5] = [
    TextId::StaffColumnBody,
    TextId::StaffColumnMass,
    TextId::StaffColumnSpeed,
    TextId::StaffColumnSpin,
    TextId::StaffColumnHeight,
];

/// What the page remembers.
#[derive(Debug, Default)]
pub struct Bodies {
    exhibit: String,
    energy: TimeSeries,
    worst: TimeSeries,
    /// The joint whose own course is shown, and the course.
    picked: Option<usize>,
    own: TimeSeries,
}

impl Bodies {
    /// Draws it.
    pub fn show(&mut self, ui: &mut Ui, input: &PanelInput) {
        let (frame, texts) = (input.frame, input.texts);
        if self.exhibit != frame.exhibit.id {
            *self = Self { exhibit: frame.exhibit.id.clone(), ..Self::default() };
        }
        let state = &frame.current.diagnostics;
        let time = frame.current.step as f64 / STEPS_PER_SECOND as f64;
        self.worst.push(time, state.joint_error);
        self.energy.push(time, state.energy);
        self.worst.show(ui, texts.get(TextId::StaffLargestJointError), "m", true);
        self.energy.show(ui, texts.get(TextId::StaffEnergy), "J", false);
        let Some(seen) = &frame.inspection else {
            ui.weak(texts.get(TextId::StaffNoDataYet));
            return;
        };
        // Another exhibit may have come on between the two.
        let joints: Vec<_> = frame.exhibit.constraints.iter().zip(&seen.joints).collect();
        if let Some((constraint, joint)) = self.picked.and_then(|picked| joints.get(picked)) {
            self.own.push(time, joint.error);
            self.own.show(ui, &constraint.name, if joint.angle { "rad" } else { "m" }, true);
        }
        ui.separator();
        ui.label(texts.get(TextId::StaffJoints));
        Grid::new("joints").num_columns(3).striped(true).spacing([16.0, 2.0]).show(ui, |ui| {
            for (index, (constraint, joint)) in joints.iter().enumerate() {
                let unit = if joint.angle { "rad" } else { "m" };
                if ui.selectable_label(self.picked == Some(index), &constraint.name).clicked() {
                    self.picked = (self.picked != Some(index)).then_some(index);
                    self.own = TimeSeries::default();
                }
                let error = egui::RichText::new(format!("{:9.2e} {unit}", joint.error)).monospace();
                ui.label(if joint.error > OPEN { error.color(BAD) } else { error });
                ui.monospace(joint.load.map_or_else(String::new, |load| format!("{load:9.3e} N")));
                ui.end_row();
            }
        });
        ui.separator();
        Grid::new("bodies").num_columns(5).min_row_height(ROW).striped(true).spacing([16.0, 2.0]).show(ui, |ui| {
            for name in COLUMNS {
                ui.label(texts.get(name));
            }
            ui.end_row();
            for (body, state) in frame.exhibit.bodies.iter().zip(&seen.bodies) {
                ui.label(&body.name);
                ui.monospace(format!("{:9.2}", 1e3 * body.properties.mass));
                ui.monospace(format!("{:8.4}", state.speed));
                ui.monospace(format!("{:8.4}", state.spin));
                ui.monospace(format!("{:7.3}", state.height));
                ui.end_row();
            }
        });
    }
}

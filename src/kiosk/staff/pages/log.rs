//! The last lines of the log.

use egui::{Label, RichText, ScrollArea, Ui};
use tracing::Level;

use super::style::BAD;
use crate::staff::log::Log;

/// What the page remembers.
#[derive(Debug, Default)]
pub struct LogPage {
    /// Only warnings and errors.
    grave: bool,
}

impl LogPage {
    /// Draws it.
    pub fn show(&mut self, ui: &mut Ui, log: &Log) {
        ui.checkbox(&mut self.grave, "only warnings and errors");
        let lines = log.lines();
        let shown: Vec<_> = lines.iter().filter(|line| !self.grave || line.level <= Level::WARN).collect();
        if shown.is_empty() {
            ui.weak("no lines");
        }
        ScrollArea::vertical().id_salt("lines").stick_to_bottom(true).auto_shrink(false).show(ui, |ui| {
            for line in shown {
                let text = RichText::new(format!("{}  {}", line.time.strftime("%H:%M:%S"), line.text)).monospace();
                let text = if line.level <= Level::WARN { text.color(BAD) } else { text };
                ui.add(Label::new(text).wrap());
            }
        });
    }
}

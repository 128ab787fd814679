//! The last lines of the log.

use egui::{Label, RichText, ScrollArea, Ui};
use tracing::Level;

use super::style::BAD;
use crate::pages::ui_strings::{TextId, UiStrings};
use crate::staff::log::Log;

/// What the page remembers.
#[derive(Debug, Default)]
pub struct LogPage {
    /// Only warnings and errors.
    grave: bool,
}

impl LogPage {
    /// Draws it.
    pub fn show(&mut self, ui: &mut Ui, log: &Log, texts: &UiStrings) {
        ui.checkbox(&mut self.grave, texts.get(TextId::StaffLogGrave));
        let lines = log.lines();
        let shown: Vec<_> = lines.iter().filter(|line| !self.grave || line.level <= Level::WARN).collect();
        if shown.is_empty() {
            ui.weak(texts.get(TextId::StaffLogEmpty));
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

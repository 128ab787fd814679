//! The work's numbers, dragged and written back into its sidecar, comments and units kept. The shelf sees the saved file
//! and shows the work again; where it does not load any more, the last good one stays on show and a press takes the
//! change back.

use std::path::{Path, PathBuf};
use std::time::SystemTime;

use egui::{CollapsingHeader, DragValue, Label, RichText, TextEdit, Ui};

use super::style::BAD;
use crate::pages::ui_strings::TextId;
use crate::staff::edit::{Changes, Number, Step, four_digits, numbers, with_number};
use crate::staff::panel_input::PanelInput;
use soffio_exhibit::SIDECAR;
use soffio_exhibit::files::{self, MAX_SIDECAR_BYTES};

/// Share of its value by which a number changes for a point of dragging.
const SPEED: f64 = 0.005;
/// The same for a number that is 0.
const FROM_ZERO: f64 = 0.001;

/// What the page remembers.
#[derive(Debug, Default)]
pub struct Parameters {
    file: PathBuf,
    written: Option<SystemTime>,
    numbers: Vec<Number>,
    filter: String,
}

impl Parameters {
    /// Draws it.
    pub fn show(
        &mut self,
        ui: &mut Ui,
        input: &PanelInput,
        may: bool,
        changes: &mut Changes,
        said: &mut Option<String>,
    ) {
        if let Err(error) = self.read(&input.frame.exhibit.folder.join(SIDECAR)) {
            ui.colored_label(BAD, error);
        }
        let texts = input.texts;
        if let Some(report) = input.exhibit_problem {
            ui.colored_label(BAD, texts.get(TextId::StaffDoesNotLoad));
            ui.add(Label::new(RichText::new(report).monospace().color(BAD)).wrap());
        }
        let file = self.file.display().to_string();
        ui.label(&*texts.format(TextId::StaffParametersHelp, &[("file", file.into())]));
        ui.horizontal(|ui| {
            let undo = texts.format(TextId::StaffUndo, &[("count", changes.count().into())]);
            if ui.add_enabled(may && changes.count() > 0, egui::Button::new(&*undo)).clicked() {
                *said = Some(changes.undo().err().unwrap_or_else(|| texts.get(TextId::StaffUndone).into()));
                self.written = None;
            }
            ui.add(TextEdit::singleline(&mut self.filter).hint_text(texts.get(TextId::StaffFind)).desired_width(160.0));
        });
        let changed = ui.add_enabled_ui(may, |ui| self.groups(ui)).inner;
        if let Some((place, value)) = changed {
            let made = changes.make(&self.file, |text| with_number(text, &place, value));
            *said = Some(made.err().unwrap_or_else(|| {
                texts.format(TextId::StaffSavedValue, &[("value", shown(value).into())]).to_string()
            }));
            self.written = None;
        }
    }

    /// Reads the file when it is another one, or has changed.
    fn read(&mut self, file: &Path) -> Result<(), String> {
        let written = std::fs::metadata(file).and_then(|data| data.modified()).ok();
        if self.file == file && self.written.is_some() && self.written == written {
            return Ok(());
        }
        let text = files::read_text(file, MAX_SIDECAR_BYTES).map_err(|problem| problem.message)?;
        (self.file, self.written) = (file.to_path_buf(), written);
        self.numbers = numbers(&text)?;
        Ok(())
    }

    /// All numbers, by their tables; the one that was let go.
    fn groups(&mut self, ui: &mut Ui) -> Option<(Vec<Step>, f64)> {
        let mut changed = None;
        let wanted = self.filter.to_lowercase();
        let finds = |number: &Number| format!("{} {}", number.of, number.name).to_lowercase().contains(&wanted);
        for group in self.numbers.chunk_by_mut(|a, b| a.of == b.of) {
            if !group.iter().any(finds) {
                continue;
            }
            let header = CollapsingHeader::new(&group[0].of).open((!wanted.is_empty()).then_some(true));
            header.show(ui, |ui| {
                for number in group.iter_mut().filter(|number| finds(number)) {
                    if drag(ui, number) {
                        changed = Some((number.place.clone(), number.value));
                    }
                }
            });
        }
        changed
    }
}

/// One number; says whether it was changed and let go.
fn drag(ui: &mut Ui, number: &mut Number) -> bool {
    ui.horizontal(|ui| {
        let speed = if number.value == 0.0 { FROM_ZERO } else { SPEED * number.value.abs() };
        let speed = if number.whole { speed.max(0.1) } else { speed };
        let unit = if number.unit.is_empty() { String::new() } else { format!(" {}", number.unit) };
        let field = DragValue::new(&mut number.value)
            .speed(speed)
            .suffix(unit)
            .update_while_editing(false)
            .custom_formatter(|value, _| shown(value));
        let response = ui.add(field);
        ui.label(&number.name);
        response.drag_stopped() || response.lost_focus() && response.changed()
    })
    .inner
}

/// As it will be written.
fn shown(value: f64) -> String {
    four_digits(value).to_string()
}

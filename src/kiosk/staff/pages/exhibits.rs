//! Which works visitors find, and in which order: `exhibits.show`, row by row.

use std::path::Path;

use egui::{RichText, Ui};

use super::states::saved_in;
use crate::pages::ui_strings::{TextId, UiStrings};
use crate::staff::action::StaffAction;
use crate::staff::edit::{Changes, with_list};
use crate::staff::panel_input::PanelInput;
use crate::venue::catalog::{ExhibitSource, folders, id};
use soffio_config::OTHERS;

/// What the page remembers.
#[derive(Debug, Default)]
pub struct Exhibits {
    /// The list of the configuration, and as it is being changed.
    configured: Vec<String>,
    list: Vec<String>,
    /// Ids of all exhibits of the folder, looked up when the list is.
    all: Vec<String>,
}

/// What is done to the list.
enum Change {
    /// A row goes so many places down.
    Move(usize, isize),
    Remove(usize),
    Add(String),
}

impl Exhibits {
    /// Draws the page. `may`: may staff change anything? `actions` and `changes` receive what they press and save; `said`
    /// receives the answer that the panel shows.
    pub fn show(
        &mut self,
        ui: &mut Ui,
        input: &PanelInput,
        may: bool,
        actions: &mut Vec<StaffAction>,
        changes: &mut Changes,
        said: &mut Option<String>,
    ) {
        let (site, texts) = (&input.site.exhibits, input.texts);
        if self.configured != site.show || self.all.is_empty() {
            (self.configured, self.list) = (site.show.clone(), site.show.clone());
            let places = ExhibitSource::All { folder: site.folder.clone(), show: vec![OTHERS.to_owned()] };
            self.all = folders(&places).iter().map(|folder| id(folder)).collect();
        }
        ui.label(texts.get(TextId::StaffExhibitsOrder));
        let change = ui.add_enabled_ui(may, |ui| self.rows(ui, input, actions)).inner;
        if let Some(change) = change {
            self.apply(change);
        }
        ui.separator();
        let changed = self.list != self.configured;
        ui.horizontal(|ui| {
            let may_save = may && changed && input.file.is_some();
            if ui.add_enabled(may_save, egui::Button::new(texts.get(TextId::StaffSaveOrder))).clicked()
                && let Some(file) = input.file
            {
                *said = Some(save(file, &self.list, changes, texts));
            }
            if ui.add_enabled(changed, egui::Button::new(texts.get(TextId::StaffDiscard))).clicked() {
                self.list.clone_from(&self.configured);
            }
        });
        if input.file.is_none() {
            ui.weak(texts.get(TextId::StaffNoFile));
        }
    }

    fn rows(&self, ui: &mut Ui, input: &PanelInput, actions: &mut Vec<StaffAction>) -> Option<Change> {
        let texts = input.texts;
        let mut change = None;
        for (row, id) in self.list.iter().enumerate() {
            ui.horizontal(|ui| {
                for (sign, by) in [("\u{2191}", -1), ("\u{2193}", 1)] {
                    let to = row as isize + by;
                    let is_inside = (0..self.list.len() as isize).contains(&to);
                    if ui.add_enabled(is_inside, egui::Button::new(RichText::new(sign).monospace())).clicked() {
                        change = Some(Change::Move(row, by));
                    }
                }
                if ui.button("\u{00d7}").clicked() {
                    change = Some(Change::Remove(row));
                }
                let stands = input.exhibit_ids.contains(&id.as_str());
                match id.as_str() {
                    OTHERS => {
                        let others = self.all.iter().filter(|id| !self.list.contains(id)).count();
                        ui.label(&*texts.format(TextId::StaffOthersCount, &[("count", others.into())]));
                    }
                    id if stands => {
                        if ui.selectable_label(input.frame.exhibit.id == id, id).clicked() {
                            actions.push(StaffAction::Show(id.to_owned()));
                        }
                    }
                    id => {
                        ui.weak(&*texts.format(TextId::StaffExhibitMissing, &[("id", id.into())]));
                    }
                }
            });
        }
        ui.separator();
        ui.label(texts.get(TextId::StaffNotListed));
        ui.horizontal_wrapped(|ui| {
            let others = self.all.iter().map(String::as_str).chain([OTHERS]);
            for id in others.filter(|id| !self.list.iter().any(|listed| listed == id)) {
                let name = if id == OTHERS { texts.get(TextId::StaffOthers) } else { id };
                if ui.button(format!("+ {name}")).clicked() {
                    change = Some(Change::Add(id.to_owned()));
                }
            }
        });
        change
    }

    fn apply(&mut self, change: Change) {
        match change {
            Change::Move(row, by) => self.list.swap(row, row.saturating_add_signed(by)),
            Change::Remove(row) => drop(self.list.remove(row)),
            Change::Add(id) => self.list.push(id),
        }
    }
}

fn save(file: &Path, list: &[String], changes: &mut Changes, texts: &UiStrings) -> String {
    match changes.make_or_create(file, |text| with_list(text, "exhibits", "show", list)) {
        Ok(()) => saved_in(texts, file),
        Err(error) => error,
    }
}

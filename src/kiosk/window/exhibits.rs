//! Handles events of the catalog, and changes exhibits in attract mode.

use super::app::App;
use super::parts::visit::Presence;
use crate::live::LiveState;
use crate::pages::menu::Menu;
use crate::step::command::KioskCommand;
use crate::venue::catalog::{self, CatalogEvent};
use crate::venue::loudness::VolumeRequests;

impl App<'_> {
    /// Handles an event of the catalog.
    pub(super) fn handle_catalog_event(&mut self, event: CatalogEvent) {
        match event {
            CatalogEvent::Show(exhibit, baked) => {
                self.exhibits.problem = None;
                self.fleet.record_reload(true, None);
                self.visit.breath_time.end_visit();
                self.visit.accessibility.look_around = false;
                self.say(format!("{} is on show", exhibit.id));
                if let Some(show) = &mut self.show {
                    show.screen.prepare(&exhibit, *baked);
                    show.live.send(KioskCommand::Exhibit(exhibit));
                }
                self.send_controls();
            }
            CatalogEvent::Failed(report) => {
                self.exhibits.record_failed();
                self.fleet.record_reload(false, None);
                self.say(format!("{}\nThe last valid exhibit stays on show.", report.trim_end()));
            }
            CatalogEvent::Listed(exhibit) => {
                self.exhibits.thumbnails.retain(|(id, _)| *id != exhibit.id);
                if self.fleet.release(&exhibit.id) {
                    self.say(format!("{} is offered again: its files have changed", exhibit.id));
                }
                self.exhibits.offer.insert(*exhibit);
            }
            CatalogEvent::Rejected(id, report) => {
                self.exhibits.offer.remove(&id);
                let shown = self.show.as_ref().map(|show| show.live.frame().exhibit.folder.clone());
                if shown.is_some_and(|folder| catalog::id(&folder) == id) {
                    self.fleet.record_reload(false, None);
                    self.exhibits.problem = Some(report.trim_end().to_owned());
                }
                self.say(format!("{}\n{id} is not offered until it is valid.", report.trim_end()));
            }
            CatalogEvent::Removed(id) => self.exhibits.offer.remove(&id),
        }
    }

    /// Requests the exhibit `by` places after the one on show, or requested; returns whether there is another.
    pub(super) fn show_neighbour(&mut self, by: i32) -> bool {
        let shown = self.show.as_ref().map(|show| show.live.frame().exhibit.folder.clone());
        shown.is_some_and(|shown| self.exhibits.show_neighbour(&shown, by))
    }

    /// Resets everything when the visitor has left, with or without attract mode. After each round of attract mode the next
    /// exhibit is shown.
    pub(super) fn update_attract(&mut self, frame: &LiveState) {
        let presence = Presence { attracts: frame.attracts, visited: self.fleet.is_visited() };
        if self.visit.ends(presence, &self.setup.config) {
            self.request_volume(VolumeRequests { leaves: true, ..VolumeRequests::default() });
            self.overlays.languages.shown.clear();
            self.overlays.menu = Menu::default();
            self.visit.leave(&self.setup.config);
            self.send_controls();
        }
        self.exhibits.record_shown(&frame.exhibit.id);
        if frame.attracts && frame.attract_rounds > 0 && !self.exhibits.is_changing() {
            self.show_neighbour(1);
        }
    }
}

//! The window's part in the works on show: what the shelf says of them, which comes next, attract mode that lets them take turns.

use super::app::App;
use crate::live::Frame;
use crate::pages::menu::Menu;
use crate::step::command::KioskCommand;
use crate::venue::loudness::Wishes;
use crate::venue::shelf::{self, News};

impl App<'_> {
    /// What the shelf has to say.
    pub(super) fn hear(&mut self, news: News) {
        match news {
            News::Show(exhibit) => {
                self.works.turning = false;
                self.works.says = None;
                self.fleet.read_anew(true, None);
                self.visit.given.leave();
                self.visit.needs.round = false;
                self.say(format!("{} is on show", exhibit.id));
                if let Some(show) = &mut self.show {
                    show.screen.prepare(&exhibit);
                    show.live.send(KioskCommand::Exhibit(exhibit));
                }
                self.tell();
            }
            News::Failed(report) => {
                self.works.turning = false;
                self.fleet.read_anew(false, None);
                self.say(format!("{}\nThe last good exhibit stays on show.", report.trim_end()));
            }
            News::Stands(work) => {
                self.works.thumbnails.retain(|(id, _)| *id != work.id);
                self.works.offer.put(*work);
            }
            News::Falls(id, report) => {
                self.works.offer.remove(&id);
                let shown = self.show.as_ref().map(|show| show.live.frame().exhibit.folder.clone());
                if shown.is_some_and(|folder| shelf::id(&folder) == id) {
                    self.fleet.read_anew(false, None);
                    self.works.says = Some(report.trim_end().to_owned());
                }
                self.say(format!("{}\n{id} is not offered until it is mended.", report.trim_end()));
            }
            News::Gone(id) => self.works.offer.remove(&id),
        }
    }

    /// Asks for the work so many places after the one on show; says whether there is another.
    pub(super) fn leaf(&self, by: i32) -> bool {
        self.show.as_ref().is_some_and(|show| self.works.leaf(&show.live.frame().exhibit.folder, by))
    }

    /// When the last visitor has left, the next one finds everything as it was first, whether the site has an attract mode or
    /// not; in it the works take turns.
    pub(super) fn follow_attract(&mut self, frame: &Frame) {
        if self.visit.ends(frame.attracts, self.fleet.is_visited(), &self.setup.config) {
            self.wish(Wishes { leaves: true, ..Wishes::default() });
            self.overlaid.languages.shown.clear();
            self.overlaid.menu = Menu::default();
            self.visit.leave(&self.setup.config);
            self.tell();
        }
        if frame.attracts && frame.attract_rounds > 0 && !self.works.turning {
            self.works.turning = self.leaf(1);
        }
    }
}

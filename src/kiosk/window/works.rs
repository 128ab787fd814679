//! The window's part in the works on show: what the shelf says of them, which comes next, attract mode that lets them take turns.

use super::App;
use crate::live::Frame;
use crate::pages::menu::Menu;
use crate::venue::shelf::{self, News};

impl App<'_> {
    /// What the shelf has to say.
    pub(super) fn hear(&mut self, news: News) {
        match news {
            News::Show(exhibit) => {
                self.turning = false;
                self.work_says = None;
                self.fleet.read_anew(true, None);
                self.given.leave();
                self.needs.round = false;
                self.say(format!("{} is on show", exhibit.id));
                if let Some(show) = &mut self.show {
                    show.screen.prepare(&exhibit);
                    show.live.controls().exhibit = Some(exhibit);
                }
                self.tell();
            }
            News::Failed(report) => {
                self.turning = false;
                self.fleet.read_anew(false, None);
                self.say(format!("{}\nThe last good exhibit stays on show.", report.trim_end()));
            }
            News::Stands(work) => {
                self.pictures.retain(|(id, _)| *id != work.id);
                self.offer.put(*work);
            }
            News::Falls(id, report) => {
                self.offer.remove(&id);
                let shown = self.show.as_ref().map(|show| show.live.frame().exhibit.folder.clone());
                if shown.is_some_and(|folder| shelf::id(&folder) == id) {
                    self.fleet.read_anew(false, None);
                    self.work_says = Some(report.trim_end().to_owned());
                }
                self.say(format!("{}\n{id} is not offered until it is mended.", report.trim_end()));
            }
            News::Gone(id) => self.offer.remove(&id),
        }
    }

    /// Asks for the work so many places after the one on show; says whether there is another.
    pub(super) fn leaf(&self, by: i32) -> bool {
        let Some(show) = &self.show else { return false };
        let shown = shelf::id(&show.live.frame().exhibit.folder);
        let next = self.offer.beside(&shown, by as isize);
        next.inspect(|work| self.shelf.show(&work.folder)).is_some()
    }

    /// When the last visitor has left, the next one finds everything as it was first, whether the site has an attract mode or
    /// not; in it the works take turns.
    pub(super) fn follow_attract(&mut self, frame: &Frame) {
        let visited = self.fleet.is_visited();
        let leaves =
            if self.config.attract.enabled { frame.attracts && !self.attracts } else { self.visited && !visited };
        self.visited = visited;
        if frame.attracts != self.attracts {
            tracing::info!(
                "{}",
                if frame.attracts { "nobody is here: attract mode begins" } else { "somebody is here" }
            );
        }
        if leaves {
            self.wish(|wishes| wishes.leaves = true);
            self.visitor.leave();
            self.language.clear();
            (self.menu, self.listens) = (Menu::default(), true);
            self.forget_needs();
            self.given.leave();
            self.tell();
        }
        if frame.attracts && frame.attract_rounds > 0 && !self.turning {
            self.turning = self.leaf(1);
        }
        self.attracts = frame.attracts;
    }
}

//! The window's part in what is asked of the kiosk: by a button, a key or a switch; and what the simulation is told of it.

use std::time::Instant;

use winit::event_loop::ActiveEventLoop;

use super::App;
use crate::venue::loudness::Wishes;
use crate::visitor::input::Request;
use soffio_simulation::Command;

impl App<'_> {
    /// What a press at a point of the picture asks for, where it is not a breath.
    pub(super) fn button_at(&self, at: egui::Pos2) -> Option<Request> {
        self.buttons.iter().find(|(rect, _)| rect.contains(at)).map(|&(_, request)| request)
    }

    pub(super) fn grant(&mut self, events: &ActiveEventLoop, request: Request) {
        match request {
            Request::Close => events.exit(),
            Request::Language(index) => self.language = self.languages.get(index).cloned().unwrap_or_default(),
            Request::NextLanguage => {
                let shown = self.languages.iter().position(|code| *code == self.language);
                let next = shown.map_or(0, |shown| (shown + 1) % self.languages.len());
                self.language = self.languages.get(next).cloned().unwrap_or_default();
            }
            Request::Menu => {
                self.menu.toggle();
                self.visitor.let_go();
            }
            Request::Work(index) => {
                if let Some(work) = self.offer.works().get(index) {
                    self.shelf.show(&work.folder);
                }
                self.menu.open = false;
            }
            Request::Leaf(by) if self.menu.open => self.menu.turn(by),
            Request::Leaf(by) => {
                self.leaf(by);
            }
            Request::Large => self.needs.reading.large ^= true,
            Request::Contrast => self.needs.reading.contrast ^= true,
            Request::Listen => self.listens = !self.listens,
            Request::PressOnce | Request::Dwell | Request::Calm | Request::Round | Request::Speak => {
                self.choose(request);
            }
            Request::Look(way) => {
                self.menu.look(way, &self.buttons);
                self.aloud.reach(self.menu.marked(&self.buttons));
            }
            Request::Enter => {
                if let Some(marked) = self.menu.marked(&self.buttons).filter(|request| *request != Request::Enter) {
                    self.grant(events, marked);
                }
            }
            Request::Nothing => {}
            Request::Louder(steps) => self.wish(|wishes| wishes.louder += steps),
            Request::Mute => self.wish(|wishes| wishes.mutes += 1),
            Request::Night => self.wish(|wishes| wishes.nights += 1),
            Request::Open => self.open_early(),
            Request::ToggleStaff => {
                self.staff.toggle();
                self.visitor.let_go();
            }
        }
    }

    /// Tells the simulation what the visitor does.
    pub(super) fn tell(&mut self) {
        let lifts = self.visitor.lifts();
        let Some(show) = &self.show else { return };
        let mut controls = show.live.controls();
        controls.aim = self.visitor.aim();
        controls.stick = self.visitor.stick().map(|tilt| tilt * self.config.controllers.stick_speed);
        controls.hold = self.visitor.holds_key();
        controls.presses.clear();
        controls.presses.extend(self.visitor.presses());
        controls.lifts.extend(lifts);
        controls.keyed = self.visitor.keyed();
        controls.press_once = self.needs.once() && !self.menu.open;
        (controls.calm, controls.round) = (self.needs.calm, self.needs.round);
        controls.activity = self.visitor.activity();
        controls.deaf = !self.listens;
        controls.closed = !self.house.is_open();
        controls.inert = !self.house.hears(self.clock.seconds(Instant::now()));
    }

    /// Asks something of the loudness.
    pub(super) fn wish(&self, change: impl FnOnce(&mut Wishes)) {
        if let Some(show) = &self.show {
            change(&mut show.live.controls().loudness);
        }
    }

    pub(super) fn command(&self, command: Command) {
        if let Some(show) = &self.show {
            show.live.controls().commands.push(command);
        }
    }
}

//! The window's part in what is asked of the kiosk: by a button, a key or a switch; and what the simulation is told of it.

use winit::event_loop::ActiveEventLoop;

use super::app::App;
use crate::step::command::KioskCommand;
use crate::venue::loudness::Wishes;
use crate::visitor::input::Request;

impl App<'_> {
    /// Does what is asked for.
    pub(super) fn grant(&mut self, events: &ActiveEventLoop, request: Request) {
        match request {
            Request::Close => events.exit(),
            Request::Language(index) => self.overlaid.languages.choose(index),
            Request::NextLanguage => self.overlaid.languages.next(),
            Request::Menu => {
                self.overlaid.menu.toggle();
                self.visit.visitor.let_go();
            }
            Request::Work(index) => {
                self.works.show_at(index);
                self.overlaid.menu.open = false;
            }
            Request::Leaf(by) if self.overlaid.menu.open => self.overlaid.menu.turn_page(by),
            Request::Leaf(by) => {
                self.leaf(by);
            }
            Request::Large => self.visit.needs.reading.large ^= true,
            Request::Contrast => self.visit.needs.reading.contrast ^= true,
            Request::Listen => self.visit.listens ^= true,
            Request::PressOnce | Request::Dwell | Request::Calm | Request::Round | Request::Speak => {
                self.choose(request);
            }
            Request::Look(way) => self.overlaid.look(way),
            Request::Enter => {
                if let Some(marked) = self.overlaid.marked().filter(|request| *request != Request::Enter) {
                    self.grant(events, marked);
                }
            }
            Request::Nothing => {}
            Request::Louder(steps) => self.wish(Wishes { louder: steps, ..Wishes::default() }),
            Request::Mute => self.wish(Wishes { mutes: 1, ..Wishes::default() }),
            Request::Night => self.wish(Wishes { nights: 1, ..Wishes::default() }),
            Request::Open => self.open_early(),
            Request::ToggleStaff => {
                self.desk.panel.toggle();
                self.visit.visitor.let_go();
            }
        }
    }

    /// Tells the simulation what the visitor does, and whether the house lets it.
    pub(super) fn tell(&mut self) {
        let Some(show) = &self.show else { return drop(self.visit.visitor.lifts()) };
        let mut inbox = show.live.inbox();
        self.visit.tell(&mut inbox, &self.setup.config, self.overlaid.menu.open);
        inbox.controls.closed = !self.house.is_open();
        inbox.controls.inert = !self.house.hears(self.pacing.time());
    }

    /// Asks something of the loudness.
    pub(super) fn wish(&self, wishes: Wishes) {
        self.send(KioskCommand::Loudness(wishes));
    }

    /// Sends a command to the simulation, where there is one.
    pub(super) fn send(&self, command: KioskCommand) {
        if let Some(show) = &self.show {
            show.live.send(command);
        }
    }
}

//! Handles requests of buttons, keys and switches, and sends the controls to the simulation.

use winit::event_loop::ActiveEventLoop;

use super::app::App;
use crate::step::command::KioskCommand;
use crate::venue::loudness::VolumeRequests;
use crate::visitor::input::Request;

impl App<'_> {
    /// Handles a request.
    pub(super) fn handle_request(&mut self, events: &ActiveEventLoop, request: Request) {
        match request {
            Request::Close => events.exit(),
            Request::Language(index) => self.overlays.languages.choose(index),
            Request::NextLanguage => self.overlays.languages.next(),
            Request::Menu => {
                self.overlays.menu.toggle();
                self.visit.visitor.release_all();
            }
            Request::Exhibit(index) => {
                self.exhibits.show_at(index);
                self.overlays.menu.open = false;
            }
            Request::Page(by) if self.overlays.menu.open => self.overlays.menu.turn_page(by),
            Request::Page(by) => {
                self.show_neighbour(by);
            }
            Request::Large => self.visit.accessibility.text.large ^= true,
            Request::Contrast => self.visit.accessibility.text.contrast ^= true,
            Request::ToggleMicrophone => self.visit.microphone_on ^= true,
            Request::PressOnce | Request::Dwell | Request::ReducedMotion | Request::LookAround | Request::ReadAloud => {
                self.choose(request);
            }
            Request::MoveFocus(direction) => self.overlays.move_focus(direction),
            Request::PressFocused => {
                if let Some(marked) = self.overlays.marked().filter(|request| *request != Request::PressFocused) {
                    self.handle_request(events, marked);
                }
            }
            Request::Nothing => {}
            Request::Louder(steps) => {
                self.request_volume(VolumeRequests { louder: steps, ..VolumeRequests::default() })
            }
            Request::Mute => self.request_volume(VolumeRequests { mutes: 1, ..VolumeRequests::default() }),
            Request::Night => self.request_volume(VolumeRequests { nights: 1, ..VolumeRequests::default() }),
            Request::Open => self.open_early(),
            Request::ToggleStaff => {
                self.desk.panel.toggle();
                self.visit.visitor.release_all();
            }
        }
    }

    /// Sends the visitor's input to the simulation, and whether it is accepted now.
    pub(super) fn send_controls(&mut self) {
        let Some(show) = &self.show else { return drop(self.visit.visitor.lifts()) };
        let mut inbox = show.live.inbox();
        self.visit.write_controls(&mut inbox, &self.setup.config, self.overlays.menu.open);
        inbox.controls.closed = !self.venue.is_open();
        inbox.controls.inert = !self.venue.accepts_input(self.pacing.time());
    }

    /// Sends requests about the loudness.
    pub(super) fn request_volume(&self, requests: VolumeRequests) {
        self.send(KioskCommand::Loudness(requests));
    }

    /// Sends a command to the simulation, where there is one.
    pub(super) fn send(&self, command: KioskCommand) {
        if let Some(show) = &self.show {
            show.live.send(command);
        }
    }
}

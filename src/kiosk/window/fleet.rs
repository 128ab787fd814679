//! The window's part in what outlives it: how a new run goes on where the last one was, what is counted meanwhile, what
//! is ordered from afar.

use std::time::Instant;

use super::app::App;
use crate::fleet::mqtt::Order;
use crate::fleet::{SAFE_MODE, Seen};
use crate::live::Frame;
use crate::venue::loudness::Wishes;

impl App<'_> {
    /// Goes on as the run before left it.
    pub(super) fn go_on(&mut self) {
        let (wrong, blank) = (self.fleet.kept().wrong_pins, self.fleet.kept().blank);
        self.desk.panel.gate().remember(wrong, self.pacing.time());
        self.house.make_blank(blank);
        self.fleet.read_anew(self.setup.says.is_empty(), None);
        if self.fleet.is_safe() {
            self.say(SAFE_MODE.into());
            self.setup.says.push(SAFE_MODE.into());
        }
    }

    /// Counts, keeps and tells; does what is ordered.
    pub(super) fn follow_fleet(&mut self) {
        let Some(show) = &self.show else { return };
        let now = Instant::now();
        if self.graphics.loses_device(self.pacing.clock.seconds(now)) {
            tracing::warn!("the graphics device is destroyed, as asked for");
            show.screen.destroy_device();
        }
        let frame = show.live.frame();
        let seen = Seen {
            frame: &frame,
            site: &self.setup.config,
            house: &self.house,
            given: &self.visit.given,
            language: &self.overlaid.languages.shown,
            activity: self.visit.visitor.activity(),
            wrong_pins: self.desk.panel.gate().wrong(),
        };
        self.fleet.tend(now, &seen);
        while let Some(order) = self.fleet.order() {
            self.obey(order, &frame);
        }
    }

    fn obey(&mut self, order: Order, frame: &Frame) {
        match order {
            Order::Reload => self.works.shelf.show(&frame.exhibit.folder),
            Order::Blank | Order::Wake => {
                let open = self.house.is_open();
                self.house.make_blank(order == Order::Blank);
                self.tell_house(open);
            }
            Order::Mute(mute) => self.wish(Wishes { muted: Some(mute), ..Wishes::default() }),
            Order::Exhibit(id) => {
                if !self.works.show(&id) {
                    self.say(format!("no work \"{id}\" is offered here"));
                }
            }
        }
    }
}

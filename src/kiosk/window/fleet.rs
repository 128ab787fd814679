//! The window's part in what outlives it: how a new run goes on where the last one was, what is counted meanwhile, what
//! is ordered from afar.

use std::time::Instant;

use super::App;
use crate::fleet::mqtt::Order;
use crate::fleet::{SAFE_MODE, Seen};
use crate::live::Frame;

impl App<'_> {
    /// Goes on as the run before left it.
    pub(super) fn go_on(&mut self) {
        let (wrong, blank) = (self.fleet.kept().wrong_pins, self.fleet.kept().blank);
        self.staff.gate().remember(wrong, self.clock.seconds(Instant::now()));
        self.house.make_blank(blank);
        self.fleet.read_anew(self.site_says.is_empty(), None);
        if self.fleet.is_safe() {
            self.say(SAFE_MODE.into());
            self.site_says.push(SAFE_MODE.into());
        }
    }

    /// Counts, keeps and tells; does what is ordered.
    pub(super) fn follow_fleet(&mut self) {
        let Some(show) = &self.show else { return };
        let now = Instant::now();
        if self.lose_device_at.is_some_and(|at| self.clock.seconds(now) >= at) {
            self.lose_device_at = None;
            tracing::warn!("the graphics device is destroyed, as asked for");
            show.screen.destroy_device();
        }
        let frame = show.live.frame();
        let seen = Seen {
            frame: &frame,
            site: &self.config,
            house: &self.house,
            given: &self.given,
            language: &self.language,
            activity: self.visitor.activity(),
            wrong_pins: self.staff.gate().wrong(),
        };
        self.fleet.tend(now, &seen);
        while let Some(order) = self.fleet.order() {
            self.obey(order, &frame);
        }
    }

    fn obey(&mut self, order: Order, frame: &Frame) {
        match order {
            Order::Reload => self.shelf.show(&frame.exhibit.folder),
            Order::Blank | Order::Wake => {
                let open = self.house.is_open();
                self.house.make_blank(order == Order::Blank);
                self.tell_house(open);
            }
            Order::Mute(mute) if mute != frame.load.loudness.muted => self.wish(|wishes| wishes.mutes = 1),
            Order::Mute(_) => {}
            Order::Exhibit(id) => match self.offer.works().iter().find(|work| work.id == id) {
                Some(work) => self.shelf.show(&work.folder),
                None => self.say(format!("no work \"{id}\" is offered here")),
            },
        }
    }
}

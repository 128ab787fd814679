//! Persisted state, counters, and commands of a broker.

use std::time::Instant;

use super::app::App;
use crate::fleet::WindowStatus;
use crate::fleet::orders::Order;
use crate::live::LiveState;
use crate::venue::loudness::VolumeRequests;

impl App<'_> {
    /// Restores the state of the run before.
    pub(super) fn restore_state(&mut self) {
        let (wrong, blank) = (self.fleet.persisted().wrong_pins, self.fleet.persisted().blank);
        self.desk.panel.gate().remember(wrong, self.pacing.time());
        self.venue.set_blank(blank);
        self.fleet.record_reload(self.setup.problems.is_empty(), None);
        for problem in self.fleet.problems() {
            self.say(problem.clone());
            self.setup.problems.push(problem);
        }
        self.setup.problems.append(&mut self.setup.warnings);
    }

    /// Counts, stores and reports; carries out commands.
    pub(super) fn update_fleet(&mut self) {
        let Some(show) = &self.show else { return };
        let now = Instant::now();
        if self.graphics.loses_device(self.pacing.clock.seconds(now)) {
            tracing::warn!("the graphics device is destroyed, as requested");
            show.screen.destroy_device();
        }
        let frame = show.live.frame();
        let seen = WindowStatus {
            frame: &frame,
            site: &self.setup.config,
            venue: &self.venue,
            breath_time: &self.visit.breath_time,
            language: &self.overlays.languages.shown,
            activity: self.visit.visitor.activity(),
            wrong_pins: self.desk.panel.gate().wrong(),
            dropped_lines: self.desk.log.dropped(),
        };
        self.fleet.update(now, &seen);
        // One in each turn of the loop, so that pictures, signals and the visitor come first.
        if let Some(order) = self.fleet.order(now) {
            self.obey(order, &frame);
        }
    }

    fn obey(&mut self, order: Order, frame: &LiveState) {
        match order {
            Order::Reload => self.exhibits.request(&frame.exhibit.folder),
            Order::Blank | Order::Wake => {
                let open = self.venue.is_open();
                self.venue.set_blank(order == Order::Blank);
                self.announce_open_state(open);
            }
            Order::Mute(mute) => self.request_volume(VolumeRequests { muted: Some(mute), ..VolumeRequests::default() }),
            Order::Exhibit(id) => {
                if !self.exhibits.show(&id) {
                    self.say(format!("no exhibit \"{id}\" is offered here"));
                }
            }
        }
    }
}

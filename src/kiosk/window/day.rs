//! The window's part in a day of the house: opening hours, cleaning, the configuration that changes, what staff ask for.

use std::time::Instant;

use jiff::{ToSpan, Zoned};
use winit::event_loop::ActiveEventLoop;

use super::App;
use crate::fleet::SAFE_MODE;
use crate::live::Frame;
use crate::staff::Wish;
use crate::venue::shelf::{Places, folders, id};
use crate::venue::site::{News, Site, waits_for_restart};
use crate::visitor::input::Request;
use soffio_config::{Day, TimeOfDay};
use soffio_simulation::Command;

impl App<'_> {
    /// Opens and closes by the hours.
    pub(super) fn follow_hours(&mut self) {
        let before = self.house.is_open();
        let now = Zoned::now();
        let yesterday = now.date().checked_sub(1.day()).unwrap_or(now.date());
        let minutes = 60 * u16::from(now.hour().unsigned_abs()) + u16::from(now.minute().unsigned_abs());
        let time = TimeOfDay::from_minutes(minutes);
        let days = [day(now.date()), day(yesterday)];
        self.house.look(&self.config.opening, days[0], days[1], time);
        self.tell_house(before);
        if self.fleet.chirp_is_due(self.config.care.chirp_at, days, time, self.house.is_open()) {
            self.chirp();
        }
    }

    /// The loudspeaker chirps to the microphone, to find out how both are.
    fn chirp(&mut self) {
        if let Some(show) = &self.show {
            show.live.controls().chirp = true;
            tracing::info!("the loudspeaker chirps to the microphone");
        }
    }

    /// Staff open the kiosk while the house is closed, or close it again.
    pub(super) fn open_early(&mut self) {
        let before = self.house.is_open();
        self.house.open_early();
        self.tell_house(before);
    }

    /// The simulation hears of what has changed: the doors, or the end of a cleaning.
    pub(super) fn tell_house(&mut self, was_open: bool) {
        let open = self.house.is_open();
        if open != was_open {
            self.visitor.let_go();
            self.menu = Default::default();
            self.say(
                if open { "the house is open" } else { "the house is closed: black, mute, the microphone closed" }
                    .into(),
            );
        }
        self.tell();
    }

    /// Takes over a changed configuration; a broken one is refused.
    pub(super) fn follow_site(&mut self) {
        while let Some(news) = self.site.as_ref().and_then(|site| site.news()) {
            let mut config = match news {
                News::Good(config) => self.overrides.apply(*config),
                News::Bad(problems) => {
                    self.fleet.read_anew(false, None);
                    self.say(format!("{problems}\nThe last good configuration stays."));
                    self.site_says = vec![problems];
                    continue;
                }
            };
            self.fleet.read_anew(true, self.site.as_ref().map(|site| site.path.as_path()));
            let mended = !self.site_says.is_empty();
            self.site_says.clear();
            self.site_says.extend(self.fleet.is_safe().then(|| SAFE_MODE.into()));
            let waits = waits_for_restart(&self.config, &config);
            if !waits.is_empty() {
                let says = format!("{}: from the next start on", waits.join(", "));
                tracing::warn!("{says}");
                self.site_says.push(says);
            }
            config.screen.fullscreen = self.config.screen.fullscreen;
            let (old, new) = (&self.config.exhibits, &mut config.exhibits);
            (new.folder, new.hot_reload) = (old.folder.clone(), old.hot_reload);
            if config == self.config {
                if mended {
                    self.say("the configuration is good again".into());
                }
                continue;
            }
            let reordered = config.exhibits.show != self.config.exhibits.show;
            self.fleet.settle(&self.config, &config);
            let visit = config.visit != self.config.visit;
            self.config = config;
            if visit {
                self.forget_needs();
            }
            if reordered && !self.one {
                self.reorder();
            }
            if let Some(show) = &self.show {
                show.live.controls().site = Some(Box::new(Site::new(&self.config, self.seed)));
            }
            self.say("the changed configuration is taken over".into());
        }
    }

    /// Offers the works in the configuration's order; those that were not offered are looked at.
    fn reorder(&mut self) {
        let site = &self.config.exhibits;
        self.offer.reorder(&site.show);
        let places = Places::All { folder: site.folder.clone(), show: site.show.clone() };
        for folder in folders(&places) {
            if !self.offer.works().iter().any(|work| work.id == id(&folder)) {
                self.shelf.look(&folder);
            }
        }
    }

    /// Does what staff ask for.
    pub(super) fn fulfil(&mut self, events: &ActiveEventLoop, wish: Wish, frame: &Frame) {
        match wish {
            Wish::Close => events.exit(),
            Wish::Reload => self.shelf.show(&frame.exhibit.folder),
            Wish::Reset => self.command(Command::Reset),
            Wish::Mute => self.grant(events, Request::Mute),
            Wish::Night => self.grant(events, Request::Night),
            Wish::Open => self.open_early(),
            Wish::Clean => {
                self.staff.toggle();
                self.menu = Default::default();
                self.visitor.let_go();
                self.house.clean(self.clock.seconds(Instant::now()));
                tracing::info!("all input is off: the glass is cleaned");
                self.tell();
            }
            Wish::Chirp => self.chirp(),
            Wish::FoamChanged => {
                let (care, breaths) = self.fleet.care();
                let had = care.foam(breaths);
                care.change_foam(breaths);
                self.say(format!("a new foam; the old one had {had} breaths"));
            }
            Wish::ListenAnew => {
                self.fleet.care().0.listen_anew();
                self.chirp();
            }
            Wish::Show(id) => {
                if let Some(work) = self.offer.works().iter().find(|work| work.id == id) {
                    self.shelf.show(&work.folder);
                }
            }
            Wish::Try(trial) => {
                if let Some(show) = &self.show {
                    show.live.controls().trials.push(trial);
                }
            }
        }
    }
}

/// A day as the configuration knows it.
fn day(date: jiff::civil::Date) -> Day {
    let part = |number: i8| number.unsigned_abs();
    let weekday = part(date.weekday().to_monday_zero_offset());
    Day { year: date.year(), month: part(date.month()), day: part(date.day()), weekday }
}

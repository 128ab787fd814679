//! The window's part in a day of the house: opening hours, cleaning, the configuration that changes, what staff ask for.

use jiff::{ToSpan, Zoned};
use winit::event_loop::ActiveEventLoop;

use super::app::App;
use crate::live::Frame;
use crate::staff::Wish;
use crate::step::command::KioskCommand;
use crate::venue::site::News;
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
        self.house.look(&self.setup.config.opening, days[0], days[1], time);
        self.tell_house(before);
        if self.fleet.chirp_is_due(self.setup.config.care.chirp_at, days, time, self.house.is_open()) {
            self.chirp();
        }
    }

    /// The loudspeaker chirps to the microphone, to find out how both are.
    fn chirp(&mut self) {
        if self.show.is_some() {
            self.send(KioskCommand::Chirp);
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
            self.visit.visitor.let_go();
            self.overlaid.menu.close();
            self.say(
                if open { "the house is open" } else { "the house is closed: black, mute, the microphone closed" }
                    .into(),
            );
        }
        self.tell();
    }

    /// Takes over a changed configuration; a broken one is refused.
    pub(super) fn follow_site(&mut self) {
        while let Some(news) = self.setup.news() {
            let config = match news {
                News::Good(config) => self.setup.overrides.apply(*config),
                News::Bad(problems) => {
                    self.fleet.read_anew(false, None);
                    self.say(format!("{problems}\nThe last good configuration stays."));
                    self.setup.says = vec![problems];
                    continue;
                }
            };
            self.fleet.read_anew(true, self.setup.file.as_ref().map(|file| file.path.as_path()));
            let change = match self.setup.take_over(config, self.fleet.is_safe()) {
                Ok(change) => change,
                Err(mended) => {
                    if mended {
                        self.say("the configuration is good again".into());
                    }
                    continue;
                }
            };
            self.fleet.settle(&change.before, &self.setup.config);
            if change.visit {
                self.forget_needs();
            }
            if change.reordered {
                self.works.reorder(&self.setup.config);
            }
            self.send(KioskCommand::Site(Box::new(self.setup.site())));
            self.say("the changed configuration is taken over".into());
        }
    }

    /// Does what staff ask for.
    pub(super) fn fulfil(&mut self, events: &ActiveEventLoop, wish: Wish, frame: &Frame) {
        match wish {
            Wish::Close => events.exit(),
            Wish::Reload => self.works.shelf.show(&frame.exhibit.folder),
            Wish::Reset => self.send(KioskCommand::Simulation(Command::Reset)),
            Wish::Mute => self.grant(events, Request::Mute),
            Wish::Night => self.grant(events, Request::Night),
            Wish::Open => self.open_early(),
            Wish::Clean => {
                self.desk.panel.toggle();
                self.overlaid.menu.close();
                self.visit.visitor.let_go();
                self.house.clean(self.pacing.time(), self.setup.config.care.cleaning_s);
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
                self.works.show(&id);
            }
            Wish::Try(trial) => self.send(KioskCommand::Try(trial)),
        }
    }
}

/// A day as the configuration knows it.
fn day(date: jiff::civil::Date) -> Day {
    let part = |number: i8| number.unsigned_abs();
    let weekday = part(date.weekday().to_monday_zero_offset());
    Day { year: date.year(), month: part(date.month()), day: part(date.day()), weekday }
}

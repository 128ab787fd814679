//! Opening hours, cleaning, changes of the configuration, and actions of staff.

use jiff::{ToSpan, Zoned};
use winit::event_loop::ActiveEventLoop;

use super::app::App;
use crate::fleet::LocalTime;
use crate::live::LiveState;
use crate::staff::StaffAction;
use crate::step::command::KioskCommand;
use crate::venue::site::ConfigEvent;
use crate::visitor::input::Request;
use soffio_config::{Day, TimeOfDay};
use soffio_simulation::Command;

impl App<'_> {
    /// Opens and closes by the hours, and starts the daily self-test.
    pub(super) fn update_hours(&mut self) {
        let before = self.venue.is_open();
        let now = Zoned::now();
        let yesterday = now.date().checked_sub(1.day()).unwrap_or(now.date());
        let minutes = 60 * u16::from(now.hour().unsigned_abs()) + u16::from(now.minute().unsigned_abs());
        let time = TimeOfDay::from_minutes(minutes);
        let now = LocalTime { today: day(now.date()), yesterday: day(yesterday), time };
        self.venue.update_schedule(&self.setup.config.opening, now.today, now.yesterday, time);
        self.announce_open_state(before);
        let at = self.setup.config.maintenance.audio_self_test_at;
        if self.fleet.self_test_is_due(at, now, self.venue.is_open()) {
            self.start_self_test();
        }
    }

    /// Starts the audio self-test.
    fn start_self_test(&mut self) {
        if self.show.is_some() {
            self.send(KioskCommand::SelfTest);
            tracing::info!("audio self-test: the loudspeaker plays a sweep");
        }
    }

    /// Staff open the kiosk outside opening hours, or close it again.
    pub(super) fn open_early(&mut self) {
        let before = self.venue.is_open();
        self.venue.open_early();
        self.announce_open_state(before);
    }

    /// Sends a changed state of the venue to the simulation, and reports an opening or closing.
    pub(super) fn announce_open_state(&mut self, was_open: bool) {
        let open = self.venue.is_open();
        if open != was_open {
            self.visit.visitor.release_all();
            self.overlays.menu.close();
            self.say(
                if open {
                    "the venue is open"
                } else {
                    "the venue is closed: black screen, no sound, the microphone off"
                }
                .into(),
            );
        }
        self.send_controls();
    }

    /// Takes over a changed configuration; an invalid one is rejected.
    pub(super) fn update_config(&mut self) {
        while let Some(event) = self.setup.next_event() {
            let loaded = match event {
                ConfigEvent::Loaded(loaded) => *loaded,
                ConfigEvent::Rejected(problems) => {
                    self.fleet.record_reload(false, None);
                    self.say(format!("{problems}\nThe last valid configuration stays."));
                    self.setup.problems = vec![problems];
                    continue;
                }
            };
            self.fleet.record_reload(true, self.setup.file.as_ref().map(|file| file.path.as_path()));
            let change = match self.setup.take_over(loaded, self.fleet.problems()) {
                Ok(change) => change,
                Err(was_broken) => {
                    if was_broken {
                        self.say("the configuration is valid again".into());
                    }
                    continue;
                }
            };
            self.fleet.reconfigure(&change.before, &self.setup.config);
            if change.visit {
                self.reset_accessibility();
            }
            if change.reordered {
                self.exhibits.reorder(&self.setup.config, &self.fleet.persisted().quarantine);
            }
            self.send(KioskCommand::Site(Box::new(self.setup.site())));
            self.say("the changed configuration is taken over".into());
        }
    }

    /// Carries out an action of staff.
    pub(super) fn apply_staff_action(&mut self, events: &ActiveEventLoop, action: StaffAction, frame: &LiveState) {
        match action {
            StaffAction::Close => events.exit(),
            StaffAction::Reload => self.exhibits.request(&frame.exhibit.folder),
            StaffAction::Reset => self.send(KioskCommand::Simulation(Command::Reset)),
            StaffAction::Mute => self.handle_request(events, Request::Mute),
            StaffAction::Night => self.handle_request(events, Request::Night),
            StaffAction::Open => self.open_early(),
            StaffAction::Clean => {
                self.desk.panel.toggle();
                self.overlays.menu.close();
                self.visit.visitor.release_all();
                self.venue.start_cleaning(self.pacing.time(), self.setup.config.maintenance.cleaning_s);
                tracing::info!("all input is off: the screen is cleaned");
                self.send_controls();
            }
            StaffAction::SelfTest => self.start_self_test(),
            StaffAction::FoamChanged => {
                let breaths = self.fleet.breaths();
                let history = self.fleet.self_test();
                let had = history.foam_breaths(breaths);
                history.change_foam(breaths);
                self.say(format!("the foam was changed; the old one had {had} breaths"));
            }
            StaffAction::ResetSelfTest => {
                self.fleet.self_test().forget_reference();
                self.start_self_test();
            }
            StaffAction::Show(id) => {
                self.exhibits.show(&id);
            }
            StaffAction::PlaySound(audition) => self.send(KioskCommand::PlaySound(audition)),
        }
    }
}

/// A date in the type of the configuration.
fn day(date: jiff::civil::Date) -> Day {
    let part = |number: i8| number.unsigned_abs();
    let weekday = part(date.weekday().to_monday_zero_offset());
    Day { year: date.year(), month: part(date.month()), day: part(date.day()), weekday }
}

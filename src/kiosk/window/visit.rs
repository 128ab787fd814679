//! Reading aloud, accessibility settings, dwell clicking and swipes of a visit.

use winit::event_loop::ActiveEventLoop;

use super::app::App;
use crate::live::LiveState;
use crate::pages::read_aloud::keeps_reading;
use crate::step::command::KioskCommand;
use crate::visitor::accessibility::AccessibilitySettings;
use crate::visitor::dwell::Target;
use crate::visitor::input::{Request, Signal};
use soffio_devices::audio::{DeviceState, Utterance};

impl App<'_> {
    /// Updates reading aloud and swipes, once a frame.
    pub(super) fn update_visit(&mut self, frame: &LiveState) {
        self.overlays.aloud.configure(&self.setup.config.visit.read_aloud);
        let made = self.overlays.aloud.update(frame.speaks);
        self.play_speech(made);
        // A visitor who listens is present.
        if frame.speaks {
            self.visit.visitor.count_input();
            self.send_controls();
        }
        // A breath ends the reading.
        if frame.current.breath.estimate.speed > 0.0 {
            let silence = self.overlays.aloud.stop();
            self.play_speech(silence);
        }
        if frame.attracts || !self.venue.is_open() {
            let silence = self.overlays.aloud.end_visit();
            self.play_speech(silence);
        }
        match self.exhibits.swiped(frame.swipes) {
            0 => {}
            by => {
                self.show_neighbour(by);
            }
        }
    }

    /// Dwell clicking: presses where the pointer rests.
    pub(super) fn update_dwell(&mut self, events: &ActiveEventLoop, time: f64, points: egui::Rect) {
        let hears = self.visit.accessibility.dwell && self.venue.accepts_input(time) && !self.desk.panel.is_open();
        let pointer = self.visit.visitor.resting_pointer().filter(|_| hears).map(|[x, y]| {
            let below = self.overlays.button_at(points.lerp_inside(egui::vec2(x as f32, y as f32)));
            let on = match below {
                Some(Request::Nothing) => None,
                Some(request) => Some(Target::Button(request)),
                None => Some(Target::Exhibit),
            };
            ([x, y], on)
        });
        let aspect = f64::from(points.width() / points.height());
        match self.visit.dwell.update(time, pointer, self.setup.config.visit.dwell_s, aspect) {
            Some(Target::Button(request)) => {
                self.visit.visitor.count_input();
                self.handle_request(events, request);
            }
            Some(Target::Exhibit) => self.visit.visitor.tap(pointer.map_or([0.5, 0.5], |(at, _)| at)),
            None => return,
        }
        self.send_controls();
    }

    /// Resets the accessibility settings to those of the site.
    pub(super) fn reset_accessibility(&mut self) {
        self.visit.accessibility = AccessibilitySettings::of(&self.setup.config.visit);
    }

    /// Ends the reading at a touch or key, unless it concerns the reading itself.
    pub(super) fn stop_reading_on(&mut self, signal: &Signal, request: Option<Request>) {
        let touches = self.visit.visitor.press_position(signal).is_some();
        let types = matches!(signal, Signal::Key(key) if key.pressed && !key.repeat);
        // Enter stands for the focused button.
        let means = match request {
            Some(Request::PressFocused) => self.overlays.marked(),
            request => request,
        };
        if (touches || types) && !keeps_reading(means) {
            let silence = self.overlays.aloud.stop();
            self.play_speech(silence);
        }
    }

    /// Changes an accessibility setting of this visit.
    pub(super) fn choose(&mut self, request: Request) {
        match request {
            Request::PressOnce => self.visit.accessibility.press_once ^= true,
            Request::Dwell => self.visit.accessibility.dwell ^= true,
            Request::ReducedMotion => self.visit.accessibility.reduced_motion ^= true,
            Request::LookAround => {
                self.visit.accessibility.look_around ^= true;
                // The page closes, so that the exhibit is visible.
                self.overlays.menu.open = false;
                self.visit.visitor.release_all();
            }
            Request::ReadAloud => {
                let silence = self.overlays.aloud.toggle();
                self.play_speech(silence);
            }
            _ => {}
        }
    }

    fn play_speech(&self, speech: Option<Utterance>) {
        if let Some(speech) = speech {
            self.send(KioskCommand::PlaySpeech(speech));
        }
    }
}

/// Sample rate of the output, Hz; `None` without one.
pub(super) fn rate(frame: &LiveState) -> Option<u32> {
    match frame.load.audio.output {
        DeviceState::Ok { sample_rate, .. } => Some(sample_rate),
        _ => None,
    }
}

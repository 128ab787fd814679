//! The window's part in what a visitor needs otherwise: reading aloud, choices for this visit, works that are swiped to.

use winit::event_loop::ActiveEventLoop;

use super::app::App;
use crate::live::Frame;
use crate::pages::read_aloud::keeps_reading;
use crate::step::command::KioskCommand;
use crate::visitor::dwell::Target;
use crate::visitor::input::{Request, Signal};
use crate::visitor::needs::Needs;
use soffio_devices::audio::{DeviceState, Words};

impl App<'_> {
    /// Looks on, once a picture.
    pub(super) fn follow_visit(&mut self, frame: &Frame) {
        self.overlaid.aloud.configure(&self.setup.config.visit.reads_aloud);
        let made = self.overlaid.aloud.update(frame.speaks);
        self.utter(made);
        // Whoever listens is there.
        if frame.speaks {
            self.visit.visitor.note();
            self.tell();
        }
        // Whoever blows wants the sculpture.
        if frame.current.breath.estimate.speed > 0.0 {
            let hush = self.overlaid.aloud.stop();
            self.utter(hush);
        }
        if frame.attracts || !self.house.is_open() {
            let hush = self.overlaid.aloud.end_visit();
            self.utter(hush);
        }
        match self.works.swiped(frame.turned) {
            0 => {}
            by => {
                self.leaf(by);
            }
        }
    }

    /// Presses where the pointer rests, for whoever chose that.
    pub(super) fn follow_rest(&mut self, events: &ActiveEventLoop, time: f64, points: egui::Rect) {
        let hears = self.visit.needs.dwell && self.house.hears(time) && !self.desk.panel.is_open();
        let pointer = self.visit.visitor.rests().filter(|_| hears).map(|[x, y]| {
            let below = self.overlaid.button_at(points.lerp_inside(egui::vec2(x as f32, y as f32)));
            let on = match below {
                Some(Request::Nothing) => None,
                Some(request) => Some(Target::Button(request)),
                None => Some(Target::Work),
            };
            ([x, y], on)
        });
        let aspect = f64::from(points.width() / points.height());
        match self.visit.dwell.tend(time, pointer, self.setup.config.visit.dwell_s, aspect) {
            Some(Target::Button(request)) => {
                self.visit.visitor.note();
                self.grant(events, request);
            }
            Some(Target::Work) => self.visit.visitor.tap(pointer.map_or([0.5, 0.5], |(at, _)| at)),
            None => return,
        }
        self.tell();
    }

    /// The next visitor finds what the site says.
    pub(super) fn forget_needs(&mut self) {
        self.visit.needs = Needs::of(&self.setup.config.visit);
    }

    /// A touch or a key ends the reading, unless it is about the reading itself.
    pub(super) fn hush_at(&mut self, signal: &Signal, request: Option<Request>) {
        let touches = self.visit.visitor.press_position(signal).is_some();
        let types = matches!(signal, Signal::Key(key) if key.pressed && !key.repeat);
        // Enter is whatever the marked button is.
        let means = match request {
            Some(Request::Enter) => self.overlaid.marked(),
            request => request,
        };
        if (touches || types) && !keeps_reading(means) {
            let hush = self.overlaid.aloud.stop();
            self.utter(hush);
        }
    }

    /// What a visitor chooses for this visit.
    pub(super) fn choose(&mut self, request: Request) {
        match request {
            Request::PressOnce => self.visit.needs.press_once ^= true,
            Request::Dwell => self.visit.needs.dwell ^= true,
            Request::Calm => self.visit.needs.calm ^= true,
            Request::Round => {
                self.visit.needs.round ^= true;
                // Whoever wants to look round wants to see the work.
                self.overlaid.menu.open = false;
                self.visit.visitor.let_go();
            }
            Request::Speak => {
                let hush = self.overlaid.aloud.toggle();
                self.utter(hush);
            }
            _ => {}
        }
    }

    fn utter(&self, words: Option<Words>) {
        if let Some(words) = words {
            self.send(KioskCommand::Say(words));
        }
    }
}

/// Rate of the loudspeaker, Hz; `None` without one.
pub(super) fn rate(frame: &Frame) -> Option<u32> {
    match frame.load.audio.output {
        DeviceState::Ok { sample_rate, .. } => Some(sample_rate),
        _ => None,
    }
}

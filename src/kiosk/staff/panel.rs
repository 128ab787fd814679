//! The panel itself: the gate before its pages, their tabs, and what each page remembers.

use egui::{Ui, vec2};

use crate::pages::canvas::INK;
use crate::staff::edit::Changes;
use crate::staff::gate::Gate;
use crate::staff::pages::style::{BAD, width};
use crate::staff::pages::{Page, bodies, exhibits, keypad, log, microphone, parameters, sound, status, test, wind};
use crate::staff::sight::Sight;
use crate::staff::wish::Wish;
use crate::visitor::input::{Phase, Signal};
use soffio_config::Config;
use soffio_simulation::InspectionScope;

/// How long a message stays in the corner of a desk, s.
const TOAST_S: f64 = 10.0;
/// Height of what staff press, mm: half of a visitor's button, for a practised finger.
const PRESS_MM: f32 = 9.0;

/// What may not be pressed is paler, and can be read all the same.
const PALER: f32 = 0.87;

/// The panel and what its pages remember.
#[derive(Default)]
pub struct Staff {
    open: bool,
    page: Page,
    gate: Gate,
    /// Its share of the picture's width.
    share: f32,
    /// Inputs that were seen, and when the last one came, s.
    touched: (u64, f64),
    toast: Option<(f64, String)>,
    /// What became of the last change.
    said: Option<String>,
    changes: Changes,
    exhibits: exhibits::Exhibits,
    bodies: bodies::Bodies,
    sound: sound::Sound,
    parameters: parameters::Parameters,
    microphone: microphone::Microphone,
    test: test::Test,
    log: log::LogPage,
}

impl Staff {
    /// Opens the panel, or closes it and shuts its gate.
    pub fn toggle(&mut self) {
        let open = !self.open;
        self.close();
        self.open = open;
    }

    fn close(&mut self) {
        self.open = false;
        self.touched = (0, f64::NEG_INFINITY);
        self.gate.shut();
        self.said = None;
        self.test.end();
    }

    /// Is it open?
    pub fn is_open(&self) -> bool {
        self.open
    }

    /// Opens a page.
    pub fn turn_to(&mut self, page: Page) {
        self.page = page;
        self.said = None;
    }

    /// The way in.
    pub fn gate(&mut self) -> &mut Gate {
        &mut self.gate
    }

    /// What the open page looks at.
    pub fn look(&self, site: &Config) -> InspectionScope {
        match self.page {
            _ if !self.open || site.staff.pin.is_set() && !self.gate.is_open() => InspectionScope::Nothing,
            Page::Bodies => InspectionScope::Bodies,
            Page::Wind => InspectionScope::Wind,
            _ => InspectionScope::Nothing,
        }
    }

    /// Keeps a message for the corner of a desk; the log has it for the panel.
    pub fn say(&mut self, time: f64, message: impl Into<String>) {
        self.toast = Some((time, message.into()));
    }

    /// What a finger or the pointer does; says whether it does it to the panel, or to the test of the glass.
    pub fn feel(&mut self, signal: &Signal) -> bool {
        match signal {
            Signal::Pointer(at) => self.test.slide(None, *at),
            Signal::Button(down) if self.open => self.test.press(None, None, *down),
            Signal::Touch { finger, at, phase: Phase::Move } => self.test.slide(Some(*finger), *at),
            Signal::Touch { finger, at, phase } if self.open => {
                self.test.press(Some(*finger), Some(*at), *phase == Phase::Down);
            }
            _ => {}
        }
        let at = match signal {
            Signal::Pointer(at) | Signal::Touch { at, .. } => Some(*at),
            Signal::Button(_) => self.test.pointer(),
            Signal::Key(_) | Signal::Deserted => None,
        };
        self.open && (self.page == Page::Test || at.is_some_and(|[x, _]| x >= 1.0 - f64::from(self.share)))
    }

    /// Draws the panel when it is open, and a new message where staff may see it.
    pub fn show(&mut self, ui: &mut Ui, sight: &Sight) -> Vec<Wish> {
        let mut wishes = Vec::new();
        self.gate.set(&sight.site.staff.pin);
        if !self.open {
            self.toast(ui, sight);
            return wishes;
        }
        let time = sight.vitals.time;
        if self.touched.1 == f64::NEG_INFINITY || sight.activity != self.touched.0 {
            self.touched = (sight.activity, time);
        }
        if time - self.touched.1 > sight.site.staff.closes_s {
            self.close();
            return wishes;
        }
        self.gate.tend(time);
        // A picture that tests the display is all there is: a press turns it on, and nothing else.
        if self.test.covers() {
            self.test.paint(ui.ctx());
            return wishes;
        }
        let width = width(ui.ctx());
        self.share = width / ui.ctx().content_rect().width();
        let panel = egui::Panel::right("staff").resizable(false).exact_size(width);
        panel.show(ui, |ui| {
            ui.spacing_mut().interact_size.y = (PRESS_MM * sight.points_per_mm).clamp(18.0, 48.0);
            ui.spacing_mut().item_spacing = vec2(8.0, 6.0);
            ui.visuals_mut().override_text_color = Some(INK);
            (ui.visuals_mut().disabled_alpha, ui.visuals_mut().weak_text_alpha) = (PALER, PALER);
            if self.gate.has_pin() && !self.gate.is_open() {
                keypad::show(ui, &mut self.gate, time, sight.points_per_mm);
            } else {
                self.pages(ui, sight, &mut wishes);
            }
        });
        if self.page == Page::Test {
            self.test.paint(ui.ctx());
        }
        wishes
    }

    fn pages(&mut self, ui: &mut Ui, sight: &Sight, wishes: &mut Vec<Wish>) {
        ui.horizontal_wrapped(|ui| {
            for page in Page::ALL {
                if ui.selectable_label(self.page == page, page.name()).clicked() {
                    self.turn_to(page);
                }
            }
        });
        ui.separator();
        let may = self.gate.is_open() || !self.gate.has_pin() && sight.on_desk;
        if !may {
            ui.colored_label(
                BAD,
                "No PIN is set: this panel shows and changes nothing. `soffio pin` prints the line for [staff].",
            );
        }
        let mut said = None;
        let scroll = egui::ScrollArea::vertical().id_salt(self.page.name()).auto_shrink(false);
        let bottom = if self.said.is_some() { 80.0 } else { 0.0 };
        let room = (ui.available_height() - bottom).max(100.0);
        scroll.max_height(room).show(ui, |ui| match self.page {
            Page::Status => status::show(ui, sight, may, wishes),
            Page::Exhibits => self.exhibits.show(ui, sight, may, wishes, &mut self.changes, &mut said),
            Page::Bodies => self.bodies.show(ui, sight),
            Page::Wind => wind::show(ui, sight),
            Page::Sound => self.sound.show(ui, sight, may, wishes),
            Page::Parameters => self.parameters.show(ui, sight, may, &mut self.changes, &mut said),
            Page::Microphone => self.microphone.show(ui, sight, may, &mut self.changes, &mut said),
            Page::Test => self.test.show(ui, sight, may, wishes),
            Page::Log => self.log.show(ui, sight.log),
        });
        if said.is_some() {
            self.said = said;
        }
        if let Some(said) = &self.said {
            ui.separator();
            ui.label(said);
        }
    }

    fn toast(&self, ui: &Ui, sight: &Sight) {
        let Some((at, message)) = self.toast.as_ref().filter(|_| sight.on_desk) else { return };
        if sight.vitals.time - at < TOAST_S {
            let corner = egui::Area::new(egui::Id::unique("toast")).anchor(egui::Align2::LEFT_TOP, [16.0, 16.0]);
            corner.show(ui.ctx(), |ui| {
                egui::Frame::popup(ui.style()).show(ui, |ui| {
                    ui.set_max_width(560.0);
                    ui.monospace(message);
                });
            });
        }
    }
}

//! The panel itself: the PIN gate, the tabs of its pages, and the state of each page.

use egui::{Ui, vec2};

use crate::pages::canvas::INK;
use crate::pages::ui_strings::TextId;
use crate::staff::action::StaffAction;
use crate::staff::edit::Changes;
use crate::staff::gate::Gate;
use crate::staff::pages::style::{BAD, width};
use crate::staff::pages::{Page, bodies, exhibits, keypad, log, microphone, parameters, sound, status, test, wind};
use crate::staff::panel_input::PanelInput;
use crate::visitor::input::{Phase, Request, Signal};
use soffio_config::{Config, Staff};
use soffio_simulation::InspectionScope;

/// Time for which a message is shown in the corner of a window on a desk, s.
const TOAST_S: f64 = 10.0;
/// Height of a button for staff, mm: half of a visitor's button.
const PRESS_MM: f32 = 9.0;

/// Opacity of disabled buttons, which stay legible.
const PALER: f32 = 0.87;

/// The panel and the state of its pages.
#[derive(Default)]
pub struct StaffPanel {
    open: bool,
    page: Page,
    gate: Gate,
    /// Width as a share of the picture's.
    share: f32,
    /// Count of inputs, and the time of the last one, s.
    touched: (u64, f64),
    /// Action of a chord that waits for the PIN.
    waiting: Option<StaffAction>,
    toast: Option<(f64, String)>,
    /// Result of the last change.
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

impl StaffPanel {
    /// Opens the panel, or closes it and shuts its gate.
    pub fn toggle(&mut self) {
        let open = !self.open;
        self.close();
        self.open = open;
    }

    /// Takes a request of a key or button. Returns it where it may be carried out at once. A chord of staff that needs the PIN opens
    /// the panel instead; it is carried out when the right PIN is entered.
    pub fn admit(&mut self, request: Request, staff: &Staff) -> Option<Request> {
        self.gate.set(&staff.pin);
        if self.gate.admits(request, staff) {
            return Some(request);
        }
        if !self.open {
            self.toggle();
        }
        self.waiting = match request {
            Request::Mute => Some(StaffAction::Mute),
            Request::Night => Some(StaffAction::Night),
            Request::Open => Some(StaffAction::Open),
            _ => None,
        };
        None
    }

    fn close(&mut self) {
        self.open = false;
        self.waiting = None;
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

    /// The PIN gate.
    pub fn gate(&mut self) -> &mut Gate {
        &mut self.gate
    }

    /// Inspection that the open page needs.
    pub fn inspection(&self, site: &Config) -> InspectionScope {
        match self.page {
            _ if !self.open || site.staff.pin.is_set() && !self.gate.is_open() => InspectionScope::Nothing,
            Page::Bodies => InspectionScope::Bodies,
            Page::Wind => InspectionScope::Wind,
            _ => InspectionScope::Nothing,
        }
    }

    /// Shows a message in the corner of a window on a desk; on the panel it is in the log.
    pub fn show_message(&mut self, time: f64, message: impl Into<String>) {
        self.toast = Some((time, message.into()));
    }

    /// Handles a signal of finger or pointer. Returns whether the panel or the screen test captures it.
    pub fn handle_signal(&mut self, signal: &Signal) -> bool {
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
            Signal::Key(_) | Signal::FocusLost => None,
        };
        self.open && (self.page == Page::Test || at.is_some_and(|[x, _]| x >= 1.0 - f64::from(self.share)))
    }

    /// Draws the panel if it is open, and a new message on a desk. Returns the actions of staff.
    pub fn show(&mut self, ui: &mut Ui, input: &PanelInput) -> Vec<StaffAction> {
        let mut actions = Vec::new();
        self.gate.set(&input.site.staff.pin);
        if !self.open {
            self.toast(ui, input);
            return actions;
        }
        let time = input.vitals.time;
        if self.touched.1 == f64::NEG_INFINITY || input.activity != self.touched.0 {
            self.touched = (input.activity, time);
        }
        if time - self.touched.1 > input.site.staff.closes_s {
            self.close();
            return actions;
        }
        self.gate.poll(time);
        if self.gate.is_open() {
            actions.extend(self.waiting.take());
        }
        // A full-screen test picture covers the panel; a press shows the next one.
        if self.test.covers() {
            self.test.paint(ui.ctx(), input.texts);
            return actions;
        }
        let width = width(ui.ctx());
        self.share = width / ui.ctx().content_rect().width();
        let panel = egui::Panel::right("staff").resizable(false).exact_size(width);
        panel.show(ui, |ui| {
            ui.spacing_mut().interact_size.y = (PRESS_MM * input.points_per_mm).clamp(18.0, 48.0);
            ui.spacing_mut().item_spacing = vec2(8.0, 6.0);
            ui.visuals_mut().override_text_color = Some(INK);
            (ui.visuals_mut().disabled_alpha, ui.visuals_mut().weak_text_alpha) = (PALER, PALER);
            if self.gate.has_pin() && !self.gate.is_open() {
                keypad::show(ui, &mut self.gate, time, input.points_per_mm, input.texts);
            } else {
                self.pages(ui, input, &mut actions);
            }
        });
        if self.page == Page::Test {
            self.test.paint(ui.ctx(), input.texts);
        }
        actions
    }

    fn pages(&mut self, ui: &mut Ui, input: &PanelInput, actions: &mut Vec<StaffAction>) {
        ui.horizontal_wrapped(|ui| {
            for page in Page::ALL {
                if ui.selectable_label(self.page == page, input.texts.get(page.title())).clicked() {
                    self.turn_to(page);
                }
            }
        });
        ui.separator();
        let may = self.gate.is_open() || !self.gate.has_pin() && input.on_desk;
        if !may {
            ui.colored_label(BAD, input.texts.get(TextId::StaffNoPin));
        }
        let mut said = None;
        let scroll = egui::ScrollArea::vertical().id_salt(self.page as usize).auto_shrink(false);
        let bottom = if self.said.is_some() { 80.0 } else { 0.0 };
        let available = (ui.available_height() - bottom).max(100.0);
        scroll.max_height(available).show(ui, |ui| match self.page {
            Page::Status => status::show(ui, input, may, actions),
            Page::Exhibits => self.exhibits.show(ui, input, may, actions, &mut self.changes, &mut said),
            Page::Bodies => self.bodies.show(ui, input),
            Page::Wind => wind::show(ui, input),
            Page::Sound => self.sound.show(ui, input, may, actions),
            Page::Parameters => self.parameters.show(ui, input, may, &mut self.changes, &mut said),
            Page::Microphone => self.microphone.show(ui, input, may, &mut self.changes, &mut said),
            Page::Test => self.test.show(ui, input, may, actions),
            Page::Log => self.log.show(ui, input.log, input.texts),
        });
        if said.is_some() {
            self.said = said;
        }
        if let Some(said) = &self.said {
            ui.separator();
            ui.label(said);
        }
    }

    fn toast(&self, ui: &Ui, input: &PanelInput) {
        let Some((at, message)) = self.toast.as_ref().filter(|_| input.on_desk) else { return };
        if input.vitals.time - at < TOAST_S {
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

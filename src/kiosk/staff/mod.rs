//! The staff panel: whether the kiosk is well, and whatever a curator wants to see, hear, measure or change.
//!
//! A key chord opens it (`staff.chord`), a PIN what is on it (`staff.pin`, [`gate`]). Where the site has set no PIN, the
//! panel shows all and changes nothing; on somebody's desk, where Esc ends the kiosk anyway, it does both. It closes
//! when nobody has touched it for a while, and asks for the PIN anew.

use egui::{Color32, RichText, Ui, vec2};

use super::edit::Changes;
use super::input::{Phase, Signal};
use super::page::INK;
use super::voice::Trial;
use soffio_config::Config;
use soffio_simulation::Look;

mod bodies;
mod display;
mod exhibits;
pub mod gate;
mod keypad;
mod log;
mod microphone;
mod parameters;
mod plot;
mod sight;
mod sound;
mod status;
mod test;
mod wind;

use gate::Gate;
pub use sight::{Sight, Vitals};

/// How long a message stays in the corner of a desk, s.
const TOAST_S: f64 = 10.0;
/// Width of the panel, points, and its greatest share of the glass.
const WIDTH: f32 = 500.0;
const WIDTH_SHARE: f32 = 0.6;
/// Height of what staff press, mm: half of a visitor's button, for a practised finger.
const PRESS_MM: f32 = 9.0;

/// Height of a row of numbers, points.
const ROW: f32 = 17.0;

/// What is not as it should be.
const BAD: Color32 = Color32::from_rgb(160, 30, 15);
/// What is.
const GOOD: Color32 = Color32::from_rgb(20, 90, 45);
/// What may not be pressed is paler, and can be read all the same.
const PALER: f32 = 0.87;

/// What staff ask of the kiosk.
#[derive(Clone, Debug, PartialEq)]
pub enum Wish {
    /// Put everything back to where it started.
    Reset,
    /// Load the exhibit from its folder again.
    Reload,
    /// Silence, or an end of it.
    Mute,
    /// From the configured hours to night, to day, and back.
    Night,
    /// All input off while the glass is cleaned.
    Clean,
    /// Open while the house is closed, or close again.
    Open,
    /// The loudspeaker chirps to the microphone.
    Chirp,
    /// The foam is a new one.
    FoamChanged,
    /// What chirps tell from now on is how it should be.
    ListenAnew,
    /// Show the work with this id.
    Show(String),
    /// Let it be heard.
    Try(Trial),
    /// End the kiosk.
    Close,
}

/// A page of the panel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Page {
    /// Is it well? And what staff do every day.
    #[default]
    Status,
    /// Which works, in which order.
    Exhibits,
    /// Bodies, joints, energy.
    Bodies,
    /// Where the breath goes.
    Wind,
    /// Instruments, tried through the loudspeaker.
    Sound,
    /// The work's numbers.
    Parameters,
    /// Levels, gain, what to do about it.
    Microphone,
    /// Glass, loudspeakers, microphone.
    Test,
    /// What was logged.
    Log,
}

impl Page {
    /// All of them, in the order of their tabs.
    pub const ALL: [Self; 9] = [
        Self::Status,
        Self::Exhibits,
        Self::Bodies,
        Self::Wind,
        Self::Sound,
        Self::Parameters,
        Self::Microphone,
        Self::Test,
        Self::Log,
    ];

    fn name(self) -> &'static str {
        match self {
            Self::Status => "Status",
            Self::Exhibits => "Exhibits",
            Self::Bodies => "Bodies",
            Self::Wind => "Wind",
            Self::Sound => "Sound",
            Self::Parameters => "Parameters",
            Self::Microphone => "Microphone",
            Self::Test => "Test",
            Self::Log => "Log",
        }
    }
}

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
    pub fn look(&self, site: &Config) -> Look {
        match self.page {
            _ if !self.open || site.staff.pin.is_set() && !self.gate.is_open() => Look::Nothing,
            Page::Bodies => Look::Bodies,
            Page::Wind => Look::Wind,
            _ => Look::Nothing,
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

/// Width of the panel, points.
fn width(context: &egui::Context) -> f32 {
    WIDTH.min(WIDTH_SHARE * context.content_rect().width())
}

/// One row of a grid of names and values.
fn row(ui: &mut Ui, name: &str, value: impl Into<String>, bad: bool) {
    ui.label(name);
    let text = RichText::new(value).monospace();
    ui.add(egui::Label::new(if bad { text.color(BAD) } else { text }).wrap());
    ui.end_row();
}

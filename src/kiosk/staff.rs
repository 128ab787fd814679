//! The staff panel: every number that says whether the kiosk is well, and a few buttons.
//!
//! It opens by a key chord only (`staff.chord`) and is plain on purpose. Messages that visitors never see, such as
//! what is wrong with a file that a curator just saved, are kept here.

use std::collections::VecDeque;

use egui::{Align2, Color32, Grid, RichText, ScrollArea, Sense, Ui, pos2, vec2};

use super::live::Frame;
use super::loudness::NightBy;
use crate::controllers::State;
use crate::simulation::MotionMode;
use crate::wind::blow::BlowEstimate;

/// Messages that are kept.
const KEPT: usize = 30;
/// How long a message stays in the corner, s.
const TOAST_S: f64 = 10.0;

/// What is not as it should be.
const BAD: Color32 = Color32::from_rgb(225, 70, 50);
/// Lower end of the meter, dB of full scale.
const QUIETEST_DBFS: f64 = -80.0;
/// Size of the meter.
const METER: [f32; 2] = [220.0, 10.0];

/// What staff ask for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wish {
    /// Put everything back to where it started.
    Reset,
    /// Load the exhibit from its folder again.
    Reload,
    /// Silence, or an end of it.
    Mute,
    /// From the configured hours to night, to day, and back.
    Night,
    /// End the kiosk.
    Close,
}

/// What the panel shows besides the simulation's own numbers.
pub struct Vitals<'a> {
    /// Name and kind of the graphics adapter.
    pub adapter: &'a str,
    /// Mean time from picture to picture, s.
    pub frame_s: f64,
    /// Pixels.
    pub size: [u32; 2],
    /// Seconds since the kiosk began.
    pub time: f64,
    /// From the last breath's first wind to its first picture, s.
    pub sight_s: f64,
}

/// The panel and its messages.
#[derive(Debug, Default)]
pub struct Staff {
    /// Is the panel open?
    pub open: bool,
    messages: VecDeque<(f64, String)>,
}

impl Staff {
    /// Keeps a message for staff.
    pub fn say(&mut self, time: f64, message: impl Into<String>) {
        self.messages.push_back((time, message.into()));
        while self.messages.len() > KEPT {
            self.messages.pop_front();
        }
    }

    /// Shows the panel when it is open, and a new message where staff may see it (`on_desk`: not in the gallery).
    pub fn show(&mut self, ui: &mut Ui, frame: &Frame, vitals: &Vitals, on_desk: bool) -> Option<Wish> {
        let mut wish = None;
        if self.open {
            egui::Window::new("Soffio").anchor(Align2::RIGHT_TOP, [-16.0, 16.0]).resizable(false).show(
                ui.ctx(),
                |ui| {
                    if frame.hears {
                        meter(ui, &frame.current.breath.estimate);
                    }
                    for remedy in frame.load.microphone.remedies() {
                        ui.set_max_width(420.0);
                        ui.colored_label(BAD, format!("microphone: {remedy}"));
                    }
                    numbers(ui, frame, vitals);
                    ui.separator();
                    ui.horizontal(|ui| {
                        let loud = &frame.load.loudness;
                        for (name, asked) in [
                            ("Reset", Wish::Reset),
                            ("Reload exhibit", Wish::Reload),
                            (if loud.muted { "Sound on" } else { "Mute" }, Wish::Mute),
                            ("Night", Wish::Night),
                            ("Close kiosk", Wish::Close),
                        ] {
                            if ui.button(name).clicked() {
                                wish = Some(asked);
                            }
                        }
                    });
                    ui.separator();
                    self.log(ui);
                },
            );
        } else if on_desk
            && let Some((at, message)) = self.messages.back()
            && vitals.time - at < TOAST_S
        {
            egui::Area::new(egui::Id::unique("toast")).anchor(Align2::LEFT_TOP, [16.0, 16.0]).show(ui.ctx(), |ui| {
                egui::Frame::popup(ui.style()).show(ui, |ui| {
                    ui.set_max_width(560.0);
                    ui.monospace(message);
                });
            });
        }
        wish
    }

    fn log(&self, ui: &mut Ui) {
        ScrollArea::vertical().max_height(160.0).max_width(420.0).stick_to_bottom(true).show(ui, |ui| {
            if self.messages.is_empty() {
                ui.weak("no messages");
            }
            for (time, message) in &self.messages {
                ui.monospace(format!("{time:8.1} s  {message}"));
            }
        });
    }
}

/// The microphone's level, and a mark at the room's floor.
fn meter(ui: &mut Ui, heard: &BlowEstimate) {
    let (room, _) = ui.allocate_exact_size(METER.into(), Sense::hover());
    let place = |dbfs: f64| room.left() + room.width() * (1.0 - dbfs / QUIETEST_DBFS).clamp(0.0, 1.0) as f32;
    let painter = ui.painter();
    painter.rect_filled(room, 2.0, Color32::from_gray(45));
    let level = room.with_max_x(place(heard.level_dbfs));
    painter.rect_filled(level, 2.0, if heard.clipping { BAD } else { Color32::from_rgb(90, 170, 90) });
    let floor = pos2(place(heard.floor_dbfs), room.top());
    painter.rect_filled(egui::Rect::from_min_size(floor, vec2(2.0, room.height())), 0.0, Color32::WHITE);
}

/// The numbers, one a row.
fn numbers(ui: &mut Ui, frame: &Frame, vitals: &Vitals) {
    let breath = &frame.current.breath;
    let heard = &breath.estimate;
    let state = &frame.current.diagnostics;
    let (audio, microphone) = (&frame.load.audio, &frame.load.microphone);
    Grid::new("numbers").num_columns(2).spacing([24.0, 3.0]).show(ui, |ui| {
        let mut row = |name: &str, value: String, bad: bool| {
            ui.label(name);
            let text = RichText::new(value).monospace();
            ui.label(if bad { text.color(BAD) } else { text });
            ui.end_row();
        };
        row("exhibit", frame.exhibit.id.clone(), false);
        let capsules = if audio.capsules == 2 { ", two capsules" } else { "" };
        row("microphone", format!("{}{capsules}", audio.input), !frame.hears);
        let level = if frame.hears {
            format!("{:6.1} dBFS, floor {:6.1}", heard.level_dbfs, heard.floor_dbfs)
        } else {
            "nothing arrives".into()
        };
        row("level", level, heard.clipping);
        let clips = format!("{} times, {} without a breath", microphone.clips, microphone.clips_without_breath);
        row("at full scale", clips, microphone.clips_lately());
        row("gain control", if heard.gain_control { "seen" } else { "none seen" }.into(), heard.gain_control);
        row("detector", format!("{:?}, {:.2}", heard.reason, heard.confidence), false);
        row("breath", format!("{:5.2} m/s heard, {:5.2} m/s blown", heard.speed, breath.speed), false);
        row("wind force", format!("{:.4} N", state.wind_force.length()), false);
        row("attract mode", if frame.attracts { "playing".into() } else { "waiting".into() }, false);
        row("joint error", format!("{:.2e} m", state.joint_error), state.joint_error > 1e-3);
        row("energy", format!("{:.4} J", state.energy), false);
        row("substeps", state.substeps.to_string(), false);
        row("impacts", state.impacts.to_string(), false);
        row("faults", state.faults.to_string(), state.faults > 0);
        row("step", format!("{:.3} ms of 4.167", 1e3 * frame.load.step_s), frame.load.step_s > 1.0 / 240.0);
        let changes = frame.load.mode_changes;
        row("moved by", format!("{}, {changes} changes", state.mode.name()), state.mode != MotionMode::Dynamic);
        row("hands", state.hands.to_string(), false);
        row("steps dropped", frame.load.dropped.to_string(), false);
        row("picture", format!("{:.1} ms, {}x{}", 1e3 * vitals.frame_s, vitals.size[0], vitals.size[1]), false);
        row("wind to picture", format!("{:.0} ms", 1e3 * vitals.sight_s), vitals.sight_s > 0.25);
        row("graphics", vitals.adapter.to_owned(), false);
        for (kind, state) in &frame.load.controllers {
            let (State::Listening(said) | State::Waiting(said)) = state;
            row(kind, said.clone(), false);
        }
        row("loudspeaker", audio.output.to_string(), false);
        row("late blocks", audio.xruns.to_string(), audio.xruns > 0);
        let loud = &frame.load.loudness;
        let muted = if loud.muted { ", muted" } else { "" };
        let eased = if loud.eased_db > 0.0 { format!(", {:.1} dB eased", loud.eased_db) } else { String::new() };
        row("volume", format!("{:.1} dB, {:+} steps{eased}{muted}", loud.volume_db, loud.steps), loud.muted);
        let by = match loud.by {
            NightBy::Hours => "the hours",
            NightBy::Night | NightBy::Day => "staff",
        };
        row("sound of the", format!("{}, by {by}", if loud.night { "night" } else { "day" }), false);
        for (name, level, laeq) in
            [("level, minute", loud.level_db[0], loud.laeq_db[0]), ("level, day", loud.level_db[1], loud.laeq_db[1])]
        {
            let value = match laeq {
                Some(laeq) => format!("{laeq:.1} dB(A)"),
                None if level.is_finite() => format!("{level:.1} dB(A) of full scale, not calibrated"),
                None => "silent".into(),
            };
            row(name, value, false);
        }
    });
}

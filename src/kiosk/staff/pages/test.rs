//! The test screen: where the glass feels fingers, which loudspeaker is which, what the microphone decides, and pictures
//! that show what is wrong with a display.

use egui::{Align2, Color32, FontId, LayerId, Order, Ui, vec2};

use super::display::Pattern;
use super::states::reason;
use super::style::{ROW, row};
use crate::pages::ui_strings::{TextId, UiStrings};
use crate::staff::action::StaffAction;
use crate::staff::panel_input::PanelInput;
use crate::step::instruments::{Audition, AuditionTarget, shipped};

/// Timbre of the loudspeaker test, and the speed of its hit, m/s.
const CALL: (&str, f64) = ("wood", 1.0);
/// Points of a finger's way that are kept.
const TRAIL: usize = 200;

/// A finger, or the pointer (`None`).
#[derive(Clone, Debug)]
struct Finger {
    of: Option<u64>,
    down: bool,
    trail: Vec<[f64; 2]>,
}

/// What the page remembers.
#[derive(Debug, Default)]
pub struct Test {
    fingers: Vec<Finger>,
    /// Where the pointer is.
    pointer: Option<[f64; 2]>,
    pattern: Option<Pattern>,
}

impl Test {
    /// A finger or the pointer goes there.
    pub fn slide(&mut self, of: Option<u64>, at: [f64; 2]) {
        if of.is_none() {
            self.pointer = Some(at);
        }
        if let Some(finger) = self.fingers.iter_mut().find(|finger| finger.of == of && finger.down) {
            finger.trail.push(at);
            let more = finger.trail.len().saturating_sub(TRAIL);
            finger.trail.drain(..more);
        }
    }

    /// It goes down or comes up; a press turns to the next picture where one is shown.
    pub fn press(&mut self, of: Option<u64>, at: Option<[f64; 2]>, down: bool) {
        if down {
            self.pattern = self.pattern.and_then(Pattern::next);
            self.fingers.retain(|finger| finger.of != of);
            let at = at.or(self.pointer);
            self.fingers.push(Finger { of, down, trail: at.into_iter().collect() });
        } else if let Some(finger) = self.fingers.iter_mut().find(|finger| finger.of == of) {
            finger.down = false;
        }
    }

    /// Where the pointer is.
    pub fn pointer(&self) -> Option<[f64; 2]> {
        self.pointer
    }

    /// Nothing is tested any more.
    pub fn end(&mut self) {
        *self = Self { pointer: self.pointer, ..Self::default() };
    }

    /// Is a picture over everything?
    pub fn covers(&self) -> bool {
        self.pattern.is_some()
    }

    /// Where fingers are down, picture coordinates.
    pub fn touches(&self) -> impl Iterator<Item = [f64; 2]> {
        self.fingers.iter().filter(|finger| finger.down).filter_map(|finger| finger.trail.last().copied())
    }

    /// Draws the page.
    pub fn show(&mut self, ui: &mut Ui, input: &PanelInput, may: bool, actions: &mut Vec<StaffAction>) {
        let texts = input.texts;
        ui.heading(texts.get(TextId::StaffGlass));
        let down = self.touches().count();
        ui.label(&*texts.format(TextId::StaffGlassHelp, &[("count", down.into())]));
        if ui.button(texts.get(TextId::StaffClearTraces)).clicked() {
            self.fingers.clear();
        }
        ui.heading(texts.get(TextId::StaffDisplay));
        ui.label(texts.get(TextId::StaffDisplayHelp));
        if ui.button(texts.get(TextId::StaffShowPatterns)).clicked() {
            self.pattern = Some(Pattern::FIRST);
        }
        ui.heading(texts.get(TextId::StaffLoudspeakers));
        ui.add_enabled_ui(may, |ui| {
            ui.horizontal(|ui| {
                for (name, pan) in [(TextId::StaffLeft, -1.0), (TextId::StaffBoth, 0.0), (TextId::StaffRight, 1.0)] {
                    let (timbre, speed) = CALL;
                    if ui.button(texts.get(name)).clicked()
                        && let Some(preset) = shipped(timbre)
                    {
                        actions.push(StaffAction::PlaySound(Audition {
                            target: AuditionTarget::Timbre(preset),
                            speed,
                            pan,
                        }));
                    }
                }
            });
        });
        ui.heading(texts.get(TextId::StaffPageMicrophone));
        let estimate = &input.frame.current.breath.estimate;
        egui::Grid::new("decision").num_columns(2).min_row_height(ROW).show(ui, |ui| {
            let decided = match (input.frame.hears, estimate.speed > 0.0) {
                (false, _) => TextId::StaffNoSignal,
                (true, false) => TextId::StaffDecisionNone,
                (true, true) => TextId::StaffDecisionBreath,
            };
            row(ui, texts.get(TextId::StaffDecision), texts.get(decided), !input.frame.hears);
            row(ui, texts.get(TextId::StaffBecause), texts.get(reason(estimate.reason)), false);
            row(ui, texts.get(TextId::StaffConfidence), format!("{:.2}", estimate.confidence), false);
            row(ui, texts.get(TextId::StaffSpeed), format!("{:.2} m/s", estimate.speed), false);
        });
    }

    /// Draws rings around fingers over the picture, or a full-screen test picture.
    pub fn paint(&self, context: &egui::Context, texts: &UiStrings) {
        let picture = context.content_rect();
        let layer = LayerId::new(Order::Foreground, egui::Id::unique("test"));
        let painter = context.layer_painter(layer);
        if let Some(pattern) = self.pattern {
            return pattern.paint(&painter, picture, texts);
        }
        let place = |[x, y]: [f64; 2]| picture.lerp_inside(vec2(x as f32, y as f32));
        for (index, finger) in self.fingers.iter().enumerate() {
            let color = if finger.down { Color32::from_rgb(20, 90, 200) } else { Color32::from_gray(120) };
            let way = finger.trail.iter().map(|at| place(*at)).collect();
            painter.line(way, egui::Stroke::new(2.0, color));
            if let Some(at) = finger.trail.last().filter(|_| finger.down) {
                painter.circle_stroke(place(*at), 40.0, egui::Stroke::new(4.0, color));
                let [x, y] = *at;
                let said = format!("{}: {x:.3}, {y:.3}", index + 1);
                painter.text(place(*at) - vec2(0.0, 56.0), Align2::CENTER_BOTTOM, said, FontId::monospace(14.0), color);
            }
        }
    }
}

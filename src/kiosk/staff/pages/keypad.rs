//! Digits to press on the glass, and those of a keyboard.

use egui::{Align, Button, Event, Grid, Key, Layout, RichText, Ui, vec2};

use super::style::BAD;
use crate::pages::ui_strings::{TextId, UiStrings};
use crate::staff::gate::Gate;

/// Side of a digit on the glass, mm.
pub const DIGIT_MM: f32 = 18.0;
/// Least side, points, where the glass is not measured, or small.
const LEAST: f32 = 44.0;

/// What a key of the pad does.
#[derive(Clone, Copy)]
enum Pressed {
    Digit(char),
    Back,
    Enter,
}

/// Asks for the PIN.
pub fn show(ui: &mut Ui, gate: &mut Gate, time: f64, points_per_mm: f32, texts: &UiStrings) {
    let side = (DIGIT_MM * points_per_mm).max(LEAST).min((ui.available_width() - 32.0) / 3.0);
    ui.add_space(side * 0.5);
    ui.with_layout(Layout::top_down(Align::Center), |ui| {
        ui.heading(texts.get(TextId::StaffEnterPin));
        let pause = gate.pause(time);
        let said = match pause {
            _ if gate.checks() => texts.get(TextId::StaffPinChecking).to_owned(),
            Some(left) => {
                let seconds = left.ceil().to_string().into();
                let count = gate.wrong().unsigned_abs().into();
                texts.format(TextId::StaffPinWrong, &[("count", count), ("seconds", seconds)]).to_string()
            }
            None if gate.entered() == 0 => "\u{2013}".to_owned(),
            None => "\u{2022} ".repeat(gate.entered()),
        };
        let text = RichText::new(said).size(22.0);
        ui.label(if pause.is_some() { text.color(BAD) } else { text });
        ui.add_space(12.0);
        let pressed = ui.add_enabled_ui(pause.is_none() && !gate.checks(), |ui| pad(ui, side)).inner;
        for key in pressed.into_iter().chain(keyboard(ui)) {
            match key {
                Pressed::Digit(digit) => gate.digit(digit),
                Pressed::Back => gate.back(),
                Pressed::Enter => gate.enter(time),
            }
        }
    });
}

fn pad(ui: &mut Ui, side: f32) -> Option<Pressed> {
    let mut pressed = None;
    let indent = 0.5 * (ui.available_width() - 3.0 * side - 16.0);
    ui.horizontal(|ui| {
        ui.add_space(indent.max(0.0));
        Grid::new("pad").spacing(vec2(8.0, 8.0)).show(ui, |ui| {
            for row in ["123", "456", "789", "<0>"] {
                for sign in row.chars() {
                    let (name, key) = match sign {
                        '<' => ("\u{2190}".to_owned(), Pressed::Back),
                        '>' => ("OK".to_owned(), Pressed::Enter),
                        digit => (digit.to_string(), Pressed::Digit(digit)),
                    };
                    let button =
                        Button::new(RichText::new(name).monospace().size(0.4 * side)).min_size(vec2(side, side));
                    if ui.add(button).clicked() {
                        pressed = Some(key);
                    }
                }
                ui.end_row();
            }
        });
    });
    pressed
}

/// What a keyboard says.
fn keyboard(ui: &Ui) -> Vec<Pressed> {
    ui.input(|input| {
        let key = |event: &Event| match event {
            Event::Text(text) => text.chars().next().filter(char::is_ascii_digit).map(Pressed::Digit),
            Event::Key { key: Key::Backspace, pressed: true, .. } => Some(Pressed::Back),
            Event::Key { key: Key::Enter, pressed: true, repeat: false, .. } => Some(Pressed::Enter),
            _ => None,
        };
        input.events.iter().filter_map(key).collect()
    })
}

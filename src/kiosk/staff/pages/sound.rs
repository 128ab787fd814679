//! Instruments, tried through the live loudspeaker: the work's own, its own timbres, and all shipped ones.

use std::sync::Arc;

use egui::{Slider, Ui};
use soffio_sound::Preset;

use super::style::BAD;
use crate::pages::ui_strings::TextId;
use crate::staff::action::StaffAction;
use crate::staff::panel_input::PanelInput;
use crate::step::instruments::{Audition, AuditionTarget, timbres};

/// What the page remembers.
#[derive(Debug)]
pub struct Sound {
    /// m/s.
    speed: f64,
    pan: f32,
    /// The shipped timbres, read once.
    timbres: Vec<Arc<Preset>>,
}

impl Default for Sound {
    fn default() -> Self {
        Self { speed: 0.5, pan: 0.0, timbres: Vec::new() }
    }
}

impl Sound {
    /// Draws it.
    pub fn show(&mut self, ui: &mut Ui, input: &PanelInput, may: bool, actions: &mut Vec<StaffAction>) {
        if self.timbres.is_empty() {
            self.timbres = timbres().collect();
        }
        let (frame, texts) = (input.frame, input.texts);
        if frame.load.loudness.muted || frame.lacks_output() {
            ui.colored_label(BAD, texts.get(TextId::StaffNothingAudible));
        }
        ui.add(Slider::new(&mut self.speed, 0.02..=4.0).logarithmic(true).text(texts.get(TextId::StaffStrikeSpeed)));
        ui.add(Slider::new(&mut self.pan, -1.0..=1.0).text(texts.get(TextId::StaffPan)));
        let (speed, pan) = (self.speed, self.pan);
        let mut play = |ui: &mut Ui, name: &str, target: AuditionTarget| {
            if ui.button(name).clicked() {
                actions.push(StaffAction::PlaySound(Audition { target, speed, pan }));
            }
        };
        ui.separator();
        ui.label(&frame.exhibit.id);
        ui.add_enabled_ui(may, |ui| {
            ui.horizontal_wrapped(|ui| {
                for sound in &frame.exhibit.sounds {
                    let timbre = &frame.exhibit.instruments[sound.instrument].timbre;
                    // Wind, slides and motion play the others.
                    if sound.is_struck {
                        play(ui, &format!("{} ({timbre})", sound.name), AuditionTarget::Exhibit(sound.instrument));
                    }
                }
            });
            ui.separator();
            ui.label(texts.get(TextId::StaffAllTimbres));
            ui.horizontal_wrapped(|ui| {
                for preset in frame.exhibit.own_timbres.iter().chain(&self.timbres) {
                    play(ui, &preset.name, AuditionTarget::Timbre(preset.clone()));
                }
            });
        });
    }
}

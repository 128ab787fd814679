//! The microphone: what it hears, how the detector judges, and what to do about it, as `soffio doctor` says.

use egui::{Color32, DragValue, Grid, Sense, Ui, pos2, vec2};

use super::states::{clips, decision, device, gain_control, remedy_text, saved_in};
use super::style::{BAD, GOOD, ROW, row};
use crate::pages::ui_strings::TextId;
use crate::staff::edit::{Changes, with_key};
use crate::staff::panel_input::PanelInput;
use soffio_config::remedies;
use soffio_detector::{BlowEstimate, Reason};

/// Lower end of the meter, dB of full scale.
const QUIETEST_DBFS: f64 = -80.0;
/// Height of the meter, points.
const METER: f32 = 22.0;
/// Breaths that a calibration asks for.
const BREATHS: usize = 3;

/// What the page remembers.
#[derive(Debug, Default)]
pub struct Microphone {
    /// Loudest and quietest since the page was opened, dB of full scale.
    range: Option<[f64; 2]>,
    calibration: Option<Calibration>,
    /// Being dragged, dB.
    sensitivity: Option<f64>,
}

/// Breaths that are listened to.
#[derive(Clone, Copy, Debug, Default)]
pub struct Calibration {
    breaths: usize,
    blows: bool,
    /// Sum of the speeds at the lips, m/s, and how many there are.
    sum: f64,
    count: u32,
}

impl Calibration {
    /// Takes notice of what the detector says.
    pub fn note(&mut self, estimate: &BlowEstimate) {
        let blows = estimate.reason == Reason::Blow;
        if blows {
            self.sum += estimate.speed;
            self.count += 1;
        }
        self.breaths += usize::from(self.blows && !blows);
        self.blows = blows;
    }

    /// Were there enough breaths?
    pub fn is_over(&self) -> bool {
        self.breaths >= BREATHS
    }

    /// The sensitivity with which they would be normal breaths, dB, for breaths heard with `now_db`.
    pub fn proposal(&self, now_db: f64) -> Option<f64> {
        (self.count > 0).then(|| remedies::sensitivity(self.sum / f64::from(self.count), now_db))
    }
}

impl Microphone {
    /// Draws it.
    pub fn show(
        &mut self,
        ui: &mut Ui,
        input: &PanelInput,
        may: bool,
        changes: &mut Changes,
        said: &mut Option<String>,
    ) {
        let (frame, texts) = (input.frame, input.texts);
        let estimate = &frame.current.breath.estimate;
        if !frame.hears {
            let device = device(texts, &frame.load.audio.input);
            ui.colored_label(BAD, &*texts.format(TextId::StaffNoSignalFrom, &[("device", device.into())]));
            for remedy in frame.load.microphone.remedies() {
                ui.colored_label(BAD, remedy_text(texts, remedy));
            }
            self.range = None;
            return;
        }
        let level = estimate.level_dbfs.max(QUIETEST_DBFS);
        let [low, high] = self.range.unwrap_or([level, level]);
        let range = [low.min(level), high.max(level)];
        self.range = Some(range);
        meter(ui, estimate, range);
        let health = &frame.load.microphone;
        Grid::new("microphone").num_columns(2).min_row_height(ROW).spacing([24.0, 4.0]).show(ui, |ui| {
            row(ui, texts.get(TextId::StaffLevelNow), format!("{:6.1} dBFS", estimate.level_dbfs), false);
            let [low, high] = range.map(|level| format!("{level:6.1}").into());
            let between = texts.format(TextId::StaffFromTo, &[("low", low), ("high", high)]);
            row(ui, texts.get(TextId::StaffLevelRange), between, false);
            let loud = estimate.floor_dbfs > remedies::LOUD_DBFS;
            row(ui, texts.get(TextId::StaffNoiseFloor), format!("{:6.1} dBFS", estimate.floor_dbfs), loud);
            let clips = clips(texts, health);
            row(ui, texts.get(TextId::StaffClipping), clips, health.clips_lately());
            row(ui, texts.get(TextId::StaffGainControl), gain_control(texts, estimate), estimate.gain_control);
            row(ui, texts.get(TextId::StaffDetector), decision(texts, estimate), false);
            row(ui, texts.get(TextId::StaffBreathAtLips), format!("{:5.2} m/s", estimate.speed), false);
            let capsules = frame.load.audio.capsules;
            row(
                ui,
                texts.get(TextId::StaffMicrophones),
                capsules.to_string(),
                input.site.audio.second_microphone_channel > 0 && capsules < 2,
            );
        });
        ui.separator();
        let mut well = true;
        for remedy in health.remedies() {
            well = false;
            ui.colored_label(BAD, remedy_text(texts, remedy));
        }
        if well {
            ui.colored_label(GOOD, texts.get(TextId::StaffAllWell));
        }
        if ui.button(texts.get(TextId::StaffMeasureAgain)).clicked() {
            self.range = None;
        }
        ui.separator();
        ui.add_enabled_ui(may && input.file.is_some(), |ui| self.sensitivity(ui, input, changes, said));
    }

    fn sensitivity(&mut self, ui: &mut Ui, input: &PanelInput, changes: &mut Changes, said: &mut Option<String>) {
        let (now, texts) = (input.site.breath.sensitivity_db, input.texts);
        let mut wanted = self.sensitivity.unwrap_or(now);
        let mut save = None;
        ui.horizontal(|ui| {
            let field = DragValue::new(&mut wanted).range(-40.0..=40.0).speed(0.2).fixed_decimals(1).suffix(" dB");
            let response = ui.add(field);
            ui.label(texts.get(TextId::StaffSensitivity));
            self.sensitivity = Some(wanted).filter(|_| response.dragged() || response.has_focus());
            save = (response.drag_stopped() || response.lost_focus() && wanted != now).then_some(wanted);
        });
        match &mut self.calibration {
            None => {
                if ui.button(texts.get(TextId::StaffCalibrate)).clicked() {
                    self.calibration = Some(Calibration::default());
                }
            }
            Some(calibration) if !calibration.is_over() => {
                calibration.note(&input.frame.current.breath.estimate);
                let left = BREATHS - calibration.breaths;
                ui.label(&*texts.format(TextId::StaffCalibrateBlow, &[("count", left.into())]));
                if ui.button(texts.get(TextId::StaffStop)).clicked() {
                    self.calibration = None;
                }
            }
            Some(calibration) => {
                let proposed = calibration.proposal(now).unwrap_or(now);
                let (new, old) = (format!("{proposed:.0}").into(), format!("{now:.0}").into());
                ui.label(&*texts.format(TextId::StaffCalibrated, &[("proposed", new), ("now", old)]));
                let (mut take, mut forget) = (false, false);
                ui.horizontal(|ui| {
                    take = ui.button(texts.get(TextId::StaffApply)).clicked();
                    forget = ui.button(texts.get(TextId::StaffDismiss)).clicked();
                });
                save = take.then_some(proposed).or(save);
                if take || forget {
                    self.calibration = None;
                }
            }
        }
        if let Some((value, file)) = save.zip(input.file) {
            let made = changes.make_or_create(file, |text| with_key(text, "breath", "sensitivity_db", value));
            *said = Some(made.err().unwrap_or_else(|| saved_in(texts, file)));
        }
    }
}

/// The level, the range it had, and a mark at the room's floor.
fn meter(ui: &mut Ui, estimate: &BlowEstimate, range: [f64; 2]) {
    let (area, _) = ui.allocate_exact_size(vec2(ui.available_width(), METER), Sense::hover());
    let place = |dbfs: f64| area.left() + area.width() * (1.0 - dbfs / QUIETEST_DBFS).clamp(0.0, 1.0) as f32;
    let painter = ui.painter();
    painter.rect_filled(area, 2.0, Color32::from_gray(215));
    let had = area.with_min_x(place(range[0])).with_max_x(place(range[1]));
    painter.rect_filled(had, 0.0, Color32::from_gray(185));
    let level = area.with_max_x(place(estimate.level_dbfs)).shrink2(vec2(0.0, 4.0));
    painter.rect_filled(level, 2.0, if estimate.clipping { BAD } else { GOOD });
    let floor = pos2(place(estimate.floor_dbfs), area.top());
    painter.rect_filled(egui::Rect::from_min_size(floor, vec2(2.0, area.height())), 0.0, Color32::BLACK);
}

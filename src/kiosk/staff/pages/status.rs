//! Is it well? Every number that says so, and what staff do every day.

use egui::{Grid, Ui};

use super::style::{BAD, ROW, row};
use crate::staff::action::StaffAction;
use crate::staff::panel_input::PanelInput;
use crate::venue::loudness::NightBy;
use soffio_devices::audio::{DeviceState, SoundDelay};
use soffio_devices::controllers::State;
use soffio_simulation::MotionMode;

/// Block that the panel proposes where the device offers it, ms: half of the default, and still longer than a step.
const SHORT_BLOCK_MS: f64 = 5.0;

/// The buttons of every day, then all numbers.
pub fn show(ui: &mut Ui, input: &PanelInput, may: bool, actions: &mut Vec<StaffAction>) {
    buttons(ui, input, may, actions);
    for says in input.config_problems {
        ui.colored_label(BAD, format!("configuration: {says}"));
    }
    for remedy in input.frame.load.microphone.remedies() {
        ui.colored_label(BAD, format!("microphone: {remedy}"));
    }
    ui.separator();
    Grid::new("numbers").num_columns(2).min_row_height(ROW).spacing([24.0, 3.0]).show(ui, |ui| numbers(ui, input));
}

fn buttons(ui: &mut Ui, input: &PanelInput, may: bool, actions: &mut Vec<StaffAction>) {
    let muted = input.frame.load.loudness.muted;
    let early = input.venue.is_early();
    ui.add_enabled_ui(may, |ui| {
        ui.horizontal_wrapped(|ui| {
            let mut all = vec![
                ("Clean the glass", StaffAction::Clean),
                (if muted { "Sound on" } else { "Mute" }, StaffAction::Mute),
                ("Night", StaffAction::Night),
                ("Reset", StaffAction::Reset),
                ("Reload exhibit", StaffAction::Reload),
            ];
            if early || !input.venue.is_open() {
                all.push((if early { "Close the house again" } else { "Open now" }, StaffAction::Open));
            }
            if input.site.visit.breath {
                all.extend([
                    ("Chirp", StaffAction::SelfTest),
                    ("New foam", StaffAction::FoamChanged),
                    ("Listen anew", StaffAction::ResetSelfTest),
                ]);
            }
            all.push(("End the kiosk", StaffAction::Close));
            for (name, action) in all {
                if ui.button(name).clicked() {
                    actions.push(action);
                }
            }
        });
    });
}

/// The numbers, one a row.
fn numbers(ui: &mut Ui, input: &PanelInput) {
    venue(ui, input);
    microphone(ui, input);
    motion(ui, input);
    picture(ui, input);
    output(ui, input);
    loudness(ui, input);
}

fn venue(ui: &mut Ui, input: &PanelInput) {
    let venue = match (input.venue.is_open(), input.venue.is_early()) {
        (true, false) => "open",
        (true, true) => "open, by staff, before its hours",
        (false, _) => "closed",
    };
    row(ui, "house", venue, false);
    row(ui, "breath", if input.site.visit.breath { "wanted" } else { "off: visitors press and hold" }, false);
    row(ui, "exhibit", input.frame.exhibit.id.clone(), false);
}

/// The microphone, its foam, and what is heard of a breath.
fn microphone(ui: &mut Ui, input: &PanelInput) {
    let frame = input.frame;
    let breath = &frame.current.breath;
    let heard = &breath.estimate;
    let (audio, microphone) = (&frame.load.audio, &frame.load.microphone);
    let capsules = if audio.capsules == 2 { ", two capsules" } else { "" };
    let missing = !frame.hears && audio.input != DeviceState::Closed;
    row(ui, "microphone", format!("{}{capsules}", audio.input), missing);
    let level = if frame.hears {
        format!("{:6.1} dBFS, floor {:6.1}", heard.level_dbfs, heard.floor_dbfs)
    } else {
        "nothing arrives".into()
    };
    row(ui, "level", level, heard.clipping);
    let clips = format!("{} times, {} without a breath", microphone.clips, microphone.clips_without_breath);
    row(ui, "at full scale", clips, microphone.clips_lately());
    let foam = input.persisted.self_test.foam_breaths(input.persisted.counters.breaths());
    let lasts = u64::from(input.site.maintenance.foam_blows);
    let said = if lasts > 0 { format!("{foam} breaths of {lasts}") } else { format!("{foam} breaths") };
    row(ui, "foam", said, lasts > 0 && foam >= lasts);
    match &input.persisted.self_test.last {
        Some((verdict, when)) => row(ui, "chirp", format!("{verdict}; {when}"), verdict.is_bad()),
        None => row(ui, "chirp", "none yet", false),
    }
    row(ui, "gain control", if heard.gain_control { "seen" } else { "none seen" }, heard.gain_control);
    row(ui, "detector", format!("{:?}, {:.2}", heard.reason, heard.confidence), false);
    row(ui, "breath", format!("{:5.2} m/s heard, {:5.2} m/s blown", heard.speed, breath.speed), false);
}

/// What moves, and how well the thread that moves it keeps up.
fn motion(ui: &mut Ui, input: &PanelInput) {
    let (frame, load) = (input.frame, &input.frame.load);
    let state = &frame.current.diagnostics;
    row(ui, "wind force", format!("{:.4} N", state.wind_force.length()), false);
    row(ui, "attract mode", if frame.attracts { "playing" } else { "waiting" }, false);
    row(ui, "joint error", format!("{:.2e} m", state.joint_error), state.joint_error > 1e-3);
    row(ui, "energy", format!("{:.4} J", state.energy), false);
    row(ui, "substeps", state.substeps.to_string(), false);
    row(ui, "impacts", state.impacts.to_string(), false);
    row(ui, "faults", state.faults.to_string(), state.faults > 0);
    row(ui, "step", format!("{:.3} ms of 4.167", 1e3 * load.step_s), load.step_s > 1.0 / 240.0);
    let changes = load.mode_changes;
    row(ui, "moved by", format!("{}, {changes} changes", state.mode.name()), state.mode != MotionMode::Dynamic);
    row(ui, "hands", state.grabs.to_string(), false);
    row(ui, "steps dropped", load.dropped.to_string(), false);
    row(ui, "commands dropped", load.commands_dropped.to_string(), load.commands_dropped > 0);
}

fn picture(ui: &mut Ui, input: &PanelInput) {
    let vitals = &input.vitals;
    let [width, height] = vitals.size;
    row(ui, "picture", format!("{:.1} ms, {width}x{height}", 1e3 * vitals.frame_s), false);
    row(ui, "wind to picture", format!("{:.0} ms", 1e3 * vitals.onset_latency_s), vitals.onset_latency_s > 0.25);
    row(ui, "graphics", vitals.adapter, false);
    for (kind, state) in &input.frame.load.controllers {
        let (State::Listening(said) | State::Waiting(said)) = state;
        row(ui, kind, said.clone(), false);
    }
}

fn output(ui: &mut Ui, input: &PanelInput) {
    let audio = &input.frame.load.audio;
    row(ui, "loudspeaker", audio.output.to_string(), false);
    if let Some(state) = &audio.hearing_loop {
        row(ui, "hearing loop", state.to_string(), !matches!(state, DeviceState::Ok { .. }));
    }
    if let Some(delay) = &audio.delay {
        row(ui, "step to sound", sound_delay(delay), false);
        row(ui, "block", block(delay.block_s, input.site.audio.block_ms, audio.shortest_block_s), false);
    }
    row(ui, "late blocks", audio.xruns.to_string(), audio.xruns > 0);
    row(ui, "sounds lost", audio.lost.to_string(), audio.lost > 0);
}

/// What a sound waits for, part by part.
fn sound_delay(delay: &SoundDelay) -> String {
    let ms = |seconds: f64| format!("{:.1}", 1e3 * seconds);
    let device = delay.device_s.map_or("device says nothing".into(), |device| format!("device {}", ms(device)));
    let (step, block, limiter) = (ms(delay.step_s), ms(delay.block_s), ms(delay.limiter_s));
    format!("{} ms: step {step}, block {block}, limiter {limiter}, {device}", ms(delay.total_s()))
}

/// The block that plays, beside the one asked for and a shorter one that the device offers.
fn block(plays_s: f64, wanted_ms: f64, shortest_s: Option<f64>) -> String {
    let said = format!("{:.1} ms, {wanted_ms:.1} wanted", 1e3 * plays_s);
    match shortest_s.map(|shortest| 1e3 * shortest) {
        Some(shortest) if shortest <= SHORT_BLOCK_MS && wanted_ms > SHORT_BLOCK_MS => {
            format!("{said}; audio.block_ms = {SHORT_BLOCK_MS:.0} is possible here")
        }
        Some(shortest) if shortest > wanted_ms => format!("{said}; the device's shortest is {shortest:.1}"),
        _ => said,
    }
}

fn loudness(ui: &mut Ui, input: &PanelInput) {
    let loud = &input.frame.load.loudness;
    let muted = if loud.muted { ", muted" } else { "" };
    let eased = if loud.eased_db > 0.0 { format!(", {:.1} dB eased", loud.eased_db) } else { String::new() };
    row(ui, "volume", format!("{:.1} dB, {:+} steps{eased}{muted}", loud.volume_db, loud.steps), loud.muted);
    let by = match loud.by {
        NightBy::Hours => "the hours",
        NightBy::Night | NightBy::Day => "staff",
    };
    row(ui, "sound of the", format!("{}, by {by}", if loud.night { "night" } else { "day" }), false);
    for (name, level, laeq) in
        [("level, minute", loud.level_db[0], loud.laeq_db[0]), ("level, day", loud.level_db[1], loud.laeq_db[1])]
    {
        let value = match laeq {
            Some(laeq) => format!("{laeq:.1} dB(A)"),
            None if level.is_finite() => format!("{level:.1} dB(A) of full scale, not calibrated"),
            None => "silent".into(),
        };
        row(ui, name, value, false);
    }
}

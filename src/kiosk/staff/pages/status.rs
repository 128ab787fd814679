//! Is it well? Every number that says so, and what staff do every day.

use egui::{Grid, Ui};

use super::style::{BAD, ROW, row};
use crate::staff::sight::Sight;
use crate::staff::wish::Wish;
use crate::venue::loudness::NightBy;
use soffio_devices::audio::DeviceState;
use soffio_devices::controllers::State;
use soffio_simulation::MotionMode;

/// The buttons of every day, then all numbers.
pub fn show(ui: &mut Ui, sight: &Sight, may: bool, wishes: &mut Vec<Wish>) {
    buttons(ui, sight, may, wishes);
    for says in sight.site_says {
        ui.colored_label(BAD, format!("configuration: {says}"));
    }
    for remedy in sight.frame.load.microphone.remedies() {
        ui.colored_label(BAD, format!("microphone: {remedy}"));
    }
    ui.separator();
    Grid::new("numbers").num_columns(2).min_row_height(ROW).spacing([24.0, 3.0]).show(ui, |ui| numbers(ui, sight));
}

fn buttons(ui: &mut Ui, sight: &Sight, may: bool, wishes: &mut Vec<Wish>) {
    let muted = sight.frame.load.loudness.muted;
    let early = sight.house.is_early();
    ui.add_enabled_ui(may, |ui| {
        ui.horizontal_wrapped(|ui| {
            let mut all = vec![
                ("Clean the glass, 60 s", Wish::Clean),
                (if muted { "Sound on" } else { "Mute" }, Wish::Mute),
                ("Night", Wish::Night),
                ("Reset", Wish::Reset),
                ("Reload exhibit", Wish::Reload),
            ];
            if early || !sight.house.is_open() {
                all.push((if early { "Close the house again" } else { "Open now" }, Wish::Open));
            }
            if sight.site.visit.breath {
                all.extend([
                    ("Chirp", Wish::Chirp),
                    ("New foam", Wish::FoamChanged),
                    ("Listen anew", Wish::ListenAnew),
                ]);
            }
            all.push(("End the kiosk", Wish::Close));
            for (name, asked) in all {
                if ui.button(name).clicked() {
                    wishes.push(asked);
                }
            }
        });
    });
}

/// The numbers, one a row.
fn numbers(ui: &mut Ui, sight: &Sight) {
    let (frame, vitals) = (sight.frame, &sight.vitals);
    let breath = &frame.current.breath;
    let heard = &breath.estimate;
    let state = &frame.current.diagnostics;
    let (audio, microphone) = (&frame.load.audio, &frame.load.microphone);
    let mut row = |name: &str, value: String, bad: bool| row(ui, name, value, bad);
    let house = match (sight.house.is_open(), sight.house.is_early()) {
        (true, false) => "open",
        (true, true) => "open, by staff, before its hours",
        (false, _) => "closed",
    };
    row("house", house.into(), false);
    row("breath", if sight.site.visit.breath { "wanted" } else { "off: visitors press and hold" }.into(), false);
    row("exhibit", frame.exhibit.id.clone(), false);
    let capsules = if audio.capsules == 2 { ", two capsules" } else { "" };
    let missing = !frame.hears && audio.input != DeviceState::Closed;
    row("microphone", format!("{}{capsules}", audio.input), missing);
    let level = if frame.hears {
        format!("{:6.1} dBFS, floor {:6.1}", heard.level_dbfs, heard.floor_dbfs)
    } else {
        "nothing arrives".into()
    };
    row("level", level, heard.clipping);
    let clips = format!("{} times, {} without a breath", microphone.clips, microphone.clips_without_breath);
    row("at full scale", clips, microphone.clips_lately());
    let foam = sight.kept.care.foam(sight.kept.tally.breaths());
    let lasts = u64::from(sight.site.care.foam_blows);
    let said = if lasts > 0 { format!("{foam} breaths of {lasts}") } else { format!("{foam} breaths") };
    row("foam", said, lasts > 0 && foam >= lasts);
    match &sight.kept.care.last {
        Some((verdict, when)) => row("chirp", format!("{verdict}; {when}"), verdict.is_bad()),
        None => row("chirp", "none yet".into(), false),
    }
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
    if let Some(state) = &audio.hearing_loop {
        row("hearing loop", state.to_string(), !matches!(state, DeviceState::Ok { .. }));
    }
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
}

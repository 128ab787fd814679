//! Is it well? Every number that says so, and what staff do every day.

use std::sync::Arc;

use egui::{Grid, Ui};

use super::states::{clips, decision, device, gain_control, mode, remedy_text, verdict};
use super::style::{BAD, ROW, row};
use crate::pages::ui_strings::{TextId, UiStrings, Variable};
use crate::staff::action::StaffAction;
use crate::staff::panel_input::PanelInput;
use crate::venue::loudness::NightBy;
use soffio_config::Breath;
use soffio_devices::audio::{DeviceState, SoundDelay};
use soffio_devices::controllers::State;
use soffio_simulation::MotionMode;

/// Block that the panel proposes where the device offers it, ms: half of the default, and still longer than a step.
const SHORT_BLOCK_MS: f64 = 5.0;
/// Time after which the ambient spread is shown, s.
const KNOWN_S: f64 = 60.0;

/// The buttons of every day, then all numbers.
pub fn show(ui: &mut Ui, input: &PanelInput, may: bool, actions: &mut Vec<StaffAction>) {
    buttons(ui, input, may, actions);
    let texts = input.texts;
    for problem in input.config_problems {
        let message = problem.as_str().into();
        ui.colored_label(BAD, &*texts.format(TextId::StaffConfigurationSays, &[("message", message)]));
    }
    for remedy in input.frame.load.microphone.remedies() {
        let message = remedy_text(texts, remedy).into();
        ui.colored_label(BAD, &*texts.format(TextId::StaffMicrophoneSays, &[("message", message)]));
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
                (TextId::StaffClean, StaffAction::Clean),
                (if muted { TextId::StaffUnmute } else { TextId::StaffMute }, StaffAction::Mute),
                (TextId::StaffNight, StaffAction::Night),
                (TextId::StaffReset, StaffAction::Reset),
                (TextId::StaffReload, StaffAction::Reload),
            ];
            if early || !input.venue.is_open() {
                all.push((if early { TextId::StaffCloseAgain } else { TextId::StaffOpenNow }, StaffAction::Open));
            }
            if input.site.visit.breath {
                all.extend([
                    (TextId::StaffAudioSelfTest, StaffAction::SelfTest),
                    (TextId::StaffNewFoam, StaffAction::FoamChanged),
                    (TextId::StaffNewReference, StaffAction::ResetSelfTest),
                ]);
            }
            all.push((TextId::StaffEnd, StaffAction::Close));
            for (name, action) in all {
                if ui.button(input.texts.get(name)).clicked() {
                    actions.push(action);
                }
            }
        });
    });
}

/// How sure the detector is here, by the recordings of the venue: a sentence.
fn detected(texts: &UiStrings, breath: &Breath) -> Arc<str> {
    match breath.detected_of {
        0 => texts.get(TextId::StaffHeardUnknown).into(),
        of => {
            let distance = format!("{:.0}", breath.detected_at_cm).into();
            let variables = [("detected", breath.detected.into()), ("of", of.into()), ("distance", distance)];
            texts.format(TextId::StaffHeardOf, &variables)
        }
    }
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
    let texts = input.texts;
    let venue = match (input.venue.is_open(), input.venue.is_early()) {
        (true, false) => TextId::StaffVenueOpen,
        (true, true) => TextId::StaffVenueEarly,
        (false, _) => TextId::StaffVenueClosed,
    };
    row(ui, texts.get(TextId::StaffVenue), texts.get(venue), false);
    let breath = if input.site.visit.breath { TextId::StaffBreathAllowed } else { TextId::StaffBreathOff };
    row(ui, texts.get(TextId::StaffBreathWanted), texts.get(breath), false);
    row(ui, texts.get(TextId::StaffExhibit), &input.frame.exhibit.id, false);
}

/// Microphone, foam and breath detection.
fn microphone(ui: &mut Ui, input: &PanelInput) {
    let (frame, texts) = (input.frame, input.texts);
    let breath = &frame.current.breath;
    let estimate = &breath.estimate;
    let (audio, microphone) = (&frame.load.audio, &frame.load.microphone);
    let missing = !frame.hears && audio.input != DeviceState::Closed;
    let mut input_device = device(texts, &audio.input);
    if audio.capsules == 2 {
        let name = input_device.into();
        input_device = texts.format(TextId::StaffMicrophoneDual, &[("device", name)]).to_string();
    }
    row(ui, texts.get(TextId::StaffMicrophone), input_device, missing);
    if frame.hears {
        let [level, floor] = [estimate.level_dbfs, estimate.floor_dbfs].map(|level| format!("{level:6.1}").into());
        let levels = texts.format(TextId::StaffLevelFloor, &[("level", level), ("floor", floor)]);
        row(ui, texts.get(TextId::StaffLevel), levels, estimate.clipping);
    } else {
        row(ui, texts.get(TextId::StaffLevel), texts.get(TextId::StaffNoSignal), estimate.clipping);
    }
    row(ui, texts.get(TextId::StaffClipping), clips(texts, microphone), microphone.clips_lately());
    let foam = input.persisted.self_test.foam_breaths(input.persisted.counters.breaths());
    let limit = u64::from(input.site.maintenance.foam_blows);
    let breaths = match limit {
        0 => texts.format(TextId::StaffFoamBreaths, &[("count", foam.into())]),
        limit => texts.format(TextId::StaffFoamBreathsOf, &[("count", foam.into()), ("limit", limit.into())]),
    };
    row(ui, texts.get(TextId::StaffFoam), breaths, limit > 0 && foam >= limit);
    match &input.persisted.self_test.last {
        Some((last, when)) => {
            let variables = [("verdict", verdict(texts, last).into()), ("when", when.as_str().into())];
            let text = texts.format(TextId::StaffSelfTestWhen, &variables);
            row(ui, texts.get(TextId::StaffSelfTest), text, last.is_bad());
        }
        None => row(ui, texts.get(TextId::StaffSelfTest), texts.get(TextId::StaffSelfTestNone), false),
    }
    row(ui, texts.get(TextId::StaffHeard), detected(texts, &input.site.breath), false);
    if let Some(ambient_spread) =
        frame.load.ambient_spread.filter(|ambient_spread| ambient_spread.bands.seconds >= KNOWN_S)
    {
        let gusts = texts.format(TextId::StaffGustsCost, &[("db", format!("{:.0}", ambient_spread.gusts_db()).into())]);
        row(ui, texts.get(TextId::StaffGusts), gusts, false);
    }
    row(ui, texts.get(TextId::StaffGainControl), gain_control(texts, estimate), estimate.gain_control);
    row(ui, texts.get(TextId::StaffDetector), decision(texts, estimate), false);
    let [detected, blown] = [estimate.speed, breath.speed].map(|speed| format!("{speed:5.2}").into());
    let speeds = texts.format(TextId::StaffBreathSpeeds, &[("detected", detected), ("blown", blown)]);
    row(ui, texts.get(TextId::StaffBreath), speeds, false);
}

/// Motion, and the load of the simulation thread.
fn motion(ui: &mut Ui, input: &PanelInput) {
    let (frame, load, texts) = (input.frame, &input.frame.load, input.texts);
    let state = &frame.current.diagnostics;
    let attract = if frame.attracts { TextId::StaffAttractPlaying } else { TextId::StaffAttractWaiting };
    row(ui, texts.get(TextId::StaffWindForce), format!("{:.4} N", state.wind_force.length()), false);
    row(ui, texts.get(TextId::StaffAttract), texts.get(attract), false);
    let error = format!("{:.2e} m", state.joint_error);
    row(ui, texts.get(TextId::StaffJointError), error, state.joint_error > 1e-3);
    row(ui, texts.get(TextId::StaffEnergy), format!("{:.4} J", state.energy), false);
    row(ui, texts.get(TextId::StaffSubsteps), state.substeps.to_string(), false);
    row(ui, texts.get(TextId::StaffImpacts), state.impacts.to_string(), false);
    row(ui, texts.get(TextId::StaffFaults), state.faults.to_string(), state.faults > 0);
    let ms = format!("{:.3}", 1e3 * load.step_s).into();
    let step = texts.format(TextId::StaffStepTime, &[("ms", ms), ("limit", "4.167".into())]);
    row(ui, texts.get(TextId::StaffStep), step, load.step_s > 1.0 / 240.0);
    let mode = texts.get(mode(state.mode)).into();
    let changes = texts.format(TextId::StaffMotionChanges, &[("mode", mode), ("count", load.mode_changes.into())]);
    row(ui, texts.get(TextId::StaffMotion), changes, state.mode != MotionMode::Dynamic);
    row(ui, texts.get(TextId::StaffPointerGrabs), state.grabs.to_string(), false);
    row(ui, texts.get(TextId::StaffStepsDropped), load.dropped.to_string(), false);
    row(ui, texts.get(TextId::StaffCommandsDropped), load.commands_dropped.to_string(), load.commands_dropped > 0);
}

fn picture(ui: &mut Ui, input: &PanelInput) {
    let (vitals, texts) = (&input.vitals, input.texts);
    let [width, height] = vitals.size;
    row(ui, texts.get(TextId::StaffPicture), format!("{:.1} ms, {width}x{height}", 1e3 * vitals.frame_s), false);
    row(
        ui,
        texts.get(TextId::StaffWindToPicture),
        format!("{:.0} ms", 1e3 * vitals.onset_latency_s),
        vitals.onset_latency_s > 0.25,
    );
    row(ui, texts.get(TextId::StaffGraphics), vitals.adapter, false);
    for (kind, state) in &input.frame.load.controllers {
        let (State::Listening(said) | State::Waiting(said)) = state;
        row(ui, kind, said, false);
    }
}

fn output(ui: &mut Ui, input: &PanelInput) {
    let (audio, texts) = (&input.frame.load.audio, input.texts);
    row(ui, texts.get(TextId::StaffLoudspeaker), device(texts, &audio.output), false);
    if let Some(state) = &audio.hearing_loop {
        let missing = !matches!(state, DeviceState::Ok { .. });
        row(ui, texts.get(TextId::StaffHearingLoop), device(texts, state), missing);
    }
    if let Some(delay) = &audio.delay {
        row(ui, texts.get(TextId::StaffStepToSound), sound_delay(texts, delay), false);
        let block = block(texts, delay.block_s, input.site.audio.block_ms, audio.shortest_block_s);
        row(ui, texts.get(TextId::StaffBlock), block, false);
    }
    row(ui, texts.get(TextId::StaffLateBlocks), audio.xruns.to_string(), audio.xruns > 0);
    row(ui, texts.get(TextId::StaffSoundsLost), audio.lost.to_string(), audio.lost > 0);
}

/// Latency from a step to its sound, by parts.
fn sound_delay(texts: &UiStrings, delay: &SoundDelay) -> Arc<str> {
    let ms = |seconds: f64| Variable::from(format!("{:.1}", 1e3 * seconds));
    let parts = [
        ("total", ms(delay.total_s())),
        ("step", ms(delay.step_s)),
        ("block", ms(delay.block_s)),
        ("limiter", ms(delay.limiter_s)),
    ];
    match delay.device_s {
        None => texts.format(TextId::StaffSoundDelayUnknown, &parts),
        Some(device) => {
            let parts: Vec<_> = parts.into_iter().chain([("device", ms(device))]).collect();
            texts.format(TextId::StaffSoundDelay, &parts)
        }
    }
}

/// Length of the output's block, beside the configured one and a shorter one that the device offers.
fn block(texts: &UiStrings, plays_s: f64, wanted_ms: f64, shortest_s: Option<f64>) -> Arc<str> {
    let ms = ("ms", Variable::from(format!("{:.1}", 1e3 * plays_s)));
    let wanted = ("wanted", Variable::from(format!("{wanted_ms:.1}")));
    match shortest_s.map(|shortest| 1e3 * shortest) {
        Some(shortest) if shortest <= SHORT_BLOCK_MS && wanted_ms > SHORT_BLOCK_MS => {
            let possible = format!("{SHORT_BLOCK_MS:.0}").into();
            texts.format(TextId::StaffBlockShorter, &[ms, wanted, ("possible", possible)])
        }
        Some(shortest) if shortest > wanted_ms => {
            let shortest = format!("{shortest:.1}").into();
            texts.format(TextId::StaffBlockShortest, &[ms, wanted, ("shortest", shortest)])
        }
        _ => texts.format(TextId::StaffBlockIs, &[ms, wanted]),
    }
}

fn loudness(ui: &mut Ui, input: &PanelInput) {
    let (loud, texts) = (&input.frame.load.loudness, input.texts);
    let (db, steps) = (format!("{:.1}", loud.volume_db).into(), format!("{:+}", loud.steps).into());
    let mut volume = texts.format(TextId::StaffVolumeIs, &[("db", db), ("steps", steps)]);
    if loud.exposure_attenuation_db > 0.0 {
        let variables = [("volume", (&*volume).into()), ("db", format!("{:.1}", loud.exposure_attenuation_db).into())];
        volume = texts.format(TextId::StaffVolumeAttenuated, &variables);
    }
    if loud.muted {
        volume = texts.format(TextId::StaffVolumeMuted, &[("volume", (&*volume).into())]);
    }
    row(ui, texts.get(TextId::StaffVolume), volume, loud.muted);
    let mode = texts.get(if loud.night { TextId::StaffSoundNight } else { TextId::StaffSoundDay });
    let by = match loud.by {
        NightBy::Hours => TextId::StaffSoundByHours,
        NightBy::Night | NightBy::Day => TextId::StaffSoundByStaff,
    };
    row(ui, texts.get(TextId::StaffSoundOfThe), texts.format(by, &[("mode", mode.into())]), false);
    for (name, level, laeq) in [
        (TextId::StaffLevelMinute, loud.level_db[0], loud.laeq_db[0]),
        (TextId::StaffLevelDay, loud.level_db[1], loud.laeq_db[1]),
    ] {
        let db = |level: f64| [("db", Variable::from(format!("{level:.1}")))];
        let value = match laeq {
            Some(laeq) => texts.format(TextId::StaffLevelCalibrated, &db(laeq)),
            None if level.is_finite() => texts.format(TextId::StaffLevelUncalibrated, &db(level)),
            None => texts.get(TextId::StaffLevelSilent).into(),
        };
        row(ui, texts.get(name), value, false);
    }
}

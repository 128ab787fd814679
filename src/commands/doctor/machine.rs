//! Screen, graphics and sound of this machine.

use std::time::{Duration, Instant};

use super::finding::{Finding, Health};
use super::microphone::{judge_blow, judge_low_tones, judge_room};
use indicatif::{ProgressBar, ProgressStyle};
use soffio_config::{Config, remedies};
use soffio_detector::bands;
use soffio_detector::{BlowDetector, BlowEstimate, BlowSettings, Reason};
use soffio_devices::audio::{AudioIo, DeviceState, MicrophoneSamples};
use soffio_kiosk::fleet::persisted;
use soffio_kiosk::pages::fonts::{self, Script};
use soffio_kiosk::pages::languages::languages_without_glyphs;
use soffio_kiosk::pages::speech_synthesis::SpeechSynthesizer;
use soffio_kiosk::pages::ui_strings::{SHIPPED, Translations};
use soffio_kiosk::venue::self_test::REFERENCE_RUNS;
use soffio_kiosk::venue::self_test_run::{SelfTestAction, SelfTestRun};
use soffio_kiosk::window;
use soffio_render::Gpu;
use soffio_sound::{BANDS, Synth};

/// Length of the recording of the room.
const LISTEN: Duration = Duration::from_millis(1100);
/// Requested breaths: automatic gain control shows in two of three.
const BREATHS: usize = 3;
/// Longest wait for the breaths.
const PATIENCE: Duration = Duration::from_secs(20);
/// Time between two readings of the microphone, and length of the recording after the last breath.
const LOOK: Duration = Duration::from_millis(20);
const AFTER: Duration = Duration::from_millis(800);
/// Range of the meter, dB below full scale.
const METER: u64 = 80;
/// Longest wait for the devices to open.
const OPENING: Duration = Duration::from_secs(3);

/// Checks of the machine; with `blow` they need somebody who blows, with `audio_self_test` a sweep is played.
pub fn look(config: &Config, blow: bool, self_test: bool) -> Vec<Finding> {
    let mut findings = vec![display(), graphics(), reading(config)];
    findings.extend(Script::ALL.map(writing));
    findings.extend(sound(config, blow, self_test));
    findings
}

fn display() -> Finding {
    let finding = match window::event_loop() {
        Ok(_) => Finding::new("display", Health::Ok, "windows can be opened", ""),
        Err(error) => {
            let remedy = "start it in a graphical session, where DISPLAY or WAYLAND_DISPLAY is set; without one \
                          the exhibit runs into files";
            Finding::new("display", Health::Bad, error, remedy)
        }
    };
    finding.of_device()
}

fn graphics() -> Finding {
    let finding = match Gpu::headless() {
        Ok(gpu) if gpu.is_software() => {
            let remedy = "the processor draws, a few pictures a second: install the graphics card's Vulkan driver";
            Finding::new("graphics", Health::Warn, gpu.name(), remedy)
        }
        Ok(gpu) => Finding::new("graphics", Health::Ok, gpu.name(), ""),
        Err(error) => {
            let remedy = "install a Vulkan driver; mesa-vulkan-drivers has one for every machine";
            Finding::new("graphics", Health::Bad, error.to_string(), remedy)
        }
    };
    finding.of_device()
}

fn writing(script: Script) -> Finding {
    let (what, package) = match script {
        Script::EastAsian => ("fonts for Chinese, Japanese and Korean", "fonts-noto-cjk or fonts-nanum"),
        Script::Hebrew => ("font for Hebrew", "fonts-noto-core or fonts-dejavu-core"),
        Script::Arabic => ("font for Arabic, Persian and Urdu", "fonts-noto-core or fonts-dejavu-core"),
    };
    let without_glyphs = || languages_without_glyphs(&Translations::default());
    match fonts::find(script) {
        Some((file, _)) if script == Script::EastAsian && !without_glyphs().is_empty() => {
            let found = format!("{} lacks letters of: {}", file.display(), without_glyphs().join(", "));
            let remedy = "install fonts-noto-cjk; until then labels in these languages are not offered";
            Finding::new(what, Health::Warn, found, remedy)
        }
        Some((file, _)) => Finding::new(what, Health::Ok, file.display().to_string(), ""),
        None => {
            let remedy = format!("install {package}; until then labels in these languages are not offered");
            Finding::new(what, Health::Warn, "none found", remedy)
        }
    }
}

/// Checks reading aloud in each language of the kiosk.
fn reading(config: &Config) -> Finding {
    let what = "reading aloud";
    if config.visit.read_aloud.is_empty() {
        return Finding::new(what, Health::Ok, "visit.read_aloud is empty: nothing is read", "");
    }
    match SpeechSynthesizer::detect(&config.visit.read_aloud) {
        Ok(speaker) => {
            let can = |can: bool| {
                let codes = SHIPPED.iter().map(|(code, _)| *code).filter(|code| speaker.can_speak(code) == can);
                codes.collect::<Vec<_>>().join(", ")
            };
            let (reads, not) = (can(true), can(false));
            let not = if not.is_empty() { not } else { format!("; not {not}, which has no button to press") };
            Finding::new(what, Health::Ok, format!("{}: {reads}{not}", config.visit.read_aloud), "")
        }
        Err(error) => {
            let remedy = "install espeak-ng, or name another program in visit.read_aloud; until then there is no \
                          button \"Read aloud\"";
            Finding::new(what, Health::Warn, error, remedy)
        }
    }
}

fn sound(config: &Config, blow: bool, self_test: bool) -> Vec<Finding> {
    let mut audio = AudioIo::start(&config.audio, Synth::silent);
    let mut samples = MicrophoneSamples::default();
    let mut rate = None;
    let began = Instant::now();
    let mut opened = None;
    // Devices open on a thread of their own; the second of listening begins with the first samples.
    while opened.map_or(began.elapsed() < OPENING, |at: Instant| at.elapsed() < LISTEN) {
        std::thread::sleep(LOOK);
        rate = audio.read_microphone(&mut samples).or(rate);
        if opened.is_none() && !samples.samples.is_empty() {
            opened = Some(Instant::now());
        }
    }
    let status = audio.status();
    let device = |what: &str, state: &DeviceState, without: &str| {
        let finding = match state {
            DeviceState::Ok { .. } => Finding::new(what, Health::Ok, state.to_string(), ""),
            _ => {
                let remedy = format!("connect one, or name it in [audio]; until then {without}");
                Finding::new(what, Health::Bad, state.to_string(), remedy)
            }
        };
        finding.of_device()
    };
    let mut findings = vec![
        device("loudspeaker", &status.output, "all is silent"),
        device("microphone", &status.input, "visitors press and hold to blow"),
    ];
    if let Some(rate) = rate {
        if config.audio.second_microphone_channel > 0 || status.capsules > 1 {
            findings.push(second_microphone(status.capsules).of_device());
        }
        findings.push(judge_room(&samples.samples, rate).of_device());
        if self_test {
            findings.push(audio_self_test(config, &mut audio).of_device());
        }
        if blow {
            let sensitivity_db = config.breath.sensitivity_db;
            let threshold = config.breath.threshold;
            let settings = BlowSettings { sensitivity_db, threshold, ..Default::default() };
            let mut detector = BlowDetector::with_settings(rate, settings);
            samples.share(0, 1, rate).feed(&mut detector);
            let (steps, levels) = listen(&mut audio, &mut detector);
            findings.push(judge_blow(&steps, sensitivity_db).of_device());
            findings.extend(levels.and_then(|levels| judge_low_tones(&levels)).map(Finding::of_device));
        }
    }
    findings
}

/// Runs the audio self-test, and compares the result with the stored reference.
fn audio_self_test(config: &Config, audio: &mut AudioIo) -> Finding {
    let what = "audio self-test";
    let (began, mut run, mut recorded) = (Instant::now(), SelfTestRun::default(), MicrophoneSamples::default());
    run.begin(0.0);
    let outcome = loop {
        std::thread::sleep(LOOK);
        recorded.clear();
        let rate = audio.read_microphone(&mut recorded);
        match run.update(began.elapsed().as_secs_f64(), &audio.status(), (&recorded.samples, rate)) {
            Some(SelfTestAction::PlaySweep(sweep)) => audio.say(&sweep),
            Some(SelfTestAction::Done(outcome)) => break outcome,
            None => {}
        }
    };
    let mut history =
        persisted::folder(config).and_then(|folder| persisted::read(&folder)).unwrap_or_default().self_test;
    if let Ok(response) = &outcome
        && history.reference_db.len() < REFERENCE_RUNS
    {
        let octaves = BANDS.iter().zip(response.levels_db).zip(response.clear);
        let said: Vec<String> = octaves
            .map(|((hz, db), clear)| format!("{hz:.0} Hz {}{db:.0} dB", if clear { "" } else { "below " }))
            .collect();
        let (health, remedy) = match response.clear.iter().filter(|clear| **clear).count() {
            0 => (Health::Bad, "the sweep does not arrive: check the loudspeaker, its amplifier and the microphone"),
            1..4 => (
                Health::Warn,
                "most of the sweep is lost in noise: turn the loudspeaker up, or clear the path to the microphone",
            ),
            _ => (Health::Ok, ""),
        };
        return Finding::new(what, health, format!("{}; no reference to compare with yet", said.join(", ")), remedy);
    }
    match history.record(&outcome, String::new()) {
        verdict if verdict.is_bad() => {
            let remedy =
                "correct it, and test again; after an intended change measure a new reference on the staff panel";
            Finding::new(what, Health::Bad, verdict.to_string(), remedy)
        }
        verdict => Finding::new(what, Health::Ok, verdict.to_string(), ""),
    }
}

fn second_microphone(microphones: usize) -> Finding {
    let what = "second microphone";
    match microphones {
        2 => Finding::new(what, Health::Ok, "it works", ""),
        _ => Finding::new(what, Health::Warn, "the microphone has no such channel", remedies::NO_SECOND_MICROPHONE),
    }
}

/// Asks for breaths and measures them, with a meter on the terminal. Also returns the mean level of each band during them.
fn listen(audio: &mut AudioIo, detector: &mut BlowDetector) -> (Vec<BlowEstimate>, Option<[f64; bands::BANDS]>) {
    eprintln!(
        "Blow at the microphone from where visitors stand, as they would: {BREATHS} times, a second or two each, with \
         a pause of two seconds between."
    );
    let began = Instant::now();
    let meter = ProgressBar::new(METER)
        .with_style(ProgressStyle::with_template("[{bar:40}] {msg}").unwrap_or_else(|_| ProgressStyle::default_bar()));
    let (mut steps, mut samples): (Vec<BlowEstimate>, _) = (Vec::new(), MicrophoneSamples::default());
    let (mut levels, mut blown) = ([0.0; bands::BANDS], 0.0);
    let (mut breaths, mut quiet_since, mut clips) = (0, Instant::now(), 0);
    // Until a moment after the last breath, or until nobody blows any more.
    while began.elapsed() < PATIENCE && (breaths < BREATHS || quiet_since.elapsed() < AFTER) {
        std::thread::sleep(LOOK);
        samples.clear();
        let Some(rate) = audio.read_microphone(&mut samples) else { break };
        samples.share(0, 1, rate).feed(detector);
        let (before, step) = (steps.last().copied().unwrap_or_default(), detector.estimate());
        if step.reason == Reason::Blow {
            breaths += usize::from(before.reason != Reason::Blow);
            quiet_since = Instant::now();
            blown += 1.0;
            levels.iter_mut().zip(detector.band_levels()).for_each(|(mean, level)| *mean += (level - *mean) / blown);
        }
        clips += usize::from(step.clipping && !before.clipping);
        let BlowEstimate { level_dbfs, floor_dbfs, reason, .. } = step;
        meter.set_position((level_dbfs + METER as f64).clamp(0.0, METER as f64) as u64);
        meter.set_message(format!(
            "{level_dbfs:4.0} dBFS, floor {floor_dbfs:4.0}, {clips} times at full scale, breath {breaths}: {reason:?}"
        ));
        steps.push(step);
    }
    meter.finish_and_clear();
    (steps, (blown > 0.0).then_some(levels))
}

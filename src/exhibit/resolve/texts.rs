//! Resolves label texts, credit, and the attract script with its breaths.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::super::diagnostic::Diagnostic;
use super::super::presentation::TAKE;
use super::super::quantity::{Angle, Quantity};
use super::super::source::join;
use super::super::view::{MAX_PITCH_DOWN, MAX_PITCH_UP, MAX_YAW};
use super::super::{Attract, AttractAction, AttractStep, Credit, Label, Labels, codes, files, sidecar};
use super::context::Context;
use soffio_soundscape::breath::{Breath, HARDEST_M_S};

/// Most bytes of a recorded breath.
const MAX_WAV_BYTES: u64 = 64 << 20;
/// Most memory of a recording over its size: the file, its samples and their mean over the channels.
const SAMPLE_GROWTH: u64 = 9;
/// Sample rate of a synthesised breath, Hz: the blow detector uses only frequencies below 6 kHz.
const BREATH_RATE: u32 = 16_000;
/// Silence before and after a synthesised breath, s, in which the detector measures its noise floor.
const QUIET_AROUND: f64 = 0.4;
/// Longest attack, hold or release of a synthesised breath, s.
const MAX_BREATH_SECONDS: f64 = 30.0;
/// Default pause after the last step of the script, s.
const PAUSE: f64 = 10.0;

impl Context<'_> {
    pub(super) fn labels(&mut self) -> Labels {
        let sidecar = self.sidecar;
        let order: Vec<String> =
            self.source.keys_of("/label").into_iter().filter(|key| key != "default_language").collect();
        let given = sidecar.label.default_language.clone();
        let default_language = given.or_else(|| order.first().cloned()).unwrap_or_else(|| "en".to_owned());
        let mut languages = Vec::new();
        for code in &order {
            let Some(texts) = sidecar.label.languages.get(code) else { continue };
            let at = join("/label", code);
            for (key, value) in [("title", &texts.title), ("alt", &texts.alt)] {
                if value.is_empty() {
                    let code_of = if key == "alt" { codes::NO_ALT } else { codes::MISSING_WORDS };
                    let problem = Diagnostic::new(code_of, format!("the label in \"{code}\" has no {key}"));
                    self.report(&at, problem.help(format!("write {key} = \"…\" there")));
                }
            }
            if texts.text.contains_key(TAKE) && !sidecar.touch.permitted {
                let message = format!("text \"{TAKE}\" invites the hand, but nobody may touch the exhibit");
                let problem = Diagnostic::new(codes::UNUSED, message);
                let help = "leave it out, or write [touch] permitted = true";
                self.report(&join(&join(&at, "text"), TAKE), problem.help(help));
            }
            languages.push((code.clone(), self.label(texts, &at)));
        }
        match sidecar.label.languages.get(&default_language) {
            Some(default) => self.compare_languages(default, &default_language),
            None if order.is_empty() => {}
            None => {
                let message = format!("there is no label in the default language \"{default_language}\"");
                self.report(
                    "/label/default_language",
                    Diagnostic::new(codes::NO_TEXT, message).help(format!("add [label.{default_language}]")),
                );
            }
        }
        for (i, sound) in sidecar.sound.iter().enumerate() {
            if let Some(key) = &sound.caption {
                self.require_text(key, "caption", &format!("/sound/{i}/caption"), |texts| &texts.caption);
            }
        }
        Labels { default_language, languages }
    }

    /// Label texts in the order of the file.
    fn label(&self, texts: &sidecar::LabelTexts, at: &str) -> Label {
        let ordered = |key: &str, map: &BTreeMap<String, String>| {
            let keys = self.source.keys_of(&join(at, key)).into_iter();
            keys.filter_map(|k| map.get(&k).map(|text| (k.clone(), text.clone()))).collect()
        };
        Label {
            title: texts.title.clone(),
            maker: texts.maker.clone(),
            body: texts.body.clone(),
            alt: texts.alt.clone(),
            text: ordered("text", &texts.text),
            caption: ordered("caption", &texts.caption),
        }
    }

    /// Warns where a language lacks texts of the default one.
    fn compare_languages(&mut self, default: &sidecar::LabelTexts, default_code: &str) {
        let sidecar = self.sidecar;
        for (code, texts) in sidecar.label.languages.iter().filter(|(code, _)| *code != default_code) {
            let pairs = [("text", &default.text, &texts.text), ("caption", &default.caption, &texts.caption)];
            for (kind, wanted, has) in pairs {
                for key in wanted.keys().filter(|key| !has.contains_key(*key)) {
                    let message = format!("{kind} \"{key}\" is missing in \"{code}\"");
                    let problem = Diagnostic::new(codes::MISSING_WORDS, message);
                    let label = format!("\"{default_code}\" has it and is shown instead");
                    let help =
                        format!("write {kind} = {{ {key} = \"…\" }} there; `soffio labels` makes a table of all texts");
                    self.report(&join("/label", code), problem.label(label).help(help));
                }
            }
        }
    }

    /// Reports a key without a text in any language.
    fn require_text(
        &mut self,
        key: &str,
        kind: &str,
        at: &str,
        map: fn(&sidecar::LabelTexts) -> &BTreeMap<String, String>,
    ) {
        let languages = &self.sidecar.label.languages;
        if !languages.values().any(|texts| map(texts).contains_key(key)) {
            let message = format!("no language has a {kind} \"{key}\"");
            let help = format!("add it: [label.en] {kind} = {{ {key} = \"…\" }}");
            self.report(at, Diagnostic::new(codes::NO_TEXT, message).help(help));
        }
    }

    pub(super) fn credit(&self) -> Credit {
        let given = &self.sidecar.credit;
        Credit {
            model_license: given.model_license.clone(),
            model_author: given.model_author.clone(),
            notice: given.notice.clone(),
            sources: given.sources.clone(),
        }
    }

    pub(super) fn attract(&mut self, labels: &Labels) -> Attract {
        let sidecar = self.sidecar;
        let mut steps: Vec<AttractStep> = Vec::new();
        for (i, given) in sidecar.attract.step.iter().enumerate() {
            let at = format!("/attract/step/{i}");
            let time = self.not_negative(given.at.0, &format!("{at}/at"));
            if steps.last().is_some_and(|last| last.at > time) {
                let message = format!("step {i} comes before the one above it");
                self.report(
                    &format!("{at}/at"),
                    Diagnostic::new(codes::ATTRACT_ORDER, message).help("write the steps in the order of time"),
                );
            }
            let Some(action) = self.action(given, labels, &at, i) else { continue };
            steps.push(AttractStep { at: time, action });
        }
        let last = steps.last().map_or(0.0, |step| step.at);
        let duration = sidecar.attract.duration.map_or(if steps.is_empty() { 0.0 } else { last + PAUSE }, |d| d.0);
        if duration < last {
            let message = format!("the script ends after {duration} s, but its last step is at {last} s");
            let problem = Diagnostic::new(codes::ATTRACT_ORDER, message);
            self.report("/attract/duration", problem.help("make it longer, or leave it out"));
        }
        Attract { steps, duration }
    }

    fn action(
        &mut self,
        given: &sidecar::AttractStep,
        labels: &Labels,
        at: &str,
        number: usize,
    ) -> Option<AttractAction> {
        match (&given.show, &given.blow, &given.camera, given.reset) {
            (Some(key), None, None, false) => {
                if !labels.languages.is_empty() {
                    self.require_text(key, "text", &format!("{at}/show"), |texts| &texts.text);
                }
                Some(AttractAction::Show(key.clone()))
            }
            (None, Some(blow), None, false) => {
                let place = format!("{at}/blow");
                if blow.aim.is_some_and(|aim| aim.iter().any(|x| !(0.0..=1.0).contains(x))) {
                    let problem = Diagnostic::new(codes::RANGE, "the aim lies outside the picture");
                    self.report(&format!("{place}/aim"), problem.help("(0,0) is top left, (1,1) bottom right"));
                }
                let (samples, sample_rate) = self.blow(blow, &place, number)?;
                Some(AttractAction::Blow { samples, sample_rate, aim: blow.aim })
            }
            (None, None, Some(turn), false) => {
                Some(AttractAction::Look(self.look(turn.map(Angle::si), &format!("{at}/camera"))))
            }
            (None, None, None, true) => Some(AttractAction::Reset),
            _ => {
                let problem = Diagnostic::new(codes::WRONG_SHAPE, "a step must have exactly one action");
                self.report(
                    at,
                    problem.help("give one of show, blow, camera and reset = true; two steps may have the same time"),
                );
                None
            }
        }
    }

    /// Orbit angles of the camera, rad, within the limits for visitors.
    fn look(&mut self, turn: [f64; 2], at: &str) -> [f64; 2] {
        let ends = [[-MAX_YAW, MAX_YAW], [-MAX_PITCH_DOWN, MAX_PITCH_UP]];
        for (i, (turn, [least, most])) in turn.into_iter().zip(ends).enumerate() {
            if !(least..=most).contains(&turn) {
                let degrees = |angle: f64| (angle.to_degrees() * 10.0).round() / 10.0;
                let problem =
                    Diagnostic::new(codes::RANGE, format!("the camera cannot orbit by {} deg", degrees(turn)));
                let help = format!("give {} to {} deg", degrees(least), degrees(most));
                self.report(&format!("{at}/{i}"), problem.help(help));
            }
        }
        turn
    }

    /// Samples and rate of a breath: recorded, or synthesised from its strength; `seed` makes two of them differ.
    fn blow(&mut self, given: &sidecar::Blow, at: &str, seed: usize) -> Option<(Arc<[f32]>, u32)> {
        let times = [("attack", given.attack), ("hold", given.hold), ("release", given.release)];
        match (&given.wav, given.strength) {
            (Some(wav), None) if times.iter().all(|(_, time)| time.is_none()) => match self.breath(wav) {
                Ok(breath) => Some(breath),
                Err(problem) => {
                    self.report(&format!("{at}/wav"), problem);
                    None
                }
            },
            (None, Some(strength)) => {
                let default = Breath::default();
                let mut seconds = [default.attack, default.hold, default.release];
                for (value, (key, time)) in seconds.iter_mut().zip(times) {
                    let Some(time) = time else { continue };
                    *value = time.0;
                    if !(0.0..=MAX_BREATH_SECONDS).contains(value) {
                        let problem =
                            Diagnostic::new(codes::RANGE, format!("{value} s is not a valid time of a breath"));
                        self.report(&format!("{at}/{key}"), problem.help(format!("give 0 to {MAX_BREATH_SECONDS} s")));
                        return None;
                    }
                }
                let [attack, hold, release] = seconds;
                let (speed, quiet) = (strength * HARDEST_M_S, QUIET_AROUND);
                let breath = Breath { lead_in: quiet, speed, attack, hold, release, lead_out: quiet, ..default };
                let samples = (seconds.iter().sum::<f64>() + 2.0 * quiet) * f64::from(BREATH_RATE);
                if !self.afford(samples as u64 * size_of::<f32>() as u64, "the breath", at) {
                    return None;
                }
                Some((breath.recorded(BREATH_RATE, seed as u64).into(), BREATH_RATE))
            }
            _ => {
                let problem = Diagnostic::new(codes::WRONG_SHAPE, "a breath needs either a recording or a strength");
                let help = "give wav alone, or strength, optionally with attack, hold and release";
                self.report(at, problem.help(help));
                None
            }
        }
    }

    /// Mono samples of a WAV in the exhibit folder.
    fn breath(&self, wav: &str) -> Result<(Arc<[f32]>, u32), Diagnostic> {
        let bytes = {
            let file = files::open_inside(self.folder, wav)?.within(MAX_WAV_BYTES)?;
            // Samples of 8 bits become samples of 32 bits.
            self.budget.charge(SAMPLE_GROWTH * file.size()).map_err(|excess| excess.diagnostic(wav))?;
            file.read()?
        };
        let broken = |error: hound::Error| {
            Diagnostic::new(codes::BREATH, format!("{wav} is not a WAV that can be read: {error}"))
                .help("PCM of 8 to 32 bits or 32-bit float")
        };
        let mut reader = hound::WavReader::new(bytes.as_slice()).map_err(broken)?;
        let spec = reader.spec();
        if !(1..=32).contains(&spec.bits_per_sample) {
            return Err(broken(hound::Error::Unsupported));
        }
        let samples: Result<Vec<f32>, _> = match spec.sample_format {
            hound::SampleFormat::Float => reader.samples::<f32>().collect(),
            hound::SampleFormat::Int => {
                let full = (1_i64 << (spec.bits_per_sample - 1)) as f32;
                reader.samples::<i32>().map(|s| s.map(|s| s as f32 / full)).collect()
            }
        };
        let channels = usize::from(spec.channels.max(1));
        let mono =
            samples.map_err(broken)?.chunks_exact(channels).map(|f| f.iter().sum::<f32>() / channels as f32).collect();
        Ok((mono, spec.sample_rate))
    }
}

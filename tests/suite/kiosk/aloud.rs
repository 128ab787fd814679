//! Reading aloud, by finger and by key, with a substitute for the system's speech program and with the system's own, down to the samples
//! of the output. The detector must not take the voice for a breath.

use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};

use soffio_detector::BlowDetector;
use soffio_devices::audio::{LOUDEST, Utterance};
use soffio_kiosk::pages::read_aloud::{ReadAloud, keeps_reading};
use soffio_kiosk::pages::speech_synthesis::SpeechSynthesizer;
use soffio_kiosk::pages::speech_text::SpokenText;
use soffio_kiosk::pages::ui_strings::TextId;
use soffio_kiosk::visitor::input::Request;
use soffio_offline::wav;

use super::pages::{Before, GLASSES, load, texts};

const RATE: u32 = 48_000;
/// A program that answers takes a fraction of a second, on a busy machine a few.
const LONG: Duration = Duration::from_secs(30);

/// A program with an English and an Italian voice that writes down what it is given and says a tone of half a second.
fn stand_in(folder: &Path) -> PathBuf {
    let tone: Vec<f32> = (0..11_025).map(|i| 0.3 * (0.2 * i as f32).sin()).collect();
    let spec = hound::WavSpec {
        channels: 1,
        sample_rate: 22_050,
        bits_per_sample: 16,
        sample_format: hound::SampleFormat::Int,
    };
    let mut writer = hound::WavWriter::create(folder.join("tone.wav"), spec).expect("a temporary file");
    tone.iter().for_each(|sample| writer.write_sample((sample * 32_767.0) as i16).expect("it is written"));
    writer.finalize().expect("it is written");
    let program = folder.join("reader");
    let here = folder.display();
    let script = format!(
        "#!/bin/sh\nif [ \"$1\" = --voices ]; then\n printf 'Pty Language Age VoiceName\\n 5 en-gb M x\\n 5 it M x\\n'\n\
         else\n echo \"$*\" >>{here}/said\n cat >>{here}/said\n cat {here}/tone.wav\nfi\n"
    );
    std::fs::write(&program, script).expect("a temporary file");
    std::fs::set_permissions(&program, std::fs::Permissions::from_mode(0o755)).expect("it can be run");
    program
}

/// Waits until there is something.
fn wait<T>(what: &str, mut there: impl FnMut() -> Option<T>) -> T {
    let began = Instant::now();
    loop {
        if let Some(it) = there() {
            return it;
        }
        assert!(began.elapsed() < LONG, "{what} never came");
        std::thread::sleep(Duration::from_millis(5));
    }
}

/// A visitor whose kiosk reads with this program.
fn before(program: &Path) -> (Before, ReadAloud) {
    let mut aloud = ReadAloud::default();
    let program = program.to_str().expect("a plain path");
    wait("the program's languages", || {
        aloud.configure(program);
        aloud.can_speak("en").then_some(())
    });
    (Before::new(&load("steel-fish"), GLASSES[0]), aloud)
}

/// What is asked for is read, and handed on once.
fn read(visitor: &mut Before, aloud: &mut ReadAloud) -> Utterance {
    visitor.look_with(|scene| aloud.start_requested(scene, RATE));
    assert!(aloud.is_on(), "it is being made");
    wait("the words", || aloud.update(false))
}

#[test]
fn a_press_reads_label_help_and_what_is_to_be_seen_in_the_language_shown() {
    let folder = tempfile::tempdir().expect("a folder");
    let (mut visitor, mut aloud) = before(&stand_in(folder.path()));
    visitor.menu.toggle();
    for language in ["en", "it"] {
        visitor.language = language.into();
        visitor.speech = Some(aloud.is_on());
        let buttons = visitor.look();
        let (rect, _) = buttons.iter().find(|(_, request)| *request == Request::ReadAloud).expect("a button");
        assert_eq!(visitor.press(rect.center()), Some(Request::ReadAloud));
        assert_eq!(aloud.toggle(), None);
        let spoken = read(&mut visitor, &mut aloud);
        assert!(spoken.sample_rate == RATE && spoken.samples.iter().all(|sample| sample.abs() <= LOUDEST));
        let seconds = spoken.samples.len() as f64 / f64::from(RATE);
        assert!((0.5..0.52).contains(&seconds), "{seconds} s of half a second");
        let said = std::fs::read_to_string(folder.path().join("said")).expect("it was asked");
        std::fs::remove_file(folder.path().join("said")).expect("it is there");
        let label = visitor.exhibit.labels.get(language).expect("a label").clone();
        let own = texts().get(language);
        let play = [TextId::Invite, TextId::Aim, TextId::Hold].map(|id| own.get(id));
        assert!(said.starts_with(&format!("--stdout --stdin -b 1 -v {language}\n")), "{said}");
        let written = [label.title.as_str(), &label.maker, label.alt.trim(), label.body.trim()];
        for part in written.into_iter().chain(play) {
            assert!(!part.is_empty() && said.contains(part), "{language}: {part:?} is not read: {said}");
        }
        // It is on until the loudspeaker has said it, or a second press.
        assert!(aloud.is_on() && aloud.update(true).is_none() && aloud.is_on());
        let hush = aloud.toggle().expect("a second press hushes");
        assert!(hush.samples.is_empty() && !aloud.is_on());
        assert_eq!(aloud.stop(), None, "there is nothing more to hush");
    }
    // No voice, no button.
    for language in ["de", "ja"] {
        assert!(!aloud.can_speak(language));
    }
    visitor.speech = None;
    assert!(!visitor.look().iter().any(|(_, request)| *request == Request::ReadAloud));
}

#[test]
fn keys_that_move_the_mark_are_told_the_button_once_something_was_read() {
    let folder = tempfile::tempdir().expect("a folder");
    let (mut visitor, mut aloud) = before(&stand_in(folder.path()));
    visitor.menu.toggle();
    aloud.announce_focus(Some(Request::Large));
    assert!(!aloud.is_on(), "nobody has asked for it");
    aloud.toggle();
    read(&mut visitor, &mut aloud);
    visitor.accessibility.text.large = true;
    let said = folder.path().join("said");
    for (request, name, language) in [
        (Request::Large, "Large text: on", "en"),
        (Request::ReducedMotion, "Less motion: off", "en"),
        (Request::LookAround, "Look round: off", "en"),
        (Request::Menu, "Back to the work", "en"),
        (Request::Exhibit(2), "Work 2", "en"),
        (Request::Language(2), "Italiano", "it"),
    ] {
        let _ = std::fs::remove_file(&said);
        let request = match request {
            Request::Language(_) => {
                Request::Language(visitor.languages.iter().position(|code| code == "it").expect("Italian"))
            }
            request => request,
        };
        aloud.announce_focus(Some(request));
        read(&mut visitor, &mut aloud);
        let text = std::fs::read_to_string(&said).expect("it was asked");
        assert!(text.contains(name) && text.contains(&format!("-v {language}\n")), "{request:?}: {text}");
    }
    aloud.end_visit();
    aloud.announce_focus(Some(Request::Large));
    assert!(!aloud.is_on(), "the next visitor is told nothing");
}

#[test]
fn every_button_of_the_page_has_a_name_in_every_language() {
    let exhibit = load("steel-fish");
    for own in texts().languages() {
        let mut visitor = Before::new(&exhibit, GLASSES[0]);
        visitor.language = own.code().into();
        visitor.menu.toggle();
        let buttons = visitor.look();
        visitor.look_with(|scene| {
            for (_, request) in buttons.iter().filter(|(_, request)| *request != Request::Nothing) {
                let said = soffio_kiosk::pages::speech_text::button(*request, scene);
                assert!(said.iter().all(|one| !one.text.is_empty()) && said.len() == 1, "{}: {request:?}", own.code());
            }
        });
    }
}

#[test]
fn a_touch_ends_the_reading_unless_it_is_about_the_reading() {
    for (request, on) in [
        (None, false),
        (Some(Request::Menu), false),
        (Some(Request::Exhibit(3)), false),
        (Some(Request::Language(1)), false),
        (Some(Request::Louder(1)), true),
        (Some(Request::MoveFocus([1, 0])), true),
    ] {
        assert_eq!(keeps_reading(request), on, "{request:?}");
    }
}

#[test]
fn a_program_that_fails_says_so_and_leaves_nothing_on() {
    let folder = tempfile::tempdir().expect("a folder");
    let program = stand_in(folder.path());
    let (mut visitor, mut aloud) = before(&program);
    std::fs::remove_file(folder.path().join("tone.wav")).expect("it is there");
    aloud.toggle();
    visitor.look_with(|scene| aloud.start_requested(scene, RATE));
    wait("its end", || {
        assert_eq!(aloud.update(false), None, "there are no words");
        (!aloud.is_on()).then_some(())
    });
}

/// The system's own program, where it is installed.
fn system() -> Option<SpeechSynthesizer> {
    crate::require::require("program that speaks", SpeechSynthesizer::detect("espeak-ng"))
}

/// What it says of the fish, in English.
fn speech(speaker: &SpeechSynthesizer) -> Utterance {
    let label = load("steel-fish").labels.get("en").expect("a label").clone();
    let description = SpokenText { text: format!("{}. {}", label.alt, label.body), language: "en".into() };
    let making = speaker.start(vec![description], RATE);
    wait("the words", || making.poll()).expect("it speaks")
}

#[test]
fn the_systems_program_speaks_and_only_what_it_can_read() {
    /// Speech goes at two to four words a second.
    const WORDS_A_SECOND: std::ops::Range<f64> = 1.5..5.0;
    let Some(speaker) = system() else { return };
    for (code, can) in
        [("en", true), ("de", true), ("fr", true), ("it", true), ("es", true), ("ko", true), ("ja", false)]
    {
        assert_eq!(speaker.can_speak(code), can, "{code}");
    }
    let label = load("steel-fish").labels.get("en").expect("a label").clone();
    let count = format!("{}. {}", label.alt, label.body).split_whitespace().count() as f64;
    let words = speech(&speaker);
    let pace = count / (words.samples.len() as f64 / f64::from(RATE));
    assert!(WORDS_A_SECOND.contains(&pace), "{pace} words a second");
    // The program's own WAV at its own rate is the same sound: as long, and as loud over time.
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("own.wav");
    let text = format!("{}. {}", label.alt, label.body);
    let status = Command::new("espeak-ng").args(["-v", "en", "-w"]).arg(&file).arg(&text).status().expect("it runs");
    assert!(status.success());
    let own = wav::read(&file).expect("a WAV");
    let (a, b) = (own.duration(), words.samples.len() as f64 / f64::from(RATE));
    assert!((a - b).abs() < 0.1, "{a} s and {b} s");
}

#[test]
fn the_ear_does_not_take_the_kiosks_speech_for_a_breath() {
    /// Loudspeaker to microphone: sound cards and air, samples; and how much of it arrives.
    const PATH: usize = 3840;
    let Some(speaker) = system() else { return };
    let words = speech(&speaker);
    for gain in [0.2_f32, 0.7] {
        let mut detector = BlowDetector::new(RATE);
        let mut recording =
            soffio_soundscape::test_sounds::pink_noise(RATE, 90, words.samples.len() as f64 / f64::from(RATE), -60.0);
        recording.resize(words.samples.len(), 0.0);
        let mut windy = 0;
        for (i, played) in words.samples.chunks(200).enumerate() {
            let at = 200 * i;
            let heard: Vec<f32> = (at..at + played.len())
                .map(|k| recording[k] + gain * k.checked_sub(PATH).map_or(0.0, |past| words.samples[past]))
                .collect();
            detector.push(&heard, played);
            windy += usize::from(detector.estimate().speed > 0.0);
        }
        assert_eq!(windy, 0, "gain {gain}: wind in {windy} steps of {}", words.samples.len() / 200);
    }
}

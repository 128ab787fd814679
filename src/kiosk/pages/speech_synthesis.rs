//! Speech synthesis (text to speech) by a program of the system, such as eSpeak NG.
//!
//! The program writes a WAV to its standard output and opens no device. All sound therefore passes through the kiosk's own
//! output, and the breath detector can subtract it. Without a program there is no button for reading aloud.
//!
//! Speech is resampled in the frequency domain: partials below both Nyquist frequencies are kept exactly. Its loudness is set
//! relative to the exhibits' −23 LUFS, so that one calibration of the site holds for both.

use std::io::{Cursor, Read, Write};
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::time::Duration;

use soffio_fourier::{real_forward, real_inverse};

use crate::pages::speech_text::SpokenText;
use soffio_devices::audio::{LOUDEST, Utterance};
use soffio_math::db_to_amplitude;

/// Loudness of speech, LUFS: 3 dB above the exhibits, which are attenuated by 12 dB meanwhile.
const SPEECH_LUFS: f64 = -20.0;
/// Time after which a program is stopped. The longest shipped label takes a tenth of a second.
const TIMEOUT: Duration = Duration::from_secs(10);
/// Languages that the program spells instead of reading: it says "Chinese letter" for every Han character.
const SPELLED_ONLY: &[&str] = &["ja", "zh", "cmn", "yue"];
/// Longest speech, s, which bounds the memory.
const LONGEST_S: f64 = 300.0;

/// A speech program and its languages.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SpeechSynthesizer {
    program: String,
    languages: Vec<String>,
}

/// Speech that is being synthesized on its own thread.
pub struct PendingSpeech(Receiver<Result<Utterance, String>>);

impl SpeechSynthesizer {
    /// Queries a program (`espeak-ng`, or one with the same arguments) for its languages.
    ///
    /// # Errors
    ///
    /// The reason why the program cannot speak.
    pub fn detect(program: &str) -> Result<Self, String> {
        let output = Command::new(program)
            .arg("--voices")
            .stdin(Stdio::null())
            .output()
            .map_err(|error| format!("{program}: {error}"))?;
        if !output.status.success() {
            return Err(format!("{program} --voices: {}", output.status));
        }
        // Pty Language Age/Gender VoiceName …
        let table = String::from_utf8_lossy(&output.stdout);
        let languages: Vec<String> =
            table.lines().skip(1).filter_map(|line| line.split_whitespace().nth(1)).map(str::to_owned).collect();
        match languages.is_empty() {
            true => Err(format!("{program} has no voices")),
            false => Ok(Self { program: program.to_owned(), languages }),
        }
    }

    /// Does it read this language, rather than spell it?
    pub fn can_speak(&self, language: &str) -> bool {
        let base = base_language(language);
        let speaks = |voice: &String| voice.split('-').next() == Some(base);
        !SPELLED_ONLY.contains(&base) && self.languages.iter().any(speaks)
    }

    /// Starts to synthesize texts one after the other as one sound, for an output with this sample rate, Hz.
    pub fn start(&self, texts: Vec<SpokenText>, sample_rate: u32) -> PendingSpeech {
        let (sender, receiver) = channel();
        let program = self.program.clone();
        let run = move || {
            // The receiver is gone if another reading has been requested meanwhile.
            let _ = sender.send(synthesize(&program, &texts, sample_rate));
        };
        // Without a thread the sender is dropped, and `PendingSpeech::poll` reports it.
        if let Err(error) = std::thread::Builder::new().name("soffio-speech".into()).spawn(run) {
            tracing::warn!("nothing is read aloud: {error}");
        }
        PendingSpeech(receiver)
    }
}

impl PendingSpeech {
    /// The finished speech, or the reason why there is none; `None` while the thread is working.
    pub fn poll(&self) -> Option<Result<Utterance, String>> {
        match self.0.try_recv() {
            Ok(speech) => Some(speech),
            Err(TryRecvError::Empty) => None,
            Err(TryRecvError::Disconnected) => Some(Err("the thread that synthesized the speech has ended".into())),
        }
    }
}

/// Language code without its region.
fn base_language(language: &str) -> &str {
    language.split(['-', '_']).next().unwrap_or(language)
}

/// Synthesizes texts one after the other as one sound.
fn synthesize(program: &str, texts: &[SpokenText], sample_rate: u32) -> Result<Utterance, String> {
    let mut all = Vec::new();
    for SpokenText { text, language } in texts.iter().filter(|said| !said.text.trim().is_empty()) {
        let (samples, rate) = parse(&run_program(program, base_language(language), text)?)?;
        all.extend(resample(&samples, rate, sample_rate));
    }
    all.truncate((LONGEST_S * f64::from(sample_rate)) as usize);
    normalize_loudness(&mut all, sample_rate)?;
    Ok(Utterance { samples: all.into(), sample_rate })
}

/// The program's WAV of a text. The text is written to standard input, so that no part of it is read as an option.
fn run_program(program: &str, language: &str, text: &str) -> Result<Vec<u8>, String> {
    let failed = |error: std::io::Error| format!("{program}: {error}");
    let mut child = Command::new(program)
        .args(["--stdout", "--stdin", "-b", "1", "-v", language])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .map_err(failed)?;
    let (stdin, stdout) = (child.stdin.take(), child.stdout.take());
    let (sender, receiver) = channel();
    // Reading runs beside writing, so that neither pipe can fill.
    let reader = std::thread::Builder::new().name("soffio-reader".into()).spawn(move || {
        let mut bytes = Vec::new();
        let read = stdout.map_or(Ok(0), |mut stdout| stdout.read_to_end(&mut bytes));
        let _ = sender.send(read.map(|_| bytes));
    });
    if let Err(error) = reader {
        kill(&mut child);
        return Err(failed(error));
    }
    let fed = stdin.map_or(Ok(()), |mut stdin| stdin.write_all(text.as_bytes()));
    let read = receiver.recv_timeout(TIMEOUT);
    kill(&mut child);
    match (fed, read) {
        (Ok(()), Ok(bytes)) => bytes.map_err(failed),
        (Err(error), _) => Err(failed(error)),
        (_, Err(_)) => Err(format!("{program} has not spoken within {} s", TIMEOUT.as_secs())),
    }
}

/// Ends the program.
fn kill(child: &mut Child) {
    // This fails if the program has ended by itself.
    let _ = child.kill();
    let _ = child.wait();
}

/// Samples (full scale ±1) and sample rate of a WAV. Its header may claim more samples than follow, as a stream does not
/// know its length.
fn parse(bytes: &[u8]) -> Result<(Vec<f32>, u32), String> {
    let mut reader = hound::WavReader::new(Cursor::new(bytes)).map_err(|error| format!("no WAV: {error}"))?;
    let spec = reader.spec();
    let full_scale = (1_i64 << (spec.bits_per_sample - 1)) as f32;
    let samples: Vec<f32> = match (spec.sample_format, spec.channels) {
        (hound::SampleFormat::Int, 1) => {
            reader.samples::<i32>().map_while(Result::ok).map(|sample| sample as f32 / full_scale).collect()
        }
        _ => return Err("not one channel of whole numbers".into()),
    };
    Ok((samples, spec.sample_rate))
}

/// Resamples in the frequency domain. With n samples at rate f and m = n g/f samples at rate g, the first bins of both
/// spectra agree:
///
/// ```text
/// Y_k = m/n X_k     0 ≤ k ≤ min(n, m)/2          y = F⁻¹ Y
/// ```
fn resample(samples: &[f32], from: u32, to: u32) -> Vec<f32> {
    if from == to || samples.is_empty() {
        return samples.to_vec();
    }
    // A whole number of periods of both rates, so that m is whole, with silence at the end.
    let period = from / gcd(from, to);
    let n = samples.len().div_ceil(period as usize) * period as usize;
    let m = n / period as usize * (to / gcd(from, to)) as usize;
    let (forward, inverse) = (real_forward(n), real_inverse(m));
    let (mut x, mut spectrum) = (forward.make_input_vec(), forward.make_output_vec());
    x.iter_mut().zip(samples).for_each(|(x, sample)| *x = f64::from(*sample));
    let (mut other, mut y) = (inverse.make_input_vec(), inverse.make_output_vec());
    if forward.process(&mut x, &mut spectrum).is_err() {
        return Vec::new();
    }
    let shared = spectrum.len().min(other.len()) - 1;
    other[..shared].copy_from_slice(&spectrum[..shared]);
    other[0].im = 0.0;
    if inverse.process(&mut other, &mut y).is_err() {
        return Vec::new();
    }
    y.iter().map(|sample| (sample / n as f64) as f32).collect()
}

fn gcd(a: u32, b: u32) -> u32 {
    if b == 0 { a } else { gcd(b, a % b) }
}

/// Scales samples to [`SPEECH_LUFS`], with no sample above [`LOUDEST`].
fn normalize_loudness(samples: &mut [f32], sample_rate: u32) -> Result<(), String> {
    let failed = |error: ebur128::Error| format!("loudness: {error}");
    let mut meter = ebur128::EbuR128::new(1, sample_rate, ebur128::Mode::I).map_err(failed)?;
    // Both loudspeakers play it.
    meter.set_channel(0, ebur128::Channel::DualMono).map_err(failed)?;
    meter.add_frames_f32(samples).map_err(failed)?;
    let loudness = meter.loudness_global().map_err(failed)?;
    let peak = samples.iter().fold(0.0_f32, |most, sample| most.max(sample.abs()));
    // Speech too short to be measured keeps its level.
    let gain = if loudness.is_finite() { db_to_amplitude(SPEECH_LUFS - loudness) as f32 } else { 1.0 };
    let gain = gain.min(LOUDEST / peak.max(f32::MIN_POSITIVE));
    samples.iter_mut().for_each(|sample| *sample *= gain);
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// Rounding of transforms of some ten thousand f32, full scale 1.
    const ROUNDING: f64 = 1e-4;

    #[test]
    fn a_sine_is_the_same_sine_at_another_rate() {
        let sine = |rate: u32, i: usize| (0.5 * (TAU * 1000.0 * i as f64 / f64::from(rate)).sin()) as f32;
        for (from, to) in [(22_050, 48_000), (22_050, 44_100), (48_000, 16_000), (16_000, 16_000)] {
            // A whole second holds a whole number of its periods: nothing leaks.
            let samples: Vec<f32> = (0..from as usize).map(|i| sine(from, i)).collect();
            let other = resample(&samples, from, to);
            assert_eq!(other.len(), to as usize, "{from} to {to}");
            for (i, sample) in other.iter().enumerate() {
                let error = f64::from(sample - sine(to, i)).abs();
                assert!(error < ROUNDING, "{from} to {to} Hz, sample {i}: {error}");
            }
        }
    }

    #[test]
    fn speech_is_as_loud_as_it_shall_be_and_never_too_great() {
        /// BS.1770 weighs 1 kHz by about 0 dB; a sine of amplitude a on both sides has 20 log a LUFS.
        const TOLERANCE_DB: f64 = 0.3;
        let tone = |a: f64| -> Vec<f32> { (0..96_000).map(|i| (a * (TAU * i as f64 / 48.0).sin()) as f32).collect() };
        for amplitude in [0.9, 0.01] {
            let mut samples = tone(amplitude);
            normalize_loudness(&mut samples, 48_000).expect("it is measured");
            let peak = samples.iter().fold(0.0_f32, |most, sample| most.max(sample.abs()));
            let lufs = 20.0 * f64::from(peak).log10();
            assert!((lufs - SPEECH_LUFS).abs() < TOLERANCE_DB, "{amplitude}: {lufs}");
        }
        // One click in silence would need far more than full scale.
        let mut click = tone(1e-5);
        click[500] = 1.0;
        normalize_loudness(&mut click, 48_000).expect("it is measured");
        assert!(click.iter().all(|sample| sample.abs() <= LOUDEST));
    }

    #[test]
    fn a_program_that_is_not_there_or_says_nonsense_is_no_speaker() {
        let error = SpeechSynthesizer::detect("no-such-program-of-speech").expect_err("it is not there");
        assert!(error.contains("no-such-program-of-speech"), "{error}");
        assert!(SpeechSynthesizer::detect("true").expect_err("no voices").contains("no voices"));
        assert!(parse(b"not a wave").is_err());
        assert!(
            run_program("cat", "en", "").is_ok_and(|bytes| bytes.is_empty()),
            "cat refuses the options and says nothing"
        );
    }

    #[test]
    fn a_language_is_spoken_by_its_own_voice_only() {
        let languages = ["en-gb", "fr-fr", "kok", "ja", "it"].map(str::to_owned).to_vec();
        let speaker = SpeechSynthesizer { program: String::new(), languages };
        for (language, can) in [("en", true), ("en-US", true), ("it", true), ("ko", false), ("ja", false), ("i", false)]
        {
            assert_eq!(speaker.can_speak(language), can, "{language}");
        }
    }
}

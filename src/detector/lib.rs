//! Breath detection: a streaming detector from microphone samples to the speed of the air.
//!
//! ```text
//! samples → resample (8 kHz) → spectrum (48 ms every 8 ms) → echo_estimate (the kiosk's own loudspeaker)
//!         → features (shape, rise over the floor, incoherence) → model (log-odds, speed) → decision (cumulative sum)
//! ```
//!
//! A breath that strikes a microphone capsule makes turbulence, which is noise of low frequency far above the ambient noise. Level
//! alone does not separate it from doors, trains and voices, and depends on the gain. So decision trees weigh the
//! shape of the spectrum, how far it rises over its floor, how unusual that is in this room, and how it develops. With two capsules they
//! also see what these do not share. The level only sets the strength of a detected breath.
//!
//! Invariants: the detector is causal; its state does not depend on how samples are cut into blocks; the speed is exactly 0
//! unless the reason is [`Reason::Blow`].
//!
//! The detector opens no device and reads no clock or file. It takes samples at 8 to 192 kHz. It stores levels of the last
//! minutes only, from which speech cannot be restored. After construction it never allocates.
//!
//! The main types are [`BlowDetector`] (one microphone, with one or two capsules), [`BlowEstimate`] (speed, confidence,
//! [`Reason`], levels) and [`BlowSettings`] (sensitivity, threshold, model, rules).
//!
//! ```
//! use soffio_detector::{BlowDetector, Reason};
//!
//! let mut detector = BlowDetector::new(16_000);
//! let hum: Vec<f32> = (0..16_000).map(|i| 0.01 * (0.02 * i as f32).sin()).collect();
//! for block in hum.chunks(80) {
//!     detector.push(block, &[]); // the second slice is what the loudspeaker played meanwhile
//! }
//! assert_eq!(detector.estimate().speed, 0.0, "a hum is no breath");
//! assert_ne!(detector.estimate().reason, Reason::Blow);
//! ```

mod agc_detector;
pub mod bands;
mod coherence;
mod decision;
mod echo_estimate;
pub mod features;
pub mod frontend;
pub mod model;
pub mod noise_floor;
mod resample;
pub mod spectrum;
pub mod trees;

use std::sync::{Arc, LazyLock};

use agc_detector::AgcDetector;
use bands::{BANDS, RUMBLE, blend, power_to_db};
use decision::Decision;
pub use decision::Rules;
pub use features::AmbientSpread;
use frontend::{Frame, Frontend, SILENCE_DBFS};
use model::{Model, Output};
use soffio_math::{db_to_amplitude, exp};

/// The trained weights.
static MODEL: &[u8] = include_bytes!("../../audio/models/breath.safetensors");

/// Speed at the lips of the hardest blow, m/s.
const HARDEST_M_S: f64 = 17.0;
/// Lowest speed of a detected breath, m/s.
const FAINTEST_M_S: f64 = 0.5;
/// Speed at the lips relative to that at the capsule: lips 10 mm wide at 20 cm, 20/(6 · 1) (Pope, *Turbulent Flows*, section 5.1).
const LIPS_RATIO: f64 = 3.3;
/// Growth of the logarithm of the speed with the level, nats a decibel: the pressure of turbulence goes with the square of the speed.
const LOG_SPEED_PER_DB: f64 = std::f64::consts::LN_10 / 40.0;
/// Time constant of the speed, s: the scatter of turbulence is averaged, a swelling breath is not.
const SPEED_S: f64 = 0.08;
/// Longest breath, s: what lasts longer is a fan or a draught, and becomes the noise floor.
const LONGEST_S: f64 = 12.0;
/// Smallest rise of a breath over the noise floor, dB.
const MIN_RISE_DB: f64 = 5.0;
/// Periodicity from which a sound counts as a voice.
const VOICED: f32 = 0.5;
/// Share of the echo in the rumble from which a sound counts as the loudspeaker's.
const MOSTLY_ECHO: f64 = 0.5;

/// Output of the detector after the last sample.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BlowEstimate {
    /// Speed of the air at the lips, m/s; exactly 0 without a breath.
    pub speed: f64,
    /// 0 (certainly no breath) … 1 (certainly a breath).
    pub confidence: f64,
    /// Reason for the decision.
    pub reason: Reason,
    /// Level of the last frame, dB of full scale (RMS).
    pub level_dbfs: f64,
    /// Noise floor below 219 Hz, dB of full scale.
    pub floor_dbfs: f64,
    /// Samples are clipped.
    pub clipping: bool,
    /// The microphone seems to have an automatic gain control, which makes the strength unreliable.
    pub gain_control: bool,
}

/// Why the detector decided as it did.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Reason {
    /// No samples arrive.
    #[default]
    NoSignal,
    /// The noise floor is being learnt.
    Settling,
    /// Nothing rises above the noise floor.
    Quiet,
    /// A voice or music.
    Voiced,
    /// Another sound, unlike breath.
    OtherSound,
    /// Like breath, but not for long enough yet.
    Pending,
    /// A breath.
    Blow,
    /// The kiosk's own loudspeaker.
    LoudspeakerEcho,
    /// Samples are not finite numbers.
    Fault,
}

/// Settings of a detector.
#[derive(Clone, Debug, PartialEq)]
pub struct BlowSettings {
    /// Added to the microphone's level before it is converted to a speed, dB. It changes the strength of a breath, never its
    /// detection.
    pub sensitivity_db: f64,
    /// How much surer than usual the detector must be of a breath: subtracted from the log-odds, nats.
    pub threshold: f64,
    /// The trained model. It is shared, since it is much larger than a detector's own state.
    pub model: Arc<Model>,
    /// Rules that turn log-odds into a decision.
    pub rules: Rules,
}

impl Default for BlowSettings {
    /// # Panics
    /// Never: a test reads the shipped weights.
    fn default() -> Self {
        static SHIPPED: LazyLock<Arc<Model>> =
            LazyLock::new(|| Arc::new(Model::read(MODEL).expect("the shipped weights are readable")));
        Self { sensitivity_db: 0.0, threshold: 0.0, model: SHIPPED.clone(), rules: Rules::default() }
    }
}

/// Streaming, causal, deterministic detector of a breath at the microphone.
///
/// Real-time safe: it allocates only in [`BlowDetector::new`], and the work per sample is bounded.
#[derive(Clone, Debug)]
pub struct BlowDetector {
    settings: BlowSettings,
    estimate: BlowEstimate,
    frontend: Frontend,
    decision: Decision,
    agc: AgcDetector,
    /// Smoothed logarithm of the speed at the capsule.
    log_speed: f64,
    output: Output,
}

impl BlowDetector {
    /// A detector for samples at `sample_rate` Hz (8–192 kHz).
    pub fn new(sample_rate: u32) -> Self {
        Self::with_settings(sample_rate, BlowSettings::default())
    }

    /// A detector with settings other than the default.
    pub fn with_settings(sample_rate: u32, settings: BlowSettings) -> Self {
        Self {
            settings,
            estimate: BlowEstimate { level_dbfs: SILENCE_DBFS, floor_dbfs: SILENCE_DBFS, ..Default::default() },
            frontend: Frontend::new(sample_rate),
            decision: Decision::default(),
            agc: AgcDetector::default(),
            log_speed: 0.0,
            output: Output::default(),
        }
    }

    /// Sets [`BlowSettings::sensitivity_db`] and [`BlowSettings::threshold`], and keeps everything learnt so far.
    pub fn set(&mut self, sensitivity_db: f64, threshold: f64) {
        (self.settings.sensitivity_db, self.settings.threshold) = (sensitivity_db, threshold);
    }

    /// Takes mono `samples` (full scale ±1). `reference` is the loudspeaker's signal over the same time (mono, same rate and
    /// length). It is empty where the microphone cannot pick up the loudspeaker.
    pub fn push(&mut self, samples: &[f32], reference: &[f32]) {
        for (i, &sample) in samples.iter().enumerate() {
            self.push_sample(sample, None, reference.get(i).copied().unwrap_or(0.0));
        }
    }

    /// Takes the samples of two capsules, `left` and `right` of the same length: wind differs between them, sound does not.
    pub fn push_stereo(&mut self, left: &[f32], right: &[f32], reference: &[f32]) {
        for (i, (&left, &right)) in left.iter().zip(right).enumerate() {
            self.push_sample(left, Some(right), reference.get(i).copied().unwrap_or(0.0));
        }
    }

    fn push_sample(&mut self, left: f32, right: Option<f32>, played: f32) {
        if let Some(frame) = self.frontend.push(left, right, played, !self.decision.blowing) {
            self.process_frame(&frame);
        }
    }

    /// What has been learnt of the room.
    pub fn ambient_spread(&self) -> AmbientSpread {
        self.frontend.features.ambient_spread()
    }

    /// Begins with what an earlier run has learnt of the room. Call it before the first sample.
    pub fn recall(&mut self, ambient_spread: &AmbientSpread) {
        self.frontend.features.recall(ambient_spread);
    }

    /// The current estimate.
    pub fn estimate(&self) -> BlowEstimate {
        self.estimate
    }

    /// Levels of the last frame in the bands between [`bands::EDGES`], without the echo, dB of full scale.
    pub fn band_levels(&self) -> [f64; BANDS] {
        self.frontend.features.levels()
    }

    /// Outputs of the model for the last frame.
    pub fn output(&self) -> Output {
        self.output
    }

    fn process_frame(&mut self, frame: &Frame) {
        self.estimate.level_dbfs = frame.level_dbfs;
        self.estimate.clipping = frame.clipping;
        let Some(measured) = &frame.measured else {
            return self.stop(Reason::Fault);
        };
        let floor = &self.frontend.features.floor;
        let rumble = floor.level[RUMBLE].iter().map(|db| db_to_amplitude(2.0 * db)).sum();
        self.estimate.floor_dbfs = power_to_db(rumble);
        let loudest = measured.levels.iter().copied().fold(SILENCE_DBFS, f64::max);
        self.output = self.settings.model.output(&measured.inputs, loudest);
        if frame.zero {
            // An unplugged microphone sends exact zeros, and so does one with a noise gate.
            return self.stop(Reason::NoSignal);
        }
        // No breath begins while the first floor or the echo of the first sound is unknown, nor from what is mostly echo; one that
        // has begun may continue.
        let settling = floor.is_settling();
        let mostly_echo = measured.echo > MOSTLY_ECHO || self.frontend.echo.is_learning();
        let capsules = if self.frontend.is_stereo() { 2 } else { 1 };
        let may_begin = !settling && (self.decision.blowing || !mostly_echo);
        let log_odds = may_begin.then_some(self.output.log_odds - self.settings.threshold);
        self.decision.push(&self.settings.rules, log_odds, capsules);
        if self.decision.seconds > LONGEST_S {
            self.frontend.features.adopt_floors();
        }
        self.agc.push(self.decision.blowing, &measured.levels);
        self.estimate.gain_control = self.agc.is_detected();
        self.log_speed += blend(SPEED_S) * (self.output.log_speed - self.log_speed);
        let reason = match () {
            () if self.decision.blowing => Reason::Blow,
            () if settling => Reason::Settling,
            () if mostly_echo => Reason::LoudspeakerEcho,
            () if self.decision.progress > 0.0 => Reason::Pending,
            () if measured.rise_db < MIN_RISE_DB => Reason::Quiet,
            () if measured.periodicity > VOICED => Reason::Voiced,
            () => Reason::OtherSound,
        };
        self.estimate.reason = reason;
        self.estimate.speed = if self.decision.blowing {
            let calibration = LOG_SPEED_PER_DB * self.settings.sensitivity_db;
            (LIPS_RATIO * exp(self.log_speed + calibration)).clamp(FAINTEST_M_S, HARDEST_M_S)
        } else {
            0.0
        };
        self.estimate.confidence = if settling { 0.0 } else { self.decision.confidence() };
    }

    /// Ends any breath, since nothing can be heard.
    fn stop(&mut self, reason: Reason) {
        self.decision = Decision::default();
        self.estimate = BlowEstimate { speed: 0.0, confidence: 0.0, reason, ..self.estimate };
    }
}

//! Breath detection: a streaming detector from microphone samples to the speed of the air at the lips.
//!
//! ```text
//! samples → resample (8 kHz, two subbands) → spectrum (48 ms every 8 ms) → echo_estimate (the kiosk's own loudspeaker)
//!         [→ dual_mic (difference of two capsules)] → features (rise over the noise floor, shape, pitch, context) → model (log-odds)
//!         [→ dual_mic_model (log-odds from both spectra, coherence and high_band)] → decision (48 ms … 6 s) → speed
//! ```
//!
//! A breath that strikes a microphone capsule makes turbulence, which is noise below 200 Hz far above the ambient noise. Level
//! alone does not separate it from doors, trains and voices, and depends on the gain. So the decision rests on the rise over the
//! noise floor and on the shape of the excess spectrum. The level only sets the strength of a detected breath.
//!
//! Invariants: the detector is causal; its state does not depend on how samples are cut into blocks; the speed is exactly 0
//! unless the reason is [`Reason::Blow`].
//!
//! The detector opens no device and reads no clock or file. It takes samples at 8 to 192 kHz. It stores features of the last
//! seconds only, from which speech cannot be restored. After construction it never allocates.
//!
//! The main types are [`BlowDetector`] (one microphone, with one or two capsules), [`BlowEstimate`] (speed, confidence,
//! [`Reason`], levels) and [`BlowSettings`] (sensitivity, model, rules). The module [`generate`] makes synthetic breaths and
//! noises for tests.
//!
//! ```
//! use soffio_detector::generate::{BreathShape, breath};
//! use soffio_detector::{BlowDetector, Reason};
//!
//! let rate = 16_000;
//! let samples = breath(rate, 1, &BreathShape { strength: 9.0, ..BreathShape::default() });
//! let mut detector = BlowDetector::new(rate);
//! let mut strongest: f64 = 0.0;
//! for block in samples.chunks(80) {
//!     detector.push(block, &[]); // the second slice is what the loudspeaker played meanwhile
//!     strongest = strongest.max(detector.estimate().speed);
//! }
//! assert!(strongest > 1.0, "the breath is detected: {strongest} m/s");
//! assert_ne!(detector.estimate().reason, Reason::Blow, "it is over");
//! ```

mod agc_detector;
mod bands;
mod coherence;
mod decision;
mod dual_mic;
pub mod dual_mic_model;
mod dual_mic_table;
mod echo_estimate;
pub mod features;
pub mod frontend;
pub mod generate;
mod high_band;
pub mod model;
mod moving_averages;
mod noise_floor;
mod resample;
mod spectrum;
pub mod table;
mod temporal_context;

use std::sync::{Arc, LazyLock};

use agc_detector::AgcDetector;
pub use decision::Rules;
use decision::{Decision, Phase};
use dual_mic_model::DualMicModel;
use features::{Features, Levels, blend, power_to_db};
use frontend::{BreathState, Frame, Frontend, SETTLING_S, SILENCE_DBFS};
use model::Model;
use soffio_math::pow;
use spectrum::band;

/// Speed of the hardest blow, m/s.
const HARDEST_M_S: f64 = 17.0;
/// Lowest wind speed of a detected breath, m/s.
const FAINTEST_M_S: f64 = 0.5;
/// Level of the low band at the hardest blow, dB of full scale: the capsule clips.
const HARDEST_DBFS: f64 = -4.0;
/// Level of the hiss above 400 Hz of the hardest blow at 10 cm, dB of full scale.
const HARDEST_HISS_DBFS: f64 = -25.0;
/// Level from which the average of a rising breath starts, dB of full scale.
const QUIETEST_BLOW_DBFS: f64 = -70.0;

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
    /// Noise floor of the low band, dB of full scale.
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
    /// Energy where breath has none.
    MidBand,
    /// A knock, a clap, a pop.
    Impulse,
    /// Like breath, but not for long enough yet.
    Pending,
    /// A breath.
    Blow,
    /// Longer than a breath can last: a fan, a train.
    TimedOut,
    /// The kiosk's own loudspeaker.
    LoudspeakerEcho,
    /// Samples are not finite numbers.
    Fault,
}

/// Settings of a detector.
#[derive(Clone, Debug, PartialEq)]
pub struct BlowSettings {
    /// Added to the microphone's level before it is converted to a speed, dB. 0 suits a microphone that a hard blow at 10 cm
    /// drives to full scale. It changes the strength of a breath, never its detection.
    pub sensitivity_db: f64,
    /// Network over the features of one spectrum. It is shared, since it is much larger than a detector's own state.
    pub model: Arc<Model>,
    /// Network over both spectra of a dual microphone.
    pub dual_mic_model: Arc<DualMicModel>,
    /// Rules that turn log-odds into a decision.
    pub rules: Rules,
}

impl Default for BlowSettings {
    fn default() -> Self {
        static SINGLE_MIC: LazyLock<Arc<Model>> = LazyLock::new(|| Arc::new(table::TRAINED.clone()));
        static DUAL_MIC: LazyLock<Arc<DualMicModel>> = LazyLock::new(|| Arc::new(dual_mic_table::TRAINED.clone()));
        Self {
            sensitivity_db: 0.0,
            model: SINGLE_MIC.clone(),
            dual_mic_model: DUAL_MIC.clone(),
            rules: Rules::default(),
        }
    }
}

/// Inputs and output of the models for one frame.
#[derive(Clone, Copy, Debug)]
pub struct FrameReport<'a> {
    /// Features of one spectrum.
    pub features: &'a Features,
    /// Inputs of the dual-microphone model; `None` with one capsule.
    pub dual_mic: Option<&'a dual_mic_model::Inputs>,
    /// Number of frames so far.
    pub frames: u64,
    /// The frame rose far enough above the noise floor to be a breath at all.
    pub possible: bool,
    /// Log-odds of breath, nats.
    pub log_odds: f64,
    /// Progress of the decision towards a breath, 0 … 1; 1 during a breath.
    pub progress: f64,
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
    features: Features,
    dual_mic: Option<dual_mic_model::Inputs>,
    log_odds: f64,
    frames: u64,
    /// Smoothed excess of the low and middle bands, dB of full scale.
    intensity_dbfs: [f64; 2],
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
            features: [0.0; features::COUNT],
            dual_mic: None,
            log_odds: 0.0,
            frames: 0,
            intensity_dbfs: [SILENCE_DBFS; 2],
        }
    }

    /// Sets [`BlowSettings::sensitivity_db`] and keeps everything learnt so far.
    pub fn set_sensitivity(&mut self, db: f64) {
        self.settings.sensitivity_db = db;
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
        let breath = BreathState { blowing: self.decision.phase == Phase::Blow, likely: self.decision.is_likely() };
        if let Some(frame) = self.frontend.push(left, right, played, breath) {
            self.process_frame(&frame);
        }
    }

    /// The current estimate.
    pub fn estimate(&self) -> BlowEstimate {
        self.estimate
    }

    /// Report of the last frame; training uses it.
    pub fn last_frame(&self) -> FrameReport<'_> {
        let possible = self.decision.is_possible();
        FrameReport {
            features: &self.features,
            dual_mic: self.dual_mic.as_ref(),
            frames: self.frames,
            possible,
            log_odds: self.log_odds,
            progress: self.decision.progress(),
        }
    }

    fn process_frame(&mut self, frame: &Frame) {
        self.frames += 1;
        self.estimate.level_dbfs = frame.level_dbfs;
        self.estimate.clipping = frame.clipping;
        if frame.fault {
            self.decision = Decision::default();
            return self.conclude(Reason::Fault, 0.0);
        }
        let scored = self.score_frame(frame);
        let (log_odds, levels) = (scored.0, &scored.2);
        self.features = scored.1;
        self.estimate.floor_dbfs = frame.levels.floor_dbfs;
        if frame.zero {
            // An unplugged microphone sends exact zeros; a working one never does for 8 ms.
            self.decision = Decision::default();
            return self.conclude(Reason::NoSignal, 0.0);
        }
        let settling = self.frontend.extractor.age() < SETTLING_S;
        self.log_odds = log_odds;
        // The echo is unknown at first, so no breath begins then; one that has begun may continue.
        let unknown_echo = self.decision.phase == Phase::Quiet && self.frontend.low_subband.echo.is_learning();
        self.decision.push(&self.settings.rules, (!settling && !unknown_echo).then_some(log_odds), levels);
        self.agc.push(self.decision.phase == Phase::Blow, levels);
        self.estimate.gain_control = self.agc.is_detected();
        for (intensity, now) in self.intensity_dbfs.iter_mut().zip([levels.excess_dbfs, levels.hiss_dbfs]) {
            let attack = if now > *intensity { 0.03 } else { 0.08 };
            *intensity += blend(attack) * (now.max(QUIETEST_BLOW_DBFS) - *intensity);
        }
        match self.decision.phase {
            Phase::Blow => self.conclude(Reason::Blow, self.speed()),
            Phase::Pending => self.conclude(Reason::Pending, 0.0),
            Phase::TimedOut => self.conclude(Reason::TimedOut, 0.0),
            Phase::Quiet if settling => self.conclude(Reason::Settling, 0.0),
            Phase::Quiet if unknown_echo => self.conclude(Reason::LoudspeakerEcho, 0.0),
            Phase::Quiet => self.conclude(self.rejection_reason(levels), 0.0),
        }
    }

    /// Log-odds, features and levels of the frame. With two capsules the log-odds are those of the dual-microphone model, and the
    /// levels those of the difference where the difference has risen.
    fn score_frame(&mut self, frame: &Frame) -> (f64, Features, Levels) {
        let model = &self.settings.model;
        let alone = model.log_odds(&frame.features);
        self.dual_mic = None;
        let Some((features, levels)) = frame.difference else {
            return (alone, frame.features, frame.levels);
        };
        let spectra = [(alone, &frame.features), (model.log_odds(&features), &features)];
        let Frontend { dual_mic, coherence, high_band, .. } = &self.frontend;
        let inputs = dual_mic_model::inputs(spectra, dual_mic, coherence, high_band);
        self.dual_mic = Some(inputs);
        let log_odds = self.settings.dual_mic_model.log_odds(&inputs);
        let rumbles = levels.rise_db > decision::MIN_RISE_DB;
        let (features, levels) = if rumbles { (features, levels) } else { (frame.features, frame.levels) };
        let hiss_dbfs = levels.hiss_dbfs.max(high_band.hiss_dbfs);
        (log_odds, features, Levels { high_band_rise_db: high_band.rise_db, hiss_dbfs, ..levels })
    }

    /// The strongest argument against breath.
    fn rejection_reason(&self, levels: &Levels) -> Reason {
        let f = &self.features;
        if levels.max_rise_db() < decision::MIN_RISE_DB {
            // The input may be above the noise floor, and yet not above the loudspeaker's echo.
            let subband = &self.frontend.low_subband;
            let level = power_to_db(band(&subband.framer.microphone, features::LOW.0, features::LOW.1));
            let has_echo = band(&subband.echo.predicted, features::LOW.0, features::MIDDLE.1) > 0.0;
            let explained = has_echo && level > levels.floor_dbfs + decision::MIN_RISE_DB;
            return if explained { Reason::LoudspeakerEcho } else { Reason::Quiet };
        }
        let fall = if levels.rise_db > levels.middle_rise_db { f[features::FALL[0]] } else { f[features::FALL[1]] };
        let against = [
            (fall * 10.0 / 6.0, Reason::Impulse),
            (f[features::PERIODICITY] / 0.5, Reason::Voiced),
            ((levels.hiss_dbfs - levels.excess_dbfs + 10.0) / 10.0, Reason::MidBand),
        ];
        against.iter().fold((0.0, Reason::MidBand), |most, &next| if next.0 > most.0 { next } else { most }).1
    }

    /// Speed at the lips from the excess of rumble and of hiss. The pressure of turbulence grows with the square of the
    /// speed, that of the hiss with its power of 2.5:
    ///
    /// ```text
    /// R = 17 m/s · 10^((L − L₁₇)/40),   H = 17 m/s · 10^((L' − L'₁₇)/50),   U = max(√(R H), 0.8 H, 0.6 R)
    /// ```
    ///
    /// The two are combined because each can fail: distance weakens the rumble, an off-axis breath leaves only the hiss, and foam
    /// or noise hides the hiss. A gain control changes the rumble, but not its ratio to the hiss. Near full scale a capsule
    /// saturates, which the logarithm flattens.
    fn speed(&self) -> f64 {
        let [rumble, hiss] = self.intensity_dbfs.map(|level| level + self.settings.sensitivity_db);
        let rumble = pow(10.0, (rumble - HARDEST_DBFS) / 40.0);
        let hiss = pow(10.0, (hiss - HARDEST_HISS_DBFS) / 50.0);
        let speed = (rumble * hiss).sqrt().max(0.8 * hiss).max(0.6 * rumble);
        (HARDEST_M_S * speed).clamp(FAINTEST_M_S, HARDEST_M_S)
    }

    fn conclude(&mut self, reason: Reason, speed: f64) {
        self.estimate.reason = reason;
        self.estimate.speed = speed;
        let is_valid = !matches!(reason, Reason::Fault | Reason::NoSignal | Reason::TimedOut | Reason::Settling);
        self.estimate.confidence = if is_valid { self.decision.confidence() } else { 0.0 };
    }
}

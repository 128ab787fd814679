//! The blow detector: from microphone samples to the speed of the air at the lips.
//!
//! ```text
//! samples → resample (8 kHz, twice) → spectrum (48 ms every 8 ms) → own (what the kiosk itself explains)
//!         [→ capsules (what differs between two)] → features (rise over the room, shape, pitch, past) → model (log-odds)
//!         [→ pair (log-odds of all that two tell, with nearness: what is one wave, and upper: above 4 kHz)] → decision (48 ms … 6 s) → speed
//! ```
//!
//! A breath that strikes a capsule is turbulence, not sound: noise below 200 Hz that towers over the room. Level alone
//! does not tell it from doors, trains and voices, and changes with every gain knob; so what decides is the rise over the
//! room and the shape of what rose. Level only says how strong the breath is.
//!
//! Invariants: causal; no state depends on how samples were cut into blocks; the speed is exactly 0 unless the reason
//! is [`Reason::Blow`].

mod bands;
mod capsules;
mod decision;
pub mod features;
pub mod front;
mod gain;
pub mod generate;
mod means;
pub mod model;
mod nearness;
mod own;
pub mod pair;
mod pair_table;
mod past;
mod resample;
mod room;
mod spectrum;
pub mod table;
mod upper;

use std::sync::{Arc, LazyLock};

pub use decision::Rules;
use decision::{Decision, Phase};
use features::{Features, Levels, blend, decibels};
use front::{Frame, FrontEnd, SETTLING_S, SILENCE_DBFS};
use gain::GainControl;
use model::Model;
use pair::PairModel;
use soffio_math::pow;
use spectrum::band;

/// Speed of the hardest blow, m/s.
const HARDEST_M_S: f64 = 17.0;
/// Speed of the faintest wind that a detected breath makes, m/s.
const FAINTEST_M_S: f64 = 0.5;
/// Level of the low band at the hardest blow, dB of full scale: the capsule is at its rails.
const HARDEST_DBFS: f64 = -4.0;
/// Level of the hiss above 400 Hz of the hardest blow at 10 cm, dB of full scale.
const HARDEST_HISS_DBFS: f64 = -25.0;
/// Level from which the mean of a rising breath starts, dB of full scale.
const QUIETEST_BLOW_DBFS: f64 = -70.0;

/// What the detector says at the end of the samples it has heard.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BlowEstimate {
    /// Speed of the air at the lips, m/s; exactly 0 when nobody blows.
    pub speed: f64,
    /// 0 (certainly no blow) … 1 (certainly a blow).
    pub confidence: f64,
    /// Why the detector decided as it did.
    pub reason: Reason,
    /// Level of the last frame, dB of full scale (RMS).
    pub level_dbfs: f64,
    /// Room floor of the low band, dB of full scale.
    pub floor_dbfs: f64,
    /// Are samples at the rails?
    pub clipping: bool,
    /// Does the microphone seem to change its gain by itself? Then strength cannot be told from it.
    pub gain_control: bool,
}

/// Why the detector decided as it did.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Reason {
    /// No samples arrive.
    #[default]
    NoSignal,
    /// Learning the room.
    Settling,
    /// Nothing rises above the room.
    Quiet,
    /// A voice or music.
    Voiced,
    /// Energy where breath has none.
    MidBand,
    /// A knock, a clap, a pop.
    Impulse,
    /// It sounds like breath, not long enough yet.
    Waiting,
    /// Somebody blows.
    Blow,
    /// It went on longer than a breath can: a fan, a train.
    Latched,
    /// The kiosk's own loudspeaker.
    OwnVoice,
    /// Samples are not finite numbers.
    Fault,
}

/// How the detector is set up.
#[derive(Clone, Debug, PartialEq)]
pub struct BlowSettings {
    /// Added to the microphone's level before it becomes a speed, dB; 0 suits a microphone that a hard blow at 10 cm
    /// drives to full scale. It changes how strong a breath is taken to be, never whether it is one.
    pub sensitivity_db: f64,
    /// Weighs the features; shared, since it is far larger than all that an ear keeps of its own.
    pub model: Arc<Model>,
    /// Weighs what two capsules make of a frame.
    pub pair: Arc<PairModel>,
    /// Turns log-odds into a decision.
    pub rules: Rules,
}

impl Default for BlowSettings {
    fn default() -> Self {
        static ONE: LazyLock<Arc<Model>> = LazyLock::new(|| Arc::new(table::TRAINED.clone()));
        static TWO: LazyLock<Arc<PairModel>> = LazyLock::new(|| Arc::new(pair_table::TRAINED.clone()));
        Self { sensitivity_db: 0.0, model: ONE.clone(), pair: TWO.clone(), rules: Rules::default() }
    }
}

/// One frame, as it was judged.
#[derive(Clone, Copy, Debug)]
pub struct Heard<'a> {
    /// What was weighed.
    pub features: &'a Features,
    /// What was weighed of two capsules, where there are two.
    pub pair: Option<&'a pair::Inputs>,
    /// Frames so far.
    pub frames: u64,
    /// Enough rose above the room for it to be weighed at all.
    pub possible: bool,
    /// What the model said.
    pub log_odds: f64,
    /// How far it is on its way to a breath, 0 … 1; 1 while somebody blows.
    pub progress: f64,
}

/// Streaming, causal, deterministic detector of a breath at the microphone.
///
/// Real-time: nothing is allocated after [`BlowDetector::new`]. The work per sample is bounded.
#[derive(Clone, Debug)]
pub struct BlowDetector {
    settings: BlowSettings,
    estimate: BlowEstimate,
    front: FrontEnd,
    decision: Decision,
    gain: GainControl,
    features: Features,
    pair: Option<pair::Inputs>,
    log_odds: f64,
    frames: u64,
    /// Smoothed excess of low and of the middle, dB of full scale.
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
            front: FrontEnd::new(sample_rate),
            decision: Decision::default(),
            gain: GainControl::default(),
            features: [0.0; features::COUNT],
            pair: None,
            log_odds: 0.0,
            frames: 0,
            intensity_dbfs: [SILENCE_DBFS; 2],
        }
    }

    /// Sets [`BlowSettings::sensitivity_db`], and keeps all that was learnt.
    pub fn set_sensitivity(&mut self, db: f64) {
        self.settings.sensitivity_db = db;
    }

    /// Hears mono `samples` (full scale ±1). `reference` is what the kiosk's loudspeaker played in the same time
    /// (mono, same rate, same length), or empty where the microphone cannot hear it.
    pub fn push(&mut self, samples: &[f32], reference: &[f32]) {
        for (i, &sample) in samples.iter().enumerate() {
            self.hear(sample, None, reference.get(i).copied().unwrap_or(0.0));
        }
    }

    /// Hears two capsules, `left` and `right` of the same length: wind differs between them, sound does not.
    pub fn push_stereo(&mut self, left: &[f32], right: &[f32], reference: &[f32]) {
        for (i, (&left, &right)) in left.iter().zip(right).enumerate() {
            self.hear(left, Some(right), reference.get(i).copied().unwrap_or(0.0));
        }
    }

    fn hear(&mut self, left: f32, right: Option<f32>, played: f32) {
        let blowing = self.decision.phase == Phase::Blow;
        if let Some(frame) = self.front.push(left, right, played, (blowing, self.decision.is_likely())) {
            self.judge(&frame);
        }
    }

    /// The present estimate.
    pub fn estimate(&self) -> BlowEstimate {
        self.estimate
    }

    /// The last frame, as it was judged: what training learns from.
    pub fn heard(&self) -> Heard<'_> {
        let possible = self.decision.is_possible();
        Heard {
            features: &self.features,
            pair: self.pair.as_ref(),
            frames: self.frames,
            possible,
            log_odds: self.log_odds,
            progress: self.decision.progress(),
        }
    }

    fn judge(&mut self, frame: &Frame) {
        self.frames += 1;
        self.estimate.level_dbfs = frame.level_dbfs;
        self.estimate.clipping = frame.clipping;
        if frame.fault {
            self.decision = Decision::default();
            return self.conclude(Reason::Fault, 0.0);
        }
        let heard = self.weigh(frame);
        let (log_odds, levels) = (heard.0, &heard.2);
        self.features = heard.1;
        self.estimate.floor_dbfs = frame.levels.floor_dbfs;
        if frame.zero {
            // An unplugged microphone sends exact zeros; a living one never does for 8 ms.
            self.decision = Decision::default();
            return self.conclude(Reason::NoSignal, 0.0);
        }
        let settling = self.front.listener.age() < SETTLING_S;
        self.log_odds = log_odds;
        // Who blows already may go on blowing.
        let first = self.decision.phase == Phase::Quiet && self.front.lower.own_voice.is_first();
        self.decision.push(&self.settings.rules, (!settling && !first).then_some(log_odds), levels);
        self.gain.push(self.decision.phase == Phase::Blow, levels);
        self.estimate.gain_control = self.gain.seen();
        for (intensity, now) in self.intensity_dbfs.iter_mut().zip([levels.excess_dbfs, levels.hiss_dbfs]) {
            let attack = if now > *intensity { 0.03 } else { 0.08 };
            *intensity += blend(attack) * (now.max(QUIETEST_BLOW_DBFS) - *intensity);
        }
        match self.decision.phase {
            Phase::Blow => self.conclude(Reason::Blow, self.speed()),
            Phase::Waiting => self.conclude(Reason::Waiting, 0.0),
            Phase::Latched => self.conclude(Reason::Latched, 0.0),
            Phase::Quiet if settling => self.conclude(Reason::Settling, 0.0),
            Phase::Quiet if first => self.conclude(Reason::OwnVoice, 0.0),
            Phase::Quiet => self.conclude(self.why_not(levels), 0.0),
        }
    }

    /// Log-odds, features and levels of the frame; where there are two capsules, the log-odds of all that they tell, and the levels
    /// of what differs between them where that is what has risen.
    fn weigh(&mut self, frame: &Frame) -> (f64, Features, Levels) {
        let model = &self.settings.model;
        let alone = model.log_odds(&frame.features);
        self.pair = None;
        let Some((features, levels)) = frame.difference else {
            return (alone, frame.features, frame.levels);
        };
        let spectra = [(alone, &frame.features), (model.log_odds(&features), &features)];
        let FrontEnd { capsules, nearness, upper, .. } = &self.front;
        let inputs = pair::inputs(spectra, capsules, nearness, upper);
        self.pair = Some(inputs);
        let log_odds = self.settings.pair.log_odds(&inputs);
        let rumbles = levels.rise_db > decision::LEAST_RISE_DB;
        let (features, levels) = if rumbles { (features, levels) } else { (frame.features, frame.levels) };
        let hiss_dbfs = levels.hiss_dbfs.max(upper.hiss_dbfs);
        (log_odds, features, Levels { upper_rise_db: upper.rise_db, hiss_dbfs, ..levels })
    }

    /// The strongest single argument against breath.
    fn why_not(&self, levels: &Levels) -> Reason {
        let f = &self.features;
        if levels.most_db() < decision::LEAST_RISE_DB {
            // It rises above the room, but not above what the kiosk itself explains.
            let heard = decibels(band(&self.front.lower.framer.microphone, features::LOW.0, features::LOW.1));
            let own = band(&self.front.lower.own_voice.predicted, features::LOW.0, features::MIDDLE.1) > 0.0;
            let explained = own && heard > levels.floor_dbfs + decision::LEAST_RISE_DB;
            return if explained { Reason::OwnVoice } else { Reason::Quiet };
        }
        let fall = if levels.rise_db > levels.middle_rise_db { f[features::FALL[0]] } else { f[features::FALL[1]] };
        let against = [
            (fall * 10.0 / 6.0, Reason::Impulse),
            (f[features::PERIODICITY] / 0.5, Reason::Voiced),
            ((levels.hiss_dbfs - levels.excess_dbfs + 10.0) / 10.0, Reason::MidBand),
        ];
        against.iter().fold((0.0, Reason::MidBand), |most, &next| if next.0 > most.0 { next } else { most }).1
    }

    /// Speed at the lips from the excess of rumble and of hiss. The pressure of turbulence goes with the square of the
    /// speed, that of the hiss with its power of 2.5:
    ///
    /// ```text
    /// R = 17 m/s · 10^((L − L₁₇)/40),   H = 17 m/s · 10^((L' − L'₁₇)/50),   U = max(√(R H), 0.8 H, 0.6 R)
    /// ```
    ///
    /// Both together forgive more than each: distance takes the rumble, a stream that misses the microphone leaves the
    /// hiss alone, foam and noise hide the hiss, and a gain control that levels the rumble leaves how the two compare.
    /// Near full scale a capsule saturates, which the decibels flatten of themselves.
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
        let heard = !matches!(reason, Reason::Fault | Reason::NoSignal | Reason::Latched | Reason::Settling);
        self.estimate.confidence = if heard { self.decision.confidence() } else { 0.0 };
    }
}

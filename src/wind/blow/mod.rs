//! The blow detector: from microphone samples to the speed of the air at the lips.
//!
//! ```text
//! samples → resample (8 kHz) → spectrum (48 ms every 8 ms) → own (what the kiosk itself explains)
//!         → features (rise over the room, shape, pitch, fall) → model (log-odds) → decision (64 ms … 6 s) → speed
//! ```
//!
//! A breath that strikes a capsule is turbulence, not sound: noise below 200 Hz that towers over the room. Level alone
//! does not tell it from doors, trains and voices, and changes with every gain knob; so what decides is the rise over the
//! room and the shape of what rose. Level only says how strong the breath is.
//!
//! Invariants: causal; no state depends on how samples were cut into blocks; the speed is exactly 0 unless the reason
//! is [`Reason::Blow`].

mod decision;
pub mod features;
pub mod model;
mod own;
mod resample;
mod spectrum;

use crate::math::pow;
use decision::{Decision, Phase};
use features::{Features, Levels, Listener, blend, decibels};
use model::Model;
use own::OwnVoice;
use resample::Resampler;
use spectrum::{Framer, band};

/// Speed of the hardest blow, m/s.
const HARDEST_M_S: f64 = 17.0;
/// Speed of the faintest wind that a detected breath makes, m/s.
const FAINTEST_M_S: f64 = 0.5;
/// Level of the low band at the hardest blow, dB of full scale: the capsule is at its rails.
const HARDEST_DBFS: f64 = -4.0;
/// Level from which the mean of a rising breath starts, dB of full scale.
const QUIETEST_BLOW_DBFS: f64 = -70.0;
/// Lowest level that is told, dB of full scale.
const SILENCE_DBFS: f64 = -120.0;
/// The room must have been heard for this long before anything can be a breath, s.
const SETTLING_S: f64 = 0.25;
/// From this amplitude a sample counts as railed.
const RAIL: f32 = 0.999;
/// Frames for which a fault holds: the analysis window (6 frames) and the smoothing after it.
const FAULT_HOLD_FRAMES: u32 = 10;

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
    /// Weighs the features.
    pub model: Model,
}

impl Default for BlowSettings {
    fn default() -> Self {
        Self { sensitivity_db: 0.0, model: model::TRAINED }
    }
}

/// Streaming, causal, deterministic detector of a breath at the microphone.
///
/// Real-time: nothing is allocated after [`BlowDetector::new`]. The work per sample is bounded.
#[derive(Clone, Debug)]
pub struct BlowDetector {
    settings: BlowSettings,
    estimate: BlowEstimate,
    microphone: Resampler,
    own: Resampler,
    framer: Framer,
    own_voice: OwnVoice,
    listener: Listener,
    decision: Decision,
    input: Input,
    features: Features,
    frames: u64,
    intensity_dbfs: f64,
}

/// What the raw samples of the present frame say.
#[derive(Clone, Copy, Debug, Default)]
struct Input {
    count: u32,
    square: f64,
    railed: u32,
    faulty: bool,
    /// Frames for which a fault still holds: until the bad samples have left the analysis window.
    fault_hold: u32,
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
            microphone: Resampler::new(sample_rate),
            own: Resampler::new(sample_rate),
            framer: Framer::new(),
            own_voice: OwnVoice::new(),
            listener: Listener::new(),
            decision: Decision::default(),
            input: Input::default(),
            features: [0.0; features::COUNT],
            frames: 0,
            intensity_dbfs: SILENCE_DBFS,
        }
    }

    /// Hears mono `samples` (full scale ±1). `reference` is what the kiosk's loudspeaker played in the same time
    /// (mono, same rate, same length), or empty where the microphone cannot hear it.
    pub fn push(&mut self, samples: &[f32], reference: &[f32]) {
        for (i, &sample) in samples.iter().enumerate() {
            let heard = self.input.push(sample);
            let played = reference.get(i).copied().filter(|x| x.is_finite()).unwrap_or(0.0);
            let own = self.own.push(f64::from(played.clamp(-1.0, 1.0)));
            if let (Some(heard), Some(own)) = (self.microphone.push(heard), own)
                && self.framer.push(heard, own)
            {
                self.hear_frame();
            }
        }
    }

    /// The present estimate.
    pub fn estimate(&self) -> BlowEstimate {
        self.estimate
    }

    /// Features of the last frame and how many frames there were: what training learns from.
    pub fn features(&self) -> (&Features, u64) {
        (&self.features, self.frames)
    }

    fn hear_frame(&mut self) {
        self.frames += 1;
        let input = self.input.take();
        self.estimate.level_dbfs = input.level_dbfs();
        self.estimate.clipping = input.railed > 1;
        if self.input.fault_hold > 0 {
            self.decision = Decision::default();
            return self.conclude(Reason::Fault, 0.0);
        }
        let blowing = self.decision.phase == Phase::Blow;
        self.own_voice.push(&self.framer.microphone, &self.framer.own, !blowing);
        let frozen = blowing || self.own_voice.masks(&self.framer.microphone);
        let (features, levels) = self.listener.push(&self.framer.microphone, &self.own_voice.predicted, frozen);
        self.features = features;
        self.estimate.floor_dbfs = levels.floor_dbfs;
        if input.square == 0.0 {
            // An unplugged microphone sends exact zeros; a living one never does for 8 ms.
            self.decision = Decision::default();
            return self.conclude(Reason::NoSignal, 0.0);
        }
        let settling = self.listener.age() < SETTLING_S;
        let log_odds = self.settings.model.log_odds(&features);
        self.decision.push((!settling).then_some(log_odds), &levels);
        let attack = if levels.excess_dbfs > self.intensity_dbfs { 0.03 } else { 0.08 };
        self.intensity_dbfs += blend(attack) * (levels.excess_dbfs.max(QUIETEST_BLOW_DBFS) - self.intensity_dbfs);
        match self.decision.phase {
            Phase::Blow => self.conclude(Reason::Blow, self.speed()),
            Phase::Waiting => self.conclude(Reason::Waiting, 0.0),
            Phase::Latched => self.conclude(Reason::Latched, 0.0),
            Phase::Quiet if settling => self.conclude(Reason::Settling, 0.0),
            Phase::Quiet => self.conclude(self.why_not(&levels), 0.0),
        }
    }

    /// The strongest single argument against breath.
    fn why_not(&self, levels: &Levels) -> Reason {
        let f = &self.features;
        if levels.rise_db < decision::LEAST_RISE_DB {
            // It rises above the room, but not above what the kiosk itself explains.
            let heard = decibels(band(&self.framer.microphone, features::LOW.0, features::LOW.1));
            let explained = heard > levels.floor_dbfs + decision::LEAST_RISE_DB;
            return if explained { Reason::OwnVoice } else { Reason::Quiet };
        }
        let against = [
            (f[features::FALL] * 10.0 / 6.0, Reason::Impulse),
            (f[features::PERIODICITY] / 0.5, Reason::Voiced),
            ((f[features::MIDDLE_SHARE] * 10.0 + 10.0) / 10.0, Reason::MidBand),
        ];
        against.iter().fold((0.0, Reason::MidBand), |most, &next| if next.0 > most.0 { next } else { most }).1
    }

    /// Speed at the lips from the excess of the low band. Turbulence pressure goes with the square of the speed, so
    /// U = 17 m/s · 10^((L − L₁₇)/40); near full scale a capsule saturates, which the decibels flatten of themselves.
    fn speed(&self) -> f64 {
        let level = self.intensity_dbfs + self.settings.sensitivity_db;
        (HARDEST_M_S * pow(10.0, (level - HARDEST_DBFS) / 40.0)).clamp(FAINTEST_M_S, HARDEST_M_S)
    }

    fn conclude(&mut self, reason: Reason, speed: f64) {
        self.estimate.reason = reason;
        self.estimate.speed = speed;
        let heard = !matches!(reason, Reason::Fault | Reason::NoSignal | Reason::Latched | Reason::Settling);
        self.estimate.confidence = if heard { self.decision.confidence() } else { 0.0 };
    }
}

impl Input {
    /// Notes one raw sample; returns what the analysis hears.
    fn push(&mut self, sample: f32) -> f64 {
        self.count += 1;
        if !sample.is_finite() {
            self.faulty = true;
            return 0.0;
        }
        if sample.abs() >= RAIL {
            self.railed += 1;
        }
        let sample = f64::from(sample.clamp(-1.0, 1.0));
        self.square += sample * sample;
        sample
    }

    /// The finished frame's tally; starts the next.
    fn take(&mut self) -> Self {
        let fault_hold = if self.faulty { FAULT_HOLD_FRAMES } else { self.fault_hold.saturating_sub(1) };
        std::mem::replace(self, Self { fault_hold, ..Self::default() })
    }

    fn level_dbfs(&self) -> f64 {
        decibels(self.square / f64::from(self.count.max(1))).max(SILENCE_DBFS)
    }
}

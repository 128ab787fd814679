//! The blow detector: from microphone samples to the speed of the air at the lips.

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

/// Streaming, causal, deterministic detector of a breath at the microphone.
#[derive(Clone, Debug)]
pub struct BlowDetector {
    estimate: BlowEstimate,
}

impl BlowDetector {
    /// A detector for samples at `sample_rate` Hz (8–192 kHz).
    pub fn new(_sample_rate: u32) -> Self {
        Self { estimate: BlowEstimate::default() }
    }

    /// Hears mono `samples` (full scale ±1). `reference` is what the kiosk's loudspeaker played in the same time
    /// (mono, same rate, same length), or empty where the microphone cannot hear it.
    pub fn push(&mut self, _samples: &[f32], _reference: &[f32]) {}

    /// The present estimate.
    pub fn estimate(&self) -> BlowEstimate {
        self.estimate
    }
}

//! Speech mixer: utterances with ducking of the exhibit's sound, mixed into the output. So they pass through the volume, and the
//! detector's echo estimate covers them as every other sound of the kiosk.
//!
//! A new utterance replaces the present one, and an empty one ends it. During speech the exhibit's sound is ducked. With d fading
//! between 1 and [`DUCK`],
//!
//! ```text
//! out = d · work + (1 − d) / (1 − DUCK) · words        |work| ≤ 1, |words| ≤ 1 − DUCK  ⇒  |out| ≤ 1
//! ```
//!
//! so one number fades the words in and out and full scale is never passed.

use std::sync::Arc;

use rtrb::{Consumer, Producer, RingBuffer};

use soffio_math::exp;

/// Gain of the exhibit's sound during speech: −12 dB.
const DUCK: f32 = 0.25;
/// Greatest sample of an utterance.
pub const LOUDEST: f32 = 1.0 - DUCK;
/// Time constant of the fade, s: no click, and no clipped first sound.
const FADE_TIME: f64 = 0.02;
/// Utterances faded below this are inaudible.
const INAUDIBLE: f32 = 1e-3;
/// Capacity of the queue; the ring of spent utterances has twice as many places.
const WAITING: usize = 8;

/// Speech to play.
#[derive(Clone, Debug, PartialEq)]
pub struct Utterance {
    /// One channel, none greater than [`LOUDEST`].
    pub samples: Arc<[f32]>,
    /// Hz; must equal the output's.
    pub sample_rate: u32,
}

/// The real-time end.
pub(super) struct SpeechMixer {
    waiting: Consumer<Arc<[f32]>>,
    spent: Producer<Arc<[f32]>>,
    utterance: Option<Arc<[f32]>>,
    at: usize,
    /// Whether the utterance fades out because others wait.
    is_fading: bool,
    duck: f32,
    fade: f32,
}

/// The kiosk's end.
pub(super) struct SpeechQueue {
    waiting: Producer<Arc<[f32]>>,
    spent: Consumer<Arc<[f32]>>,
}

/// Both ends, for an output of this rate, Hz.
pub(super) fn open(sample_rate: u32) -> (SpeechMixer, SpeechQueue) {
    let (to_mouth, waiting) = RingBuffer::new(WAITING);
    let (spent, back) = RingBuffer::new(2 * WAITING);
    let fade = (1.0 - exp(-1.0 / (FADE_TIME * f64::from(sample_rate.max(1))))) as f32;
    let speech_mixer = SpeechMixer { waiting, spent, utterance: None, at: 0, is_fading: false, duck: 1.0, fade };
    (speech_mixer, SpeechQueue { waiting: to_mouth, spent: back })
}

impl SpeechMixer {
    /// Mixes speech into stereo frames. Real-time: bounded, no allocation; spent utterances return through a ring.
    pub fn mix(&mut self, stereo: &mut [f32]) {
        self.advance();
        let utterance = self.utterance.as_deref().unwrap_or_default();
        if utterance.len() <= self.at && self.duck == 1.0 {
            return;
        }
        for frame in stereo.as_chunks_mut::<2>().0 {
            let sample = utterance.get(self.at).copied();
            self.at += usize::from(sample.is_some());
            let target = if sample.is_some() && !self.is_fading { DUCK } else { 1.0 };
            self.duck += (target - self.duck) * self.fade;
            let speech = sample.unwrap_or_default() * (1.0 - self.duck) / LOUDEST;
            frame.iter_mut().for_each(|sample| *sample = self.duck * *sample + speech);
        }
        if 1.0 - self.duck < INAUDIBLE && self.at >= utterance.len() {
            self.duck = 1.0;
        }
    }

    /// Whether an utterance is being spoken or waits.
    pub fn is_speaking(&self) -> bool {
        !self.is_fading && self.utterance.as_ref().is_some_and(|utterance| self.at < utterance.len())
            || !self.waiting.is_empty()
    }

    /// Advances to the newest waiting utterance once the present one has faded and the ring of spent ones has space.
    fn advance(&mut self) {
        let waiting = self.waiting.slots();
        self.is_fading |= waiting > 0;
        let faded =
            1.0 - self.duck < INAUDIBLE || self.utterance.as_ref().is_none_or(|utterance| self.at >= utterance.len());
        if !(self.is_fading && faded) || self.spent.slots() <= waiting {
            return;
        }
        for next in (0..waiting).map_while(|_| self.waiting.pop().ok()) {
            if let Some(old) = self.utterance.replace(next) {
                // There is room: only this end pushes.
                let _ = self.spent.push(old);
            }
        }
        (self.at, self.is_fading) = (0, false);
    }
}

impl SpeechQueue {
    /// Queues an utterance in place of the present one, and drops spent ones.
    pub fn say(&mut self, samples: Arc<[f32]>) {
        while self.spent.pop().is_ok() {}
        // A full ring means that the device has stalled; stale speech is not wanted.
        let _ = self.waiting.push(samples);
    }
}

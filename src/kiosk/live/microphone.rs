//! How the microphone does over time, for staff: exact silence, samples at full scale, a gain that changes by itself.
//! Of the sound itself nothing is kept.

use soffio_config::remedies;
use soffio_detector::{BlowEstimate, Reason};
use soffio_simulation::STEPS_PER_SECOND;

/// A microphone that sends exact zeros for this long is muted, or its cable is out: 3 s.
const MUTED_STEPS: u64 = 3 * STEPS_PER_SECOND;
/// For how long clipping is worth a word: 10 s.
const LATELY_STEPS: u64 = 10 * STEPS_PER_SECOND;

/// What is known of the microphone.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MicrophoneHealth {
    /// Times that samples reached full scale: a hard breath may, nothing else should.
    pub clips: u64,
    /// Those among them when nobody blew.
    pub clips_without_breath: u64,
    /// Steps of exact silence until now.
    silent_steps: u64,
    clipping: bool,
    /// Steps since it clipped when nobody blew.
    since_clip: Option<u64>,
    gain_control: bool,
    loud: bool,
}

impl MicrophoneHealth {
    /// Takes notice of a step: whether there is a microphone, and what the detector says.
    pub fn note(&mut self, listens: bool, heard: &BlowEstimate) {
        let silent = listens && heard.reason == Reason::NoSignal;
        self.silent_steps = if silent { self.silent_steps + 1 } else { 0 };
        self.since_clip = self.since_clip.map(|steps| steps + 1).filter(|steps| *steps < LATELY_STEPS);
        let clipping = listens && heard.clipping;
        if clipping && !self.clipping {
            self.clips += 1;
            // What is going to be a breath is none yet in its first frames.
            if !matches!(heard.reason, Reason::Blow | Reason::Pending) {
                self.clips_without_breath += 1;
                self.since_clip = Some(0);
            }
        }
        self.clipping = clipping;
        self.gain_control = listens && heard.gain_control;
        self.loud = listens && heard.floor_dbfs > remedies::LOUD_DBFS;
    }

    /// Does it send nothing but exact silence?
    pub fn is_silent(&self) -> bool {
        self.silent_steps > MUTED_STEPS
    }

    /// Has it clipped lately, though nobody blew?
    pub fn clips_lately(&self) -> bool {
        self.since_clip.is_some()
    }

    /// What staff should do about it, the gravest first; nothing where it is well.
    pub fn remedies(&self) -> impl Iterator<Item = &'static str> {
        let advice = [
            (self.is_silent(), remedies::MUTED),
            (self.gain_control, remedies::GAIN_CONTROL),
            (self.clips_lately(), remedies::CLIPPING),
            (self.loud, remedies::LOUD),
        ];
        advice.into_iter().filter_map(|(needed, remedy)| needed.then_some(remedy))
    }
}

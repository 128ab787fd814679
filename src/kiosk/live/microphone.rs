//! Health of the microphone over time, for staff: exact silence, clipping, automatic gain control. The sound itself is not
//! stored.

use soffio_config::remedies;
use soffio_detector::{BlowEstimate, Reason};
use soffio_simulation::STEPS_PER_SECOND;

/// Time of exact zeros after which the microphone is muted, or its cable is out: 3 s.
const MUTED_STEPS: u64 = 3 * STEPS_PER_SECOND;
/// Time for which clipping is reported: 10 s.
const LATELY_STEPS: u64 = 10 * STEPS_PER_SECOND;

/// Health of the microphone.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MicrophoneHealth {
    /// Number of times that samples reached full scale; only a hard breath should.
    pub clips: u64,
    /// Number of those without a breath.
    pub clips_without_breath: u64,
    /// Steps of exact silence until now.
    silent_steps: u64,
    clipping: bool,
    /// Steps since the last clipping without a breath.
    since_clip: Option<u64>,
    gain_control: bool,
    loud: bool,
}

impl MicrophoneHealth {
    /// Records a step: whether there is a microphone, and the detector's estimate.
    pub fn update(&mut self, listens: bool, estimate: &BlowEstimate) {
        let silent = listens && estimate.reason == Reason::NoSignal;
        self.silent_steps = if silent { self.silent_steps + 1 } else { 0 };
        self.since_clip = self.since_clip.map(|steps| steps + 1).filter(|steps| *steps < LATELY_STEPS);
        let clipping = listens && estimate.clipping;
        if clipping && !self.clipping {
            self.clips += 1;
            // The first frames of a breath are not detected yet.
            if !matches!(estimate.reason, Reason::Blow | Reason::Pending) {
                self.clips_without_breath += 1;
                self.since_clip = Some(0);
            }
        }
        self.clipping = clipping;
        self.gain_control = listens && estimate.gain_control;
        self.loud = listens && estimate.floor_dbfs > remedies::LOUD_DBFS;
    }

    /// Does it deliver exact silence?
    pub fn is_silent(&self) -> bool {
        self.silent_steps > MUTED_STEPS
    }

    /// Did it clip recently without a breath?
    pub fn clips_lately(&self) -> bool {
        self.since_clip.is_some()
    }

    /// Remedies for staff, the most important first; none for a good microphone.
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

//! A run of the audio self-test: the devices open, the sweep is played, the microphone records it. The samples stay in
//! memory for a few seconds, and are overwritten with the outcome.

use std::sync::Arc;

use crate::venue::sweep::{RECORDED_S, SweepResponse, measure_response, sweep};
use soffio_devices::audio::{AudioStatus, DeviceState, Utterance};
use zeroize::Zeroizing;

/// Longest wait for the devices to open, s.
const OPENING_S: f64 = 8.0;
/// Time from open devices to the sweep, s: their filters settle, and the volume reaches its value.
const SETTLING_S: f64 = 1.0;
/// Longest wait for the whole recording, s.
const PATIENCE_S: f64 = RECORDED_S + 2.0;
/// Most samples of one read, s: the ring of the microphone.
const LONGEST_READ_S: f64 = 2.0;

/// Outcome of a run: the response, or the reason why there is none.
pub type SelfTestOutcome = Result<SweepResponse, String>;

/// Next action of a run.
#[derive(Debug)]
pub enum SelfTestAction {
    /// Play the sweep.
    PlaySweep(Utterance),
    /// The run is over.
    Done(SelfTestOutcome),
}

/// State of a run.
#[derive(Debug, Default)]
pub struct SelfTestRun(SelfTestPhase);

#[derive(Debug, Default)]
enum SelfTestPhase {
    #[default]
    Idle,
    /// Start of the phase, s, and when both devices were first open.
    Opening(f64, Option<f64>),
    Recording {
        since: f64,
        rate: u32,
        samples: Zeroizing<Vec<f32>>,
    },
}

impl SelfTestRun {
    /// Begins a run at `time`, s; nothing happens where one is running.
    pub fn begin(&mut self, time: f64) {
        if !self.is_running() {
            self.0 = SelfTestPhase::Opening(time, None);
        }
    }

    /// Is a run on its way? Then the microphone must be open, and the output at its usual volume.
    pub fn is_running(&self) -> bool {
        !matches!(self.0, SelfTestPhase::Idle)
    }

    /// Continues with the samples recorded since the last call; `recorded` holds them and their rate, Hz.
    pub fn update(
        &mut self,
        time: f64,
        status: &AudioStatus,
        recorded: (&[f32], Option<u32>),
    ) -> Option<SelfTestAction> {
        match &mut self.0 {
            SelfTestPhase::Idle => None,
            SelfTestPhase::Opening(since, there) => match (&status.input, &status.output, recorded.1) {
                (DeviceState::Ok { .. }, DeviceState::Ok { sample_rate, .. }, Some(rate)) => {
                    if time - *there.get_or_insert(time) < SETTLING_S {
                        return None;
                    }
                    let samples: Arc<[f32]> = sweep(*sample_rate).into();
                    let most = ((RECORDED_S + LONGEST_READ_S) * f64::from(rate)) as usize;
                    let recording = Zeroizing::new(Vec::with_capacity(most));
                    self.0 = SelfTestPhase::Recording { since: time, rate, samples: recording };
                    Some(SelfTestAction::PlaySweep(Utterance { samples, sample_rate: *sample_rate }))
                }
                (input, output, _) if time - *since >= OPENING_S => {
                    let missing = [("loudspeaker", output), ("microphone", input)]
                        .into_iter()
                        .find(|(_, state)| !matches!(state, DeviceState::Ok { .. }));
                    let why = missing.map_or("no sample arrives from the microphone".into(), |(what, state)| {
                        format!("{what}: {state}")
                    });
                    self.end(Err(why))
                }
                _ => None,
            },
            SelfTestPhase::Recording { since, rate, samples } => {
                // A buffer that grew would leave a copy behind.
                let left = samples.capacity() - samples.len();
                samples.extend_from_slice(&recorded.0[..recorded.0.len().min(left)]);
                let enough = samples.len() as f64 >= RECORDED_S * f64::from(*rate);
                if enough {
                    let came = measure_response(samples, *rate);
                    return self.end(Ok(came));
                }
                let lost = recorded.1 != Some(*rate) || time - *since > PATIENCE_S;
                if lost { self.end(Err("the microphone was lost during the test".into())) } else { None }
            }
        }
    }

    fn end(&mut self, outcome: SelfTestOutcome) -> Option<SelfTestAction> {
        self.0 = SelfTestPhase::Idle;
        Some(SelfTestAction::Done(outcome))
    }
}

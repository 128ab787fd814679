//! The course of a chirp (`chirp`): the microphone opens, the loudspeaker comes to its usual volume, the chirp is said,
//! the microphone hears it. A few seconds of samples in memory, gone with the answer.

use std::sync::Arc;

use crate::venue::chirp::{Arrived, HEARD_S, arrived, chirp};
use soffio_devices::audio::{AudioStatus, DeviceState, Words};

/// Devices that have not opened by then do not, s.
const OPENING_S: f64 = 8.0;
/// From when both are open to the chirp, s: filters of the devices settle, the volume glides to its place.
const SETTLING_S: f64 = 1.0;
/// Longer than what is to be heard, nothing is waited for, s.
const PATIENCE_S: f64 = HEARD_S + 2.0;

/// What came of a chirp: what arrived, or why none was sent.
pub type Outcome = Result<Arrived, String>;

/// What is to be done now.
#[derive(Debug)]
pub enum Act {
    /// The loudspeaker is to say the chirp.
    Say(Words),
    /// It is over.
    Done(Outcome),
}

/// A chirp on its way.
#[derive(Debug, Default)]
pub struct Course(State);

#[derive(Debug, Default)]
enum State {
    #[default]
    Idle,
    /// Since when, s; and since when both devices are there.
    Opens(f64, Option<f64>),
    Hears {
        since: f64,
        rate: u32,
        samples: Vec<f32>,
    },
}

impl Course {
    /// Begins, at `time`, s, where none is on its way.
    pub fn begin(&mut self, time: f64) {
        if !self.runs() {
            self.0 = State::Opens(time, None);
        }
    }

    /// Is the microphone wanted, and the loudspeaker at its usual volume?
    pub fn runs(&self) -> bool {
        !matches!(self.0, State::Idle)
    }

    /// Goes on with what the microphone heard since the last call (at this rate, Hz).
    pub fn tend(&mut self, time: f64, status: &AudioStatus, heard: (&[f32], Option<u32>)) -> Option<Act> {
        match &mut self.0 {
            State::Idle => None,
            State::Opens(since, there) => match (&status.input, &status.output, heard.1) {
                (DeviceState::Ok { .. }, DeviceState::Ok { sample_rate, .. }, Some(rate)) => {
                    if time - *there.get_or_insert(time) < SETTLING_S {
                        return None;
                    }
                    let samples: Arc<[f32]> = chirp(*sample_rate).into();
                    self.0 = State::Hears { since: time, rate, samples: Vec::new() };
                    Some(Act::Say(Words { samples, sample_rate: *sample_rate }))
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
            State::Hears { since, rate, samples } => {
                samples.extend_from_slice(heard.0);
                let enough = samples.len() as f64 >= HEARD_S * f64::from(*rate);
                if enough {
                    let came = arrived(samples, *rate);
                    return self.end(Ok(came));
                }
                let lost = heard.1 != Some(*rate) || time - *since > PATIENCE_S;
                if lost { self.end(Err("the microphone was lost in the middle".into())) } else { None }
            }
        }
    }

    fn end(&mut self, outcome: Outcome) -> Option<Act> {
        self.0 = State::Idle;
        Some(Act::Done(outcome))
    }
}

//! From the sum of all sounds to the loudspeaker: the room, the night, the limiter.
//!
//! ```text
//! mix ─┬──────────→ (+) ─→ night ─→ limiter ─→ out
//!      └─→ room ────┘
//! ```
//!
//! The volume comes after it, in the callback: what the limiter let pass stays below its ceiling at any volume up to 0 dB.

use super::limiter::Limiter;
use super::night::Night;
use super::reverb::{Reverb, ReverbSpec};

/// Frames that the room answers at once.
const PIECE: usize = 256;

pub(super) struct Master {
    sample_rate: f64,
    room: Option<Box<Reverb>>,
    night: Night,
    limiter: Limiter,
    started: bool,
}

impl Master {
    pub fn new(sample_rate: f64) -> Self {
        Self {
            sample_rate,
            room: None,
            night: Night::new(sample_rate),
            limiter: Limiter::new(sample_rate),
            started: false,
        }
    }

    /// Frames by which the sound comes later.
    pub fn latency(&self) -> usize {
        self.limiter.latency()
    }

    /// The room from now on; `None` and rooms that cannot be are the open air.
    pub fn set_room(&mut self, spec: Option<&ReverbSpec>) {
        self.room = spec.and_then(|spec| Reverb::new(spec, self.sample_rate)).map(Box::new);
    }

    /// Real-time.
    pub fn set_night(&mut self, night: bool) {
        self.night.set(night, !self.started);
    }

    /// Takes frames, gives those of [`Self::latency`] ago in their place; how they are cut into calls does not matter.
    /// Real-time.
    pub fn process(&mut self, frames: &mut [[f32; 2]]) {
        self.started = true;
        if let Some(room) = &mut self.room {
            for frames in frames.chunks_mut(PIECE) {
                let mut answer = [[0.0; 2]; PIECE];
                let answer = &mut answer[..frames.len()];
                answer.copy_from_slice(frames);
                room.answer(answer);
                frames.as_flattened_mut().iter_mut().zip(answer.as_flattened()).for_each(|(x, y)| *x += y);
            }
        }
        self.night.process(frames);
        self.limiter.process(frames);
    }
}

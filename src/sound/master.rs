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
use super::room::{Room, RoomSpec};

pub(super) struct Master {
    sample_rate: f64,
    room: Option<Box<Room>>,
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
    pub fn set_room(&mut self, spec: Option<&RoomSpec>) {
        self.room = spec.and_then(|spec| Room::new(spec, self.sample_rate)).map(Box::new);
    }

    /// Real-time.
    pub fn set_night(&mut self, night: bool) {
        self.night.set(night, !self.started);
    }

    /// Takes a frame, gives the frame of [`Self::latency`] ago. Real-time.
    pub fn process(&mut self, frame: [f32; 2]) -> [f32; 2] {
        self.started = true;
        let [l, r] = frame;
        let heard = match &mut self.room {
            Some(room) => {
                let [a, b] = room.process(frame);
                [l + a, r + b]
            }
            None => frame,
        };
        self.limiter.process(self.night.process(heard))
    }
}

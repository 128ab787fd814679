//! A second output, for a hearing loop or headphones: what the loudspeaker plays, in mono, at a volume of its own.
//!
//! The loudspeaker's callback gives what it plays, before the visitor's volume, into a ring; this one takes it out at its own
//! clock (`reference` says how two clocks are kept together). Each is a stream of its own: where this one stands still the
//! ring is full and the loudspeaker goes on, and where the loudspeaker stands still this one is silent.
//!
//! A mute, a closed house and an attract mode without a sound are obeyed here too: what comes through the ring then is
//! silence. What the visitor does to the volume is not: who wears a hearing aid has one there.

use cpal::{FromSample, SizedSample};
use rtrb::{Consumer, Producer, RingBuffer};

use super::reference::ReferenceTap;
use soffio_math::exp;

/// What waits between the two devices, s: the longest usual block of either.
const WAITS: f64 = 0.06;
/// Room in the ring, s.
const ROOM: f64 = 1.0;
/// Frames at once, however long the device's blocks are.
const CHUNK: usize = 256;
/// Time constant of what fades when nothing comes, and comes back, s: no click.
const GLIDE: f64 = 0.005;

/// The loudspeaker's end.
pub struct Tail(pub(super) Producer<f32>);

/// The real-time end: all that the second device's callback touches.
pub struct Hearing {
    from: Consumer<f32>,
    from_rate: u32,
    rate: u32,
    channels: usize,
    tap: ReferenceTap,
    /// Enough has come to play it.
    flows: bool,
    samples: Vec<f32>,
    /// What was played last, and how far it is faded in.
    last: f32,
    faded: f32,
    glide: f32,
    gain: f32,
}

/// Both ends, between devices of these rates, Hz; `gain` is linear.
pub fn open(from_rate: u32, rate: u32, channels: usize, gain: f32) -> (Tail, Hearing) {
    let (to, from) = RingBuffer::new((ROOM * f64::from(from_rate)) as usize);
    let hearing = Hearing {
        from,
        from_rate,
        rate,
        channels: channels.max(1),
        tap: ReferenceTap::default(),
        flows: false,
        samples: Vec::with_capacity(CHUNK),
        last: 0.0,
        faded: 0.0,
        glide: (1.0 - exp(-1.0 / (GLIDE * f64::from(rate.max(1))))) as f32,
        gain,
    };
    (Tail(to), hearing)
}

impl Hearing {
    /// The callback's whole body. Real-time: bounded, no allocation, no lock, no system call.
    pub fn play<T: SizedSample + FromSample<f32>>(&mut self, data: &mut [T]) {
        for out in data.chunks_mut(CHUNK * self.channels) {
            let count = out.len() / self.channels;
            self.take(count);
            for (i, frame) in out.chunks_mut(self.channels).enumerate() {
                let target = if self.flows { 1.0 } else { 0.0 };
                self.faded += (target - self.faded) * self.glide;
                // While nothing comes, the last sample fades.
                self.last = self.samples.get(i).copied().unwrap_or(self.last);
                frame.fill(T::from_sample(self.faded * self.gain * self.last));
            }
        }
    }

    /// Takes so many samples, or none until enough have come.
    fn take(&mut self, count: usize) {
        self.samples.clear();
        let needed = |seconds: f64| (seconds * f64::from(self.from_rate)) as usize;
        let block = needed(count as f64 / f64::from(self.rate.max(1)));
        if !self.flows && self.from.slots() >= needed(WAITS) + block {
            self.flows = true;
            self.tap = ReferenceTap::keeping(WAITS);
        }
        // Two more: those between which the resampler stands.
        self.flows &= self.from.slots() >= block + 2;
        if self.flows {
            self.tap.read(&mut self.from, self.from_rate, self.rate, count, &mut self.samples);
        }
    }
}

//! Hearing loop: a second output for an induction loop or headphones, in mono, with its own volume.
//!
//! The output's callback writes its signal, before the visitor's volume, into a ring; this callback reads it at its own clock
//! (see `reference` for the clock drift). The streams are independent: if this one stalls, the ring is full and the output
//! continues; if the output stalls, this one is silent.
//!
//! Mute, closing hours and a silent attract mode apply here too. The visitor's volume does not, because hearing aids have their
//! own.

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
/// Time constant of the fades when samples run out or return, s: no click.
const GLIDE: f64 = 0.005;

/// The loudspeaker's end.
pub struct Tail(pub(super) Producer<f32>);

/// The real-time end: all that the second device's callback touches.
pub struct HearingLoop {
    from: Consumer<f32>,
    from_rate: u32,
    rate: u32,
    channels: usize,
    tap: ReferenceTap,
    /// Whether enough samples have arrived.
    flows: bool,
    samples: Vec<f32>,
    /// What was played last, and how far it is faded in.
    last: f32,
    faded: f32,
    glide: f32,
    gain: f32,
}

/// Makes both ends of a hearing loop: the main output writes mono samples at `from_rate`, Hz; the second device plays them
/// at `rate`, Hz, on all of its `channels`, with the linear `gain`.
pub fn open(from_rate: u32, rate: u32, channels: usize, gain: f32) -> (Tail, HearingLoop) {
    let (to, from) = RingBuffer::new((ROOM * f64::from(from_rate)) as usize);
    let hearing = HearingLoop {
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

impl HearingLoop {
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

//! The microphone: a real-time thread that copies one channel into a ring.

use cpal::{FromSample, Sample, SizedSample};
use rtrb::{Consumer, Producer, RingBuffer};

/// Room in the ring, s: as long as the kiosk may stand still without losing what was heard.
const RING: u32 = 2;

/// The real-time end: everything that the microphone's callback touches.
pub struct Recorder {
    ring: Producer<f32>,
    channels: usize,
    /// The channel that listens; `None` mixes all.
    channel: Option<usize>,
}

/// The kiosk's end.
pub struct Ears {
    ring: Consumer<f32>,
    sample_rate: u32,
}

/// The two ends of a microphone. `channel` counts from 1 (0 mixes all); one that the device lacks mixes all too.
pub fn open(sample_rate: u32, channels: usize, channel: u16) -> (Recorder, Ears) {
    let (to, from) = RingBuffer::new((RING * sample_rate) as usize);
    let channels = channels.max(1);
    let channel = usize::from(channel).checked_sub(1).filter(|channel| *channel < channels);
    (Recorder { ring: to, channels, channel }, Ears { ring: from, sample_rate })
}

impl Recorder {
    /// The callback's whole body. Real-time: bounded, no allocation, no lock, no system call.
    pub fn record<T: SizedSample>(&mut self, data: &[T])
    where
        f32: FromSample<T>,
    {
        let share = 1.0 / self.channels as f32;
        for frame in data.chunks_exact(self.channels) {
            let sample = match self.channel {
                Some(channel) => f32::from_sample(frame[channel]),
                None => frame.iter().map(|s| f32::from_sample(*s)).sum::<f32>() * share,
            };
            // A full ring means that nobody listens.
            let _ = self.ring.push(sample);
        }
    }
}

impl Ears {
    /// Hz.
    pub fn sample_rate(&self) -> u32 {
        self.sample_rate
    }

    /// Appends what was heard since the last call; how many samples that is.
    pub fn read(&mut self, into: &mut Vec<f32>) -> usize {
        let count = self.ring.slots();
        let Ok(chunk) = self.ring.read_chunk(count) else { return 0 };
        let (first, second) = chunk.as_slices();
        into.extend_from_slice(first);
        into.extend_from_slice(second);
        chunk.commit_all();
        count
    }
}

//! Microphone input: a real-time callback that copies its one or two channels into a ring buffer.

use cpal::{FromSample, Sample, SizedSample};
use rtrb::{Consumer, Producer, RingBuffer};

use soffio_simulation::Microphone;

/// Capacity of the ring, s: the longest stall of the kiosk without lost samples.
const RING: u32 = 2;

/// The real-time end: everything that the microphone's callback touches.
pub struct Recorder {
    ring: Producer<[f32; 2]>,
    channels: usize,
    /// The channel that listens; `None` mixes all.
    channel: Option<usize>,
    /// The second capsule's.
    second: Option<usize>,
}

/// The kiosk's end.
pub struct MicrophoneReader {
    ring: Consumer<[f32; 2]>,
    sample_rate: u32,
    two: bool,
}

/// Opens both ends of a microphone. `wanted`: channels of the first and the second capsule, from 1.
///
/// If the first is 0 or the device lacks it, all channels are mixed; but with [0, 0] two channels are taken as two capsules. The
/// second is 0 for none. It is ignored beside a mix, or if the device lacks it.
pub fn open(sample_rate: u32, channels: usize, wanted: [u16; 2]) -> (Recorder, MicrophoneReader) {
    let (to, from) = RingBuffer::new((RING * sample_rate) as usize);
    let channels = channels.max(1);
    let wanted = if wanted == [0, 0] && channels == 2 { [1, 2] } else { wanted };
    let [channel, second] =
        wanted.map(|number| usize::from(number).checked_sub(1).filter(|channel| *channel < channels));
    let second = second.filter(|_| channel.is_some() && channel != second);
    (
        Recorder { ring: to, channels, channel, second },
        MicrophoneReader { ring: from, sample_rate, two: second.is_some() },
    )
}

/// Samples since the last read, and the output of the same time, all at the microphone's rate.
#[derive(Clone, Debug, Default)]
pub struct MicrophoneSamples {
    /// One capsule, full scale ±1.
    pub samples: Vec<f32>,
    /// The second one, as long; empty where there is one only.
    pub second: Vec<f32>,
    /// Output signal, mono, as long; empty without an output device.
    pub reference: Vec<f32>,
}

impl MicrophoneSamples {
    /// Removes all samples.
    pub fn clear(&mut self) {
        self.samples.clear();
        self.second.clear();
        self.reference.clear();
    }

    /// The `i`-th of `n` consecutive equal parts, as the microphone input of a step at `sample_rate` Hz.
    pub fn share(&self, i: u64, n: u64, sample_rate: u32) -> Microphone<'_> {
        let part = |all: &'_ [f32]| {
            let bound = |k: u64| (all.len() as u64 * k / n) as usize;
            bound(i)..bound(i + 1)
        };
        let second = (!self.second.is_empty()).then(|| &self.second[part(&self.second)]);
        let (samples, reference) = (&self.samples[part(&self.samples)], &self.reference[part(&self.reference)]);
        Microphone { samples, second, sample_rate, reference }
    }
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
            let second = self.second.map_or(0.0, |channel| f32::from_sample(frame[channel]));
            // A full ring means that the kiosk has stalled.
            let _ = self.ring.push([sample, second]);
        }
    }
}

impl MicrophoneReader {
    /// Sample rate of the microphone, Hz.
    pub fn sample_rate(&self) -> u32 {
        self.sample_rate
    }

    /// How many capsules listen, 1 or 2.
    pub fn capsules(&self) -> usize {
        1 + usize::from(self.two)
    }

    /// Appends the samples since the last call. Returns their number for each capsule.
    pub fn read(&mut self, into: &mut MicrophoneSamples) -> usize {
        let count = self.ring.slots();
        let Ok(chunk) = self.ring.read_chunk(count) else { return 0 };
        let (head, tail) = chunk.as_slices();
        for frames in [head, tail] {
            into.samples.extend(frames.iter().map(|frame| frame[0]));
            if self.two {
                into.second.extend(frames.iter().map(|frame| frame[1]));
            }
        }
        chunk.commit_all();
        count
    }
}

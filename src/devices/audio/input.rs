//! The microphone: a real-time thread that copies its capsules into a ring, a pair a frame.

use cpal::{FromSample, Sample, SizedSample};
use rtrb::{Consumer, Producer, RingBuffer};

use soffio_simulation::Microphone;

/// Room in the ring, s: as long as the kiosk may stand still without losing what was heard.
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
pub struct Ears {
    ring: Consumer<[f32; 2]>,
    sample_rate: u32,
    two: bool,
}

/// The two ends of a microphone. Channels count from 1. The first is the capsule's own (0 takes all: two are two capsules,
/// more are mixed, as is where the device lacks the channel); the other is a second capsule's (0 for none, as is one that the
/// device lacks, and any beside a mix).
pub fn open(sample_rate: u32, channels: usize, wanted: [u16; 2]) -> (Recorder, Ears) {
    let (to, from) = RingBuffer::new((RING * sample_rate) as usize);
    let channels = channels.max(1);
    let wanted = if wanted == [0, 0] && channels == 2 { [1, 2] } else { wanted };
    let [channel, second] =
        wanted.map(|number| usize::from(number).checked_sub(1).filter(|channel| *channel < channels));
    let second = second.filter(|_| channel.is_some() && channel != second);
    (Recorder { ring: to, channels, channel, second }, Ears { ring: from, sample_rate, two: second.is_some() })
}

/// What was heard since the last look, and what the loudspeaker played meanwhile. All at the microphone's rate.
#[derive(Clone, Debug, Default)]
pub struct Heard {
    /// One capsule, full scale ±1.
    pub samples: Vec<f32>,
    /// The second one, as long; empty where there is one only.
    pub second: Vec<f32>,
    /// What was played, mono, as long; empty without a loudspeaker.
    pub reference: Vec<f32>,
}

impl Heard {
    /// Forgets it.
    pub fn clear(&mut self) {
        self.samples.clear();
        self.second.clear();
        self.reference.clear();
    }

    /// The `i`-th of `n` equal shares, in order and without a gap, as a step hears it at `sample_rate` Hz.
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
            // A full ring means that nobody listens.
            let _ = self.ring.push([sample, second]);
        }
    }
}

impl Ears {
    /// Hz.
    pub fn sample_rate(&self) -> u32 {
        self.sample_rate
    }

    /// How many capsules listen, 1 or 2.
    pub fn capsules(&self) -> usize {
        1 + usize::from(self.two)
    }

    /// Appends what was heard since the last call; how many samples of each capsule that is.
    pub fn read(&mut self, into: &mut Heard) -> usize {
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

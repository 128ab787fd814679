//! Microphone input: a real-time callback that copies its one or two channels into a ring buffer.
//!
//! Samples are overwritten with zeros once they are read or cleared, so that memory holds no more of them than the next step needs.

use cpal::{FromSample, Sample, SizedSample};
use rtrb::{Consumer, Producer, RingBuffer};
use zeroize::{Zeroize, Zeroizing};

use crate::protection::LockedMemory;
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

/// The kiosk's end. When it is dropped, the rest of the ring is overwritten, and the other end stops.
pub struct MicrophoneReader {
    /// Of the ring, and so before it.
    _locked: Option<LockedMemory>,
    ring: Consumer<[f32; 2]>,
    sample_rate: u32,
    two: bool,
}

/// Opens both ends of a microphone. `wanted`: channels of the first and the second capsule, from 1.
///
/// If the first is 0 or the device lacks it, all channels are mixed; but with [0, 0] two channels are taken as two capsules. The
/// second is 0 for none. It is ignored beside a mix, or if the device lacks it.
pub fn open(sample_rate: u32, channels: usize, wanted: [u16; 2]) -> (Recorder, MicrophoneReader) {
    let (mut to, from) = RingBuffer::new((RING * sample_rate) as usize);
    let slots = to.slots();
    // The whole of a new ring is free, and lies in one piece.
    let locked = to.write_chunk_uninit(slots).ok().and_then(|mut chunk| LockedMemory::lock(chunk.as_mut_slices().0));
    if locked.is_none() {
        tracing::debug!("the microphone's ring is not locked in memory: LimitMEMLOCK allows no more");
    }
    let channels = channels.max(1);
    let wanted = if wanted == [0, 0] && channels == 2 { [1, 2] } else { wanted };
    let [channel, second] =
        wanted.map(|number| usize::from(number).checked_sub(1).filter(|channel| *channel < channels));
    let second = second.filter(|_| channel.is_some() && channel != second);
    (
        Recorder { ring: to, channels, channel, second },
        MicrophoneReader { _locked: locked, ring: from, sample_rate, two: second.is_some() },
    )
}

/// Samples since the last read, and the output of the same time, all at the microphone's rate. They are overwritten when it is
/// cleared or dropped.
#[derive(Clone, Debug, Default)]
pub struct MicrophoneSamples {
    /// One capsule, full scale ±1.
    pub samples: Zeroizing<Vec<f32>>,
    /// The second one, as long; empty where there is one only.
    pub second: Zeroizing<Vec<f32>>,
    /// Output signal, mono, as long; empty without an output device.
    pub reference: Vec<f32>,
}

impl MicrophoneSamples {
    /// Overwrites and removes all samples.
    pub fn clear(&mut self) {
        for samples in [&mut self.samples, &mut self.second] {
            samples.as_mut_slice().zeroize();
            samples.clear();
        }
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
        // Samples that nobody reads would stay in the ring.
        if self.ring.is_abandoned() {
            return;
        }
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

/// Appends one channel of some frames. A buffer that has to grow leaves no copy behind.
fn append(samples: &mut Zeroizing<Vec<f32>>, frames: &[[f32; 2]], channel: usize) {
    let needed = samples.len() + frames.len();
    if needed > samples.capacity() {
        let mut larger = Vec::with_capacity(needed.max(2 * samples.capacity()));
        larger.extend_from_slice(samples);
        // The old one is overwritten as it is dropped.
        *samples = Zeroizing::new(larger);
    }
    samples.extend(frames.iter().map(|frame| frame[channel]));
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
        let two = self.two;
        self.take(|frames| {
            append(&mut into.samples, frames, 0);
            if two {
                append(&mut into.second, frames, 1);
            }
        })
    }

    /// Passes all frames in the ring, in at most two pieces, and overwrites them. Returns their number.
    fn take(&mut self, mut pass: impl FnMut(&[[f32; 2]])) -> usize {
        let count = self.ring.slots();
        let Ok(mut chunk) = self.ring.read_chunk(count) else { return 0 };
        let (head, tail) = chunk.as_mut_slices();
        for frames in [head, tail] {
            pass(frames);
            frames.as_flattened_mut().zeroize();
        }
        chunk.commit_all();
        count
    }
}

impl Drop for MicrophoneReader {
    fn drop(&mut self) {
        self.take(|_| {});
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sample rate of these tests, Hz.
    const RATE: u32 = 8000;

    /// The slots of a ring that are free: all of them once everything was read. Slots keep their last values.
    fn free_slots(recorder: &mut Recorder) -> Vec<f32> {
        let slots = recorder.ring.slots();
        let mut chunk = recorder.ring.write_chunk_uninit(slots).expect("they are free");
        let (head, tail) = chunk.as_mut_slices();
        [head, tail].into_iter().flatten().flat_map(|slot| written(slot)).collect()
    }

    #[allow(unsafe_code)]
    fn written(slot: &std::mem::MaybeUninit<[f32; 2]>) -> [f32; 2] {
        // SAFETY: the test has filled the whole ring once, and all bits are a number.
        unsafe { slot.assume_init() }
    }

    #[test]
    fn a_ring_that_was_read_holds_zeros_and_so_does_one_whose_reader_is_gone() {
        let (mut recorder, mut reader) = open(RATE, 2, [1, 2]);
        let noise = vec![0.5_f32; 2 * (RING * RATE) as usize];
        let mut samples = MicrophoneSamples::default();
        recorder.record(&noise);
        assert_eq!(recorder.ring.slots(), 0, "the ring is full");
        assert_eq!(reader.read(&mut samples), (RING * RATE) as usize);
        assert!(samples.samples.iter().chain(samples.second.iter()).all(|sample| *sample == 0.5));
        assert!(free_slots(&mut recorder).iter().all(|sample| *sample == 0.0), "what was read is overwritten");

        recorder.record(&noise);
        // The ring lives on in its other end.
        drop(reader);
        recorder.record(&noise);
        let (ring, filled) = (recorder.ring.slots(), (RING * RATE) as usize);
        assert_eq!(ring, filled, "what was left is taken out, and nothing more is written");
        assert!(free_slots(&mut recorder).iter().all(|sample| *sample == 0.0));
    }

    #[test]
    fn cleared_samples_and_outgrown_buffers_are_overwritten() {
        let mut samples = MicrophoneSamples::default();
        append(&mut samples.samples, &[[0.25, 0.75]; 100], 0);
        append(&mut samples.second, &[[0.25, 0.75]; 100], 1);
        let capacity = samples.samples.capacity();
        append(&mut samples.samples, &[[0.25, 0.75]; 1000], 0);
        assert!(samples.samples.capacity() > capacity && samples.samples.len() == 1100);
        assert!(samples.samples.iter().all(|s| *s == 0.25) && samples.second.iter().all(|s| *s == 0.75));
        samples.clear();
        assert!(samples.samples.is_empty());
        // Growing again, they would show what the memory still has.
        for buffer in [&mut samples.samples, &mut samples.second] {
            assert!(spare(buffer).iter().all(|sample| *sample == 0.0));
        }
    }

    /// What a cleared buffer has behind its end, as far as it was filled.
    #[allow(unsafe_code)]
    fn spare(buffer: &mut Zeroizing<Vec<f32>>) -> Vec<f32> {
        let spare = &buffer.spare_capacity_mut()[..100];
        // SAFETY: the test has filled a hundred samples there.
        spare.iter().map(|sample| unsafe { sample.assume_init() }).collect()
    }
}

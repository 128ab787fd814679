//! Front end of the detector: from raw samples to the network's inputs, a frame every 8 ms. Training uses the same code.

use super::bands::power_to_db;
use super::echo_estimate::EchoEstimate;
use super::features::{self, Features};
use super::resample::{INTERNAL_RATE, Resampler};
use super::spectrum::{Framer, Sample};
use soffio_math::{PI, exp};

/// Lowest level that is reported, dB of full scale.
pub const SILENCE_DBFS: f64 = -120.0;
/// From this amplitude a sample counts as clipped.
const RAIL: f32 = 0.999;
/// Frames for which a fault holds: the analysis window (6 frames) and the smoothing after it.
const FAULT_HOLD_FRAMES: u32 = 10;

/// Corner of the high-pass that removes a converter's offset, Hz: below the lowest band.
const OFFSET_HZ: f64 = 8.0;

/// Front end: samples in, inputs of the network out.
#[derive(Clone, Debug)]
pub struct Frontend {
    input: Input,
    left: Channel,
    right: Channel,
    reference: Resampler,
    framer: Framer,
    /// Echo of the loudspeaker. Boxed, since it is large and a detector moves from exhibit to exhibit.
    pub(super) echo: Box<EchoEstimate>,
    /// Inputs of the network, and the floors.
    pub features: Features,
    /// Samples of a second capsule have arrived, which differ from those of the first.
    stereo: bool,
}

/// One analysed frame.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    /// Inputs of the network and what they come from; `None` while samples are not finite, or were within the last frames.
    pub measured: Option<features::Frame>,
    /// Level of the frame, dB of full scale.
    pub level_dbfs: f64,
    /// Samples are clipped.
    pub clipping: bool,
    /// Every sample is exactly 0.
    pub zero: bool,
}

/// Resampler and high-pass of a capsule.
#[derive(Clone, Debug)]
struct Channel {
    resampler: Resampler,
    /// e^(−2π f/R): pole of the high-pass y ← x − x′ + p y.
    pole: f64,
    before: f64,
    out: f64,
}

impl Channel {
    fn new(resampler: Resampler) -> Self {
        Self { resampler, pole: exp(-2.0 * PI * OFFSET_HZ / f64::from(INTERNAL_RATE)), before: 0.0, out: 0.0 }
    }

    fn push(&mut self, sample: f64) -> Option<f64> {
        let x = self.resampler.push(sample)?;
        self.out = x - self.before + self.pole * self.out;
        self.before = x;
        Some(self.out)
    }
}

/// Statistics of the raw samples of the present frame.
#[derive(Clone, Copy, Debug, Default)]
struct Input {
    count: u32,
    square: f64,
    railed: u32,
    faulty: bool,
    /// Frames for which a fault still holds: until the bad samples have left the analysis window.
    fault_hold: u32,
}

impl Frontend {
    /// A front end for samples at `sample_rate` Hz (8–192 kHz).
    pub fn new(sample_rate: u32) -> Self {
        let resampler = Resampler::new(sample_rate);
        Self {
            input: Input::default(),
            left: Channel::new(resampler.clone()),
            right: Channel::new(resampler.clone()),
            reference: resampler,
            framer: Framer::new(),
            echo: Box::new(EchoEstimate::new()),
            features: Features::new(),
            stereo: false,
        }
    }

    /// The same front end, for two capsules that are known to be two. Otherwise the first sample that differs says so.
    pub fn of_two_capsules(self) -> Self {
        Self { stereo: true, ..self }
    }

    /// Two capsules are heard.
    pub(super) fn is_stereo(&self) -> bool {
        self.stereo
    }

    /// Takes one sample of each capsule and of the loudspeaker; returns a frame where one is ready. The echo is not learnt where
    /// `learn_echo` is false, so that a breath is not taken for the kiosk's response to it.
    pub fn push(&mut self, left: f32, right: Option<f32>, played: f32, learn_echo: bool) -> Option<Frame> {
        let first = self.input.push(left);
        let played = if played.is_finite() { f64::from(played.clamp(-1.0, 1.0)) } else { 0.0 };
        let second = right.map(|x| self.input.push(x));
        // Many devices send one microphone on both channels: that is one capsule, whose two copies would be all sound and no air.
        self.stereo |= second.is_some_and(|second| second != first);
        let reference = self.reference.push(played);
        let left = self.left.push(first);
        let right = if self.stereo { self.right.push(second.unwrap_or(first)) } else { left };
        let sample = || Some(Sample { left: left?, right: right?, reference: reference? });
        sample().is_some_and(|sample| self.framer.push(sample)).then(|| self.frame(learn_echo))
    }

    fn frame(&mut self, learn_echo: bool) -> Frame {
        let input = self.input.take();
        let measured = (input.fault_hold == 0).then(|| {
            self.echo.push(&self.framer.microphone, &self.framer.reference, learn_echo);
            self.features.push(&self.framer, &self.echo.predicted, self.stereo)
        });
        Frame {
            measured,
            level_dbfs: power_to_db(input.square / f64::from(input.count.max(1))).max(SILENCE_DBFS),
            clipping: input.railed > 1,
            zero: input.square == 0.0,
        }
    }
}

impl Input {
    /// Counts one raw sample; returns it limited to full scale, or 0 where it is not finite.
    fn push(&mut self, sample: f32) -> f64 {
        self.count += 1;
        if !sample.is_finite() {
            self.faulty = true;
            return 0.0;
        }
        if sample.abs() >= RAIL {
            self.railed += 1;
        }
        let sample = f64::from(sample.clamp(-1.0, 1.0));
        self.square += sample * sample;
        sample
    }

    /// The statistics of the finished frame; starts the next.
    fn take(&mut self) -> Self {
        let fault_hold = if self.faulty { FAULT_HOLD_FRAMES } else { self.fault_hold.saturating_sub(1) };
        std::mem::replace(self, Self { fault_hold, ..Self::default() })
    }
}

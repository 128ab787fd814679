//! Front end of the detector: from raw samples to features, a frame every 8 ms. Training uses the same code.

use super::coherence::{Coherence, LOW_SUBBAND};
use super::dual_mic::DualMic;
use super::dual_mic_model::REGIONS;
use super::echo_estimate::EchoEstimate;
use super::features::{
    COUNT, FALL, FeatureExtractor, Features, Freeze, Levels, MIN_DIFFERENCE_FLOOR, MIN_FLOOR, power_to_db,
};
use super::high_band::HighBand;
use super::resample::Resampler;
use super::spectrum::{Framer, Sample};

/// Length of sound that is needed before a breath can be detected, s: the noise floor settles meanwhile.
pub(super) const SETTLING_S: f64 = 0.25;
/// Lowest level that is reported, dB of full scale.
pub(super) const SILENCE_DBFS: f64 = -120.0;
/// From this amplitude a sample counts as clipped.
const RAIL: f32 = 0.999;
/// Frames for which a fault holds: the analysis window (6 frames) and the smoothing after it.
const FAULT_HOLD_FRAMES: u32 = 10;

/// Front end: samples in, features out.
#[derive(Clone, Debug)]
pub struct Frontend {
    input: Input,
    /// The subband below 4 kHz. Boxed, since it is large and a detector moves from exhibit to exhibit.
    pub(super) low_subband: Box<Subband>,
    pub(super) extractor: FeatureExtractor,
    /// Features of the difference of two capsules.
    difference_extractor: FeatureExtractor,
    pub(super) dual_mic: DualMic,
    pub(super) coherence: Coherence<REGIONS>,
    /// The subband above 4 kHz, with two capsules only.
    high_subband: Box<Subband>,
    pub(super) high_band: Box<HighBand>,
    /// Samples of a second capsule have arrived.
    stereo: bool,
}

/// One subband, below or above 4 kHz: resamplers, spectra and echo estimate.
#[derive(Clone, Debug)]
pub(super) struct Subband {
    left: Resampler,
    right: Resampler,
    reference: Resampler,
    pub framer: Framer,
    pub echo: EchoEstimate,
}

impl Subband {
    fn new(resampler: Resampler) -> Self {
        let (left, right) = (resampler.clone(), resampler.clone());
        Self { left, right, reference: resampler, framer: Framer::new(), echo: EchoEstimate::new() }
    }

    /// Takes one sample of each capsule and of the loudspeaker; true where a new frame is ready.
    fn push(&mut self, left: f64, right: Option<f64>, played: f64) -> bool {
        let reference = self.reference.push(played);
        let left = self.left.push(left);
        let right = right.map_or(left, |x| self.right.push(x));
        let sample = || Some(Sample { left: left?, right: right?, reference: reference? });
        sample().is_some_and(|sample| self.framer.push(sample))
    }

    fn update_echo(&mut self, learn: bool) {
        self.echo.push(&self.framer.microphone, &self.framer.reference, learn);
    }
}

/// One analysed frame.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    /// Features of the microphone's spectrum, inputs of the model.
    pub features: Features,
    /// Levels that the decision needs beside the features.
    pub levels: Levels,
    /// Features and levels of the difference of two capsules; `None` with one capsule.
    pub difference: Option<(Features, Levels)>,
    /// Level of the frame, dB of full scale.
    pub level_dbfs: f64,
    /// Samples are clipped.
    pub clipping: bool,
    /// Samples are not finite, or were within the last frames.
    pub fault: bool,
    /// Every sample is exactly 0.
    pub zero: bool,
}

/// State of the decision that the front end adapts to.
#[derive(Clone, Copy, Debug)]
pub struct BreathState {
    /// A breath is detected.
    pub blowing: bool,
    /// A breath is likely, not detected yet.
    pub likely: bool,
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
        Self {
            input: Input::default(),
            low_subband: Box::new(Subband::new(Resampler::new(sample_rate))),
            extractor: FeatureExtractor::new(MIN_FLOOR),
            difference_extractor: FeatureExtractor::new(MIN_DIFFERENCE_FLOOR),
            dual_mic: DualMic::new(),
            coherence: Coherence::new(LOW_SUBBAND),
            high_subband: Box::new(Subband::new(Resampler::high_band(sample_rate))),
            high_band: Box::new(HighBand::new()),
            stereo: false,
        }
    }

    /// Takes one sample of each capsule and of the loudspeaker; returns a frame where one is ready. The noise floor is frozen
    /// during a breath and while one is likely; the echo estimate during a breath only.
    pub fn push(&mut self, left: f32, right: Option<f32>, played: f32, breath: BreathState) -> Option<Frame> {
        let first = self.input.push(left);
        let played = if played.is_finite() { f64::from(played.clamp(-1.0, 1.0)) } else { 0.0 };
        let second = right.map(|x| self.input.push(x));
        self.stereo |= second.is_some();
        let second = self.stereo.then(|| second.unwrap_or(first));
        if second.is_some() {
            // Both subbands come in step, from the same samples.
            self.high_subband.push(first, second, played);
        }
        self.low_subband.push(first, second, played).then(|| self.frame(breath))
    }

    fn frame(&mut self, BreathState { blowing, likely }: BreathState) -> Frame {
        let input = self.input.take();
        let fault = self.input.fault_hold > 0;
        let (mut features, mut levels, mut difference) = ([0.0; COUNT], Levels::default(), None);
        if !fault {
            self.low_subband.update_echo(!blowing);
            let Subband { framer, echo: estimate, .. } = &*self.low_subband;
            let masked = estimate.masks_low_band(&framer.microphone);
            let Framer { channels, scale, microphone, kurtosis, .. } = framer;
            let echo = &estimate.predicted;
            let freeze = Freeze { noise_floor: blowing || likely || masked, context: blowing };
            (features, levels) = self.extractor.push(microphone, echo, *kurtosis, freeze);
            levels.masked = masked;
            if self.stereo {
                // The noise floor of the difference is learnt before two capsules are recognised, which may happen amid a puff.
                self.dual_mic.push(channels, !(blowing || likely), *scale, microphone);
                let freeze = Freeze { noise_floor: blowing || likely, ..freeze };
                let residual = self.dual_mic.residual_echo(echo);
                let analysed = self.difference_extractor.push(&self.dual_mic.difference, &residual, *kurtosis, freeze);
                self.dual_mic.track_puff(analysed.1.rise_db, 10.0 * analysed.0[FALL[0]]);
                let is_known =
                    self.dual_mic.difference_ratio.is_some() && self.difference_extractor.age() >= SETTLING_S;
                difference = Some(analysed).filter(|_| is_known);
                self.coherence.push(channels, echo, !(blowing || likely), *scale);
                self.high_subband.update_echo(!blowing);
                let Subband { framer, echo: estimate, .. } = &*self.high_subband;
                self.high_band.push(framer, &estimate.predicted, freeze, levels.middle_dbfs);
            }
        }
        Frame {
            features,
            levels,
            difference,
            level_dbfs: power_to_db(input.square / f64::from(input.count.max(1))).max(SILENCE_DBFS),
            clipping: input.railed > 1,
            fault,
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

#[cfg(test)]
mod tests {
    use super::super::features::RISEN_DB;
    use super::*;
    use crate::generate::filter::{high_passed, low_passed, normalised, white};
    use soffio_math::db_to_amplitude;
    use soffio_math::noise::Random;

    const RATE: u32 = 8000;
    const SEED: u64 = 17;

    /// Band-limited noise between two frequencies, Hz, at a level, dB of full scale.
    fn noise((from, to): (f64, f64), dbfs: f64, seconds: u32, random: &mut Random) -> Vec<f64> {
        let white = white((seconds * RATE) as usize, random);
        let band = normalised(high_passed(low_passed(white, RATE.into(), to, 3), RATE.into(), from, 3));
        band.into_iter().map(|x| db_to_amplitude(dbfs) * x).collect()
    }

    #[test]
    fn rumble_far_below_the_noise_floor_rises_in_the_difference() {
        const WIND_DBFS: f64 = -78.0;
        const SECONDS: u32 = 8;
        const BEGINS_S: f64 = 6.0;
        let mut random = Random::new(SEED);
        // Ambient noise is the same at both capsules at low frequencies only; from the sixth second on each has its own turbulence.
        let ambient = noise((60.0, 200.0), -58.0, SECONDS, &mut random);
        let mut capsule = || {
            let (high, own) = (noise((1000.0, 3000.0), -60.0, SECONDS, &mut random), white(ambient.len(), &mut random));
            let wind = noise((40.0, 150.0), WIND_DBFS, SECONDS, &mut random);
            let own = own.iter().zip(&high).map(|(own, high)| db_to_amplitude(-105.0) * own + high);
            let blown = |(i, wind): (usize, &f64)| if i as f64 >= BEGINS_S * f64::from(RATE) { *wind } else { 0.0 };
            let wind = wind.iter().enumerate().map(blown);
            let sum = ambient.iter().zip(own).zip(wind).map(|((ambient, own), wind)| (ambient + own + wind) as f32);
            sum.collect::<Vec<_>>()
        };
        let (left, right) = (capsule(), capsule());
        let mut frontend = Frontend::new(RATE);
        let (mut before, mut after, mut sum) = (Vec::new(), Vec::new(), Vec::new());
        for (i, (left, right)) in left.iter().zip(&right).enumerate() {
            let t = i as f64 / f64::from(RATE);
            let breath = BreathState { blowing: t >= BEGINS_S, likely: false };
            let Some(frame) = frontend.push(*left, Some(*right), 0.0, breath) else { continue };
            let Some((_, levels)) = frame.difference else { continue };
            if t > BEGINS_S + 1.0 {
                after.push(levels.rise_db);
                sum.push(frame.levels.rise_db);
            } else if t > BEGINS_S - 2.0 && t < BEGINS_S {
                before.push(levels.rise_db);
            }
        }
        let mean = |x: &[f64]| x.iter().sum::<f64>() / x.len() as f64;
        let (before, after, sum) = (mean(&before), mean(&after), mean(&sum));
        assert!(before < 2.0, "it stands {before:.1} dB above its own noise floor");
        assert!(after > RISEN_DB + 3.0, "two capsules: {after:.1} dB");
        assert!(sum < RISEN_DB, "one capsule: {sum:.1} dB");
    }
}

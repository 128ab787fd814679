//! From raw samples to features: what the detector and its training share.

use super::capsules::Capsules;
use super::features::{COUNT, FALL, Features, Levels, Listener, QUIETEST, QUIETEST_DIFFERENCE, Still, decibels};
use super::nearness::{LOWER, Nearness};
use super::own::OwnVoice;
use super::pair::REGIONS;
use super::resample::Resampler;
use super::spectrum::{Framer, Sample};
use super::upper::Upper;

/// The room must have been heard for this long before anything can be a breath, s.
pub(super) const SETTLING_S: f64 = 0.25;
/// Lowest level that is told, dB of full scale.
pub(super) const SILENCE_DBFS: f64 = -120.0;
/// From this amplitude a sample counts as railed.
const RAIL: f32 = 0.999;
/// Frames for which a fault holds: the analysis window (6 frames) and the smoothing after it.
const FAULT_HOLD_FRAMES: u32 = 10;

/// Samples in, features out, a frame every 8 ms.
#[derive(Clone, Debug)]
pub struct FrontEnd {
    input: Input,
    /// What lies below 4 kHz. A half is large, and an ear is handed from work to work: it stays where it is.
    pub(super) lower: Box<Half>,
    pub(super) listener: Listener,
    /// Listens to what differs between two capsules.
    apart: Listener,
    pub(super) capsules: Capsules,
    pub(super) nearness: Nearness<REGIONS>,
    /// What two capsules hear above 4 kHz.
    above: Box<Half>,
    pub(super) upper: Box<Upper>,
    /// Samples of two capsules have come.
    stereo: bool,
}

/// What lies below 4 kHz, or above: in frames, with what of it the kiosk itself explains.
#[derive(Clone, Debug)]
pub(super) struct Half {
    left: Resampler,
    right: Resampler,
    played: Resampler,
    pub framer: Framer,
    pub own_voice: OwnVoice,
}

impl Half {
    fn new(resampler: Resampler) -> Self {
        let (left, right) = (resampler.clone(), resampler.clone());
        Self { left, right, played: resampler, framer: Framer::new(), own_voice: OwnVoice::new() }
    }

    /// Takes one sample of each capsule and of what was played; true where a new frame is ready.
    fn push(&mut self, left: f64, right: Option<f64>, played: f64) -> bool {
        let own = self.played.push(played);
        let left = self.left.push(left);
        let right = right.map_or(left, |x| self.right.push(x));
        let sample = || Some(Sample { left: left?, right: right?, own: own? });
        sample().is_some_and(|sample| self.framer.push(sample))
    }

    fn hear_itself(&mut self, learn: bool) {
        self.own_voice.push(&self.framer.microphone, &self.framer.own, learn);
    }
}

/// One frame, as it is judged.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    /// What the model weighs.
    pub features: Features,
    /// Beside them, what the decision needs.
    pub levels: Levels,
    /// Both, of what differs between two capsules.
    pub difference: Option<(Features, Levels)>,
    /// Level of the frame, dB of full scale.
    pub level_dbfs: f64,
    /// Samples are at the rails.
    pub clipping: bool,
    /// Samples are not finite, or were a moment ago.
    pub fault: bool,
    /// Every sample is exactly 0.
    pub zero: bool,
}

/// What the raw samples of the present frame say.
#[derive(Clone, Copy, Debug, Default)]
struct Input {
    count: u32,
    square: f64,
    railed: u32,
    faulty: bool,
    /// Frames for which a fault still holds: until the bad samples have left the analysis window.
    fault_hold: u32,
}

impl FrontEnd {
    /// A front end for samples at `sample_rate` Hz (8–192 kHz).
    pub fn new(sample_rate: u32) -> Self {
        Self {
            input: Input::default(),
            lower: Box::new(Half::new(Resampler::new(sample_rate))),
            listener: Listener::new(QUIETEST),
            apart: Listener::new(QUIETEST_DIFFERENCE),
            capsules: Capsules::new(),
            nearness: Nearness::new(LOWER),
            above: Box::new(Half::new(Resampler::upper(sample_rate))),
            upper: Box::new(Upper::new()),
            stereo: false,
        }
    }

    /// Takes one sample of each capsule and of what was played. While somebody is `blowing`, or while it is `likely`,
    /// the picture of the room stands still; while somebody is blowing, so does that of the kiosk's own sound.
    pub fn push(
        &mut self,
        left: f32,
        right: Option<f32>,
        played: f32,
        (blowing, likely): (bool, bool),
    ) -> Option<Frame> {
        let heard = self.input.push(left);
        let played = if played.is_finite() { f64::from(played.clamp(-1.0, 1.0)) } else { 0.0 };
        let second = right.map(|x| self.input.push(x));
        self.stereo |= second.is_some();
        let second = self.stereo.then(|| second.unwrap_or(heard));
        if second.is_some() {
            // Both halves come in step, from the same samples.
            self.above.push(heard, second, played);
        }
        self.lower.push(heard, second, played).then(|| self.frame(blowing, likely))
    }

    fn frame(&mut self, blowing: bool, likely: bool) -> Frame {
        let input = self.input.take();
        let fault = self.input.fault_hold > 0;
        let (mut features, mut levels, mut difference) = ([0.0; COUNT], Levels::default(), None);
        if !fault {
            self.lower.hear_itself(!blowing);
            let Half { framer, own_voice, .. } = &*self.lower;
            let covered = own_voice.masks(&framer.microphone);
            let room = blowing || likely || covered;
            let Framer { capsules, scale, microphone, peakedness, .. } = framer;
            let (own, still) = (&own_voice.predicted, Still { room, past: blowing });
            (features, levels) = self.listener.push(microphone, own, *peakedness, still);
            levels.covered = covered;
            if self.stereo {
                // Its room is learnt before two capsules are told apart, which may happen amid a puff.
                self.capsules.push(capsules, !(blowing || likely), *scale, microphone);
                let still = Still { room: blowing || likely, ..still };
                let left = self.capsules.left_of(own);
                let heard = self.apart.push(&self.capsules.difference, &left, *peakedness, still);
                self.capsules.note(heard.1.rise_db, 10.0 * heard.0[FALL[0]]);
                let told = self.capsules.share.is_some() && self.apart.age() >= SETTLING_S;
                difference = Some(heard).filter(|_| told);
                self.nearness.push(capsules, own, !(blowing || likely), *scale);
                self.above.hear_itself(!blowing);
                let Half { framer, own_voice, .. } = &*self.above;
                self.upper.push(framer, &own_voice.predicted, still, levels.middle_dbfs);
            }
        }
        Frame {
            features,
            levels,
            difference,
            level_dbfs: decibels(input.square / f64::from(input.count.max(1))).max(SILENCE_DBFS),
            clipping: input.railed > 1,
            fault,
            zero: input.square == 0.0,
        }
    }
}

impl Input {
    /// Notes one raw sample; returns what the analysis hears.
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

    /// The finished frame's tally; starts the next.
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
    use soffio_math::from_decibels;
    use soffio_math::noise::Random;

    const RATE: u32 = 8000;
    const SEED: u64 = 17;

    /// Noise between two frequencies, Hz, this loud, dB of full scale.
    fn noise((from, to): (f64, f64), dbfs: f64, seconds: u32, random: &mut Random) -> Vec<f64> {
        let white = white((seconds * RATE) as usize, random);
        let band = normalised(high_passed(low_passed(white, RATE.into(), to, 3), RATE.into(), from, 3));
        band.into_iter().map(|x| from_decibels(dbfs) * x).collect()
    }

    #[test]
    fn rumble_far_below_the_room_rises_out_of_what_differs() {
        const WIND_DBFS: f64 = -78.0;
        const SECONDS: u32 = 8;
        const BEGINS_S: f64 = 6.0;
        let mut random = Random::new(SEED);
        // A room that is the same at both, whose treble is not; eddies of their own from the sixth second on.
        let room = noise((60.0, 200.0), -58.0, SECONDS, &mut random);
        let mut capsule = || {
            let (treble, own) = (noise((1000.0, 3000.0), -60.0, SECONDS, &mut random), white(room.len(), &mut random));
            let wind = noise((40.0, 150.0), WIND_DBFS, SECONDS, &mut random);
            let own = own.iter().zip(&treble).map(|(own, treble)| from_decibels(-105.0) * own + treble);
            let blown = |(i, wind): (usize, &f64)| if i as f64 >= BEGINS_S * f64::from(RATE) { *wind } else { 0.0 };
            let wind = wind.iter().enumerate().map(blown);
            room.iter().zip(own).zip(wind).map(|((room, own), wind)| (room + own + wind) as f32).collect::<Vec<_>>()
        };
        let (left, right) = (capsule(), capsule());
        let mut front = FrontEnd::new(RATE);
        let (mut before, mut after, mut sum) = (Vec::new(), Vec::new(), Vec::new());
        for (i, (left, right)) in left.iter().zip(&right).enumerate() {
            let t = i as f64 / f64::from(RATE);
            let Some(frame) = front.push(*left, Some(*right), 0.0, (t >= BEGINS_S, false)) else { continue };
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
        assert!(before < 2.0, "it stands {before:.1} dB above its own room");
        assert!(after > RISEN_DB + 3.0, "two capsules: {after:.1} dB");
        assert!(sum < RISEN_DB, "one capsule: {sum:.1} dB");
    }
}

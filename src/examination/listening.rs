//! One take through one detector: the speed over time, and whether each breath was detected.

use soffio_soundscape::{BreathLabel, Take};

use crate::subject::Make;

/// Distance between two readings of the detector, s.
pub const BLOCK_S: f64 = 0.008;
/// Time after the end of the air in which a detection still counts, s.
const AFTER_S: f64 = 0.3;
/// Time before the flow at the lips at which the detector must be silent, s.
const BEFORE_S: f64 = 0.05;
/// Time after the end of a breath from which a new beginning is a false trigger, s.
const AFTERMATH_S: f64 = 0.5;
/// Speed of a clear breath at the capsule, m/s.
const CLEAR_M_S: f64 = 1.0;
/// Level of a clear breath over the room, dB.
const CLEAR_DB: f64 = 10.0;
/// Share of the peak speed down to which a breath must be tracked.
const TRACKED_SHARE: f64 = 0.25;
/// Least speed at the capsule that must be tracked, m/s.
const TRACKED_M_S: f64 = 0.35;

/// Is the breath clear?
pub fn is_clear(breath: &BreathLabel) -> bool {
    breath.peak_speed >= CLEAR_M_S && breath.level_db >= CLEAR_DB
}

/// Readings of a detector over a take.
#[derive(Clone, Debug)]
pub struct Readings {
    /// Speed after each block, m/s.
    pub speeds: Vec<f64>,
}

/// How a detector answered one breath.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Answer {
    /// It was detected.
    pub detected: bool,
    /// From the arrival of the air to the first speed, s; negative where the lips were heard before.
    pub delay: Option<f64>,
    /// Share of the time with at least 0.35 m/s, and a quarter of the peak, in which a speed was reported.
    pub tracked: f64,
}

impl Readings {
    /// Runs a new detector over a take.
    pub fn of(make: &Make<'_>, take: &Take) -> Self {
        let mut detector = make(take.sample_rate);
        let step = (BLOCK_S * f64::from(take.sample_rate)).round() as usize;
        let mut speeds = Vec::with_capacity(take.left.len() / step + 1);
        for start in (0..take.left.len()).step_by(step) {
            let end = (start + step).min(take.left.len());
            let played = if take.played.is_empty() { &[][..] } else { &take.played[start..end] };
            detector.push(&take.left[start..end], take.right.as_ref().map(|right| &right[start..end]), played);
            speeds.push(detector.speed());
        }
        Self { speeds }
    }

    /// Index of the reading at a time, s.
    fn at(&self, time: f64) -> usize {
        ((time / BLOCK_S).max(0.0) as usize).min(self.speeds.len().saturating_sub(1))
    }

    /// Readings and their times between two times, s.
    fn between(&self, from: f64, until: f64) -> impl Iterator<Item = (f64, f64)> + '_ {
        let (first, last) = (self.at(from), self.at(until));
        self.speeds[first..=last.max(first)]
            .iter()
            .enumerate()
            .map(move |(i, u)| ((first + i + 1) as f64 * BLOCK_S, *u))
    }

    /// Answer to a breath.
    pub fn answer(&self, breath: &BreathLabel) -> Answer {
        let silent = self.speeds[self.at(breath.lips - BEFORE_S)] == 0.0;
        let detected = silent && self.between(breath.arrival, breath.end + AFTER_S).any(|(_, u)| u > 0.0);
        let first = self.between(breath.lips, breath.end + AFTER_S).find(|(_, u)| *u > 0.0);
        let delay = first.filter(|_| detected).map(|(time, _)| time - breath.arrival);
        let least = TRACKED_M_S.max(TRACKED_SHARE * breath.peak_speed);
        let strong = self.between(breath.arrival, breath.end).filter(|(time, _)| breath.speed_at(*time) >= least);
        let (heard, all) =
            strong.fold((0_usize, 0_usize), |(heard, all), (_, u)| (heard + usize::from(u > 0.0), all + 1));
        Answer { detected, delay, tracked: heard as f64 / all.max(1) as f64 }
    }

    /// Pairs of local and reported speed in a breath, m/s.
    pub fn pairs<'a>(&'a self, breath: &'a BreathLabel) -> impl Iterator<Item = (f64, f64)> + 'a {
        self.between(breath.arrival, breath.end).map(|(time, u)| (breath.speed_at(time), u))
    }

    /// Number of times that a speed begins away from all breaths, after some seconds of learning.
    pub fn false_positives(&self, breaths: &[BreathLabel], learning_s: f64) -> usize {
        let begins = self.speeds.windows(2).enumerate().filter(|(_, pair)| pair[0] == 0.0 && pair[1] > 0.0);
        let times = begins.map(|(i, _)| (i + 1) as f64 * BLOCK_S);
        times
            .filter(|time| {
                let near = |b: &BreathLabel| b.lips - BEFORE_S < *time && *time < b.end + AFTERMATH_S;
                *time >= learning_s && !breaths.iter().any(near)
            })
            .count()
    }
}

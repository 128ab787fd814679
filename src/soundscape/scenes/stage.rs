//! A stage: rooms, draughts and breaths at the capsules, recorded by any microphone.

use soffio_math::noise::hash_words;

use super::R;
use crate::breath::Breath;
use crate::level::over_room;
use crate::microphone::{Microphone, pascals};
use crate::voices::add;
use crate::{BreathLabel, Event, RATE, Take};

/// Sound at one or two capsules, Pa at [`RATE`], the breaths apart from the rest.
#[derive(Clone, Debug)]
pub struct Stage {
    room: Vec<Vec<f64>>,
    air: Vec<Vec<f64>>,
    breaths: Vec<BreathLabel>,
    events: Vec<Event>,
    played: Vec<f32>,
}

impl Stage {
    /// A silent stage.
    pub fn new(seconds: f64, capsules: usize) -> Self {
        let silence = vec![vec![0.0; (seconds * R) as usize]; capsules];
        Self { room: silence.clone(), air: silence, breaths: Vec::new(), events: Vec::new(), played: Vec::new() }
    }

    /// Length, s.
    pub fn seconds(&self) -> f64 {
        self.room[0].len() as f64 / R
    }

    /// Adds a sound that is no breath, Pa at each capsule, from a time on, s.
    pub fn add_noise(&mut self, at: f64, sound: &[Vec<f64>], events: &[Event]) {
        self.room.iter_mut().zip(sound).for_each(|(out, sound)| add(out, at, sound, 1.0));
        self.events.extend(events.iter().map(|event| Event { at: event.at + at, until: event.until + at, ..*event }));
    }

    /// Adds a breath whose recipe begins at a time, s; its spacing must be 0 for one capsule.
    pub fn add_breath(&mut self, at: f64, breath: &Breath, seed: u64) {
        let air = breath.air(RATE, seed);
        self.air.iter_mut().zip(&air.pressure).for_each(|(out, sound)| add(out, at, sound, 1.0));
        self.breaths.push(breath.label(at, &air.speeds));
    }

    /// Sets what the kiosk plays, full scale ±1, and adds its echo, Pa.
    pub fn add_echo(&mut self, played: &[f64], echo: &[Vec<f64>]) {
        self.add_noise(0.0, echo, &[]);
        self.played = played.iter().map(|x| *x as f32).collect();
    }

    /// A take by a microphone. The second capsule differs a little from the first.
    pub fn recorded(&self, microphone: &Microphone, seed: u64) -> Take {
        let microphones = [*microphone, microphone.second(seed)];
        let mut channels =
            self.room.iter().zip(&self.air).zip(&microphones).enumerate().map(|(i, ((room, air), mic))| {
                let sum: Vec<f64> = room.iter().zip(air).map(|(r, a)| r + a).collect();
                mic.record(&sum, R, hash_words(&[seed, i as u64]))
            });
        let left = channels.next().unwrap_or_default();
        let right = channels.next();
        let mut played = self.played.clone();
        played.resize(if played.is_empty() { 0 } else { left.len() }, 0.0);
        Take { breaths: self.labelled(microphone), played, left, right, events: self.events.clone(), sample_rate: RATE }
    }

    /// Labels with levels over the room: at the better of two capsules.
    fn labelled(&self, microphone: &Microphone) -> Vec<BreathLabel> {
        if self.breaths.is_empty() {
            return Vec::new();
        }
        let passed = |sound: &Vec<f64>| microphone.high_passed(sound, R);
        let pairs: Vec<(Vec<f64>, Vec<f64>)> =
            self.room.iter().zip(&self.air).map(|(room, air)| (passed(room), passed(air))).collect();
        let level = |breath: &BreathLabel| {
            let [from, until] = [breath.arrival, breath.end + 0.05].map(|t| (t * R).max(0.0) as usize);
            let best = pairs.iter().map(|(room, air)| {
                let until = until.min(air.len());
                let from = from.min(until);
                // At least two windows of the room.
                let before = from.saturating_sub(4096);
                over_room(&air[from..until], &room[before..until], R, pascals(microphone.noise_db))
            });
            best.fold(f64::NEG_INFINITY, f64::max)
        };
        self.breaths.iter().map(|breath| BreathLabel { level_db: level(breath), ..breath.clone() }).collect()
    }
}

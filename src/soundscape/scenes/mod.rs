//! Scenes: a museum's sounds and breaths at one or two capsules, in pascals, and takes of them by a microphone.
//!
//! A [`Scenario`] is one group of speakers and rooms, drawn from a seed. It convolves dry sounds at places of a room with the room's
//! impulse response to each capsule. A [`Stage`] sums rooms, draughts, the kiosk's echo and breaths.

mod bystanders;
mod stage;

pub use bystanders::Noise;
pub use stage::Stage;

use soffio_math::noise::{Random, hash_words};

use super::filters::{normalised, parted};
use super::rooms::{ALIKE_HZ, Room, convolved};
use super::voices::{self, Voice, add};
use super::{Event, RATE, kiosk_sound, microphone::pascals, noises};

const R: f64 = RATE as f64;
/// Voices of a scenario.
const VOICES: usize = 12;
/// Length of each voice's speech before it repeats, s.
const SPEECH_S: f64 = 15.0;
/// Places in a room; the last is that of a visitor in front of the kiosk.
const PLACES: usize = 5;

/// One group of speakers in one room.
#[derive(Debug)]
pub struct Scenario {
    voices: Vec<(Voice, Vec<f64>)>,
    room: Room,
    responses: Vec<[Vec<f64>; 2]>,
}

/// Dry sounds by place, and their events; place [`PLACES`] is the table itself, without a room.
struct Dry {
    places: Vec<Vec<f64>>,
    events: Vec<Event>,
}

impl Dry {
    fn silent(seconds: f64) -> Self {
        Self { places: vec![vec![0.0; (seconds * R) as usize]; PLACES + 1], events: Vec::new() }
    }

    /// Adds a sound at a place, from a time on, s.
    fn put(&mut self, what: &'static str, place: usize, at: f64, sound: &[f64], gain: f64) {
        add(&mut self.places[place], at, sound, gain);
        let at = at.max(0.0);
        self.events.push(Event { at, until: at + sound.len() as f64 / R, what });
    }
}

impl Scenario {
    /// The scenario of a seed, in a random room.
    pub fn new(seed: u64) -> Self {
        let room = Room::random(&mut Random::new(hash_words(&[seed, 0x726f_6f6d])));
        Self::in_room(seed, room)
    }

    /// A scenario of a seed in a given room.
    pub fn in_room(seed: u64, room: Room) -> Self {
        let mut random = Random::new(hash_words(&[seed, 0x0076_6f69]));
        let speaker = |_| {
            let voice = Voice::random(&mut random);
            let voice = if random.unit() < 0.15 { voice.shouting() } else { voice };
            (voice, voices::speech(&voice, SPEECH_S, &mut random))
        };
        let voices = (0..VOICES).map(speaker).collect();
        let mut random = Random::new(hash_words(&[seed, 0x706c_6163]));
        let response = |place: usize| {
            let at = if place + 1 < PLACES {
                room.place(&mut random)
            } else {
                room.near(random.range(0.3, 1.0), &mut random)
            };
            let seed = random.word();
            [room.response(at, 0, seed), room.response(at, 1, seed)]
        };
        let responses = (0..PLACES).map(response).collect();
        Self { voices, room, responses }
    }

    /// Spacing of the two capsules, m.
    pub fn spacing(&self) -> f64 {
        self.room.spacing()
    }

    /// A random part of the speech of a random voice, of unit RMS.
    pub fn speech(&self, seconds: f64, random: &mut Random) -> Vec<f64> {
        let track = &self.voices[(random.unit() * VOICES as f64) as usize].1;
        let from = (random.unit() * track.len() as f64) as usize;
        track.iter().cycle().skip(from).take((seconds * R) as usize).copied().collect()
    }

    /// A random voice.
    pub fn voice(&self, random: &mut Random) -> Voice {
        self.voices[(random.unit() * VOICES as f64) as usize].0
    }

    /// Sound at each capsule of all dry sounds.
    fn heard(&self, dry: &Dry, capsules: usize) -> Vec<Vec<f64>> {
        let capsule = |capsule: usize| {
            let mut out = dry.places[PLACES].clone();
            for (sound, response) in dry.places.iter().zip(&self.responses) {
                if sound.iter().any(|x| *x != 0.0) {
                    let arrived = convolved(sound, &response[capsule]);
                    out.iter_mut().zip(&arrived).for_each(|(y, x)| *y += x);
                }
            }
            out
        };
        (0..capsules).map(capsule).collect()
    }

    /// A sound from right in front of the kiosk, at each of 1 or 2 capsules.
    pub fn before_the_kiosk(&self, sound: &[f64], capsules: usize) -> Vec<Vec<f64>> {
        self.responses[PLACES - 1][..capsules].iter().map(|response| convolved(sound, response)).collect()
    }

    /// Diffuse noise of ventilation and street at a level (dB of sound), at each capsule, Pa. It is the same at two capsules below
    /// some hundred hertz only.
    pub fn air_noise(&self, seconds: f64, level_db: f64, capsules: usize, random: &mut Random) -> Vec<Vec<f64>> {
        let air = noises::air(seconds, random);
        let other = |_| parted(air.clone(), noises::air(seconds, random), R, ALIKE_HZ);
        let others: Vec<Vec<f64>> = (1..capsules).map(other).collect();
        let scale = pascals(level_db);
        let scaled = |sound: Vec<f64>| sound.into_iter().map(|x| scale * x).collect();
        std::iter::once(air).chain(others).map(scaled).collect()
    }

    /// Echo of the kiosk's output (full scale ±1) at each capsule, Pa; a full-scale output has this level (dB of sound).
    pub fn echo(&self, played: &[f64], level_db: f64, capsules: usize, random: &mut Random) -> Vec<Vec<f64>> {
        // Delay of the sound card both ways.
        let late = random.range(0.02, 0.09) * R;
        let mut delayed = vec![0.0; late as usize];
        delayed.extend(kiosk_sound::speaker_response(played, random));
        delayed.truncate(played.len());
        let loud = pascals(level_db);
        delayed.iter_mut().for_each(|x| *x *= loud);
        self.before_the_kiosk(&delayed, capsules)
    }

    /// Output of the kiosk at full volume: wind, strikes, sentences; full scale ±1.
    pub fn kiosk_output(&self, seconds: f64, random: &mut Random) -> Vec<f64> {
        let speech = normalised(self.speech(seconds, random));
        kiosk_sound::kiosk(seconds, &speech, random)
    }
}

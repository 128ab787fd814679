//! Labelled scenes: breaths and other sounds in front of a microphone, drawn from a seed.
//!
//! A [`Scenario`] is one group of speakers and rooms. Training and validation use scenarios of different seeds, so they share no
//! voice, room or event. A scene sums dry sounds at places of a room, and convolves each place with the room's impulse response to
//! each capsule. It adds breath, bumps through the table, and the microphone: corner, noise, gain, clipping.

mod breaths;
mod bystanders;
mod lips;

use soffio_detector::generate::filter::{high_passed, low_passed, normalised, parted, power, white};
use soffio_math::noise::{Random, hash_words};
use soffio_math::{db_to_amplitude, exp, tanh};

use super::rooms::{ALIKE_HZ, Room, convolved};
use super::voices::{self, Voice, add};
use super::{Breath, Event, Kind, RATE, Take, kiosk_sound, noises};
pub use lips::Lips;

const R: f64 = RATE as f64;
/// Voices of a scenario, and the length of each one's speech before it repeats, s.
const VOICES: usize = 20;
const SPEECH_S: f64 = 15.0;
/// Rooms of a scenario, and places in each.
const ROOMS: usize = 8;
const PLACES: usize = 5;
/// Largest differences of two capsules of a kind: sensitivity, dB; high-pass corner, relative.
pub const UNLIKE: (f64, f64) = (1.5, 0.1);

/// Condition of a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Condition {
    /// A minute of museum without breath.
    Museum,
    /// Pops, thumps, claps, doors, bumps in a quiet room.
    Impulses,
    /// Sounds most like breath, one after another: thunder, doors, hands on the table, coughs, fans.
    Alike,
    /// Breath in a quiet room, of any strength, distance and angle.
    Isolated,
    /// Breath in a quiet room from a distance (m) and an angle (degrees), of a child (true) or an adult.
    Cell(f64, f64, bool),
    /// Breath straight at the microphone in a museum, at a signal-to-noise ratio, dB.
    Noisy(f64),
    /// Off-axis breath in a museum, at a signal-to-noise ratio of the hiss, dB.
    Aside(f64),
    /// Off-axis breath in a museum with two capsules, at a signal-to-noise ratio of the rumble of their difference, dB. Often nothing else
    /// of it can be detected.
    Between(f64),
    /// Breath at the microphone right after the visitor has talked there; a companion may continue.
    Spoken,
    /// Breath of a visitor in a group, whose companions talk and laugh in front of the kiosk all the time.
    Companions,
    /// The kiosk's own sound at full volume in one of three rooms, without breath.
    KioskSound(u32),
    /// The same, with talk right in front of it.
    TalkedOver(u32),
    /// Breath straight at the microphone with the kiosk's response, in one of three rooms.
    Answered(u32),
}

/// Recording conditions of a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hearing {
    /// Additional gain of the microphone, dB.
    pub gain_db: f64,
    /// Two capsules a few centimetres apart.
    pub stereo: bool,
}

/// One group of speakers, rooms and recordings.
#[derive(Debug)]
pub struct Scenario {
    seed: u64,
    voices: Vec<(Voice, Vec<f64>)>,
    rooms: Vec<(Room, Vec<[Vec<f64>; 2]>)>,
    /// Recorded noises, dry, of unit RMS.
    recorded: Vec<Vec<f64>>,
}

/// Dry sounds by place, and their events; place [`PLACES`] is the table itself, without a room.
struct Dry {
    places: Vec<Vec<f64>>,
    /// Difference of the second capsule from the first, for turbulence.
    beside: Vec<f64>,
    events: Vec<Event>,
}

impl Dry {
    fn silent(samples: usize) -> Self {
        let silence = vec![0.0; samples];
        Self { places: vec![silence.clone(); PLACES + 1], beside: silence, events: Vec::new() }
    }

    fn samples(&self) -> usize {
        self.places[0].len()
    }

    /// Adds a sound at a place, from a time on, s.
    fn put(&mut self, what: &'static str, place: usize, at: f64, sound: &[f64], gain: f64) {
        add(&mut self.places[place], at, sound, gain);
        let at = at.max(0.0);
        self.events.push(Event { at, until: at + sound.len() as f64 / R, what, on_table: place == PLACES, gain });
    }

    /// Adds puffs at both capsules.
    fn put_puffs(&mut self, at: f64, [first, second]: &[Vec<f64>; 2], gain: f64) {
        self.put("puffs", PLACES, at, first, gain);
        add(&mut self.beside, at, second, gain);
        add(&mut self.beside, at, first, -gain);
    }
}

impl Scenario {
    /// The scenario of a seed.
    pub fn new(seed: u64) -> Self {
        let mut random = Random::new(hash_words(&[seed, 0x0076_6f69]));
        let voices = Self::speakers(&mut random);
        let rooms = (0..ROOMS).map(|_| Self::heard_in(Room::random(&mut random), &mut random)).collect();
        Self { seed, voices, rooms, recorded: Vec::new() }
    }

    /// A scenario of a seed with a single room.
    pub fn in_room(seed: u64, room: Room) -> Self {
        let mut random = Random::new(hash_words(&[seed, 0x0076_6f69]));
        let voices = Self::speakers(&mut random);
        let rooms = vec![Self::heard_in(room, &mut random)];
        Self { seed, voices, rooms, recorded: Vec::new() }
    }

    fn speakers(random: &mut Random) -> Vec<(Voice, Vec<f64>)> {
        let speaker = |_| {
            let voice = Voice::random(random);
            let voice = if random.unit() < 0.15 { voice.shouting() } else { voice };
            (voice, voices::speech(&voice, SPEECH_S, random))
        };
        (0..VOICES).map(speaker).collect()
    }

    /// A room with its responses from several places; the last place is that of a visitor in front of the kiosk.
    fn heard_in(room: Room, random: &mut Random) -> (Room, Vec<[Vec<f64>; 2]>) {
        let response = |place: usize| {
            let at = if place + 1 < PLACES { room.place(random) } else { room.near(random.range(0.3, 1.0), random) };
            let seed = random.word();
            [room.response(at, 0, seed), room.response(at, 1, seed)]
        };
        let responses = (0..PLACES).map(response).collect();
        (room, responses)
    }

    /// Adds recorded noises, which then occur in scenes of museums.
    pub fn with_recordings<'a>(mut self, takes: impl IntoIterator<Item = &'a Take>) -> Self {
        let noises = takes.into_iter().filter(|take| take.kind == Kind::Noise && take.duration() > 2.0);
        self.recorded.extend(
            noises
                .map(|take| resampled(&take.left, take.sample_rate))
                .filter(|sound| power(sound) > 0.0)
                .map(normalised),
        );
        self
    }

    /// One scene of a condition; the same index gives the same scene.
    pub fn take(&self, condition: Condition, index: u64, hearing: Hearing) -> Take {
        let mut random = Random::new(hash_words(&[self.seed, condition.number(), index]));
        match condition {
            Condition::Museum => self.museum(index, hearing, &mut random),
            Condition::Impulses => self.impulses(index, hearing, &mut random),
            Condition::Alike => self.alike(index, hearing, &mut random),
            Condition::Isolated => {
                let child = random.unit() < 0.4;
                let angle = if random.unit() < 0.5 { random.range(0.0, 12.0) } else { random.range(12.0, 60.0) };
                let far = (random.range(0.05_f64, 0.6), random.range(0.05, 0.6));
                self.blow(condition, index, (far.0.min(far.1), angle, child), hearing, &mut random)
            }
            Condition::Cell(distance, angle, child) => {
                self.blow(condition, index, (distance, angle, child), hearing, &mut random)
            }
            Condition::Noisy(_) | Condition::Answered(_) | Condition::Spoken => {
                let child = random.unit() < 0.4;
                let mouth = (random.range(0.05, 0.3), random.range(0.0, 12.0), child);
                self.blow(condition, index, mouth, hearing, &mut random)
            }
            Condition::Aside(_) | Condition::Between(_) | Condition::Companions => {
                let child = random.unit() < 0.4;
                let mouth = (random.range(0.1, 0.45), random.range(20.0, 60.0), child);
                self.blow(condition, index, mouth, hearing, &mut random)
            }
            Condition::KioskSound(room) | Condition::TalkedOver(room) => {
                self.kiosk_sound(condition, index, room, hearing, &mut random)
            }
        }
    }

    /// Spacing of the two capsules in the first room, m.
    pub fn spacing(&self) -> f64 {
        self.rooms.first().map_or(0.0, |(room, _)| room.spacing())
    }

    /// A random part of the speech of a random voice.
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
    fn heard(&self, dry: &Dry, stereo: bool, random: &mut Random) -> Vec<Vec<f64>> {
        let (_, responses) = &self.rooms[(random.unit() * self.rooms.len() as f64) as usize];
        let capsule = |capsule: usize| {
            let mut out = dry.places[PLACES].clone();
            if capsule > 0 {
                out.iter_mut().zip(&dry.beside).for_each(|(y, x)| *y += x);
            }
            for (sound, response) in dry.places.iter().zip(responses) {
                if sound.iter().any(|x| *x != 0.0) {
                    let arrived = convolved(sound, &response[capsule]);
                    out.iter_mut().zip(&arrived).for_each(|(y, x)| *y += x);
                }
            }
            out
        };
        (0..1 + usize::from(stereo)).map(capsule).collect()
    }

    /// Adds ambient air noise at a level, dB of full scale. It is diffuse: the same at two capsules below some hundred hertz only.
    fn add_air(channels: &mut [Vec<f64>], dbfs: f64, random: &mut Random) {
        let seconds = channels[0].len() as f64 / R;
        let air = noises::air(seconds + 0.001, random);
        add(&mut channels[0], 0.0, &air, db_to_amplitude(dbfs));
        if let Some(second) = channels.get_mut(1) {
            let other = noises::air(seconds + 0.001, &mut Random::new(hash_words(&[air[0].to_bits(), 2])));
            add(second, 0.0, &parted(air, other, R, ALIKE_HZ), db_to_amplitude(dbfs));
        }
    }

    /// Adds the echo of the kiosk's output in a room, with a gain, dB.
    fn add_echo(&self, played: &[f64], (room, loud): (u32, f64), channels: &mut [Vec<f64>], random: &mut Random) {
        let (_, responses) = &self.rooms[room as usize % self.rooms.len()];
        // Delay of the sound card both ways; loudspeaker and microphone both stand at the kiosk.
        let late = (0.02 + 0.035 * f64::from(room)) * R;
        let mut delayed = vec![0.0; late as usize];
        delayed.extend(kiosk_sound::speaker_response(played, random));
        delayed.truncate(played.len());
        let loud = db_to_amplitude(loud);
        for (channel, response) in channels.iter_mut().zip(&responses[PLACES - 1]) {
            channel.iter_mut().zip(convolved(&delayed, response)).for_each(|(y, x)| *y += loud * x);
        }
    }

    fn kiosk_sound(&self, condition: Condition, index: u64, room: u32, hearing: Hearing, random: &mut Random) -> Take {
        let seconds = 60.0;
        let played = kiosk_sound::kiosk(seconds, &self.speech(seconds, random), random);
        let mut channels = vec![vec![0.0; played.len()]; 1 + usize::from(hearing.stereo)];
        let mut events = Vec::new();
        if let Condition::TalkedOver(_) = condition {
            let dry = self.talk_on(seconds, random);
            channels = self.heard(&dry, hearing.stereo, random);
            channels.iter_mut().for_each(|channel| channel.resize(played.len(), 0.0));
            events = dry.events;
        }
        let loud = random.range(-8.0, 4.0);
        self.add_echo(&played, (room, loud), &mut channels, random);
        Self::add_air(&mut channels, random.range(-72.0, -50.0), random);
        let take = self.finish(condition, index, channels, Kind::Noise, Vec::new(), hearing, random);
        Take { events, played: played.iter().map(|x| *x as f32).collect(), ..take }
    }

    /// Passes the sound through the microphone: corner, noise, gain and clipping.
    #[allow(clippy::too_many_arguments)] // one call per kind of scene, all of it different
    fn finish(
        &self,
        condition: Condition,
        index: u64,
        channels: Vec<Vec<f64>>,
        kind: Kind,
        breaths: Vec<Breath>,
        hearing: Hearing,
        random: &mut Random,
    ) -> Take {
        let corner = [20.0, 40.0, 60.0, 80.0, 110.0][(random.unit() * 5.0) as usize];
        let gain = db_to_amplitude(hearing.gain_db + random.range(-6.0, 6.0));
        let (soft, hiss) = (random.unit() < 0.6, db_to_amplitude(random.range(-86.0, -66.0)));
        // Two capsules never match exactly.
        let mut unlike = Random::new(hash_words(&[self.seed, condition.number(), index, 2]));
        let mut heard = channels.into_iter().enumerate().map(|(capsule, channel)| {
            let noise = white(channel.len(), random);
            let (louder, higher) = match capsule {
                0 => (1.0, 1.0),
                _ => (db_to_amplitude(unlike.range(-UNLIKE.0, UNLIKE.0)), 1.0 + unlike.range(-UNLIKE.1, UNLIKE.1)),
            };
            let heard = high_passed(channel, R, higher * corner, 2);
            let (gain, rail) = (louder * gain, |x: f64| if soft { tanh(x) } else { x.clamp(-1.0, 1.0) });
            heard.iter().zip(&noise).map(|(x, n)| rail(gain * (x + hiss * n)) as f32).collect::<Vec<f32>>()
        });
        let left = heard.next().unwrap_or_default();
        Take {
            name: format!("{condition:?} {index}"),
            group: format!("world {}", self.seed),
            label: format!("{condition:?}"),
            kind,
            breaths,
            level: None,
            right: heard.next(),
            left,
            played: Vec::new(),
            events: Vec::new(),
            sample_rate: RATE,
        }
    }
}

/// A recording at [`RATE`], by linear interpolation after a low-pass: accurate enough for noise.
pub fn resampled(samples: &[f32], sample_rate: u32) -> Vec<f64> {
    let from = f64::from(sample_rate);
    let samples: Vec<f64> = samples.iter().map(|x| f64::from(*x)).collect();
    let samples = if from > R { low_passed(samples, from, 0.4 * R, 2) } else { samples };
    let at = |i: usize| {
        let t = i as f64 * from / R;
        let (i, part) = (t as usize, t.fract());
        samples[i] + part * (samples.get(i + 1).copied().unwrap_or(0.0) - samples[i])
    };
    (0..(samples.len() as f64 * R / from) as usize).map(at).collect()
}

impl Condition {
    /// Number of the condition, for seeds.
    fn number(self) -> u64 {
        match self {
            Self::Museum => 1,
            Self::Impulses => 2,
            Self::Isolated => 3,
            Self::Cell(distance, angle, child) => {
                hash_words(&[4, distance.to_bits(), angle.to_bits(), u64::from(child)])
            }
            Self::Noisy(snr) => hash_words(&[5, snr.to_bits()]),
            Self::Aside(snr) => hash_words(&[7, snr.to_bits()]),
            Self::Between(snr) => hash_words(&[9, snr.to_bits()]),
            Self::Alike => 6,
            Self::Spoken => 8,
            Self::Companions => 10,
            Self::KioskSound(room) => 100 + u64::from(room),
            Self::TalkedOver(room) => 300 + u64::from(room),
            Self::Answered(room) => 200 + u64::from(room),
        }
    }
}

/// A take after automatic gain control in the microphone: the gain follows an average power, fast down and slow up.
pub fn with_gain_control(take: &Take) -> Take {
    let (down, up) = (exp(-1.0 / (0.015 * R)), exp(-1.0 / (0.5 * R)));
    let mut followed = 1e-4;
    let mut controlled = |x: &f32| {
        let square = f64::from(x * x);
        let keep = if square > followed { down } else { up };
        followed = keep * followed + (1.0 - keep) * square;
        (f64::from(*x) * (0.18 / (followed + 1e-9).sqrt()).min(8.0)).clamp(-1.0, 1.0) as f32
    };
    Take { left: take.left.iter().map(&mut controlled).collect(), ..take.clone() }
}

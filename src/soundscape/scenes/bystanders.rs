//! Noises of a museum, in pascals at the capsules: one kind at a time, or a crowd's mixture.
//!
//! Levels are those at the microphone. Normal, loud and shouted speech have 62, 75 and 82 dB at a metre (ANSI S3.5-1997); museums have
//! 50 to 70 dB(A) (Carvalho, Gonçalves and Garcia 2013).

use soffio_math::noise::Random;

use super::{Dry, PLACES, R, Scenario};
use crate::Event;
use crate::breath::{Breath, Manner, Person};
use crate::filters::{normalised, peaked};
use crate::microphone::pascals;
use crate::{RATE, noises, voices};

/// Kind of noise.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Noise {
    /// Ventilation, street.
    Air,
    /// Talk of many people in the room.
    Crowd,
    /// Children who shout and laugh.
    Children,
    /// Talk in front of the kiosk, at half a metre.
    Talk,
    /// Talk into the microphone from 5 to 25 cm: its plosives reach the capsule as puffs of air.
    Plosives,
    /// Steps.
    Steps,
    /// Doors, chairs, dropped things, applause, thunder.
    Knocks,
    /// Hands on the kiosk and its microphone.
    Handling,
    /// Music, whistles, telephones.
    Music,
    /// Motors, trolleys, trains, rain.
    Machines,
    /// Vacuum cleaners and hand dryers.
    Blowers,
}

impl Noise {
    /// All kinds.
    pub const ALL: [Self; 11] = [
        Self::Air,
        Self::Crowd,
        Self::Children,
        Self::Talk,
        Self::Plosives,
        Self::Steps,
        Self::Knocks,
        Self::Handling,
        Self::Music,
        Self::Machines,
        Self::Blowers,
    ];

    /// Name for tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Air => "ventilation",
            Self::Crowd => "crowd",
            Self::Children => "children",
            Self::Talk => "talk at the kiosk",
            Self::Plosives => "talk into the microphone",
            Self::Steps => "steps",
            Self::Knocks => "doors and knocks",
            Self::Handling => "handling",
            Self::Music => "music and tones",
            Self::Machines => "machines and rain",
            Self::Blowers => "vacuum cleaner, hand dryer",
        }
    }
}

fn place(random: &mut Random) -> usize {
    (random.unit() * PLACES as f64) as usize
}

fn level(low_db: f64, high_db: f64, random: &mut Random) -> f64 {
    pascals(random.range(low_db, high_db))
}

impl Scenario {
    /// Noise of one kind at each of 1 or 2 capsules, Pa, and its events.
    pub fn noise(
        &self,
        kind: Noise,
        seconds: f64,
        capsules: usize,
        random: &mut Random,
    ) -> (Vec<Vec<f64>>, Vec<Event>) {
        let mut dry = Dry::silent(seconds);
        let mut at = random.range(0.3, 2.0);
        match kind {
            Noise::Air => {
                let loud = random.range(35.0, 68.0);
                return (self.air_noise(seconds, loud, capsules, random), Vec::new());
            }
            Noise::Crowd => self.put_crowd(&mut dry, seconds, random),
            _ => {
                while at < seconds - 1.0 {
                    let length = self.put_one(kind, &mut dry, at, seconds, random);
                    at += length + random.range(0.3, 4.0);
                }
            }
        }
        let mut heard = self.heard(&dry, capsules);
        if kind == Noise::Plosives {
            self.add_plosives(&mut heard, &dry.events, random);
        }
        (heard, dry.events)
    }

    fn put_crowd(&self, dry: &mut Dry, seconds: f64, random: &mut Random) {
        let loud = random.range(45.0, 68.0);
        for _ in 0..random.range(3.0, 14.0) as u32 {
            let gain = pascals(loud + random.range(-8.0, 3.0));
            dry.put("talk", place(random), 0.0, &self.speech(seconds, random), gain);
        }
    }

    /// Puts one sound of a kind at a time, s; returns its length, s.
    fn put_one(&self, kind: Noise, dry: &mut Dry, at: f64, seconds: f64, random: &mut Random) -> f64 {
        let voice = self.voice(random);
        let long = random.range(3.0, 25.0).min(seconds - at);
        let (what, sound, gain, where_) = match kind {
            Noise::Children => {
                let sound = if random.unit() < 0.4 {
                    voices::laughter(&voice, random)
                } else {
                    voices::speech(&voice.shouting(), random.range(0.3, 2.5), random)
                };
                ("children", normalised(sound), level(62.0, 92.0, random), place(random))
            }
            Noise::Talk => {
                ("talk at the kiosk", self.speech(long.min(12.0), random), level(60.0, 86.0, random), PLACES - 1)
            }
            Noise::Plosives => {
                ("talk into the microphone", self.speech(long.min(12.0), random), level(74.0, 98.0, random), PLACES - 1)
            }
            Noise::Steps => {
                let sound = noises::footsteps(long.min(8.0), random);
                ("steps", sound, level(62.0, 90.0, random), place(random))
            }
            Noise::Handling => {
                let sound = if random.unit() < 0.4 { noises::bump(random) } else { noises::handling(random) };
                ("handling", sound, level(80.0, 118.0, random), PLACES)
            }
            Noise::Music => {
                let (what, sound) = if random.unit() < 0.5 {
                    ("music", noises::music(long, random))
                } else {
                    ("tone", voices::tone(random.range(0.1, 2.0), random))
                };
                (what, normalised(sound), level(50.0, 82.0, random), place(random))
            }
            Noise::Machines => {
                let (what, sound) = match (random.unit() * 5.0) as u32 {
                    0 => ("trolley", noises::trolley(long, random)),
                    1 => ("train", noises::train(long, random)),
                    2 => ("rain", noises::rain(long, random)),
                    3 => ("ventilation", noises::switched_air(long, random)),
                    _ => ("machine", noises::machine(long, random)),
                };
                (what, normalised(sound), level(48.0, 80.0, random), place(random))
            }
            Noise::Blowers => ("blower", noises::blower(long, random), level(60.0, 86.0, random), place(random)),
            _ => {
                let (what, sound) = match (random.unit() * 7.0) as u32 {
                    0 => ("door", noises::door(random)),
                    1 => ("scrape", noises::scrape(random)),
                    2 => ("drop", noises::drop(random)),
                    3 => ("thunder", noises::thunder(random)),
                    4 => ("cough", voices::cough(&voice, random)),
                    5 => ("clap", noises::clap(random.range(600.0, 2400.0), random)),
                    _ => ("applause", noises::applause(random.range(0.2, 5.0), random)),
                };
                (what, peaked(sound), level(70.0, 108.0, random), place(random))
            }
        };
        dry.put(what, where_, at, &sound, gain);
        sound.len() as f64 / R
    }

    /// Adds a puff of air for each plosive of talk into the microphone: 20 to 60 ms, 3 to 9 m/s at the lips.
    fn add_plosives(&self, heard: &mut [Vec<f64>], events: &[Event], random: &mut Random) {
        let spacing = if heard.len() > 1 { self.spacing() } else { 0.0 };
        for event in events {
            let (near, far) = (0.05, random.range(0.06, 0.25));
            let speaker = Breath::random(Manner::Puff, Person::Adult, (near, far), random);
            let mut at = event.at + random.range(0.0, 0.8);
            while at < event.until - 0.1 {
                let length = random.range(0.02, 0.06);
                let puff = Breath {
                    speed: random.range(3.0, 9.0),
                    attack: 0.3 * length,
                    hold: 0.2 * length,
                    release: 0.5 * length,
                    lead_out: 0.3,
                    angle_deg: random.range(0.0, 25.0),
                    hiss_db: -6.0,
                    spacing,
                    ..speaker
                };
                let air = puff.air(RATE, random.word());
                heard.iter_mut().zip(&air.pressure).for_each(|(out, p)| voices::add(out, at, p, 1.0));
                at += random.range(0.3, 2.0);
            }
        }
    }

    /// A museum's mixture at each of 1 or 2 capsules, Pa; `busy` (0 to about 2) scales the number of sounds.
    pub fn crowd(&self, seconds: f64, busy: f64, capsules: usize, random: &mut Random) -> (Vec<Vec<f64>>, Vec<Event>) {
        let mut dry = Dry::silent(seconds);
        if random.unit() < 0.7 * busy {
            self.put_crowd(&mut dry, seconds, random);
        }
        let mixture: &[(Noise, f64)] = &[
            (Noise::Children, 1.5),
            (Noise::Talk, 1.0),
            (Noise::Steps, 2.0),
            (Noise::Knocks, 2.5),
            (Noise::Handling, 0.5),
            (Noise::Music, 0.7),
            (Noise::Machines, 0.8),
            (Noise::Blowers, 0.2),
        ];
        for (kind, a_minute) in mixture {
            let count = (a_minute * busy * seconds / 60.0 + random.unit()) as u32;
            for _ in 0..count {
                let at = random.range(0.0, (seconds - 1.0).max(0.1));
                self.put_one(*kind, &mut dry, at, seconds, random);
            }
        }
        (self.heard(&dry, capsules), dry.events)
    }
}

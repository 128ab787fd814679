//! Scenes without breath, and the noises around a breath: a museum, a crowd, knocks, and the sounds most like breath.

use soffio_detector::generate::filter::{normalised, peaked};
use soffio_math::db_to_amplitude;
use soffio_math::noise::Random;

use super::super::rooms::convolved;
use super::super::voices;
use super::super::{Kind, Take, noises};
use super::{Condition, Dry, Hearing, PLACES, R, Scenario};

impl Scenario {
    /// Sustained and sudden sounds of a museum; `busy` scales their number.
    pub(super) fn museum_sounds(&self, seconds: f64, busy: f64, random: &mut Random) -> Dry {
        let mut dry = Dry::silent((seconds * R) as usize);
        let place = |random: &mut Random| (random.unit() * PLACES as f64) as usize;
        let decibel = |random: &mut Random, low: f64, high: f64| db_to_amplitude(random.range(low, high));
        if random.unit() < 0.6 * busy {
            let loud = random.range(-62.0, -24.0);
            for _ in 0..random.range(1.0, 14.0) as u32 {
                let at = place(random);
                let gain = db_to_amplitude(loud + random.range(-8.0, 3.0));
                dry.put("talk", at, 0.0, &self.speech(seconds, random), gain);
            }
        }
        if random.unit() < 0.25 * busy {
            // Talk right in front of the kiosk.
            let gain = decibel(random, -40.0, -12.0);
            let from = random.range(0.0, 0.3 * seconds);
            dry.put("talk at the kiosk", PLACES - 1, from, &self.speech(0.6 * seconds, random), gain);
            if random.unit() < 0.5 {
                let puffs = voices::plosives(0.6 * seconds, random);
                let from = random.range(0.0, 0.3 * seconds);
                dry.put_puffs(from, &puffs, decibel(random, -30.0, -6.0));
            }
        }
        if !self.recorded.is_empty() && random.unit() < 0.35 * busy {
            let track = &self.recorded[(random.unit() * self.recorded.len() as f64) as usize];
            let (at, gain) = (place(random), decibel(random, -50.0, -16.0));
            let (from, length) = (random.unit() * track.len() as f64, dry.samples() as f64 * random.range(0.3, 1.5));
            let sound: Vec<f64> = track.iter().cycle().skip(from as usize).take(length as usize).copied().collect();
            let at = if random.unit() < 0.5 { PLACES } else { at };
            dry.put("a recording", at, random.range(-0.2, 0.5) * seconds, &sound, gain);
        }
        let lasting = (random.unit() * 2.5 * busy * seconds / 60.0 + random.unit()) as u32;
        for _ in 0..lasting {
            let length = random.range(3.0, 25.0).min(seconds);
            let (what, sound) = match (random.unit() * 8.0) as u32 {
                0 => ("trolley", noises::trolley(length, random)),
                1 => ("train", noises::train(length, random)),
                2 => ("machine", noises::machine(length, random)),
                3 => ("ventilation", noises::switched_air(length, random)),
                4 => ("rain", noises::rain(length, random)),
                5 => ("steps", noises::footsteps(length, random)),
                6 => ("applause", noises::applause(length.min(8.0), random)),
                _ => ("music", noises::music(length, random)),
            };
            let (at, when) = (place(random), random.range(-0.2, 1.0) * (seconds - 1.0));
            dry.put(what, at, when, &normalised(sound), decibel(random, -58.0, -16.0));
        }
        let sudden = (random.range(0.0, 10.0) * busy * seconds / 60.0 + random.unit()) as u32;
        for _ in 0..sudden {
            let voice = self.voice(random);
            let (what, sound) = match (random.unit() * 12.0) as u32 {
                0 => ("laughter", voices::laughter(&voice, random)),
                1 => ("cough", voices::cough(&voice, random)),
                2 => ("shout", voices::speech(&voice.shouting(), random.range(0.3, 2.5), random)),
                3 => ("door", noises::door(random)),
                4 => ("scrape", noises::scrape(random)),
                5 => ("drop", noises::drop(random)),
                6 => ("thunder", noises::thunder(random)),
                7 => ("steps", noises::footsteps(random.range(0.5, 3.0), random)),
                8 => ("handling", noises::handling(random)),
                9 => ("tone", voices::tone(random.range(0.1, 2.0), random)),
                10 => ("applause", noises::applause(random.range(0.2, 3.0), random)),
                _ => ("bump", noises::bump(random)),
            };
            let table = random.unit() < 0.15;
            let at = if table { PLACES } else { place(random) };
            let when = random.range(0.0, seconds);
            dry.put(what, at, when, &peaked(sound), decibel(random, -42.0, -2.0));
        }
        dry
    }

    /// A steady noise: a full hall, a machine, rain, a recording.
    pub(super) fn throng(&self, seconds: f64, random: &mut Random) -> Dry {
        let mut dry = Dry::silent((seconds * R) as usize);
        let place = |random: &mut Random| (random.unit() * PLACES as f64) as usize;
        if !self.recorded.is_empty() && random.unit() < 0.5 {
            let track = &self.recorded[(random.unit() * self.recorded.len() as f64) as usize];
            let from = (random.unit() * track.len() as f64) as usize;
            let sound: Vec<f64> = track.iter().cycle().skip(from).take(dry.samples()).copied().collect();
            let at = if random.unit() < 0.7 { PLACES } else { place(random) };
            dry.put("a recording", at, 0.0, &sound, 0.1);
            return dry;
        }
        if random.unit() < 0.7 {
            for _ in 0..random.range(5.0, 25.0) as u32 {
                let (at, gain) = (place(random), db_to_amplitude(random.range(-8.0, 3.0)));
                dry.put("throng", at, 0.0, &self.speech(seconds, random), gain * 0.03);
            }
        }
        let (what, even) = match (random.unit() * 4.0) as u32 {
            0 => ("rain", noises::rain(seconds, random)),
            1 => ("music", noises::music(seconds, random)),
            2 => ("machine", noises::machine(seconds, random)),
            _ => ("air", noises::air(seconds, random)),
        };
        let (at, gain) = (place(random), db_to_amplitude(random.range(-45.0, -15.0)));
        dry.put(what, at, 0.0, &even, gain);
        dry
    }

    /// Talk at the kiosk that stops shortly before a breath at `onset` (s); a companion may talk all the time.
    pub(super) fn talk_before(&self, onset: f64, seconds: f64, random: &mut Random) -> Dry {
        let mut dry = Dry::silent((seconds * R) as usize);
        let until = (onset - random.range(0.1, 3.0)).max(0.3);
        let from = (until - random.range(0.8, 6.0)).max(0.0);
        let loud = random.range(-45.0, -8.0);
        let words = self.speech(until - from, random);
        dry.put("talk at the kiosk", PLACES - 1, from, &words, db_to_amplitude(loud));
        if random.unit() < 0.3 {
            dry.put_puffs(
                from,
                &voices::plosives(until - from, random),
                db_to_amplitude(loud + random.range(0.0, 6.0)),
            );
        }
        if random.unit() < 0.3 {
            let (at, gain) =
                ((random.unit() * PLACES as f64) as usize, db_to_amplitude(loud - random.range(6.0, 30.0)));
            dry.put("a companion's talk", at, 0.0, &self.speech(seconds, random), gain);
        }
        dry
    }

    /// Companions of the visitor who blows: they talk and laugh in front of the kiosk all the time, in a museum that may be empty.
    pub(super) fn companions(&self, seconds: f64, random: &mut Random) -> Dry {
        let busy = if random.unit() < 0.5 { random.range(0.2, 2.0) } else { 0.0 };
        let mut dry = self.museum_sounds(seconds, busy, random);
        let loud = random.range(-62.0, -30.0);
        for _ in 0..random.range(2.0, 5.0) as u32 {
            let gain = db_to_amplitude(loud + random.range(-9.0, 9.0));
            dry.put("a companion's talk", PLACES - 1, 0.0, &self.speech(seconds, random), gain);
        }
        let laughter = normalised(voices::laughter(&self.voice(random), random));
        let gain = db_to_amplitude(loud + random.range(0.0, 15.0));
        dry.put("a companion's laughter", PLACES - 1, random.range(0.0, seconds), &laughter, gain);
        dry
    }

    /// Talk right in front of the kiosk, sometimes into its microphone.
    pub(super) fn talk_on(&self, seconds: f64, random: &mut Random) -> Dry {
        let mut dry = Dry::silent((seconds * R) as usize);
        let mut at = random.range(0.3, 6.0);
        while at < seconds - 1.0 {
            let (length, loud) = (random.range(0.8, 12.0).min(seconds - at), random.range(-45.0, -8.0));
            dry.put("talk at the kiosk", PLACES - 1, at, &self.speech(length, random), db_to_amplitude(loud));
            if random.unit() < 0.7 {
                dry.put_puffs(at, &voices::plosives(length, random), db_to_amplitude(loud + random.range(0.0, 6.0)));
            }
            at += length + random.range(0.3, 6.0);
        }
        dry
    }

    /// Sound of a museum at each of 1 or 2 capsules, before the microphone's own response: full scale ±1 at [`RATE`](super::super::RATE).
    pub fn crowd(&self, seconds: f64, busy: f64, capsules: usize, random: &mut Random) -> Vec<Vec<f64>> {
        let dry = self.museum_sounds(seconds, busy, random);
        self.heard(&dry, capsules > 1, random)
    }

    /// A sound from right in front of the kiosk, at each of 1 or 2 capsules.
    pub fn before_the_kiosk(&self, sound: &[f64], capsules: usize) -> Vec<Vec<f64>> {
        self.rooms[0].1[PLACES - 1][..capsules].iter().map(|response| convolved(sound, response)).collect()
    }

    pub(super) fn museum(&self, index: u64, hearing: Hearing, random: &mut Random) -> Take {
        let seconds = 60.0;
        let dry = self.museum_sounds(seconds, 1.0, random);
        let mut channels = self.heard(&dry, hearing.stereo, random);
        Self::add_air(&mut channels, random.range(-75.0, -38.0), random);
        let take = self.finish(Condition::Museum, index, channels, Kind::Noise, Vec::new(), hearing, random);
        Take { events: dry.events, ..take }
    }

    pub(super) fn impulses(&self, index: u64, hearing: Hearing, random: &mut Random) -> Take {
        let seconds = 20.0;
        let mut dry = Dry::silent((seconds * R) as usize);
        let mut at = random.range(0.6, 1.5);
        while at < seconds - 1.0 {
            let mut puffs = None;
            let (what, sound, table) = match (random.unit() * 9.0) as u32 {
                0 => ("door", noises::door(random), false),
                1 => ("bump", noises::bump(random), true),
                2 => ("drop", noises::drop(random), random.unit() < 0.5),
                3 => ("puffs", puffs.insert(voices::plosives(random.range(0.3, 1.5), random))[0].clone(), true),
                4 => ("steps", noises::footsteps(random.range(0.4, 2.0), random), false),
                5 => ("handling", noises::handling(random), true),
                6 => ("applause", noises::applause(random.range(0.5, 3.0), random), false),
                7 => ("applause", noises::applause(random.range(0.5, 4.0), random), random.unit() < 0.5),
                _ => ("clap", noises::clap(random.range(600.0, 2400.0), random), random.unit() < 0.5),
            };
            let place = if table { PLACES } else { (random.unit() * PLACES as f64) as usize };
            let gain = db_to_amplitude(random.range(-30.0, 0.0));
            match puffs {
                Some(puffs) => dry.put_puffs(at, &puffs, gain),
                None => dry.put(what, place, at, &sound, gain),
            }
            at += random.range(0.7, 3.0);
        }
        let mut channels = self.heard(&dry, hearing.stereo, random);
        Self::add_air(&mut channels, random.range(-75.0, -50.0), random);
        let take = self.finish(Condition::Impulses, index, channels, Kind::Impulse, Vec::new(), hearing, random);
        Take { events: dry.events, ..take }
    }

    pub(super) fn alike(&self, index: u64, hearing: Hearing, random: &mut Random) -> Take {
        let seconds = 20.0;
        let busy = if random.unit() < 0.5 { random.range(0.2, 2.0) } else { 0.0 };
        let mut dry = self.museum_sounds(seconds, busy, random);
        // Alone or in a row: a sound after others of its kind is easier to recognise.
        let longest = random.range(1.0, 9.0);
        let mut at = random.range(0.6, 3.0);
        while at < seconds - 1.0 {
            let (what, sound) = match (random.unit() * 10.0) as u32 {
                0..3 => ("thunder", noises::thunder(random)),
                3..6 => ("door", noises::door(random)),
                6 => ("scrape", noises::scrape(random)),
                7 => ("cough", voices::cough(&self.voice(random), random)),
                8 => ("ventilation", noises::switched_air(random.range(1.0, 6.0), random)),
                _ => ("handling", noises::handling(random)),
            };
            let table = random.unit() < if what == "handling" { 0.8 } else { 0.2 };
            let place = if table { PLACES } else { (random.unit() * PLACES as f64) as usize };
            dry.put(what, place, at, &peaked(sound), db_to_amplitude(random.range(-42.0, 0.0)));
            at += random.range(0.7, longest);
        }
        let mut channels = self.heard(&dry, hearing.stereo, random);
        Self::add_air(&mut channels, random.range(-75.0, -45.0), random);
        let take = self.finish(Condition::Alike, index, channels, Kind::Noise, Vec::new(), hearing, random);
        Take { events: dry.events, ..take }
    }
}

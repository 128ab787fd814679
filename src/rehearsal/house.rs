//! The house as the microphone hears it: the crowd of the day, the air, visitors before the kiosk, and the kiosk itself.
//!
//! Time goes in blocks of 10 ms, as a sound card's does. Everything is summed as sound; last comes the microphone: its
//! corner, its own noise, its rails.
//!
//! How loud a house is beside a breath is a matter of physics. The breath of [`generate`](soffio_detector::generate) at 8.9 m/s
//! strikes a capsule 30 cm away at −23 dB of full scale. A round jet from lips a centimetre wide has 6 · 8.9 m/s · 1/30 =
//! 1.8 m/s left there (Pope, Turbulent Flows, 2000, section 5.1), and a quarter of that wavers: ρ U u′ = 1 Pa, 94 dB. So
//! full scale is 117 dB of sound, and a museum of 57 dB(A) (Carvalho et al. 2016, measured in Santo Tirso) lies 60 dB
//! below it.

use std::collections::VecDeque;
use std::sync::Arc;

use super::blocks::BLOCK;
use super::day::busyness;
use super::loudness::{loud, scaled};
use super::rate::Finer;
use super::room::Echo;
use super::standing::{Above, Standing};
use soffio_detector::generate::filter::{parted, white};
use soffio_math::noise::{Random, hash_words};
use soffio_math::{PI, exp, from_decibels};
use soffio_offline::wav::Recording;
use soffio_soundscape::rooms::ALIKE_HZ;
use soffio_soundscape::scenes::{UNLIKE, World, resampled};
use soffio_soundscape::{RATE, noises};

const R: f64 = RATE as f64;
/// The crowd comes in pieces of this length, which fade into each other, s.
pub const PIECE_S: f64 = 60.0;
const FADE_S: f64 = 2.0;
/// A recording must be so long, s: the fades at its ends and as much between them.
const SHORTEST_S: f64 = 3.0 * FADE_S;
/// Mean level of an empty house, and what a full one has more: 66 dB in all, and 80 dB with a school class in it; each minute
/// is louder or quieter by up to 4 dB.
const HOUSE_DB: (f64, f64) = (48.0, 18.0);
const MINUTE_DB: f64 = 4.0;
/// Ventilation and street, dB of full scale: from a quiet house to a busy one.
const AIR_DBFS: (f64, f64) = (-62.0, -50.0);
/// Noise of the microphone, dB of full scale.
const HISS_DBFS: f64 = -76.0;
/// Corners of a bare capsule, a gooseneck on a sound card, a cheap one, Hz.
const CORNERS_HZ: [f64; 3] = [20.0, 60.0, 80.0];

/// Where the crowd comes from.
pub enum Crowd {
    /// Made, by the day's seed.
    Made,
    /// Recordings at 16 kHz, one after another, round after round.
    Recorded(Vec<Vec<f64>>),
}

/// A crowd of recordings, each long enough to fade into the next.
pub fn recorded(recordings: &[Recording]) -> Result<Crowd, String> {
    let long = recordings.iter().filter(|recording| recording.duration() >= SHORTEST_S);
    let sounds: Vec<_> = long.map(|recording| resampled(&recording.samples, recording.sample_rate)).collect();
    if sounds.is_empty() {
        return Err(format!("no WAV of {SHORTEST_S} s or more is there; record your gallery for some minutes"));
    }
    Ok(Crowd::Recorded(sounds))
}

/// A sound at the microphone.
#[derive(Clone)]
struct Sound {
    /// Sample at which it begins.
    start: u64,
    /// As each capsule hears it.
    channels: Vec<Vec<f64>>,
    breath: bool,
}

/// Everything that the microphone hears.
#[derive(Clone)]
pub struct House {
    world: Arc<World>,
    seed: u64,
    crowd: Arc<Crowd>,
    /// Length of the day, s.
    day_s: f64,
    pieces: u64,
    sounds: Vec<Sound>,
    /// The breath that is looked at, to know how far it stands above all else.
    standing: Standing,
    echo: Echo,
    capsules: Vec<Capsule>,
    /// Samples heard.
    sample: u64,
}

impl House {
    /// A day of so many seconds in a world of one room, heard by a microphone of so many capsules.
    pub fn new(world: World, echo: Echo, crowd: Crowd, seed: u64, (day_s, capsules): (f64, usize)) -> Self {
        let mut random = Random::new(hash_words(&[seed, 0x686f_7573]));
        let corner = CORNERS_HZ[(random.unit() * CORNERS_HZ.len() as f64) as usize];
        let capsule = |number: usize| match number {
            0 => Capsule::new((corner, 1.0), random.word()),
            _ => {
                let (louder, higher) = (random.range(-UNLIKE.0, UNLIKE.0), 1.0 + random.range(-UNLIKE.1, UNLIKE.1));
                Capsule::new((higher * corner, from_decibels(louder)), random.word())
            }
        };
        let capsules = (0..capsules).map(capsule).collect();
        let (world, crowd, standing) = (Arc::new(world), Arc::new(crowd), Standing::default());
        Self { world, seed, crowd, day_s, pieces: 0, sounds: Vec::new(), standing, echo, capsules, sample: 0 }
    }

    /// The same house from a piece of the crowd on, each of [`PIECE_S`]; `self` must not have been heard yet.
    pub fn at(&self, piece: u64) -> Self {
        Self { pieces: piece, sample: (piece as f64 * PIECE_S * R) as u64, ..self.clone() }
    }

    /// Until when it has been heard, s of the day.
    pub fn now(&self) -> f64 {
        self.sample as f64 / R
    }

    /// Its speakers and its room.
    pub fn world(&self) -> &World {
        &self.world
    }

    /// How many capsules listen.
    pub fn capsules(&self) -> usize {
        self.capsules.len()
    }

    /// Lets a sound begin at a time of the day, s; full scale ±1 at 16 kHz, as each capsule hears it.
    pub fn put(&mut self, at: f64, sound: Vec<Vec<f64>>) {
        self.add(at, sound, false);
    }

    /// The same of a breath.
    pub fn put_breath(&mut self, at: f64, sound: Vec<Vec<f64>>) {
        self.add(at, sound, true);
    }

    fn add(&mut self, at: f64, channels: Vec<Vec<f64>>, breath: bool) {
        self.sounds.push(Sound { start: (at * R).round().max(0.0) as u64, channels, breath });
    }

    /// From now on tells of what begins at a time of the day, s.
    pub fn look_at(&mut self, onset: f64) {
        self.standing = Standing::at(onset);
    }

    /// How far the breaths of the time that is looked at stand above all else ([`Standing::above_db`]).
    pub fn above_db(&self) -> Option<Above> {
        self.standing.above_db()
    }

    /// The next block of the microphone at 48 kHz, full scale ±1, frame by frame, while `played` leaves the loudspeaker
    /// (stereo at 48 kHz).
    pub fn hear(&mut self, played: &[f32]) -> Vec<f32> {
        while self.capsules[0].ahead.len() < BLOCK {
            self.go_on();
        }
        let echoes = self.echo.hear(played);
        let (from, until) = (self.sample, self.sample + BLOCK as u64);
        let count = self.capsules.len();
        let mut heard = Vec::new();
        for (number, (capsule, mut sum)) in self.capsules.iter_mut().zip(echoes).enumerate() {
            sum.iter_mut().zip(capsule.ahead.drain(..BLOCK)).for_each(|(y, x)| *y += x);
            let mut blown = vec![0.0; BLOCK];
            for Sound { start, channels, breath } in &self.sounds {
                let sound = &channels[number];
                let into = start.saturating_sub(from).min(BLOCK as u64) as usize;
                let past = from.saturating_sub(*start).min(sound.len() as u64) as usize;
                let to = if *breath { &mut blown } else { &mut sum };
                to[into..].iter_mut().zip(&sound[past..]).for_each(|(y, x)| *y += x);
            }
            self.standing.hear(number, from, &blown, &sum);
            sum.iter_mut().zip(&blown).for_each(|(y, x)| *y += x);
            let samples = capsule.record(&sum);
            heard.resize(count * samples.len(), 0.0);
            heard.iter_mut().skip(number).step_by(count).zip(samples).for_each(|(y, x)| *y = x);
        }
        self.sounds.retain(|sound| sound.start + sound.channels[0].len() as u64 > until);
        self.sample = until;
        heard
    }

    /// Another piece of the crowd.
    fn go_on(&mut self) {
        let mut random = Random::new(hash_words(&[self.seed, self.pieces, 0x6372_6f77]));
        let busy = busyness(self.pieces as f64 * PIECE_S / self.day_s);
        let count = self.capsules.len();
        let mut piece = match &*self.crowd {
            Crowd::Made => {
                let level = HOUSE_DB.0 + HOUSE_DB.1 * busy + random.range(-MINUTE_DB, MINUTE_DB);
                let crowd = scaled(self.world.crowd(PIECE_S + FADE_S, busy, count, &mut random), loud(level));
                let level = from_decibels(AIR_DBFS.0 + (AIR_DBFS.1 - AIR_DBFS.0) * (0.5 * busy).min(1.0));
                let air = noises::air(PIECE_S + FADE_S, &mut random);
                let both = heard_by(air, count).into_iter().zip(crowd);
                both.map(|(air, crowd)| crowd.iter().zip(&air).map(|(y, x)| y + level * x).collect()).collect()
            }
            Crowd::Recorded(recordings) => {
                heard_by(recordings[(self.pieces % recordings.len() as u64) as usize].clone(), count)
            }
        };
        for (capsule, piece) in self.capsules.iter_mut().zip(&mut piece) {
            capsule.append(std::mem::take(piece));
        }
        self.pieces += 1;
    }
}

/// What comes from everywhere, as each of so many capsules hears it: above [`ALIKE_HZ`] each by itself.
fn heard_by(sound: Vec<f64>, capsules: usize) -> Vec<Vec<f64>> {
    let other = |_| {
        let mut other = sound.clone();
        other.rotate_left(sound.len() / 3);
        parted(sound.clone(), other, R, ALIKE_HZ)
    };
    let others: Vec<_> = (1..capsules).map(other).collect();
    std::iter::once(sound.clone()).chain(others).collect()
}

/// A capsule of the microphone.
#[derive(Clone)]
struct Capsule {
    /// Crowd that is made and not yet heard.
    ahead: VecDeque<f64>,
    /// The end of the last piece, which fades into the next.
    fading: Vec<f64>,
    keep: f64,
    gain: f64,
    low: [f64; 2],
    random: Random,
    finer: Finer,
}

impl Capsule {
    fn new((corner_hz, gain): (f64, f64), seed: u64) -> Self {
        Self {
            ahead: VecDeque::new(),
            fading: Vec::new(),
            keep: exp(-2.0 * PI * corner_hz / R),
            gain,
            low: [0.0; 2],
            random: Random::new(seed),
            finer: Finer::new(),
        }
    }

    /// Lets a piece of the crowd follow the last one.
    fn append(&mut self, mut piece: Vec<f64>) {
        let fade = ((FADE_S * R) as usize).min(piece.len() / 2);
        for (i, y) in piece.iter_mut().take(self.fading.len()).enumerate() {
            // Two that know nothing of each other keep their power.
            let part = i as f64 / self.fading.len() as f64;
            *y = part.sqrt() * *y + (1.0 - part).sqrt() * self.fading[i];
        }
        self.fading = piece.split_off(piece.len() - fade);
        self.ahead.extend(piece);
    }

    fn record(&mut self, air: &[f64]) -> Vec<f32> {
        let hiss = white(air.len(), &mut self.random);
        let (keep, gain, low) = (self.keep, self.gain, &mut self.low);
        let heard = air.iter().zip(&hiss).map(|(x, n)| {
            let mut y = *x;
            for low in low.iter_mut() {
                *low = y + keep * (*low - y);
                y -= *low;
            }
            gain * y + from_decibels(HISS_DBFS) * n
        });
        self.finer.convert(heard).into_iter().map(|x| x.clamp(-1.0, 1.0) as f32).collect()
    }
}

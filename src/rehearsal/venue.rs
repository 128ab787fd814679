//! The venue at the microphone: the crowd of the day, the air, visitors in front of the kiosk, and the kiosk's own echo.
//!
//! Time advances in blocks of 10 ms, as with a sound card. All sounds are summed as pressure, Pa. Last comes the microphone: its
//! high-pass corner, its noise and clipping.
//!
//! The ratio of the crowd's level to a breath follows from physics: both are in pascals ([`super::loudness`]). A museum of 57 dB(A)
//! (Carvalho et al. 2016, measured in Santo Tirso) lies 60 dB below full scale.

use std::collections::VecDeque;
use std::sync::Arc;

use super::blocks::BLOCK;
use super::breath_snr::{BreathSnr, SnrMeter};
use super::day::occupancy;
use super::echo_path::EchoPath;
use super::loudness::{FULL_SCALE_PA, loud, scaled};
use super::rate::Interpolator;
use soffio_math::noise::{Random, hash_words};
use soffio_math::{PI, db_to_amplitude, exp};
use soffio_offline::wav::Recording;
use soffio_soundscape::RATE;
use soffio_soundscape::draught::Draught;
use soffio_soundscape::filters::{parted, white};
use soffio_soundscape::microphone::{UNLIKE, resampled};
use soffio_soundscape::rooms::ALIKE_HZ;
use soffio_soundscape::scenes::Scenario;

const R: f64 = RATE as f64;
/// Length of a piece of the crowd, s.
pub const PIECE_S: f64 = 60.0;
/// Crossfade between pieces, s.
const FADE_S: f64 = 2.0;
/// Shortest recording of a crowd, s: the fades at its ends, and as much between them.
const SHORTEST_S: f64 = 3.0 * FADE_S;
/// Mean level of an empty venue, and the increase of a full one, dB of sound: 66 dB in all, and 80 dB with a school class.
const CROWD_DB: (f64, f64) = (48.0, 18.0);
/// Largest variation of the level from minute to minute, dB.
const MINUTE_DB: f64 = 4.0;
/// Ventilation and street, from a quiet venue to a busy one, dB of sound.
const AIR_DB: (f64, f64) = (48.0, 60.0);
/// Lengths of a draught's eddies, m: ISO 7730 and what it cites measure 0.05 to 0.5.
const DRAUGHT_M: (f64, f64) = (0.05, 0.5);
/// Noise of the microphone, dB of sound.
const HISS_DB: f64 = 34.0;
/// High-pass corners of a bare capsule, a gooseneck on a sound card, and a cheap microphone, Hz.
const CORNERS_HZ: [f64; 3] = [20.0, 60.0, 80.0];

/// Source of the crowd's sound.
pub enum Crowd {
    /// Synthetic, from the day's seed.
    Made,
    /// Recordings at 16 kHz, Pa, one after another, repeated.
    Recorded(Vec<Vec<f64>>),
}

/// A crowd of recordings, each long enough to fade into the next.
///
/// # Errors
/// No recording is long enough.
pub fn recorded(recordings: &[Recording]) -> Result<Crowd, String> {
    let long = recordings.iter().filter(|recording| recording.duration() >= SHORTEST_S);
    let sounds: Vec<Vec<f64>> = long
        .map(|recording| resampled(&recording.samples, recording.sample_rate, RATE))
        .map(|sound| sound.iter().map(|x| FULL_SCALE_PA * f64::from(*x)).collect())
        .collect();
    if sounds.is_empty() {
        return Err(format!("it has no WAV of {SHORTEST_S} s or more; record your gallery for some minutes"));
    }
    Ok(Crowd::Recorded(sounds))
}

/// A sound at the microphone.
#[derive(Clone)]
struct Sound {
    /// First sample.
    start: u64,
    /// Samples at each capsule.
    channels: Vec<Vec<f64>>,
    is_breath: bool,
}

/// All sound at the microphone.
#[derive(Clone)]
pub struct Venue {
    scenario: Arc<Scenario>,
    seed: u64,
    crowd: Arc<Crowd>,
    /// Length of the day, s.
    day_s: f64,
    /// Mean speed of the draught at the microphone, m/s.
    draught_m_s: f64,
    pieces: u64,
    sounds: Vec<Sound>,
    /// Meter of the signal-to-noise ratio of one breath.
    snr_meter: SnrMeter,
    echo: EchoPath,
    capsules: Vec<Capsule>,
    /// Number of samples so far.
    sample: u64,
}

/// Parameters of a venue.
pub struct VenueSettings {
    /// Seed of the crowd and the microphone.
    pub seed: u64,
    /// Length of the day, s.
    pub day_s: f64,
    /// Capsules of the microphone, 1 or 2.
    pub capsules: usize,
    /// Mean speed of the draught at the microphone, m/s.
    pub draught_m_s: f64,
}

impl Venue {
    /// A venue for one day in a scenario of one room.
    pub fn new(scenario: Scenario, echo: EchoPath, crowd: Crowd, settings: &VenueSettings) -> Self {
        let VenueSettings { seed, day_s, capsules, draught_m_s } = *settings;
        let mut random = Random::new(hash_words(&[seed, 0x686f_7573]));
        let corner = CORNERS_HZ[(random.unit() * CORNERS_HZ.len() as f64) as usize];
        let capsule = |number: usize| match number {
            0 => Capsule::new(corner, 1.0, random.word()),
            _ => {
                let (louder, higher) = (random.range(-UNLIKE.0, UNLIKE.0), 1.0 + random.range(-UNLIKE.1, UNLIKE.1));
                Capsule::new(higher * corner, db_to_amplitude(louder), random.word())
            }
        };
        let capsules = (0..capsules).map(capsule).collect();
        let (scenario, crowd, snr_meter) = (Arc::new(scenario), Arc::new(crowd), SnrMeter::default());
        Self {
            scenario,
            seed,
            crowd,
            day_s,
            draught_m_s,
            pieces: 0,
            sounds: Vec::new(),
            snr_meter,
            echo,
            capsules,
            sample: 0,
        }
    }

    /// The same venue from a piece of the crowd on, each of [`PIECE_S`]; `self` must be at its beginning.
    pub fn at(&self, piece: u64) -> Self {
        Self { pieces: piece, sample: (piece as f64 * PIECE_S * R) as u64, ..self.clone() }
    }

    /// Time of the next block, s of the day.
    pub fn now(&self) -> f64 {
        self.sample as f64 / R
    }

    /// Speakers and room of the venue.
    pub fn scenario(&self) -> &Scenario {
        &self.scenario
    }

    /// Number of capsules.
    pub fn capsules(&self) -> usize {
        self.capsules.len()
    }

    /// Adds a sound at a time of the day, s; Pa at 16 kHz, one channel per capsule.
    pub fn put(&mut self, at: f64, sound: Vec<Vec<f64>>) {
        self.sounds.push(Sound { start: Self::sample_at(at), channels: sound, is_breath: false });
    }

    /// Adds a breath at a time of the day, s, in the same form.
    pub fn put_breath(&mut self, at: f64, sound: Vec<Vec<f64>>) {
        self.sounds.push(Sound { start: Self::sample_at(at), channels: sound, is_breath: true });
    }

    fn sample_at(at: f64) -> u64 {
        (at * R).round().max(0.0) as u64
    }

    /// Starts to measure the signal-to-noise ratio of the breath that begins at a time of the day, s.
    pub fn measure_snr(&mut self, onset: f64) {
        self.snr_meter = SnrMeter::at(onset);
    }

    /// Signal-to-noise ratio of the measured breath ([`SnrMeter::snr_db`]).
    pub fn snr_db(&self) -> Option<BreathSnr> {
        self.snr_meter.snr_db()
    }

    /// Next block of the microphone at 48 kHz, full scale ±1, interleaved, while the loudspeaker plays `played` (stereo at 48 kHz).
    pub fn next_block(&mut self, played: &[f32]) -> Vec<f32> {
        while self.capsules[0].ahead.len() < BLOCK {
            self.extend_crowd();
        }
        let echoes = self.echo.process(played);
        let (from, until) = (self.sample, self.sample + BLOCK as u64);
        let count = self.capsules.len();
        let mut block = Vec::new();
        for (number, (capsule, mut sum)) in self.capsules.iter_mut().zip(echoes).enumerate() {
            sum.iter_mut().zip(capsule.ahead.drain(..BLOCK)).for_each(|(y, x)| *y += x);
            let mut breaths = vec![0.0; BLOCK];
            for Sound { start, channels, is_breath } in &self.sounds {
                let sound = &channels[number];
                let into = start.saturating_sub(from).min(BLOCK as u64) as usize;
                let elapsed = from.saturating_sub(*start).min(sound.len() as u64) as usize;
                let to = if *is_breath { &mut breaths } else { &mut sum };
                to[into..].iter_mut().zip(&sound[elapsed..]).for_each(|(y, x)| *y += x);
            }
            self.snr_meter.push(number, from, &breaths, &sum);
            sum.iter_mut().zip(&breaths).for_each(|(y, x)| *y += x);
            let samples = capsule.record(&sum);
            block.resize(count * samples.len(), 0.0);
            block.iter_mut().skip(number).step_by(count).zip(samples).for_each(|(y, x)| *y = x);
        }
        self.sounds.retain(|sound| sound.start + sound.channels[0].len() as u64 > until);
        self.sample = until;
        block
    }

    /// Adds the next piece of the crowd.
    fn extend_crowd(&mut self) {
        let mut random = Random::new(hash_words(&[self.seed, self.pieces, 0x6372_6f77]));
        let occupancy = occupancy(self.pieces as f64 * PIECE_S / self.day_s);
        let count = self.capsules.len();
        let mut piece = match &*self.crowd {
            Crowd::Made => {
                let level = CROWD_DB.0 + CROWD_DB.1 * occupancy + random.range(-MINUTE_DB, MINUTE_DB);
                let (crowd, _) = self.scenario.crowd(PIECE_S + FADE_S, occupancy, count, &mut random);
                let crowd = scaled(crowd, loud(level));
                let level = AIR_DB.0 + (AIR_DB.1 - AIR_DB.0) * (0.5 * occupancy).min(1.0);
                let air = self.scenario.air_noise(PIECE_S + FADE_S, level, count, &mut random);
                let both = air.iter().zip(crowd);
                both.map(|(air, crowd)| crowd.iter().zip(air).map(|(y, x)| y + x).collect()).collect()
            }
            Crowd::Recorded(recordings) => {
                diffuse(recordings[(self.pieces % recordings.len() as u64) as usize].clone(), count)
            }
        };
        if self.draught_m_s > 0.0 {
            let length = random.range(DRAUGHT_M.0, DRAUGHT_M.1);
            let spacing = if count > 1 { self.scenario.spacing() } else { 0.0 };
            let draught = Draught::random(self.draught_m_s, length, spacing, &mut random);
            let air = draught.pressure(PIECE_S + FADE_S, RATE, random.word());
            for (piece, air) in piece.iter_mut().zip(air) {
                piece.iter_mut().zip(air).for_each(|(y, x)| *y += x);
            }
        }
        for (capsule, piece) in self.capsules.iter_mut().zip(&mut piece) {
            capsule.append(std::mem::take(piece));
        }
        self.pieces += 1;
    }
}

/// A diffuse sound at each capsule: the same below [`ALIKE_HZ`], uncorrelated above.
fn diffuse(sound: Vec<f64>, capsules: usize) -> Vec<Vec<f64>> {
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
    /// Samples of the crowd that are not played yet.
    ahead: VecDeque<f64>,
    /// End of the last piece, which fades into the next.
    fading: Vec<f64>,
    keep: f64,
    gain: f64,
    low: [f64; 2],
    random: Random,
    interpolator: Interpolator,
}

impl Capsule {
    fn new(corner_hz: f64, gain: f64, seed: u64) -> Self {
        Self {
            ahead: VecDeque::new(),
            fading: Vec::new(),
            keep: exp(-2.0 * PI * corner_hz / R),
            gain,
            low: [0.0; 2],
            random: Random::new(seed),
            interpolator: Interpolator::new(),
        }
    }

    /// Appends a piece of the crowd with a crossfade.
    fn append(&mut self, mut piece: Vec<f64>) {
        let fade = ((FADE_S * R) as usize).min(piece.len() / 2);
        for (i, y) in piece.iter_mut().take(self.fading.len()).enumerate() {
            // Uncorrelated sounds keep their power.
            let part = i as f64 / self.fading.len() as f64;
            *y = part.sqrt() * *y + (1.0 - part).sqrt() * self.fading[i];
        }
        self.fading = piece.split_off(piece.len() - fade);
        self.ahead.extend(piece);
    }

    fn record(&mut self, air: &[f64]) -> Vec<f32> {
        let hiss = white(air.len(), &mut self.random);
        let (keep, gain, noise, low) = (self.keep, self.gain / FULL_SCALE_PA, loud(HISS_DB), &mut self.low);
        let received = air.iter().zip(&hiss).map(|(x, n)| {
            let mut y = *x;
            for low in low.iter_mut() {
                *low = y + keep * (*low - y);
                y -= *low;
            }
            gain * (y + noise * n)
        });
        self.interpolator.convert(received).into_iter().map(|x| x.clamp(-1.0, 1.0) as f32).collect()
    }
}

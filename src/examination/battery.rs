//! The battery: which takes are made, and how they are scored.
//!
//! A take of breaths has a room, some seconds of learning, and five breaths of one visitor. The same stage passes several
//! microphones. The full size has 640 breaths and 11 hours of noise; a size of 0.05 suits a test.

use soffio_math::noise::hash_words;
use soffio_soundscape::breath::Manner;
use soffio_soundscape::parallel::parallel;
use soffio_soundscape::scenes::{Noise, Scenario};

use crate::subject::Make;
use crate::tally::Tally;
use crate::{breaths, bystanders};

/// Seeds of examinations begin here; no training uses them.
const FIRST_SEED: u64 = 0x6578_616d_0000_0000;
/// Scenarios that takes share in turn.
const SCENARIOS: u64 = 12;
/// Takes of breaths at the full size.
const BREATH_TAKES: f64 = 128.0;
/// Takes that also pass all high-passes, gains, rates and controls, at the full size.
const MICROPHONE_TAKES: f64 = 48.0;
/// Takes of holds with dips at the full size.
const DIP_TAKES: f64 = 40.0;
/// Takes of a minute of each kind of noise at the full size.
const NOISE_TAKES: f64 = 60.0;
/// Takes of a minute of the kiosk's own sound at the full size.
const KIOSK_TAKES: f64 = 40.0;
/// Draughts of each speed and length at the full size.
const DRAUGHT_TAKES: f64 = 2.0;
/// Speeds of draughts, m/s.
const DRAUGHTS_M_S: [f64; 4] = [0.1, 0.2, 0.4, 0.6];
/// Lengths of eddies in draughts, m.
const LENGTHS_M: [f64; 4] = [0.02, 0.1, 0.3, 1.0];

/// Size and kind of an examination.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Battery {
    /// Number and length of takes relative to the full size.
    pub size: f64,
    /// Capsules, 1 or 2.
    pub capsules: usize,
    /// Seed of all sounds.
    pub seed: u64,
    /// Part that is examined; `None` for all.
    pub only: Option<Part>,
}

/// Part of the battery.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// Breaths through a plain microphone, and holds with dips.
    Breaths,
    /// Breaths through other microphones.
    Microphones,
    /// Noises.
    Noises,
    /// Draughts.
    Draughts,
    /// The kiosk's own sound.
    Kiosk,
}

/// One take of the battery.
#[derive(Clone, Copy, Debug)]
enum Job {
    Breaths { index: u64, microphones: bool },
    Dips { index: u64 },
    Noise { kind: Option<Noise>, index: u64 },
    Draught { speed: f64, length: f64, index: u64, seconds: f64 },
    Kiosk { index: u64 },
}

impl Battery {
    /// Number of takes, at least `least`.
    fn count(&self, full: f64, least: u64) -> u64 {
        ((full * self.size).round() as u64).max(least)
    }

    /// All takes.
    fn jobs(&self) -> Vec<Job> {
        let wants = |part| self.only.is_none_or(|only| only == part);
        let mut jobs = Vec::new();
        let microphones = if wants(Part::Microphones) { self.count(MICROPHONE_TAKES, 2) } else { 0 };
        let breaths = if wants(Part::Breaths) { self.count(BREATH_TAKES, 6) } else { microphones };
        jobs.extend((0..breaths).map(|index| Job::Breaths { index, microphones: index < microphones }));
        if wants(Part::Breaths) {
            jobs.extend((0..self.count(DIP_TAKES, 2)).map(|index| Job::Dips { index }));
        }
        if wants(Part::Noises) {
            for kind in Noise::ALL.into_iter().map(Some).chain([None]) {
                jobs.extend((0..self.count(NOISE_TAKES, 1)).map(|index| Job::Noise { kind, index }));
            }
        }
        if wants(Part::Draughts) {
            let seconds = (600.0 * self.size * DRAUGHT_TAKES).clamp(30.0, 600.0);
            for speed in DRAUGHTS_M_S {
                for length in LENGTHS_M {
                    let draught = |index| Job::Draught { speed, length, index, seconds };
                    jobs.extend((0..self.count(DRAUGHT_TAKES, 1)).map(draught));
                }
            }
        }
        if wants(Part::Kiosk) {
            jobs.extend((0..self.count(KIOSK_TAKES, 2)).map(|index| Job::Kiosk { index }));
        }
        jobs
    }
}

/// Examines a detector.
pub fn run(make: &Make<'_>, battery: &Battery) -> Tally {
    let jobs = battery.jobs();
    let seed = FIRST_SEED + battery.seed;
    let scenarios = SCENARIOS.min(jobs.len() as u64);
    let scenarios = parallel((0..scenarios).collect(), |index| Scenario::new(hash_words(&[seed, index])));
    let capsules = battery.capsules;
    let tallies = parallel(jobs, |job| {
        let scenario = |index: u64| &scenarios[index as usize % scenarios.len()];
        match job {
            Job::Breaths { index, microphones } => {
                breaths::take(make, scenario(index), (seed, index), capsules, microphones)
            }
            Job::Dips { index } => breaths::dips(make, scenario(index), (seed, index), capsules),
            Job::Noise { kind, index } => bystanders::noise(make, scenario(index), (seed, index), capsules, kind),
            Job::Draught { speed, length, index, seconds } => {
                bystanders::draught(make, scenario(index), (seed, index), capsules, (speed, length, seconds))
            }
            Job::Kiosk { index } => bystanders::kiosk(make, scenario(index), (seed, index), capsules),
        }
    });
    let mut all = Tally::default();
    tallies.into_iter().for_each(|tally| all.add(tally));
    all
}

/// Manners that the breaths of takes run through in turn.
pub(crate) const MANNERS: [Manner; 10] = [
    Manner::Plain,
    Manner::Puff,
    Manner::Plain,
    Manner::Pfff,
    Manner::Hold,
    Manner::Plain,
    Manner::Whoo,
    Manner::Plain,
    Manner::Straw,
    Manner::Foam,
];

//! What the kiosk knows of its own ears: blows since the foam was changed, and what the nightly chirp says of foam,
//! loudspeaker and microphone.
//!
//! The first [`CLEAN_NIGHTS`] chirps that arrive whole are what the later ones are compared with, octave by octave. Levels
//! are all that is kept of a chirp.

use serde::{Deserialize, Serialize};

use crate::venue::chirp::{Arrived, OCTAVES};
use crate::venue::chirping::Outcome;

/// Chirps that make the mean which later ones are compared with.
pub const CLEAN_NIGHTS: usize = 3;
/// The first ones agree within this, dB on the mean; else the older ones are forgotten.
const AGREE_DB: f64 = 4.0;
/// Octaves up to 1 kHz are low, those above high. So many of each must be known before anything is said of them.
const LOW: usize = 4;
const KNOWN: (usize, usize) = (2, 2);
/// So much less at the top than at the bottom is a foam that is wet or full of dust, dB.
const WET_DB: f64 = -4.5;
/// So much less everywhere is a way that is blocked, dB.
const BLOCKED_DB: f64 = -10.0;
/// So much more than it was: somebody has turned up a gain, dB.
const LOUDER_DB: f64 = 10.0;
/// A level that the room's noise hides is known to be lost where the noise itself lies so far below what was, dB.
const HIDDEN_DB: f64 = -15.0;

/// What a chirp says.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", tag = "is", content = "by")]
pub enum Verdict {
    /// As in the first nights; the mean difference, dB.
    Good(f64),
    /// One of the first nights, which the later ones are compared with.
    Learns(usize),
    /// The foam lets no high tones through; so much less than of low ones, dB.
    WetFoam(f64),
    /// Everything is softer, by so much, dB: foam, microphone or loudspeaker is covered, or a gain turned down.
    Blocked(f64),
    /// Everything is louder, by so much, dB.
    Louder(f64),
    /// The microphone gives no sound at all.
    DeadMicrophone,
    /// The microphone hears the room and no chirp.
    Unheard,
    /// The room was too loud to say anything.
    Noisy,
    /// There was none, for this reason.
    None(String),
}

impl Verdict {
    /// Should staff do something?
    pub fn is_bad(&self) -> bool {
        !matches!(self, Self::Good(_) | Self::Learns(_) | Self::Noisy)
    }

    /// As the metrics name it.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Good(_) => "good",
            Self::Learns(_) => "learns",
            Self::WetFoam(_) => "wet-foam",
            Self::Blocked(_) => "blocked",
            Self::Louder(_) => "louder",
            Self::DeadMicrophone => "dead-microphone",
            Self::Unheard => "unheard",
            Self::Noisy => "noisy",
            Self::None(_) => "none",
        }
    }

    /// All names of [`Self::name`].
    pub const NAMES: [&str; 9] =
        ["good", "learns", "wet-foam", "blocked", "louder", "dead-microphone", "unheard", "noisy", "none"];
}

impl std::fmt::Display for Verdict {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Good(by) => write!(f, "foam, loudspeaker and microphone are as they were ({by:+.1} dB)"),
            Self::Learns(night) => write!(f, "chirp {night} of {CLEAN_NIGHTS} that later ones are compared with"),
            Self::WetFoam(by) => write!(f, "the foam is wet or dusty: high tones arrive {by:.0} dB softer; change it"),
            Self::Blocked(by) => {
                write!(f, "all arrives {by:.0} dB softer: look at the foam, what stands in the way, and the gains")
            }
            Self::Louder(by) => {
                write!(f, "all arrives {by:+.0} dB louder: a gain was turned up; listen anew if it was meant so")
            }
            Self::DeadMicrophone => f.write_str("the microphone gives no sound: its cable, its switch, its power"),
            Self::Unheard => f.write_str("the microphone hears the room and no chirp: loudspeaker or its amplifier"),
            Self::Noisy => f.write_str("the room was too loud to tell"),
            Self::None(why) => write!(f, "no chirp: {why}"),
        }
    }
}

/// What is kept of foam and chirps.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Care {
    /// Breaths at the microphone, of all runs, when the foam was changed last.
    pub foam_changed_at: u64,
    /// Levels of the first clean chirps, dB.
    pub clean_db: Vec<[f64; OCTAVES]>,
    /// The last chirp over the mean of the first ones, dB; unknown octaves are empty.
    pub change_db: [Option<f64>; OCTAVES],
    /// What it says, and the local day and time at which it was heard.
    pub last: Option<(Verdict, String)>,
}

impl Care {
    /// Breaths that the foam has had, of so many at the microphone in all.
    pub fn foam(&self, breaths: u64) -> u64 {
        // Counters begin anew where the file of what is kept was deleted.
        breaths.saturating_sub(self.foam_changed_at)
    }

    /// The foam is a new one. What the first nights were stays: a good foam is as good as the one before.
    pub fn change_foam(&mut self, breaths: u64) {
        self.foam_changed_at = breaths;
    }

    /// What is heard from now on is what later chirps are compared with.
    pub fn listen_anew(&mut self) {
        (self.clean_db, self.change_db) = (Vec::new(), [None; OCTAVES]);
    }

    /// Takes in a chirp that was heard (or not) at this local day and time.
    pub fn note(&mut self, outcome: &Outcome, when: String) -> &Verdict {
        let verdict = match outcome {
            Ok(arrived) => self.judge(arrived),
            Err(why) => Verdict::None(why.clone()),
        };
        &self.last.insert((verdict, when)).0
    }

    fn judge(&mut self, arrived: &Arrived) -> Verdict {
        self.change_db = [None; OCTAVES];
        if arrived.dead {
            return Verdict::DeadMicrophone;
        }
        if self.clean_db.len() < CLEAN_NIGHTS {
            return self.learn(arrived);
        }
        let usual = self.usual();
        for b in 0..OCTAVES {
            let change = arrived.levels_db[b] - usual[b];
            self.change_db[b] = (arrived.clear[b] || change < HIDDEN_DB).then_some(change);
        }
        let mean = |bands: std::ops::Range<usize>, least: usize| {
            let known: Vec<f64> = self.change_db[bands].iter().flatten().copied().collect();
            (known.len() >= least).then(|| known.iter().sum::<f64>() / known.len() as f64)
        };
        let (Some(low), Some(high), Some(all)) =
            (mean(0..LOW, KNOWN.0), mean(LOW..OCTAVES, KNOWN.1), mean(0..OCTAVES, 0))
        else {
            return Verdict::Noisy;
        };
        if !arrived.clear.contains(&true) {
            Verdict::Unheard
        } else if high - low <= WET_DB && low > BLOCKED_DB {
            Verdict::WetFoam(low - high)
        } else if all <= BLOCKED_DB {
            Verdict::Blocked(-all)
        } else if all >= LOUDER_DB {
            Verdict::Louder(all)
        } else {
            Verdict::Good(all)
        }
    }

    /// A chirp that arrives whole is one of the first ones.
    fn learn(&mut self, arrived: &Arrived) -> Verdict {
        if !arrived.clear.contains(&true) {
            return Verdict::Unheard;
        }
        if arrived.clear.contains(&false) {
            return Verdict::Noisy;
        }
        let apart = |clean: &[f64; OCTAVES]| {
            clean.iter().zip(&arrived.levels_db).map(|(a, b)| (a - b).abs()).sum::<f64>() / OCTAVES as f64
        };
        // Somebody has turned a knob since: what came before is not how it is.
        if self.clean_db.iter().any(|clean| apart(clean) > AGREE_DB) {
            self.clean_db.clear();
        }
        self.clean_db.push(arrived.levels_db);
        Verdict::Learns(self.clean_db.len())
    }

    /// Mean of the first ones, dB.
    fn usual(&self) -> [f64; OCTAVES] {
        let mean = |b: usize| self.clean_db.iter().map(|clean| clean[b]).sum::<f64>() / self.clean_db.len() as f64;
        std::array::from_fn(mean)
    }
}

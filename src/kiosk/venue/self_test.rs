//! Verdicts of the audio self-test on foam, loudspeaker and microphone, and the breaths since the foam was changed.
//!
//! The first [`REFERENCE_RUNS`] self-tests in which all octaves are clear make the reference. Later ones are compared with
//! its mean, octave by octave. Only levels are stored, never the sound.

use serde::{Deserialize, Serialize};

use crate::venue::self_test_run::SelfTestOutcome;
use crate::venue::sweep::{OCTAVES, SweepResponse};

/// Self-tests that make the reference.
pub const REFERENCE_RUNS: usize = 3;
/// Largest mean difference of levels within the reference, dB; beyond it the older runs are dropped.
const AGREE_DB: f64 = 4.0;
/// Number of low octaves, those up to 1 kHz; the others are high.
const LOW: usize = 4;
/// Least known octaves among the low and among the high ones for a verdict.
const KNOWN: (usize, usize) = (2, 2);
/// Change of the high octaves minus that of the low ones, dB, below which the foam is wet or dusty.
const WET_DB: f64 = -4.5;
/// Mean change, dB, below which the path from loudspeaker to microphone is blocked.
const BLOCKED_DB: f64 = -10.0;
/// Mean change, dB, above which a gain was turned up.
const LOUDER_DB: f64 = 10.0;
/// Change, dB, below which an octave counts as lost even where noise hides it: the noise itself is that far below the reference.
const HIDDEN_DB: f64 = -15.0;

/// Verdict of a self-test. Changes are relative to the reference.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", tag = "is", content = "by")]
pub enum Verdict {
    /// As in the reference; the mean change, dB.
    Good(f64),
    /// One of the runs that make the reference; its number.
    Learns(usize),
    /// The foam absorbs high tones; by so much more than low ones, dB.
    WetFoam(f64),
    /// All octaves are softer, by so much, dB: foam, microphone or loudspeaker is covered, or a gain was turned down.
    Blocked(f64),
    /// All octaves are louder, by so much, dB.
    Louder(f64),
    /// The microphone delivers exact silence.
    DeadMicrophone,
    /// The microphone records the room and no sweep.
    Unheard,
    /// The room was too loud for a verdict.
    Noisy,
    /// The test was not run, for this reason.
    None(String),
}

impl Verdict {
    /// Should staff do something?
    pub fn is_bad(&self) -> bool {
        !matches!(self, Self::Good(_) | Self::Learns(_) | Self::Noisy)
    }

    /// Its name in the metrics.
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
            Self::Good(by) => write!(f, "foam, loudspeaker and microphone are unchanged ({by:+.1} dB)"),
            Self::Learns(night) => write!(f, "run {night} of {REFERENCE_RUNS} that make the reference"),
            Self::WetFoam(by) => write!(f, "the foam is wet or dusty: high tones arrive {by:.0} dB softer; change it"),
            Self::Blocked(by) => {
                write!(
                    f,
                    "all tones arrive {by:.0} dB softer: check the foam, the gains, and whether something blocks the path"
                )
            }
            Self::Louder(by) => {
                write!(
                    f,
                    "all tones arrive {by:+.0} dB louder: a gain was turned up; measure a new reference if that was intended"
                )
            }
            Self::DeadMicrophone => f.write_str("the microphone delivers no sound: check its cable, switch and power"),
            Self::Unheard => {
                f.write_str("the microphone records the room and no sweep: check the loudspeaker and its amplifier")
            }
            Self::Noisy => f.write_str("the room was too loud for the test"),
            Self::None(why) => write!(f, "not run: {why}"),
        }
    }
}

/// Results of the audio self-tests and state of the microphone's foam, as they outlast a restart in `state.json`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct SelfTestHistory {
    /// Number of breaths at the microphone in all runs until the foam was changed last.
    pub foam_changed_at: u64,
    /// Levels of the reference runs, dB.
    #[serde(alias = "clean_db")]
    pub reference_db: Vec<[f64; OCTAVES]>,
    /// Change of the last run from the mean of the reference, dB; unknown octaves are empty.
    pub change_db: [Option<f64>; OCTAVES],
    /// Last verdict, with its local day and time.
    pub last: Option<(Verdict, String)>,
}

impl SelfTestHistory {
    /// Breaths since the foam was changed; `breaths` are all at the microphone.
    pub fn foam_breaths(&self, breaths: u64) -> u64 {
        // Counters start from zero when the state file was deleted.
        breaths.saturating_sub(self.foam_changed_at)
    }

    /// The foam was changed. The reference stays: a good foam is as good as the one before.
    pub fn change_foam(&mut self, breaths: u64) {
        self.foam_changed_at = breaths;
    }

    /// Drops the reference: the next runs make a new one.
    pub fn forget_reference(&mut self) {
        (self.reference_db, self.change_db) = (Vec::new(), [None; OCTAVES]);
    }

    /// Records the outcome of a run at this local day and time; returns its verdict.
    pub fn record(&mut self, outcome: &SelfTestOutcome, when: String) -> &Verdict {
        let verdict = match outcome {
            Ok(response) => self.evaluate(response),
            Err(why) => Verdict::None(why.clone()),
        };
        &self.last.insert((verdict, when)).0
    }

    fn evaluate(&mut self, response: &SweepResponse) -> Verdict {
        self.change_db = [None; OCTAVES];
        if response.dead {
            return Verdict::DeadMicrophone;
        }
        if self.reference_db.len() < REFERENCE_RUNS {
            return self.learn(response);
        }
        let usual = self.usual();
        for b in 0..OCTAVES {
            let change = response.levels_db[b] - usual[b];
            self.change_db[b] = (response.clear[b] || change < HIDDEN_DB).then_some(change);
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
        if !response.clear.contains(&true) {
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

    /// A run in which all octaves are clear is added to the reference.
    fn learn(&mut self, response: &SweepResponse) -> Verdict {
        if !response.clear.contains(&true) {
            return Verdict::Unheard;
        }
        if response.clear.contains(&false) {
            return Verdict::Noisy;
        }
        let apart = |clean: &[f64; OCTAVES]| {
            clean.iter().zip(&response.levels_db).map(|(a, b)| (a - b).abs()).sum::<f64>() / OCTAVES as f64
        };
        // A gain was changed meanwhile: the older runs do not describe the present.
        if self.reference_db.iter().any(|clean| apart(clean) > AGREE_DB) {
            self.reference_db.clear();
        }
        self.reference_db.push(response.levels_db);
        Verdict::Learns(self.reference_db.len())
    }

    /// Mean of the reference, dB.
    fn usual(&self) -> [f64; OCTAVES] {
        let mean =
            |b: usize| self.reference_db.iter().map(|clean| clean[b]).sum::<f64>() / self.reference_db.len() as f64;
        std::array::from_fn(mean)
    }
}

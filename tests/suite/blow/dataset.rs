//! The labelled recordings (`../shared/breath`, or where `SOFFIO_BREATH_DATA` says), and the scores of a model on them.

use std::path::{Path, PathBuf};

use soffio::offline::wav;
use soffio::wind::blow::{BlowDetector, BlowSettings, model::Model};

/// One labelled recording.
#[derive(Clone, Debug)]
pub struct Clip {
    pub file: String,
    pub label: String,
    /// blow, not_blow or ambiguous.
    pub expected: String,
    /// When the air starts and has stopped, s; only for blows.
    pub span: Option<(f64, f64)>,
    /// Place on an intensity ladder.
    pub level: Option<f64>,
    pub snr_db: Option<f64>,
    /// Recordings of one speaker or take share a group.
    pub group: String,
    pub samples: Vec<f32>,
    pub sample_rate: u32,
}

impl Clip {
    pub fn duration(&self) -> f64 {
        self.samples.len() as f64 / f64::from(self.sample_rate)
    }

    pub fn is_blow(&self) -> bool {
        self.expected == "blow"
    }

    /// A knock, clap, pop or thump: must never trigger.
    pub fn is_impulse(&self) -> bool {
        ["impulse", "plosive_pop", "clap", "handling_thump"].contains(&self.label.as_str())
    }

    /// The same recording, louder or quieter, cut at full scale.
    pub fn with_gain(&self, db: f64) -> Self {
        let gain = 10f64.powf(db / 20.0) as f32;
        let samples = self.samples.iter().map(|x| (x * gain).clamp(-1.0, 1.0)).collect();
        Self { samples, ..self.clone() }
    }
}

fn folder() -> Option<PathBuf> {
    let given = std::env::var_os("SOFFIO_BREATH_DATA").map(PathBuf::from);
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/breath");
    [given, Some(beside)].into_iter().flatten().find(|folder| folder.join("labels.csv").is_file())
}

/// All recordings, or `None` where the set is absent.
pub fn load() -> Option<Vec<Clip>> {
    let folder = folder()?;
    let table = std::fs::read_to_string(folder.join("labels.csv")).expect("labels.csv is text");
    let clip = |line: &str| {
        // Only the last column (notes) may hold commas.
        let cell: Vec<&str> = line.splitn(15, ',').collect();
        let number = |i: usize| cell[i].parse::<f64>().ok();
        let recording = wav::read(folder.join(cell[0])).expect("a recording of the set");
        Clip {
            file: cell[0].into(),
            label: cell[1].into(),
            expected: cell[2].into(),
            span: if cell[2] == "blow" { number(3).zip(number(4)) } else { None },
            level: number(11),
            snr_db: number(12),
            group: cell[13].into(),
            samples: recording.samples,
            sample_rate: recording.sample_rate,
        }
    };
    Some(table.lines().skip(1).map(clip).collect())
}

/// Wind over time, a value every 5 ms.
pub fn speeds(model: &Model, samples: &[f32], sample_rate: u32) -> Vec<(f64, f64)> {
    let settings = BlowSettings { model: model.clone(), ..BlowSettings::default() };
    let mut detector = BlowDetector::with_settings(sample_rate, settings);
    let block = (sample_rate / 200) as usize;
    let mut heard = 0;
    let hear = |block: &[f32]| {
        detector.push(block, &[]);
        heard += block.len();
        (heard as f64 / f64::from(sample_rate), detector.estimate().speed)
    };
    samples.chunks(block).map(hear).collect()
}

/// What a model made of one recording.
#[derive(Clone, Debug, Default)]
pub struct Verdict {
    /// Wind within the breath.
    pub detected: bool,
    /// Onset to wind, s.
    pub latency: Option<f64>,
    /// End of the breath to the last wind, s.
    pub release: Option<f64>,
    /// Winds that began outside the breath.
    pub false_triggers: usize,
    /// Mean speed over the breath, m/s.
    pub mean_speed: f64,
}

/// Wind that begins this little before the labelled onset is on time, s.
const EARLY_S: f64 = 0.05;
/// A wind that begins up to this long after the end is the breath's tail, s.
const LATE_S: f64 = 0.3;

pub fn judge(model: &Model, clip: &Clip) -> Verdict {
    let wind = speeds(model, &clip.samples, clip.sample_rate);
    let mut verdict = Verdict::default();
    let mut before = 0.0;
    let inside = |t: f64| clip.span.is_some_and(|(onset, offset)| t >= onset - EARLY_S && t <= offset + LATE_S);
    for &(t, speed) in &wind {
        if speed > 0.0 && before == 0.0 && !inside(t) {
            verdict.false_triggers += 1;
        }
        before = speed;
    }
    if let Some((onset, offset)) = clip.span {
        let blowing: Vec<_> = wind.iter().filter(|(t, s)| *s > 0.0 && inside(*t)).collect();
        verdict.detected = !blowing.is_empty();
        verdict.latency = blowing.first().map(|(t, _)| t - onset);
        verdict.release = blowing.last().map(|(t, _)| t - offset);
        let within: Vec<_> = wind.iter().filter(|(t, _)| *t >= onset && *t <= offset).collect();
        verdict.mean_speed = within.iter().map(|(_, s)| s).sum::<f64>() / within.len().max(1) as f64;
    }
    verdict
}

/// Scores over a set of verdicts.
#[derive(Clone, Debug, Default)]
pub struct Scores {
    pub isolated: (usize, usize),
    pub noisy_5: (usize, usize),
    pub noisy_0: (usize, usize),
    pub false_noise: usize,
    pub noise_hours: f64,
    pub false_impulse: usize,
    pub latency: Vec<f64>,
    pub release: Vec<f64>,
    pub early: usize,
}

impl Scores {
    pub fn add(&mut self, clip: &Clip, verdict: &Verdict) {
        let count = |(hit, all): &mut (usize, usize)| {
            *hit += usize::from(verdict.detected);
            *all += 1;
        };
        if clip.is_blow() {
            match clip.snr_db {
                None => count(&mut self.isolated),
                Some(snr) if snr >= 5.0 => count(&mut self.noisy_5),
                Some(_) => count(&mut self.noisy_0),
            }
            self.latency.extend(verdict.latency);
            self.release.extend(verdict.release);
            self.early += verdict.false_triggers;
        } else if clip.expected == "not_blow" {
            if clip.is_impulse() {
                self.false_impulse += verdict.false_triggers;
            } else {
                self.false_noise += verdict.false_triggers;
                self.noise_hours += clip.duration() / 3600.0;
            }
        }
    }

    pub fn detection(&self) -> f64 {
        self.isolated.0 as f64 / self.isolated.1.max(1) as f64
    }

    pub fn false_per_hour(&self) -> f64 {
        self.false_noise as f64 / self.noise_hours.max(1e-9)
    }

    /// Value below which the given part of the (sorted) values lies.
    pub fn quantile(values: &[f64], part: f64) -> f64 {
        let mut sorted = values.to_vec();
        sorted.sort_by(f64::total_cmp);
        let last = sorted.len().saturating_sub(1);
        sorted.get((part * last as f64).round() as usize).copied().unwrap_or(f64::NAN)
    }
}

impl std::fmt::Display for Scores {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let ms = |values: &[f64], part: f64| 1000.0 * Self::quantile(values, part);
        write!(
            f,
            "isolated {}/{} | >=5 dB {}/{} | 0 dB {}/{} | false {} ({:.0}/h) | impulses {} | beside blows {} | \
             latency {:.0}/{:.0} ms | release p90 {:.0} max {:.0} ms",
            self.isolated.0,
            self.isolated.1,
            self.noisy_5.0,
            self.noisy_5.1,
            self.noisy_0.0,
            self.noisy_0.1,
            self.false_noise,
            self.false_per_hour(),
            self.false_impulse,
            self.early,
            ms(&self.latency, 0.5),
            ms(&self.latency, 0.9),
            ms(&self.release, 0.9),
            ms(&self.release, 1.0),
        )
    }
}

pub fn score(model: &Model, clips: &[Clip]) -> Scores {
    let mut scores = Scores::default();
    clips.iter().for_each(|clip| scores.add(clip, &judge(model, clip)));
    scores
}

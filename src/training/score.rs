//! Scores of the blow detector on labelled takes: detection, latency, release and false positives, with 95 % bounds.
//!
//! The bounds are those of [`soffio_soundscape::statistics`].

use std::collections::BTreeMap;
use std::fmt;

use soffio_detector::{BlowDetector, BlowSettings};
use soffio_soundscape::statistics::{poisson, quantile, wilson};
use soffio_soundscape::{Kind, Take};

/// Largest lead of a wind over its labelled onset, s.
const EARLY_S: f64 = 0.05;
/// Time after the end of a breath in which a wind may begin as its tail, s.
const LATE_S: f64 = 0.3;
/// Steps a second at which the wind is sampled: those of the simulation.
const STEPS_HZ: usize = 240;

/// Score of one breath.
#[derive(Clone, Copy, Debug, Default)]
pub struct BreathScore {
    /// Time from onset to wind, s; `None` where the breath was missed.
    pub latency: Option<f64>,
    /// Time from the end of the breath to the end of its wind, s.
    pub release: Option<f64>,
    /// Number of times that the wind stopped within the breath.
    pub breaks: usize,
    /// Mean wind speed over the breath, m/s.
    pub mean_speed: f64,
}

/// Score of one take.
#[derive(Clone, Debug, Default)]
pub struct TakeScore {
    /// Scores of its breaths, in order.
    pub breaths: Vec<BreathScore>,
    /// Times at which wind began without breath, s.
    pub false_positives: Vec<f64>,
    /// The detector has found automatic gain control.
    pub gain_control: bool,
}

impl TakeScore {
    /// True where every breath was detected.
    pub fn detected(&self) -> bool {
        self.breaths.iter().all(|breath| breath.latency.is_some())
    }
}

/// Runs a detector over a take.
pub fn score_take(settings: &BlowSettings, take: &Take) -> TakeScore {
    let mut detector = BlowDetector::with_settings(take.sample_rate, settings.clone());
    let mut score = TakeScore { breaths: vec![BreathScore::default(); take.breaths.len()], ..TakeScore::default() };
    let mut steps = vec![0; take.breaths.len()];
    let breath_at = |t: f64| take.breaths.iter().position(|b| t >= b.onset - EARLY_S && t <= b.offset + LATE_S);
    // Breath to which the present wind belongs.
    let mut current = None;
    let (mut from, mut before) = (0, 0.0);
    for step in 1.. {
        let to = (step * take.sample_rate as usize / STEPS_HZ).min(take.left.len());
        let played = if take.played.is_empty() { &[] } else { &take.played[from..to] };
        match &take.right {
            Some(right) => detector.push_stereo(&take.left[from..to], &right[from..to], played),
            None => detector.push(&take.left[from..to], played),
        }
        from = to;
        let (t, speed) = (to as f64 / f64::from(take.sample_rate), detector.estimate().speed);
        let breath = breath_at(t);
        if speed > 0.0 {
            if before == 0.0 && breath.is_none() {
                score.false_positives.push(t);
            }
            // Wind that outlasts its breath still belongs to it.
            current = breath.or(current.filter(|_| before > 0.0));
            if let Some(i) = current {
                let breath = &mut score.breaths[i];
                if before == 0.0 && breath.latency.is_some() && t < take.breaths[i].offset {
                    breath.breaks += 1;
                }
                breath.latency.get_or_insert(t - take.breaths[i].onset);
                breath.release = Some(t - take.breaths[i].offset);
            }
        }
        if let Some(i) = take.breaths.iter().position(|b| t >= b.onset && t <= b.offset) {
            steps[i] += 1;
            score.breaths[i].mean_speed += (speed - score.breaths[i].mean_speed) / f64::from(steps[i]);
        }
        before = speed;
        if to == take.left.len() {
            break;
        }
    }
    score.gain_control = detector.estimate().gain_control;
    score
}

/// Scores of several takes.
#[derive(Clone, Debug, Default)]
pub struct Scores {
    /// Number of breaths detected, and of all.
    pub detected: (usize, usize),
    /// Number of winds that stopped within a breath.
    pub breaks: usize,
    /// Times from onset to wind, s.
    pub latency: Vec<f64>,
    /// Times from the end of a breath to the end of its wind, s.
    pub release: Vec<f64>,
    /// Number of winds without breath.
    pub false_positives: usize,
    /// Time without breath, h.
    pub hours: f64,
}

impl Scores {
    /// Adds the score of one take.
    pub fn add(&mut self, take: &Take, score: &TakeScore) {
        let blown: f64 = take.breaths.iter().map(|b| b.offset - b.onset + EARLY_S + LATE_S).sum();
        self.hours += (take.duration() - blown).max(0.0) / 3600.0;
        self.false_positives += score.false_positives.len();
        for (_, breath) in take.breaths.iter().zip(&score.breaths).filter(|(b, _)| take.kind == Kind::Blow && !b.faint)
        {
            self.detected.0 += usize::from(breath.latency.is_some());
            self.detected.1 += 1;
            self.breaks += breath.breaks;
            self.latency.extend(breath.latency);
            self.release.extend(breath.release);
        }
    }

    /// Share of the breaths that were detected.
    pub fn share(&self) -> f64 {
        self.detected.0 as f64 / self.detected.1.max(1) as f64
    }

    /// False positives per hour.
    pub fn per_hour(&self) -> f64 {
        self.false_positives as f64 / self.hours.max(1e-9)
    }
}

impl fmt::Display for Scores {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.detected.1 > 0 {
            let (low, high) = wilson(self.detected.0, self.detected.1);
            let ms = |values: &[f64], part: f64| 1000.0 * quantile(values, part);
            write!(
                f,
                "{:4}/{:<4} {:5.1} % [{:.1}, {:.1}]",
                self.detected.0,
                self.detected.1,
                100.0 * self.share(),
                100.0 * low,
                100.0 * high
            )?;
            write!(f, "  latency {:3.0}/{:3.0} ms", ms(&self.latency, 0.5), ms(&self.latency, 0.9))?;
            write!(f, "  release p90 {:3.0} max {:3.0} ms", ms(&self.release, 0.9), ms(&self.release, 1.0))?;
            write!(f, "  breaks {:.2}  ", self.breaks as f64 / self.detected.1 as f64)?;
        }
        let (low, high) = poisson(self.false_positives);
        write!(
            f,
            "false positives {} in {:.2} h: {:.1}/h [{:.1}, {:.1}]",
            self.false_positives,
            self.hours,
            self.per_hour(),
            low / self.hours,
            high / self.hours
        )
    }
}

/// Scores by name, in order of the names.
#[derive(Clone, Debug, Default)]
pub struct Table(pub BTreeMap<String, Scores>);

impl Table {
    /// Adds the score of one take to a row.
    pub fn add(&mut self, row: &str, take: &Take, score: &TakeScore) {
        self.0.entry(row.to_owned()).or_default().add(take, score);
    }

    /// Adds the scores of another table.
    pub fn join(&mut self, other: Self) {
        for (row, scores) in other.0 {
            let mine = self.0.entry(row).or_default();
            mine.detected = (mine.detected.0 + scores.detected.0, mine.detected.1 + scores.detected.1);
            mine.breaks += scores.breaks;
            mine.latency.extend(scores.latency);
            mine.release.extend(scores.release);
            mine.false_positives += scores.false_positives;
            mine.hours += scores.hours;
        }
    }

    /// Row of a recording: breaths by their noise, other takes by their kind; `None` for ambiguous ones.
    pub fn row(take: &Take) -> Option<&'static str> {
        let snr = take.breaths.first().and_then(|b| b.snr_db);
        match (take.kind, snr) {
            (Kind::Blow, None) => Some("1 isolated breaths"),
            (Kind::Blow, Some(snr)) if snr >= 5.0 => Some("2 breaths 5 dB and more above noise"),
            (Kind::Blow, Some(_)) => Some("3 breaths as loud as the noise"),
            (Kind::Noise, _) => Some("4 noise of a museum"),
            (Kind::Impulse, _) => Some("5 knocks, claps, pops, doors"),
            (Kind::Ambiguous, _) => None,
        }
    }
}

impl fmt::Display for Table {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.iter().try_for_each(|(row, scores)| writeln!(f, "{row:38} {scores}"))
    }
}

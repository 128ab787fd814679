//! Marks for the blow detector: what it makes of labelled takes, with 95 % bounds.
//!
//! The bounds are those of [`soffio_soundscape::statistics`].

use std::collections::BTreeMap;
use std::fmt;

use soffio_detector::{BlowDetector, BlowSettings};
use soffio_soundscape::statistics::{poisson, quantile, wilson};
use soffio_soundscape::{Kind, Take};

/// Wind that begins this little before the labelled onset is on time, s.
const EARLY_S: f64 = 0.05;
/// A wind that begins up to this long after the end is the breath's tail, s.
const LATE_S: f64 = 0.3;
/// Steps a second at which the wind is read: those of the simulation.
const STEPS_HZ: usize = 240;

/// What the detector made of one breath.
#[derive(Clone, Copy, Debug, Default)]
pub struct Answer {
    /// Onset to wind, s; `None` where there was none.
    pub latency: Option<f64>,
    /// End of the breath to the end of its wind, s.
    pub release: Option<f64>,
    /// How often its wind stopped before its end.
    pub breaks: usize,
    /// Mean speed over the breath, m/s.
    pub mean_speed: f64,
}

/// What the detector made of one take.
#[derive(Clone, Debug, Default)]
pub struct Verdict {
    /// A breath each.
    pub answers: Vec<Answer>,
    /// Winds that began where nobody blew, s.
    pub ghosts: Vec<f64>,
    /// The detector says that the microphone changes its gain.
    pub gain_control: bool,
}

impl Verdict {
    /// Every breath made wind.
    pub fn detected(&self) -> bool {
        self.answers.iter().all(|answer| answer.latency.is_some())
    }
}

/// Lets a detector hear a take.
pub fn judge(settings: &BlowSettings, take: &Take) -> Verdict {
    let mut detector = BlowDetector::with_settings(take.sample_rate, settings.clone());
    let mut verdict = Verdict { answers: vec![Answer::default(); take.breaths.len()], ..Verdict::default() };
    let mut steps = vec![0; take.breaths.len()];
    let breath_at = |t: f64| take.breaths.iter().position(|b| t >= b.onset - EARLY_S && t <= b.offset + LATE_S);
    // The breath that the present wind belongs to.
    let mut answered = None;
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
                verdict.ghosts.push(t);
            }
            // Wind that outlasts its breath is still its wind.
            answered = breath.or(answered.filter(|_| before > 0.0));
            if let Some(i) = answered {
                let answer = &mut verdict.answers[i];
                if before == 0.0 && answer.latency.is_some() && t < take.breaths[i].offset {
                    answer.breaks += 1;
                }
                answer.latency.get_or_insert(t - take.breaths[i].onset);
                answer.release = Some(t - take.breaths[i].offset);
            }
        }
        if let Some(i) = take.breaths.iter().position(|b| t >= b.onset && t <= b.offset) {
            steps[i] += 1;
            verdict.answers[i].mean_speed += (speed - verdict.answers[i].mean_speed) / f64::from(steps[i]);
        }
        before = speed;
        if to == take.left.len() {
            break;
        }
    }
    verdict.gain_control = detector.estimate().gain_control;
    verdict
}

/// Marks of one kind of take.
#[derive(Clone, Debug, Default)]
pub struct Marks {
    /// Breaths heard, and all.
    pub heard: (usize, usize),
    /// Winds that stopped within a breath.
    pub breaks: usize,
    /// Onset to wind, s.
    pub latency: Vec<f64>,
    /// End to the last wind, s.
    pub release: Vec<f64>,
    /// Winds without breath.
    pub ghosts: usize,
    /// Time in which nobody blew, h.
    pub hours: f64,
}

impl Marks {
    /// Adds one take's verdict.
    pub fn add(&mut self, take: &Take, verdict: &Verdict) {
        let blown: f64 = take.breaths.iter().map(|b| b.offset - b.onset + EARLY_S + LATE_S).sum();
        self.hours += (take.duration() - blown).max(0.0) / 3600.0;
        self.ghosts += verdict.ghosts.len();
        for (_, answer) in
            take.breaths.iter().zip(&verdict.answers).filter(|(b, _)| take.kind == Kind::Blow && !b.faint)
        {
            self.heard.0 += usize::from(answer.latency.is_some());
            self.heard.1 += 1;
            self.breaks += answer.breaks;
            self.latency.extend(answer.latency);
            self.release.extend(answer.release);
        }
    }

    /// Part of the breaths that were heard.
    pub fn share(&self) -> f64 {
        self.heard.0 as f64 / self.heard.1.max(1) as f64
    }

    /// Winds without breath, an hour.
    pub fn per_hour(&self) -> f64 {
        self.ghosts as f64 / self.hours.max(1e-9)
    }
}

impl fmt::Display for Marks {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.heard.1 > 0 {
            let (low, high) = wilson(self.heard.0, self.heard.1);
            let ms = |values: &[f64], part: f64| 1000.0 * quantile(values, part);
            write!(
                f,
                "{:4}/{:<4} {:5.1} % [{:.1}, {:.1}]",
                self.heard.0,
                self.heard.1,
                100.0 * self.share(),
                100.0 * low,
                100.0 * high
            )?;
            write!(f, "  latency {:3.0}/{:3.0} ms", ms(&self.latency, 0.5), ms(&self.latency, 0.9))?;
            write!(f, "  release p90 {:3.0} max {:3.0} ms", ms(&self.release, 0.9), ms(&self.release, 1.0))?;
            write!(f, "  breaks {:.2}  ", self.breaks as f64 / self.heard.1 as f64)?;
        }
        let (low, high) = poisson(self.ghosts);
        write!(
            f,
            "ghosts {} in {:.2} h: {:.1}/h [{:.1}, {:.1}]",
            self.ghosts,
            self.hours,
            self.per_hour(),
            low / self.hours,
            high / self.hours
        )
    }
}

/// Marks by name, in order of the names.
#[derive(Clone, Debug, Default)]
pub struct Table(pub BTreeMap<String, Marks>);

impl Table {
    /// Adds one take's verdict to a row.
    pub fn add(&mut self, row: &str, take: &Take, verdict: &Verdict) {
        self.0.entry(row.to_owned()).or_default().add(take, verdict);
    }

    /// Takes in the marks of another table.
    pub fn join(&mut self, other: Self) {
        for (row, marks) in other.0 {
            let mine = self.0.entry(row).or_default();
            mine.heard = (mine.heard.0 + marks.heard.0, mine.heard.1 + marks.heard.1);
            mine.breaks += marks.breaks;
            mine.latency.extend(marks.latency);
            mine.release.extend(marks.release);
            mine.ghosts += marks.ghosts;
            mine.hours += marks.hours;
        }
    }

    /// Row of a recording: breaths by their noise, the rest by their kind; ambiguous ones have none.
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
        self.0.iter().try_for_each(|(row, marks)| writeln!(f, "{row:38} {marks}"))
    }
}

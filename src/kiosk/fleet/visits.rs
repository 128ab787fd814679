//! Visits: when they began and how long they lasted. Counts and times only, nothing about a person.

use serde::{Deserialize, Serialize};

/// Upper bounds of the histogram of visit lengths, s.
pub const DWELL_S: &[f64] = &[5.0, 10.0, 20.0, 30.0, 60.0, 120.0, 180.0, 300.0, 600.0, 1200.0];
/// Upper bounds of the histogram of times between frames, s.
pub const FRAME_S: &[f64] =
    &[0.009, 0.012, 0.017, 0.02, 0.025, 0.034, 0.05, 0.067, 0.08, 0.1, 0.125, 0.15, 0.2, 0.25, 0.35, 0.5, 1.0];

/// Histogram: counts of values between bounds.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Histogram {
    /// Count of values up to each bound, and beyond the last one.
    pub counts: Vec<u64>,
    /// Sum of all values.
    pub sum: f64,
}

impl Histogram {
    /// Counts a value; `bounds` ascend.
    pub fn record(&mut self, bounds: &[f64], value: f64) {
        self.counts.resize(bounds.len() + 1, 0);
        self.counts[bounds.partition_point(|bound| *bound < value)] += 1;
        self.sum += value;
    }

    /// Number of values.
    pub fn total(&self) -> u64 {
        self.counts.iter().sum()
    }
}

/// Detects visits from inputs and breaths.
#[derive(Clone, Debug, Default)]
pub struct VisitCounter {
    /// Begin and last input of the present visit, s.
    running: Option<(f64, f64)>,
    activity: u64,
    language: String,
}

/// Signs of a visitor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct VisitorSigns {
    /// Number of inputs so far.
    pub inputs: u64,
    /// Does somebody blow?
    pub blows: bool,
}

/// A finished visit.
#[derive(Clone, Debug, PartialEq)]
pub struct FinishedVisit {
    /// From the first input to the last, s.
    pub seconds: f64,
    /// Language shown at its end.
    pub language: String,
}

impl VisitCounter {
    /// Records the signs of a visitor at `time`, s. Returns a visit that has ended: `idle_s`, s, after its last sign.
    pub fn record(&mut self, time: f64, signs: VisitorSigns, language: &str, idle_s: f64) -> Option<FinishedVisit> {
        let VisitorSigns { inputs, blows } = signs;
        if inputs != self.activity || blows {
            self.activity = inputs;
            self.running = Some((self.running.map_or(time, |(began, _)| began), time));
            language.clone_into(&mut self.language);
            return None;
        }
        let (began, last) = self.running.filter(|(_, last)| time - last >= idle_s)?;
        self.running = None;
        Some(FinishedVisit { seconds: last - began, language: self.language.clone() })
    }

    /// Is a visit in progress?
    pub fn in_progress(&self) -> bool {
        self.running.is_some()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_visit_lasts_from_the_first_input_to_the_last_and_is_told_once() {
        let mut visits = VisitCounter::default();
        let mut finished = Vec::new();
        for second in 0..300 {
            // Somebody presses at 10, blows at 15 to 20, presses at 70 after leaving for 50 s, and never again.
            let inputs = u64::from(second >= 10) + u64::from(second >= 70);
            let language = if second < 60 { "en" } else { "it" };
            let signs = VisitorSigns { inputs, blows: (15..=20).contains(&second) };
            finished.extend(visits.record(f64::from(second), signs, language, 30.0));
            assert_eq!(visits.in_progress(), (10..50).contains(&second) || (70..100).contains(&second), "{second}");
        }
        let visit = |seconds, language: &str| FinishedVisit { seconds, language: language.into() };
        assert_eq!(finished, [visit(10.0, "en"), visit(0.0, "it")]);
    }

    #[test]
    fn a_histogram_counts_each_number_beside_its_bound() {
        let mut histogram = Histogram::default();
        [0.5, 1.0, 1.1, 9.0].into_iter().for_each(|value| histogram.record(&[1.0, 2.0], value));
        assert_eq!((histogram.counts.clone(), histogram.total()), (vec![2, 1, 1], 4));
        assert_eq!(histogram.sum, 11.6);
    }
}

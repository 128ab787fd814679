//! Visits: when somebody came, and how long they stayed. Counts and times, of nobody in particular.

use serde::{Deserialize, Serialize};

/// Upper bounds of what a visit's length is sorted into, s.
pub const DWELL_S: &[f64] = &[5.0, 10.0, 20.0, 30.0, 60.0, 120.0, 180.0, 300.0, 600.0, 1200.0];
/// Upper bounds of what the time from picture to picture is sorted into, s.
pub const FRAME_S: &[f64] =
    &[0.009, 0.012, 0.017, 0.02, 0.025, 0.034, 0.05, 0.067, 0.08, 0.1, 0.125, 0.15, 0.2, 0.25, 0.35, 0.5, 1.0];

/// How often a number lay between which bounds.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Histogram {
    /// Beside each bound, and beyond the last one.
    pub counts: Vec<u64>,
    /// Of all that was counted.
    pub sum: f64,
}

impl Histogram {
    /// Counts a number among these bounds, which ascend.
    pub fn note(&mut self, bounds: &[f64], value: f64) {
        self.counts.resize(bounds.len() + 1, 0);
        self.counts[bounds.partition_point(|bound| *bound < value)] += 1;
        self.sum += value;
    }

    /// How many numbers were counted.
    pub fn total(&self) -> u64 {
        self.counts.iter().sum()
    }
}

/// The visit that goes on, if one does.
#[derive(Clone, Debug, Default)]
pub struct Visits {
    /// When it began and when somebody last did something, s.
    running: Option<(f64, f64)>,
    activity: u64,
    language: String,
}

/// A visit that is over.
#[derive(Clone, Debug, PartialEq)]
pub struct Visit {
    /// From the first input to the last, s.
    pub seconds: f64,
    /// Language that was shown at the last.
    pub language: String,
}

impl Visits {
    /// At `time`, s: so many inputs were seen so far, and somebody blows or not. A visit is over `idle_s` after the last.
    pub fn note(&mut self, time: f64, (inputs, blows): (u64, bool), language: &str, idle_s: f64) -> Option<Visit> {
        if inputs != self.activity || blows {
            self.activity = inputs;
            self.running = Some((self.running.map_or(time, |(began, _)| began), time));
            language.clone_into(&mut self.language);
            return None;
        }
        let (began, last) = self.running.filter(|(_, last)| time - last >= idle_s)?;
        self.running = None;
        Some(Visit { seconds: last - began, language: self.language.clone() })
    }

    /// Is somebody here?
    pub fn goes_on(&self) -> bool {
        self.running.is_some()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_visit_lasts_from_the_first_input_to_the_last_and_is_told_once() {
        let mut visits = Visits::default();
        let mut told = Vec::new();
        for second in 0..300 {
            // Somebody presses at 10, blows at 15 to 20, presses at 70 after leaving for 50 s, and never again.
            let inputs = u64::from(second >= 10) + u64::from(second >= 70);
            let language = if second < 60 { "en" } else { "it" };
            let seen = (inputs, (15..=20).contains(&second));
            told.extend(visits.note(f64::from(second), seen, language, 30.0));
            assert_eq!(visits.goes_on(), (10..50).contains(&second) || (70..100).contains(&second), "{second}");
        }
        let visit = |seconds, language: &str| Visit { seconds, language: language.into() };
        assert_eq!(told, [visit(10.0, "en"), visit(0.0, "it")]);
    }

    #[test]
    fn a_histogram_counts_each_number_beside_its_bound() {
        let mut histogram = Histogram::default();
        [0.5, 1.0, 1.1, 9.0].into_iter().for_each(|value| histogram.note(&[1.0, 2.0], value));
        assert_eq!((histogram.counts.clone(), histogram.total()), (vec![2, 1, 1], 4));
        assert_eq!(histogram.sum, 11.6);
    }
}

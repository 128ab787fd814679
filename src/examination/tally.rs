//! Rows of the table: shares, rates, times and correlations with 95 % bounds.

use std::collections::BTreeMap;
use std::fmt;

use serde::Serialize;
use soffio_soundscape::statistics::{poisson, quantile, spearman, wilson};

/// Part of the table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
pub enum Section {
    /// Breaths through a plain microphone.
    Breaths,
    /// The same breaths through other microphones.
    Microphones,
    /// Noises without breath.
    Noises,
    /// Draughts, and breaths in them.
    Draughts,
    /// The kiosk's own sound.
    Kiosk,
}

/// One row.
#[derive(Clone, Debug, PartialEq)]
pub enum Row {
    /// Hits of all.
    Share {
        /// Hits.
        hits: usize,
        /// All.
        all: usize,
    },
    /// Events in some hours.
    Rate {
        /// Events.
        events: usize,
        /// Time, h.
        hours: f64,
    },
    /// Times, s.
    Times(Vec<f64>),
    /// Pairs of true and reported values.
    Pairs(Vec<(f64, f64)>),
}

/// All rows by section and name.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tally(BTreeMap<(Section, String), Row>);

/// What a row says.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Line {
    /// Part of the table.
    pub section: Section,
    /// Name of the row.
    pub name: String,
    /// Share, events an hour, median time (s) or rank correlation.
    pub value: f64,
    /// 95 % bounds; of times the median and the ninth decile.
    pub bounds: (f64, f64),
    /// Number of breaths, events, times or pairs.
    pub count: usize,
}

impl Tally {
    fn row(&mut self, section: Section, name: &str, empty: Row) -> &mut Row {
        self.0.entry((section, name.to_owned())).or_insert(empty)
    }

    /// Counts a hit or a miss.
    pub fn share(&mut self, section: Section, name: &str, hit: bool) {
        if let Row::Share { hits, all } = self.row(section, name, Row::Share { hits: 0, all: 0 }) {
            *hits += usize::from(hit);
            *all += 1;
        }
    }

    /// Counts events in a time, s.
    pub fn rate(&mut self, section: Section, name: &str, count: usize, seconds: f64) {
        if let Row::Rate { events, hours } = self.row(section, name, Row::Rate { events: 0, hours: 0.0 }) {
            *events += count;
            *hours += seconds / 3600.0;
        }
    }

    /// Notes a time, s.
    pub fn time(&mut self, section: Section, name: &str, seconds: f64) {
        if let Row::Times(times) = self.row(section, name, Row::Times(Vec::new())) {
            times.push(seconds);
        }
    }

    /// Notes pairs of true and reported values.
    pub fn pairs(&mut self, section: Section, name: &str, more: impl IntoIterator<Item = (f64, f64)>) {
        if let Row::Pairs(pairs) = self.row(section, name, Row::Pairs(Vec::new())) {
            pairs.extend(more);
        }
    }

    /// Adds another tally.
    pub fn add(&mut self, other: Self) {
        for ((section, name), row) in other.0 {
            match (self.0.get_mut(&(section, name.clone())), row) {
                (None, row) => {
                    self.0.insert((section, name), row);
                }
                (Some(Row::Share { hits, all }), Row::Share { hits: h, all: a }) => {
                    *hits += h;
                    *all += a;
                }
                (Some(Row::Rate { events, hours }), Row::Rate { events: e, hours: h }) => {
                    *events += e;
                    *hours += h;
                }
                (Some(Row::Times(times)), Row::Times(more)) => times.extend(more),
                (Some(Row::Pairs(pairs)), Row::Pairs(more)) => pairs.extend(more),
                (Some(_), _) => debug_assert!(false, "{name} is of two kinds"),
            }
        }
    }

    /// Lines of the table in order.
    pub fn lines(&self) -> Vec<Line> {
        let line = |((section, name), row): (&(Section, String), &Row)| {
            let (value, bounds, count) = match row {
                Row::Share { hits, all } => (*hits as f64 / (*all).max(1) as f64, wilson(*hits, *all), *all),
                Row::Rate { events, hours } => {
                    let (low, high) = poisson(*events);
                    (*events as f64 / hours, (low / hours, high / hours), *events)
                }
                Row::Times(times) => {
                    let [median, ninth] = [0.5, 0.9].map(|part| quantile(times, part));
                    (median, (median, ninth), times.len())
                }
                Row::Pairs(pairs) => {
                    let r = spearman(pairs);
                    (r, fisher(r, pairs.len()), pairs.len())
                }
            };
            Line { section: *section, name: name.clone(), value, bounds, count }
        };
        self.0.iter().map(line).collect()
    }

    /// A line by its name.
    pub fn line(&self, section: Section, name: &str) -> Option<Line> {
        self.lines().into_iter().find(|line| line.section == section && line.name == name)
    }
}

/// 95 % bounds of a correlation of independent pairs (Fisher 1921).
fn fisher(r: f64, pairs: usize) -> (f64, f64) {
    /// Two-sided 95 % of the normal distribution.
    const Z: f64 = 1.959_964;
    let z = 0.5 * soffio_math::ln((1.0 + r) / (1.0 - r).max(1e-12));
    let half = Z / (pairs.max(4) as f64 - 3.0).sqrt();
    (soffio_math::tanh(z - half), soffio_math::tanh(z + half))
}

impl fmt::Display for Tally {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut section = None;
        for (line, row) in self.lines().iter().zip(self.0.values()) {
            if section != Some(line.section) {
                writeln!(f, "\n{:?}", line.section)?;
                section = Some(line.section);
            }
            let Line { name, value, bounds: (low, high), count, .. } = line;
            match row {
                Row::Share { .. } => writeln!(
                    f,
                    "  {name:58} {:6.1} %   {:5.1} … {:5.1} %   of {count}",
                    100.0 * value,
                    100.0 * low,
                    100.0 * high
                )?,
                Row::Rate { hours, .. } => {
                    writeln!(f, "  {name:58} {value:6.1} /h  {low:5.1} … {high:5.1} /h  in {hours:.2} h")?;
                }
                Row::Times(_) => writeln!(f, "  {name:58} {value:6.3} s   p90 {high:.3} s   of {count}")?,
                Row::Pairs(_) => writeln!(f, "  {name:58} {value:6.2}     {low:5.2} … {high:5.2}     of {count}")?,
            }
        }
        Ok(())
    }
}

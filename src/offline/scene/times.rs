//! Processor time of each step of a run.
//!
//! The same steps are run several times, and the least time of each counts, since other work on the machine only adds
//! time.

use cpu_time::ThreadTime;
use serde::Serialize;

use super::run::Engine;

/// Least time of each step so far, µs.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StepTimes {
    us: Vec<f64>,
}

/// Summary of the step times, µs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct TimesReport {
    /// Mean.
    pub mean_us: f64,
    /// Median.
    pub p50_us: f64,
    /// 99th percentile.
    pub p99_us: f64,
    /// Maximum.
    pub p100_us: f64,
    /// Index of the slowest step, from 0.
    pub worst_step: usize,
}

impl StepTimes {
    /// Runs and times the next step of the first round.
    pub fn time<T>(&mut self, step: impl FnOnce() -> T) -> T {
        let (seconds, out) = timed(step);
        self.us.push(1e6 * seconds);
        out
    }

    /// Runs all steps again in an engine at its start; the least time of each step counts.
    pub fn repeat(&mut self, engine: &mut (impl Engine + ?Sized)) {
        self.repeat_with(|_| engine.step());
    }

    /// As [`Self::repeat`], with a function that runs the step of an index.
    pub fn repeat_with<T>(&mut self, mut step: impl FnMut(usize) -> T) {
        for (index, least) in self.us.iter_mut().enumerate() {
            *least = least.min(1e6 * timed(|| step(index)).0);
        }
    }

    /// Time of each step, µs.
    pub fn us(&self) -> &[f64] {
        &self.us
    }

    /// Mean, percentiles and the slowest step; zeros without steps.
    pub fn report(&self) -> TimesReport {
        let mut sorted = self.us.clone();
        sorted.sort_by(f64::total_cmp);
        // The least time that so many percent of the steps keep to.
        let percentile = |percent: usize| sorted.get((percent * sorted.len()).div_ceil(100).max(1) - 1).copied();
        let worst = (0..self.us.len()).reduce(|worst, step| if self.us[step] > self.us[worst] { step } else { worst });
        TimesReport {
            mean_us: self.us.iter().sum::<f64>() / self.us.len().max(1) as f64,
            p50_us: percentile(50).unwrap_or_default(),
            p99_us: percentile(99).unwrap_or_default(),
            p100_us: percentile(100).unwrap_or_default(),
            worst_step: worst.unwrap_or_default(),
        }
    }
}

impl FromIterator<f64> for StepTimes {
    fn from_iter<I: IntoIterator<Item = f64>>(us: I) -> Self {
        Self { us: us.into_iter().collect() }
    }
}

/// Runs a function; returns its processor time, s, and its result.
pub fn timed<T>(run: impl FnOnce() -> T) -> (f64, T) {
    let start = ThreadTime::now();
    let out = run();
    (start.elapsed().as_secs_f64(), out)
}

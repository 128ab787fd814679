//! The rendered sound of a visit, and what is measured of it.

use soffio_math::{PI, amplitude_to_db, cos};
use soffio_simulation::SAMPLE_RATE;

/// A rendered sound, mono.
pub struct Sound {
    pub samples: Vec<f64>,
}

impl Sound {
    /// The samples from `from` to `to`, s.
    pub fn span(&self, from: f64, to: f64) -> &[f64] {
        let [first, last] = [from, to].map(|t| ((t * f64::from(SAMPLE_RATE)) as usize).min(self.samples.len()));
        &self.samples[first..last]
    }

    /// Level from `from` to `to`, dB of full scale (root mean square); −∞ for silence.
    pub fn level(&self, from: f64, to: f64) -> f64 {
        let span = self.span(from, to);
        let power = span.iter().map(|x| x * x).sum::<f64>() / span.len().max(1) as f64;
        amplitude_to_db(power.sqrt())
    }

    /// Mean rate of its oscillation from `from` to `to`, Hz: half of the changes of sign a second.
    pub fn rate(&self, from: f64, to: f64) -> f64 {
        let span = self.span(from, to);
        let changes = span.windows(2).filter(|pair| pair[0] * pair[1] < 0.0).count();
        0.5 * changes as f64 / (to - from)
    }

    /// The strongest frequency between two, in whole Hz, from `from` to `to`, s: Goertzel's filter at each.
    pub fn strongest(&self, between: (u32, u32), from: f64, to: f64) -> f64 {
        let span = self.span(from, to);
        let power = |frequency: f64| {
            let turn = 2.0 * cos(2.0 * PI * frequency / f64::from(SAMPLE_RATE));
            let (one, two) = span.iter().fold((0.0, 0.0), |(one, two), x| (x + turn * one - two, one));
            one * one + two * two - turn * one * two
        };
        let best = (between.0..=between.1).map(f64::from).max_by(|a, b| power(*a).total_cmp(&power(*b)));
        best.expect("a frequency")
    }

    /// Time of the loudest sample, s.
    pub fn loudest(&self) -> f64 {
        let loudest = self.samples.iter().enumerate().max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()));
        loudest.map_or(0.0, |(index, _)| index as f64 / f64::from(SAMPLE_RATE))
    }
}

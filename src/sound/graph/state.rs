//! What one operator of one voice remembers.

use crate::timbre::{FilterKind, LONGEST_DELAY};
use soffio_math::noise::Random;

/// Sections of the pink filter.
pub(super) const PINK: usize = 6;

/// What one operator of one voice remembers.
#[derive(Clone)]
pub(crate) struct State {
    /// Level now, and its change per sample.
    pub gain: f64,
    pub gain_step: f64,
    /// Whether anything that is heard takes this operator.
    pub needed: bool,
    pub(super) random: Random,
    /// Env, slow noise and texture: value now; env: factor per sample; others: change per sample.
    pub value: f64,
    pub(super) change: f64,
    /// Env: rise per sample until it is 1; 0 afterwards.
    pub(super) rise: f64,
    /// Slow noise: its seed, and how many octaves are heard.
    pub(super) seed: u64,
    pub(super) octaves: u32,
    /// Slow noise at audio rate: its time and step. Texture: place on the line, in points.
    pub(super) place: f64,
    pub(super) step: f64,
    /// Texture: level of the pyramid and its change per sample; points left of this piece, and the place on the next.
    pub(super) level: [f64; 2],
    pub(super) left: f64,
    pub(super) next: Option<f64>,
    /// Filter: the two integrators, and the coefficients.
    pub(super) integrators: [f64; 2],
    pub(super) g: f64,
    pub(super) damping: f64,
    pub(super) shrink: f64,
    /// Pink noise: memories of its sections.
    pub(super) pink: [f64; PINK],
    /// Delay: the line, how much of it is in use, and the sample that comes out next.
    pub(super) line: Vec<f32>,
    pub(super) used: usize,
    pub(super) at: usize,
    /// Samples until what is on the line has come out.
    pub(super) held: usize,
}

impl State {
    /// At rest.
    pub fn new(seed: u64) -> Self {
        Self {
            gain: 0.0,
            gain_step: 0.0,
            needed: false,
            random: Random::new(seed),
            value: 0.0,
            change: 0.0,
            rise: 0.0,
            seed: 0,
            octaves: 0,
            place: 0.0,
            step: 0.0,
            level: [0.0; 2],
            left: f64::INFINITY,
            next: None,
            integrators: [0.0; 2],
            g: 0.0,
            damping: 1.0,
            shrink: 1.0,
            pink: [0.0; PINK],
            line: Vec::new(),
            used: 0,
            at: 0,
            held: 0,
        }
    }

    /// Whether something is still to come out that went in.
    pub fn holds(&self) -> bool {
        self.held > 0
    }

    /// At rest again; the room of a delay stays. Real-time.
    pub fn reset(&mut self, seed: u64) {
        let line = std::mem::take(&mut self.line);
        *self = Self { line, ..Self::new(seed) };
    }

    /// Room for the longest delay. Allocates.
    pub(super) fn make_room(&mut self, sample_rate: f64) {
        let longest = (LONGEST_DELAY * sample_rate) as usize + 1;
        if self.line.len() < longest {
            self.line.resize(longest, 0.0);
        }
    }

    /// One sample of the state-variable filter by trapezoidal integration (Zavalishin, "The Art of VA Filter Design",
    /// 2018, 4.1): stable under any change of its coefficients. g = tan(π f/fs), damping = 1/Q,
    /// shrink = 1/(1 + g (damping + g)). The one-pole is the same with one integrator.
    pub(super) fn filter(&mut self, x: f64, kind: FilterKind) -> f64 {
        let [s1, s2] = self.integrators;
        let (g, damping) = (self.g, self.damping);
        if kind == FilterKind::OnePole {
            let v = (x - s1) * g / (1.0 + g);
            let low = v + s1;
            self.integrators[0] = low + v;
            return low;
        }
        let high = (x - (damping + g) * s1 - s2) * self.shrink;
        let band = g * high + s1;
        let low = g * band + s2;
        self.integrators = [2.0 * band - s1, 2.0 * low - s2];
        match kind {
            FilterKind::LowPass | FilterKind::OnePole => low,
            FilterKind::BandPass => damping * band,
            FilterKind::HighPass => high,
        }
    }
}

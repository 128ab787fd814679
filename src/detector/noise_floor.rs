//! Noise floor of each band, and how far the band usually stands above it.
//!
//! ```text
//! F ← F + (Δt / τ↑) · min(l − F, M)         where l > F      floor, dB
//! F ← F + (Δt / τ↓) · (l − F)               where l ≤ F
//! s² ← s² + (Δt / τ_s) · (min(l − F, R)² − s²)                spread about the floor, dB²
//! ```
//!
//! Symbols: l level of the band, dB of full scale; τ↑, τ↓, τ_s time constants; M the largest step that raises the floor, R the
//! largest rise that counts. The bound M/τ↑ is 0.75 dB a second, so a breath of five seconds hardly lowers its own rise.
//!
//! The rise l − F says how loud a sound is here and now. The quotient (l − F)/s says how unusual it is in this room: in a draught
//! the level of turbulence jumps by 20 dB all the time, and s learns that within two minutes. A breath must exceed it.
//! Nothing is frozen during a breath: the training sees the same floors as a gallery.
//!
//! The asymmetric average follows minimum statistics (Martin, "Noise power spectral density estimation", IEEE Trans. Speech
//! Audio Process. 9, 2001) without its search over a window.

use super::spectrum::FRAME_S;

/// Time constant of a rising floor τ↑, s.
const UP_S: f64 = 8.0;
/// Time constant of a falling floor τ↓, s: a crowd that leaves is forgotten at once.
const DOWN_S: f64 = 1.0;
/// Largest step M that raises the floor, dB.
const MOST_UP_DB: f64 = 6.0;
/// Time constant of the spread τ_s, s.
const SPREAD_S: f64 = 120.0;
/// Largest rise R in the spread, dB: one slam must not count for minutes.
const MOST_SPREAD_DB: f64 = 25.0;
/// Spread at first, dB, and the time for which it counts, s: that of noise in bands of a few bins.
const FIRST_SPREAD: (f64, f64) = (6.0, 20.0);
/// Time in which the first floor is a plain mean, s.
const FIRST_S: f64 = 0.25;

/// Floor and spread of `N` bands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Floor<const N: usize> {
    /// F, dB of full scale.
    pub level: [f64; N],
    /// s², dB².
    spread: [f64; N],
    /// Time that has been learnt, s.
    seconds: f64,
    /// Time for which the spreads were learnt in an earlier run, s.
    recalled_s: f64,
}

/// Spreads of the bands and how long they were learnt: what is worth keeping of a room.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spreads<const N: usize> {
    /// s of each band, dB.
    pub db: [f64; N],
    /// Time in which they were learnt, s; at most τ_s.
    pub seconds: f64,
}

impl<const N: usize> Floor<N> {
    /// Nothing is known yet.
    pub(crate) fn new() -> Self {
        Self { level: [0.0; N], spread: [FIRST_SPREAD.0 * FIRST_SPREAD.0; N], seconds: 0.0, recalled_s: 0.0 }
    }

    /// True until a first floor is known.
    pub fn is_settling(&self) -> bool {
        self.seconds < FIRST_S
    }

    /// Learns the levels of one frame, dB of full scale.
    pub fn learn(&mut self, levels: &[f64; N]) {
        self.seconds += FRAME_S;
        let first = FRAME_S / self.seconds;
        let spread_weight = FRAME_S / (self.recalled_s + self.seconds + FIRST_SPREAD.1).min(SPREAD_S);
        for ((floor, spread), level) in self.level.iter_mut().zip(&mut self.spread).zip(levels) {
            let rise = level - *floor;
            if self.seconds < FIRST_S {
                *floor += first * rise;
                continue;
            }
            *floor += if rise > 0.0 { FRAME_S / UP_S * rise.min(MOST_UP_DB) } else { FRAME_S / DOWN_S * rise };
            let counted = rise.clamp(-MOST_SPREAD_DB, MOST_SPREAD_DB);
            *spread += spread_weight * (counted * counted - *spread);
        }
    }

    /// Takes these levels as the floor: what seemed to be a breath is none.
    pub fn adopt(&mut self, levels: &[f64; N]) {
        self.level = *levels;
    }

    /// Rise of a band over its floor, dB.
    pub fn rise(&self, band: usize, level: f64) -> f64 {
        level - self.level[band]
    }

    /// s, dB.
    pub fn spread(&self, band: usize) -> f64 {
        self.spread[band].sqrt()
    }

    /// All spreads, and the time in which they were learnt.
    pub fn spreads(&self) -> Spreads<N> {
        Spreads { db: std::array::from_fn(|b| self.spread(b)), seconds: (self.recalled_s + self.seconds).min(SPREAD_S) }
    }

    /// Begins with the spreads of an earlier run; the level is learnt anew. Numbers that no room gives change nothing: below 0 or above R.
    pub fn recall(&mut self, spreads: &Spreads<N>) {
        if spreads.seconds >= 0.0 && spreads.db.iter().all(|db| (0.0..=MOST_SPREAD_DB).contains(db)) {
            self.spread = spreads.db.map(|db| db * db);
            self.recalled_s = spreads.seconds.min(SPREAD_S);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use soffio_math::noise::Random;

    fn learn(floor: &mut Floor<1>, seconds: f64, mut level: impl FnMut() -> f64) {
        (0..(seconds / FRAME_S) as usize).for_each(|_| floor.learn(&[level()]));
    }

    #[test]
    fn a_breath_of_five_seconds_hardly_raises_it_and_a_crowd_that_leaves_is_forgotten() {
        let mut floor = Floor::new();
        learn(&mut floor, 30.0, || -60.0);
        learn(&mut floor, 5.0, || -20.0);
        let raised = floor.level[0] + 60.0;
        assert!((raised - 5.0 * MOST_UP_DB / UP_S).abs() < 0.05, "{raised} dB, not 0.75 dB a second");
        learn(&mut floor, 3.0 * DOWN_S, || -60.0);
        assert!(floor.level[0] < -59.8, "{} dB", floor.level[0]);
    }

    #[test]
    fn gusts_become_usual_within_three_minutes() {
        let (mut floor, mut random) = (Floor::new(), Random::new(4));
        learn(&mut floor, 60.0, || -60.0);
        let strange = |floor: &Floor<1>| 15.0 / floor.spread(0);
        // After 60 s a quarter of the first variance is left: 20 s of 80 s.
        let expected = 15.0 / (0.5 * FIRST_SPREAD.0);
        assert!((strange(&floor) - expected).abs() < 0.1, "in a still room: {}", strange(&floor));
        learn(&mut floor, 180.0, || if random.unit() < 0.3 { -45.0 } else { -60.0 });
        assert!(strange(&floor) < 2.2, "in a draught: {}", strange(&floor));
        // Another run begins with what this one knows, and learns the level of another gain at once.
        let mut next = Floor::new();
        next.recall(&floor.spreads());
        learn(&mut next, 1.0, || -40.0);
        assert!((next.spread(0) - floor.spread(0)).abs() < 0.2 && (next.level[0] + 40.0).abs() < 0.1, "{next:?}");
        next.recall(&Spreads { db: [f64::NAN], seconds: 60.0 });
        assert!((next.spread(0) - floor.spread(0)).abs() < 0.2, "no number is no spread");
    }
}

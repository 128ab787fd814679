//! Absorption filters of the delay lines: frequency-dependent decay of a feedback delay network.
//!
//! A line of m samples that is passed once every m/fs seconds loses 60 dB in T(f) when each pass loses
//! (Jot and Chaigne, "Digital delay networks for designing artificial reverberators", 90th AES Convention, 1991)
//!
//! ```text
//! G(f) = −60 m / (fs T(f))   dB
//! ```
//!
//! T is asked for at seven octaves. The line's filter is a gain and six second-order shelves, one where two octaves meet,
//! each of which raises frequencies above its corner by a factor h (with A = √h, w = tan(π f/fs), Butterworth's flanks):
//!
//! ```text
//! H(s) = A (A s² + √(2A) w s + w²)/(s² + √(2A) w s + A w²)      s = (1 − z⁻¹)/(1 + z⁻¹)
//! ```
//!
//! which is 1 far below the corner, h far above, and √h at it. The shelves overlap, so their gains are found together:
//! Newton's method on the seven levels in dB at the octaves' centres, with the slopes of the levels by differences. At the
//! centres the decay is then exact, and between them it runs from one to the next.
//!
//! | symbol | here | unit |
//! |---|---|---|
//! | T(f) | `t60` | s |
//! | G(f) | `target` | dB |
//! | h | `rise`, in dB | 1 |

use super::lines::{BANDS, LINES};
use soffio_math::{PI, amplitude_to_db, db_to_amplitude, sincos, sqrt};

/// Shelves of a line: one between two octaves.
pub(super) const SHELVES: usize = BANDS.len() - 1;
/// Iterations of Newton's method; four leave less than 10⁻⁹ dB for all valid specifications.
const ROUNDS: usize = 8;
/// Step of the finite differences, dB: small beside the levels and large beside their rounding.
const STEP: f64 = 1e-3;
/// Greatest gain of a line at any frequency, dB: below 0, so that every sound decays.
const MAX_GAIN_DB: f64 = -1e-3;

/// y = b0 x + s₁, s₁ ← b1 x − a1 y + s₂, s₂ ← b2 x − a2 y: b0, b1, b2, a1, a2.
type Shelf = [f64; 5];

/// 0 dB far below the corner (Hz), `rise` dB far above, half of it at the corner.
fn shelf(corner: f64, rise: f64, sample_rate: f64) -> Shelf {
    let a = db_to_amplitude(0.5 * rise);
    let (s, c) = sincos(PI * corner / sample_rate);
    let w = s / c;
    let (damping, square) = (sqrt(2.0 * a) * w, w * w);
    let norm = 1.0 / (1.0 + damping + a * square);
    [
        a * (a + damping + square) * norm,
        2.0 * a * (square - a) * norm,
        a * (a - damping + square) * norm,
        2.0 * (a * square - 1.0) * norm,
        (1.0 - damping + a * square) * norm,
    ]
}

/// Level of a shelf at a frequency, dB.
fn shelf_level(shelf: &Shelf, frequency: f64, sample_rate: f64) -> f64 {
    let (s, c) = sincos(2.0 * PI * frequency / sample_rate);
    // |b0 + b1 z⁻¹ + b2 z⁻²|² with z⁻² turned back by one: (b0 + b2) c + b1 and (b0 − b2) s.
    let size = |b0: f64, b1: f64, b2: f64| {
        let (re, im) = ((b0 + b2) * c + b1, (b0 - b2) * s);
        re * re + im * im
    };
    let [b0, b1, b2, a1, a2] = *shelf;
    0.5 * amplitude_to_db(size(b0, b1, b2) / size(1.0, a1, a2))
}

/// Filter of one line.
#[derive(Clone, Copy, Debug)]
pub(super) struct Absorption {
    /// dB.
    gain: f64,
    /// dB, of each shelf.
    rises: [f64; SHELVES],
}

impl Absorption {
    /// For a line of so many samples in a room of these decay times, s.
    pub fn new(samples: usize, t60: &[f64; BANDS.len()], sample_rate: f64) -> Self {
        let target = t60.map(|t| -60.0 * samples as f64 / (sample_rate * t));
        let mut filter = Self { gain: target[0], rises: [0.0; SHELVES] };
        for _ in 0..ROUNDS {
            let now = filter.levels(sample_rate);
            // One row a centre: slopes of its level, and what it lacks.
            let mut rows = [[0.0; BANDS.len() + 1]; BANDS.len()];
            for unknown in 0..BANDS.len() {
                let mut moved = filter;
                *moved.number(unknown) += STEP;
                for (row, (after, before)) in rows.iter_mut().zip(moved.levels(sample_rate).iter().zip(&now)) {
                    row[unknown] = (after - before) / STEP;
                }
            }
            for (row, (target, now)) in rows.iter_mut().zip(target.iter().zip(&now)) {
                row[BANDS.len()] = target - now;
            }
            solve(&mut rows);
            for (unknown, row) in rows.iter().enumerate() {
                *filter.number(unknown) += row[BANDS.len()];
            }
        }
        filter
    }

    /// The gain, or the rise of a shelf.
    fn number(&mut self, index: usize) -> &mut f64 {
        match index {
            0 => &mut self.gain,
            _ => &mut self.rises[index - 1],
        }
    }

    /// The shelves as they filter, and the gain, linear.
    pub fn filters(&self, sample_rate: f64) -> (f64, [Shelf; SHELVES]) {
        let one = |i: usize| shelf(corner(i, sample_rate), self.rises[i], sample_rate);
        (db_to_amplitude(self.gain), std::array::from_fn(one))
    }

    /// Level at a frequency, dB.
    pub fn level(&self, frequency: f64, sample_rate: f64) -> f64 {
        let (_, shelves) = self.filters(sample_rate);
        self.gain + shelves.iter().map(|shelf| shelf_level(shelf, frequency, sample_rate)).sum::<f64>()
    }

    fn levels(&self, sample_rate: f64) -> [f64; BANDS.len()] {
        let (_, shelves) = self.filters(sample_rate);
        BANDS.map(|band| {
            let frequency = centre(band, sample_rate);
            self.gain + shelves.iter().map(|shelf| shelf_level(shelf, frequency, sample_rate)).sum::<f64>()
        })
    }

    /// Does it take something at every frequency?
    pub fn decays(&self, sample_rate: f64) -> bool {
        // Twelve to the octave from 20 Hz to half the rate, and both ends.
        let mut frequency = 20.0;
        let ratio = db_to_amplitude(6.020_599_913_279_624 / 12.0);
        let mut loudest = self.level(0.0, sample_rate).max(self.level(0.5 * sample_rate, sample_rate));
        while frequency < 0.5 * sample_rate {
            loudest = loudest.max(self.level(frequency, sample_rate));
            frequency *= ratio;
        }
        loudest <= MAX_GAIN_DB
    }
}

/// Where two octaves meet.
fn corner(shelf: usize, sample_rate: f64) -> f64 {
    sqrt(centre(BANDS[shelf], sample_rate) * centre(BANDS[shelf + 1], sample_rate))
}

/// The octave's centre, inside what a slow device can play.
fn centre(band: f64, sample_rate: f64) -> f64 {
    band * (sample_rate / 20_000.0).min(1.0)
}

/// Gauss and Jordan, rows by their largest; the answer is the last column.
fn solve(rows: &mut [[f64; BANDS.len() + 1]; BANDS.len()]) {
    for column in 0..BANDS.len() {
        let largest = (column..BANDS.len()).max_by(|&a, &b| rows[a][column].abs().total_cmp(&rows[b][column].abs()));
        rows.swap(column, largest.unwrap_or(column));
        let pivot = rows[column][column];
        rows[column].iter_mut().for_each(|x| *x /= pivot);
        let lead = rows[column];
        for (_, row) in rows.iter_mut().enumerate().filter(|(i, _)| *i != column) {
            let factor = row[column];
            row.iter_mut().zip(&lead).for_each(|(x, l)| *x -= factor * l);
        }
    }
}

/// Filters of all lines, side by side as the network runs them. The b0 of all shelves are taken out and what passes a shelf
/// as it is goes beside it, which leaves four products and four sums:
///
/// ```text
/// H/b0 = 1 + (c1 z⁻¹ + c2 z⁻²)/(1 + a1 z⁻¹ + a2 z⁻²)        c = b/b0 − a
/// ```
pub(super) struct Absorptions {
    /// Of the line, with the b0 of its shelves.
    pub gain: [f32; LINES],
    /// By shelf: c1, c2, a1, a2.
    pub shelves: [[[f32; LINES]; 4]; SHELVES],
}

impl Absorptions {
    /// For lines of these lengths; `None` where one would not decay at some frequency.
    pub fn new(lengths: &[usize; LINES], t60: &[f64; BANDS.len()], sample_rate: f64) -> Option<Self> {
        let mut all = Self { gain: [0.0; LINES], shelves: [[[0.0; LINES]; 4]; SHELVES] };
        for (line, &length) in lengths.iter().enumerate() {
            let filter = Absorption::new(length, t60, sample_rate);
            if !filter.decays(sample_rate) {
                return None;
            }
            let (gain, shelves) = filter.filters(sample_rate);
            all.gain[line] = shelves.iter().fold(gain, |gain, [b0, ..]| gain * b0) as f32;
            for (to, [b0, b1, b2, a1, a2]) in all.shelves.iter_mut().zip(shelves) {
                for (to, from) in to.iter_mut().zip([b1 / b0 - a1, b2 / b0 - a2, a1, a2]) {
                    to[line] = from as f32;
                }
            }
        }
        Some(all)
    }
}

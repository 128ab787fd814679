//! A circular membrane that is held at its rim: a drum's head.
//!
//! ```text
//! f_mn = (j_mn/j_01) f_01        J_m(j_mn) = 0        φ = N_m J_m(j_mn r) cos m(θ − θ₀) / |J_{m+1}(j_mn)|
//! ```
//!
//! with r the distance from the centre over the radius, and N₀ = 1, N_m = √2, so that φ² is 1 in the mean (Rayleigh, *The Theory of
//! Sound*, chapter 9). Of the two modes of each m ≥ 1, a hit excites the one whose antinode it lies on, so θ = θ₀. A hit on the centre
//! excites m = 0 alone; one near the rim hardly the lowest, which hardly moves there.

use super::limits::{HIGHEST, T60_DECAYS};
use super::mode::Mode;
use super::shape::Shape;
use crate::timbre::Membrane;
use soffio_math::{ln, pow};

/// Step in which a sign of J is looked for: its zeros are π apart, or a little more.
const STEP: f64 = 0.5;
/// Halvings of a step until a zero is known to the last digits.
const HALVINGS: usize = 50;

/// The first zero of J₀.
pub const FIRST_ZERO: f64 = 2.404_825_557_695_773;

/// Modes (m, n) as zeros of J_m up to `highest`, ascending.
pub fn zeros(highest: f64) -> Vec<(i32, f64)> {
    let mut zeros = Vec::new();
    for m in 0.. {
        // The first zero of J_m lies above m.
        let mut low = f64::from(m).max(STEP);
        if low > highest {
            break;
        }
        while low < highest {
            let high = low + STEP;
            if libm::jn(m, low) * libm::jn(m, high) < 0.0 {
                zeros.push((m, bisected(m, low, high)));
            }
            low = high;
        }
    }
    zeros.retain(|(_, zero)| *zero <= highest);
    zeros.sort_by(|a, b| a.1.total_cmp(&b.1));
    zeros
}

/// The zero of J_m between two places of unlike sign.
fn bisected(m: i32, mut low: f64, mut high: f64) -> f64 {
    let sign = libm::jn(m, low);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if libm::jn(m, middle) * sign > 0.0 { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// The lowest `count` partials of the membrane at its own radius, ascending.
pub(super) fn partials(membrane: &Membrane, count: usize) -> Vec<Mode> {
    let Membrane { fundamental, t60, high, tilt, .. } = *membrane;
    let [c_low, c_high] = t60.map(|t60| T60_DECAYS / t60);
    let slope = (c_high - c_low) / (high * high - fundamental * fundamental);
    // About z²/8 zeros lie below z.
    let reach = (FIRST_ZERO * HIGHEST / fundamental).min(10.0 + (10.0 * count as f64).sqrt());
    let mut modes: Vec<Mode> = zeros(reach)
        .into_iter()
        .take(count)
        .map(|(m, zero)| {
            let frequency = fundamental * zero / FIRST_ZERO;
            let octaves = ln(frequency / fundamental) / ln(2.0);
            Mode {
                frequency,
                decay: c_low + slope * (frequency * frequency - fundamental * fundamental),
                amplitude: pow(10.0, tilt * octaves / 20.0),
                shape: Shape::Membrane { order: m, zero, over: norm(m, zero) },
            }
        })
        .collect();
    let power: f64 = modes.iter().map(|mode| mode.amplitude * mode.amplitude).sum();
    modes.iter_mut().for_each(|mode| mode.amplitude /= power.sqrt());
    modes
}

/// N_m/|J_{m+1}(j_mn)|.
fn norm(m: i32, zero: f64) -> f64 {
    let pairs = if m == 0 { 1.0 } else { std::f64::consts::SQRT_2 };
    pairs / libm::jn(m + 1, zero).abs()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zeros_are_bessels_and_their_number_is_weyls() {
        // Abramowitz and Stegun, table 9.5.
        let known = [2.40483, 3.83171, 5.13562, 5.52008, 6.38016, 7.01559, 7.58834, 8.41724, 8.65373, 8.77148];
        let found = zeros(60.0);
        for (zero, known) in found.iter().zip(known) {
            assert!((zero.1 - known).abs() < 6e-6, "{zero:?}, not {known}");
        }
        // Weyl: z²/8 of distinct orders, and a rim's part less.
        let weyl = 60.0 * 60.0 / 8.0;
        assert!((found.len() as f64 / weyl - 1.0).abs() < 0.05, "{} zeros, not {weyl}", found.len());
    }

    #[test]
    fn shapes_have_a_mean_square_of_one_and_are_held_at_the_rim() {
        for (m, zero) in zeros(12.0) {
            let shape = |r: f64| norm(m, zero) * libm::jn(m, zero * r);
            let steps = 4000;
            let mean: f64 = (0..steps)
                .map(|i| (i as f64 + 0.5) / steps as f64)
                .map(|r| 2.0 * r * shape(r) * shape(r) / steps as f64)
                .sum::<f64>()
                * if m == 0 { 1.0 } else { 0.5 };
            assert!((mean - 1.0).abs() < 1e-4, "m {m}, zero {zero}: {mean}");
            assert!(shape(1.0).abs() < 1e-9, "it is held");
        }
        assert!((zeros(3.0)[0].1 - FIRST_ZERO).abs() < 1e-12);
    }
}

//! What frames were like lately: a frame alone is doubtful, its means over a tenth and a half of a second make it clear.

use super::bands::blend;

/// Time constants of the means, s.
pub const MEANS_S: [f64; 2] = [0.1, 0.5];
/// Numbers that are told of each that is measured: itself and its means.
pub const TOLD: usize = 1 + MEANS_S.len();

/// Means of so many numbers.
#[derive(Clone, Debug)]
pub struct Means<const N: usize> {
    means: [[f64; N]; MEANS_S.len()],
    begun: bool,
}

impl<const N: usize> Means<N> {
    /// Of nothing yet.
    pub fn new() -> Self {
        Self { means: [[0.0; N]; MEANS_S.len()], begun: false }
    }

    /// Takes in what is measured of a frame, and tells it and its means, the shorter one first: [`TOLD`] times `N` numbers.
    pub fn push(&mut self, measured: &[f64; N], told: &mut [f64]) {
        let begun = std::mem::replace(&mut self.begun, true);
        for (means, seconds) in self.means.iter_mut().zip(MEANS_S) {
            let weight = if begun { blend(seconds) } else { 1.0 };
            means.iter_mut().zip(measured).for_each(|(mean, x)| *mean += weight * (x - *mean));
        }
        let rows = std::iter::once(measured).chain(&self.means);
        told.chunks_exact_mut(N).zip(rows).for_each(|(out, row)| out.copy_from_slice(row));
    }
}

/// What a number is that is told of those of these names, in words.
pub fn name(names: &[&str], told: usize) -> String {
    let over = told.checked_sub(names.len()).map(|i| format!(", mean of {} s", MEANS_S[i / names.len()]));
    format!("{}{}", names[told % names.len()], over.unwrap_or_default())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spectrum::FRAME_S;

    #[test]
    fn a_step_is_told_at_once_and_its_means_follow() {
        let (mut means, mut told) = (Means::new(), [0.0; 2 * TOLD]);
        means.push(&[1.0, 5.0], &mut told);
        assert_eq!(told, [1.0, 5.0, 1.0, 5.0, 1.0, 5.0], "of one frame");
        let frames = 25;
        (0..frames).for_each(|_| means.push(&[2.0, 5.0], &mut told));
        let after = f64::from(frames) * FRAME_S;
        for (row, seconds) in told.chunks(2).skip(1).zip(MEANS_S) {
            let expected = 2.0 - soffio_math::exp(-after / seconds);
            assert!((row[0] - expected).abs() < 1e-12 && row[1] == 5.0, "{row:?} of {seconds} s");
        }
        assert_eq!(told[..2], [2.0, 5.0]);
        assert_eq!([0, 1, 2, 5].map(|i| name(&["a", "b"], i)), ["a", "b", "a, mean of 0.1 s", "b, mean of 0.5 s"]);
    }
}

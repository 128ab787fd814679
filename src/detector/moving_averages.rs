//! Exponential moving averages of features over 0.1 and 0.5 s: single frames scatter, their averages do not.

use super::bands::blend;

/// Time constants of the averages, s.
pub const AVERAGES_S: [f64; 2] = [0.1, 0.5];
/// Outputs per input: the value itself and its averages.
pub const OUTPUTS_PER_INPUT: usize = 1 + AVERAGES_S.len();

/// Moving averages of `N` values.
#[derive(Clone, Debug)]
pub struct MovingAverages<const N: usize> {
    averages: [[f64; N]; AVERAGES_S.len()],
    started: bool,
}

impl<const N: usize> MovingAverages<N> {
    /// Averages that start at the first values.
    pub fn new() -> Self {
        Self { averages: [[0.0; N]; AVERAGES_S.len()], started: false }
    }

    /// Takes one frame's values and writes [`OUTPUTS_PER_INPUT`] times `N` outputs: the values, then their shorter averages, then
    /// their longer ones.
    pub fn push(&mut self, measured: &[f64; N], outputs: &mut [f64]) {
        let started = std::mem::replace(&mut self.started, true);
        for (averages, seconds) in self.averages.iter_mut().zip(AVERAGES_S) {
            let weight = if started { blend(seconds) } else { 1.0 };
            averages.iter_mut().zip(measured).for_each(|(mean, x)| *mean += weight * (x - *mean));
        }
        let rows = std::iter::once(measured).chain(&self.averages);
        outputs.chunks_exact_mut(N).zip(rows).for_each(|(out, row)| out.copy_from_slice(row));
    }
}

/// Name of an output, made from the names of the inputs.
pub fn name(names: &[&str], output: usize) -> String {
    let over = output.checked_sub(names.len()).map(|i| format!(", mean of {} s", AVERAGES_S[i / names.len()]));
    format!("{}{}", names[output % names.len()], over.unwrap_or_default())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spectrum::FRAME_S;

    #[test]
    fn a_step_passes_at_once_and_its_averages_follow() {
        let (mut averages, mut outputs) = (MovingAverages::new(), [0.0; 2 * OUTPUTS_PER_INPUT]);
        averages.push(&[1.0, 5.0], &mut outputs);
        assert_eq!(outputs, [1.0, 5.0, 1.0, 5.0, 1.0, 5.0], "of one frame");
        let frames = 25;
        (0..frames).for_each(|_| averages.push(&[2.0, 5.0], &mut outputs));
        let after = f64::from(frames) * FRAME_S;
        for (row, seconds) in outputs.chunks(2).skip(1).zip(AVERAGES_S) {
            let expected = 2.0 - soffio_math::exp(-after / seconds);
            assert!((row[0] - expected).abs() < 1e-12 && row[1] == 5.0, "{row:?} of {seconds} s");
        }
        assert_eq!(outputs[..2], [2.0, 5.0]);
        assert_eq!([0, 1, 2, 5].map(|i| name(&["a", "b"], i)), ["a", "b", "a, mean of 0.1 s", "b, mean of 0.5 s"]);
    }
}

//! Checks of the generator against formulas and measured facts.

mod air;
mod scenes;
mod signals;

use soffio_fourier::{Complex, real_forward};
use soffio_math::{PI, cos, log10};

/// Window of the spectra, samples: bins of 7.8 Hz.
const WINDOW: usize = 2048;

/// Powers of two signals, and their cross spectrum.
type Spectra = (Vec<f64>, Vec<f64>, Vec<Complex<f64>>);

/// Mean spectra of one or two signals in half-overlapping windows: power of each, and their cross spectrum.
fn spectra(a: &[f32], b: &[f32]) -> Spectra {
    let plan = real_forward(WINDOW);
    let mean = |x: &[f32]| x.iter().map(|x| f64::from(*x)).sum::<f64>() / x.len() as f64;
    let means = [mean(a), mean(b)];
    let count = WINDOW / 2 + 1;
    let (mut aa, mut bb, mut ab) = (vec![0.0; count], vec![0.0; count], vec![Complex::default(); count]);
    for start in (0..a.len() - WINDOW).step_by(WINDOW / 2) {
        let [x, y] = [(a, means[0]), (b, means[1])].map(|(signal, mean)| {
            let hann = |i: usize| 0.5 - 0.5 * cos(2.0 * PI * i as f64 / WINDOW as f64);
            let mut time: Vec<f64> = (0..WINDOW).map(|i| hann(i) * (f64::from(signal[start + i]) - mean)).collect();
            let mut bins = plan.make_output_vec();
            plan.process(&mut time, &mut bins).expect("both lengths are the plan's");
            bins
        });
        for k in 0..count {
            aa[k] += x[k].norm_sqr();
            bb[k] += y[k].norm_sqr();
            ab[k] += x[k] * y[k].conj();
        }
    }
    (aa, bb, ab)
}

/// Sum of a spectrum between two frequencies, Hz.
fn band(power: &[f64], low: f64, high: f64) -> f64 {
    let bin = super::noise::RATE / WINDOW as f64;
    power.iter().enumerate().filter(|(k, _)| (low..high).contains(&(*k as f64 * bin))).map(|(_, p)| p).sum()
}

/// Root mean square about the mean.
fn fluctuation(x: impl Iterator<Item = f64> + Clone) -> f64 {
    let count = x.clone().count() as f64;
    let mean = x.clone().sum::<f64>() / count;
    (x.map(|x| (x - mean) * (x - mean)).sum::<f64>() / count).sqrt()
}

/// Decibels of a power ratio.
fn db(power: f64) -> f64 {
    10.0 * log10(power)
}

/// A share of sorted values, 0 … 1.
fn quantile(values: &mut [f64], share: f64) -> f64 {
    values.sort_by(f64::total_cmp);
    values[((values.len() - 1) as f64 * share) as usize]
}

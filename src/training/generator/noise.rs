//! Noise of any spectrum, in blocks by Fourier transform, and fast convolution.
//!
//! A noise of N samples with the amplitude spectrum a(f) is
//!
//! ```text
//! x_n = Σ_k X_k e^(2πi kn/N),   X_k = a(f_k) (g₁ + i g₂),   f_k = k · rate/N
//! ```
//!
//! with independent g of variance σ² = 2/3 (the sum of two uniform numbers in ±1). By the central limit theorem x is
//! Gaussian. Its variance is Σ 2 a² · 2σ² over 0 < k < N/2, and the noise is divided by its root. A pair with the
//! coherence γ(f) has X₂ = γ X₁ + √(1 − γ²) X₃, where X₃ is independent and as large as X₁.
//!
//! Spectra are tabulated at six points an octave and interpolated linearly, so no bin costs a transcendental.

use std::collections::BTreeMap;
use std::sync::Arc;

use soffio_fourier::{Complex, ComplexToReal, RealToComplex, real_forward, real_inverse};
use soffio_math::noise::Random;
use soffio_math::{exp, ln, pow};

/// Sample rate of everything in a scene, Hz.
pub(super) const RATE: f64 = 16_000.0;
/// Longest block of noise: 8 s, so a repetition is not heard and the transform stays in the cache.
const LONGEST: usize = 1 << 17;
/// Samples over which two blocks of a long noise are cross-faded: 64 ms.
const FADE: usize = 1024;
/// Variance of one part of a random bin: a sum of two uniform numbers in ±1.
const PART_VARIANCE: f64 = 2.0 / 3.0;

/// Draws that the recipes need, of the project's generator.
pub(super) trait Draw {
    /// True with the probability `p`.
    fn chance(&mut self, p: f64) -> bool;
    /// Uniform in the logarithm, in `low` … `high`, both positive.
    fn log_range(&mut self, low: f64, high: f64) -> f64;
    /// Mean 0 and variance 1, nearly Gaussian: the sum of twelve uniform numbers of 16 bits.
    fn normal(&mut self) -> f64;
    /// One of these.
    fn pick<T: Copy>(&mut self, of: &[T]) -> T;
    /// A whole number in `low` … `high`, both included.
    fn whole(&mut self, low: usize, high: usize) -> usize;
}

impl Draw for Random {
    fn chance(&mut self, p: f64) -> bool {
        self.unit() < p
    }

    fn log_range(&mut self, low: f64, high: f64) -> f64 {
        low * exp(self.unit() * ln(high / low))
    }

    fn normal(&mut self) -> f64 {
        let mut sum = 0.0;
        for _ in 0..3 {
            let word = self.word();
            for shift in [0, 16, 32, 48] {
                sum += ((word >> shift) & 0xffff) as f64;
            }
        }
        sum / 65_535.0 - 6.0
    }

    fn pick<T: Copy>(&mut self, of: &[T]) -> T {
        of[(self.word() % of.len() as u64) as usize]
    }

    fn whole(&mut self, low: usize, high: usize) -> usize {
        low + (self.word() % (high - low + 1) as u64) as usize
    }
}

/// Amplitude over frequency, tabulated.
#[derive(Clone, Debug)]
pub(super) struct Shape {
    /// Frequency as a share of the sample rate, and amplitude, rising frequencies.
    points: Vec<(f64, f64)>,
}

impl Shape {
    /// Points of an octave.
    const PER_OCTAVE: f64 = 6.0;
    /// Octaves below half the sample rate.
    const OCTAVES: usize = 16;

    /// Of a function of frequency, in the unit of `rate`.
    pub(super) fn new(rate: f64, amplitude: impl Fn(f64) -> f64) -> Self {
        let count = Self::OCTAVES * Self::PER_OCTAVE as usize;
        let points = (0..=count).map(|i| {
            let share = 0.5 * pow(2.0, (i as f64 - count as f64) / Self::PER_OCTAVE);
            (share, amplitude(share * rate))
        });
        Self { points: points.collect() }
    }

    /// Through corners (Hz, dB), straight in dB over the logarithm of frequency, at [`RATE`].
    pub(super) fn corners(corners: &[(f64, f64)]) -> Self {
        Self::new(RATE, |f| {
            let after = corners.iter().position(|c| c.0 > f);
            let db = match after {
                Some(0) => corners[0].1,
                None => corners[corners.len() - 1].1,
                Some(i) => {
                    let ((f0, d0), (f1, d1)) = (corners[i - 1], corners[i]);
                    d0 + (d1 - d0) * ln(f / f0) / ln(f1 / f0)
                }
            };
            pow(10.0, db / 20.0)
        })
    }

    /// Calls `put` with each bin of a transform of `n` samples, in 0 < k < n/2, and the amplitude there.
    fn bins(&self, n: usize, mut put: impl FnMut(usize, f64)) {
        let mut k = 1;
        let first = self.points[0];
        while k < n / 2 && (k as f64) < first.0 * n as f64 {
            put(k, first.1);
            k += 1;
        }
        for pair in self.points.windows(2) {
            let ((f0, a0), (f1, a1)) = (pair[0], pair[1]);
            let slope = (a1 - a0) / ((f1 - f0) * n as f64);
            while k < n / 2 && (k as f64) < f1 * n as f64 {
                put(k, a0 + slope * (k as f64 - f0 * n as f64));
                k += 1;
            }
        }
    }
}

/// A complex number of which both parts have the variance 2/3.
#[inline]
fn random_bin(random: &mut Random) -> Complex<f64> {
    /// Of a 16-bit number, as a share of its range.
    const SCALE: f64 = 2.0 / 65_535.0;
    let word = random.word();
    let part = |shift: u32| ((word >> shift) & 0xffff) as f64 * SCALE;
    Complex::new(part(0) + part(16) - 2.0, part(32) + part(48) - 2.0)
}

type Plan = (Arc<dyn RealToComplex<f64>>, Arc<dyn ComplexToReal<f64>>);

/// Transforms of one scene: plans are made once.
#[derive(Default)]
pub(super) struct Workshop {
    plans: BTreeMap<usize, Plan>,
}

impl Workshop {
    /// Forward and inverse plan of `n` samples.
    pub(super) fn plan(&mut self, n: usize) -> Plan {
        self.plans.entry(n).or_insert_with(|| (real_forward(n), real_inverse(n))).clone()
    }

    /// Time signal of a spectrum, times `scale`.
    fn back(&mut self, bins: &mut [Complex<f64>], scale: f64) -> Vec<f32> {
        let n = 2 * (bins.len() - 1);
        let mut time = vec![0.0; n];
        self.plan(n).1.process(bins, &mut time).expect("both lengths are the plan's");
        time.iter().map(|x| (x * scale) as f32).collect()
    }

    /// A periodic block of `n` samples, a power of two, of root mean square 1.
    fn block(&mut self, random: &mut Random, n: usize, shape: &Shape) -> Vec<f32> {
        let mut bins = vec![Complex::default(); n / 2 + 1];
        let mut power = 0.0;
        shape.bins(n, |k, a| {
            bins[k] = random_bin(random) * a;
            power += a * a;
        });
        self.back(&mut bins, 1.0 / (4.0 * PART_VARIANCE * power).sqrt().max(f64::MIN_POSITIVE))
    }

    /// `n` samples of noise of root mean square 1. Long noises are blocks, cross-faded at equal power.
    pub(super) fn noise(&mut self, random: &mut Random, n: usize, shape: &Shape) -> Vec<f32> {
        if n <= LONGEST {
            let mut block = self.block(random, n.next_power_of_two().max(1024), shape);
            block.truncate(n);
            return block;
        }
        let mut out: Vec<f32> = Vec::with_capacity(n + LONGEST);
        while out.len() < n {
            let block = self.block(random, LONGEST, shape);
            let overlap = out.len().min(FADE);
            let start = out.len() - overlap;
            for (i, x) in block[..overlap].iter().enumerate() {
                let share = (i as f32 + 0.5) / FADE as f32;
                out[start + i] = out[start + i] * (1.0 - share).sqrt() + x * share.sqrt();
            }
            out.extend_from_slice(&block[overlap..]);
        }
        out.truncate(n);
        out
    }

    /// Two periodic noises of `n` samples, a power of two, each of root mean square 1, with this coherence between them.
    pub(super) fn pair(&mut self, random: &mut Random, n: usize, shape: &Shape, coherence: &Shape) -> [Vec<f32>; 2] {
        let zero = Complex::default();
        let (mut first, mut second) = (vec![zero; n / 2 + 1], vec![zero; n / 2 + 1]);
        let mut power = 0.0;
        coherence.bins(n, |k, gamma| second[k].re = gamma);
        shape.bins(n, |k, a| {
            let gamma = second[k].re;
            first[k] = random_bin(random) * a;
            second[k] = first[k] * gamma + random_bin(random) * (a * (1.0 - gamma * gamma).max(0.0).sqrt());
            power += a * a;
        });
        let scale = 1.0 / (4.0 * PART_VARIANCE * power).sqrt().max(f64::MIN_POSITIVE);
        [self.back(&mut first, scale), self.back(&mut second, scale)]
    }

    /// Convolution with two impulse responses of one length; each result is as long as `x`.
    pub(super) fn convolve(&mut self, x: &[f32], kernels: [&[f32]; 2]) -> [Vec<f32>; 2] {
        let taps = kernels[0].len().max(1);
        let n = (2 * taps).next_power_of_two().clamp(1 << 14, LONGEST);
        let hop = n - taps + 1;
        let (forward, inverse) = self.plan(n);
        let mut time = vec![0.0; n];
        let spectra = kernels.map(|kernel| {
            time.iter_mut().for_each(|t| *t = 0.0);
            time.iter_mut().zip(kernel).for_each(|(t, k)| *t = f64::from(*k) / n as f64);
            let mut bins = forward.make_output_vec();
            forward.process(&mut time, &mut bins).expect("both lengths are the plan's");
            bins
        });
        let mut out = [vec![0.0; x.len()], vec![0.0; x.len()]];
        let mut bins = forward.make_output_vec();
        let mut product = bins.clone();
        for start in (0..x.len()).step_by(hop) {
            let part = &x[start..(start + hop).min(x.len())];
            if part.iter().all(|x| *x == 0.0) {
                continue;
            }
            time.iter_mut().for_each(|t| *t = 0.0);
            time.iter_mut().zip(part).for_each(|(t, x)| *t = f64::from(*x));
            forward.process(&mut time, &mut bins).expect("both lengths are the plan's");
            for (spectrum, out) in spectra.iter().zip(&mut out) {
                product.iter_mut().zip(&bins).zip(spectrum).for_each(|((p, a), b)| *p = a * b);
                (product[0].im, product[n / 2].im) = (0.0, 0.0);
                inverse.process(&mut product, &mut time).expect("both lengths are the plan's");
                out[start..].iter_mut().zip(&time).for_each(|(y, t)| *y += *t as f32);
            }
        }
        out
    }
}

/// A smooth random function of about unit variance: random values at the whole numbers, joined by cubics (Catmull and Rom
/// 1974). It changes within about one unit, so a quarter of a period.
pub(super) struct Drift {
    knots: Vec<f64>,
}

impl Drift {
    /// Random values have 1 at the knots and about 0.7 between, so 1.15 gives 1 on average.
    const GAIN: f64 = 1.15;

    /// For arguments in 0 … `span`; beyond, it repeats.
    pub(super) fn new(random: &mut Random, span: f64) -> Self {
        Self { knots: (0..span as usize + 8).map(|_| Self::GAIN * random.normal()).collect() }
    }

    /// Value at `x`, not negative.
    pub(super) fn at(&self, x: f64) -> f64 {
        let (k, t) = (x as usize, x - x.floor());
        let [a, b, c, d] = [0, 1, 2, 3].map(|i| self.knots[(k + i) % self.knots.len()]);
        b + 0.5 * t * (c - a + t * (2.0 * a - 5.0 * b + 4.0 * c - d + t * (3.0 * (b - c) + d - a)))
    }
}

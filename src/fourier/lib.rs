//! Plans of discrete Fourier transforms: the one place where the library that does them is compiled.
//!
//! The library's planners are generic. Each crate that calls one compiles every algorithm for itself, a minute of processor
//! time, so all of them call these functions instead. What they return is called through a table of functions and costs its
//! user nothing to compile. The library is built without its vector instructions, which differ between processors in the
//! last bit: here the same samples give the same bits on any of them.
//!
//! | function | transform | symbols |
//! |---|---|---|
//! | [`forward`] | complex, in place | X_k = Σ x_n e^(−2πi kn/N) |
//! | [`inverse`] | complex, in place, not scaled | x_n = Σ X_k e^(2πi kn/N), which is N times the first |
//! | [`real_forward`] | N real samples to N/2 + 1 bins | the same X_k, k ≤ N/2 |
//! | [`real_inverse`] | N/2 + 1 bins to N real samples, not scaled | the same x_n; X_0 and, of even N, X_(N/2) are real |
//!
//! It never keeps samples between calls, and planning is the only thing that allocates: `process_with_scratch` of a plan does
//! not.
//!
//! ```
//! use soffio_fourier::{real_forward, real_inverse};
//!
//! // Two whole periods of a cosine in eight samples: half of the eight lies in bin 2, the other half at its mirror.
//! let mut wave: Vec<f64> = (0..8).map(|n| [1.0, 0.0, -1.0, 0.0][n % 4]).collect();
//! let before = wave.clone();
//! let forward = real_forward(8);
//! let mut bins = forward.make_output_vec();
//! forward.process(&mut wave, &mut bins).expect("both lengths are the plan's");
//! for (k, bin) in bins.iter().enumerate() {
//!     assert!((bin.re - if k == 2 { 4.0 } else { 0.0 }).abs() < 1e-12 && bin.im.abs() < 1e-12);
//! }
//!
//! // And back, times eight.
//! (bins[0].im, bins[4].im) = (0.0, 0.0);
//! real_inverse(8).process(&mut bins, &mut wave).expect("both lengths are the plan's");
//! assert!(wave.iter().zip(&before).all(|(back, x)| (back - 8.0 * x).abs() < 1e-12));
//! ```

use std::sync::Arc;

use realfft::RealFftPlanner;
use rustfft::FftPlanner;

pub use realfft::{ComplexToReal, RealToComplex};
pub use rustfft::Fft;
pub use rustfft::num_complex::Complex;

/// The complex transform of `n` samples.
pub fn forward(n: usize) -> Arc<dyn Fft<f64>> {
    FftPlanner::new().plan_fft_forward(n)
}

/// The complex transform back, `n` times too large.
pub fn inverse(n: usize) -> Arc<dyn Fft<f64>> {
    FftPlanner::new().plan_fft_inverse(n)
}

/// The transform of `n` real samples.
pub fn real_forward(n: usize) -> Arc<dyn RealToComplex<f64>> {
    RealFftPlanner::new().plan_fft_forward(n)
}

/// The transform back to `n` real samples, `n` times too large.
pub fn real_inverse(n: usize) -> Arc<dyn ComplexToReal<f64>> {
    RealFftPlanner::new().plan_fft_inverse(n)
}

//! Levels in octave bands, by averaged spectra (Welch, IEEE Trans. AU 15, 1967).
//!
//! ```text
//! P_B = Σ_B mean |X_k|² / Σ w²          X: spectra of Hann windows w of 128 ms that overlap by half
//! ```

use soffio_fourier::real_forward;
use soffio_math::{PI, cos, log10};

/// Limits of the octave bands in which a breath is compared with its room, Hz.
pub const OCTAVES_HZ: [f64; 8] = [31.0, 62.0, 125.0, 250.0, 500.0, 1000.0, 2000.0, 3400.0];
/// Window, s.
const WINDOW_S: f64 = 0.128;
/// Keeps quotients finite.
const LEAST: f64 = 1e-18;

/// Power between each limit (Hz) and the next.
pub fn band_powers(samples: &[f64], rate: f64, limits: &[f64]) -> Vec<f64> {
    let size = ((WINDOW_S * rate) as usize).next_power_of_two();
    let window: Vec<f64> = (0..size).map(|i| 0.5 - 0.5 * cos(2.0 * PI * (i as f64 + 0.5) / size as f64)).collect();
    let transform = real_forward(size);
    let mut bins = transform.make_output_vec();
    let mut sums = vec![0.0; limits.len() - 1];
    let mut frames = 0.0;
    let mut padded = samples.to_vec();
    padded.resize(samples.len().max(size), 0.0);
    for start in (0..=padded.len() - size).step_by(size / 2) {
        let mut frame: Vec<f64> = padded[start..start + size].iter().zip(&window).map(|(x, w)| x * w).collect();
        // Lengths agree by construction.
        if transform.process(&mut frame, &mut bins).is_err() {
            break;
        }
        let bin = |hz: f64| ((hz * size as f64 / rate).round() as usize).min(bins.len());
        for (sum, pair) in sums.iter_mut().zip(limits.windows(2)) {
            *sum += bins[bin(pair[0])..bin(pair[1])].iter().map(|z| z.norm_sqr()).sum::<f64>();
        }
        frames += 1.0;
    }
    let whole: f64 = window.iter().map(|w| w * w).sum::<f64>() * size as f64;
    // Half of the power lies at negative frequencies.
    sums.iter().map(|sum| 2.0 * sum / (f64::max(frames, 1.0) * whole)).collect()
}

/// Level of a breath over its room in the best octave band, dB. `noise` is the RMS of white noise that the microphone adds.
pub fn over_room(breath: &[f64], room: &[f64], rate: f64, noise: f64) -> f64 {
    let [breath, room] = [breath, room].map(|sound| band_powers(sound, rate, &OCTAVES_HZ));
    let ratio = |(pair, (b, r)): (&[f64], (&f64, &f64))| {
        let own = noise * noise * (pair[1] - pair[0]) / (0.5 * rate);
        b / (r + own + LEAST)
    };
    let best = OCTAVES_HZ.windows(2).zip(breath.iter().zip(&room)).map(ratio).fold(0.0, f64::max);
    10.0 * log10(best.max(LEAST))
}

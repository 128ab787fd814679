//! Exponential sine sweep (A. Farina, 2000): measures the response from loudspeaker to microphone, octave by octave.
//!
//! The frequency of the sweep rises exponentially, x(t) = A sin(2π f₀ T/L (e^{tL/T} − 1)) with L = ln(f₁/f₀). The impulse
//! response h follows from the recording y by division of the spectra,
//!
//! ```text
//! H = Y X* / (|X|² + ε)         h = F⁻¹ H        level of an octave: mean |F(w h)|² over its bins, dB
//! ```
//!
//! with a window w about the first arrival, which excludes the delay of the devices and the late reverberation. Harmonic
//! distortion lies before the arrival, the second harmonic by T ln 2/L. Between the two there is only noise; the same window
//! there measures the noise in each level.
//!
//! The microphone may record voices too. Everything from which they could be restored is overwritten after its use.

use soffio_fourier::{Complex, RealToComplex, real_forward, real_inverse};
use zeroize::{Zeroize, Zeroizing};

use soffio_math::{PI, amplitude_to_db, cos, exp, ln, sin};
use soffio_sound::BANDS;

/// Length of the sweep, s.
pub const SWEEP_S: f64 = 2.5;
/// Length of the recording from the beginning of the sweep, s. It includes the latency of both devices and the first
/// reflections.
pub const RECORDED_S: f64 = SWEEP_S + LATEST_S + 0.3;
/// Lowest and highest frequency, Hz: the octaves of [`BANDS`] with a margin.
const RANGE_HZ: (f64, f64) = (80.0, 11_500.0);
/// Greatest sample: −12 dB of full scale, so that the loudspeaker is not overdriven.
const AMPLITUDE: f64 = 0.25;
/// Fade at either end, s.
const FADE_S: f64 = 0.05;
/// Latest arrival of the sweep, s.
const LATEST_S: f64 = 1.0;
/// Window: its part before the arrival, and its length, s. The second harmonic lies 0.35 s before.
const WINDOW_S: (f64, f64) = (0.005, 0.1);
/// Windows of noise before the arrival.
const QUIET_WINDOWS: usize = 2;
/// Regularisation ε as a share of the greatest |X|²: damps the division outside of the range of the sweep.
const DAMPING: f64 = 1e-4;
/// Level above the noise from which an octave is clear, dB.
const CLEAR_DB: f64 = 6.0;
/// Least peak of a working microphone; below it the cable is out, or the microphone is switched off.
const DEAD: f32 = 1e-5;

/// Number of octaves.
pub const OCTAVES: usize = BANDS.len();

/// Measured response to a sweep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SweepResponse {
    /// Level of each octave of [`BANDS`], dB: recorded over played. Where an octave is not clear, the level of the noise,
    /// which is an upper bound.
    pub levels_db: [f64; OCTAVES],
    /// Is the octave above the noise?
    pub clear: [bool; OCTAVES],
    /// Did the microphone deliver exact silence?
    pub dead: bool,
}

/// Samples of the sweep at this rate, Hz. Frequencies too high for the rate are left out.
pub fn sweep(rate: u32) -> Vec<f32> {
    let rate = f64::from(rate);
    let (low, high) = RANGE_HZ;
    let growth = ln(high / low);
    let turns = 2.0 * PI * low * SWEEP_S / growth;
    let sample = |i: usize| {
        let t = i as f64 / rate;
        let grown = exp(t * growth / SWEEP_S);
        let edge = (t.min(SWEEP_S - t) / FADE_S).clamp(0.0, 1.0);
        let fade = 0.5 - 0.5 * cos(PI * edge);
        let possible = if low * grown < 0.45 * rate { 1.0 } else { 0.0 };
        (AMPLITUDE * possible * fade * sin(turns * (grown - 1.0))) as f32
    };
    (0..(SWEEP_S * rate) as usize).map(sample).collect()
}

/// Response to a sweep that arrives within the first second of these samples; `rate` in Hz.
pub fn measure_response(recorded: &[f32], rate: u32) -> SweepResponse {
    let dead = recorded.iter().all(|sample| sample.abs() < DEAD);
    let impulse_response = impulse_response(recorded, rate);
    let samples = |seconds: f64| (seconds * f64::from(rate)) as usize;
    let latest = samples(LATEST_S).min(impulse_response.len() - 1);
    let loudest =
        |best: usize, i: usize| if impulse_response[i].abs() > impulse_response[best].abs() { i } else { best };
    let first = (0..=latest).fold(0, loudest);
    let window = samples(WINDOW_S.1);
    let octaves = |before: usize| {
        let from = first + 2 * impulse_response.len() - samples(WINDOW_S.0) - before;
        powers((0..window).map(|i| impulse_response[(from + i) % impulse_response.len()]), rate)
    };
    let there = octaves(0);
    let mut noise = [0.0; OCTAVES];
    for quiet in (1..=QUIET_WINDOWS).map(|k| octaves(k * (window + samples(WINDOW_S.0)))) {
        (0..OCTAVES).for_each(|b| noise[b] += quiet[b] / QUIET_WINDOWS as f64);
    }
    let clear: [bool; OCTAVES] =
        std::array::from_fn(|b| !dead && power_to_db(there[b]) - power_to_db(noise[b]) >= CLEAR_DB);
    let level = |b: usize| power_to_db(if clear[b] { there[b] - noise[b] } else { there[b].max(noise[b]) });
    SweepResponse { levels_db: std::array::from_fn(level), clear, dead }
}

/// Level of a power, dB; finite for silence.
fn power_to_db(power: f64) -> f64 {
    0.5 * amplitude_to_db(power.max(1e-24))
}

/// The impulse response between loudspeaker and microphone, circular.
fn impulse_response(recorded: &[f32], rate: u32) -> Zeroizing<Vec<f64>> {
    let sent = sweep(rate);
    let length = (sent.len() + recorded.len()).next_power_of_two();
    let forward = real_forward(length);
    let (x, y) = (spectrum(&*forward, doubles(&sent)), spectrum(&*forward, doubles(recorded)));
    let damping = DAMPING * x.iter().map(Complex::norm_sqr).fold(0.0, f64::max);
    let mut ratio = y;
    ratio.0.iter_mut().zip(x.iter()).for_each(|(y, x)| *y = *y * x.conj() / (x.norm_sqr() + damping));
    // The spectrum of a real signal is real here, rounding aside.
    ratio.0[0].im = 0.0;
    ratio.0[length / 2].im = 0.0;
    let mut impulse_response = Zeroizing::new(vec![0.0; length]);
    let back = real_inverse(length);
    let mut scratch = Spectrum(back.make_scratch_vec());
    back.process_with_scratch(&mut ratio.0, &mut impulse_response, &mut scratch.0).expect("lengths of one plan");
    impulse_response.iter_mut().for_each(|sample| *sample /= length as f64);
    impulse_response
}

/// Mean power of the bins of each octave; 0 where the rate has none.
fn powers(cut: impl ExactSizeIterator<Item = f64>, rate: u32) -> [f64; OCTAVES] {
    let length = cut.len().next_power_of_two();
    let spectrum = spectrum(&*real_forward(length), cut);
    std::array::from_fn(|b| {
        let half = std::f64::consts::SQRT_2;
        let bin = |hz: f64| ((hz * length as f64 / f64::from(rate)) as usize).min(spectrum.len());
        let bins = &spectrum[bin(BANDS[b] / half)..bin(BANDS[b] * half)];
        bins.iter().map(Complex::norm_sqr).sum::<f64>() / bins.len().max(1) as f64
    })
}

fn doubles(samples: &[f32]) -> impl ExactSizeIterator<Item = f64> {
    samples.iter().map(|sample| f64::from(*sample))
}

/// A spectrum, or room for one, that is overwritten when it is dropped.
struct Spectrum(Vec<Complex<f64>>);

impl std::ops::Deref for Spectrum {
    type Target = [Complex<f64>];

    fn deref(&self) -> &Self::Target {
        &self.0
    }
}

impl Drop for Spectrum {
    fn drop(&mut self) {
        for z in &mut self.0 {
            z.re.zeroize();
            z.im.zeroize();
        }
    }
}

/// Spectrum of samples, padded with zeros to the length of the transform.
fn spectrum(forward: &dyn RealToComplex<f64>, samples: impl Iterator<Item = f64>) -> Spectrum {
    let mut padded = Zeroizing::new(vec![0.0; forward.len()]);
    padded.iter_mut().zip(samples).for_each(|(padded, sample)| *padded = sample);
    let (mut out, mut scratch) = (Spectrum(forward.make_output_vec()), Spectrum(forward.make_scratch_vec()));
    forward.process_with_scratch(&mut padded, &mut out.0, &mut scratch.0).expect("lengths of one plan");
    out
}

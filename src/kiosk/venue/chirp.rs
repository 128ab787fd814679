//! A chirp from the loudspeaker to the microphone, and what of it arrives, octave by octave.
//!
//! The chirp is a sine whose frequency rises by as many octaves in each second, x(t) = A sin(2π f₀ T/L (e^{tL/T} − 1)) with
//! L = ln(f₁/f₀). From what is heard, y, the way between the two is found by division of the spectra,
//!
//! ```text
//! H = Y X* / (|X|² + ε)         h = F⁻¹ H        level of an octave: mean |F(w h)|² over its bins, dB
//! ```
//!
//! with a window w about the first arrival, so that neither the delay of the devices nor the room's long reverberation
//! counts. What a loudspeaker distorts lies before the arrival (A. Farina, 2000), the second harmonic by T ln 2/L; between
//! the two there is noise only, and the same window there says how much of a level is the room's noise.

use soffio_fourier::{Complex, RealToComplex, real_forward, real_inverse};

use soffio_math::{PI, cos, decibels, exp, ln, sin};
use soffio_sound::BANDS;

/// Length of the chirp, s.
pub const CHIRP_S: f64 = 2.5;
/// How long the microphone is heard for from its beginning on, s: the latency of both devices and the first reflections.
pub const HEARD_S: f64 = CHIRP_S + LATEST_S + 0.3;
/// Its lowest and highest frequency, Hz: the octaves of [`BANDS`] with something to spare.
const RANGE_HZ: (f64, f64) = (80.0, 11_500.0);
/// Greatest sample: −12 dB of full scale, so that a loudspeaker is not driven into its limits.
const AMPLITUDE: f64 = 0.25;
/// Fade at either end, s.
const FADE_S: f64 = 0.05;
/// The latest arrival that is looked for, s.
const LATEST_S: f64 = 1.0;
/// The window: before the arrival and in all, s. The second harmonic lies 0.35 s before.
const WINDOW_S: (f64, f64) = (0.005, 0.1);
/// Windows of noise before it.
const QUIET_WINDOWS: usize = 2;
/// Below this share of the greatest |X|² the division is damped: outside of the chirp's range.
const DAMPING: f64 = 1e-4;
/// An octave so far above the noise is clear, dB.
const CLEAR_DB: f64 = 6.0;
/// A microphone whose loudest sample is below this hears nothing at all: its cable is out, or it is switched off.
const DEAD: f32 = 1e-5;

/// Octaves that are told apart.
pub const OCTAVES: usize = BANDS.len();

/// What arrived of a chirp.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arrived {
    /// Level of each octave of [`BANDS`], dB: what the microphone's samples are over the chirp's. Where it is not clear,
    /// the noise's, below which the chirp is.
    pub levels_db: [f64; OCTAVES],
    /// Is it above the noise?
    pub clear: [bool; OCTAVES],
    /// Did the microphone give no sound at all?
    pub dead: bool,
}

/// The chirp at this rate, Hz: what is too high for it is left out.
pub fn chirp(rate: u32) -> Vec<f32> {
    let rate = f64::from(rate);
    let (low, high) = RANGE_HZ;
    let growth = ln(high / low);
    let turns = 2.0 * PI * low * CHIRP_S / growth;
    let sample = |i: usize| {
        let t = i as f64 / rate;
        let grown = exp(t * growth / CHIRP_S);
        let edge = (t.min(CHIRP_S - t) / FADE_S).clamp(0.0, 1.0);
        let fade = 0.5 - 0.5 * cos(PI * edge);
        let possible = if low * grown < 0.45 * rate { 1.0 } else { 0.0 };
        (AMPLITUDE * possible * fade * sin(turns * (grown - 1.0))) as f32
    };
    (0..(CHIRP_S * rate) as usize).map(sample).collect()
}

/// What arrived of a chirp that began with the first of these samples, or up to a second later.
pub fn arrived(heard: &[f32], rate: u32) -> Arrived {
    let dead = heard.iter().all(|sample| sample.abs() < DEAD);
    let way = way(heard, rate);
    let samples = |seconds: f64| (seconds * f64::from(rate)) as usize;
    let latest = samples(LATEST_S).min(way.len() - 1);
    let loudest = |best: usize, i: usize| if way[i].abs() > way[best].abs() { i } else { best };
    let first = (0..=latest).fold(0, loudest);
    let window = samples(WINDOW_S.1);
    let octaves = |before: usize| {
        let from = first + 2 * way.len() - samples(WINDOW_S.0) - before;
        let cut: Vec<f64> = (0..window).map(|i| way[(from + i) % way.len()]).collect();
        powers(cut, rate)
    };
    let there = octaves(0);
    let mut noise = [0.0; OCTAVES];
    for quiet in (1..=QUIET_WINDOWS).map(|k| octaves(k * (window + samples(WINDOW_S.0)))) {
        (0..OCTAVES).for_each(|b| noise[b] += quiet[b] / QUIET_WINDOWS as f64);
    }
    let clear: [bool; OCTAVES] =
        std::array::from_fn(|b| !dead && decibels_of(there[b]) - decibels_of(noise[b]) >= CLEAR_DB);
    let level = |b: usize| decibels_of(if clear[b] { there[b] - noise[b] } else { there[b].max(noise[b]) });
    Arrived { levels_db: std::array::from_fn(level), clear, dead }
}

/// Of a power, dB; silence is very low and still a number.
fn decibels_of(power: f64) -> f64 {
    0.5 * decibels(power.max(1e-24))
}

/// The impulse response between loudspeaker and microphone, circular.
fn way(heard: &[f32], rate: u32) -> Vec<f64> {
    let sent = chirp(rate);
    let length = (sent.len() + heard.len()).next_power_of_two();
    let forward = real_forward(length);
    let (x, y) = (spectrum(&*forward, doubles(&sent)), spectrum(&*forward, doubles(heard)));
    let damping = DAMPING * x.iter().map(Complex::norm_sqr).fold(0.0, f64::max);
    let mut ratio: Vec<_> = x.iter().zip(&y).map(|(x, y)| y * x.conj() / (x.norm_sqr() + damping)).collect();
    // What a real signal cannot have, rounding aside.
    ratio[0].im = 0.0;
    ratio[length / 2].im = 0.0;
    let mut way = vec![0.0; length];
    real_inverse(length).process(&mut ratio, &mut way).expect("lengths of one plan");
    way.iter_mut().for_each(|sample| *sample /= length as f64);
    way
}

/// Mean power of each octave's bins; nothing where the rate has none.
fn powers(cut: Vec<f64>, rate: u32) -> [f64; OCTAVES] {
    let length = cut.len().next_power_of_two();
    let spectrum = spectrum(&*real_forward(length), cut);
    std::array::from_fn(|b| {
        let half = std::f64::consts::SQRT_2;
        let bin = |hz: f64| ((hz * length as f64 / f64::from(rate)) as usize).min(spectrum.len());
        let bins = &spectrum[bin(BANDS[b] / half)..bin(BANDS[b] * half)];
        bins.iter().map(Complex::norm_sqr).sum::<f64>() / bins.len().max(1) as f64
    })
}

fn doubles(samples: &[f32]) -> Vec<f64> {
    samples.iter().map(|sample| f64::from(*sample)).collect()
}

fn spectrum(forward: &dyn RealToComplex<f64>, mut samples: Vec<f64>) -> Vec<Complex<f64>> {
    samples.resize(forward.len(), 0.0);
    let mut out = forward.make_output_vec();
    forward.process(&mut samples, &mut out).expect("lengths of one plan");
    out
}

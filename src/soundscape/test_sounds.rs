//! Noises at any sample rate for tests: white, pink, hum, a voice, knocks, thuds, plosives. Deterministic in their seed.

use soffio_math::noise::{Random, hash_words, perlin1};
use soffio_math::{PI, cos, db_to_amplitude, exp, sin};

use crate::filters::{gaussian, low_passed, normalised, resonance};

/// White noise of the given level, dB of full scale (RMS).
pub fn white_noise(sample_rate: u32, seed: u64, seconds: f64, dbfs: f64) -> Vec<f32> {
    scaled(gaussian(length(sample_rate, seconds), &mut Random::new(seed)), dbfs)
}

/// Noise that falls by 3 dB an octave, of the given level, dB of full scale (RMS).
pub fn pink_noise(sample_rate: u32, seed: u64, seconds: f64, dbfs: f64) -> Vec<f32> {
    let (count, rate) = (length(sample_rate, seconds), f64::from(sample_rate));
    // Low-passed noises a factor of four apart; each is √4 stronger per hertz than the next.
    let mut sum = vec![0.0; count];
    for stage in 0..6_u32 {
        let corner = 10.0 * f64::from(1_u32 << (2 * stage));
        let layer = gaussian(count, &mut Random::new(hash_words(&[seed, u64::from(stage)])));
        for (s, x) in sum.iter_mut().zip(normalised(low_passed(layer, rate, corner.min(0.4 * rate), 1))) {
            *s += x;
        }
    }
    scaled(sum, dbfs)
}

/// Mains hum: a fundamental (Hz) and its odd harmonics, of the given level, dB of full scale (RMS).
pub fn hum(sample_rate: u32, seconds: f64, fundamental_hz: f64, dbfs: f64) -> Vec<f32> {
    let tone = |i: usize| {
        let angle = 2.0 * PI * fundamental_hz * i as f64 / f64::from(sample_rate);
        sin(angle) + 0.4 * sin(3.0 * angle) + 0.2 * sin(5.0 * angle)
    };
    scaled((0..length(sample_rate, seconds)).map(tone).collect(), dbfs)
}

/// A voice on vowels: a wandering pitch about `pitch_hz`, three formants, three syllables a second.
pub fn voice(sample_rate: u32, seed: u64, seconds: f64, pitch_hz: f64, dbfs: f64) -> Vec<f32> {
    let rate = f64::from(sample_rate);
    let mut angle = 0.0;
    let mut pulses = Vec::with_capacity(length(sample_rate, seconds));
    for i in 0..length(sample_rate, seconds) {
        let time = i as f64 / rate;
        let syllable = sin(PI * 3.0 * time);
        let pitch = pitch_hz * (1.0 + 0.12 * perlin1(2.0 * time, seed));
        angle += 2.0 * PI * pitch / rate;
        // A band-limited glottal pulse train: exp(a (cos θ − 1)) has all harmonics, falling smoothly.
        pulses.push(syllable * syllable * (exp(12.0 * (cos(angle) - 1.0)) - 0.2));
    }
    let mut out = vec![0.0; pulses.len()];
    for (formant, gain) in [(650.0, 1.0), (1200.0, 0.5), (2600.0, 0.25)] {
        for (o, x) in out.iter_mut().zip(resonance(&pulses, rate, formant, 90.0)) {
            *o += gain * x;
        }
    }
    scaled(out, dbfs)
}

/// Knocks on the table that carries the microphone: damped 30–90 Hz, with a click, at the given times (s).
pub fn knocks(sample_rate: u32, seed: u64, seconds: f64, times: &[f64], peak: f64) -> Vec<f32> {
    let rate = f64::from(sample_rate);
    let mut random = Random::new(seed);
    let mut out = vec![0.0; length(sample_rate, seconds)];
    for &start in times {
        let (pitch, decay) = (random.range(30.0, 90.0), random.range(0.03, 0.12));
        for (i, o) in out.iter_mut().enumerate().skip((start * rate) as usize) {
            let t = i as f64 / rate - start;
            *o += peak * (sin(2.0 * PI * pitch * t) * exp(-t / decay) + 0.3 * random.signed() * exp(-t / 0.004));
        }
    }
    out.into_iter().map(|x: f64| x.clamp(-1.0, 1.0) as f32).collect()
}

/// Steps and falling objects: bursts of low noise that decay within 40–150 ms, at the given times (s).
pub fn thuds(sample_rate: u32, seed: u64, seconds: f64, times: &[f64], peak: f64) -> Vec<f32> {
    let rate = f64::from(sample_rate);
    let mut random = Random::new(seed);
    let mut out = vec![0.0; length(sample_rate, seconds)];
    for &start in times {
        let (corner, decay) = (random.range(60.0, 400.0), random.range(0.04, 0.15));
        let count = (8.0 * decay * rate) as usize;
        let body = normalised(low_passed(gaussian(count, &mut random), rate, corner, 2));
        for (i, (o, x)) in out.iter_mut().skip((start * rate) as usize).zip(body).enumerate() {
            let t = i as f64 / rate;
            *o += peak * 0.4 * x * (1.0 - exp(-t / 0.002)) * exp(-t / decay);
        }
    }
    out.into_iter().map(|x: f64| x.clamp(-1.0, 1.0) as f32).collect()
}

/// Plosive puffs (p and b): 25–70 ms of low noise at the given times (s).
pub fn plosives(sample_rate: u32, seed: u64, seconds: f64, times: &[f64], peak: f64) -> Vec<f32> {
    let rate = f64::from(sample_rate);
    let mut random = Random::new(seed);
    let mut out = vec![0.0; length(sample_rate, seconds)];
    for &start in times {
        let count = (random.range(0.025, 0.07) * rate) as usize;
        let puff = low_passed(gaussian(4 * count, &mut random), rate, 90.0, 2);
        let puff = &puff[3 * count..];
        let top = puff.iter().fold(1e-12, |m: f64, x| m.max(x.abs()));
        for (i, (o, x)) in out.iter_mut().skip((start * rate) as usize).zip(puff).enumerate() {
            let hann = 0.5 - 0.5 * cos(2.0 * PI * i as f64 / count as f64);
            *o += peak * hann * x / top;
        }
    }
    out.into_iter().map(|x: f64| x.clamp(-1.0, 1.0) as f32).collect()
}

/// Adds `other` to `samples`, sample by sample, up to the shorter length.
pub fn mix(samples: &mut [f32], other: &[f32]) {
    samples.iter_mut().zip(other).for_each(|(a, b)| *a += b);
}

fn length(sample_rate: u32, seconds: f64) -> usize {
    (f64::from(sample_rate) * seconds).round().max(0.0) as usize
}

/// Scaled to a level in dB of full scale (RMS), cut at full scale.
fn scaled(samples: Vec<f64>, dbfs: f64) -> Vec<f32> {
    let gain = db_to_amplitude(dbfs);
    normalised(samples).into_iter().map(|x| (gain * x).clamp(-1.0, 1.0) as f32).collect()
}

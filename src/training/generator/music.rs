//! Music: bass lines, drums, struck and held chords, with vibrato.
//!
//! Tones are sums of harmonics 1/k^p. Struck strings decay, higher partials faster and a little sharp,
//! f_k = k f √(1 + B k²) (Fletcher and Rossing, The Physics of Musical Instruments, 1998, section 12.3).

use soffio_math::noise::Random;
use soffio_math::{PI, pow, sin, sincos};

use super::noise::{Draw, RATE, Shape};
use super::objects::ring;
use super::stage::{Stage, add};
use super::voice::normalise;

/// Samples between two settings of a vibrato.
const BLOCK: usize = 64;
/// Stiffness B of strings.
const STIFFNESS: f64 = 3e-4;

/// Frequency of a tone, Hz, by semitones from A at 440 Hz.
fn tone(semitones: f64) -> f64 {
    440.0 * pow(2.0, semitones / 12.0)
}

/// A held tone with vibrato, rising and falling: strings, winds, an organ.
fn held(random: &mut Random, wave: &mut [f32], f: f64, loud: f64) {
    let (rate, depth) = (random.range(4.0, 6.5), random.range(0.0, 0.012));
    let (power, phase) = (random.range(0.8, 2.2), 2.0 * PI * random.unit());
    let blocks = wave.len() / BLOCK;
    let bend: Vec<f64> =
        (0..blocks).map(|b| 1.0 + depth * sin(phase + 2.0 * PI * rate * (b * BLOCK) as f64 / RATE)).collect();
    let rise = random.range(0.01, 0.2) * RATE / BLOCK as f64;
    for k in 1..=10 {
        let k = f64::from(k);
        if k * f > 7000.0 {
            break;
        }
        let (y, x) = sincos(2.0 * PI * random.unit());
        let (mut x, mut y) = (x, y);
        let gain = loud / pow(k, power);
        for (b, part) in wave.chunks_exact_mut(BLOCK).enumerate() {
            let (s, c) = sincos(2.0 * PI * k * f * bend[b] / RATE);
            let edge = (b.min(blocks - 1 - b) as f64 / rise).min(1.0) * gain;
            for out in part {
                *out += (edge * y) as f32;
                (x, y) = (c * x - s * y, s * x + c * y);
            }
        }
    }
}

/// A struck or plucked string.
fn string(random: &mut Random, wave: &mut [f32], f: f64, loud: f64) {
    let (decay, power) = (random.range(0.3, 1.2) * (220.0 / f).sqrt().min(2.5), random.range(0.7, 1.6));
    for k in 1..=10 {
        let k = f64::from(k);
        let partial = k * f * (1.0 + STIFFNESS * k * k).sqrt();
        if partial > 7000.0 {
            break;
        }
        ring(wave, partial, decay / (1.0 + 0.25 * (k - 1.0)), loud / pow(k, power), random.signed());
    }
}

/// A drum of falling pitch.
fn kick(random: &mut Random) -> Vec<f32> {
    let (low, high) = (random.range(40.0, 65.0), random.range(100.0, 220.0));
    let mut wave = vec![0.0_f32; (0.35 * RATE) as usize];
    let (mut f, mut phase, mut gain) = (high, 0.0, 1.0);
    for (i, out) in wave.iter_mut().enumerate() {
        // A parabola for each half wave.
        let half = if phase < 0.5 { 16.0 * phase * (0.5 - phase) } else { -16.0 * (phase - 0.5) * (1.0 - phase) };
        *out = (half * gain * (i as f64 / 20.0).min(1.0)) as f32;
        phase += f / RATE;
        if phase >= 1.0 {
            phase -= 1.0;
        }
        f += 0.002 * (low - f);
        gain *= 0.9992;
    }
    wave
}

/// A piece of `seconds` s, root mean square 1: some of bass, drums, chords and a tune.
pub(super) fn piece(stage: &mut Stage, random: &mut Random, seconds: f64) -> Vec<f32> {
    const MINOR: [f64; 7] = [0.0, 2.0, 3.0, 5.0, 7.0, 8.0, 10.0];
    let mut out = vec![0.0_f32; (seconds * RATE) as usize];
    let (beat, key) = (random.range(0.3, 0.85), random.range(-26.0, -14.0));
    let parts = [random.chance(0.6), random.chance(0.45), random.chance(0.6), random.chance(0.6)];
    let (struck, legato) = (random.chance(0.6), random.range(0.5, 1.8));
    if parts[1] {
        let drum = kick(random);
        let snare_shape = Shape::corners(&[(120.0, -10.0), (250.0, 0.0), (4000.0, -4.0), (8000.0, -12.0)]);
        let mut snare = stage.noise(random, 0.15, &snare_shape);
        let count = snare.len() as f32;
        snare.iter_mut().enumerate().for_each(|(i, x)| {
            let fall = 1.0 - i as f32 / count;
            *x *= 0.5 * fall * fall * fall;
        });
        for i in 0..(seconds / beat) as usize {
            let at = i as f64 * beat * RATE;
            add(&mut out, at, if i % 2 == 0 { &drum } else { &snare }, 1.5);
            if random.chance(0.25) {
                add(&mut out, at + 0.5 * beat * RATE, &drum, 1.0);
            }
        }
    }
    let mut bar = 0.0;
    while bar < seconds {
        let root = key + random.pick(&MINOR);
        let mut note = |random: &mut Random, at: f64, pitch: f64, length: f64, loud: f64| {
            let count = ((length * RATE) as usize).min(((seconds - at).max(0.0) * RATE) as usize);
            let start = (at * RATE) as usize;
            let Some(place) = out.get_mut(start..start + count) else { return };
            if struck { string(random, place, tone(pitch), loud) } else { held(random, place, tone(pitch), loud) }
        };
        if parts[0] {
            for i in 0..4 {
                note(random, bar + f64::from(i) * beat, root - 12.0, beat * 0.95, 1.0);
            }
        }
        if parts[2] || parts == [false; 4] {
            for step in [0.0, 3.0, 7.0] {
                note(random, bar, root + 12.0 + step, 4.0 * beat * legato.min(1.0), 0.4);
            }
        }
        if parts[3] {
            let mut t = 0.0;
            while t < 4.0 * beat {
                let length = beat * random.pick(&[0.5, 1.0, 1.0, 2.0]);
                let pitch = key + 24.0 + random.pick(&MINOR);
                note(random, bar + t, pitch, length * legato, 0.5);
                t += length;
            }
        }
        bar += 4.0 * beat;
    }
    normalise(&mut out);
    out
}

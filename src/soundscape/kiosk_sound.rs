//! Synthesis of the kiosk's own sound: its wind, its chimes and its speech, and the response of its loudspeaker.

use super::RATE;
use super::voices::{add, decaying};
use crate::filters::{high_passed, low_passed, normalised, white};
use soffio_math::noise::{Random, perlin1};
use soffio_math::{PI, pow, sin, tanh};

const R: f64 = RATE as f64;

/// The kiosk's sound of wind: noise whose corner and loudness follow a breath.
struct Wind {
    low: Vec<f64>,
    high: Vec<f64>,
}

impl Wind {
    fn new(samples: usize, random: &mut Random) -> Self {
        let low = normalised(low_passed(white(samples, random), R, random.range(150.0, 400.0), 1));
        let high = low_passed(high_passed(white(samples, random), R, 200.0, 1), R, 1800.0, 2);
        Self { low, high: normalised(high) }
    }

    /// A gust from `at` on, that rises within `rise`, s.
    fn blow(&self, out: &mut [f64], at: f64, length: f64, (loud, rise): (f64, f64), random: &mut Random) {
        let (from, seed) = ((at * R) as usize, random.word());
        for i in from..(from + (length * R) as usize).min(out.len()) {
            let t = i as f64 / R - at;
            let swell = (t / rise).min((length - t) / (0.3 * length)).clamp(0.0, 1.0);
            let level = loud * swell * swell * (1.0 + 0.3 * perlin1(5.0 * t, seed));
            out[i] += level * (0.6 * self.low[i] + 0.6 * self.high[i]);
        }
    }
}

/// The kiosk at full volume: gusts of wind sound, strikes of plates and tubes, sentences of `speech`. Full scale ±1.
pub fn kiosk(seconds: f64, speech: &[f64], random: &mut Random) -> Vec<f64> {
    let mut out = vec![0.0; (seconds * R) as usize];
    let wind = Wind::new(out.len(), random);
    let mut at = random.range(0.3, 2.0);
    while at < seconds {
        let (length, loud, rise) = (random.range(0.5, 4.0), random.range(0.05, 0.45), random.range(0.05, 0.4));
        wind.blow(&mut out, at, length, (loud, rise), random);
        at += length + random.range(0.2, 4.0);
    }
    let from = random.range(0.0, 1.0);
    strikes(&mut out, from, random);
    if random.unit() < 0.4 {
        let loud = random.range(0.05, 0.25);
        add(&mut out, random.range(0.0, 0.5 * seconds), &speech[..speech.len() / 2], loud);
    }
    out.into_iter().map(|x| x.clamp(-1.0, 1.0)).collect()
}

/// Strikes of plates and tubes from a time on.
fn strikes(out: &mut [f64], from: f64, random: &mut Random) {
    let (mut at, seconds) = (from, out.len() as f64 / R);
    while at < seconds {
        let f = 55.0 * pow(2.0, random.range(0.0, 5.0));
        let mut strike = vec![0.0; (1.5 * R) as usize];
        for ratio in [1.0, 2.76, 5.4] {
            if ratio * f < 0.45 * R {
                let step = 2.0 * PI * ratio * f / R;
                strike.iter_mut().enumerate().for_each(|(i, y)| *y += sin(step * i as f64) / ratio);
            }
        }
        add(out, at, &decaying(strike, 0.001, random.range(0.05, 0.6)), random.range(0.03, 0.4));
        at += pow(10.0, random.range(-1.2, 0.6));
    }
}

/// Response of a small loudspeaker: a high-pass at its resonance, and soft saturation when it is driven hard.
pub fn speaker_response(played: &[f64], random: &mut Random) -> Vec<f64> {
    let (corner, drive) = (random.range(50.0, 150.0), random.range(0.3, 1.2));
    let out = high_passed(played.to_vec(), R, corner, 2);
    out.into_iter().map(|x| tanh(drive * x) / drive).collect()
}

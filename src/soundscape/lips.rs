//! Sound of the lips: hiss of the narrow opening, voice and whistle at the onset. It travels as sound, at once and everywhere.
//!
//! ```text
//! p(t) = p₁₀ (u₀ / 10 m/s)^2.7 (10 cm / d) n(t)        n: noise of unit RMS, 0.5–7 kHz, with resonances of lips and vocal tract
//! ```
//!
//! The exponent lies between those of a dipole (3) and of a fricative's source at low flow (2.2–2.7); see Stevens, JASA 50 (1971),
//! and Shadle, J. Acoust. Soc. Am. 81 suppl. (1987). p₁₀ is 57 dB: a soft /f/ at 10 cm.

use soffio_math::noise::{Random, perlin1};
use soffio_math::{PI, pow, sin};

use crate::RATE;
use crate::breath::Manner;
use crate::filters::{high_passed, low_passed, normalised, resonance, white};
use crate::microphone::{pascals, resampled};
use crate::voices::{self, Voice, add, shaped};

/// Level of the hiss at 10 cm and 10 m/s, dB of sound.
const HISS_DB: f64 = 57.0;
/// Exponent of the hiss over the speed.
const HISS_EXPONENT: f64 = 2.7;
/// Distance and speed of that level, m and m/s.
const REFERENCE: (f64, f64) = (0.1, 10.0);
/// Hiss of "pfff" over plain breath, dB: lips that nearly touch.
const PFFF_DB: f64 = 12.0;
/// Hiss of a straw, whose resonance whistles, dB.
const STRAW_DB: f64 = 4.0;
/// Level of voice or whistle at 10 cm, dB of sound: soft speech has 70 dB there.
const WHOO_DB: (f64, f64) = (60.0, 78.0);

/// Sound of the lips at 1 m, Pa, for a speed at the lips (m/s) one value a millisecond. `louder` is a deviation of the hiss, dB.
pub fn sound(lips: &[f64], manner: Manner, louder: f64, rate: u32, random: &mut Random) -> Vec<f64> {
    let r = f64::from(rate);
    let count = (lips.len() as f64 * r / 1000.0).round() as usize;
    let mut hiss = white(count, random);
    let (low, high) = (random.range(400.0, 1500.0), random.range(3000.0, 7000.0).min(0.4 * r));
    hiss = low_passed(high_passed(hiss, r, low, 1), r, high, 1);
    for _ in 0..2 {
        let centre = random.range(900.0, 5000.0).min(0.4 * r);
        let tract = resonance(&hiss, r, centre, random.range(200.0, 900.0));
        let share = random.range(0.5, 2.0);
        hiss.iter_mut().zip(&tract).for_each(|(y, x)| *y += share * x);
    }
    if manner == Manner::Straw {
        // A straw of 10 to 20 cm, open at one end.
        let first = random.range(420.0, 850.0);
        for k in [1.0, 3.0, 5.0] {
            let pipe = resonance(&hiss, r, (k * first).min(0.4 * r), 60.0);
            hiss.iter_mut().zip(&pipe).for_each(|(y, x)| *y += 4.0 / k * x);
        }
    }
    let more = match manner {
        Manner::Pfff => PFFF_DB,
        Manner::Straw => STRAW_DB,
        _ => 0.0,
    };
    let scale = pascals(HISS_DB + louder + more) * REFERENCE.0;
    let levels: Vec<f64> = lips.iter().map(|u| scale * pow(u / REFERENCE.1, HISS_EXPONENT)).collect();
    let mut out = normalised(hiss);
    for (i, y) in out.iter_mut().enumerate() {
        *y *= levels[(i as f64 * 1000.0 / r) as usize];
    }
    if manner == Manner::Whoo {
        let voiced = whoo(lips, random);
        let voiced = resampled(&voiced.iter().map(|x| *x as f32).collect::<Vec<_>>(), RATE, rate);
        out.iter_mut().zip(&voiced).for_each(|(y, x)| *y += f64::from(*x));
    }
    out
}

/// Voice or whistle at the onset of a breath, Pa at 1 m, at [`RATE`].
fn whoo(lips: &[f64], random: &mut Random) -> Vec<f64> {
    let r = f64::from(RATE);
    let mut out = vec![0.0; (lips.len() as f64 * r / 1000.0) as usize];
    let top = lips.iter().copied().fold(0.0, f64::max);
    let onset = lips.iter().position(|u| *u > 0.1 * top).unwrap_or(0) as f64 / 1000.0;
    let length = random.range(0.15, 0.7);
    let sound = if random.unit() < 0.6 {
        voices::vowel_of(&Voice::random(random), length, random)
    } else {
        let (f, glide, seed) = (random.range(700.0, 2200.0), random.range(-0.3, 0.3), random.word());
        let mut angle = 0.0;
        let tone = (0..(length * r) as usize).map(|i| {
            let t = i as f64 / r;
            angle += 2.0 * PI * f * (1.0 + glide * t / length + 0.01 * perlin1(20.0 * t, seed)) / r;
            sin(angle)
        });
        normalised(shaped(tone.collect(), 0.2, 0.3))
    };
    add(&mut out, onset, &sound, pascals(random.range(WHOO_DB.0, WHOO_DB.1)) * REFERENCE.0);
    out
}

//! Synthesis of human sounds by the source–filter model (Fant 1960): talk, shouting children, laughter, coughs. Glottal pulses or breath
//! noise pass through formants that move from syllable to syllable.
//!
//! Every sound has unit RMS while it lasts.

use crate::filters::{high_passed, low_passed, normalised, resonance, white};
use soffio_math::noise::Random;
use soffio_math::{PI, exp, sin};

use super::RATE;

const R: f64 = RATE as f64;

/// Parameters of a speaker.
#[derive(Clone, Copy, Debug)]
pub struct Voice {
    /// Mean pitch, Hz.
    pub pitch_hz: f64,
    /// Formants relative to an adult man's.
    formants: f64,
    /// Corner of the glottal pulses, Hz: higher for a pressed or shouted voice.
    tilt_hz: f64,
    /// Level of breath noise relative to the pulses.
    breathy: f64,
    /// Syllables per second.
    pace: f64,
}

impl Voice {
    /// A random speaker, between a deep man and a small child.
    pub fn random(random: &mut Random) -> Self {
        let (pitch, formants) = match (random.unit() * 3.0) as u32 {
            0 => (random.range(80.0, 150.0), random.range(0.95, 1.05)),
            1 => (random.range(160.0, 250.0), random.range(1.1, 1.2)),
            _ => (random.range(240.0, 400.0), random.range(1.25, 1.45)),
        };
        Self {
            pitch_hz: pitch,
            formants,
            tilt_hz: random.range(150.0, 600.0),
            breathy: random.range(0.01, 0.2),
            pace: random.range(3.0, 6.0),
        }
    }

    /// The same speaker shouting.
    pub fn shouting(self) -> Self {
        Self { pitch_hz: 1.5 * self.pitch_hz, tilt_hz: 1500.0, breathy: 0.05, pace: 0.5 * self.pace, ..self }
    }
}

/// Speech: phrases of syllables, each a vowel, with or without a preceding hiss or burst.
pub fn speech(voice: &Voice, seconds: f64, random: &mut Random) -> Vec<f64> {
    let count = (seconds * R) as usize;
    let mut out = vec![0.0; count];
    let mut at = random.range(0.0, 0.3);
    while at < seconds {
        let phrase = random.range(3.0, 14.0) as u32;
        let mut pitch = voice.pitch_hz * random.range(1.0, 1.2);
        for _ in 0..phrase {
            let length = random.range(0.6, 1.3) / voice.pace;
            if random.unit() < 0.5 {
                at += consonant(&mut out, at, random);
            }
            vowel(&mut out, at, length, pitch, voice, random);
            at += length;
            pitch *= random.range(0.9, 1.07);
            pitch = pitch.clamp(0.7 * voice.pitch_hz, 1.5 * voice.pitch_hz);
        }
        at += random.range(0.1, 0.9);
    }
    normalised(out)
}

/// A hiss (s, sh, f) or a burst (p, t, k), and its length, s.
fn consonant(out: &mut [f64], at: f64, random: &mut Random) -> f64 {
    let burst = random.unit() < 0.5;
    let length = if burst { random.range(0.01, 0.03) } else { random.range(0.05, 0.14) };
    let corner = if burst { random.range(300.0, 2500.0) } else { random.range(1800.0, 4500.0) };
    let noise = high_passed(white((length * R) as usize, random), R, corner, 2);
    let loud = random.range(0.05, 0.35);
    add(out, at, &shaped(noise, 0.2, 0.3), loud);
    length + random.range(0.0, 0.04)
}

/// One vowel of a voice, at its pitch.
pub fn vowel_of(voice: &Voice, seconds: f64, random: &mut Random) -> Vec<f64> {
    let mut out = vec![0.0; (seconds * R) as usize];
    vowel(&mut out, 0.0, seconds, voice.pitch_hz, voice, random);
    normalised(out)
}

fn vowel(out: &mut [f64], at: f64, length: f64, pitch: f64, voice: &Voice, random: &mut Random) {
    // Mean formants of five vowels of men (Peterson and Barney 1952).
    const VOWELS: [[f64; 3]; 5] = [
        [730.0, 1090.0, 2440.0],
        [530.0, 1840.0, 2480.0],
        [270.0, 2290.0, 3010.0],
        [570.0, 840.0, 2410.0],
        [300.0, 870.0, 2240.0],
    ];
    let formants = VOWELS[(random.unit() * 5.0) as usize];
    let excitation = pulses((length * R) as usize, pitch, random.range(-0.15, 0.1), voice, random);
    let mut sound = vec![0.0; excitation.len()];
    for (formant, gain) in formants.into_iter().zip([1.0, 0.6, 0.3]) {
        let centre = (formant * voice.formants).min(0.45 * R);
        sound.iter_mut().zip(resonance(&excitation, R, centre, 60.0 + 0.05 * centre)).for_each(|(y, x)| *y += gain * x);
    }
    let loud = random.range(0.5, 1.0);
    add(out, at, &shaped(normalised(sound), 0.25, 0.4), loud);
}

/// Glottal pulses, whose corner sets their softness, and breath noise; `glide` is the change of the pitch.
fn pulses(count: usize, pitch: f64, glide: f64, voice: &Voice, random: &mut Random) -> Vec<f64> {
    let mut out: Vec<f64> = white(count, random).into_iter().map(|x| voice.breathy * 0.1 * x).collect();
    let mut at = 0.0;
    while at + 1.0 < count as f64 {
        let (i, part) = (at as usize, at.fract());
        out[i] += 1.0 - part;
        out[i + 1] += part;
        let now = pitch * (1.0 + glide * at / count as f64 + 0.012 * random.signed());
        at += R / now.max(50.0);
    }
    high_passed(low_passed(out, R, voice.tilt_hz, 2), R, 60.0, 1)
}

/// Laughter: bursts of ha, four to six a second, with falling pitch.
pub fn laughter(voice: &Voice, random: &mut Random) -> Vec<f64> {
    let count = random.range(4.0, 14.0) as u32;
    let step = 1.0 / random.range(3.8, 6.0);
    let mut out = vec![0.0; ((f64::from(count) * step + 0.5) * R) as usize];
    let mut pitch = voice.pitch_hz * random.range(1.2, 2.0);
    for i in 0..count {
        let at = f64::from(i) * step;
        let gain = 1.0 - 0.6 * f64::from(i) / f64::from(count);
        let breath = low_passed(high_passed(white((0.3 * step * R) as usize, random), R, 500.0, 1), R, 2500.0, 1);
        add(&mut out, at, &shaped(breath, 0.3, 0.4), 0.3 * gain);
        let mut syllable = vec![0.0; out.len()];
        vowel(&mut syllable, at + 0.25 * step, 0.5 * step, pitch, voice, random);
        out.iter_mut().zip(&syllable).for_each(|(y, x)| *y += gain * x);
        pitch *= random.range(0.92, 1.02);
    }
    normalised(out)
}

/// A cough or a sneeze: an explosion of air of 40–90 ms, then a hoarse rest. Only its sound reaches the capsule, no air.
pub fn cough(voice: &Voice, random: &mut Random) -> Vec<f64> {
    let blasts = random.range(1.0, 4.0) as u32;
    let mut out = vec![0.0; ((0.35 * f64::from(blasts) + 0.4) * R) as usize];
    for i in 0..blasts {
        let at = 0.33 * f64::from(i) + random.range(0.0, 0.04);
        let length = random.range(0.04, 0.12);
        let blast = white((3.0 * length * R) as usize, random);
        let centre = random.range(350.0, 900.0);
        let throat = resonance(&blast, R, centre * voice.formants, 300.0);
        let rest = low_passed(high_passed(blast, R, 150.0, 1), R, random.range(1000.0, 3000.0), 1);
        let sound: Vec<f64> = throat.iter().zip(&rest).map(|(a, b)| 2.0 * a + 0.5 * b).collect();
        add(&mut out, at, &decaying(sound, 0.004, length), 1.0);
        let hoarse = Voice { breathy: 1.5, ..*voice };
        vowel(&mut out, at + length, 0.15, 0.8 * voice.pitch_hz, &hoarse, random);
    }
    normalised(out)
}

/// Whistles, howls, sung notes, telephones, squeaks: a gliding tone, with or without harmonics and breath.
pub fn tone(seconds: f64, random: &mut Random) -> Vec<f64> {
    let f = soffio_math::pow(10.0, random.range(1.9, 3.5));
    let (glide, vibrato, rate) = (random.range(-0.5, 0.5), random.range(0.0, 0.06), random.range(3.0, 8.0));
    let (second, third) = (random.range(0.0, 0.6), random.range(0.0, 0.4));
    let breath = high_passed(white((seconds * R) as usize, random), R, 400.0, 1);
    let airy = random.range(0.0, 0.15);
    let mut angle = 0.0;
    let sound = breath.iter().enumerate().map(|(i, air)| {
        let t = i as f64 / R;
        let now = (f * (1.0 + glide * t / seconds + vibrato * sin(2.0 * PI * rate * t))).min(0.4 * R);
        angle += 2.0 * PI * now / R;
        sin(angle) + second * sin(2.0 * angle) + third * sin(3.0 * angle) + airy * air
    });
    let (rise, fall) = (random.range(0.02, 0.4), random.range(0.05, 0.5));
    normalised(shaped(sound.collect(), rise, fall))
}

/// Fades in and out over shares of the length (sin²).
pub fn shaped(mut sound: Vec<f64>, rise: f64, fall: f64) -> Vec<f64> {
    let count = sound.len() as f64;
    for (i, x) in sound.iter_mut().enumerate() {
        let t = i as f64 / count;
        let part = (t / rise).min((1.0 - t) / fall).min(1.0);
        let s = sin(0.5 * PI * part);
        *x *= s * s;
    }
    sound
}

/// Rises within `attack`, s, and decays with the time constant `decay`, s.
pub fn decaying(mut sound: Vec<f64>, attack: f64, decay: f64) -> Vec<f64> {
    let (up, down) = (exp(-1.0 / (attack * R)), exp(-1.0 / (decay * R)));
    let (mut rising, mut falling) = (1.0, 1.0);
    for x in &mut sound {
        rising *= up;
        falling *= down;
        *x *= (1.0 - rising) * falling;
    }
    sound
}

/// Adds `sound` from `at` seconds on, up to the end of the output.
pub fn add(out: &mut [f64], at: f64, sound: &[f64], gain: f64) {
    let start = ((at * R).max(0.0) as usize).min(out.len());
    out[start..].iter_mut().zip(sound).for_each(|(y, x)| *y += gain * x);
}

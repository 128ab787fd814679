//! Sounds of people: talk near and far, crowds, laughter, coughs, sneezes, sighs, claps, steps and whistling.
//!
//! Levels at 1 m: talk 55 to 68 dB, raised 66 to 74, shouts 80 to 92 (ANSI S3.5, 1997; Pearsons and others 1977).
//! A mouth within 30 cm of the capsule also blows on it with its consonants. That air is no breath at the kiosk: the
//! jets are those of [`super::jet`], as short as the consonants, and count among everything else.

use soffio_math::PI;
use soffio_math::noise::Random;
use soffio_math::{exp, sin};

use super::breath::{self, Aim, modulate};
use super::jet::STEP;
use super::noise::{Draw, RATE, Shape};
use super::stage::Stage;
use super::turbulence::pressure;
use super::voice::{self, Puff, Score, Speaker};

/// Beyond this distance consonants' air does not reach the capsule, m.
const REACH: f64 = 0.4;

/// One person speaks for about `seconds` s at the distance `metres`.
pub(super) fn talk(stage: &mut Stage, random: &mut Random, at: f64, seconds: f64, metres: f64) {
    let child = random.chance(0.2);
    let speaker = voice::draw_speaker(random, child);
    let score = voice::speech(random, &speaker, seconds, 1.0);
    let db = random.range(54.0, 70.0);
    utter(stage, random, at, (&speaker, &score), db, metres);
}

/// Any other vocal sound of one person.
pub(super) fn exclaim(stage: &mut Stage, random: &mut Random, at: f64, metres: f64) {
    let child = random.chance(0.35);
    let speaker = voice::draw_speaker(random, child);
    let (score, db) = match random.whole(0, 4) {
        0 | 1 => {
            let count = random.whole(3, 14);
            (voice::laughter(random, &speaker, count), random.range(60.0, 80.0))
        }
        2 => (voice::shout(random, &speaker), random.range(74.0, 92.0)),
        3 => {
            let seconds = random.range(2.0, 9.0);
            (voice::song(random, &speaker, seconds, false), random.range(60.0, 80.0))
        }
        _ => {
            let seconds = random.range(2.0, 9.0);
            (voice::song(random, &speaker, seconds, true), random.range(48.0, 66.0))
        }
    };
    utter(stage, random, at, (&speaker, &score), db, metres);
}

fn utter(stage: &mut Stage, random: &mut Random, at: f64, who: (&Speaker, &Score), db: f64, metres: f64) {
    let wave = voice::perform(random, who.0, who.1);
    stage.sound(at, &wave, db, metres);
    if metres < REACH {
        let tilt = random.range(0.0, 0.35);
        let turn = 2.0 * PI * random.unit();
        let off = (tilt * sin(turn), tilt * sin(turn + 0.5 * PI));
        let aim = Aim { distance: metres, off, wander: (0.05, 0.8), lag: 0.0, scale: 0.08 };
        for puff in &who.1.puffs {
            puff_of_air(stage, random, at, puff, &aim);
        }
    }
}

/// A consonant's jet.
fn puff_of_air(stage: &mut Stage, random: &mut Random, at: f64, puff: &Puff, aim: &Aim) {
    let steps = (puff.seconds / STEP).max(4.0) as usize;
    let arch = |i: usize| sin(PI * (i as f64 + 0.5) / steps as f64);
    let lips: Vec<f64> = (0..steps).map(|i| puff.speed * arch(i)).collect();
    let (air, _) = breath::at_capsules(random, &lips, puff.diameter, aim, stage.port.spacing);
    let waves = pressure(&mut stage.workshop, random, &air, &stage.port);
    stage.pressure(at + puff.at, &waves, false);
}

/// Many people talk, all over the room, for `seconds` s, `db` at the microphone.
pub(super) fn babble(stage: &mut Stage, random: &mut Random, at: f64, seconds: f64, db: f64, children: bool) {
    let count = random.whole(3, 5);
    let length = seconds.min(11.0);
    let mut sum = vec![0.0_f32; (seconds * RATE) as usize];
    for _ in 0..count {
        let child = random.chance(if children { 0.9 } else { 0.1 });
        let speaker = voice::draw_speaker(random, child);
        let score = if children && random.chance(0.4) {
            voice::shout(random, &speaker)
        } else {
            voice::speech(random, &speaker, length, 1.0)
        };
        let wave = voice::perform(random, &speaker, &score);
        // The same person again and again, at other places and pitches: nobody follows one of so many.
        for _ in 0..random.whole(2, 5) {
            let (pace, gain) = (random.range(0.85, 1.2), random.log_range(0.2, 1.0) as f32);
            let mut place = random.unit() * wave.len() as f64;
            for y in &mut sum {
                let (k, t) = (place as usize, (place - place.floor()) as f32);
                let (a, b) = (wave[k], wave[if k + 1 < wave.len() { k + 1 } else { 0 }]);
                *y += gain * (a + t * (b - a));
                place += pace;
                if place >= wave.len() as f64 {
                    place -= wave.len() as f64;
                }
            }
        }
    }
    voice::normalise(&mut sum);
    let edge = (0.5 / STEP) as usize;
    let steps = (seconds / STEP) as usize;
    let gains: Vec<f64> = (0..steps).map(|i| (i.min(steps - i) as f64 / edge as f64).min(1.0)).collect();
    modulate(&mut sum, &gains);
    stage.diffuse(at, &sum, db);
}

/// A noise burst with an exponential rise and fall, s.
fn burst(stage: &mut Stage, random: &mut Random, shape: &Shape, seconds: f64, rise: f64, fall: f64) -> Vec<f32> {
    let mut wave = stage.noise(random, seconds, shape);
    let steps = (seconds / STEP) as usize + 1;
    let gain = |t: f64| (1.0 - exp(-t / rise)) * exp(-t / fall);
    let gains: Vec<f64> = (0..steps).map(|i| gain(i as f64 * STEP)).collect();
    modulate(&mut wave, &gains);
    voice::normalise(&mut wave);
    wave
}

/// Coughs of one person: one to four, each a blast and a voiced or noisy end.
pub(super) fn cough(stage: &mut Stage, random: &mut Random, at: f64, metres: f64) {
    let (mut t, db) = (at, random.range(66.0, 86.0));
    let low = random.log_range(250.0, 600.0);
    for _ in 0..random.whole(1, 4) {
        let shape = Shape::corners(&[(60.0, -24.0), (low, -3.0), (3.0 * low, 0.0), (4000.0, -12.0), (8000.0, -24.0)]);
        let fall = random.range(0.05, 0.15);
        let rise = random.range(0.003, 0.02);
        let wave = burst(stage, random, &shape, 0.4, rise, fall);
        stage.sound(t, &wave, db + random.range(-4.0, 2.0), metres);
        t += random.range(0.3, 0.8);
    }
}

/// A sneeze: a breath in, and a blast.
pub(super) fn sneeze(stage: &mut Stage, random: &mut Random, at: f64, metres: f64) {
    let inward = Shape::corners(&[(300.0, -20.0), (1500.0, 0.0), (6000.0, -10.0)]);
    let wave = burst(stage, random, &inward, 0.6, 0.3, 0.3);
    stage.sound(at, &wave, random.range(40.0, 56.0), metres);
    let outward = Shape::corners(&[(150.0, -15.0), (800.0, 0.0), (4000.0, -3.0), (8000.0, -10.0)]);
    let fall = random.range(0.08, 0.2);
    let wave = burst(stage, random, &outward, 0.6, 0.01, fall);
    stage.sound(at + 0.65, &wave, random.range(74.0, 92.0), metres);
}

/// A sigh or a blown breath that is heard and does not reach the microphone.
pub(super) fn sigh(stage: &mut Stage, random: &mut Random, at: f64, metres: f64) {
    let centre = random.log_range(500.0, 3500.0);
    let shape = Shape::corners(&[(80.0, -35.0), (0.5 * centre, -6.0), (centre, 0.0), (7000.0, -14.0)]);
    let seconds = random.range(0.4, 2.5);
    let wave = burst(stage, random, &shape, seconds, 0.3 * seconds, 0.4 * seconds);
    stage.sound(at, &wave, random.range(38.0, 66.0), metres);
}

/// Claps of one person, or applause of many (`diffuse`).
pub(super) fn claps(stage: &mut Stage, random: &mut Random, at: f64, metres: f64) {
    let (period, db) = (random.range(0.2, 0.6), random.range(72.0, 92.0));
    for i in 0..random.whole(1, 10) {
        let centre = random.log_range(600.0, 2500.0);
        let shape = Shape::corners(&[(100.0, -24.0), (centre, 0.0), (4.0 * centre, -12.0)]);
        let fall = random.range(0.006, 0.02);
        let wave = burst(stage, random, &shape, 0.1, 0.0008, fall);
        stage.sound(at + i as f64 * period, &wave, db, metres);
    }
}

/// Applause of many for `seconds` s.
pub(super) fn applause(stage: &mut Stage, random: &mut Random, at: f64, seconds: f64) {
    let mut sum = vec![0.0_f32; (seconds * RATE) as usize];
    let rate = random.log_range(20.0, 150.0);
    let shape = Shape::corners(&[(100.0, -24.0), (1200.0, 0.0), (5000.0, -12.0)]);
    let claps: Vec<Vec<f32>> = (0..6).map(|_| burst(stage, random, &shape, 0.06, 0.0008, 0.012)).collect();
    for _ in 0..(rate * seconds) as usize {
        let (clap, t) = (random.whole(0, 5), random.unit() * seconds);
        let loud = sin(PI * t / seconds) * random.log_range(0.2, 1.0);
        super::stage::add(&mut sum, t * RATE, &claps[clap], loud);
    }
    voice::normalise(&mut sum);
    stage.diffuse(at, &sum, random.range(55.0, 82.0));
}

/// Whistling of a tune, with the hiss of the lips.
pub(super) fn whistling(stage: &mut Stage, random: &mut Random, at: f64, metres: f64) {
    let seconds = random.range(1.0, 6.0);
    let mut wave = Vec::with_capacity((seconds * RATE) as usize);
    let (mut f, mut aim, mut phase) = (1200.0, 1200.0, 0.0_f64);
    let mut left = 0_usize;
    for i in 0..(seconds * RATE) as usize {
        if left == 0 {
            aim = random.log_range(700.0, 2600.0);
            left = (random.range(0.15, 0.7) * RATE) as usize;
        }
        left -= 1;
        f += 0.001 * (aim - f);
        phase += f / RATE;
        if phase >= 1.0 {
            phase -= 1.0;
        }
        let half = if phase < 0.5 { 16.0 * phase * (0.5 - phase) } else { -16.0 * (phase - 0.5) * (1.0 - phase) };
        let edge = (i.min(left + 400) as f64 / 800.0).min(1.0);
        wave.push((edge * (half + 0.05 * random.signed())) as f32);
    }
    stage.sound(at, &wave, random.range(62.0, 82.0), metres);
}

/// Steps of one or more people: heel and sole on stone, wood or carpet.
pub(super) fn footsteps(stage: &mut Stage, random: &mut Random, at: f64, seconds: f64) {
    let (period, hard) = (random.range(0.35, 0.7), random.unit());
    let (db, mut metres) = (random.range(40.0, 62.0), random.range(1.0, 6.0));
    let nearer = random.range(-0.9, 0.9);
    // A floor that carries the steps into the stand.
    let floor = random.chance(0.4).then(|| random.range(-10.0, 20.0));
    let mut t = 0.0;
    while t < seconds {
        let centre = 60.0 + 900.0 * hard * random.range(0.7, 1.4);
        let shape = Shape::corners(&[(25.0, -6.0), (80.0, 0.0), (centre.max(100.0), 0.0), (6.0 * centre, -20.0)]);
        let fall = 0.012 + 0.03 * (1.0 - hard);
        let wave = burst(stage, random, &shape, 0.2, 0.002, fall);
        stage.sound(at + t, &wave, db + random.range(-3.0, 3.0), metres);
        if let Some(more) = floor {
            stage.contact(at + t, &wave, db + more, 1.0);
        }
        metres = (metres - nearer * period).max(0.5);
        t += period * random.range(0.92, 1.08);
    }
}

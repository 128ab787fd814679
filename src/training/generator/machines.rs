//! Machines, traffic and weather: ventilation, hums, vacuum cleaners, hand dryers, trains, lifts, rain.
//!
//! Ventilation falls by 5 dB an octave, as the noise-criterion curves do (ASHRAE Handbook, 2019, chapter 49). Motors
//! add tones at multiples of their rate to broad noise. Levels are those at the microphone, dB.

use soffio_math::noise::Random;
use soffio_math::{PI, exp};

use super::breath::modulate;
use super::draught::switched;
use super::jet::STEP;
use super::noise::{Draw, Drift, RATE, Shape};
use super::objects::ring;
use super::stage::{Stage, add};
use super::voice::normalise;

/// Ventilation and the room's rest noise over the whole scene: `db` at the microphone.
pub(super) fn ventilation(stage: &mut Stage, random: &mut Random, seconds: f64, db: f64) {
    let (slope, low) = (random.range(2.0, 7.0), random.log_range(20.0, 120.0));
    let (bump, height) = (random.log_range(60.0, 900.0), random.range(0.0, 12.0));
    let shape = Shape::new(RATE, |f| {
        let octaves = soffio_math::ln(f.max(low) / low) / std::f64::consts::LN_2;
        let x = soffio_math::ln(f / bump) / 0.4;
        let below = (f / low).min(1.0);
        below * soffio_math::pow(10.0, (-slope * octaves + height * exp(-x * x)) / 20.0)
    });
    let wave = stage.noise(random, seconds, &shape);
    stage.diffuse(0.0, &wave, db);
}

/// Tones at multiples of `hertz`, with random strengths, root mean square 1.
fn tones(random: &mut Random, seconds: f64, hertz: f64, count: usize, fall: f64) -> Vec<f32> {
    let mut wave = vec![0.0_f32; (seconds * RATE) as usize];
    for k in 1..=count {
        let f = hertz * k as f64;
        if f < 7500.0 {
            let gain = random.log_range(0.1, 1.0) / soffio_math::pow(k as f64, fall);
            ring(&mut wave, f, 1e6, gain, 2.0 * PI * random.unit());
        }
    }
    normalise(&mut wave);
    wave
}

/// Electrical hum in the cable, of 50 or 60 Hz and its harmonics: straight onto both signals, as a pressure.
pub(super) fn hum(stage: &mut Stage, random: &mut Random, seconds: f64) {
    let mains = random.pick(&[50.0, 50.0, 60.0]);
    let (count, fall) = (random.whole(1, 14), random.range(0.0, 1.5));
    let wave = tones(random, seconds, mains, count, fall);
    let balance = random.range(0.5, 1.5);
    stage.contact(0.0, &wave, random.range(34.0, 84.0), balance);
}

/// A vacuum cleaner, hand dryer, drill or grinder: on and off, broad noise and the motor's tones.
pub(super) fn motor(stage: &mut Stage, random: &mut Random, at: f64, seconds: f64) {
    let low = random.log_range(100.0, 800.0);
    let shape = Shape::corners(&[(0.3 * low, -18.0), (low, 0.0), (5.0 * low, -3.0), (8000.0, -16.0)]);
    let mut wave = stage.noise(random, seconds, &shape);
    let rate = random.log_range(80.0, 420.0);
    let count = random.whole(3, 16);
    let tonal = tones(random, seconds, rate, count, 0.7);
    add(&mut wave, 0.0, &tonal, random.range(0.1, 1.2));
    let envelope = if random.chance(0.5) {
        switched(random, seconds, (2.0, 12.0), (0.5, 6.0))
    } else {
        let waver = Drift::new(random, 4.0 * seconds);
        (0..(seconds / STEP) as usize).map(|i| exp(0.3 * waver.at(2.0 * i as f64 * STEP))).collect()
    };
    // A motor needs a quarter of a second to start and to stop.
    let edge = |i: usize| (i.min(envelope.len() - i) as f64 * STEP / 0.25).min(1.0);
    let envelope: Vec<f64> = envelope.iter().enumerate().map(|(i, c)| edge(i) * c * c).collect();
    modulate(&mut wave, &envelope);
    let db = random.range(48.0, 86.0);
    if random.chance(0.5) {
        stage.diffuse(at, &wave, db)
    } else {
        stage.sound(at, &wave, db, random.log_range(0.7, 5.0))
    }
}

/// A car, a train or a lift goes by: a rumble that comes and goes, and shakes the floor.
pub(super) fn rumble(stage: &mut Stage, random: &mut Random, at: f64) {
    let seconds = random.range(4.0, 20.0);
    let low = random.log_range(16.0, 70.0);
    let high = random.log_range(80.0, 500.0);
    let shape = Shape::corners(&[(0.5 * low, -15.0), (low, 0.0), (high, -6.0), (8.0 * high, -40.0)]);
    let mut wave = stage.noise(random, seconds, &shape);
    let (waver, width) = (Drift::new(random, seconds * 4.0), random.range(0.1, 0.35));
    let depth = random.range(0.1, 0.9);
    let gains: Vec<f64> = (0..(seconds / STEP) as usize)
        .map(|i| {
            let t = i as f64 * STEP;
            let x = (t / seconds - 0.5) / width;
            t.min(seconds - t).min(1.0) * exp(-0.5 * x * x + depth * waver.at(4.0 * t))
        })
        .collect();
    modulate(&mut wave, &gains);
    let db = random.range(50.0, 88.0);
    stage.diffuse(at, &wave, db);
    if random.chance(0.5) {
        stage.contact(at, &wave, db - random.range(0.0, 20.0), random.range(0.85, 1.15));
    }
}

/// Rain on a roof or window, or water: a steady noise and its drops.
pub(super) fn rain(stage: &mut Stage, random: &mut Random, seconds: f64) {
    let centre = random.log_range(800.0, 4000.0);
    let shape = Shape::corners(&[(100.0, -25.0), (0.4 * centre, -6.0), (centre, 0.0), (8000.0, -6.0)]);
    let mut wave = stage.noise(random, seconds, &shape);
    let mut drop = vec![0.0_f32; 600];
    ring(&mut drop, random.log_range(500.0, 3000.0), 0.004, 1.0, 0.0);
    for _ in 0..(seconds * random.log_range(2.0, 60.0)) as usize {
        let (at, loud) = (random.unit() * seconds, random.log_range(0.3, 6.0));
        add(&mut wave, at * RATE, &drop, loud);
    }
    normalise(&mut wave);
    stage.diffuse(0.0, &wave, random.range(35.0, 68.0));
}

/// Crackle of a cable, a mobile phone's buzz (217 Hz bursts), dropped blocks and steps of gain: faults of the finished
/// signals.
pub(super) fn faults(random: &mut Random, capsules: &mut [Vec<f32>]) {
    let length = capsules[0].len();
    let seconds = length as f64 / RATE;
    let one = random.chance(0.5).then(|| random.whole(0, 1));
    let hit: Vec<usize> = (0..2).filter(|i| one.is_none_or(|one| one == *i)).collect();
    match random.whole(0, 3) {
        0 => {
            let strength = random.log_range(0.003, 0.5);
            for _ in 0..random.whole(1, 6) {
                let start = (random.unit() * seconds * RATE) as usize;
                let span = (random.log_range(0.05, 1.5) * RATE) as usize;
                let rate = random.log_range(5.0, 400.0) / RATE;
                let (mut level, keep) = (0.0, exp(-1.0 / (random.log_range(0.0002, 0.01) * RATE)));
                for i in start..(start + span).min(length) {
                    level *= keep;
                    if random.chance(rate) {
                        level += strength * random.normal();
                    }
                    hit.iter().for_each(|c| capsules[*c][i] += level as f32);
                }
            }
        }
        1 => {
            let start = (random.unit() * seconds * RATE) as usize;
            let span = (random.range(0.5, 4.0) * RATE) as usize;
            let (strength, period) = (random.log_range(0.002, 0.2), RATE / 216.7);
            for i in start..(start + span).min(length) {
                let phase = (i - start) as f64 / period;
                let frame = (phase / 8.0) as usize;
                // Time slots of eighths, with the pauses of the protocol every 26th frame.
                if phase - phase.floor() < 0.125 && frame % 26 != 25 {
                    hit.iter().for_each(|c| capsules[*c][i] += strength as f32);
                }
            }
        }
        2 => {
            for _ in 0..random.whole(1, 8) {
                let start = (random.unit() * seconds * RATE) as usize;
                let span = (random.log_range(0.004, 0.4) * RATE) as usize;
                for i in start..(start + span).min(length) {
                    hit.iter().for_each(|c| capsules[*c][i] = 0.0);
                }
            }
        }
        _ => {
            for _ in 0..random.whole(1, 3) {
                let start = (random.unit() * seconds * RATE) as usize;
                let gain = random.log_range(0.3, 3.0) as f32;
                for capsule in capsules.iter_mut() {
                    capsule[start.min(length)..].iter_mut().for_each(|x| *x = (*x * gain).clamp(-1.0, 1.0));
                }
            }
        }
    }
}

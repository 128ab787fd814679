//! Things: knocks, doors, chairs, drops, luggage, bells, clocks, and hands on the microphone or its table.
//!
//! A struck thing is a sum of decaying modes, x(t) = Σ a_i e^(−t/τ_i) sin(2π f_i t) (Morse and Ingard, Theoretical
//! Acoustics, 1968, chapter 4). A touch of the mount reaches both capsules at once through the solid, so it is
//! coherent, mostly at 20 to 300 Hz. Sliding is a row of small slips at random times, and rubbing foam adds their crackle.

use soffio_math::noise::Random;
use soffio_math::{PI, exp, sincos};

use super::breath::modulate;
use super::jet::STEP;
use super::noise::{Draw, Drift, RATE, Shape};
use super::stage::{Stage, add};
use super::voice::normalise;

/// Adds one decaying mode, by a rotating phasor.
pub(super) fn ring(wave: &mut [f32], hertz: f64, decay: f64, gain: f64, phase: f64) {
    let r = exp(-1.0 / (decay * RATE));
    let (s, c) = sincos(2.0 * PI * hertz / RATE);
    let (s, c) = (r * s, r * c);
    let (y, x) = sincos(phase);
    let (mut x, mut y) = (gain * x, gain * y);
    for (i, out) in wave.iter_mut().enumerate() {
        *out += y as f32;
        (x, y) = (c * x - s * y, s * x + c * y);
        if i & 255 == 0 && x.abs() + y.abs() < 1e-5 * gain {
            break;
        }
    }
}

/// A struck thing: `count` modes between `low` and `high` Hz, decays within `decay` s, peak 1.
fn struck(random: &mut Random, count: usize, band: (f64, f64), decay: (f64, f64)) -> Vec<f32> {
    let mut wave = vec![0.0_f32; (8.0 * decay.1 * RATE) as usize + 64];
    for _ in 0..count {
        let f = random.log_range(band.0, band.1);
        let slow = random.log_range(decay.0, decay.1);
        ring(&mut wave, f, slow, random.range(0.2, 1.0), 0.3 * random.signed());
    }
    // The blow itself is not sudden: a fifth of a millisecond up.
    for (i, x) in wave.iter_mut().take(4).enumerate() {
        *x *= i as f32 / 4.0;
    }
    let peak = wave.iter().fold(1e-9_f32, |p, x| p.max(x.abs()));
    wave.iter_mut().for_each(|x| *x /= peak);
    wave
}

/// Knocks on the table or the mount: one to twelve, by hand, with their sound in the air.
pub(super) fn knocks(stage: &mut Stage, random: &mut Random, at: f64) {
    let (mut t, period) = (at, random.range(0.12, 0.9));
    let (low, balance) = (random.log_range(20.0, 120.0), random.range(0.6, 1.5));
    let db = random.range(70.0, 118.0);
    for _ in 0..random.whole(1, 12) {
        let count = random.whole(2, 6);
        let solid = struck(random, count, (low, 4.0 * low), (0.01, 0.12));
        stage.contact(t, &solid, db + random.range(-6.0, 3.0), balance);
        let air = struck(random, 6, (200.0, 3000.0), (0.004, 0.02));
        stage.sound(t, &air, (db - 30.0).max(50.0), 0.4);
        t += period * random.range(0.7, 1.4);
    }
}

/// The microphone or its table is moved, slid or held: a noise of the solid that comes and goes.
pub(super) fn handling(stage: &mut Stage, random: &mut Random, at: f64) {
    let seconds = random.log_range(0.3, 5.0);
    let low = random.log_range(15.0, 80.0);
    let high = random.log_range(100.0, 900.0);
    let fall = random.range(-30.0, -12.0);
    let shape = Shape::corners(&[(0.5 * low, -20.0), (low, 0.0), (high, -6.0), (8.0 * high, fall)]);
    let mut wave = stage.noise(random, seconds, &shape);
    let rate = random.log_range(2.0, 25.0);
    let waver = Drift::new(random, seconds * rate + 4.0);
    let rough = random.range(0.3, 2.2);
    let steps = (seconds / STEP) as usize;
    let gains: Vec<f64> = (0..steps)
        .map(|i| {
            let edge = (i.min(steps - i) as f64 * STEP / 0.08).min(1.0);
            edge * exp(rough * waver.at(i as f64 * STEP * rate))
        })
        .collect();
    modulate(&mut wave, &gains);
    normalise(&mut wave);
    stage.contact(at, &wave, random.range(66.0, 108.0), random.range(0.5, 1.8));
}

/// A hand taps or rubs the foam: dull thumps, or crackle over a rumble.
pub(super) fn foam(stage: &mut Stage, random: &mut Random, at: f64) {
    if random.chance(0.45) {
        let mut t = at;
        let (db, balance) = (random.range(80.0, 114.0), random.range(0.25, 2.0));
        for _ in 0..random.whole(1, 9) {
            let thump = struck(random, 4, (18.0, 260.0), (0.008, 0.06));
            stage.contact(t, &thump, db + random.range(-8.0, 2.0), balance);
            t += random.range(0.1, 0.6);
        }
        return;
    }
    let seconds = random.log_range(0.4, 4.0);
    let mut wave = vec![0.0_f32; (seconds * RATE) as usize];
    let (rate, stroke) = (random.log_range(60.0, 900.0), random.range(0.7, 4.0));
    let waver = Drift::new(random, seconds * stroke * 2.0 + 4.0);
    let mut t = 0.0;
    let decay = (random.log_range(0.0003, 0.003), random.log_range(0.003, 0.02));
    let band = (random.log_range(30.0, 300.0), random.log_range(500.0, 6000.0));
    let slips: Vec<Vec<f32>> = (0..12).map(|_| struck(random, 2, band, decay)).collect();
    while t < seconds {
        // More and stronger slips in the middle of a stroke.
        let pace = exp(1.2 * waver.at(t * stroke * 2.0));
        let slip = random.whole(0, 11);
        add(&mut wave, t * RATE, &slips[slip], pace.min(3.0) * random.log_range(0.05, 1.0));
        t += random.range(0.2, 1.8) / (rate * pace.clamp(0.3, 3.0));
    }
    normalise(&mut wave);
    let db = random.range(66.0, 104.0);
    stage.contact(at, &wave, db, random.range(0.2, 2.0));
    let rumble = Shape::corners(&[(12.0, -12.0), (30.0, 0.0), (150.0, -8.0), (600.0, -35.0)]);
    let mut low = stage.noise(random, seconds, &rumble);
    let steps = (seconds / STEP) as usize;
    let gains: Vec<f64> = (0..steps).map(|i| exp(0.9 * waver.at(i as f64 * STEP * stroke * 2.0))).collect();
    modulate(&mut low, &gains);
    normalise(&mut low);
    stage.contact(at, &low, db + random.range(-14.0, 8.0), random.range(0.4, 1.6));
}

/// A door, a slam, a falling thing: a low boom in the air, a clatter above it, and the floor's shake.
pub(super) fn slam(stage: &mut Stage, random: &mut Random, at: f64) {
    let metres = random.log_range(1.0, 15.0);
    let db = random.range(70.0, 106.0);
    let boom = struck(random, 8, (18.0, 140.0), (0.04, 0.35));
    stage.sound(at, &boom, db, metres);
    let clatter = struck(random, 12, (150.0, 2500.0), (0.006, 0.06));
    stage.sound(at + 0.003, &clatter, db - random.range(4.0, 18.0), metres);
    if random.chance(0.5) {
        let shake = struck(random, 4, (12.0, 60.0), (0.05, 0.3));
        stage.contact(at, &shake, db - random.range(5.0, 25.0), random.range(0.8, 1.25));
    }
}

/// A door two rooms away, a blast, something heavy on the floor above: bursts of low noise that die away, one or many.
pub(super) fn boom(stage: &mut Stage, random: &mut Random, at: f64) {
    let (metres, db) = (random.log_range(1.0, 20.0), random.range(58.0, 104.0));
    let (count, spread) = (random.pick(&[1, 1, 1, 2, 3, 6, 12]), random.range(0.3, 5.0));
    let solid = random.chance(0.4).then(|| random.range(3.0, 25.0));
    for i in 0..count {
        let (low, high) = (random.log_range(15.0, 60.0), random.log_range(60.0, 700.0));
        let shape = Shape::corners(&[(0.5 * low, -12.0), (low, 0.0), (high.max(low), -3.0), (5.0 * high, -32.0)]);
        let (rise, fall) = (random.log_range(0.002, 0.2), random.log_range(0.03, 0.8));
        let mut wave = stage.noise(random, rise + 6.0 * fall, &shape);
        let gains: Vec<f64> = (0..((rise + 6.0 * fall) / STEP) as usize)
            .map(|k| {
                let t = k as f64 * STEP;
                (t / rise).min(1.0) * exp(-(t - rise).max(0.0) / fall)
            })
            .collect();
        modulate(&mut wave, &gains);
        normalise(&mut wave);
        let from = at + if i == 0 { 0.0 } else { spread * random.unit() };
        let loud = db - random.range(0.0, 12.0);
        stage.sound(from, &wave, loud, metres);
        if let Some(less) = solid {
            stage.contact(from, &wave, loud - less, random.range(0.8, 1.25));
        }
    }
}

/// A thing falls and bounces: ever faster and weaker knocks of the same modes.
pub(super) fn drop_thing(stage: &mut Stage, random: &mut Random, at: f64) {
    let low = random.log_range(150.0, 2000.0);
    let decay = random.log_range(0.01, 0.2);
    let sound = struck(random, 9, (low, 5.0 * low), (0.2 * decay, decay));
    let (mut gap, mut t, mut db) = (random.range(0.15, 0.45), at, random.range(66.0, 90.0));
    let metres = random.log_range(0.5, 6.0);
    for _ in 0..random.whole(1, 7) {
        stage.sound(t, &sound, db, metres);
        t += gap;
        gap *= random.range(0.5, 0.8);
        db -= random.range(2.0, 7.0);
    }
}

/// A chair is pushed: stick and slip at 30 to 300 Hz, with its harmonics.
pub(super) fn chair(stage: &mut Stage, random: &mut Random, at: f64) {
    let seconds = random.range(0.2, 1.5);
    let mut wave = vec![0.0_f32; (seconds * RATE) as usize];
    let pace = random.log_range(30.0, 300.0);
    let slip = struck(random, 5, (150.0, 3000.0), (0.002, 0.012));
    let mut t = 0.0;
    while t < seconds {
        add(&mut wave, t * RATE, &slip, random.range(0.3, 1.0));
        t += random.range(0.85, 1.15) / pace;
    }
    normalise(&mut wave);
    stage.sound(at, &wave, random.range(58.0, 80.0), random.log_range(0.6, 6.0));
}

/// Luggage rolls past: the joints of a floor, and a rumble.
pub(super) fn luggage(stage: &mut Stage, random: &mut Random, at: f64) {
    let seconds = random.range(3.0, 10.0);
    let shape = Shape::corners(&[(30.0, -8.0), (120.0, 0.0), (700.0, -3.0), (5000.0, -25.0)]);
    let mut wave = stage.noise(random, seconds, &shape);
    let joint = random.range(3.0, 15.0);
    let waver = Drift::new(random, seconds * 8.0);
    let steps = (seconds / STEP) as usize;
    let gains: Vec<f64> = (0..steps)
        .map(|i| {
            let t = i as f64 * STEP;
            let near = 1.0 / (1.0 + 8.0 * (t / seconds - 0.5) * (t / seconds - 0.5) * 4.0);
            let beat = t * joint - (t * joint).floor();
            near * (0.5 + exp(-6.0 * beat) + 0.3 * waver.at(t * 8.0)).max(0.1)
        })
        .collect();
    modulate(&mut wave, &gains);
    normalise(&mut wave);
    stage.sound(at, &wave, random.range(58.0, 78.0), random.log_range(1.0, 5.0));
}

/// Rods, bells or a glass are struck: inharmonic modes of a free bar, 1 : 2.757 : 5.404 : 8.933 (Rossing 2000).
pub(super) fn chimes(random: &mut Random, seconds: f64) -> Vec<f32> {
    const BAR: [f64; 4] = [1.0, 2.757, 5.404, 8.933];
    let mut wave = vec![0.0_f32; (seconds * RATE) as usize];
    let pace = random.log_range(0.4, 5.0);
    let low = random.log_range(50.0, 900.0);
    let decay = random.log_range(0.2, 3.0);
    let mut t = 0.0;
    while t < seconds {
        let f = low * random.pick(&[1.0, 1.125, 1.25, 1.5, 1.667, 2.0, 2.5]);
        let loud = random.log_range(0.1, 1.0);
        let start = ((t * RATE) as usize).min(wave.len());
        for (i, ratio) in BAR.iter().enumerate().filter(|(_, ratio)| f * **ratio < 7500.0) {
            let part = loud / (1.0 + i as f64 * random.range(0.3, 2.0));
            ring(&mut wave[start..], f * ratio, decay / (1.0 + i as f64), part, 0.0);
        }
        t += random.range(0.1, 1.9) / pace;
    }
    normalise(&mut wave);
    wave
}

/// A clock ticks.
pub(super) fn clock(stage: &mut Stage, random: &mut Random, at: f64, seconds: f64) {
    let low = random.log_range(600.0, 2500.0);
    let two = [0, 1].map(|_| struck(random, 4, (low, 3.0 * low), (0.001, 0.008)));
    let (period, db) = (random.pick(&[0.25, 0.5, 1.0]), random.range(38.0, 62.0));
    for i in 0..(seconds / period) as usize {
        stage.sound(at + i as f64 * period, &two[i % 2], db, 1.0);
    }
}

//! Synthesis of museum noises other than people: air, steps, doors, wheels, trains, weather, machines, music.
//!
//! Each sound is dry (the room comes later). Sustained sounds have unit RMS, events a unit peak. All are models with random parameters
//! within wide bounds, so that no detector learns a single door.

use super::RATE;
use super::voices::{add, decaying, shaped};
use crate::filters::{high_passed, low_passed, normalised, peaked, resonance, white};
use soffio_math::noise::{Random, perlin1};
use soffio_math::{PI, cos, exp, pow, sin};

const R: f64 = RATE as f64;

fn samples(seconds: f64) -> usize {
    (seconds * R).max(1.0) as usize
}

/// Noise whose spectrum is a random mixture of four low-passed noises: any ventilation, any distant street.
pub fn air(seconds: f64, random: &mut Random) -> Vec<f64> {
    let mut out = vec![0.0; samples(seconds)];
    for (low, high) in [(25.0, 70.0), (70.0, 250.0), (250.0, 900.0), (900.0, 5000.0)] {
        let layer =
            normalised(low_passed(white(out.len(), random), R, random.range(low, high), 1 + (low < 60.0) as usize));
        let gain = pow(10.0, random.range(-1.0, 0.0));
        out.iter_mut().zip(&layer).for_each(|(y, x)| *y += gain * x);
    }
    // A fan may hum.
    if random.unit() < 0.4 {
        let (f, gain) = (random.range(25.0, 240.0), random.range(0.05, 0.8));
        out.iter_mut().enumerate().for_each(|(i, y)| *y += gain * sin(2.0 * PI * f * i as f64 / R));
    }
    normalised(out)
}

/// Slow random modulation between `least` and 1, at about `hz`.
fn swell(sound: &mut [f64], hz: f64, least: f64, random: &mut Random) {
    let seed = random.word();
    let at = |i: usize| (0.5 + 0.8 * perlin1(hz * i as f64 / R, seed)).clamp(0.0, 1.0);
    sound.iter_mut().enumerate().for_each(|(i, x)| *x *= least + (1.0 - least) * at(i));
}

/// Ventilation that starts or stops within 0.1–3 s.
pub fn switched_air(seconds: f64, random: &mut Random) -> Vec<f64> {
    let mut out = air(seconds, random);
    let (on, up) = (random.range(0.1, 0.4) * seconds, random.range(0.1, 3.0));
    let (off, down) = (random.range(0.6, 0.95) * seconds, random.range(0.1, 3.0));
    for (i, x) in out.iter_mut().enumerate() {
        let t = i as f64 / R;
        *x *= ((t - on) / up).clamp(0.0, 1.0) * (1.0 - (t - off) / down).clamp(0.0, 1.0);
    }
    out
}

/// A person walking over wood, stone, metal or carpet.
pub fn footsteps(seconds: f64, random: &mut Random) -> Vec<f64> {
    let mut out = vec![0.0; samples(seconds)];
    let (pace, corner) = (random.range(1.4, 3.0), pow(10.0, random.range(2.0, 3.4)));
    let (heel, ring) = (random.range(0.01, 0.08), random.range(80.0, 1200.0));
    let metal = random.unit() < 0.3;
    let mut at = random.range(0.0, 0.6);
    while at < seconds {
        let noise = white(samples(0.5), random);
        let body = low_passed(noise.clone(), R, corner, 2);
        let mut step = decaying(normalised(body), 0.002, heel * random.range(0.7, 1.4));
        if metal {
            // A plate with several modes.
            for k in 1..5 {
                let mode =
                    resonance(&noise[..200], R, (ring * f64::from(k) * random.range(0.9, 1.3)).min(7000.0), 12.0);
                let mut tail = mode;
                tail.resize(samples(0.5), 0.0);
                let f = ring * f64::from(k);
                tail.iter_mut().enumerate().for_each(|(i, x)| {
                    let t = i as f64 / R;
                    *x += 0.5 * sin(2.0 * PI * f * t) * exp(-t / 0.12) / f64::from(k);
                });
                add(&mut step, 0.0, &tail, 0.7);
            }
        }
        add(&mut out, at, &step, random.range(0.5, 1.0));
        // The sole follows the heel.
        add(&mut out, at + random.range(0.06, 0.16), &step, random.range(0.0, 0.5));
        at += random.range(0.85, 1.15) / pace;
    }
    peaked(out)
}

/// A door: the latch, the slam, the rattle of the frame.
pub fn door(random: &mut Random) -> Vec<f64> {
    let mut out = vec![0.0; samples(1.6)];
    let slam = low_passed(white(samples(1.2), random), R, random.range(60.0, 500.0), 2);
    add(&mut out, 0.15, &decaying(normalised(slam), 0.002, random.range(0.03, 0.25)), 1.0);
    let f = random.range(35.0, 120.0);
    let boom: Vec<f64> = (0..samples(0.8)).map(|i| sin(2.0 * PI * f * i as f64 / R)).collect();
    add(&mut out, 0.15, &decaying(boom, 0.003, random.range(0.03, 0.15)), random.range(0.0, 1.5));
    for _ in 0..(random.unit() * 5.0) as u32 {
        let click = high_passed(white(samples(0.05), random), R, 800.0, 1);
        add(&mut out, random.range(0.0, 0.5), &decaying(click, 0.0005, 0.008), random.range(0.1, 0.6));
    }
    peaked(out)
}

/// A trolley, a suitcase or a wheelchair: rumble of the floor, joints of the tiles, and rattling parts.
pub fn trolley(seconds: f64, random: &mut Random) -> Vec<f64> {
    let corner = random.range(60.0, 300.0);
    let mut out = normalised(low_passed(white(samples(seconds), random), R, corner, 2));
    swell(&mut out, random.range(4.0, 16.0), 0.3, random);
    let rattle = high_passed(white(out.len(), random), R, random.range(400.0, 2000.0), 1);
    let gain = random.range(0.0, 0.5);
    out.iter_mut().zip(&normalised(rattle)).for_each(|(y, x)| *y += gain * x);
    let mut at = 0.0;
    let step = random.range(0.15, 0.8);
    while at < seconds {
        let knock = low_passed(white(samples(0.1), random), R, random.range(80.0, 600.0), 2);
        add(&mut out, at, &decaying(normalised(knock), 0.001, 0.02), random.range(0.5, 2.5));
        at += step * random.range(0.8, 1.2);
    }
    normalised(passing(out, random))
}

/// A train below the floor or a lorry in the street: low rumble that rises and falls over seconds.
pub fn train(seconds: f64, random: &mut Random) -> Vec<f64> {
    let mut out = normalised(low_passed(white(samples(seconds), random), R, random.range(25.0, 120.0), 2));
    swell(&mut out, random.range(1.0, 8.0), 0.5, random);
    let f = random.range(30.0, 90.0);
    let gain = random.range(0.0, 0.8);
    out.iter_mut().enumerate().for_each(|(i, y)| *y += gain * sin(2.0 * PI * f * i as f64 / R));
    normalised(passing(out, random))
}

/// Envelope of a passing source: amplitude 1 / (1 + (t/τ)²).
fn passing(mut sound: Vec<f64>, random: &mut Random) -> Vec<f64> {
    let seconds = sound.len() as f64 / R;
    let (middle, near) = (seconds * random.range(0.3, 0.7), seconds * random.range(0.08, 0.4));
    for (i, x) in sound.iter_mut().enumerate() {
        let t = (i as f64 / R - middle) / near;
        *x /= 1.0 + t * t;
    }
    sound
}

/// Thunder, a blast, or a heavy object that falls on the floor above: rumbles of many bursts.
pub fn thunder(random: &mut Random) -> Vec<f64> {
    let seconds = random.range(1.0, 6.0);
    let mut out = vec![0.0; samples(seconds)];
    let bursts = random.range(1.0, 16.0) as u32;
    for i in 0..bursts {
        let corner = pow(10.0, random.range(1.5, 2.9));
        let burst = low_passed(white(samples(seconds), random), R, corner, 2);
        let sharp = random.range(0.002, 0.25);
        let at = if i == 0 { random.range(0.0, 0.1) } else { random.range(0.0, 0.6) * seconds };
        add(&mut out, at, &decaying(normalised(burst), sharp, random.range(0.08, 0.9)), random.range(0.2, 1.0));
    }
    let crack = low_passed(high_passed(white(out.len(), random), R, 300.0, 1), R, random.range(900.0, 4000.0), 1);
    let gain = random.range(0.0, 0.6);
    add(&mut out, 0.02, &decaying(normalised(crack), 0.005, random.range(0.05, 0.5)), gain);
    peaked(out)
}

/// Rain on a skylight, a fountain, the sea: drops and their blend.
pub fn rain(seconds: f64, random: &mut Random) -> Vec<f64> {
    let mut out = vec![0.0; samples(seconds)];
    let blur = low_passed(
        high_passed(white(out.len(), random), R, pow(10.0, random.range(1.6, 3.0)), 1),
        R,
        pow(10.0, random.range(2.8, 3.8)),
        1,
    );
    out.iter_mut().zip(&normalised(blur)).for_each(|(y, x)| *y += x);
    let rate = pow(10.0, random.range(0.5, 2.7));
    let loud = random.range(0.5, 6.0);
    let mut at = 0.0;
    while at < seconds {
        let f = pow(10.0, random.range(2.2, 3.7));
        let decay = random.range(0.001, 0.012);
        let drop: Vec<f64> = (0..samples(5.0 * decay)).map(|i| sin(2.0 * PI * f * i as f64 / R)).collect();
        add(&mut out, at, &decaying(drop, 0.0004, decay), loud * random.range(0.1, 1.0));
        at += -soffio_math::ln(1.0 - random.unit()) / rate;
    }
    let (hz, least) = (random.range(0.1, 3.0), random.range(0.1, 1.0));
    swell(&mut out, hz, least, random);
    normalised(out)
}

/// Motors, compressors, pumps, propellers, vacuum cleaners: pulses at a low rate, their harmonics, and noise.
pub fn machine(seconds: f64, random: &mut Random) -> Vec<f64> {
    let mut out = vec![0.0; samples(seconds)];
    let f = pow(10.0, random.range(1.1, 2.4));
    let (steep, wobble, seed) = (random.range(0.5, 8.0), random.range(0.0, 0.06), random.word());
    let noise = low_passed(white(out.len(), random), R, pow(10.0, random.range(2.0, 3.6)), 1);
    let noise = normalised(noise);
    let (tone, hiss, chop) = (random.range(0.0, 1.0), random.range(0.1, 1.2), random.range(0.0, 1.0));
    let mut angle = 0.0;
    for (i, y) in out.iter_mut().enumerate() {
        angle += 2.0 * PI * f / R * (1.0 + wobble * perlin1(3.0 * i as f64 / R, seed));
        let pulse = exp(steep * (cos(angle) - 1.0));
        *y = tone * (pulse - 0.3) + hiss * noise[i] * (1.0 - chop + chop * pulse);
    }
    let out = high_passed(out, R, 25.0, 1);
    let start = random.range(0.02, 1.5) / seconds;
    normalised(shaped(out, start.min(0.5), random.range(0.05, 0.3)))
}

/// A vacuum cleaner or a hand dryer: a whistling motor and much air, that starts and stops.
pub fn blower(seconds: f64, random: &mut Random) -> Vec<f64> {
    let hiss = low_passed(high_passed(white(samples(seconds), random), R, random.range(80.0, 400.0), 1), R, 3500.0, 1);
    let rumble = low_passed(white(hiss.len(), random), R, random.range(60.0, 200.0), 2);
    let (f, whistle, low) = (random.range(180.0, 700.0), random.range(0.05, 0.6), random.range(0.0, 0.6));
    let mut angle = 0.0;
    let start = random.range(0.2, 1.2);
    let parts = normalised(hiss).into_iter().zip(normalised(rumble)).enumerate();
    let sound = parts.map(|(i, (h, l))| {
        let speed = (i as f64 / R / start).min(1.0);
        angle += 2.0 * PI * f * speed / R;
        let square = speed * speed;
        square * (h + low * l + whistle * (sin(angle) + 0.5 * sin(3.0 * angle)))
    });
    normalised(shaped(sound.collect(), 0.01, 0.1))
}

/// Music from another room or a phone: chords, a bass, a drum.
pub fn music(seconds: f64, random: &mut Random) -> Vec<f64> {
    let mut out = vec![0.0; samples(seconds)];
    let beat = random.range(0.35, 0.8);
    let root = random.range(55.0, 130.0);
    let (attack, decay) = (random.range(0.004, 0.12), random.range(0.15, 1.5));
    let (bass, drum, brush) = (random.range(0.0, 1.0), random.range(0.0, 1.2), random.range(0.0, 0.4));
    let dull = random.range(0.5, 1.1);
    let mut at = 0.0;
    while at < seconds {
        let steps = [0.0, 3.0, 4.0, 5.0, 7.0, 9.0, 12.0];
        let pick = |random: &mut Random| steps[(random.unit() * 7.0) as usize];
        let base = pick(random);
        for voice in 0..4 {
            let octave = if voice == 0 { 1.0 } else { 2.0 + f64::from(voice / 2) * 2.0 };
            let f = root * octave * pow(2.0, (base + if voice == 0 { 0.0 } else { pick(random) }) / 12.0);
            let loud = if voice == 0 { bass } else { random.range(0.2, 0.6) };
            let mut note = vec![0.0; samples((4.0 * decay).min(2.5))];
            for k in 1..7 {
                let (fk, gain) = (f * f64::from(k), pow(f64::from(k), -2.0 * dull));
                if fk < 6500.0 {
                    note.iter_mut().enumerate().for_each(|(i, y)| *y += gain * sin(2.0 * PI * fk * i as f64 / R));
                }
            }
            add(&mut out, at, &decaying(note, attack, decay), loud);
        }
        let f = random.range(45.0, 80.0);
        let kick = (0..samples(0.3)).map(|i| {
            let t = i as f64 / R;
            sin(2.0 * PI * f * (t + 0.02 * (1.0 - exp(-t / 0.02))))
        });
        add(&mut out, at, &decaying(kick.collect(), 0.003, 0.08), drum);
        let snare = high_passed(white(samples(0.2), random), R, 700.0, 1);
        add(&mut out, at + 0.5 * beat, &decaying(snare, 0.001, 0.05), brush);
        at += beat;
    }
    normalised(out)
}

/// Applause of a few or many.
pub fn applause(seconds: f64, random: &mut Random) -> Vec<f64> {
    let mut out = vec![0.0; samples(seconds)];
    for _ in 0..pow(10.0, random.range(0.0, 1.9)) as u32 {
        let (centre, rate) = (random.range(600.0, 2400.0), random.range(2.0, 5.0));
        let (mut at, loud) = (random.range(0.0, 0.5), random.range(0.2, 1.0));
        while at < seconds {
            add(&mut out, at, &clap(centre, random), loud * random.range(0.7, 1.0));
            at += random.range(0.9, 1.1) / rate;
        }
    }
    peaked(out)
}

/// One clap of two hands: one or two resonances of the hollow between them.
pub fn clap(centre_hz: f64, random: &mut Random) -> Vec<f64> {
    let noise = white(samples(0.12), random);
    let narrow = random.range(0.3, 1.6);
    let mut burst = resonance(&noise, R, centre_hz, narrow * centre_hz);
    if random.unit() < 0.4 {
        let second = resonance(&noise, R, 0.5 * centre_hz, 0.5 * centre_hz);
        let gain = random.range(0.0, 1.0);
        burst.iter_mut().zip(&second).for_each(|(y, x)| *y += gain * x);
    }
    peaked(decaying(burst, 0.0005, random.range(0.003, 0.02)))
}

/// A chair, a shoe or a case dragged over the floor: stick-slip, broadband or squeaking.
pub fn scrape(random: &mut Random) -> Vec<f64> {
    let seconds = random.range(0.2, 1.2);
    let f = pow(10.0, random.range(1.6, 2.9));
    let noise = white(samples(seconds), random);
    let mut angle = 0.0;
    let seed = random.word();
    let slip = noise.iter().enumerate().map(|(i, x)| {
        angle += 2.0 * PI * f / R * (1.0 + 0.4 * perlin1(9.0 * i as f64 / R, seed));
        (0.3 * x + 1.0) * exp(6.0 * (cos(angle) - 1.0))
    });
    let body = high_passed(low_passed(slip.collect(), R, pow(10.0, random.range(2.6, 3.7)), 1), R, 80.0, 1);
    peaked(shaped(body, 0.2, 0.3))
}

/// A dropped object: knocks, keys, a coin.
pub fn drop(random: &mut Random) -> Vec<f64> {
    let mut out = vec![0.0; samples(1.5)];
    let metal = random.unit() < 0.5;
    let (mut at, mut pause, mut loud) = (0.05, random.range(0.05, 0.25), 1.0);
    let f = random.range(1500.0, 5000.0);
    for _ in 0..random.range(1.0, 7.0) as u32 {
        let hit = low_passed(white(samples(0.2), random), R, pow(10.0, random.range(2.0, 3.5)), 2);
        add(&mut out, at, &decaying(normalised(hit), 0.001, random.range(0.005, 0.04)), loud);
        if metal {
            let ring: Vec<f64> = (0..samples(0.4)).map(|i| sin(2.0 * PI * f * i as f64 / R)).collect();
            add(&mut out, at, &decaying(ring, 0.0005, 0.08), 0.5 * loud);
        }
        at += pause;
        pause *= 0.75;
        loud *= random.range(0.4, 0.8);
    }
    peaked(out)
}

/// A bump against the kiosk or its microphone: damped 25–120 Hz, with or without a click.
pub fn bump(random: &mut Random) -> Vec<f64> {
    let (f, decay) = (random.range(25.0, 120.0), random.range(0.02, 0.14));
    let tone: Vec<f64> = (0..samples(0.9)).map(|i| sin(2.0 * PI * f * i as f64 / R)).collect();
    let mut out = decaying(tone, 0.001, decay);
    let click = decaying(white(samples(0.1), random), 0.0005, random.range(0.002, 0.02));
    add(&mut out, 0.0, &click, random.range(0.0, 0.6));
    peaked(out)
}

/// A hand that rubs the microphone or the kiosk: bursts of low noise, each under a fifth of a second.
pub fn handling(random: &mut Random) -> Vec<f64> {
    let mut out = vec![0.0; samples(1.2)];
    let mut at = 0.05;
    for _ in 0..random.range(1.0, 6.0) as u32 {
        let rub = low_passed(white(samples(random.range(0.03, 0.16)), random), R, random.range(60.0, 1500.0), 1);
        add(&mut out, at, &shaped(normalised(rub), 0.3, 0.4), random.range(0.3, 1.0));
        at += random.range(0.15, 0.5);
    }
    peaked(out)
}

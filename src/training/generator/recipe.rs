//! Recipes: which breaths, sounds, draughts and devices make up a scene.
//!
//! A scene has one recipe, which sets what happens most. Over it, independently, lie breaths (55 % of the scenes), a
//! draught (25 %), the kiosk's own sound (25 %) and faults of the device (8 %). Events follow each other with pauses of
//! 0.6 to 20 s.

use soffio_math::noise::Random;

use super::BreathLabel;
use super::breath::{self, Aim, Manner};
use super::draught;
use super::filter::{Biquad, highpass};
use super::noise::{Draw, Drift, RATE, Shape};
use super::stage::{Stage, add};
use super::turbulence::Port;
use super::{jet, machines, music, objects, people, voice};

/// Air on the axis with which visitors are content, m/s.
const NOTICED: f64 = 0.7;

/// Recipes and their weights.
pub(super) const KINDS: [(&str, usize); 12] = [
    ("quiet", 13),
    ("gallery", 16),
    ("crowd", 9),
    ("near speech", 11),
    ("touch", 11),
    ("impacts", 12),
    ("music", 7),
    ("machines", 7),
    ("outdoor", 4),
    ("fan", 4),
    ("rumble", 8),
    ("coughs", 5),
];

/// One of the kinds, by weight.
pub(super) fn kind(random: &mut Random) -> &'static str {
    let all: usize = KINDS.iter().map(|k| k.1).sum();
    let mut left = random.whole(0, all - 1);
    for (kind, weight) in KINDS {
        if left < weight {
            return kind;
        }
        left -= weight;
    }
    "quiet"
}

/// Draws the ports and their foam.
pub(super) fn port(random: &mut Random) -> Port {
    Port {
        coefficient: random.range(0.25, 1.0),
        slope: random.range(5.0 / 3.0, 7.0 / 3.0),
        size: random.log_range(0.001, 0.015),
        wake: (random.log_range(0.0015, 0.01), if random.chance(0.85) { random.log_range(0.03, 1.2) } else { 0.0 }),
        foam: if random.chance(0.25) { random.range(0.015, 0.045) } else { 0.0 },
        spacing: random.log_range(0.01, 0.12),
        decay: random.range(6.0, 14.0),
    }
}

/// What lasts for the whole scene.
pub(super) fn background(stage: &mut Stage, random: &mut Random, kind: &str, seconds: f64) {
    let loud = matches!(kind, "crowd" | "machines" | "outdoor" | "rumble");
    let db = if loud { random.range(32.0, 66.0) } else { random.range(18.0, 56.0) };
    machines::ventilation(stage, random, seconds, db);
    if random.chance(0.25) {
        machines::hum(stage, random, seconds);
    }
    match kind {
        "crowd" => {
            let (db, children) = (random.range(52.0, 78.0), random.chance(0.4));
            people::babble(stage, random, 0.0, seconds, db, children);
        }
        "gallery" if random.chance(0.6) => {
            let db = random.range(36.0, 58.0);
            people::babble(stage, random, 0.0, seconds, db, false);
        }
        "music" => {
            let (db, metres) = (random.range(46.0, 84.0), random.log_range(0.5, 6.0));
            let wave = music::piece(stage, random, seconds);
            stage.sound(0.0, &wave, db, metres);
        }
        "outdoor" => {
            draught::wind(stage, random, seconds);
            if random.chance(0.3) {
                machines::rain(stage, random, seconds);
            }
        }
        "fan" => draught::fan(stage, random, seconds),
        "rumble" if random.chance(0.3) => machines::rain(stage, random, seconds),
        _ => {}
    }
    if !matches!(kind, "outdoor" | "fan") && random.chance(0.2) {
        let envelope = draught::envelope(random, seconds);
        let stream = draught::draw(random);
        draught::blow(stage, random, 0.0, &stream, &envelope);
    }
}

/// Adds one event without breath from `at` s on; its duration, s.
pub(super) fn event(stage: &mut Stage, random: &mut Random, kind: &str, at: f64) -> f64 {
    let usual = if random.chance(0.25) { "gallery" } else { kind };
    match usual {
        "near speech" => {
            let (seconds, metres) = (random.range(1.0, 8.0), random.log_range(0.04, 0.35));
            match random.unit() {
                u if u < 0.75 => people::talk(stage, random, at, seconds, metres),
                u if u < 0.9 => people::exclaim(stage, random, at, metres),
                _ => breath::blow_past(stage, random, at, metres.max(0.08)),
            }
            seconds
        }
        "touch" => {
            match random.whole(0, 4) {
                0 => objects::knocks(stage, random, at),
                1 | 2 => objects::handling(stage, random, at),
                _ => objects::foam(stage, random, at),
            }
            2.5
        }
        "impacts" => {
            match random.whole(0, 8) {
                0 => objects::slam(stage, random, at),
                1 | 7 | 8 => objects::boom(stage, random, at),
                2 => objects::drop_thing(stage, random, at),
                3 => objects::chair(stage, random, at),
                4 => objects::knocks(stage, random, at),
                5 => objects::luggage(stage, random, at),
                _ => {
                    let metres = random.log_range(0.3, 6.0);
                    people::claps(stage, random, at, metres);
                }
            }
            1.5
        }
        "machines" => {
            let seconds = random.range(3.0, 20.0);
            machines::motor(stage, random, at, seconds);
            seconds
        }
        "rumble" if random.chance(0.6) => {
            machines::rumble(stage, random, at);
            8.0
        }
        "rumble" => {
            objects::boom(stage, random, at);
            3.0
        }
        "coughs" => {
            let metres = random.log_range(0.5, 4.0);
            match random.whole(0, 7) {
                0 | 1 => people::cough(stage, random, at, metres),
                2 => people::sneeze(stage, random, at, metres),
                3 | 4 => people::sigh(stage, random, at, metres),
                5 | 6 => breath::blow_past(stage, random, at, 0.3 * metres),
                _ => people::whistling(stage, random, at, metres),
            }
            2.0
        }
        _ => ordinary(stage, random, at),
    }
}

/// What visitors of a gallery do.
fn ordinary(stage: &mut Stage, random: &mut Random, at: f64) -> f64 {
    let metres = random.log_range(0.4, 6.0);
    let seconds = random.range(1.0, 8.0);
    match random.whole(0, 17) {
        0..=4 => people::talk(stage, random, at, seconds, metres),
        5 | 6 => people::exclaim(stage, random, at, metres),
        7 | 8 => people::footsteps(stage, random, at, seconds),
        9 => people::cough(stage, random, at, metres),
        10 => people::sigh(stage, random, at, metres),
        11 if random.chance(0.5) => objects::slam(stage, random, at),
        11 => objects::boom(stage, random, at),
        12 => objects::knocks(stage, random, at),
        13 => people::applause(stage, random, at, seconds),
        14 => objects::clock(stage, random, at, seconds),
        15 => people::whistling(stage, random, at, metres),
        16 => {
            let wave = objects::chimes(random, seconds);
            stage.sound(at, &wave, random.range(45.0, 75.0), metres);
        }
        _ => objects::chair(stage, random, at),
    }
    seconds
}

/// A visitor blows, once or in a row. Adds the labels; the duration, s.
pub(super) fn breaths(stage: &mut Stage, random: &mut Random, at: f64, labels: &mut Vec<BreathLabel>) -> f64 {
    let (foam, spacing) = (stage.port.foam, stage.port.spacing);
    let mut first = breath::draw_manner(random, foam);
    let aim = breath::draw_aim(random, first.name, foam, spacing);
    // Who stands far off blows harder, mostly.
    let arriving = jet::steady(first.speed, first.diameter, aim.distance);
    if arriving < NOTICED && random.chance(0.75) {
        first.harder((NOTICED / arriving) * random.range(0.8, 2.0));
    }
    let count = match random.unit() {
        u if u < 0.6 => 1,
        u if u < 0.85 => random.whole(2, 3),
        _ if first.seconds < 1.2 => random.whole(3, 9),
        _ => 2,
    };
    let (mut t, gap) = (at, random.log_range(0.15, 2.5));
    if random.chance(0.3) {
        breath::inhale(stage, random, at - 0.05, aim.distance);
    }
    for i in 0..count {
        let manner = if i == 0 { first.clone() } else { again(random, &first) };
        if t + manner.seconds > stage.length as f64 / RATE - 1.0 {
            break;
        }
        let aim = if i == 0 { aim } else { moved(random, &aim) };
        labels.push(breath::add_breath(stage, random, t, &manner, &aim));
        t += manner.seconds + gap * random.range(0.6, 1.5);
    }
    t - at
}

/// The same visitor's next breath.
fn again(random: &mut Random, manner: &Manner) -> Manner {
    let change = random.range(0.7, 1.3);
    Manner { speed: manner.speed * change, seconds: manner.seconds * random.range(0.7, 1.2), ..manner.clone() }
}

/// The same visitor, moved a little.
fn moved(random: &mut Random, aim: &Aim) -> Aim {
    let mut shift = || 0.02 * random.normal();
    let off = (aim.off.0 + shift(), aim.off.1 + shift());
    Aim { off, distance: aim.distance * (1.0 + 4.0 * shift()).clamp(0.7, 1.3), ..*aim }
}

/// The kiosk's sound of wind: noise in one or two broad bands, in gusts that begin within a tenth to half a second.
fn gusts(stage: &mut Stage, random: &mut Random, seconds: f64) -> Vec<f32> {
    let bands: [(f64, f64); 2] =
        [(random.log_range(40.0, 150.0), random.log_range(150.0, 600.0)), (200.0, random.log_range(600.0, 3000.0))];
    let mut wave = vec![0.0; (seconds * RATE) as usize];
    for (low, high) in bands {
        let share = random.range(0.0, 1.0) as f32;
        let shape = Shape::corners(&[(0.5 * low, -12.0), (low, 0.0), (high, 0.0), (4.0 * high, -24.0)]);
        wave.iter_mut().zip(stage.noise(random, seconds, &shape)).for_each(|(x, noise)| *x += share * noise);
    }
    let mut at = 0.0;
    while at < seconds {
        let (length, rise, flutter) = (random.log_range(0.4, 5.0), random.range(0.05, 0.5), Drift::new(random, 40.0));
        let pause = random.log_range(0.1, 5.0);
        let range = |t: f64| ((t * RATE) as usize).min((seconds * RATE) as usize);
        for (i, x) in wave[range(at)..range(at + length)].iter_mut().enumerate() {
            let t = i as f64 / RATE;
            let swell = (t / rise).min((length - t) / (0.3 * length)).clamp(0.0, 1.0);
            *x *= (swell * swell * (1.0 + 0.25 * flutter.at(6.0 * t)).max(0.0)) as f32;
        }
        wave[range(at + length)..range(at + length + pause)].fill(0.0);
        at += length + pause;
    }
    voice::normalise(&mut wave);
    wave
}

/// The kiosk's own sound: the samples that it plays, full scale 1. What the capsules hear of it is added to the stage.
pub(super) fn kiosk_output(stage: &mut Stage, random: &mut Random, seconds: f64) -> Vec<f32> {
    let mut played =
        if random.chance(0.7) { objects::chimes(random, seconds) } else { music::piece(stage, random, seconds) };
    let loud = random.log_range(0.01, 0.3);
    if random.chance(0.7) {
        let (wind, share) = (gusts(stage, random, seconds), random.range(0.3, 3.0) as f32);
        played.iter_mut().zip(wind).for_each(|(x, gust)| *x += share * gust);
    }
    let waver = Drift::new(random, seconds);
    let pauses = random.range(-2.5, 0.5);
    let every = (0.01 * RATE) as usize;
    for (i, part) in played.chunks_mut(every).enumerate() {
        let gain = ((waver.at(0.005 * i as f64) - pauses).clamp(0.0, 1.0) * loud) as f32;
        part.iter_mut().for_each(|x| *x = (*x * gain).clamp(-1.0, 1.0));
    }
    // A small loudspeaker: no bass, a resonance, a cubic distortion, and a delay of the device.
    let mut received = played.clone();
    let bend = random.range(0.0, 0.3) as f32;
    received.iter_mut().for_each(|x| *x -= bend * *x * *x * *x);
    let (corner, resonance) = (random.log_range(50.0, 300.0), random.log_range(150.0, 4000.0));
    let mut chain = highpass(corner, 2);
    chain.push(Biquad::peak(resonance, 1.5, random.range(-6.0, 9.0)));
    chain.into_iter().for_each(|filter| filter.run(&mut received));
    let delay = random.log_range(0.004, 0.2);
    // Level at 1 m of a sine at full scale is 70 to 98 dB.
    let db = random.range(73.0, 101.0);
    let metres = random.log_range(0.15, 2.0);
    stage.sound(delay, &received, db, metres);
    if random.chance(0.3) {
        let mut solid = vec![0.0; received.len()];
        add(&mut solid, 0.0, &received, 1.0);
        Biquad::first_lowpass(400.0).run(&mut solid);
        stage.contact(delay, &solid, db - random.range(0.0, 20.0), random.range(0.7, 1.4));
    }
    played
}

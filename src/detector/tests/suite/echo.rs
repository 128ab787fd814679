//! The kiosk's own echo: its loudspeaker, through a room, at its microphone.

use std::collections::VecDeque;

use soffio_detector::{BlowDetector, BlowEstimate, Reason};
use soffio_math::noise::Random;
use soffio_soundscape::breath::Breath;
use soffio_soundscape::test_sounds as sounds;

const RATE: u32 = 48000;
/// Samples of one simulation step.
const BLOCK: usize = 200;
/// Delay from the sample at the loudspeaker's input to the one at the microphone, s: sound card both ways, and air.
const PATH_S: f64 = 0.08;

/// A path from loudspeaker to microphone: the direct sound and some reflections, all unknown to the detector.
struct EchoPath {
    history: VecDeque<f32>,
    echoes: Vec<(usize, f32)>,
}

impl EchoPath {
    fn new(gain: f32) -> Self {
        let at = |ms: f64| ((PATH_S * 1000.0 + ms) * f64::from(RATE) / 1000.0) as usize;
        let echoes = [(0.0, 1.0), (7.3, 0.5), (13.1, -0.4), (23.9, 0.3), (41.0, -0.25), (67.7, 0.15)];
        let echoes = echoes.map(|(ms, g)| (at(ms), gain * g)).to_vec();
        Self { history: vec![0.0; at(100.0)].into(), echoes }
    }

    fn push(&mut self, played: f32) -> f32 {
        self.history.pop_back();
        self.history.push_front(played);
        self.echoes.iter().map(|&(delay, gain)| gain * self.history[delay]).sum()
    }
}

/// The kiosk's sound of wind: noise between 120 Hz and 2 kHz, whose level follows the wind speed.
struct WindSound {
    random: Random,
    level: f64,
    low: [f64; 2],
    high: f64,
}

impl WindSound {
    fn new(seed: u64) -> Self {
        Self { random: Random::new(seed), level: 0.0, low: [0.0; 2], high: 0.0 }
    }

    /// Next sample, as loud at the microphone as the breath: √(mean square) ≈ 0.65 at 17 m/s, with the square of the speed.
    fn next(&mut self, speed: f64) -> f32 {
        let pole = |corner: f64| 1.0 - (-2.0 * std::f64::consts::PI * corner / f64::from(RATE)).exp();
        self.level += pole(3.0) * (speed * speed / 289.0 - self.level);
        let mut x = self.random.signed();
        for low in &mut self.low {
            *low += pole(120.0) * (x - *low);
            x -= *low;
        }
        self.high += pole(2000.0) * (x - self.high);
        (3.1 * self.level * self.high) as f32
    }
}

/// Estimates for a visitor and the loudspeaker together at the microphone; `play` gives the loudspeaker's next sample from the wind
/// speed.
fn run(visitor: &[f32], gain: f32, mut play: impl FnMut(usize, f64) -> f32) -> Vec<(f64, BlowEstimate)> {
    let mut path = EchoPath::new(gain);
    let mut detector = BlowDetector::new(RATE);
    let mut estimates = Vec::new();
    for (step, block) in visitor.chunks(BLOCK).enumerate() {
        let speed = detector.estimate().speed;
        let played: Vec<f32> = (0..block.len()).map(|i| play(step * BLOCK + i, speed)).collect();
        let sum: Vec<f32> = block.iter().zip(&played).map(|(b, p)| (b + path.push(*p)).clamp(-1.0, 1.0)).collect();
        detector.push(&sum, &played);
        estimates.push(((step + 1) as f64 * BLOCK as f64 / f64::from(RATE), detector.estimate()));
    }
    estimates
}

fn quiet_room(seconds: f64) -> Vec<f32> {
    sounds::pink_noise(RATE, 90, seconds, -60.0)
}

/// Share of a breath, its ends left out, for which the wind must last while the kiosk is as loud as the breath: between gusts the
/// echo masks a soft breath for moments.
const HELD: f64 = 0.8;

/// Time in which the wind ends after a breath, s, while the kiosk does not know its echo yet, and later. The echo itself needs 0.15 s.
const RELEASE_S: (f64, f64) = (0.7, 0.4);

#[test]
fn a_breath_that_makes_the_kiosk_sound_is_still_a_breath_and_ends() {
    for (seed, strength) in [(1, 6.0), (2, 8.9), (3, 13.3)] {
        let breath = Breath { speed: strength, hold: 2.0, lead_out: 3.0, ..Breath::default() };
        let mut visitor = breath.recorded(RATE, seed);
        // Twice: the second time the detector knows the echo.
        visitor.extend(breath.recorded(RATE, seed));
        let mut sound = WindSound::new(seed);
        let wind = run(&visitor, 1.0, |_, speed| sound.next(speed));
        for (start, release) in [(0.0, RELEASE_S.0), (breath.duration(), RELEASE_S.1)] {
            let label = breath.label(0.0, &breath.speeds(seed));
            let (onset, end) = (label.arrival, label.end);
            let inside = |t: f64| t > start + onset + 0.3 && t < start + end - 0.3;
            let during: Vec<_> = wind.iter().filter(|(t, _)| inside(*t)).collect();
            let held = during.iter().filter(|(_, e)| e.speed > 0.0).count() as f64 / during.len() as f64;
            assert!(held > HELD, "{strength} m/s from {start} s: wind for {:.0} % of the breath", 100.0 * held);
            let late = |t: f64| t > start + end + release && t < start + breath.duration();
            let false_trigger = wind.iter().find(|(t, e)| late(*t) && e.speed > 0.0);
            assert!(false_trigger.is_none(), "{strength} m/s from {start} s: wind after the breath: {false_trigger:?}");
        }
    }
}

#[test]
fn the_kiosk_alone_never_makes_wind() {
    let seconds = 8.0;
    // Gusts of its own wind sound, as after a breath, at up to four times the coupling that is assumed at first.
    for gain in [0.3, 1.0, 4.0] {
        let mut sound = WindSound::new(5);
        let gusts = |t: f64| if t % 2.0 > 0.8 { 14.0 } else { 0.0 };
        let wind = run(&quiet_room(seconds), gain, |i, _| sound.next(gusts(i as f64 / f64::from(RATE))));
        let false_trigger = wind.iter().find(|(_, e)| e.speed > 0.0);
        assert!(false_trigger.is_none(), "wind sound at gain {gain}: {false_trigger:?}");
    }
    // Low bursts like breath, a played breath, and a chime.
    let times: Vec<f64> = (0..6).map(|k| 0.6 + 1.2 * f64::from(k)).collect();
    let breath = Breath { lead_in: 0.8, hold: 1.5, lead_out: 4.0, ..Breath::default() };
    let chime = |i: usize| {
        let t = (i as f64 / f64::from(RATE)) % 1.5;
        let partials = [(520.0, 0.3), (1434.0, 0.2), (2810.0, 0.1)];
        partials.iter().map(|(f, a)| a * (2.0 * std::f64::consts::PI * f * t).sin() * (-t / 0.8).exp()).sum::<f64>()
            as f32
    };
    let sounds: [(&str, Vec<f32>); 3] = [
        ("thuds", sounds::thuds(RATE, 6, seconds, &times, 0.8)),
        ("a recorded breath that is played", breath.recorded(RATE, 7)),
        ("a chime", (0..(seconds * f64::from(RATE)) as usize).map(chime).collect()),
    ];
    for (name, sound) in sounds {
        let wind = run(&quiet_room(seconds), 0.7, |i, _| sound.get(i).copied().unwrap_or(0.0));
        let false_trigger = wind.iter().find(|(_, e)| e.speed > 0.0);
        assert!(false_trigger.is_none(), "{name}: {false_trigger:?}");
        if name != "a chime" {
            assert!(
                wind.iter().any(|(_, e)| e.reason == Reason::LoudspeakerEcho),
                "{name}: the detector names the echo"
            );
        }
    }
}

#[test]
fn a_loudspeaker_that_the_microphone_does_not_hear_never_makes_wind() {
    const SECONDS: f64 = 40.0;
    // Headphones, a hearing loop or a far loudspeaker: what is predicted and not heard is no sound.
    for (seed, strength) in [(3, 0.05), (4, 0.2), (5, 0.6)] {
        let mut random = Random::new(seed);
        let mut strikes: Vec<(f64, f64)> = Vec::new();
        let mut t = 0.5;
        while t < SECONDS {
            strikes.push((t, 500.0 + 2_800.0 * random.unit()));
            t += 0.1 + 1.2 * random.unit();
        }
        let mut played = vec![0.0_f32; (SECONDS * f64::from(RATE)) as usize];
        for (begin, hz) in strikes {
            let first = (begin * f64::from(RATE)) as usize;
            for (i, sample) in played.iter_mut().skip(first).take(RATE as usize).enumerate() {
                let t = i as f64 / f64::from(RATE);
                *sample += (strength * (2.0 * std::f64::consts::PI * hz * t).sin() * (-t / 0.15).exp()) as f32;
            }
        }
        let wind = run(&quiet_room(SECONDS), 0.0, |i, _| played.get(i).copied().unwrap_or(0.0));
        let false_trigger = wind.iter().find(|(_, e)| e.speed > 0.0);
        assert!(false_trigger.is_none(), "strikes of {strength}: {false_trigger:?}");
    }
}

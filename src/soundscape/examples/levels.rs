//! Prints figures of synthetic breaths: air, level, spectrum and speed of the synthesis at several distances; band levels of
//! recordings, which people at telephones and consoles have too.

use std::time::Instant;

use soffio_math::log10;
use soffio_math::noise::Random;
use soffio_soundscape::breath::{Breath, Manner, Person};
use soffio_soundscape::draught::Draught;
use soffio_soundscape::filters::power;
use soffio_soundscape::level::band_powers;
use soffio_soundscape::microphone::Microphone;
use soffio_soundscape::statistics::quantile;

/// Sample rate, Hz.
const RATE: u32 = 16_000;
/// Limits of bands, Hz.
const BANDS_HZ: [f64; 8] = [31.0, 94.0, 203.0, 406.0, 812.0, 1625.0, 3400.0, 7000.0];
/// Recordings of each kind.
const COUNT: u64 = 40;
/// Length of a draught, s.
const DRAUGHT_S: f64 = 60.0;

fn main() {
    println!("breath of 9 m/s at the lips, steady part");
    for distance in [0.05, 0.10, 0.20, 0.36, 0.50] {
        at_distance(distance);
    }
    println!("recordings: median levels from 31 Hz to 7 kHz, dB relative to 31-203 Hz");
    for (name, person, range, corner, order) in [
        ("telephone, breathing", Person::Weak, (0.06, 0.15), 150.0, 4),
        ("at the nose", Person::Weak, (0.03, 0.05), 60.0, 2),
        ("console, blowing", Person::Adult, (0.03, 0.06), 60.0, 2),
        ("kiosk, blowing", Person::Adult, (0.10, 0.35), 40.0, 2),
    ] {
        let microphone = Microphone { high_pass_hz: corner, order, ..Microphone::default() };
        recordings(name, person, range, microphone);
    }
    let begun = Instant::now();
    let draught = Draught::random(0.4, 0.1, 0.05, &mut Random::new(3));
    let pressure = draught.pressure(DRAUGHT_S, RATE, 3);
    let fast = DRAUGHT_S / begun.elapsed().as_secs_f64();
    println!("draught of 0.4 m/s at two capsules: {:.0} dB of sound, {fast:.0} times real time", level(&pressure[0]));
}

/// Level, dB of sound.
fn level(pressure: &[f64]) -> f64 {
    let mean = pressure.iter().sum::<f64>() / pressure.len() as f64;
    let moving: Vec<f64> = pressure.iter().map(|p| p - mean).collect();
    10.0 * log10(power(&moving) / 4e-10)
}

fn at_distance(distance: f64) {
    let breath = Breath { distance, hold: 4.0, wander_deg: 0.0, hiss_db: -60.0, ..Breath::default() };
    let begun = Instant::now();
    let air = breath.air(RATE, 3);
    let fast = breath.duration() / begun.elapsed().as_secs_f64();
    let label = breath.label(0.0, &air.speeds);
    let steady = &air.pressure[0][(2.3 * f64::from(RATE)) as usize..5 * RATE as usize];
    let mean = steady.iter().sum::<f64>() / steady.len() as f64;
    let moving: Vec<f64> = steady.iter().map(|p| p - mean).collect();
    let bands = band_powers(&moving, f64::from(RATE), &[20.0, 60.0, 7900.0]);
    println!(
        "  {:3.0} cm: {:4.2} m/s, arrives after {:4.2} s, {:5.1} dB of sound, {:3.0} % of it above 20 Hz below 60 Hz, {fast:.0} times real time",
        100.0 * distance,
        label.peak_speed,
        label.arrival - label.lips,
        level(steady),
        100.0 * bands[0] / (bands[0] + bands[1]),
    );
}

fn recordings(name: &str, person: Person, range: (f64, f64), microphone: Microphone) {
    let mut random = Random::new(5);
    let mut levels = vec![Vec::new(); BANDS_HZ.len() - 1];
    for seed in 0..COUNT {
        let drawn = Breath::random(Manner::Plain, person, range, &mut random);
        let breath = Breath { angle_deg: drawn.angle_deg.min(4.0), room_db: 30.0, microphone, ..drawn };
        let label = breath.label(0.0, &breath.speeds(seed));
        let samples: Vec<f64> = breath.recorded(RATE, seed).iter().map(|x| f64::from(*x)).collect();
        let [from, until] = [label.arrival, label.end].map(|t| ((t * f64::from(RATE)) as usize).min(samples.len()));
        let powers = band_powers(&samples[from..until], f64::from(RATE), &BANDS_HZ);
        let low = powers[0] + powers[1];
        levels.iter_mut().zip(powers).for_each(|(levels, power)| levels.push(10.0 * log10(power / low)));
    }
    let medians: Vec<String> = levels.iter().map(|levels| format!("{:4.0}", quantile(levels, 0.5))).collect();
    println!("  {name:22}{}", medians.join(""));
}

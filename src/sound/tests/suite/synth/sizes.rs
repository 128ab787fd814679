//! The size of a body is heard, and where a drum is hit.

use soffio_math::amplitude_to_db;
use soffio_sound::modes::{T60_DECAYS, membrane_zeros};
use soffio_sound::{Preset, SoundBody, SoundCommand, Strike, Synth, partials};

use super::winds::spectrum;
use super::{RATE, render};

/// A preset on a round body of this radius (m), of the specimen's form, hit at a place along it; mono, two seconds.
fn heard(name: &str, radius: f64, at: f32) -> Vec<f64> {
    let preset = Preset::shipped(name).expect("valid");
    let mut synth = Synth::with_preset(RATE, &preset, &sized(name, radius), 1).expect("compiles");
    synth.set_dry(true);
    let position = [at, 0.0];
    let (impulse, speed, mass) = (1e-3, 0.5, 0.02);
    let strike = Strike { sample: 0, instrument: 0, impulse, speed, mass, position, pan: 0.0, distance: 1.0 };
    synth.command(SoundCommand::Strike(strike));
    render(&mut synth, 2 * RATE as usize).chunks(2).map(|frame| f64::from(frame[0])).collect()
}

fn sized(name: &str, radius: f64) -> soffio_sound::InstrumentSpec {
    let preset = Preset::shipped(name).expect("valid");
    let spec = preset.specimen.spec(name);
    let ratio = radius / spec.body.half_extents[0];
    let body = SoundBody {
        half_extents: spec.body.half_extents.map(|half| half * ratio),
        thickness: spec.body.thickness * ratio,
        area: spec.body.area * ratio * ratio,
        mass: spec.body.mass * ratio * ratio * ratio,
    };
    soffio_sound::InstrumentSpec { body, ..spec }
}

/// Mean frequency of the power of a sound, Hz.
fn centroid(samples: &[f64]) -> f64 {
    const N: usize = 8192;
    let power = spectrum(samples, N);
    let of = |weight: fn(f64) -> f64| -> f64 { power.iter().enumerate().map(|(k, p)| weight(k as f64) * p).sum() };
    of(|k| k) / of(|_| 1.0) * f64::from(RATE) / N as f64
}

/// Elasticity has no length of its own: of two bodies of one form and material, the larger one sounds lower in proportion, and rings
/// longer in proportion.
#[test]
fn pitch_and_decay_go_with_the_size() {
    for name in ["wood", "metal", "bell", "drum"] {
        let preset = Preset::shipped(name).expect("valid");
        let lowest = |radius: f64| {
            let modes = partials(&preset, &sized(name, radius)).expect("it can ring");
            (modes[0].frequency, T60_DECAYS / modes[0].decay)
        };
        let ((low, long), (high, short)) = (lowest(0.5), lowest(0.05));
        assert!((high / low / 10.0 - 1.0).abs() < 1e-9, "{name}: {low} and {high} Hz");
        assert!((long / short / 10.0 - 1.0).abs() < 1e-9, "{name}: {long} and {short} s");
        let [large, small] = [0.5, 0.02].map(|radius| centroid(&heard(name, radius, 0.6)));
        println!("{name}: heard at {large:.0} Hz with 50 cm, {small:.0} Hz with 2 cm");
        assert!(small > 4.0 * large, "{name}: heard at {large} Hz with 50 cm, {small} Hz with 2 cm");
    }
}

/// The head of a drum is a circular membrane, and the thesis' own example: near the rim it sounds brighter than at its centre.
#[test]
fn a_drum_has_a_membranes_pitches_and_is_lower_at_its_centre() {
    let preset = Preset::shipped("drum").expect("valid");
    let modes = partials(&preset, &preset.specimen.spec("drum")).expect("it can ring");
    // Rayleigh, The Theory of Sound, section 206.
    for (mode, ratio) in modes.iter().zip([1.0, 1.594, 2.136, 2.296, 2.653, 2.918, 3.156, 3.501]) {
        let found = mode.frequency / modes[0].frequency;
        assert!((found / ratio - 1.0).abs() < 0.01, "{found}, not {ratio}");
    }
    // The centre moves in the symmetric modes alone.
    let zeros = membrane_zeros(12.0);
    assert!(zeros.iter().filter(|(m, _)| *m == 0).count() >= 3);
    let [centre, rim] = [0.0, 0.85].map(|at| heard("drum", 0.175, at));
    let [low, high] = [&centre, &rim].map(|sound| centroid(sound));
    println!("centre {low:.0} Hz, rim {high:.0} Hz");
    assert!(low < 0.8 * high, "centre {low} Hz, rim {high} Hz");
    let at = |sound: &[f64], hz: f64| super::amplitude(&sound[4800..48_000], hz);
    let second = 85.0 * 1.594;
    let fall = amplitude_to_db(at(&centre, second) / at(&centre, 85.0));
    assert!(fall < -30.0, "the mode with a line of rest through the centre: {fall} dB");
}

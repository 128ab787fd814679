//! Oscillators, frequency modulation, formulas, and timbres that motion plays, against their formulas.

use soffio_math::{PI, amplitude_to_db, cos, sin};
use soffio_sound::{BodyMotion, MotionSound, Preset, SoundCommand, Strike, Synth};

use super::presets::heard;
use super::{RATE, amplitude, render, rms, spec};

/// Samples are f32, with 24 bits of mantissa; sums of a second of them are exact to a few of these.
const ROUNDED: f64 = 1e-6;
/// Smoothed corners take from a harmonic at f what the integral of a triangle of two samples takes: sinc²(f/fs), 2 % at 3.7 kHz.
const SMOOTHED: f64 = 0.02;

fn preset(nodes: &str) -> Preset {
    let text = format!("timbre = 1\nname = \"x\"\ndescription = \"\"\n{nodes}");
    Preset::parse("x", &text).unwrap_or_else(|error| panic!("{error}"))
}

/// J_k(x) by Bessel's integral.
fn bessel(k: u32, x: f64) -> f64 {
    const STEPS: u32 = 4000;
    let at = |i: u32| {
        let angle = PI * (f64::from(i) + 0.5) / f64::from(STEPS);
        cos(f64::from(k) * angle - x * sin(angle))
    };
    (0..STEPS).map(at).sum::<f64>() / f64::from(STEPS)
}

#[test]
fn fm_has_the_partials_of_bessels_functions() {
    let (carrier, modulator, index) = (4000.0, 600.0, 2.4);
    let preset = preset("[node.out]\ntype = \"fm\"\ncarrier = 4000\nratio = 0.15\nindex = 2.4\n");
    assert!(preset.continuous() == preset.moves(), "nothing moves it: it is played once for each hit");
    let out = heard(&preset, 1.0);
    for k in 0..5u32 {
        for side in [-1.0, 1.0] {
            let measured = amplitude(&out, carrier + side * f64::from(k) * modulator);
            let expected = bessel(k, index).abs();
            assert!((measured - expected).abs() < 1e-4, "partial {side}·{k}: {measured} instead of {expected}");
        }
    }
    // Between the partials there is nothing.
    assert!(amplitude(&out, carrier + 0.5 * modulator) < 1e-4);
}

#[test]
fn an_oscillator_modulated_by_another_is_fm_too() {
    let two = preset(
        "[node.low]\ntype = \"oscillator\"\nfrequency = 600\n\
         [node.out]\ntype = \"oscillator\"\nfrequency = 4000\nin = \"low\"\nindex = 2.4\n",
    );
    let one = preset("[node.out]\ntype = \"fm\"\ncarrier = 4000\nratio = 0.15\nindex = 2.4\n");
    let (two, one) = (heard(&two, 0.2), heard(&one, 0.2));
    let off = two.iter().zip(&one).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(off < 10.0 * ROUNDED, "{off}");
}

#[test]
fn waveforms_have_their_harmonics_and_do_not_alias() {
    // 740 Hz divides neither the sample rate nor half of it: aliases fall between the harmonics.
    let tone = 740.0;
    for (shape, amplitude_of) in [
        ("sine", (|k| if k == 1 { 1.0 } else { 0.0 }) as fn(i32) -> f64),
        ("triangle", |k| if k % 2 == 1 { 8.0 / (PI * PI * f64::from(k * k)) } else { 0.0 }),
        ("saw", |k| 2.0 / (PI * f64::from(k))),
        ("square", |k| if k % 2 == 1 { 4.0 / (PI * f64::from(k)) } else { 0.0 }),
    ] {
        let out =
            heard(&preset(&format!("[node.out]\ntype = \"oscillator\"\nshape = \"{shape}\"\nfrequency = 740\n")), 1.0);
        for k in 1..6 {
            let (measured, expected) = (amplitude(&out, f64::from(k) * tone), amplitude_of(k));
            let off = (measured - expected).abs();
            assert!(off < SMOOTHED * expected + 1e-3, "{shape}, harmonic {k}: {measured} instead of {expected}");
        }
        // The 40th harmonic, 29.6 kHz, would fold to 18.4 kHz; a plain saw has it at −36 dB of the first.
        let folded = amplitude(&out, 48_000.0 - 40.0 * tone) / amplitude(&out, tone);
        println!("{shape}: folded {:.0} dB", amplitude_to_db(folded));
        assert!(amplitude_to_db(folded) < -40.0, "{shape}: {folded}");
    }
}

#[test]
fn a_formula_is_what_it_says_at_each_sample() {
    let preset = preset(
        "[node.low]\ntype = \"oscillator\"\nfrequency = 100\n[node.high]\ntype = \"oscillator\"\nfrequency = 1000\n\
         [node.out]\ntype = \"function\"\nin = [\"low\", \"high\"]\nof = \"low * high + 0.25 * cos(2 * pi * 50 * t)\"\n",
    );
    for (i, sample) in heard(&preset, 0.1).iter().enumerate() {
        let t = i as f64 / f64::from(RATE);
        let tone = |hz: f64| sin(2.0 * PI * hz * t);
        let expected = tone(100.0) * tone(1000.0) + 0.25 * cos(2.0 * PI * 50.0 * t);
        assert!((sample - expected).abs() < 10.0 * ROUNDED, "sample {i}: {sample} instead of {expected}");
    }
}

/// Partials that are struck, and a tone whose index and pitch follow the spin.
const WHIRR: &str = "[node.bank]\ntype = \"modal\"\nfrom = \"table\"\nfundamental = 2000\ncontact_radius = 0.002\ngain = 10\n\
    table = [{ ratio = 1, gain = 1, t60 = 2 }]\n\
    [node.whirr]\ntype = \"fm\"\ncarrier = { input = \"body_spin\", scale = 100 }\nindex = { input = \"body_spin\", scale = 0.1 }\n\
    gain = { input = \"body_spin\", scale = 0.01 }\n\
    [node.out]\ntype = \"sum\"\nin = [\"bank\", \"whirr\"]\n";

fn spin(sample: u64, spin: f32) -> SoundCommand {
    let motion = BodyMotion { spin, ..BodyMotion::default() };
    SoundCommand::Motion(MotionSound { sample, instrument: 0, motion, pan: -1.0, distance: 1.0 })
}

fn left(synth: &mut Synth, seconds: f64) -> Vec<f64> {
    let out = render(synth, (seconds * f64::from(RATE)) as usize);
    out.chunks(2).map(|frame| f64::from(frame[0])).collect()
}

#[test]
fn motion_plays_a_timbre_and_hits_ring_its_partials() {
    let preset = preset(WHIRR);
    assert!(preset.moves() && preset.rings() && preset.follows_motion() && !preset.follows_wind());
    let mut synth = Synth::with_preset(RATE, &preset, &spec("x"), 1).expect("compiles");
    synth.set_dry(true);
    assert!(rms(&render(&mut synth, 4800)) == 0.0, "at rest it is silent");
    // 5 rad/s: a carrier of 500 Hz and an index of 0.5.
    synth.command(spin(synth.position(), 5.0));
    left(&mut synth, 0.2);
    let out = left(&mut synth, 1.0);
    // With a ratio of 1, the partial below 0 Hz folds back onto the one above: J₀ − J₂, and J₁ + J₃.
    let first = |index: f64| bessel(0, index) - bessel(2, index);
    assert!((amplitude(&out, 500.0) - 0.05 * first(0.5)).abs() < 1e-4, "{}", amplitude(&out, 500.0));
    // Twice as fast: an octave higher, brighter, louder.
    synth.command(spin(synth.position(), 10.0));
    left(&mut synth, 0.2);
    let out = left(&mut synth, 1.0);
    assert!((amplitude(&out, 1000.0) - 0.1 * first(1.0)).abs() < 1e-4, "{}", amplitude(&out, 1000.0));
    let second = 0.1 * (bessel(1, 1.0) + bessel(3, 1.0));
    assert!((amplitude(&out, 2000.0) - second).abs() < 1e-4, "{}", amplitude(&out, 2000.0));
    // Halted, and struck.
    synth.command(spin(synth.position(), 0.0));
    left(&mut synth, 0.2);
    assert!(rms(&render(&mut synth, 4800)) < ROUNDED);
    let strike = Strike {
        sample: synth.position(),
        instrument: 0,
        impulse: 0.01,
        speed: 0.3,
        mass: 0.01,
        position: [0.5, 0.0],
        pan: -1.0,
        distance: 1.0,
    };
    synth.command(SoundCommand::Strike(strike));
    let out = left(&mut synth, 0.5);
    assert!(amplitude(&out, 2000.0) > 0.01, "{}", amplitude(&out, 2000.0));
    // Another exhibit: all ends, and begins again with the next command.
    synth.command(spin(synth.position(), 5.0));
    left(&mut synth, 0.2);
    synth.command(SoundCommand::Silence { sample: synth.position() });
    left(&mut synth, 0.2);
    assert!(rms(&render(&mut synth, 4800)) == 0.0);
    synth.command(spin(synth.position(), 5.0));
    assert!(rms(&render(&mut synth, 9600)) > 0.01);
    assert_eq!(synth.faults(), 0);
}

#[test]
fn each_input_of_motion_reaches_its_number() {
    let values =
        BodyMotion { speed: 0.1, spin: 0.2, joint_force: 0.3, tension: 0.4, way: 0.5, height: -0.6, parameter: 0.7 };
    for (input, expected) in [
        ("body_speed", 0.1),
        ("body_spin", 0.2),
        ("joint_force", 0.3),
        ("tension", 0.4),
        ("way", 0.5),
        ("height", -0.6),
        ("parameter", 0.7),
        ("distance", 2.0),
    ] {
        for node in [
            format!("type = \"value\"\ngain = {{ input = \"{input}\" }}\n"),
            format!("type = \"function\"\nof = \"{input}\"\n"),
        ] {
            let preset = preset(&format!("[node.out]\n{node}"));
            let mut synth = Synth::with_preset(RATE, &preset, &spec("x"), 1).expect("compiles");
            synth.set_dry(true);
            let motion = MotionSound { sample: 0, instrument: 0, motion: values, pan: -1.0, distance: 2.0 };
            synth.command(SoundCommand::Motion(motion));
            let out = left(&mut synth, 0.1);
            // Twice as far, half as loud.
            assert!((2.0 * out[4799] - expected).abs() < 10.0 * ROUNDED, "{input}: {}", 2.0 * out[4799]);
        }
    }
}

//! The shipped presets: each sounds like what it is, in figures.

use soffio_math::amplitude_to_db;
use soffio_sound::modes::T60_DECAYS;
use soffio_sound::{Mode, Preset, Slide, SoundCommand, Synth, partials, timbre};

use super::{RATE, amplitude, peak, render, rms};

/// A preset on its specimen, played from the start, mono and dry.
pub fn heard(preset: &Preset, seconds: f64) -> Vec<f64> {
    let mut synth = Synth::with_preset(RATE, preset, &preset.specimen.spec(&preset.name), 1).expect("compiles");
    synth.set_dry(true);
    synth.command(preset.specimen.command(preset, 0, 0));
    let out = render(&mut synth, (seconds * f64::from(RATE)) as usize);
    assert_eq!(synth.faults(), 0, "{}", preset.name);
    let side = std::f64::consts::SQRT_2;
    out.chunks(2).map(|frame| f64::from(frame[0]) * side).collect()
}

fn shipped(name: &str) -> (Preset, Vec<Mode>) {
    let preset = Preset::shipped(name).expect("valid");
    let modes = partials(&preset, &preset.specimen.spec(name)).expect("it can ring");
    (preset, modes)
}

#[test]
fn all_compile_and_sound_at_a_sensible_level() {
    let mut wrong = Vec::new();
    for name in timbre::names() {
        let preset = Preset::shipped(name).expect("valid");
        let out: Vec<f32> = heard(&preset, 2.0).iter().map(|x| *x as f32).collect();
        let db = amplitude_to_db(f64::from(peak(&out)));
        println!("{name}: peak {db:.1} dBFS, rms {:.1} dBFS", amplitude_to_db(rms(&out)));
        // Heard at one metre on a laptop's speaker; no specimen's hit leans on the limiter.
        if !(-36.0..-3.0).contains(&db) {
            wrong.push(format!("{name}: {db:.1} dBFS"));
        }
    }
    assert!(wrong.is_empty(), "{wrong:?}");
}

#[test]
fn the_thesis_counts_and_times_of_decay_are_kept() {
    // Partials and T60 in s of wood, drum, metal and bell.
    for (name, count, shortest, longest) in
        [("wood", 600, 0.05, 0.3), ("drum", 250, 0.2, 0.8), ("metal", 25, 1.0, 6.0), ("bell", 10, 3.0, 20.0)]
    {
        let (preset, modes) = shipped(name);
        assert_eq!(modes.len(), count, "{name}");
        let mut t60: Vec<f64> = modes.iter().map(|mode| T60_DECAYS / mode.decay).collect();
        t60.sort_by(f64::total_cmp);
        // The spread of the draw reaches beyond the range at both ends; the middle nine tenths are in it.
        let (low, high) = (t60[count / 20], t60[count - 1 - count / 20]);
        println!("{name}: T60 {low:.3} to {high:.3} s");
        assert!(low > 0.8 * shortest && high < 1.25 * longest, "{name}: {low} to {high} s");
        // Heard: the level falls by 60 dB in a time within the range.
        let out = heard(&preset, 1.3 * longest);
        let frame = (0.02 * f64::from(RATE)) as usize;
        let levels: Vec<f64> = out
            .chunks_exact(frame)
            .map(|c| amplitude_to_db((c.iter().map(|x| x * x).sum::<f64>() / frame as f64).sqrt()))
            .collect();
        let top = levels.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let fallen = levels.iter().rposition(|l| *l > top - 60.0).expect("it sounds") as f64 * 0.02;
        println!("{name}: falls by 60 dB in {fallen:.2} s");
        assert!((0.7 * shortest..1.25 * longest).contains(&fallen), "{name}: {fallen} s");
    }
}

#[test]
fn chimes_ring_at_c5_as_long_as_their_metal_does() {
    // T60 at 523 Hz, 2.2/(η f); the tube's own sound takes up to a tenth.
    const LESS: f64 = 0.12;
    for (name, t60) in
        [("aluminium", 10.5), ("steel", 7.0), ("brass", 4.2), ("copper", 1.9), ("glass", 2.1), ("bamboo", 0.28)]
    {
        let (preset, modes) = shipped(&format!("chime-{name}"));
        assert!((modes[0].frequency / 523.25 - 1.0).abs() < 0.01, "{name}: {} Hz", modes[0].frequency);
        let own = T60_DECAYS / modes[0].decay;
        assert!((1.0 - LESS..1.02).contains(&(own / t60)), "{name}: {own} s");
        // And as it is heard: both planes together, between two windows of one beat each.
        let beat = 1.0 / (modes[1].frequency - modes[0].frequency);
        let apart = if beat < 0.4 * t60 { beat } else { 0.3 * t60 };
        let out = heard(&preset, 0.1 + 2.0 * apart);
        let window = 4800.min((0.3 * apart * f64::from(RATE)) as usize);
        let early = (0.05 * f64::from(RATE)) as usize;
        let late = early + (apart * f64::from(RATE)) as usize;
        let middle = 0.5 * (modes[0].frequency + modes[1].frequency);
        let fall = amplitude_to_db(
            amplitude(&out[early..early + window], middle) / amplitude(&out[late..late + window], middle),
        );
        if apart == beat {
            // After a whole beat the two planes are in step again.
            let heard = 60.0 * apart / fall;
            println!("{name}: T60 {own:.2} s, heard {heard:.2} s");
            assert!((heard / own - 1.0).abs() < 0.05, "{name}: {heard} s instead of {own} s");
        }
    }
}

#[test]
fn materials_are_told_apart_by_how_long_they_ring() {
    let ring = |name: &str| {
        let (_, modes) = shipped(name);
        T60_DECAYS / modes[0].decay
    };
    let order = ["bell", "chime-aluminium", "chime-steel", "metal", "chime-brass", "chime-copper", "drum", "wood"];
    for pair in order.windows(2) {
        assert!(ring(pair[0]) > ring(pair[1]), "{} rings longer than {}", pair[0], pair[1]);
    }
}

#[test]
fn a_tick_is_short_and_high() {
    let (preset, _) = shipped("clock-tick");
    let out = heard(&preset, 0.5);
    let energy = |part: &[f64]| part.iter().map(|x| x * x).sum::<f64>();
    let at = |seconds: f64| (seconds * f64::from(RATE)) as usize;
    // Two clicks: there is a second rise 9 ms after the first.
    // Slopes, so that the ringing of the case does not hide it.
    let slopes: Vec<f64> = out.windows(2).map(|w| w[1] - w[0]).collect();
    assert!(energy(&slopes[at(0.009)..at(0.012)]) > 1.3 * energy(&slopes[at(0.006)..at(0.009)]));
    assert!(energy(&out[at(0.1)..]) < 1e-4 * energy(&out));
    // Most of its energy lies between 1.5 and 9 kHz, nothing to speak of below 150 Hz.
    let power = super::winds::spectrum(&[&[0.0; 3000], &out[..9288]].concat(), 8192);
    let bin = |hz: f64| (hz / f64::from(RATE) * 8192.0) as usize;
    let band = |low: f64, high: f64| power[bin(low)..bin(high)].iter().sum::<f64>();
    assert!(band(1500.0, 9000.0) > 2.0 * band(200.0, 1200.0));
    assert!(band(30.0, 140.0) < 0.01 * band(200.0, 9000.0));
}

#[test]
fn numbers_may_follow_several_inputs() {
    let text = "timbre = 1\nname = \"x\"\ndescription = \"\"\n[node.out]\ntype = \"value\"\n\
        gain = { input = \"slip_speed\", scale = 2, power = 0.5, times = [{ input = \"normal_force\", power = 2, offset = 1 }], \
        plus = [{ input = \"position_x\", scale = 0.125 }] }\n";
    let preset = Preset::parse("x", text).expect("valid");
    assert!(preset.slides());
    let mut synth = Synth::with_preset(RATE, &preset, &preset.specimen.spec("x"), 1).expect("compiles");
    synth.set_dry(true);
    let (speed, force) = (0.04, 0.5);
    let position = [0.5, 0.0];
    let slide = Slide { sample: 0, instrument: 0, speed, force, position, pan: -1.0, distance: 1.0 };
    synth.command(SoundCommand::Slide(slide));
    let out = render(&mut synth, 48_000);
    // 2 · √0.04 · (0.5 + 1)² + 0.5/8, settled; f32.
    assert!((out[2 * 47_999] - 0.9625).abs() < 1e-4, "{}", out[2 * 47_999]);
}

#[test]
fn a_delay_is_as_long_as_it_says_and_a_map_follows_its_points() {
    let text = "timbre = 1\nname = \"x\"\ndescription = \"\"\n\
        [node.one]\ntype = \"value\"\ngain = 1\n[node.click]\ntype = \"env\"\nin = \"one\"\ndecay = 1e-5\n\
        [node.later]\ntype = \"delay\"\nin = \"click\"\ntime = 0.01\nfeedback = 0.5\n\
        [node.out]\ntype = \"map\"\nin = \"later\"\npoints = [[0, 0], [0.5, 0.1], [1, 0.5]]\n";
    let preset = Preset::parse("x", text).expect("valid");
    let out = heard(&preset, 0.05);
    let level = |i: usize| out[i];
    assert!((level(480) - 0.5).abs() < 1e-3 && (level(960) - 0.1).abs() < 1e-3, "{} {}", level(480), level(960));
    assert!(out[..480].iter().all(|x| *x == 0.0) && level(700) == 0.0);
}

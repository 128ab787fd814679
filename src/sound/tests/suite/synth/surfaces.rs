//! Scraping: the line of a surface as a sound.

use soffio_math::{PI, amplitude_to_db, sin};
use soffio_sound::{Preset, Slide, SoundCommand, SoundSurface, SurfaceLine, Synth};

use super::winds::spectrum;
use super::{RATE, render, spec};

/// The needle alone: what the contact reads, before any body.
fn needle(lines: &str) -> Preset {
    let text = format!(
        "timbre = 1\nname = \"x\"\ndescription = \"\"\n[node.out]\ntype = \"texture\"\n{lines}\n\
         gain = {{ input = \"normal_force\", power = 0.6, scale = 0.1 }}\n"
    );
    Preset::parse("x", &text).unwrap_or_else(|e| panic!("{e}"))
}

/// Slides at a steady speed, after it settled.
fn slide(preset: &Preset, surface: Option<SurfaceLine>, speed: f32, force: f32, seconds: f64) -> Vec<f64> {
    let surface = surface.map(SoundSurface::Line);
    let spec = soffio_sound::InstrumentSpec { surface, ..spec("x") };
    let mut synth = Synth::with_preset(RATE, preset, &spec, 1).expect("compiles");
    synth.set_dry(true);
    let slide = Slide { sample: 0, instrument: 0, speed, force, position: [0.0; 2], pan: -1.0, distance: 1.0 };
    synth.command(SoundCommand::Slide(slide));
    render(&mut synth, RATE as usize / 4);
    let out = render(&mut synth, (seconds * f64::from(RATE)) as usize);
    out.chunks(2).map(|frame| f64::from(frame[0])).collect()
}

/// A grating: `periods` sine waves on 4096 points a tenth of a millimetre apart.
fn grating(periods: usize) -> SurfaceLine {
    let value = |i: usize| sin(2.0 * PI * (i * periods) as f64 / 4096.0) as f32;
    SurfaceLine { values: (0..4096).map(value).collect(), spacing: 1e-4 }
}

#[test]
fn the_spectrum_moves_with_the_speed() {
    // A grating of 0.8 mm: f = v / 0.8 mm, within 2 %.
    const TOLERANCE: f64 = 0.02;
    let preset = needle("kind = \"image\"");
    for speed in [0.05f32, 0.1, 0.37, 1.0, 3.0, 8.0] {
        let power = spectrum(&slide(&preset, Some(grating(512)), speed, 1.0, 2.0), 1 << 14);
        let top = (0..power.len()).max_by(|a, b| power[*a].total_cmp(&power[*b])).expect("bins");
        let near = top.saturating_sub(3)..top + 4;
        let bin = near.clone().map(|i| i as f64 * power[i]).sum::<f64>() / near.map(|i| power[i]).sum::<f64>();
        let (tone, wanted) = (bin * f64::from(RATE) / f64::from(1 << 14), f64::from(speed) / 8e-4);
        assert!((tone / wanted - 1.0).abs() < TOLERANCE, "{speed} m/s: {tone} Hz, not {wanted}");
    }
    // And of a rough surface, the whole spectrum: its centre of power by twice the speed.
    let wood = needle("kind = \"wood\"\ngrain = 0.002\nresolution = 2e-5");
    let centre = |speed: f32| {
        // The same way at either speed.
        let power = spectrum(&slide(&wood, None, speed, 1.0, 4.0 / f64::from(speed)), 1 << 15);
        let band = |i: &usize| {
            (200.0 * f64::from(speed)..20_000.0 * f64::from(speed))
                .contains(&(*i as f64 * 48_000.0 / f64::from(1 << 15)))
        };
        let sum: f64 = (0..power.len()).filter(band).map(|i| power[i]).sum();
        (0..power.len()).filter(band).map(|i| i as f64 * power[i]).sum::<f64>() / sum
    };
    let ratio = centre(0.2) / centre(0.1);
    assert!((ratio / 2.0 - 1.0).abs() < TOLERANCE, "twice as fast: {ratio}");
}

#[test]
fn what_is_too_fine_to_hear_does_not_come_back_as_something_else() {
    // Any grating at any speed: what is neither its own frequency nor below −60 dB would be an alias. The first is where
    // it should be or is gone.
    const ALIAS: f64 = -60.0;
    let preset = needle("kind = \"image\"");
    let mut worst = f64::NEG_INFINITY;
    for periods in [100, 300, 512, 700, 900] {
        for speed in [0.5f32, 1.3, 3.0, 4.7, 6.1, 7.7, 9.9, 13.7, 22.0, 47.0] {
            let power = spectrum(&slide(&preset, Some(grating(periods)), speed, 1.0, 1.0), 1 << 12);
            // Amplitude of the grating as it is heard where nothing is lost.
            let full =
                spectrum(&(0..8192).map(|i| 0.1 * 2f64.sqrt() * sin(0.5 * f64::from(i))).collect::<Vec<_>>(), 1 << 12);
            let full = full.iter().copied().fold(0.0, f64::max);
            let own = f64::from(speed) * periods as f64 / 0.4096 * f64::from(1 << 12) / f64::from(RATE);
            let stray =
                (2..power.len()).filter(|i| (*i as f64 - own).abs() > 16.0).map(|i| power[i]).fold(0.0, f64::max);
            let db = 0.5 * amplitude_to_db(stray / full);
            worst = worst.max(db);
            assert!(db < ALIAS, "{periods} periods at {speed} m/s: {db:.1} dB beside {own:.0}");
        }
    }
    println!("worst alias {worst:.1} dB");
}

#[test]
fn the_level_follows_the_force_by_its_power() {
    // N^0.6: exact but for f32.
    const TOLERANCE: f64 = 0.01;
    let preset = needle("kind = \"rough\"");
    let level = |force: f32| {
        let out = slide(&preset, None, 0.2, force, 1.0);
        amplitude_to_db((out.iter().map(|x| x * x).sum::<f64>() / out.len() as f64).sqrt())
    };
    for (low, high) in [(0.5, 1.0), (1.0, 4.0)] {
        let gain = level(high) - level(low);
        let wanted = 0.6 * amplitude_to_db(f64::from(high / low));
        assert!((gain - wanted).abs() < TOLERANCE, "{gain} dB, not {wanted}");
    }
}

#[test]
fn surfaces_differ_and_go_on_without_a_seam_and_without_coming_back() {
    // A line of 0.33 m: the sound a turn later is another piece. Chance alone gives some hundredths.
    const ALIKE: f64 = 0.3;
    // The largest step between samples is no larger over many pieces than within one.
    for kind in ["wood", "marble", "rough"] {
        let preset = needle(&format!("kind = \"{kind}\"\ngrain = 0.002"));
        let out = slide(&preset, None, 1.0, 1.0, 8.0);
        let step = |part: &[f64]| part.windows(2).map(|w| (w[1] - w[0]).abs()).fold(0.0, f64::max);
        let turn = (0.32768 * f64::from(RATE)) as usize;
        assert!(step(&out) < 1.3 * step(&out[..turn - 100]).max(step(&out[turn / 2..turn + turn / 2])), "{kind}");
        assert!(out.iter().any(|x| x.abs() > 0.02), "{kind}");
        let product =
            |lag: usize| out.iter().zip(&out[lag..]).map(|(a, b)| a * b).sum::<f64>() / (out.len() - lag) as f64;
        let near = (1..=18).flat_map(|repeats| (0..5).map(move |i| repeats * turn + repeats * i / 4));
        let alike = near.map(|lag| (product(lag) / product(0)).abs()).fold(0.0, f64::max);
        println!("{kind}: alike by {alike:.3} over 6 m");
        assert!(alike < ALIKE, "{kind}: {alike}");
    }
}

#[test]
fn a_slide_ends_with_the_contact_and_scrapes_are_cut_like_everything_else() {
    for name in ["scrape-wood", "scrape-metal", "scrape-stone"] {
        let preset = Preset::shipped(name).expect("valid");
        let run = |block: usize| {
            let mut synth = Synth::with_preset(RATE, &preset, &preset.specimen.spec(name), 1).expect("compiles");
            synth.command(preset.specimen.command(&preset, 0, 100));
            synth.command(SoundCommand::Slide(Slide { sample: 5000, ..Slide::default() }));
            let mut out = Vec::new();
            while out.len() < 2 * 12_000 {
                out.extend(render(&mut synth, block));
            }
            out.truncate(2 * 12_000);
            let rest = render(&mut synth, 8 * RATE as usize);
            (out, synth.sounding(), super::peak(&rest[rest.len() - 2000..]))
        };
        let (whole, sounding, last) = run(12_000);
        assert!(super::peak(&whole) > 1e-3 && sounding <= 1 && last == 0.0, "{name}: {sounding}, {last}");
        for block in [1, 17, 480] {
            assert!(run(block).0 == whole, "{name} in blocks of {block}");
        }
    }
}

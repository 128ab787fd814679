//! The sound of wind: its slope, its pitch and its level, from long-term spectra.

use soffio_fourier::real_forward;
use soffio_math::{amplitude_to_db, ln};
use soffio_sound::{Preset, SoundCommand, Synth, WindSound, multifractal};

use super::{RATE, render, rms, spec};

/// Mean power spectrum of a long signal by Welch's method: `n` points a window of Hann, half overlapping.
pub fn spectrum(signal: &[f64], n: usize) -> Vec<f64> {
    let transform = real_forward(n);
    let window: Vec<f64> =
        (0..n).map(|i| 0.5 - 0.5 * soffio_math::cos(2.0 * soffio_math::PI * i as f64 / n as f64)).collect();
    let mut power = vec![0.0; n / 2 + 1];
    let mut bins = transform.make_output_vec();
    let mut windows = 0.0;
    for start in (0..signal.len().saturating_sub(n - 1)).step_by(n / 2) {
        let mut part: Vec<f64> = signal[start..start + n].iter().zip(&window).map(|(x, w)| x * w).collect();
        transform.process(&mut part, &mut bins).expect("lengths agree");
        power.iter_mut().zip(&bins).for_each(|(p, b)| *p += b.norm_sqr());
        windows += 1.0;
    }
    power.iter_mut().for_each(|p| *p /= windows);
    power
}

/// A timbre in steady wind, after it settled, mono.
fn wind(name: &str, speed: f32, seconds: usize) -> Vec<f64> {
    let preset = Preset::shipped(name).expect("valid");
    let mut synth = Synth::with_preset(RATE, &preset, &spec(name), 1).expect("compiles");
    synth.set_dry(true);
    synth.command(SoundCommand::Wind(WindSound { sample: 0, speed, ..WindSound::default() }));
    render(&mut synth, RATE as usize / 2);
    render(&mut synth, seconds * RATE as usize).chunks(2).map(|f| f64::from(f[0])).collect()
}

#[test]
fn gusts_have_the_slope_of_their_roughness() {
    // −1 − 2H within 0.15 over six octaves, from the mean of many realisations.
    const TOLERANCE: f64 = 0.15;
    for h in [0.1, 0.25, 1.0 / 3.0, 0.5, 1.0] {
        let (octaves, n, rate) = (10, 1 << 14, 1024.0);
        let mut total = vec![0.0; n / 2 + 1];
        for seed in 0..24 {
            let g: Vec<f64> = (0..4 * n).map(|i| multifractal(i as f64 / rate + 0.37, octaves, h, seed)).collect();
            let mean = g.iter().sum::<f64>() / g.len() as f64;
            let centred: Vec<f64> = g.iter().map(|x| x - mean).collect();
            total.iter_mut().zip(spectrum(&centred, n)).for_each(|(t, p)| *t += p);
        }
        // Density in whole octaves from 2 to 128 Hz: gradient noise has a bump in each octave, which a whole one evens out.
        let points: Vec<(f64, f64)> = (1..7)
            .map(|octave| {
                let (low, high) = ((1usize << octave) * n / rate as usize, (2usize << octave) * n / rate as usize);
                (f64::from(octave), ln(total[low..high].iter().sum::<f64>() / (high - low) as f64) / ln(2.0))
            })
            .collect();
        let count = points.len() as f64;
        let (mx, my) =
            (points.iter().map(|p| p.0).sum::<f64>() / count, points.iter().map(|p| p.1).sum::<f64>() / count);
        let slope = points.iter().map(|p| (p.0 - mx) * (p.1 - my)).sum::<f64>()
            / points.iter().map(|p| (p.0 - mx) * (p.0 - mx)).sum::<f64>();
        println!("H = {h:.2}: slope {slope:.3}, wanted {:.3}", -1.0 - 2.0 * h);
        assert!((slope + 1.0 + 2.0 * h).abs() < TOLERANCE, "H = {h}: {slope}");
    }
}

#[test]
fn a_wire_sings_at_a_fifth_of_the_speed_over_its_diameter() {
    const TOLERANCE: f64 = 0.03;
    for speed in [1.0, 2.0, 4.0, 8.0] {
        let power = spectrum(&wind("wind-wire", speed, 20), 1 << 14);
        let bin = f64::from(RATE) / f64::from(1 << 14);
        // Centre of the power within a third of an octave around its top.
        let top = (0..power.len()).max_by(|a, b| power[*a].total_cmp(&power[*b])).expect("bins");
        let near = (top as f64 * 0.89) as usize..(top as f64 * 1.12) as usize + 1;
        let tone = near.clone().map(|i| i as f64 * power[i]).sum::<f64>() / near.map(|i| power[i]).sum::<f64>() * bin;
        let strouhal = 0.2 * f64::from(speed) / 0.8e-3;
        println!("{speed} m/s: {tone:.1} Hz, 0.2 U/d = {strouhal:.1} Hz");
        assert!((tone / strouhal - 1.0).abs() < TOLERANCE, "{speed} m/s: {tone} Hz");
    }
}

#[test]
fn wind_gains_eighteen_decibels_per_doubling() {
    // Pressure grows with U³. Gusts are the same at the same time, so levels compare.
    const TOLERANCE: f64 = 1.0;
    for (name, speeds) in [("wind-room", [0.75, 1.5, 3.0]), ("wind-wire", [1.0, 2.0, 4.0])] {
        let levels: Vec<f64> = speeds
            .iter()
            .map(|&speed| amplitude_to_db(rms(&wind(name, speed, 20).iter().map(|x| *x as f32).collect::<Vec<_>>())))
            .collect();
        println!("{name} at {speeds:?} m/s: {levels:.2?} dBFS");
        for pair in levels.windows(2) {
            assert!((pair[1] - pair[0] - 18.0).abs() < TOLERANCE, "{name}: {levels:?}");
        }
    }
}

#[test]
fn noises_have_their_colours() {
    let play = |kind: &str| {
        let text = format!(
            "timbre = 1\nname = \"x\"\ndescription = \"\"\n[node.n]\ntype = \"noise\"\nkind = \"{kind}\"\nbase = 20\noctaves = 8\nroughness = 0.5\n\
            [node.out]\ntype = \"sum\"\nin = [\"n\"]\ngain = {{ input = \"wind_speed\", max = 1, scale = 0.1 }}\n"
        );
        let preset = Preset::parse("x", &text).expect("valid");
        let mut synth = Synth::with_preset(RATE, &preset, &spec("x"), 1).expect("compiles");
        synth.set_dry(true);
        synth.command(SoundCommand::Wind(WindSound { sample: 0, speed: 1.0, ..WindSound::default() }));
        render(&mut synth, RATE as usize);
        let out: Vec<f64> = render(&mut synth, 30 * RATE as usize).chunks(2).map(|f| 10.0 * f64::from(f[0])).collect();
        let level = (out.iter().map(|x| x * x).sum::<f64>() / out.len() as f64).sqrt();
        (spectrum(&out, 1 << 12), level)
    };
    let density = |power: &[f64], low: f64| {
        let bin = |f: f64| (f / f64::from(RATE) * 4096.0) as usize;
        10.0 * soffio_math::log10(
            power[bin(low)..bin(2.0 * low)].iter().sum::<f64>() / (bin(2.0 * low) - bin(low)) as f64,
        )
    };
    // Octave by octave; half a decibel is the ripple of the pink filter and the scatter of 30 s.
    const RIPPLE: f64 = 0.6;
    let ((white, loud), (pink, soft)) = (play("white"), play("pink"));
    for i in 0..7 {
        let f = 60.0 * f64::from(1 << i);
        assert!((density(&white, 2.0 * f) - density(&white, f)).abs() < RIPPLE, "white at {f} Hz");
        let step = density(&pink, 2.0 * f) - density(&pink, f);
        assert!((step + 3.01).abs() < RIPPLE, "pink at {f} Hz: {step} dB per octave");
    }
    println!("white {loud:.3}, pink {soft:.3}");
    assert!((soft / loud - 1.0).abs() < 0.1, "pink is as loud as white: {soft} and {loud}");
    // Gradient noise of audible rate: −1 − 2H = −2 is −6 dB per octave, between the bumps of its octaves.
    let (perlin, _) = play("perlin");
    let fall = density(&perlin, 80.0) - density(&perlin, 1280.0);
    assert!((fall - 24.0).abs() < 4.0, "{fall} dB in four octaves");
}

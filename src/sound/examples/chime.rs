//! Rings a chime tube of aluminium and prints its peak and its decay.
//!
//! `cargo run -p soffio-sound --example chime`            prints only
//! `cargo run -p soffio-sound --example chime out.wav`    also writes the sound, stereo, 48 kHz

use soffio_math::{PI, amplitude_to_db};
use soffio_sound::{InstrumentSpec, SoundBody, SoundCommand, SoundMaterial, Strike, Synth};

const RATE: u32 = 48_000;
const SECONDS: usize = 4;

/// A tube of 25.4 mm with a wall of 1.65 mm, 0.6 m long: its longest side is the first half extent.
fn tube() -> SoundBody {
    let (length, outer, wall) = (0.6, 0.0254, 0.00165);
    let section = PI * wall * (outer - wall);
    SoundBody {
        half_extents: [0.5 * length, 0.5 * outer],
        thickness: wall,
        area: 2.0 * PI * outer * length,
        mass: 2710.0 * section * length,
    }
}

fn main() -> Result<(), hound::Error> {
    let material = SoundMaterial { youngs_modulus: 68.9e9, poisson: 0.33, density: 2710.0, loss_factor: 1e-4 };
    let spec = InstrumentSpec {
        timbre: "chime-aluminium".into(),
        own: None,
        body: tube(),
        material,
        surface: None,
        gain: 1.0,
        max_voices: 1,
    };
    let mut synth = Synth::new(RATE, &[spec], 1).expect("a shipped timbre");
    synth.command(SoundCommand::Strike(Strike {
        sample: 0,
        instrument: 0,
        impulse: 0.01, // N s: a wooden striker of 30 g at 0.3 m/s
        speed: 0.3,
        mass: 0.03,
        position: [0.0, 0.0],
        pan: 0.0,
        distance: 1.0,
    }));
    let mut frames = vec![0.0_f32; 2 * SECONDS * RATE as usize];
    synth.render(&mut frames);

    let peak = frames.iter().fold(0.0, |most: f32, x| most.max(x.abs()));
    println!("peak {:.1} dB of full scale", amplitude_to_db(f64::from(peak)));
    let level = |second: f64| {
        let from = 2 * (second * f64::from(RATE)) as usize;
        let part = &frames[from..from + RATE as usize / 5]; // a tenth of a second of both channels
        amplitude_to_db((part.iter().map(|x| f64::from(*x) * f64::from(*x)).sum::<f64>() / part.len() as f64).sqrt())
    };
    for second in [0.1, 0.5, 1.0, 2.0, 3.0] {
        println!("after {second:.1} s: {:.1} dB of full scale (RMS)", level(second));
    }
    println!("it falls by 60 dB in about {:.1} s", 60.0 * 2.0 / (level(1.0) - level(3.0)));

    if let Some(path) = std::env::args().nth(1) {
        let spec = hound::WavSpec {
            channels: 2,
            sample_rate: RATE,
            bits_per_sample: 32,
            sample_format: hound::SampleFormat::Float,
        };
        let mut file = hound::WavWriter::create(path, spec)?;
        frames.iter().try_for_each(|x| file.write_sample(*x))?;
        file.finalize()?;
    }
    Ok(())
}

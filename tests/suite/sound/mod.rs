//! Sound of whole scenes. The synthesizer alone is tested in its own crate.

mod contact;
mod every_timbre;
pub mod own_timbres;
mod scratching;
mod visit;

use soffio_fourier::real_forward;
use soffio_math::PI;
use soffio_sound::{InstrumentSpec, SoundBody, SoundMaterial, Synth};

pub const RATE: u32 = 48_000;

fn steel() -> SoundMaterial {
    SoundMaterial { youngs_modulus: 2e11, poisson: 0.3, density: 7850.0, loss_factor: 6e-4 }
}

fn disc(radius: f64, thickness: f64) -> SoundBody {
    let area = PI * radius * radius;
    SoundBody { half_extents: [radius; 2], thickness, area, mass: area * thickness * steel().density }
}

fn spec(timbre: &str) -> InstrumentSpec {
    InstrumentSpec {
        timbre: timbre.into(),
        own: None,
        body: disc(0.06, 5e-4),
        material: steel(),
        surface: None,
        gain: 1.0,
        max_voices: 8,
    }
}

fn render(synth: &mut Synth, frames: usize) -> Vec<f32> {
    let mut out = vec![0.0; 2 * frames];
    synth.render(&mut out);
    out
}

fn rms(samples: &[f32]) -> f64 {
    (samples.iter().map(|s| f64::from(*s) * f64::from(*s)).sum::<f64>() / samples.len() as f64).sqrt()
}

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

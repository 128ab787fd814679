//! Test rendering of one timbre on its specimen, for listening and measuring.

use soffio_simulation::SAMPLE_RATE;
use soffio_sound::timbre::Specimen;
use soffio_sound::{Preset, SoundCommand, SoundSurface, SurfaceLine, Synth, TimbreError};

/// Parameters of a test sound, in addition to those of the specimen.
#[derive(Clone, Debug, Default)]
pub struct TestSound {
    /// Peak force of the impact, N, instead of its impulse: J = 2Fτ/π for a half sine of Hertz's duration τ.
    pub peak_force: Option<f64>,
    /// Direction of the wind, rad.
    pub direction: f64,
    /// Surface profile, for timbres that read a picture.
    pub surface: Option<SurfaceLine>,
    /// Seed of the random numbers.
    pub seed: u64,
}

/// Reasons why a timbre cannot be rendered.
#[derive(Debug, thiserror::Error)]
pub enum AuditionError {
    /// The timbre cannot be built on this body.
    #[error(transparent)]
    Timbre(#[from] TimbreError),
    /// A number is not finite or out of range.
    #[error("a number given cannot be played: all must be finite, an impulse, masses and forces at least 0")]
    Number,
}

impl TestSound {
    /// Renders so many seconds, mono, dry, at 1 m; full scale is ±1 and can be exceeded.
    ///
    /// # Errors
    /// The preset does not fit the specimen's body.
    pub fn render(&self, preset: &Preset, specimen: &Specimen, seconds: f64) -> Result<Vec<f32>, AuditionError> {
        let mut spec = specimen.spec(&preset.name);
        spec.surface = self.surface.clone().map(SoundSurface::Line);
        let mut synth = Synth::with_preset(SAMPLE_RATE, preset, &spec, self.seed)?;
        synth.set_dry(true);
        synth.command(self.command(preset, specimen, &synth));
        let mut stereo = vec![0.0; 2 * (seconds * f64::from(SAMPLE_RATE)) as usize];
        synth.render(&mut stereo);
        if synth.faults() > 0 {
            return Err(AuditionError::Number);
        }
        // A centred sound is 1/√2 on either side: the sum of both over √2 is the sound itself.
        let half = std::f32::consts::FRAC_1_SQRT_2;
        Ok(stereo.as_chunks::<2>().0.iter().map(|[left, right]| (left + right) * half).collect())
    }

    fn command(&self, preset: &Preset, s: &Specimen, synth: &Synth) -> SoundCommand {
        let mut command = s.command(preset, 0, 0);
        match &mut command {
            SoundCommand::Wind(wind) => wind.direction = self.direction as f32,
            SoundCommand::Strike(strike) => {
                let contact_time = synth.contact_time(0, s.hit_mass, s.speed).unwrap_or_default();
                let of_peak = |force: f64| (2.0 * force * contact_time / std::f64::consts::PI) as f32;
                strike.impulse = self.peak_force.map_or(strike.impulse, of_peak);
            }
            _ => {}
        }
        command
    }
}

//! Instruments of the synthesizer: those of the exhibit on show, and one more that staff try.

use std::sync::Arc;

use soffio_exhibit::Exhibit;
use soffio_sound::timbre::names;
use soffio_sound::{
    BodyMotion, InstrumentSpec, MotionSound, Preset, ReverbSpec, Slide, SoundCommand, Strike, Synth, WindSound,
};

/// Mass of the beater with which staff try an instrument, kg: a small wooden one.
const BEATER: f64 = 0.01;
/// Distance of its sound from the listener, m.
const AWAY: f32 = 1.0;
/// Length of a sustained sound, audio samples: 0.8 s.
const SUSTAINED: u64 = 38_400;

/// A sound that staff try through the live loudspeaker.
#[derive(Clone, Debug, PartialEq)]
pub struct Audition {
    /// The instrument.
    pub target: AuditionTarget,
    /// Speed of the hit or of the slide, m/s.
    pub speed: f64,
    /// −1 left … 1 right.
    pub pan: f32,
}

/// An instrument to try.
#[derive(Clone, Debug, PartialEq)]
pub enum AuditionTarget {
    /// One of the exhibit, by its index.
    Exhibit(usize),
    /// A timbre on its specimen.
    Timbre(Arc<Preset>),
}

/// The shipped timbres.
pub fn timbres() -> impl Iterator<Item = Arc<Preset>> {
    names().filter_map(shipped)
}

/// A shipped timbre; `None`, and a line in the log, where there is none of this name.
pub fn shipped(name: &str) -> Option<Arc<Preset>> {
    Preset::shipped(name).inspect_err(|error| tracing::error!("{error}")).ok().map(Arc::new)
}

/// A timbre on its specimen, the body on which it is tried.
#[derive(Clone, Debug)]
pub struct AuditionInstrument {
    /// The timbre.
    pub preset: Arc<Preset>,
}

impl AuditionInstrument {
    /// The body with the timbre, as an instrument.
    pub fn spec(&self) -> InstrumentSpec {
        let own = Some(self.preset.clone());
        InstrumentSpec { own, ..self.preset.specimen.spec(&self.preset.name) }
    }

    /// Commands for the synth that play `audition` from the sample with number `sample` on. `instrument` is its index in the
    /// synth, after those of the exhibit. Hits and slides have the speed of the audition, wind and motion that of the specimen.
    pub fn play(&self, instrument: u16, audition: &Audition, sample: u64) -> Vec<SoundCommand> {
        let s = &self.preset.specimen;
        let (speed, pan) = (audition.speed as f32, audition.pan);
        let mut command = s.command(&self.preset, instrument, sample);
        let later = sample + SUSTAINED;
        let end = match &mut command {
            SoundCommand::Strike(strike) => {
                // The impulse of the specimen's own hit, scaled by the speed.
                strike.impulse = (s.impulse * audition.speed / s.speed.max(1e-3)) as f32;
                (strike.speed, strike.pan) = (speed, pan);
                None
            }
            SoundCommand::Slide(slide) => {
                (slide.speed, slide.pan) = (speed, pan);
                Some(SoundCommand::Slide(Slide { sample: later, speed: 0.0, force: 0.0, ..*slide }))
            }
            SoundCommand::Wind(wind) => {
                wind.pan = pan;
                Some(SoundCommand::Wind(WindSound { sample: later, speed: 0.0, ..*wind }))
            }
            SoundCommand::Motion(moving) => {
                moving.pan = pan;
                Some(SoundCommand::Motion(MotionSound { sample: later, motion: BodyMotion::default(), ..*moving }))
            }
            SoundCommand::Damp(_) | SoundCommand::Silence { .. } => None,
        };
        std::iter::once(command).chain(end).collect()
    }
}

/// A hit of the beater on an instrument of the exhibit.
pub fn hit(instrument: u16, audition: &Audition, sample: u64) -> SoundCommand {
    let (speed, mass) = (audition.speed as f32, BEATER as f32);
    // A beater that rebounds at the same speed transfers twice its momentum.
    let impulse = 2.0 * mass * speed;
    let position = [0.7, 0.2];
    SoundCommand::Strike(Strike {
        sample,
        instrument,
        impulse,
        speed,
        mass,
        position,
        pan: audition.pan,
        distance: AWAY,
    })
}

/// Settings of the synthesizer besides the exhibit's instruments.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SynthSetup {
    /// Reverberation; `None` is the open air.
    pub reverb: Option<ReverbSpec>,
    /// Limit of sounding partials.
    pub most_partials: usize,
    /// Seed of all random numbers.
    pub seed: u64,
}

impl SynthSetup {
    /// Returns a function that builds the synthesizer of an exhibit, with an instrument to try after its own, at a sample rate.
    pub fn synth(
        self,
        exhibit: &Exhibit,
        audition_instrument: Option<&AuditionInstrument>,
    ) -> impl Fn(u32) -> Synth + Send + 'static {
        let own = exhibit.instruments.iter().cloned();
        let instruments: Vec<InstrumentSpec> = own.chain(audition_instrument.map(AuditionInstrument::spec)).collect();
        move |rate| {
            let mut synth = Synth::new(rate, &instruments, self.seed).unwrap_or_else(|error| {
                tracing::error!("the exhibit stays silent: {error}");
                Synth::silent(rate)
            });
            synth.set_reverb(self.reverb.as_ref());
            synth.set_most_partials(self.most_partials);
            synth
        }
    }
}

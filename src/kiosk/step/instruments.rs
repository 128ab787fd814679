//! Instruments of the synthesizer: those of the exhibit on show, and one more that staff try.

use soffio_exhibit::Exhibit;
use soffio_sound::timbre::{Specimen, names};
use soffio_sound::{InstrumentSpec, Preset, ReverbSpec, Slide, SoundCommand, Strike, Synth};

/// Mass of the beater with which staff try an instrument, kg: a small wooden one.
const BEATER: f64 = 0.01;
/// Distance of its sound from the listener, m.
const AWAY: f32 = 1.0;
/// Length of a slide over a scraped timbre, audio samples: 0.8 s.
const SCRAPE: u64 = 38_400;

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
    /// A shipped timbre on its specimen.
    Timbre(&'static str),
}

/// The shipped timbres that are hit or scraped: all except those of the wind.
pub fn timbres() -> impl Iterator<Item = &'static str> {
    names().filter(|name| preset(name).is_some_and(|preset| preset.slides() || !preset.continuous()))
}

fn preset(name: &str) -> Option<Preset> {
    Preset::shipped(name).inspect_err(|error| tracing::error!("{error}")).ok()
}

/// A timbre with its specimen, the body on which it is tried.
#[derive(Clone, Debug)]
pub struct AuditionInstrument {
    /// Name of the timbre.
    pub name: &'static str,
    specimen: Specimen,
    slides: bool,
}

impl AuditionInstrument {
    /// The shipped timbre of this name on its specimen; `None` where there is none.
    pub fn new(name: &'static str) -> Option<Self> {
        let preset = preset(name)?;
        let slides = preset.slides();
        Some(Self { name, specimen: preset.specimen, slides })
    }

    /// Commands for the synth that play `audition` from the sample with number `sample` on. `instrument` is its index in the
    /// synth, after those of the exhibit.
    pub fn play(&self, instrument: u16, audition: &Audition, sample: u64) -> Vec<SoundCommand> {
        let s = &self.specimen;
        let position = [s.at as f32, s.at_y as f32];
        let (speed, pan) = (audition.speed as f32, audition.pan);
        if self.slides {
            let force = s.force as f32;
            let slide = Slide { sample, instrument, speed, force, position, pan, distance: AWAY };
            let end = Slide { sample: sample + SCRAPE, speed: 0.0, force: 0.0, ..slide };
            return vec![SoundCommand::Slide(slide), SoundCommand::Slide(end)];
        }
        // The impulse of the specimen's own hit, scaled by the speed.
        let impulse = s.impulse * audition.speed / s.speed.max(1e-3);
        let (impulse, mass) = (impulse as f32, s.hit_mass as f32);
        vec![SoundCommand::Strike(Strike { sample, instrument, impulse, speed, mass, position, pan, distance: AWAY })]
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
        let instruments: Vec<InstrumentSpec> = own
            .chain(
                audition_instrument
                    .map(|audition_instrument| audition_instrument.specimen.spec(audition_instrument.name)),
            )
            .collect();
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

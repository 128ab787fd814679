//! The instruments that the loudspeaker plays: those of the exhibit on show, and beside them one that staff try.

use soffio_exhibit::Exhibit;
use soffio_sound::timbre::{Specimen, names};
use soffio_sound::{InstrumentSpec, Preset, ReverbSpec, Slide, SoundCommand, Strike, Synth};

/// What strikes an instrument that staff try, kg: a small wooden beater.
const BEATER: f64 = 0.01;
/// How far before the listener it sounds, m.
const AWAY: f32 = 1.0;
/// How long something slides over a timbre that is scraped, audio samples: 0.8 s.
const SCRAPE: u64 = 38_400;

/// What is tried through the live loudspeaker.
#[derive(Clone, Debug, PartialEq)]
pub struct Trial {
    /// Which instrument.
    pub tried: Tried,
    /// How hard: speed of the hit or of the sliding, m/s.
    pub speed: f64,
    /// −1 left … 1 right.
    pub pan: f32,
}

/// An instrument to try.
#[derive(Clone, Debug, PartialEq)]
pub enum Tried {
    /// The exhibit's own, by its index.
    Own(usize),
    /// A shipped timbre on its specimen.
    Timbre(&'static str),
}

/// The shipped timbres that a hit or a scrape plays: all but those of the wind.
pub fn timbres() -> impl Iterator<Item = &'static str> {
    names().filter(|name| preset(name).is_some_and(|preset| preset.slides() || !preset.continuous()))
}

fn preset(name: &str) -> Option<Preset> {
    Preset::shipped(name).inspect_err(|error| tracing::error!("{error}")).ok()
}

/// A timbre with the body it is tried on.
#[derive(Clone, Debug)]
pub struct Guest {
    /// Name of the timbre.
    pub name: &'static str,
    specimen: Specimen,
    slides: bool,
}

impl Guest {
    /// A shipped timbre on its specimen.
    pub fn new(name: &'static str) -> Option<Self> {
        let preset = preset(name)?;
        let slides = preset.slides();
        Some(Self { name, specimen: preset.specimen, slides })
    }

    /// What plays it, as the instrument after the exhibit's own; from `sample` on.
    pub fn play(&self, instrument: u16, trial: &Trial, sample: u64) -> Vec<SoundCommand> {
        let s = &self.specimen;
        let position = [s.at as f32, s.at_y as f32];
        let (speed, pan) = (trial.speed as f32, trial.pan);
        if self.slides {
            let force = s.force as f32;
            let slide = Slide { sample, instrument, speed, force, position, pan, distance: AWAY };
            let end = Slide { sample: sample + SCRAPE, speed: 0.0, force: 0.0, ..slide };
            return vec![SoundCommand::Slide(slide), SoundCommand::Slide(end)];
        }
        // As hard as the specimen's own hit at the specimen's speed.
        let impulse = s.impulse * trial.speed / s.speed.max(1e-3);
        let (impulse, mass) = (impulse as f32, s.hit_mass as f32);
        vec![SoundCommand::Strike(Strike { sample, instrument, impulse, speed, mass, position, pan, distance: AWAY })]
    }
}

/// A hit of the beater on one of the exhibit's own instruments.
pub fn hit(instrument: u16, trial: &Trial, sample: u64) -> SoundCommand {
    let (speed, mass) = (trial.speed as f32, BEATER as f32);
    // A beater that comes back as fast as it came gives twice its momentum.
    let impulse = 2.0 * mass * speed;
    let position = [0.7, 0.2];
    SoundCommand::Strike(Strike { sample, instrument, impulse, speed, mass, position, pan: trial.pan, distance: AWAY })
}

/// What the site adds to an exhibit's instruments.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Voice {
    /// What they are heard in; `None` is the open air.
    pub room: Option<ReverbSpec>,
    /// That ring at once.
    pub most_partials: usize,
    /// Of all that is random.
    pub seed: u64,
}

impl Voice {
    /// Builds the voice of an exhibit, and of a guest after it, for a loudspeaker's rate.
    pub fn synth(self, exhibit: &Exhibit, guest: Option<&Guest>) -> impl Fn(u32) -> Synth + Send + 'static {
        let own = exhibit.instruments.iter().cloned();
        let instruments: Vec<InstrumentSpec> = own.chain(guest.map(|guest| guest.specimen.spec(guest.name))).collect();
        move |rate| {
            let mut synth = Synth::new(rate, &instruments, self.seed).unwrap_or_else(|error| {
                tracing::error!("the exhibit stays silent: {error}");
                Synth::silent(rate)
            });
            synth.set_reverb(self.room.as_ref());
            synth.set_most_partials(self.most_partials);
            synth
        }
    }
}

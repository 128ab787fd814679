//! Captions: which of the exhibit's sounds can be heard now, for those who cannot hear them.
//!
//! A sound is captioned from when it is set off until two seconds after; what slides or blows, for as long as it does.

use soffio_exhibit::{Exhibit, SoundBinding, SoundTrigger};
use soffio_simulation::STEPS_PER_SECOND;
use soffio_sound::SoundCommand;

/// A caption stays so long, s: long enough to be read.
const STAYS: f64 = 2.0;
/// Slower hits are not heard over a room, m/s.
const HIT: f32 = 0.02;
/// Slower winds are not heard over a room, m/s.
const WIND: f32 = 0.8;
/// Captions at once.
const MOST: usize = 2;

/// When each sound of an exhibit was last heard.
#[derive(Clone, Debug, Default)]
pub struct Captions {
    /// Step, by the exhibit's sounds.
    heard: Vec<Option<u64>>,
    /// Which slide.
    slides: Vec<bool>,
}

impl Captions {
    /// Takes in what sounds in a step.
    pub fn note(&mut self, exhibit: &Exhibit, sounds: &[SoundCommand], step: u64) {
        self.heard.resize(exhibit.sounds.len(), None);
        self.slides.resize(exhibit.sounds.len(), false);
        for command in sounds {
            for (index, sound) in exhibit.sounds.iter().enumerate() {
                match (command, sound.on) {
                    (SoundCommand::Strike(strike), SoundTrigger::Impact)
                        if plays(sound, strike.instrument) && strike.speed > HIT =>
                    {
                        self.heard[index] = Some(step);
                    }
                    (SoundCommand::Slide(slide), SoundTrigger::Slide) if plays(sound, slide.instrument) => {
                        self.slides[index] = slide.force > 0.0 && slide.speed > 0.0;
                    }
                    (SoundCommand::Wind(wind), SoundTrigger::Wind) if wind.speed > WIND => {
                        self.heard[index] = Some(step);
                    }
                    _ => {}
                }
            }
        }
        for (heard, _) in self.heard.iter_mut().zip(&self.slides).filter(|(_, slides)| **slides) {
            *heard = Some(step);
        }
    }

    /// Keys of the captions to be read at a step, the newest first.
    pub fn shown(&self, exhibit: &Exhibit, step: u64) -> Vec<String> {
        let stays = (STAYS * STEPS_PER_SECOND as f64) as u64;
        let mut now: Vec<(u64, &str)> = Vec::new();
        for (sound, heard) in exhibit.sounds.iter().zip(&self.heard) {
            let (Some(heard), Some(key)) = (heard, sound.caption.as_deref()) else { continue };
            if step.saturating_sub(*heard) > stays {
                continue;
            }
            match now.iter_mut().find(|(_, other)| *other == key) {
                Some((newest, _)) => *newest = (*newest).max(*heard),
                None => now.push((*heard, key)),
            }
        }
        now.sort_by_key(|(heard, _)| std::cmp::Reverse(*heard));
        now.into_iter().take(MOST).map(|(_, key)| key.to_owned()).collect()
    }
}

fn plays(sound: &SoundBinding, instrument: u16) -> bool {
    sound.instrument == usize::from(instrument)
}

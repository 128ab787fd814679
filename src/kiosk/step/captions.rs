//! Captions of the exhibit's sounds, for visitors who cannot hear them.
//!
//! A caption is shown for two seconds after a sound starts. Sliding and wind are captioned for as long as they last.

use soffio_exhibit::{Exhibit, SoundBinding, SoundTrigger};
use soffio_simulation::STEPS_PER_SECOND;
use soffio_sound::{BodyMotion, SoundCommand};

/// Time for which a caption is shown, s: long enough to be read.
const STAYS: f64 = 2.0;
/// Least speed of an audible impact, m/s.
const HIT: f32 = 0.02;
/// Least speed of an audible wind, m/s.
const WIND: f32 = 0.8;
/// Least speed (m/s) or spin (rad/s) of an audible motion: a slow swing.
const MOVES: [f32; 2] = [0.1, 0.5];
/// Most captions at once.
const MOST: usize = 2;

/// Last step of each sound of an exhibit.
#[derive(Clone, Debug, Default)]
pub struct Captions {
    /// Step, by the exhibit's sounds.
    played_at: Vec<Option<u64>>,
    /// Sounds of sliding that are on.
    sliding: Vec<bool>,
}

impl Captions {
    /// Records the sounds of a step.
    pub fn update(&mut self, exhibit: &Exhibit, sounds: &[SoundCommand], step: u64) {
        self.played_at.resize(exhibit.sounds.len(), None);
        self.sliding.resize(exhibit.sounds.len(), false);
        for command in sounds {
            for (index, sound) in exhibit.sounds.iter().enumerate() {
                match (command, sound.on) {
                    (SoundCommand::Strike(strike), SoundTrigger::Impact | SoundTrigger::Motion)
                        if plays(sound, strike.instrument) && strike.speed > HIT =>
                    {
                        self.played_at[index] = Some(step);
                    }
                    (SoundCommand::Slide(slide), SoundTrigger::Slide) if plays(sound, slide.instrument) => {
                        self.sliding[index] = slide.force > 0.0 && slide.speed > 0.0;
                    }
                    (SoundCommand::Wind(wind), SoundTrigger::Wind)
                        if plays(sound, wind.instrument) && wind.speed > WIND =>
                    {
                        self.played_at[index] = Some(step);
                    }
                    (SoundCommand::Motion(moving), SoundTrigger::Motion) if plays(sound, moving.instrument) => {
                        let BodyMotion { speed, spin, .. } = moving.motion;
                        if speed > MOVES[0] || spin > MOVES[1] {
                            self.played_at[index] = Some(step);
                        }
                    }
                    _ => {}
                }
            }
        }
        for (played_at, _) in self.played_at.iter_mut().zip(&self.sliding).filter(|(_, sliding)| **sliding) {
            *played_at = Some(step);
        }
    }

    /// Keys of the captions to show at a step, the newest first.
    pub fn shown(&self, exhibit: &Exhibit, step: u64) -> Vec<String> {
        let stays = (STAYS * STEPS_PER_SECOND as f64) as u64;
        let mut now: Vec<(u64, &str)> = Vec::new();
        for (sound, played_at) in exhibit.sounds.iter().zip(&self.played_at) {
            let (Some(played_at), Some(key)) = (played_at, sound.caption.as_deref()) else { continue };
            if step.saturating_sub(*played_at) > stays {
                continue;
            }
            match now.iter_mut().find(|(_, other)| *other == key) {
                Some((newest, _)) => *newest = (*newest).max(*played_at),
                None => now.push((*played_at, key)),
            }
        }
        now.sort_by_key(|(played_at, _)| std::cmp::Reverse(*played_at));
        now.into_iter().take(MOST).map(|(_, key)| key.to_owned()).collect()
    }
}

fn plays(sound: &SoundBinding, instrument: u16) -> bool {
    sound.instrument == usize::from(instrument)
}

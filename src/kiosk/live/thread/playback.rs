//! What is heard: the instruments of the exhibit on show, one that staff try beside them, and how loud it all is.

use crate::step::stage::Stage;
use crate::step::voice::{Guest, Trial, Tried, Voice, hit};
use crate::venue::loudness::{Loudness, Wishes};
use crate::venue::site::Site;
use soffio_config::AudioSettings;
use soffio_devices::audio::AudioIo;
use soffio_exhibit::Exhibit;
use soffio_math::from_decibels;
use soffio_sound::SoundCommand;

/// The loudspeaker's side of the thread. The devices are opened together, so the microphone is read through it too.
pub(super) struct Playback {
    pub audio: AudioIo,
    pub loudness: Loudness,
    /// Sounds of the steps that are being done.
    pub sounds: Vec<SoundCommand>,
    voice: Voice,
    /// The timbre that staff try beside the exhibit's own, and what is to be heard when it has come.
    guest: Option<Guest>,
    trial: Option<Trial>,
}

impl Playback {
    /// Opens the devices; the microphone only where something may be heard.
    pub(super) fn start(site: &Site, exhibit: &Exhibit, closed: bool) -> Self {
        let voice = voice(site);
        Self {
            audio: AudioIo::start_with(&site.audio, site.breath && !closed, voice.synth(exhibit, None)),
            loudness: Loudness::new(site.volume, site.night.clone(), site.silent_attract),
            sounds: Vec::new(),
            voice,
            guest: None,
            trial: None,
        }
    }

    /// Takes over a changed configuration: only what differs begins anew.
    pub(super) fn settle(&mut self, before: &Site, site: &Site, exhibit: &Exhibit, closed: bool) {
        self.voice = voice(site);
        let devices = |site: &Site| AudioSettings { volume_db: 0.0, most_partials: 0, ..site.audio.clone() };
        let reopens = devices(before) != devices(site);
        if reopens {
            let synth = self.voice.synth(exhibit, self.guest.as_ref());
            self.audio = AudioIo::start_with(&site.audio, site.breath && !closed, synth);
        } else if self.voice != voice(before) || before.settings != site.settings {
            self.audio.set_instruments(self.voice.synth(exhibit, self.guest.as_ref()));
        }
        let loud = |site: &Site| (site.volume, site.night.clone(), site.silent_attract);
        if reopens || loud(before) != loud(site) {
            self.loudness.settle(site.volume, site.night.clone(), site.silent_attract, reopens);
        }
    }

    /// Another exhibit, with its own sounds alone.
    pub(super) fn swap(&mut self, exhibit: &Exhibit) {
        (self.guest, self.trial) = (None, None);
        self.audio.set_instruments(self.voice.synth(exhibit, None));
    }

    /// Plays what staff want to hear: the exhibit's own instruments at once, others when they have been built.
    pub(super) fn try_sounds(&mut self, trial: Option<Trial>, stage: &Stage) {
        let sample = stage.sample();
        let instruments = stage.exhibit().instruments.len();
        match trial {
            Some(trial) => match trial.tried {
                Tried::Own(index) if index < instruments => self.sounds.push(hit(index as u16, &trial, sample)),
                Tried::Own(_) => {}
                Tried::Timbre(name) => {
                    if self.guest.as_ref().is_none_or(|guest| guest.name != name) {
                        self.guest = Guest::new(name);
                        self.audio.set_instruments(self.voice.synth(stage.exhibit(), self.guest.as_ref()));
                    }
                    self.trial = Some(trial);
                }
            },
            None if self.trial.is_none() => return,
            None => {}
        }
        if self.audio.has_instruments()
            && let Some((trial, guest)) = self.trial.take().zip(self.guest.as_ref())
        {
            self.sounds.extend(guest.play(instruments as u16, &trial, sample));
        }
    }

    /// Sends the sounds of the steps done.
    pub(super) fn send(&mut self, stage: &Stage) {
        self.audio.send(stage.sample(), &self.sounds);
    }

    /// Sets how loud it is; a chirp is heard at the configured volume.
    pub(super) fn set_loudness(&mut self, wishes: Wishes, (attracts, closed): (bool, bool), chirp_at_db: Option<f64>) {
        self.loudness.tend(wishes, (attracts, closed), self.audio.knobs());
        if let Some(volume_db) = chirp_at_db {
            self.audio.knobs().set_volume(from_decibels(volume_db) as f32);
        }
    }
}

/// What the site adds to an exhibit's instruments.
fn voice(site: &Site) -> Voice {
    Voice { room: site.room, most_partials: site.audio.most_partials as usize, seed: site.settings.seed }
}

//! What changes while the kiosk runs: the configuration, the exhibit, the instruments that staff try.

use std::sync::Arc;

use super::Thread;
use crate::live::local_time;
use crate::step::captions::Captions;
use crate::step::governor::Governor;
use crate::step::moments::Moments;
use crate::step::voice::{Guest, Trial, Tried, Voice, hit};
use crate::venue::site::Site;
use soffio_config::AudioSettings;
use soffio_devices::audio::AudioIo;
use soffio_devices::controllers::Controllers;
use soffio_exhibit::Exhibit;
use soffio_simulation::Settings;

impl Thread {
    /// Takes over a changed configuration: of the devices and threads only what differs begins anew.
    pub(super) fn settle(&mut self, site: Site) {
        let before = std::mem::replace(&mut self.site, site);
        let site = &self.site;
        self.voice = voice(site);
        let devices = |site: &Site| AudioSettings { volume_db: 0.0, most_partials: 0, ..site.audio.clone() };
        let reopens = devices(&before) != devices(site);
        if reopens {
            let synth = self.voice.synth(self.stage.exhibit(), self.guest.as_ref());
            self.audio = AudioIo::start_with(&site.audio, site.breath && !self.closed, synth);
        } else if self.voice != voice(&before) || before.settings != site.settings {
            self.audio.set_instruments(self.voice.synth(self.stage.exhibit(), self.guest.as_ref()));
        }
        let loud = |site: &Site| (site.volume, site.night.clone(), site.silent_attract);
        if reopens || loud(&before) != loud(site) {
            self.loudness.settle(site.volume, site.night.clone(), site.silent_attract, reopens);
        }
        if before.controllers != site.controllers {
            self.controllers = Controllers::start(&site.controllers);
        }
        let anew = before.settings != site.settings;
        if anew {
            self.end();
        }
        self.stage.settle(Settings { clock: local_time(), ..self.site.settings }, self.site.idle_s);
        if anew {
            self.begin_anew();
        }
    }

    /// The run of the exhibit on show is over.
    fn end(&mut self) {
        if let Some(record) = &mut self.record {
            record.end(&self.stage);
        }
    }

    /// The exhibit begins at its start: what was told of it is over. A trace knows one run only and ends.
    fn begin_anew(&mut self) {
        if let Some(record) = &mut self.record {
            record.begin(self.stage.exhibit(), *self.stage.settings());
        }
        self.captions = Captions::default();
        self.moments = Moments::new(self.stage.snapshot());
        self.onset = None;
        if let Some(trace) = self.trace.take() {
            match trace.finish() {
                Ok(_) => tracing::warn!("the trace ends here: the exhibit begins anew"),
                Err(error) => tracing::error!("{error}"),
            }
        }
    }

    /// Plays what staff want to hear: the exhibit's own instruments at once, others when they have been built.
    pub(super) fn try_sounds(&mut self, trial: Option<Trial>) {
        let sample = self.stage.sample();
        let instruments = self.stage.exhibit().instruments.len();
        match trial {
            Some(trial) => match trial.tried {
                Tried::Own(index) if index < instruments => self.sounds.push(hit(index as u16, &trial, sample)),
                Tried::Own(_) => {}
                Tried::Timbre(name) => {
                    if self.guest.as_ref().is_none_or(|guest| guest.name != name) {
                        self.guest = Guest::new(name);
                        self.audio.set_instruments(self.voice.synth(self.stage.exhibit(), self.guest.as_ref()));
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

    /// Another exhibit from its start, with its own sounds.
    pub(super) fn swap(&mut self, exhibit: Arc<Exhibit>) {
        (self.guest, self.trial) = (None, None);
        self.audio.set_instruments(self.voice.synth(&exhibit, None));
        self.governor = Governor::new(exhibit.motion);
        self.end();
        self.stage.swap(exhibit, local_time());
        self.begin_anew();
    }
}

/// What the site adds to an exhibit's instruments.
pub(super) fn voice(site: &Site) -> Voice {
    Voice { room: site.room, most_partials: site.audio.most_partials as usize, seed: site.settings.seed }
}

//! Sound output: the instruments of the exhibit on show, one more that staff try, and the loudness.

use crate::step::instruments::{Audition, AuditionInstrument, AuditionTarget, SynthSetup, hit};
use crate::step::stage::Stage;
use crate::venue::loudness::{KioskActivity, Loudness, LoudnessSettings, OutputCount, VolumeRequests};
use crate::venue::site::Site;
use soffio_config::AudioSettings;
use soffio_devices::audio::AudioIo;
use soffio_exhibit::Exhibit;
use soffio_math::db_to_amplitude;
use soffio_sound::SoundCommand;

/// Sound output. The devices are opened together, so the microphone is read through it too.
pub(super) struct Playback {
    /// Devices of the sound.
    pub audio: AudioIo,
    /// Loudness control.
    pub loudness: Loudness,
    /// Sounds of the present steps.
    pub sounds: Vec<SoundCommand>,
    synth_setup: SynthSetup,
    /// Instrument that staff try, and the sound to play when it is built.
    audition_instrument: Option<AuditionInstrument>,
    audition: Option<Audition>,
}

impl Playback {
    /// Opens the devices; the microphone only if breath is allowed and the venue is open.
    pub(super) fn start(site: &Site, exhibit: &Exhibit, closed: bool) -> Self {
        let synth_setup = synth_setup(site);
        Self {
            audio: AudioIo::start_with(&site.audio, site.breath && !closed, synth_setup.synth(exhibit, None)),
            loudness: Loudness::new(loudness_settings(site)),
            sounds: Vec::new(),
            synth_setup,
            audition_instrument: None,
            audition: None,
        }
    }

    /// Takes over a changed configuration; only changed parts restart.
    pub(super) fn reconfigure(&mut self, before: &Site, site: &Site, exhibit: &Exhibit, closed: bool) {
        self.synth_setup = synth_setup(site);
        let devices = |site: &Site| AudioSettings { volume_db: 0.0, most_partials: 0, ..site.audio.clone() };
        let reopens = devices(before) != devices(site);
        if reopens {
            let synth = self.synth_setup.synth(exhibit, self.audition_instrument.as_ref());
            self.audio = AudioIo::start_with(&site.audio, site.breath && !closed, synth);
        } else if self.synth_setup != synth_setup(before) || before.settings != site.settings {
            self.audio.set_instruments(self.synth_setup.synth(exhibit, self.audition_instrument.as_ref()));
        }
        let loudness = loudness_settings(site);
        if reopens || loudness_settings(before) != loudness {
            let output = if reopens { OutputCount::Restarted } else { OutputCount::Continued };
            self.loudness.reconfigure(loudness, output);
        }
    }

    /// Takes the instruments of another exhibit.
    pub(super) fn swap(&mut self, exhibit: &Exhibit) {
        (self.audition_instrument, self.audition) = (None, None);
        self.audio.set_instruments(self.synth_setup.synth(exhibit, None));
    }

    /// Plays a sound for staff: an instrument of the exhibit at once, another one when it is built.
    pub(super) fn play_audition(&mut self, audition: Option<Audition>, stage: &Stage) {
        let sample = stage.sample();
        let instruments = stage.exhibit().instruments.len();
        match audition {
            Some(audition) => match audition.target {
                AuditionTarget::Exhibit(index) if index < instruments => {
                    self.sounds.push(hit(index as u16, &audition, sample))
                }
                AuditionTarget::Exhibit(_) => {}
                AuditionTarget::Timbre(ref preset) => {
                    if self.audition_instrument.as_ref().is_none_or(|instrument| instrument.preset != *preset) {
                        self.audition_instrument = Some(AuditionInstrument { preset: preset.clone() });
                        self.audio.set_instruments(
                            self.synth_setup.synth(stage.exhibit(), self.audition_instrument.as_ref()),
                        );
                    }
                    self.audition = Some(audition);
                }
            },
            None if self.audition.is_none() => return,
            None => {}
        }
        if self.audio.has_instruments()
            && let Some((audition, audition_instrument)) = self.audition.take().zip(self.audition_instrument.as_ref())
        {
            self.sounds.extend(audition_instrument.play(instruments as u16, &audition, sample));
        }
    }

    /// Sends the sounds of the steps done.
    pub(super) fn send(&mut self, stage: &Stage) {
        self.audio.send(stage.sample(), &self.sounds);
    }

    /// Updates the loudness; a self-test plays at the configured volume, dB.
    pub(super) fn set_loudness(
        &mut self,
        requests: VolumeRequests,
        activity: KioskActivity,
        self_test_db: Option<f64>,
    ) {
        self.loudness.update(requests, activity, self.audio.knobs());
        if let Some(volume_db) = self_test_db {
            self.audio.knobs().set_volume(db_to_amplitude(volume_db) as f32);
        }
    }
}

/// Settings of the loudness by the site.
fn loudness_settings(site: &Site) -> LoudnessSettings {
    LoudnessSettings { volume: site.volume, night: site.night.clone(), silent_attract: site.silent_attract }
}

/// Settings of the synthesizer by the site.
fn synth_setup(site: &Site) -> SynthSetup {
    SynthSetup { reverb: site.reverb, most_partials: site.audio.most_partials as usize, seed: site.settings.seed }
}

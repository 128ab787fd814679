//! The kiosk under rehearsal: all that runs live, but for clock, window and devices.
//!
//! The same [`Stage`], the loudspeaker's own callback, the microphone's own ring and the same tap that aligns what was
//! played with what was heard. Blocks of 10 ms come and go as a sound card's do, steps 240 times a second.
//!
//! Beside the loudspeaker stands another one that nobody hears. It is told the same, but that no wind blows: strikes ring
//! in it, and in its room, as they do in the first, to the bit. What the two differ by is the wind.

use std::sync::Arc;

use super::blocks::{FRAMES, SAMPLE_RATE_HZ};
use soffio_devices::audio::output::{self, Engine, Player, Workshop};
use soffio_devices::audio::{Heard, Knobs, ReferenceTap, input};
use soffio_exhibit::Exhibit;
use soffio_kiosk::step::controls::Controls;
use soffio_kiosk::step::instruments::SynthSetup;
use soffio_kiosk::step::stage::Stage;
use soffio_kiosk::venue::site::Site;
use soffio_math::from_decibels;
use soffio_sound::{SoundCommand, Volume, WindSound};

/// A loudspeaker: its callback, and all that goes to it.
struct Loudspeaker {
    player: Player,
    speaker: output::Voice,
    workshop: Workshop,
    knobs: Arc<Knobs>,
    /// The block that leaves it, stereo.
    played: Vec<f32>,
}

impl Loudspeaker {
    fn new(volume: f32) -> Self {
        let knobs = Arc::new(Knobs::new(volume));
        let (player, speaker, workshop) = output::open(SAMPLE_RATE_HZ, 2, knobs.clone());
        Self { player, speaker, workshop, knobs, played: vec![0.0; 2 * FRAMES] }
    }

    fn play(&mut self) {
        self.workshop.clear();
        self.player.play(&mut self.played);
    }
}

/// A kiosk.
pub struct Machine {
    /// What moves and answers.
    pub stage: Stage,
    loud: Loudspeaker,
    /// The one in still air.
    still: Loudspeaker,
    /// What it is told in a step.
    told: Vec<SoundCommand>,
    recorder: input::Recorder,
    ears: input::Ears,
    tap: ReferenceTap,
    heard: Heard,
    volume: Volume,
    voice: SynthSetup,
    generation: u64,
}

impl Machine {
    /// A work on show, as loud as visitors can make it, with a microphone of so many capsules.
    pub fn new(exhibit: Arc<Exhibit>, site: &Site, capsules: usize) -> Self {
        let mut volume = Volume::new(site.volume);
        volume.step(i32::MAX);
        let [loud, still] = [(); 2].map(|()| Loudspeaker::new(from_decibels(volume.db()) as f32));
        let (recorder, ears) = input::open(SAMPLE_RATE_HZ, capsules, [0, 0]);
        let voice = SynthSetup {
            reverb: site.reverb,
            most_partials: site.audio.most_partials as usize,
            seed: site.settings.seed,
        };
        let mut machine = Self {
            stage: Stage::new(exhibit.clone(), site.settings, None, site.idle_s),
            loud,
            still,
            told: Vec::new(),
            recorder,
            ears,
            tap: ReferenceTap::default(),
            heard: Heard::default(),
            volume,
            voice,
            generation: 0,
        };
        machine.tune(&exhibit);
        machine
    }

    fn tune(&mut self, exhibit: &Exhibit) {
        for speaker in [&mut self.loud, &mut self.still] {
            let synth = Box::new(self.voice.synth(exhibit, None)(SAMPLE_RATE_HZ));
            speaker.workshop.exchange(Some(Engine { synth, generation: self.generation }));
        }
    }

    /// Another work.
    pub fn show(&mut self, exhibit: Arc<Exhibit>) {
        self.generation += 1;
        self.tune(&exhibit);
        self.stage.swap(exhibit, None);
    }

    /// Staff's key: mutes, or lets it sound again.
    pub fn toggle_mute(&mut self) {
        self.volume.toggle_mute();
        let volume = if self.volume.is_muted() { 0.0 } else { from_decibels(self.volume.db()) as f32 };
        [&self.loud, &self.still].iter().for_each(|speaker| speaker.knobs.set_volume(volume));
    }

    /// Is it muted?
    pub fn is_muted(&self) -> bool {
        self.volume.is_muted()
    }

    /// The volume, dB.
    pub fn volume_db(&self) -> f64 {
        self.volume.db()
    }

    /// What leaves the loudspeaker now: a block of [`FRAMES`] frames, stereo.
    pub fn played(&self) -> &[f32] {
        &self.loud.played
    }

    /// What would leave it if no wind blew at the work, while all else goes on as it does.
    pub fn played_in_still_air(&self) -> &[f32] {
        &self.still.played
    }

    /// Exchanges a block with the devices: what the microphone heard, frame by frame, while the last one was played, and the
    /// next one.
    pub fn exchange(&mut self, heard: &[f32]) {
        self.recorder.record(heard);
        self.loud.play();
        self.still.play();
    }

    /// One step with all that the microphone has delivered; without it where it is unplugged.
    pub fn step(&mut self, controls: &Controls, plugged: bool) {
        self.heard.clear();
        let count = self.ears.read(&mut self.heard);
        let (ring, rate) = (self.loud.speaker.reference(), SAMPLE_RATE_HZ);
        self.tap.read(ring, rate, rate, count, &mut self.heard.reference);
        let microphone = plugged.then(|| self.heard.share(0, 1, SAMPLE_RATE_HZ));
        self.stage.step(controls, microphone);
        let (now, sounds) = (self.stage.sample(), self.stage.sounds());
        self.loud.speaker.send(now, sounds, self.generation);
        let becalmed = |command: &SoundCommand| match *command {
            SoundCommand::Wind(wind) => SoundCommand::Wind(WindSound { speed: 0.0, gust: 0.0, ..wind }),
            other => other,
        };
        self.told.clear();
        self.told.extend(sounds.iter().map(becalmed));
        self.still.speaker.send(now, &self.told, self.generation);
    }
}

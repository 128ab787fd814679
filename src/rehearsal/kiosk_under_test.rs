//! The kiosk under test: everything that runs live, except clock, window and devices.
//!
//! It has the same [`Stage`], the same output callback, the same microphone ring, and the same tap that aligns the reference signal
//! with the microphone. Blocks of 10 ms are exchanged as by a sound card, with 240 steps a second.
//!
//! A second output gets the same commands, but no wind. Impacts and reverberation sound in it as in the first, to the bit, so the
//! difference of the two is the wind.

use std::sync::Arc;

use super::blocks::{FRAMES, SAMPLE_RATE_HZ};
use soffio_devices::audio::output::{self, Engine, Player, SynthInstaller};
use soffio_devices::audio::{Knobs, MicrophoneSamples, ReferenceTap, input};
use soffio_exhibit::Exhibit;
use soffio_kiosk::step::controls::Controls;
use soffio_kiosk::step::instruments::SynthSetup;
use soffio_kiosk::step::stage::Stage;
use soffio_kiosk::venue::site::Site;
use soffio_math::db_to_amplitude;
use soffio_sound::{SoundCommand, Volume, WindSound};

/// An audio output: its callback, and everything that feeds it.
struct AudioOutput {
    player: Player,
    voice_sender: output::OutputHandle,
    workshop: SynthInstaller,
    knobs: Arc<Knobs>,
    /// The current block, stereo.
    played: Vec<f32>,
}

impl AudioOutput {
    fn new(volume: f32) -> Self {
        let knobs = Arc::new(Knobs::new(volume));
        let (player, voice_sender, workshop) = output::open(SAMPLE_RATE_HZ, 2, knobs.clone());
        Self { player, voice_sender, workshop, knobs, played: vec![0.0; 2 * FRAMES] }
    }

    fn play(&mut self) {
        self.workshop.clear();
        self.player.play(&mut self.played);
    }
}

/// The kiosk under test.
pub struct KioskUnderTest {
    /// Simulation, visitors and attract mode.
    pub stage: Stage,
    output: AudioOutput,
    /// The same output in still air.
    still_air: AudioOutput,
    /// Commands of a step for the output in still air.
    still_air_commands: Vec<SoundCommand>,
    recorder: input::Recorder,
    microphone: input::MicrophoneReader,
    tap: ReferenceTap,
    received: MicrophoneSamples,
    volume: Volume,
    voice: SynthSetup,
    generation: u64,
}

impl KioskUnderTest {
    /// A kiosk with an exhibit, at the highest volume that visitors can set, with a microphone of 1 or 2 capsules.
    pub fn new(exhibit: Arc<Exhibit>, site: &Site, capsules: usize) -> Self {
        let mut volume = Volume::new(site.volume);
        volume.step(i32::MAX);
        let [output, still_air] = [(); 2].map(|()| AudioOutput::new(db_to_amplitude(volume.db()) as f32));
        let (recorder, microphone) = input::open(SAMPLE_RATE_HZ, capsules, [0, 0]);
        let voice = SynthSetup {
            reverb: site.reverb,
            most_partials: site.audio.most_partials as usize,
            seed: site.settings.seed,
        };
        let mut kiosk = Self {
            stage: Stage::new(exhibit.clone(), site.settings, None, site.idle_s),
            output,
            still_air,
            still_air_commands: Vec::new(),
            recorder,
            microphone,
            tap: ReferenceTap::default(),
            received: MicrophoneSamples::default(),
            volume,
            voice,
            generation: 0,
        };
        kiosk.tune(&exhibit);
        kiosk
    }

    fn tune(&mut self, exhibit: &Exhibit) {
        for output in [&mut self.output, &mut self.still_air] {
            let synth = Box::new(self.voice.synth(exhibit, None)(SAMPLE_RATE_HZ));
            output.workshop.exchange(Some(Engine { synth, generation: self.generation }));
        }
    }

    /// Shows another exhibit.
    pub fn show(&mut self, exhibit: Arc<Exhibit>) {
        self.generation += 1;
        self.tune(&exhibit);
        self.stage.swap(exhibit, None);
    }

    /// Mutes, or unmutes, as the staff's key does.
    pub fn toggle_mute(&mut self) {
        self.volume.toggle_mute();
        let volume = if self.volume.is_muted() { 0.0 } else { db_to_amplitude(self.volume.db()) as f32 };
        [&self.output, &self.still_air].iter().for_each(|output| output.knobs.set_volume(volume));
    }

    /// True while muted.
    pub fn is_muted(&self) -> bool {
        self.volume.is_muted()
    }

    /// The volume, dB.
    pub fn volume_db(&self) -> f64 {
        self.volume.db()
    }

    /// Current block of the output: [`FRAMES`] frames, stereo.
    pub fn played(&self) -> &[f32] {
        &self.output.played
    }

    /// The same block in still air, with everything else unchanged.
    pub fn played_in_still_air(&self) -> &[f32] {
        &self.still_air.played
    }

    /// Exchanges a block with the devices: takes the microphone's frames during the last block, and makes the next block.
    pub fn exchange(&mut self, recorded: &[f32]) {
        self.recorder.record(recorded);
        self.output.play();
        self.still_air.play();
    }

    /// Runs one step with the microphone's new samples, or without them where it is unplugged.
    pub fn step(&mut self, controls: &Controls, plugged: bool) {
        self.received.clear();
        let count = self.microphone.read(&mut self.received);
        let (ring, rate) = (self.output.voice_sender.reference(), SAMPLE_RATE_HZ);
        self.tap.read(ring, rate, rate, count, &mut self.received.reference);
        let microphone = plugged.then(|| self.received.share(0, 1, SAMPLE_RATE_HZ));
        self.stage.step(controls, microphone);
        let (now, sounds) = (self.stage.sample(), self.stage.sounds());
        self.output.voice_sender.send(now, sounds, self.generation);
        let becalmed = |command: &SoundCommand| match *command {
            SoundCommand::Wind(wind) => SoundCommand::Wind(WindSound { speed: 0.0, gust: 0.0, ..wind }),
            other => other,
        };
        self.still_air_commands.clear();
        self.still_air_commands.extend(sounds.iter().map(becalmed));
        self.still_air.voice_sender.send(now, &self.still_air_commands, self.generation);
    }
}

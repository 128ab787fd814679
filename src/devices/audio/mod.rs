//! Audio input and output by cpal; no other module uses that crate.
//!
//! ```text
//! kiosk thread                    supervisor thread              real-time threads
//! AudioIo::send ── commands ring ─────────────────────────────→ Player (owns the Synth) → output device
//! AudioIo::read_microphone ←── reference ring ───────────────── Player: output signal, mono
//!                          ←── microphone ring ──────────────── Recorder ← microphone
//! AudioIo::set_instruments ──→ builds the Synth ── synth ring → Player; the old one ── retired ring ─→ dropped here
//! AudioIo::say ────── speech ring ────────────────────────────→ Player: mixed in, and into the reference
//!                                                               Player: mono ── tail ring ─→ HearingLoop
//! AudioIo::knobs ←──────────── volume, night, energy ───────────→ Player
//! AudioIo::status ←──────────── opens, watches, reopens
//! ```
//!
//! Invariant: a missing, lost or silent device never stops the kiosk. The supervisor retries for ever, with growing pauses, and
//! reports the reason in [`AudioStatus`].
//!
//! Real-time: the callbacks ([`output::Player::play`], [`input::Recorder::record`]) never allocate, free, lock, log or
//! call the system (`tests/suite/realtime.rs`).

mod clock;
pub mod devices;
pub mod hearing_loop;
pub mod input;
mod knobs;
pub mod output;
mod reference;
mod speech_mixer;
mod supervisor;

use std::sync::atomic::Ordering;
use std::sync::mpsc::{Receiver, Sender};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;

pub use clock::ClockMap;
pub use input::MicrophoneSamples;
pub use knobs::{Knobs, PlayedEnergy};
pub use reference::ReferenceTap;
pub use soffio_config::AudioSettings;
pub use speech_mixer::{LOUDEST, Utterance};
use supervisor::{Link, Request, Supervisor};

use soffio_math::db_to_amplitude;
use soffio_sound::{SoundCommand, Synth};

/// Builds the synth for the rate of an output device, Hz.
pub type SynthFactory = Box<dyn Fn(u32) -> Synth + Send>;

/// State of the audio devices.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AudioStatus {
    /// Microphone.
    pub input: DeviceState,
    /// Output device.
    pub output: DeviceState,
    /// The second output, if the site has one.
    pub hearing_loop: Option<DeviceState>,
    /// Overruns and underruns since the start: the machine was too slow.
    pub xruns: u64,
    /// Number of times that an output device was opened.
    pub openings: u64,
    /// Number of microphone capsules in use, 0 without a microphone.
    pub capsules: usize,
    /// Latency from a step to the air; `None` before the first output.
    pub delay: Option<SoundDelay>,
    /// Shortest block that the output's driver offers, s, if known.
    pub shortest_block_s: Option<f64>,
    /// Commands dropped because a ring was full.
    pub lost: u64,
}

/// Latency of a sound from the step that causes it to the air, by its parts, s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SoundDelay {
    /// The step: an impact may be as old as its step when it is sent.
    pub step_s: f64,
    /// The longest block so far: a sound starts on its own sample of the next one.
    pub block_s: f64,
    /// The limiter's look-ahead.
    pub limiter_s: f64,
    /// Latency of the device from the callback to the converter, if it reports one.
    pub device_s: Option<f64>,
}

impl SoundDelay {
    /// Sum of all parts, s.
    pub fn total_s(&self) -> f64 {
        self.step_s + self.block_s + self.limiter_s + self.device_s.unwrap_or(0.0)
    }
}

/// State of an audio device, microphone or output, as the status page and the metrics show it.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum DeviceState {
    /// Not opened yet.
    #[default]
    Starting,
    /// Open.
    Ok {
        /// Name in the system.
        name: String,
        /// Sample rate, Hz.
        sample_rate: u32,
    },
    /// Missing or failed, for this reason; opening is retried.
    Missing(String),
    /// Closed by the kiosk: outside opening hours, or at a site without breath.
    Closed,
}

impl std::fmt::Display for DeviceState {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Starting => f.write_str("starting"),
            Self::Ok { name, sample_rate } => write!(f, "{name}, {sample_rate} Hz"),
            Self::Missing(reason) => write!(f, "missing: {reason}"),
            Self::Closed => f.write_str("closed"),
        }
    }
}

/// Audio input and output of the kiosk.
pub struct AudioIo {
    requests: Sender<Request>,
    links: Receiver<Link>,
    status: Arc<Mutex<AudioStatus>>,
    knobs: Arc<Knobs>,
    supervisor: Option<JoinHandle<()>>,
    generation: u64,
    listens: bool,
    microphone: Option<input::MicrophoneReader>,
    output: Option<output::OutputHandle>,
    tap: ReferenceTap,
}

impl AudioIo {
    /// Starts to open the devices and returns at once; `synth` is called for each output device that is opened.
    pub fn start(settings: &AudioSettings, synth: impl Fn(u32) -> Synth + Send + 'static) -> Self {
        Self::start_with(settings, true, synth)
    }

    /// The same, with the microphone (`listens`) or without it.
    pub fn start_with(settings: &AudioSettings, listens: bool, synth: impl Fn(u32) -> Synth + Send + 'static) -> Self {
        let (requests, inbox) = std::sync::mpsc::channel();
        let (outbox, links) = std::sync::mpsc::channel();
        let status = Arc::new(Mutex::new(AudioStatus::default()));
        let knobs = Arc::new(Knobs::new(db_to_amplitude(settings.volume_db) as f32));
        let supervisor =
            Supervisor::new(settings.clone(), listens, Box::new(synth), inbox, outbox, status.clone(), knobs.clone());
        let supervisor = std::thread::Builder::new().name("soffio-audio".into()).spawn(move || supervisor.run());
        if let Err(error) = &supervisor {
            let missing = DeviceState::Missing(format!("no thread for the devices: {error}"));
            let none = AudioStatus { input: missing.clone(), output: missing, ..AudioStatus::default() };
            *status.lock().unwrap_or_else(PoisonError::into_inner) = none;
        }
        Self {
            requests,
            links,
            status,
            knobs,
            supervisor: supervisor.ok(),
            generation: 0,
            listens,
            microphone: None,
            output: None,
            tap: ReferenceTap::default(),
        }
    }

    /// Sends commands to the synth. Their times and `now`, the present, are sample times of the simulation
    /// ([`SAMPLE_RATE`](soffio_simulation::SAMPLE_RATE)); commands are dropped if the ring is full or there is no output device.
    pub fn send(&mut self, now: u64, commands: &[SoundCommand]) {
        self.take_links();
        if let Some(handle) = &mut self.output {
            handle.send(now, commands, self.generation);
        }
    }

    /// Appends the microphone's samples since the last call, and as many samples of the output of that time (none without an output
    /// device). Returns the microphone's rate, Hz; `None` without a microphone.
    pub fn read_microphone(&mut self, into: &mut MicrophoneSamples) -> Option<u32> {
        self.take_links();
        let reader = self.microphone.as_mut()?;
        let samples = reader.read(into);
        let rate = reader.sample_rate();
        if let Some(handle) = &mut self.output {
            let played_rate = handle.sample_rate();
            self.tap.read(handle.reference(), played_rate, rate, samples, &mut into.reference);
        }
        Some(rate)
    }

    /// Replaces the instruments. Commands sent after this call are for the new ones; the old ones fade out.
    pub fn set_instruments(&mut self, synth: impl Fn(u32) -> Synth + Send + 'static) {
        self.generation += 1;
        // Fails only when the supervisor could not be started, which the status says already.
        let _ = self.requests.send(Request::Instruments { synth: Box::new(synth), generation: self.generation });
    }

    /// Whether the last requested instruments are playing; never without an output device.
    pub fn has_instruments(&self) -> bool {
        let samples =
            |handle: &output::OutputHandle| handle.shared().generation.load(Ordering::Acquire) == self.generation;
        self.output.as_ref().is_some_and(samples)
    }

    /// Opens or closes the microphone.
    pub fn listen(&mut self, listens: bool) {
        if self.listens != listens {
            self.listens = listens;
            // Fails only when the supervisor could not be started, which the status says already.
            let _ = self.requests.send(Request::Listen(listens));
        }
    }

    /// Speaks an utterance in place of the present one; an empty one ends it. It is part of the output and so of the microphone's
    /// reference. Without an output device, or at another rate, nothing is spoken.
    pub fn say(&mut self, words: &Utterance) {
        self.take_links();
        if let Some(handle) = &mut self.output {
            handle.say(words);
        }
    }

    /// Whether an utterance is being spoken.
    pub fn speaks(&self) -> bool {
        self.output.as_ref().is_some_and(|handle| handle.shared().speaks.load(Ordering::Relaxed))
    }

    /// State of the audio devices.
    pub fn status(&self) -> AudioStatus {
        let status = self.status.lock().unwrap_or_else(PoisonError::into_inner).clone();
        AudioStatus { lost: self.output.as_ref().map_or(0, output::OutputHandle::lost), ..status }
    }

    /// Volume and night mode, and the measured loudness.
    pub fn knobs(&self) -> &Knobs {
        &self.knobs
    }

    /// Frames played so far; `None` without an output device.
    pub fn played(&self) -> Option<u64> {
        self.output.as_ref().map(|handle| handle.shared().played.load(Ordering::Acquire))
    }

    fn take_links(&mut self) {
        for link in self.links.try_iter() {
            match link {
                Link::Microphone(reader) => self.microphone = reader,
                Link::Output(handle) => {
                    self.output = handle;
                    self.tap = ReferenceTap::default();
                }
            }
        }
    }
}

impl Drop for AudioIo {
    fn drop(&mut self) {
        let _ = self.requests.send(Request::Stop);
        if let Some(thread) = self.supervisor.take() {
            // It has nothing to say; a panic of it was printed when it happened.
            let _ = thread.join();
        }
    }
}

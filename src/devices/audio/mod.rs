//! Microphone and loudspeaker: the only module that names the audio crate.
//!
//! ```text
//! kiosk thread                    supervisor thread              real-time threads
//! AudioIo::send ── commands ring ─────────────────────────────→ Player (owns the Synth) → loudspeaker
//! AudioIo::read_microphone ←── reference ring ───────────────── Player: what was played, mono
//!                          ←── microphone ring ──────────────── Recorder ← microphone
//! AudioIo::set_instruments ──→ builds the Synth ── synth ring → Player; the old one ── retired ring ─→ dropped here
//! AudioIo::say ────── words ring ─────────────────────────────→ Player: over the work, and into the reference
//!                                                               Player: mono ── tail ring ─→ Hearing → hearing loop
//! AudioIo::knobs ←──────────── volume, night, energy ───────────→ Player
//! AudioIo::status ←──────────── opens, watches, reopens
//! ```
//!
//! Invariant: a missing, lost or silent device never stops the kiosk. The supervisor tries again for ever, with growing
//! pauses, and says what it waits for.
//!
//! Real-time: the callbacks ([`output::Player::play`], [`input::Recorder::record`]) never allocate, free, lock, log or
//! call the system (`tests/suite/realtime.rs`).

mod clock;
pub mod devices;
pub mod hearing;
pub mod input;
mod knobs;
mod mouth;
pub mod output;
mod reference;
mod supervisor;

use std::sync::atomic::Ordering;
use std::sync::mpsc::{Receiver, Sender};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;

pub use clock::ClockMap;
pub use input::Heard;
pub use knobs::Knobs;
pub use mouth::{LOUDEST, Words};
pub use reference::ReferenceTap;
pub use soffio_config::AudioSettings;
use supervisor::{Link, Request, Supervisor};

use soffio_math::db_to_amplitude;
use soffio_sound::{SoundCommand, Synth};

/// Builds the synth for the rate of a loudspeaker, Hz.
pub type SynthFactory = Box<dyn Fn(u32) -> Synth + Send>;

/// How the devices are.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AudioStatus {
    /// Microphone.
    pub input: DeviceState,
    /// Loudspeaker.
    pub output: DeviceState,
    /// The second output, where the site has one.
    pub hearing_loop: Option<DeviceState>,
    /// Gaps in either since the start: the machine was too slow.
    pub xruns: u64,
    /// Times that a loudspeaker was opened: more than once when it was lost and came back.
    pub openings: u64,
    /// Capsules of the microphone that listen: 0 without one.
    pub capsules: usize,
    /// From a step to the air; `None` until the loudspeaker has played.
    pub delay: Option<SoundDelay>,
    /// Shortest block that the loudspeaker's driver offers, s; `None` where it does not say.
    pub shortest_block_s: Option<f64>,
    /// Commands that were not heard: more than the rings hold.
    pub lost: u64,
}

/// What a sound waits for between the step that causes it and the air, s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SoundDelay {
    /// The step: a hit may be as old as its step when it is sent.
    pub step_s: f64,
    /// The longest block so far: a sound starts on its own sample of the next one.
    pub block_s: f64,
    /// The limiter's look-ahead.
    pub limiter_s: f64,
    /// What the device itself reports, from the callback to the converter; `None` where it reports nothing.
    pub device_s: Option<f64>,
}

impl SoundDelay {
    /// All of it, s.
    pub fn total_s(&self) -> f64 {
        self.step_s + self.block_s + self.limiter_s + self.device_s.unwrap_or(0.0)
    }
}

/// How one device is.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum DeviceState {
    /// Not looked for yet.
    #[default]
    Starting,
    /// Works.
    Ok {
        /// As the system calls it.
        name: String,
        /// Hz.
        sample_rate: u32,
    },
    /// Does not work, for this reason; it is tried again and again.
    Missing(String),
    /// The kiosk does not want it now: closed by hours, or by a site where nobody blows.
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

/// The kiosk's ears and voice.
pub struct AudioIo {
    requests: Sender<Request>,
    links: Receiver<Link>,
    status: Arc<Mutex<AudioStatus>>,
    knobs: Arc<Knobs>,
    supervisor: Option<JoinHandle<()>>,
    generation: u64,
    listens: bool,
    microphone: Option<input::Ears>,
    loudspeaker: Option<output::Voice>,
    tap: ReferenceTap,
}

impl AudioIo {
    /// Begins to open the devices and returns at once; `synth` is called for each loudspeaker that is opened.
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
            Supervisor::new((settings.clone(), listens), Box::new(synth), inbox, outbox, status.clone(), knobs.clone());
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
            loudspeaker: None,
            tap: ReferenceTap::default(),
        }
    }

    /// Sends commands to the loudspeaker's synth. Their times and `now`, the present, are sample times of the simulation
    /// ([`SAMPLE_RATE`](soffio_simulation::SAMPLE_RATE)); what the ring has no room for is lost, and so is everything while there is no loudspeaker.
    pub fn send(&mut self, now: u64, commands: &[SoundCommand]) {
        self.take_links();
        if let Some(voice) = &mut self.loudspeaker {
            voice.send(now, commands, self.generation);
        }
    }

    /// Appends what the microphone has heard since the last call, and as many samples of what the loudspeaker played
    /// meanwhile (none without a loudspeaker). The answer is the microphone's rate, Hz; `None` when there is none.
    pub fn read_microphone(&mut self, into: &mut Heard) -> Option<u32> {
        self.take_links();
        let ears = self.microphone.as_mut()?;
        let heard = ears.read(into);
        let rate = ears.sample_rate();
        if let Some(voice) = &mut self.loudspeaker {
            let played_rate = voice.sample_rate();
            self.tap.read(voice.reference(), played_rate, rate, heard, &mut into.reference);
        }
        Some(rate)
    }

    /// Other instruments from now on: commands sent after this call are meant for them. The old ones fade.
    pub fn set_instruments(&mut self, synth: impl Fn(u32) -> Synth + Send + 'static) {
        self.generation += 1;
        // Fails only when the supervisor could not be started, which the status says already.
        let _ = self.requests.send(Request::Instruments { synth: Box::new(synth), generation: self.generation });
    }

    /// Have the instruments that were asked for last arrived at the loudspeaker? Never without one.
    pub fn has_instruments(&self) -> bool {
        let heard = |voice: &output::Voice| voice.shared().generation.load(Ordering::Acquire) == self.generation;
        self.loudspeaker.as_ref().is_some_and(heard)
    }

    /// Closes the microphone, or opens it again.
    pub fn listen(&mut self, listens: bool) {
        if self.listens != listens {
            self.listens = listens;
            // Fails only when the supervisor could not be started, which the status says already.
            let _ = self.requests.send(Request::Listen(listens));
        }
    }

    /// Has words said instead of those that are being said; none hush. They are mixed into what the loudspeaker plays, so
    /// the microphone's reference holds them. Without a loudspeaker, or at another rate than its own, nothing is said.
    pub fn say(&mut self, words: &Words) {
        self.take_links();
        if let Some(voice) = &mut self.loudspeaker {
            voice.say(words);
        }
    }

    /// Is the loudspeaker saying words?
    pub fn speaks(&self) -> bool {
        self.loudspeaker.as_ref().is_some_and(|voice| voice.shared().speaks.load(Ordering::Relaxed))
    }

    /// How the devices are.
    pub fn status(&self) -> AudioStatus {
        let status = self.status.lock().unwrap_or_else(PoisonError::into_inner).clone();
        AudioStatus { lost: self.loudspeaker.as_ref().map_or(0, output::Voice::lost), ..status }
    }

    /// Volume and night, and how loud it was.
    pub fn knobs(&self) -> &Knobs {
        &self.knobs
    }

    /// Frames the loudspeaker has been given so far; `None` without one.
    pub fn played(&self) -> Option<u64> {
        self.loudspeaker.as_ref().map(|voice| voice.shared().played.load(Ordering::Acquire))
    }

    fn take_links(&mut self) {
        for link in self.links.try_iter() {
            match link {
                Link::Microphone(ears) => self.microphone = ears,
                Link::Loudspeaker(voice) => {
                    self.loudspeaker = voice;
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

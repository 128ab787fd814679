//! Opens the devices, watches them, opens them again.
//!
//! Streams live and die on this thread alone. A device is given up when its error callback says so, or when it has not
//! asked for a block for [`STALL_TIMEOUT`]: some drivers die without a word. Then it is tried again after 1, 2, 2, … s ([`BACK_OFF`]).

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::time::{Duration, Instant};

use cpal::traits::{DeviceTrait, StreamTrait};
use cpal::{BufferSize, Device, ErrorKind, FromSample, SampleFormat, SizedSample, Stream, StreamConfig};
use cpu_time::ThreadTime;

use super::devices::{Chosen, Direction, choose, is_present};
use super::hearing_loop::{self, HearingLoop};
use super::input::{self, MicrophoneReader, Recorder};
use super::output::{self, Engine, OutputHandle, Player, SynthInstaller};
use super::{AudioSettings, AudioStatus, DeviceState, Knobs, SoundDelay, SynthFactory};
use soffio_config::remedies;
use soffio_math::db_to_amplitude;
use soffio_simulation::{SAMPLE_RATE, SAMPLES_PER_STEP};

/// Between two looks at the devices.
const POLL_INTERVAL: Duration = Duration::from_millis(100);
/// A device that asks for no block for this long is lost.
const STALL_TIMEOUT: Duration = Duration::from_secs(3);
/// Between two looks whether the device is still listed.
const PRESENCE_INTERVAL: Duration = Duration::from_secs(1);
/// From so many blocks on their length is judged.
const LEAST_BLOCKS: u64 = 50;
/// First and longest pause before a device is opened again: within three seconds after it is plugged in.
const BACK_OFF: (Duration, Duration) = (Duration::from_secs(1), Duration::from_secs(2));

/// Where this is set, the loudspeaker's callback measures its processor time, for the log's last line.
const MEASURE: &str = "SOFFIO_MEASURE_CALLBACK";

/// Request of the kiosk to the supervisor.
pub(super) enum Request {
    /// Other instruments.
    Instruments { synth: SynthFactory, generation: u64 },
    /// The microphone open, or closed.
    Listen(bool),
    /// The end.
    Stop,
}

/// The kiosk's end of a device that was opened; `None` when it was lost.
pub(super) enum Link {
    Microphone(Option<MicrophoneReader>),
    Output(Option<OutputHandle>),
}

/// What the callbacks of one stream report.
#[derive(Default)]
struct Health {
    /// Blocks so far.
    blocks: AtomicU64,
    /// Frames of the longest block.
    longest: AtomicU64,
    /// What the device reports from the last callback to the converter, ns; 0 where it reports nothing.
    device: AtomicU64,
    /// Gaps so far.
    xruns: AtomicU64,
    /// Greatest share of its own time that a block took of a processor, millionths; only where it is measured.
    worst: AtomicU64,
    /// Why the stream is over.
    lost: OnceLock<String>,
}

impl Health {
    /// A callback had so many frames.
    fn block(&self, frames: usize) {
        self.blocks.fetch_add(1, Ordering::Relaxed);
        self.longest.fetch_max(frames as u64, Ordering::Relaxed);
    }

    /// A callback of so many frames took so much processor time, s.
    fn worked(&self, seconds: f64, frames: usize, sample_rate: u32) {
        let share = 1e6 * seconds * f64::from(sample_rate) / frames.max(1) as f64;
        self.worst.fetch_max(share as u64, Ordering::Relaxed);
    }

    fn report(&self, error: &cpal::Error) {
        match error.kind() {
            ErrorKind::Xrun => {
                self.xruns.fetch_add(1, Ordering::Relaxed);
            }
            // The stream goes on: on another device, or at ordinary priority.
            ErrorKind::DeviceChanged | ErrorKind::RealtimeDenied => {}
            _ => {
                // Only the first reason counts. The stream is over, so this thread may allocate.
                let _ = self.lost.set(error.to_string());
            }
        }
    }
}

/// One device over all its openings.
struct ManagedDevice {
    direction: Direction,
    /// Of the device that is open.
    id: String,
    called: Instant,
    stream: Option<Stream>,
    health: Arc<Health>,
    seen: (u64, Instant),
    retry_at: Instant,
    pause: Duration,
    /// Hz.
    sample_rate: u32,
    /// Whether the length of its blocks has been logged.
    is_block_reported: bool,
    /// Gaps of earlier lives.
    xruns: u64,
}

impl ManagedDevice {
    fn new(direction: Direction) -> Self {
        let now = Instant::now();
        let (health, seen) = (Arc::default(), (0, now));
        Self {
            direction,
            id: String::new(),
            called: now,
            stream: None,
            health,
            seen,
            retry_at: now,
            pause: BACK_OFF.0,
            sample_rate: 1,
            is_block_reported: false,
            xruns: 0,
        }
    }

    fn xruns(&self) -> u64 {
        self.xruns + self.health.xruns.load(Ordering::Relaxed)
    }

    /// Length of its longest block, ms; once per opening, after enough blocks.
    fn take_block_report(&mut self) -> Option<f64> {
        if self.is_block_reported || self.health.blocks.load(Ordering::Relaxed) < LEAST_BLOCKS {
            return None;
        }
        self.is_block_reported = true;
        Some(1e3 * self.health.longest.load(Ordering::Relaxed) as f64 / f64::from(self.sample_rate))
    }

    /// What a sound waits for on the way to this loudspeaker, whose limiter looks ahead by `limiter_s`.
    fn delay(&self, limiter_s: f64) -> Option<SoundDelay> {
        let longest = self.health.longest.load(Ordering::Relaxed);
        let device = self.health.device.load(Ordering::Relaxed);
        (self.stream.is_some() && longest > 0).then(|| SoundDelay {
            step_s: SAMPLES_PER_STEP as f64 / f64::from(SAMPLE_RATE),
            block_s: longest as f64 / f64::from(self.sample_rate),
            limiter_s,
            device_s: (device > 0).then_some(1e-9 * device as f64),
        })
    }

    /// Why the stream is over, if it is.
    fn lost(&mut self) -> Option<String> {
        self.stream.as_ref()?;
        if let Some(reason) = self.health.lost.get() {
            return Some(reason.clone());
        }
        let blocks = self.health.blocks.load(Ordering::Relaxed);
        if blocks != self.seen.0 {
            self.seen = (blocks, Instant::now());
            // It works: the next trouble is a new one.
            self.pause = BACK_OFF.0;
        } else if self.seen.1.elapsed() > STALL_TIMEOUT {
            return Some(format!("the device stood still for {} s", STALL_TIMEOUT.as_secs()));
        }
        if self.called.elapsed() > PRESENCE_INTERVAL {
            self.called = Instant::now();
            if !is_present(self.direction, &self.id) {
                return Some("it was pulled out".into());
            }
        }
        None
    }

    fn close(&mut self) {
        self.xruns = self.xruns();
        self.stream = None;
        self.health = Arc::default();
        self.retry_at = Instant::now() + self.pause;
        self.pause = (self.pause * 2).min(BACK_OFF.1);
    }

    fn due(&self) -> bool {
        self.stream.is_none() && Instant::now() >= self.retry_at
    }

    fn opened(&mut self, stream: Stream, id: String, sample_rate: u32) {
        self.stream = Some(stream);
        (self.id, self.called) = (id, Instant::now());
        (self.sample_rate, self.is_block_reported) = (sample_rate, false);
        self.seen = (0, Instant::now());
    }
}

pub(super) struct Supervisor {
    settings: AudioSettings,
    listens: bool,
    synth: SynthFactory,
    generation: u64,
    inbox: Receiver<Request>,
    links: Sender<Link>,
    status: Arc<Mutex<AudioStatus>>,
    knobs: Arc<Knobs>,
    microphone: ManagedDevice,
    output: ManagedDevice,
    hearing_loop: ManagedDevice,
    /// The opening of the loudspeaker that the second output hears.
    follows: u64,
    openings: u64,
    installer: Option<(SynthInstaller, u32)>,
    /// Look-ahead of the limiter of what plays, s.
    limiter_s: f64,
}

impl Supervisor {
    /// A supervisor that has opened no device yet. `inbox` brings requests, `links` takes the ends of opened devices.
    pub fn new(
        settings: AudioSettings,
        listens: bool,
        synth: SynthFactory,
        inbox: Receiver<Request>,
        links: Sender<Link>,
        status: Arc<Mutex<AudioStatus>>,
        knobs: Arc<Knobs>,
    ) -> Self {
        Self {
            settings,
            listens,
            synth,
            generation: 0,
            inbox,
            links,
            status,
            knobs,
            microphone: ManagedDevice::new(Direction::Input),
            output: ManagedDevice::new(Direction::Output),
            hearing_loop: ManagedDevice::new(Direction::Output),
            follows: 0,
            openings: 0,
            installer: None,
            limiter_s: 0.0,
        }
    }

    /// Until the kiosk stops.
    pub fn run(mut self) {
        loop {
            self.update_output();
            self.update_microphone();
            self.update_hearing_loop();
            for (name, line) in [("microphone", &mut self.microphone), ("loudspeaker", &mut self.output)] {
                if let Some(length) = line.take_block_report() {
                    tracing::info!("{name} in blocks of {length:.1} ms");
                }
            }
            let xruns = self.microphone.xruns() + self.output.xruns();
            let delay = self.output.delay(self.limiter_s);
            self.update_status(|status| (status.xruns, status.delay) = (xruns, delay));
            match self.inbox.recv_timeout(POLL_INTERVAL) {
                Ok(Request::Instruments { synth, generation }) => {
                    (self.synth, self.generation) = (synth, generation);
                    self.install_synth();
                }
                Ok(Request::Listen(listens)) => self.listens = listens,
                Ok(Request::Stop) | Err(RecvTimeoutError::Disconnected) => break,
                Err(RecvTimeoutError::Timeout) => {
                    if let Some((installer, _)) = &mut self.installer {
                        installer.clear();
                    }
                }
            }
        }
        let health = &self.output.health;
        let blocks = health.blocks.load(Ordering::Relaxed);
        let worst = health.worst.load(Ordering::Relaxed) as f64 / 1e4;
        if std::env::var_os(MEASURE).is_some() {
            let xruns = self.output.xruns();
            tracing::info!("loudspeaker: {blocks} blocks, xruns: {xruns}, the worst took {worst:.2} % of its time");
        }
    }

    fn update_status(&self, change: impl FnOnce(&mut AudioStatus)) {
        change(&mut self.status.lock().unwrap_or_else(PoisonError::into_inner));
    }

    /// Passes an end to the kiosk; when the kiosk is gone, `Stop` is on its way.
    fn link(&self, link: Link) {
        let _ = self.links.send(link);
    }

    fn install_synth(&mut self) {
        if let Some((installer, rate)) = &mut self.installer {
            let synth = Box::new((self.synth)(*rate));
            self.limiter_s = synth.latency() as f64 / f64::from(*rate);
            installer.exchange(Some(Engine { synth, generation: self.generation }));
        }
    }

    fn update_output(&mut self) {
        if let Some(reason) = self.output.lost() {
            tracing::warn!("loudspeaker lost: {reason}");
            self.output.close();
            self.installer = None;
            self.link(Link::Output(None));
            self.update_status(|status| status.output = DeviceState::Missing(reason));
        }
        if !self.output.due() {
            return;
        }
        let result = choose(Direction::Output, &self.settings.output, self.settings.block_ms).and_then(|chosen| {
            let Chosen { device, id, name, config, format, shortest_block } = chosen;
            let open = |config: StreamConfig| {
                let (player, handle, installer) =
                    output::open(config.sample_rate, config.channels.into(), self.knobs.clone());
                let stream = play(&device, config, format, player, self.output.health.clone())?;
                Ok((stream, handle, installer))
            };
            let (stream, handle, installer) =
                with_any_block(config, open).map_err(|error| format!("{name}: {error}"))?;
            Ok((stream, (handle, installer), id, name, config.sample_rate, shortest_block))
        });
        match result {
            Ok((stream, (handle, installer), id, name, sample_rate, shortest)) => {
                tracing::info!("loudspeaker: {name}, {sample_rate} Hz");
                self.output.opened(stream, id, sample_rate);
                self.installer = Some((installer, sample_rate));
                self.openings += 1;
                self.install_synth();
                self.link(Link::Output(Some(handle)));
                self.update_status(|status| {
                    status.output = DeviceState::Ok { name, sample_rate };
                    status.openings += 1;
                    status.shortest_block_s = shortest.map(|frames| f64::from(frames) / f64::from(sample_rate));
                });
            }
            Err(reason) => {
                self.output.close();
                self.update_status(|status| status.output = DeviceState::Missing(reason));
            }
        }
    }

    /// The second output follows the loudspeaker that is open; neither opening nor losing it touches the first.
    fn update_hearing_loop(&mut self) {
        let wanted = self.settings.hearing_loop.trim();
        if wanted.is_empty() {
            return;
        }
        let lost = match &self.installer {
            None => Some("waits for the loudspeaker".to_owned()),
            Some(_) if self.follows != self.openings => Some("the loudspeaker is another one".into()),
            Some(_) => self.hearing_loop.lost(),
        };
        if let Some(reason) = lost {
            if self.hearing_loop.stream.is_some() {
                tracing::warn!("hearing loop closed: {reason}");
                self.hearing_loop.close();
            }
            self.follows = self.openings;
            self.update_status(|status| status.hearing_loop = Some(DeviceState::Missing(reason)));
        }
        let Some((installer, from_rate)) = self.installer.as_mut().filter(|_| self.hearing_loop.due()) else { return };
        let gain = db_to_amplitude(self.settings.hearing_loop_db) as f32;
        let result = choose(Direction::Output, wanted, self.settings.block_ms).and_then(|chosen| {
            let Chosen { device, id, name, config, format, .. } = chosen;
            let open = |config: StreamConfig| {
                let (tail, hearing) = hearing_loop::open(*from_rate, config.sample_rate, config.channels.into(), gain);
                Ok((play(&device, config, format, hearing, self.hearing_loop.health.clone())?, tail))
            };
            let (stream, tail) = with_any_block(config, open).map_err(|error| format!("{name}: {error}"))?;
            Ok((stream, tail, id, name, config.sample_rate))
        });
        let state = match result {
            Ok((stream, tail, id, name, sample_rate)) => {
                tracing::info!("hearing loop: {name}, {sample_rate} Hz");
                self.hearing_loop.opened(stream, id, sample_rate);
                installer.lead(tail);
                DeviceState::Ok { name, sample_rate }
            }
            Err(reason) => {
                self.hearing_loop.close();
                DeviceState::Missing(reason)
            }
        };
        self.update_status(|status| status.hearing_loop = Some(state));
    }

    fn update_microphone(&mut self) {
        if !self.listens {
            return self.close_microphone();
        }
        if let Some(reason) = self.microphone.lost() {
            tracing::warn!("microphone lost: {reason}");
            self.microphone.close();
            self.link(Link::Microphone(None));
            self.update_status(|status| (status.input, status.capsules) = (DeviceState::Missing(reason), 0));
        }
        if !self.microphone.due() {
            return;
        }
        let result = choose(Direction::Input, &self.settings.microphone, self.settings.block_ms).and_then(|chosen| {
            let Chosen { device, id, name, config, format, .. } = chosen;
            let open = |config: StreamConfig| {
                let wanted = [self.settings.microphone_channel, self.settings.second_microphone_channel];
                let (recorder, reader) = input::open(config.sample_rate, config.channels.into(), wanted);
                Ok((record(&device, config, format, recorder, self.microphone.health.clone())?, reader))
            };
            let (stream, reader) = with_any_block(config, open).map_err(|error| format!("{name}: {error}"))?;
            Ok((stream, reader, id, name, config.sample_rate))
        });
        match result {
            Ok((stream, reader, id, name, sample_rate)) => {
                let capsules = reader.capsules();
                tracing::info!("microphone: {name}, {sample_rate} Hz, capsules: {capsules}");
                if capsules < 2 && self.settings.second_microphone_channel > 0 {
                    tracing::warn!("no second capsule: {}", remedies::NO_SECOND_MICROPHONE);
                }
                self.microphone.opened(stream, id, sample_rate);
                self.link(Link::Microphone(Some(reader)));
                self.update_status(|status| {
                    (status.input, status.capsules) = (DeviceState::Ok { name, sample_rate }, capsules)
                });
            }
            Err(reason) => {
                self.microphone.close();
                self.update_status(|status| status.input = DeviceState::Missing(reason));
            }
        }
    }
}

impl Supervisor {
    /// The stream ends, so that the system shows nobody listening; it is opened at once when it is wanted again.
    fn close_microphone(&mut self) {
        if self.microphone.stream.is_some() {
            tracing::info!("microphone closed");
            self.microphone.close();
            self.link(Link::Microphone(None));
        }
        (self.microphone.retry_at, self.microphone.pause) = (Instant::now(), BACK_OFF.0);
        self.update_status(|status| (status.input, status.capsules) = (DeviceState::Closed, 0));
    }
}

/// With the block that is wanted, or else with the device's own: some drivers promise more than they keep.
fn with_any_block<T>(
    config: StreamConfig,
    mut open: impl FnMut(StreamConfig) -> Result<T, cpal::Error>,
) -> Result<T, cpal::Error> {
    open(config).or_else(|_| open(StreamConfig { buffer_size: BufferSize::Default, ..config }))
}

/// What an output's callback calls.
trait Plays: Send + 'static {
    fn play<T: SizedSample + FromSample<f32>>(&mut self, data: &mut [T]);
}

impl Plays for Player {
    fn play<T: SizedSample + FromSample<f32>>(&mut self, data: &mut [T]) {
        Player::play(self, data);
    }
}

impl Plays for HearingLoop {
    fn play<T: SizedSample + FromSample<f32>>(&mut self, data: &mut [T]) {
        HearingLoop::play(self, data);
    }
}

fn play(
    device: &Device,
    config: StreamConfig,
    format: SampleFormat,
    player: impl Plays,
    health: Arc<Health>,
) -> Result<Stream, cpal::Error> {
    fn build<T: SizedSample + FromSample<f32>>(
        device: &Device,
        config: StreamConfig,
        mut player: impl Plays,
        health: Arc<Health>,
    ) -> Result<Stream, cpal::Error> {
        let errors = health.clone();
        let channels = usize::from(config.channels).max(1);
        // Asking the time of a thread is a system call, so it is asked only in a test of it.
        let measured = std::env::var_os(MEASURE).is_some();
        let callback = move |data: &mut [T], info: &cpal::OutputCallbackInfo| {
            let before = measured.then(ThreadTime::now);
            player.play(data);
            if let Some(before) = before {
                health.worked(before.elapsed().as_secs_f64(), data.len() / channels, config.sample_rate);
            }
            let time = info.timestamp();
            if let Some(ahead) = time.playback.checked_duration_since(time.callback) {
                health.device.store(ahead.as_nanos() as u64, Ordering::Relaxed);
            }
            health.block(data.len() / channels);
        };
        let stream = device.build_output_stream(config, callback, move |error| errors.report(&error), None)?;
        stream.play()?;
        Ok(stream)
    }
    match format {
        SampleFormat::F32 => build::<f32>(device, config, player, health),
        SampleFormat::F64 => build::<f64>(device, config, player, health),
        SampleFormat::I32 => build::<i32>(device, config, player, health),
        SampleFormat::I24 => build::<cpal::I24>(device, config, player, health),
        SampleFormat::I16 => build::<i16>(device, config, player, health),
        SampleFormat::U16 => build::<u16>(device, config, player, health),
        SampleFormat::U8 => build::<u8>(device, config, player, health),
        _ => Err(ErrorKind::UnsupportedConfig.into()),
    }
}

fn record(
    device: &Device,
    config: StreamConfig,
    format: SampleFormat,
    recorder: Recorder,
    health: Arc<Health>,
) -> Result<Stream, cpal::Error> {
    fn build<T: SizedSample>(
        device: &Device,
        config: StreamConfig,
        mut recorder: Recorder,
        health: Arc<Health>,
    ) -> Result<Stream, cpal::Error>
    where
        f32: FromSample<T>,
    {
        let errors = health.clone();
        let channels = usize::from(config.channels).max(1);
        let callback = move |data: &[T], _: &cpal::InputCallbackInfo| {
            recorder.record(data);
            health.block(data.len() / channels);
        };
        let stream = device.build_input_stream(config, callback, move |error| errors.report(&error), None)?;
        stream.play()?;
        Ok(stream)
    }
    match format {
        SampleFormat::F32 => build::<f32>(device, config, recorder, health),
        SampleFormat::F64 => build::<f64>(device, config, recorder, health),
        SampleFormat::I32 => build::<i32>(device, config, recorder, health),
        SampleFormat::I24 => build::<cpal::I24>(device, config, recorder, health),
        SampleFormat::I16 => build::<i16>(device, config, recorder, health),
        SampleFormat::U16 => build::<u16>(device, config, recorder, health),
        SampleFormat::U8 => build::<u8>(device, config, recorder, health),
        _ => Err(ErrorKind::UnsupportedConfig.into()),
    }
}

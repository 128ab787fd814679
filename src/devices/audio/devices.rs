//! Which devices there are, which one is meant, and how it is set up.
//!
//! The sound server is asked first (PulseAudio's protocol, which PipeWire speaks too): its devices can be shared and keep
//! their names. Then the system's own host (ALSA).

use std::cell::RefCell;
use std::rc::Rc;

use cpal::traits::{DeviceTrait, HostTrait};
use cpal::{BufferSize, Device, Host, HostId, SampleFormat, StreamConfig, SupportedStreamConfigRange};

/// The rate that spares all conversion, Hz.
const PREFERRED_RATE: u32 = soffio_simulation::SAMPLE_RATE;

/// How the sound server ends the name of what a loudspeaker plays.
const MONITOR: &str = ".monitor";

/// Where sound goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// Microphones.
    Input,
    /// Loudspeakers.
    Output,
}

/// A device as it is listed.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Listed {
    /// For the configuration.
    pub id: String,
    /// As the system calls it.
    pub name: String,
    /// Its own rate, Hz.
    pub sample_rate: u32,
    /// Its own number of channels.
    pub channels: u16,
    /// The system's own choice.
    pub default: bool,
}

/// A device that was found, and how to open it.
pub struct Chosen {
    /// The device.
    pub device: Device,
    /// For the configuration.
    pub id: String,
    /// As the system calls it.
    pub name: String,
    /// Rate, channels, block.
    pub config: StreamConfig,
    /// Type of its samples.
    pub format: SampleFormat,
    /// Shortest block that the driver offers, frames; `None` where it does not say.
    pub shortest_block: Option<u32>,
}

/// From now on what ALSA's library has to say on this thread is kept in memory instead of written to the terminal, which
/// it does for every plug-in without a device, at each look. What was kept before is dropped. What matters of it comes
/// as an error.
#[cfg(target_os = "linux")]
fn hush() {
    if let Err(error) = alsa::Output::local_error_handler() {
        tracing::debug!("ALSA will write to the terminal: {error}");
    }
}

#[cfg(not(target_os = "linux"))]
fn hush() {}

/// Hosts that answer, the preferred one first.
fn hosts() -> impl Iterator<Item = Rc<Host>> {
    hush();
    let mut ids = cpal::available_hosts();
    ids.sort_by_key(|id| *id != HostId::PulseAudio);
    ids.into_iter().filter_map(host)
}

/// A host, if it answers.
fn host(id: HostId) -> Option<Rc<Host>> {
    thread_local! {
        /// The library never closes a connection to the sound server, which grants some 64; so this thread keeps one
        /// for as long as it answers.
        static SERVER: RefCell<Option<Rc<Host>>> = const { RefCell::new(None) };
    }
    let open = || cpal::host_from_id(id).ok().map(Rc::new);
    if id != HostId::PulseAudio {
        return open();
    }
    SERVER.with_borrow_mut(|present| {
        *present = present.take().filter(|host| host.output_devices().is_ok()).or_else(open);
        present.clone()
    })
}

/// The host API: the sound server if there is one, else the driver. What a driver calls its
/// default beside a server is that server again, by a longer way.
fn owner() -> impl Iterator<Item = Rc<Host>> {
    let answers = |host: &Host| host.output_devices().is_ok_and(|mut devices| devices.next().is_some());
    let mut served = false;
    hosts().take_while(move |host| !std::mem::replace(&mut served, host.id() == HostId::PulseAudio && answers(host)))
}

/// The system's own choice. When a microphone is pulled out, a sound server may call the loudspeaker's own sound the
/// microphone from then on; that is never meant, so any other goes before it.
fn default_device(host: &Host, direction: Direction) -> Option<Device> {
    match direction {
        Direction::Input => {
            let is_ear = |device: &Device| !id(device).ends_with(MONITOR);
            let others = || host.input_devices().ok().and_then(|mut devices| devices.find(is_ear));
            host.default_input_device().filter(is_ear).or_else(others)
        }
        Direction::Output => host.default_output_device(),
    }
}

/// Is this device of [`Chosen::id`] still there? A sound server moves the stream of one that is pulled out to another,
/// without a word. A host that does not answer says nothing.
pub fn is_present(direction: Direction, wanted: &str) -> bool {
    let there = |host: Rc<Host>| all_devices(&host, direction).map(|devices| devices.iter().any(|d| id(d) == wanted));
    let prefix = wanted.split(':').next().unwrap_or_default();
    hosts().filter(|host| host.id().to_string() == prefix).all(|host| there(host).unwrap_or(true))
}

fn all_devices(host: &Host, direction: Direction) -> Result<Vec<Device>, cpal::Error> {
    Ok(match direction {
        Direction::Input => host.input_devices()?.collect(),
        Direction::Output => host.output_devices()?.collect(),
    })
}

fn name(device: &Device) -> String {
    device.description().map_or_else(|_| device.to_string(), |d| d.name().to_owned())
}

fn id(device: &Device) -> String {
    device.id().map_or_else(|_| device.to_string(), |id| id.to_string())
}

/// All devices of one direction that can be opened, on the preferred host that has any.
///
/// # Errors
/// A driver call failed: its message.
pub fn list(direction: Direction) -> Result<Vec<Listed>, String> {
    let mut found = Vec::new();
    for host in hosts() {
        let default = default_device(&host, direction).map(|device| id(&device));
        for device in all_devices(&host, direction).map_err(|error| format!("{}: {error}", host.id()))? {
            let config = match direction {
                Direction::Input => device.default_input_config(),
                Direction::Output => device.default_output_config(),
            };
            let id = id(&device);
            // ALSA lists its plug-ins too: those that do not open, and the one that swallows everything.
            let Some(config) = config.ok().filter(|_| id != "alsa:null") else { continue };
            found.push(Listed {
                name: name(&device),
                sample_rate: config.sample_rate(),
                channels: config.channels(),
                default: default.as_ref() == Some(&id),
                id,
            });
        }
        if !found.is_empty() {
            break;
        }
    }
    Ok(found)
}

/// The device that `wanted` means: an id, any part of a name, or the system's own choice when empty.
///
/// # Errors
/// Why there is none, for staff.
pub fn choose(direction: Direction, wanted: &str, block_ms: f64) -> Result<Chosen, String> {
    let kind = match direction {
        Direction::Input => "microphone",
        Direction::Output => "loudspeaker",
    };
    let wanted = wanted.trim();
    let mut problem = match wanted {
        "" => format!("this machine has no {kind}"),
        _ => format!("no {kind} is called \"{wanted}\"; `soffio devices` lists them"),
    };
    let hosts: Vec<Rc<Host>> = if wanted.is_empty() { owner().collect() } else { hosts().collect() };
    for host in hosts {
        let device = if wanted.is_empty() {
            default_device(&host, direction)
        } else {
            let devices = all_devices(&host, direction).unwrap_or_default();
            // `host:id`, the id alone, or the whole name, before any part of either.
            let exact = devices.iter().position(|d| {
                let id = id(d);
                id == wanted || id.split_once(':').is_some_and(|(_, own)| own == wanted) || name(d) == wanted
            });
            let part = |d: &Device| {
                let hay = format!("{} {}", name(d), id(d)).to_lowercase();
                hay.contains(&wanted.to_lowercase())
            };
            let index = exact.or_else(|| devices.iter().position(part));
            index.and_then(|i| devices.into_iter().nth(i))
        };
        let Some(device) = device else { continue };
        match configure(&device, direction, block_ms) {
            Ok(StreamChoice { config, format, shortest_block }) => {
                let (id, name) = (id(&device), name(&device));
                return Ok(Chosen { id, name, device, config, format, shortest_block });
            }
            Err(error) => problem = format!("{}: {error}", name(&device)),
        }
    }
    Err(problem)
}

/// How a device is opened.
struct StreamChoice {
    config: StreamConfig,
    format: SampleFormat,
    /// Shortest block that the driver offers, frames, if it says so.
    shortest_block: Option<u32>,
}

/// The preferred rate if the device has it in its own format, else its own rate; blocks of about `block_ms`, ms.
fn configure(device: &Device, direction: Direction, block_ms: f64) -> Result<StreamChoice, cpal::Error> {
    let (own, ranges): (_, Vec<SupportedStreamConfigRange>) = match direction {
        Direction::Input => (device.default_input_config()?, device.supported_input_configs()?.collect()),
        Direction::Output => (device.default_output_config()?, device.supported_output_configs()?.collect()),
    };
    let same = |range: &&SupportedStreamConfigRange| {
        range.channels() == own.channels() && range.sample_format() == own.sample_format()
    };
    let preferred = ranges.iter().filter(same).find_map(|range| range.try_with_sample_rate(PREFERRED_RATE));
    let chosen = preferred.unwrap_or(own);
    let frames = (block_ms.clamp(1.0, 200.0) * f64::from(chosen.sample_rate()) / 1000.0).round() as u32;
    let (buffer_size, shortest_block) = match *chosen.buffer_size() {
        cpal::SupportedBufferSize::Range { min, max } if min <= max => {
            (BufferSize::Fixed(frames.clamp(min, max)), Some(min))
        }
        _ => (BufferSize::Default, None),
    };
    let config = StreamConfig { buffer_size, ..chosen.config() };
    Ok(StreamChoice { config, format: chosen.sample_format(), shortest_block })
}

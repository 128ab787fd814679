//! Which devices there are, which one is meant, and how it is set up.
//!
//! The sound server is asked first (PulseAudio's protocol, which PipeWire speaks too): its devices can be shared and keep
//! their names. Then the system's own host (ALSA).

use cpal::traits::{DeviceTrait, HostTrait};
use cpal::{BufferSize, Device, Host, HostId, SampleFormat, StreamConfig, SupportedStreamConfigRange};

/// The rate that spares all conversion, Hz.
const PREFERRED_RATE: u32 = crate::simulation::SAMPLE_RATE;

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
    /// As the system calls it.
    pub name: String,
    /// Rate, channels, block.
    pub config: StreamConfig,
    /// Type of its samples.
    pub format: SampleFormat,
}

/// Hosts that answer, the preferred one first.
fn hosts() -> impl Iterator<Item = Host> {
    let mut ids = cpal::available_hosts();
    ids.sort_by_key(|id| *id != HostId::PulseAudio);
    ids.into_iter().filter_map(|id| cpal::host_from_id(id).ok())
}

fn default_device(host: &Host, direction: Direction) -> Option<Device> {
    match direction {
        Direction::Input => host.default_input_device(),
        Direction::Output => host.default_output_device(),
    }
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
    for host in hosts() {
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
            Ok((config, format)) => return Ok(Chosen { name: name(&device), device, config, format }),
            Err(error) => problem = format!("{}: {error}", name(&device)),
        }
    }
    Err(problem)
}

/// The preferred rate if the device has it in its own format, else its own rate.
fn configure(
    device: &Device,
    direction: Direction,
    block_ms: f64,
) -> Result<(StreamConfig, SampleFormat), cpal::Error> {
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
    let buffer_size = match *chosen.buffer_size() {
        cpal::SupportedBufferSize::Range { min, max } if min <= max => BufferSize::Fixed(frames.clamp(min, max)),
        _ => BufferSize::Default,
    };
    Ok((StreamConfig { buffer_size, ..chosen.config() }, chosen.sample_format()))
}

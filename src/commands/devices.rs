//! `soffio devices`.

use super::failure::{Failure, Outcome};

/// Lists the devices of this machine: microphones, loudspeakers, GPUs.
#[derive(clap::Args, Debug, Default)]
#[command(after_help = "\
Example: soffio devices
         soffio devices --json

`audio.microphone` and `audio.output` in the configuration take these ids, or any part of a name.")]
pub struct Args {
    /// One JSON object instead of text.
    #[arg(long)]
    json: bool,
}

/// Runs the command. Nothing found is not an error; a driver that fails is.
#[cfg(feature = "kiosk")]
pub fn run(args: Args) -> Outcome {
    use std::io::Write;

    use soffio_devices::audio::devices::{Direction, list};

    let inputs = list(Direction::Input).map_err(Failure::device)?;
    let outputs = list(Direction::Output).map_err(Failure::device)?;
    let gpus = gpus();
    let text = if args.json {
        let all = serde_json::json!({ "microphones": inputs, "loudspeakers": outputs, "gpus": gpus });
        format!("{all}\n")
    } else {
        let mut text = String::new();
        for (title, devices) in [("microphones", &inputs), ("loudspeakers", &outputs)] {
            text += &format!("{title}\n");
            for device in devices {
                let default = if device.default { "  (the system's own choice)" } else { "" };
                let (rate, channels) = (device.sample_rate, device.channels);
                text += &format!("  {}  \"{}\"  {rate} Hz  {channels} ch{default}\n", device.id, device.name);
            }
            if devices.is_empty() {
                text += "  none\n";
            }
        }
        text += "gpus\n";
        for gpu in &gpus {
            text += &format!("  {}  {}  {}\n", gpu.name, gpu.kind, gpu.driver);
        }
        if gpus.is_empty() {
            text += "  none\n";
        }
        text
    };
    // A reader that closed the pipe has read enough.
    let _ = std::io::stdout().write_all(text.as_bytes());
    Ok(())
}

/// Runs the command.
#[cfg(not(feature = "kiosk"))]
pub fn run(_args: Args) -> Outcome {
    Err(Failure { code: 2, message: "this build supports no devices; build it with the feature `kiosk`".into() })
}

/// A graphics adapter.
#[cfg(feature = "kiosk")]
#[derive(serde::Serialize)]
struct Gpu {
    name: String,
    /// Discrete, integrated, virtual, or a processor that paints in software.
    kind: String,
    driver: String,
}

#[cfg(feature = "kiosk")]
fn gpus() -> Vec<Gpu> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
        backends: wgpu::Backends::VULKAN,
        ..wgpu::InstanceDescriptor::new_without_display_handle_from_env()
    });
    let adapters = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::VULKAN));
    adapters
        .iter()
        .map(|adapter| {
            let info = adapter.get_info();
            let kind = match info.device_type {
                wgpu::DeviceType::DiscreteGpu => "discrete",
                wgpu::DeviceType::IntegratedGpu => "integrated",
                wgpu::DeviceType::VirtualGpu => "virtual",
                wgpu::DeviceType::Cpu => "software",
                wgpu::DeviceType::Other => "other",
            };
            Gpu { name: info.name, kind: kind.into(), driver: format!("{} {}", info.driver, info.driver_info) }
        })
        .collect()
}

//! `soffio doctor`.

use std::path::{Path, PathBuf};

use super::{Failure, Outcome};
use crate::config::Config;
use crate::exhibit;
use crate::math::decibels;

/// Says what to mend on this machine: screen, graphics, microphone, loudspeaker, fonts, files.
#[derive(clap::Args, Debug, Default)]
#[command(after_help = "Example:\n  soffio doctor --json")]
pub struct Args {
    /// The site's configuration [default: kiosk-config/kiosk.toml here or above, else built in]
    #[arg(long, value_name = "FILE")]
    config: Option<PathBuf>,
    /// One JSON array on stdout instead of text
    #[arg(long)]
    json: bool,
}

/// How well something is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Health {
    /// As it should be.
    Ok,
    /// The kiosk runs, but not as well as it could.
    Warn,
    /// The kiosk lacks something that it is made for.
    Bad,
}

/// One thing looked at.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
pub struct Finding {
    /// What was looked at.
    pub what: String,
    /// How well it is.
    pub health: Health,
    /// What was found.
    pub found: String,
    /// What to do; empty where there is nothing to do.
    pub remedy: String,
    /// A device or driver (exit code 3) rather than a file (exit code 1).
    pub device: bool,
}

impl Finding {
    fn new(what: &str, health: Health, found: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self { what: what.into(), health, found: found.into(), remedy: remedy.into(), device: false }
    }

    fn of_device(self) -> Self {
        Self { device: true, ..self }
    }
}

/// Runs the command.
pub fn run(args: Args) -> Outcome {
    let loaded = Config::load(args.config.as_deref());
    let mut findings = vec![match &loaded {
        Ok((_, Some(file))) => Finding::new("configuration", Health::Ok, file.display().to_string(), ""),
        Ok((_, None)) => Finding::new("configuration", Health::Ok, "built in; no file found", ""),
        Err(error) => Finding::new("configuration", Health::Bad, error.to_string(), "mend the lines named here"),
    }];
    let config = loaded.map(|(config, _)| config).unwrap_or_default();
    findings.extend(exhibits(&config));
    #[cfg(feature = "kiosk")]
    findings.extend(machine::look(&config));
    #[cfg(not(feature = "kiosk"))]
    findings.push(
        Finding::new("devices", Health::Bad, "this build has no window and no sound", "build with the feature `kiosk`")
            .of_device(),
    );

    if args.json {
        println!("{}", serde_json::json!(findings));
    } else {
        findings.iter().for_each(print);
    }
    let bad = |device| findings.iter().any(|f| f.health == Health::Bad && f.device == device);
    match (bad(false), bad(true)) {
        (true, _) => Err(Failure { code: 1, message: String::new() }),
        (false, true) => Err(Failure { code: 3, message: String::new() }),
        (false, false) => Ok(()),
    }
}

fn print(finding: &Finding) {
    let Finding { what, health, found, remedy, .. } = finding;
    let mark = match health {
        Health::Ok => "ok  ",
        Health::Warn => "warn",
        Health::Bad => "bad ",
    };
    println!("{mark}  {what}: {}", found.replace('\n', "\n        "));
    if !remedy.is_empty() {
        println!("        -> {remedy}");
    }
}

/// Every exhibit of the configured folder, and whether the one to be shown is among them.
fn exhibits(config: &Config) -> Vec<Finding> {
    let folder = &config.exhibit.folder;
    let mut folders: Vec<PathBuf> = std::fs::read_dir(folder)
        .map(|entries| entries.flatten().map(|entry| entry.path()).filter(|path| is_exhibit(path)).collect())
        .unwrap_or_default();
    folders.sort();
    let mut findings: Vec<Finding> = folders
        .iter()
        .map(|path| {
            let what = format!("exhibit {}", path.file_name().unwrap_or_default().to_string_lossy());
            match exhibit::load(path) {
                Ok(_) => Finding::new(&what, Health::Ok, "valid", ""),
                Err(report) => {
                    let remedy = format!("soffio check {}", path.display());
                    Finding::new(&what, Health::Bad, report.to_string(), remedy)
                }
            }
        })
        .collect();
    if !is_exhibit(&folder.join(&config.exhibit.id)) {
        let found = format!("{} is not in {}", config.exhibit.id, folder.display());
        let remedy = "set exhibit.id and exhibit.folder in kiosk-config/kiosk.toml, or start where the folder is";
        findings.push(Finding::new("exhibit to be shown", Health::Bad, found, remedy));
    }
    findings
}

fn is_exhibit(folder: &Path) -> bool {
    folder.join("exhibit.toml").is_file() || folder.join("exhibit.json").is_file()
}

/// What a second of sound of the room says about a microphone.
pub fn judge_room(samples: &[f32], sample_rate: u32) -> Finding {
    /// Quieter than any room through any microphone, dB of full scale: it is switched off.
    const MUTED_DBFS: f64 = -100.0;
    /// Louder than a room should be where a gentle breath is to stand out, dB of full scale.
    const LOUD_DBFS: f64 = -25.0;
    /// Share of samples at the rails from which it clips.
    const CLIPPED: f64 = 1e-4;
    /// Rise from the first to the last tenth of the time, dB, that only a gain that adapts makes in a steady room.
    const CREEPING_DB: f64 = 8.0;
    const WHAT: &str = "microphone level";

    // The first tenth is left out: streams begin with silence and clicks.
    let heard = &samples[samples.len() / 10..];
    let peak = heard.iter().fold(0.0_f32, |peak, sample| peak.max(sample.abs()));
    let level = |part: &[f32]| {
        let power: f64 = part.iter().map(|&x| f64::from(x) * f64::from(x)).sum();
        decibels((power / part.len().max(1) as f64).sqrt())
    };
    let rms = level(heard);
    let tenths: Vec<f64> = heard.chunks((heard.len() / 9).max(1)).map(level).collect();
    let creeps = tenths.windows(2).all(|pair| pair[1] >= pair[0])
        && tenths.first().zip(tenths.last()).is_some_and(|(first, last)| last - first > CREEPING_DB);
    let clipped = heard.iter().filter(|sample| sample.abs() >= 0.999).count() as f64 / heard.len().max(1) as f64;

    let found = match peak {
        0.0 => "not a single sample differs from zero".to_owned(),
        _ => format!("{rms:.1} dBFS, peak {:.1} dBFS", decibels(f64::from(peak))),
    };
    if heard.len() < sample_rate as usize / 2 {
        let found = format!("{} samples in a second that has {sample_rate}", samples.len());
        return Finding::new(WHAT, Health::Bad, found, "it hardly delivers: try another socket or another device");
    }
    if rms < MUTED_DBFS {
        return Finding::new(WHAT, Health::Bad, found, "it is muted: open the input in the system's mixer");
    }
    if clipped > CLIPPED {
        return Finding::new(WHAT, Health::Warn, found, "it clips: turn the input gain down");
    }
    if creeps {
        let remedy = "the level creeps up by itself: switch automatic gain control and noise suppression off";
        return Finding::new(WHAT, Health::Warn, found, remedy);
    }
    if rms > LOUD_DBFS {
        return Finding::new(WHAT, Health::Warn, found, "loud for a quiet room: turn the input gain down");
    }
    Finding::new(WHAT, Health::Ok, found, "")
}

/// Screen, graphics and sound.
#[cfg(feature = "kiosk")]
mod machine {
    use std::time::{Duration, Instant};

    use super::{Finding, Health, judge_room};
    use crate::audio_io::{AudioIo, DeviceState};
    use crate::config::Config;
    use crate::kiosk::{fonts, window};
    use crate::render::Gpu;
    use crate::sound::Synth;

    /// How long the room is listened to.
    const LISTEN: Duration = Duration::from_millis(1100);
    /// Longest wait for the devices to open.
    const OPENING: Duration = Duration::from_secs(3);

    pub fn look(config: &Config) -> Vec<Finding> {
        let mut findings = vec![display(), graphics(), east_asian()];
        findings.extend(sound(config));
        findings
    }

    fn display() -> Finding {
        let finding = match window::event_loop() {
            Ok(_) => Finding::new("display", Health::Ok, "windows can be opened", ""),
            Err(error) => {
                let remedy = "start it in a graphical session, where DISPLAY or WAYLAND_DISPLAY is set; without one \
                              the exhibit runs into files";
                Finding::new("display", Health::Bad, error, remedy)
            }
        };
        finding.of_device()
    }

    fn graphics() -> Finding {
        let finding = match Gpu::headless() {
            Ok(gpu) if gpu.is_software() => {
                let remedy = "the processor draws, a few pictures a second: install the graphics card's Vulkan driver";
                Finding::new("graphics", Health::Warn, gpu.name(), remedy)
            }
            Ok(gpu) => Finding::new("graphics", Health::Ok, gpu.name(), ""),
            Err(error) => {
                let remedy = "install a Vulkan driver; mesa-vulkan-drivers has one for every machine";
                Finding::new("graphics", Health::Bad, error.to_string(), remedy)
            }
        };
        finding.of_device()
    }

    fn east_asian() -> Finding {
        let what = "fonts for Chinese, Japanese and Korean";
        match fonts::find_east_asian() {
            Some((file, _)) => Finding::new(what, Health::Ok, file.display().to_string(), ""),
            None => {
                let remedy = "install fonts-noto-cjk or fonts-nanum; until then these languages are not offered";
                Finding::new(what, Health::Warn, "none found", remedy)
            }
        }
    }

    fn sound(config: &Config) -> Vec<Finding> {
        let mut audio = AudioIo::start(&config.audio, Synth::silent);
        let (mut heard, mut played) = (Vec::new(), Vec::new());
        let mut rate = None;
        let began = Instant::now();
        let mut opened = None;
        // Devices open on a thread of their own; the second of listening begins with the first samples.
        while opened.map_or(began.elapsed() < OPENING, |at: Instant| at.elapsed() < LISTEN) {
            std::thread::sleep(Duration::from_millis(20));
            rate = audio.read_microphone(&mut heard, &mut played).or(rate);
            if opened.is_none() && !heard.is_empty() {
                opened = Some(Instant::now());
            }
        }
        let status = audio.status();
        let device = |what: &str, state: &DeviceState, without: &str| {
            let finding = match state {
                DeviceState::Ok { .. } => Finding::new(what, Health::Ok, state.to_string(), ""),
                _ => {
                    let remedy = format!("connect one, or name it in [audio]; until then {without}");
                    Finding::new(what, Health::Bad, state.to_string(), remedy)
                }
            };
            finding.of_device()
        };
        let mut findings = vec![
            device("loudspeaker", &status.output, "all is silent"),
            device("microphone", &status.input, "visitors press and hold to blow"),
        ];
        if let Some(rate) = rate {
            findings.push(judge_room(&heard, rate).of_device());
        }
        findings
    }
}

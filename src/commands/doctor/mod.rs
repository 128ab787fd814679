//! `soffio doctor`: one list of findings, each with its remedy.

use std::path::{Path, PathBuf};

use super::failure::{Failure, Outcome};
use super::setup;
use soffio_config::{Config, LoadedConfig, OTHERS};
use soffio_exhibit as exhibit;

mod finding;
#[cfg(feature = "kiosk")]
mod machine;
mod microphone;

pub use finding::{Finding, Health};
pub use microphone::{judge_blow, judge_low_tones, judge_room};

/// Checks this machine and names remedies: screen, graphics, microphone, loudspeaker, fonts, files.
#[derive(clap::Args, Debug, Default)]
#[command(after_help = "Example:\n  soffio doctor --json\n  soffio doctor --audio-self-test --blow")]
pub struct Args {
    /// The site's configuration [default: kiosk-config/kiosk.toml here or above, else built in]
    #[arg(long, value_name = "FILE")]
    config: Option<PathBuf>,
    /// Measure a breath too, from where visitors stand, and propose the sensitivity
    #[arg(long)]
    blow: bool,
    /// Play a sweep through the loudspeaker, record it with the microphone, and report how both and the foam are
    #[arg(long)]
    audio_self_test: bool,
    /// One JSON array on stdout instead of text
    #[arg(long)]
    json: bool,
}

/// Runs the command.
pub fn run(args: Args) -> Outcome {
    #[cfg(feature = "kiosk")]
    soffio_devices::protection::forbid_core_dumps().map_err(Failure::device)?;
    let loaded = Config::load(args.config.as_deref()).map(setup::with_staff_overrides);
    let mut findings = vec![match &loaded {
        Ok(LoadedConfig { file: None, .. }) => Finding::new("configuration", Health::Ok, "built in; no file found", ""),
        Ok(loaded @ LoadedConfig { file: Some(file), .. }) => {
            let warnings: Vec<String> = loaded.warning_texts().collect();
            match warnings.is_empty() {
                true => Finding::new("configuration", Health::Ok, file.display().to_string(), ""),
                false => {
                    let remedy = format!("`soffio check --fix {}` rewrites the file", file.display());
                    Finding::new("configuration", Health::Warn, warnings.join("\n"), remedy)
                }
            }
        }
        Err(error) => Finding::new("configuration", Health::Bad, error.to_string(), "correct the lines named here"),
    }];
    if let Ok(LoadedConfig { staff: Some(staff), .. }) = &loaded {
        let (health, remedy) = match &staff.problem {
            None => (Health::Ok, ""),
            Some(_) => (Health::Warn, "correct that file or delete it; until then the configuration holds alone"),
        };
        findings.push(Finding::new("staff settings", health, staff.summary(), remedy));
    }
    let config = loaded.map(|loaded| loaded.config).unwrap_or_default();
    findings.push(pin(&config));
    findings.extend(exhibits(&config));
    #[cfg(feature = "kiosk")]
    findings.extend(machine::look(&config, args.blow, args.audio_self_test));
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

/// Whether staff can change anything at the kiosk.
fn pin(config: &Config) -> Finding {
    match config.staff.pin.is_set() {
        true => Finding::new("staff PIN", Health::Ok, "set", ""),
        false => {
            let remedy =
                "`soffio pin` prints the line for [staff]; until then the staff panel shows and changes nothing";
            Finding::new("staff PIN", Health::Warn, "none is set", remedy)
        }
    }
}

/// Every exhibit of the configured folder, and whether those to be shown are among them.
fn exhibits(config: &Config) -> Vec<Finding> {
    let folder = &exhibit::exhibits_folder(&config.exhibits.folder);
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
    for id in config.exhibits.show.iter().filter(|id| *id != OTHERS && !is_exhibit(&folder.join(id))) {
        let found = format!("{id} is not in {}", folder.display());
        let remedy = "set exhibits.show and exhibits.folder in kiosk-config/kiosk.toml, or start where the folder is";
        findings.push(Finding::new("exhibit to be shown", Health::Bad, found, remedy));
    }
    findings
}

fn is_exhibit(folder: &Path) -> bool {
    folder.join(exhibit::SIDECAR).is_file()
}

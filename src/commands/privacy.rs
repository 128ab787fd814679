//! `soffio privacy`.

use std::path::PathBuf;

use super::failure::{Failure, Outcome};
use soffio_config::Config;

/// Says what the kiosk keeps of its visitors, where and for how long, and what it does not keep.
#[derive(clap::Args, Debug, Default)]
#[command(after_help = "\
Example:
  soffio privacy --config /etc/soffio/kiosk.toml")]
pub struct Args {
    /// The site's configuration [default: kiosk-config/kiosk.toml here or above, else built in]
    #[arg(long, value_name = "FILE")]
    config: Option<PathBuf>,
    /// One JSON object on stdout instead of text
    #[arg(long)]
    json: bool,
}

/// Something that is kept.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
pub struct Kept {
    /// What it is.
    pub what: String,
    /// Where.
    pub place: String,
    /// Until when.
    pub until: String,
}

/// The whole report.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
pub struct Report {
    /// What is kept. None of it says who somebody is.
    pub kept: Vec<Kept>,
    /// What is not.
    pub not_kept: Vec<&'static str>,
    /// Ways out of the machine.
    pub sent: Vec<String>,
}

/// Runs the command.
pub fn run(args: Args) -> Outcome {
    let (config, _) = Config::load(args.config.as_deref()).map_err(Failure::input)?;
    let report = report(&config);
    if args.json {
        println!("{}", serde_json::json!(report));
        return Ok(());
    }
    println!("Kept:");
    for Kept { what, place, until } in &report.kept {
        println!("  {what}\n      where: {place}; until: {until}");
    }
    println!("\nNot kept, at no time, in no file:");
    report.not_kept.iter().for_each(|what| println!("  {what}"));
    println!("\nOver the network:");
    match report.sent.is_empty() {
        true => println!("  nothing"),
        false => report.sent.iter().for_each(|what| println!("  {what}")),
    }
    Ok(())
}

/// What a kiosk with this configuration keeps.
pub fn report(config: &Config) -> Report {
    let kept =
        |what: &str, place: &str, until: &str| Kept { what: what.into(), place: place.into(), until: until.into() };
    let mut all = vec![];
    if config.visit.breath {
        all.push(kept(
            "microphone samples, from which level, bands and onset of a breath are found",
            "memory",
            "the next few steps, a fraction of a second; of what the room sounds like, mean spectra of some seconds",
        ));
    }
    if config.visit.breath {
        all.push(kept(
            "a few seconds of the kiosk's own chirp, once a day or when staff ask for it",
            "memory",
            "it is heard",
        ));
    }
    all.push(kept("seconds blown at a work in this visit", "memory", "the visit ends"));
    all.push(kept(
        "what the simulation was told (pointers, hands, speed of the breath) or where the work was, without a name or a sound",
        "nowhere, but where an engineer starts the kiosk with --record FILE or --trace FILE: there",
        "the file is deleted",
    ));
    all.push(kept(
        "language, type, contrast, volume, motion and press-once as a visitor chose them",
        "memory",
        "nobody has been there for attract.idle_s",
    ));
    all.push(kept("mean level of what the loudspeaker played", "memory", "a minute; midnight"));
    all.push(kept(
        "log: devices, exhibits, faults, and when a breath began and ended, by whatever means it was blown",
        "standard error: the journal, under systemd",
        "as the journal is set; the last 400 lines in memory",
    ));
    const COUNTS: &str = "counts over all visitors (visits and how long they were, breaths by their source, languages)";
    #[cfg(feature = "kiosk")]
    if let Some(folder) = soffio_kiosk::fleet::kept::folder(config) {
        let what = format!(
            "{COUNTS}; the day's sum of breath; how loud the kiosk's own chirp arrived in seven octaves; wrong PINs, mute, night, the work on show"
        );
        all.push(kept(&what, &folder.display().to_string(), "the file is deleted"));
    }
    let metrics = &config.staff.metrics;
    if !metrics.as_os_str().is_empty() {
        let what = format!("numbers of the machine, and {COUNTS}");
        all.push(kept(&what, &metrics.display().to_string(), "15 s, then the next ones take their place"));
    }
    let not_kept = vec![
        "sound: no microphone sample is ever written to a file or sent anywhere",
        "pictures of anybody: there is no camera",
        "names, faces, voices, or anything by which a visitor could be known again",
        "where a visitor touched or pointed, unless an engineer has started a record (above)",
        "which visitor blew when, or how one went from work to work",
    ];
    let broker = &config.mqtt.broker;
    let told = format!(
        "to the broker {broker}: how the kiosk is, the language it shows, and the counts; no visitor, no sound"
    );
    Report { kept: all, not_kept, sent: (!broker.is_empty()).then_some(told).into_iter().collect() }
}

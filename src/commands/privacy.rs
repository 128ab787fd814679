//! `soffio privacy`.

use std::path::PathBuf;

use super::failure::Outcome;
use soffio_config::Config;

/// Lists the data that the kiosk stores about its visitors, where and for how long, and the data that it never stores.
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

/// Stored data.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
pub struct StoredItem {
    /// Description.
    pub what: String,
    /// Place.
    pub place: String,
    /// Time until which it is stored.
    pub until: String,
}

/// The whole report.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
pub struct Report {
    /// Stored data. None of it identifies a person.
    pub kept: Vec<StoredItem>,
    /// Data that is never stored.
    pub not_kept: Vec<&'static str>,
    /// Data sent over the network.
    pub sent: Vec<String>,
}

/// Runs the command.
pub fn run(args: Args) -> Outcome {
    let config = super::setup::config(args.config.as_deref())?;
    let report = report(&config);
    if args.json {
        println!("{}", serde_json::json!(report));
        return Ok(());
    }
    println!("Kept:");
    for StoredItem { what, place, until } in &report.kept {
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

/// Data that a kiosk with this configuration stores.
pub fn report(config: &Config) -> Report {
    let kept = |what: &str, place: &str, until: &str| StoredItem {
        what: what.into(),
        place: place.into(),
        until: until.into(),
    };
    let mut all = vec![];
    if config.visit.breath {
        all.push(kept(
            "microphone samples, from which level, bands and onset of a breath are computed",
            "memory",
            "the next step, a fraction of a second, then they are overwritten; for the noise of the room, mean spectra of some seconds",
        ));
    }
    if config.visit.breath {
        all.push(kept(
            "a few seconds of the audio self-test, once a day or when staff start it",
            "memory",
            "the test ends",
        ));
    }
    all.push(kept("seconds of breath at an exhibit in this visit", "memory", "the visit ends"));
    all.push(kept(
        "inputs of the simulation (pointers, grabs, speed of the breath) or poses of the exhibit, without a name or a sound",
        "nowhere, unless an engineer starts the kiosk with --record FILE or --trace FILE",
        "the file is deleted",
    ));
    all.push(kept(
        "language, text size, contrast, volume, motion and press-once as chosen by a visitor",
        "memory",
        "there was no input for attract.idle_s",
    ));
    all.push(kept("mean level of the played sound", "memory", "a minute; midnight"));
    all.push(kept(
        "log: devices, exhibits, faults, and begin and end of each breath with its kind of input",
        "standard error: the journal, under systemd",
        "as the journal is set; the last 400 lines in memory",
    ));
    const COUNTS: &str = "counts over all visitors (visits and how long they were, breaths by their source, languages)";
    #[cfg(feature = "kiosk")]
    if let Some(folder) = soffio_kiosk::fleet::persisted::folder(config) {
        let what = format!(
            "{COUNTS}; the breath time of the day; levels of the audio self-test in seven octaves; wrong PINs, mute, night, the exhibit on show"
        );
        all.push(kept(&what, &folder.display().to_string(), "the file is deleted"));
    }
    let metrics = &config.staff.metrics;
    if !metrics.as_os_str().is_empty() {
        let what = format!("measurements of the machine, and {COUNTS}");
        all.push(kept(&what, &metrics.display().to_string(), "15 s, then they are replaced"));
    }
    let not_kept = vec![
        "sound: no microphone sample is ever written to a file or sent anywhere; the kiosk allows no core dump, a file with its memory",
        "pictures of people: there is no camera",
        "names, faces, voices, or anything that could identify a visitor",
        "where a visitor touched or pointed, unless an engineer has started a record (above)",
        "which visitor blew when, or in which order a visitor saw the exhibits",
    ];
    let broker = &config.mqtt.broker;
    let sent = format!(
        "to the broker {broker}: state of the kiosk, the language on show, and the counts; nothing about a person, no sound"
    );
    Report { kept: all, not_kept, sent: (!broker.is_empty()).then_some(sent).into_iter().collect() }
}

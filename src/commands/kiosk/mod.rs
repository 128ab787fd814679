//! `soffio kiosk`.

use std::io::{IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use tracing_subscriber::filter::{LevelFilter, Targets};
use tracing_subscriber::layer::SubscriberExt;
use tracing_subscriber::util::SubscriberInitExt;

use super::arguments::SolverArg;
use super::failure::{Failure, Outcome};
use super::setup;
use soffio_config::{Config, FILE, LoadedConfig, StaffOverrides};
use soffio_devices::protection::forbid_core_dumps;
use soffio_exhibit::Exhibit;
use soffio_kiosk::fleet::Fleet;
use soffio_kiosk::fleet::persisted;
use soffio_kiosk::fleet::persisted_spread::PersistedSpread;
use soffio_kiosk::live::{Options, Report};
use soffio_kiosk::staff::log::Log;
use soffio_kiosk::venue::catalog::{self, ExhibitSource};
use soffio_kiosk::venue::site::{Overrides, Site};
use soffio_kiosk::venue::trial;
use soffio_kiosk::window::{self, Ended, Launch, Missing};
use soffio_offline::feed::WavFeed;
use soffio_offline::{demo, wav};
use soffio_simulation::{STEPS_PER_SECOND, Settings};

mod supervised;

/// Folder for the files of a run without a window.
const OUT: &str = "out";

/// Default seed: every day in the gallery begins alike.
const DEFAULT_SEED: u64 = 1;

/// Runs the live kiosk.
#[derive(clap::Args, Debug, Default)]
#[command(after_help = "Example:\n  soffio kiosk --windowed --breath breath.wav --for 20")]
pub struct Args {
    /// The site's configuration [default: kiosk-config/kiosk.toml here or above, else built in]
    #[arg(long, value_name = "FILE")]
    config: Option<PathBuf>,
    /// A window on a desk instead of the whole screen; Esc closes it
    #[arg(long)]
    windowed: bool,
    /// Only this exhibit: its id, or its folder [default: those that are configured]
    #[arg(long, value_name = "EXHIBIT")]
    exhibit: Option<String>,
    /// A recording instead of the microphone
    #[arg(long, value_name = "WAV")]
    breath: Option<PathBuf>,
    /// End after so much time
    #[arg(long = "for", value_name = "SECONDS", value_parser = super::arguments::parse_seconds, allow_negative_numbers = true)]
    duration: Option<f64>,
    /// Never play the attract script
    #[arg(long)]
    no_attract: bool,
    /// Seed of all random numbers [default: 1]
    #[arg(long, value_name = "N")]
    seed: Option<u64>,
    /// Solver of the exhibits' motion
    #[arg(long, value_enum, default_value_t)]
    solver: SolverArg,
    /// Writes the poses of all moving bodies, 60 rows a second
    #[arg(long, value_name = "CSV")]
    trace: Option<PathBuf>,
    /// Writes all inputs of the simulation, for `soffio replay`; never a sound
    #[arg(long, value_name = "FILE")]
    record: Option<PathBuf>,
    /// Safe mode: one built-in exhibit, no controllers, no remote commands. Where the start crashes again and again it is automatic, with
    /// an exhibit that has not crashed
    #[arg(long)]
    safe: bool,
    /// Without a display or graphics: plays the exhibit to its recorded breath and leaves a picture, a sound and a trace in out/
    #[arg(long)]
    demo: bool,
    /// Draws with the shaders in this folder, and reloads them when one changes
    #[arg(long, value_name = "FOLDER", hide = true)]
    shaders: Option<PathBuf>,
    /// Destroys the graphics device after so much time, to test its loss
    #[arg(long, value_name = "SECONDS", hide = true)]
    lose_device_at: Option<f64>,
}

/// Runs the command.
pub fn run(args: Args) -> Outcome {
    let log = Log::default();
    let _guard = log_to_stderr(&log);
    forbid_core_dumps().unwrap_or_else(|error| tracing::error!("{error}"));
    let (loaded, problem) = match Config::load(args.config.as_deref()) {
        Ok(loaded) => (loaded, None),
        Err(error) => {
            let config = supervised::config_in_need(&error).ok_or_else(|| Failure::input(&error))?;
            (
                LoadedConfig { config, file: Some(error.file.clone()), ..LoadedConfig::default() },
                Some(error.to_string()),
            )
        }
    };
    let overrides = Overrides { windowed: args.windowed, no_attract: args.no_attract, safe: false };
    let state = persisted::folder(&overrides.apply(loaded.config.clone()));
    let loaded = match &state {
        Some(folder) => loaded.with_staff_overrides(folder),
        None => loaded,
    };
    let warnings: Vec<String> =
        loaded.warning_texts().chain(loaded.staff.iter().map(StaffOverrides::summary)).collect();
    warnings.iter().for_each(|warning| tracing::warn!("{warning}"));
    let LoadedConfig { config, file, .. } = loaded;
    match &file {
        Some(file) => tracing::info!("configuration: {}", file.display()),
        None => tracing::info!("configuration: built in"),
    }
    let places = source(&config, args.exhibit.as_deref())?;
    let begun = supervised::begin(state.clone(), catalog::folders(&places), args.safe);
    let mut begun = begun.map_err(Failure::device)?;
    if let Some(file) = file.as_ref().filter(|_| problem.is_none()) {
        begun.store.save_good_config(file);
    }
    let overrides = Overrides { safe: begun.safe, ..overrides };
    let config = overrides.apply(config);

    if let Ok(program) = std::env::current_exe() {
        trial::enable(program);
    }

    let built_in = if begun.shows_built_in { supervised::built_in() } else { None };
    let (exhibit, places) = match &built_in {
        Some(built_in) => (built_in.exhibit.clone(), ExhibitSource::One(built_in.exhibit.folder.clone())),
        None => (choose(&config, &begun)?, places),
    };
    begun.announce(&exhibit.id);
    let recording = args.breath.map(wav::read).transpose().map_err(Failure::input)?;
    let site = Site::new(&config, args.seed.unwrap_or(DEFAULT_SEED));
    let settings = site.settings;
    let options = Options {
        exhibit: exhibit.clone(),
        site,
        closed: false,
        ambient_spread: begun.persisted.ambient_spread.as_ref().and_then(PersistedSpread::ambient_spread),
        recording: recording.as_ref().map(WavFeed::from),
        steps: args.duration.map(|seconds| (seconds * STEPS_PER_SECOND as f64).round() as u64),
        trace: args.trace,
        record: args.record,
        mode: args.solver.mode(),
    };
    let stop = Arc::new(AtomicBool::new(false));
    setup::stop_on_ctrl_c(&stop);

    let fleet = Fleet::start(begun.store, begun.persisted, begun.safe, &config);
    let (lose_device_at, shaders) = (args.lose_device_at, args.shaders.clone());
    let launch = Launch { config, overrides, file, state, problem, warnings, log, fleet, lose_device_at, shaders };
    match window::run(launch, &places, options, &stop) {
        Ok(Ended::Done(report)) => summarize(&report, args.duration.is_some()),
        Ok(Ended::Interrupted) => Err(Failure { code: 130, message: String::new() }),
        Ok(Ended::Failed(message)) => Err(Failure::device(message)),
        Err(missing) if args.demo => demonstrate(&missing, &exhibit, settings, &stop),
        Err(missing) => Err(Failure::device(explain(&missing))),
    }
}

/// Where the exhibits come from: one alone, or those of the configuration.
fn source(config: &Config, only: Option<&str>) -> Result<ExhibitSource, Failure> {
    match only {
        Some(only) => soffio_exhibit::resolve(only).map(ExhibitSource::One).map_err(Failure::input),
        None => Ok(ExhibitSource::All { folder: config.exhibits.folder.clone(), show: config.exhibits.show.clone() }),
    }
}

/// The first exhibit that loads. After a crash the one that was on show comes first, and those that are set aside are left out.
/// Exhibits that do not load are reported and skipped.
fn choose(config: &Config, begun: &supervised::Begun) -> Result<Arc<Exhibit>, Failure> {
    let marker = begun.store.load_marker();
    let mut failure = None;
    for folder in begun.folders() {
        match marker.during(&catalog::id(folder), || setup::open(&folder.to_string_lossy())) {
            Ok(exhibit) => return Ok(exhibit),
            Err(error) => {
                tracing::error!("{}", error.message.trim_end());
                failure = failure.or(Some(error));
            }
        }
    }
    Err(failure.unwrap_or_else(|| {
        let folder = config.exhibits.folder.display();
        Failure::input(format!(
            "no exhibit to show: {folder} has none of exhibits.show\n  help: set exhibits.folder and exhibits.show in \
             {FILE}, or start where the folder is"
        ))
    }))
}

/// Prints the report of a run with a planned end on stdout.
fn summarize(report: &Report, planned: bool) -> Outcome {
    if planned {
        let said = writeln!(std::io::stdout(), "{}", serde_json::json!(report));
        said.map_err(|error| Failure::input(format!("the summary cannot be written to stdout: {error}")))?;
    }
    Ok(())
}

/// Why there is no live kiosk, and what to do.
fn explain(missing: &Missing) -> String {
    match missing {
        Missing::Display(why) => format!(
            "no display to open a window on ({why}). Start it where DISPLAY or WAYLAND_DISPLAY is set; --demo plays an exhibit without one"
        ),
        Missing::Graphics(why) => format!(
            "no graphics adapter for the window ({why}). Install a Vulkan driver; mesa-vulkan-drivers has one for every machine"
        ),
    }
}

/// The same exhibit without a window: a picture, a sound and a trace.
fn demonstrate(missing: &Missing, exhibit: &Arc<Exhibit>, settings: Settings, stop: &AtomicBool) -> Outcome {
    eprintln!("soffio: {}.", explain(missing));
    eprintln!("soffio: {} runs without a window instead, on a recorded breath.", exhibit.id);
    let demo = match demo::run(exhibit, settings, Path::new(OUT), stop) {
        Ok(demo) => demo,
        Err(_) if stop.load(Ordering::Relaxed) => return Err(Failure { code: 130, message: String::new() }),
        Err(error) => return Err(Failure::input(error)),
    };
    if let Some(why) = &demo.no_picture {
        eprintln!("soffio: no picture: {why}");
    }
    for file in &demo.files {
        eprintln!("soffio: wrote {}", file.display());
    }
    println!("{}", serde_json::json!(demo.summary));
    Ok(())
}

/// Logs go to stderr, and their last lines to the staff panel; `RUST_LOG` says how much. The sound server's client calls
/// its own orderly end an error. The guard writes the last lines at the end.
fn log_to_stderr(log: &Log) -> impl Drop + use<> {
    let requested = std::env::var("RUST_LOG").ok().and_then(|filter| filter.parse::<Targets>().ok());
    let usual = || {
        let levels = [("soffio", LevelFilter::INFO), ("pulseaudio", LevelFilter::OFF)];
        Targets::new().with_default(LevelFilter::ERROR).with_targets(levels)
    };
    let filter = requested.unwrap_or_else(usual);
    let terminal = std::io::stderr().is_terminal();
    let (writer, guard) = log.writer(std::io::stderr());
    let lines = tracing_subscriber::fmt::layer().with_writer(writer).with_ansi(terminal);
    // A second call in one process keeps the first log.
    let _ = tracing_subscriber::registry().with(filter).with(lines).with(log.clone()).try_init();
    guard
}

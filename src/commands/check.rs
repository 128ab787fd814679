//! `soffio check`: all problems of exhibits, models, configurations and files of UI strings at once, each located and explained.

use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::failure::{Failure, Outcome};
use super::fix;
use soffio_config::{Config, Problem};
use soffio_exhibit::renamed::{self, FileKind};
use soffio_exhibit::{self as exhibit, Budget, Diagnostic, Location, Report, codes, model, printable};
#[cfg(feature = "kiosk")]
use soffio_kiosk::pages::ui_strings;
use soffio_offline::budget::{self, Findings};
use soffio_offline::scene::PhysicsScene;
use soffio_simulation::{Settings, Simulation, StepInput};

/// Validates exhibits, configs and models: all problems at once, located, explained.
///
/// An exhibit without mistakes is also run, for up to 10 s of processor time: a hard breath, a fast hand, and 20 assemblies.
/// A warning says where a kiosk would not keep up with it.
///
/// Examples: soffio check exhibits/steel-fish
///           soffio check --fix kiosk-config/kiosk.toml
#[derive(clap::Args, Debug, Default)]
pub struct Args {
    /// Exhibit ids or folders, a folder of exhibits, their exhibit.toml, .glb or .gltf files; a site's configuration
    /// (any other .toml), with the texts beside it; files or a folder of texts (.ftl); a physics scene (.json).
    #[arg(required = true, value_name = "PATH")]
    paths: Vec<String>,
    /// Does not run the exhibits.
    #[arg(long)]
    quick: bool,
    /// Only whether it loads and takes its first steps: a trial before the kiosk loads it.
    #[arg(long, hide = true)]
    trial: bool,
    /// Rewrites files with old names of keys, and says what changed; comments and layout stay.
    #[arg(long)]
    fix: bool,
    /// Prints one JSON array of problems to stdout.
    #[arg(long)]
    json: bool,
}

/// How far an exhibit without mistakes is run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Run {
    No,
    /// For [`FIRST_STEPS`].
    FirstSteps,
    /// Under all stress loads.
    Loads,
}

/// Steps of a trial: enough to take what memory a run takes.
const FIRST_STEPS: usize = 24;

/// Runs the command.
pub fn run(args: Args) -> Outcome {
    let paths: Vec<String> = args.paths.iter().flat_map(|path| expand(path)).collect();
    if args.fix {
        fix::run(&paths)?;
    }
    let mut all = Report::default();
    for path in paths {
        let (report, findings) = check(
            &path,
            if args.trial {
                Run::FirstSteps
            } else if args.quick {
                Run::No
            } else {
                Run::Loads
            },
        );
        if !args.json {
            let verdict = match (report.has_errors(), report.diagnostics.len()) {
                (_, 0) => "good".to_owned(),
                (true, n) => format!("{n} problem{}", if n == 1 { "" } else { "s" }),
                (false, n) => format!("good, {n} warning{}", if n == 1 { "" } else { "s" }),
            };
            let verdict = match findings.filter(|findings| findings.tried < findings.of) {
                Some(Findings { tried, of, .. }) => format!("{verdict} (time for {tried} of {of} loads)"),
                None => verdict,
            };
            eprint!("{}", report.to_terminal_text());
            eprintln!("{}: {verdict}", printable::line(&path));
        }
        all.absorb(report);
    }
    if args.json {
        println!("{}", printable::json(&all.to_json().to_string()));
    }
    if all.has_errors() { Err(Failure { code: 1, message: String::new() }) } else { Ok(()) }
}

/// The exhibits of a folder of exhibits, or the files of a folder of texts, in the order of their names; any other path is
/// itself.
fn expand(path: &str) -> Vec<String> {
    let own = Path::new(path).join(exhibit::SIDECAR).exists();
    let children = std::fs::read_dir(path).into_iter().flatten().flatten().map(|entry| entry.path());
    let mut inside: Vec<String> = children
        .filter(|child| child.join(exhibit::SIDECAR).exists() || child.extension().is_some_and(|end| end == "ftl"))
        .filter(|child| child.file_name().is_some_and(|name| !name.to_string_lossy().starts_with('.')))
        .map(|child| child.to_string_lossy().into_owned())
        .collect();
    inside.sort();
    if own || inside.is_empty() { vec![path.into()] } else { inside }
}

/// Problems and warnings of one path, by what it is, and what a run found.
fn check(path: &str, run: Run) -> (Report, Option<Findings>) {
    let file = Path::new(path);
    let extension = file.extension().and_then(|e| e.to_str()).unwrap_or_default().to_lowercase();
    let without = |report: Report| (report, None);
    let outcome = match extension.as_str() {
        "glb" | "gltf" => model::import(file).map(|imported| without(imported.warnings.into())),
        "toml" if file.file_name().is_some_and(|name| name == exhibit::SIDECAR) => {
            exhibit_report(file.parent().unwrap_or(file), run)
        }
        "toml" => {
            let mut report = match Config::load(Some(file)) {
                Ok(loaded) => config_report(file, &loaded.warnings, codes::OLD_NAME),
                Err(error) => config_report(&error.file, &error.problems, codes::CONFIG),
            };
            texts_beside(file).iter().for_each(|texts| report.absorb(texts_report(texts)));
            Ok(without(report))
        }
        "ftl" => Ok(without(texts_report(file))),
        "json" => scene_report(file).map(without),
        _ => exhibit::resolve(path).and_then(|folder| exhibit_report(&folder, run)),
    };
    outcome.unwrap_or_else(without)
}

/// A configuration's problems in the form of an exhibit's.
fn config_report(path: &Path, problems: &[Problem], code: codes::Code) -> Report {
    let file = path.display().to_string();
    // A file that cannot be read again has no lines to show; its problems are listed without them.
    let text = std::fs::read_to_string(path).unwrap_or_default();
    let diagnostics = problems.iter().map(|problem| {
        let message = if problem.line > 0 { problem.message.clone() } else { format!("{file} {}", problem.message) };
        let mut diagnostic = Diagnostic::new(code, message);
        diagnostic.help = Some(problem.help.clone()).filter(|help| !help.is_empty());
        diagnostic.location = (problem.line > 0).then(|| Location {
            file: file.clone(),
            line: problem.line,
            column: problem.column,
            span: rest_of_line(&text, problem.line, problem.column),
        });
        diagnostic
    });
    Report::in_file(&file, text.as_str().into(), diagnostics.collect())
}

/// The files of texts that belong to a configuration file.
#[cfg(feature = "kiosk")]
fn texts_beside(file: &Path) -> Vec<PathBuf> {
    file.parent().map(|folder| ui_strings::files(&folder.join(ui_strings::FOLDER))).unwrap_or_default()
}

/// Problems of a file of texts in the form of an exhibit's.
#[cfg(feature = "kiosk")]
fn texts_report(path: &Path) -> Report {
    let file = path.display().to_string();
    let text = std::fs::read_to_string(path).unwrap_or_default();
    let text = text.trim_start_matches('\u{feff}');
    let diagnostics = ui_strings::check(path).into_iter().map(|problem| {
        let code = if problem.is_warning { codes::MISSING_TEXTS } else { codes::TEXTS };
        let (line, column) = (problem.line, problem.column);
        let placed = problem.span.map(|span| Location { file: file.clone(), line, column, span });
        let message = if placed.is_some() { problem.message } else { format!("{file}: {}", problem.message) };
        let mut diagnostic = Diagnostic::new(code, message).help(problem.help);
        diagnostic.location = placed;
        diagnostic
    });
    Report::in_file(&file, text.into(), diagnostics.collect())
}

/// Without the kiosk the program has no texts to compare.
#[cfg(not(feature = "kiosk"))]
fn texts_beside(_: &Path) -> Vec<PathBuf> {
    Vec::new()
}

/// Without the kiosk the program has no texts to compare.
#[cfg(not(feature = "kiosk"))]
fn texts_report(path: &Path) -> Report {
    let message = format!("{}: this program was built without the kiosk and has no texts", path.display());
    Report::single(Diagnostic::new(codes::TEXTS, message).help("use a program with the feature `kiosk`"))
}

/// Bytes from a place to the end of its line; line and column (in characters) count from 1.
fn rest_of_line(text: &str, line: usize, column: usize) -> Range<usize> {
    let start: usize = text.split_inclusive('\n').take(line - 1).map(str::len).sum();
    let line = text[start..].lines().next().unwrap_or_default();
    let before: usize = line.chars().take(column - 1).map(char::len_utf8).sum();
    start + before..start + line.len()
}

/// Problems of a physics scene: old names as warnings, else the first mistake.
fn scene_report(file: &Path) -> Result<Report, Report> {
    PhysicsScene::read(file).map_err(|error| Report::single(Diagnostic::new(codes::SCENE, error.to_string())))?;
    let name = file.display().to_string();
    let text = std::fs::read_to_string(file).unwrap_or_default();
    let updated = renamed::update(FileKind::Scene, &text);
    let warnings = updated.replacements.iter().map(|change| {
        let help = format!("`soffio check --fix {name}` rewrites the file");
        Diagnostic::new(codes::OLD_NAME, format!("{name}: {change}")).help(help)
    });
    Ok(warnings.collect::<Vec<_>>().into())
}

fn exhibit_report(folder: &Path, run: Run) -> Result<(Report, Option<Findings>), Report> {
    let budget = Budget::timed(|| cpu_time::ThreadTime::now().as_duration());
    let exhibit = Arc::new(exhibit::load_within(folder, &budget)?);
    let mut report = exhibit.warning_report();
    match run {
        Run::No => return Ok((report, None)),
        Run::FirstSteps => {
            let mut simulation = Simulation::new(exhibit, Settings::default());
            (0..FIRST_STEPS).for_each(|_| simulation.step(&StepInput { hold: true, ..StepInput::default() }));
            return Ok((report, None));
        }
        Run::Loads => {}
    }
    let findings = budget::check(&exhibit);
    let warnings = findings.late.iter().map(|late| late.warning(&exhibit.id)).collect::<Vec<_>>();
    report.absorb(warnings.into());
    Ok((report, Some(findings)))
}

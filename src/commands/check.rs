//! `soffio check`: all problems of exhibits and models at once, each located and explained.

use std::io::IsTerminal;
use std::path::Path;

use super::{Failure, Outcome};
use crate::exhibit::{self, Report, model};

/// Validates exhibits, configs and models: all problems at once, located, explained.
///
/// Example: soffio check exhibits/steel-fish
#[derive(clap::Args, Debug, Default)]
pub struct Args {
    /// Exhibit ids or folders, their exhibit.toml, .glb or .gltf files.
    #[arg(required = true, value_name = "PATH")]
    paths: Vec<String>,
    /// Prints one JSON array of problems to stdout.
    #[arg(long)]
    json: bool,
}

/// Runs the command.
pub fn run(args: Args) -> Outcome {
    let mut all = Report::default();
    for path in &args.paths {
        let report = check(path);
        if !args.json {
            let verdict = match (report.has_errors(), report.diagnostics.len()) {
                (_, 0) => "good".to_owned(),
                (true, n) => format!("{n} problem{}", if n == 1 { "" } else { "s" }),
                (false, n) => format!("good, {n} warning{}", if n == 1 { "" } else { "s" }),
            };
            eprint!("{}", report.render(std::io::stderr().is_terminal()));
            eprintln!("{path}: {verdict}");
        }
        all.absorb(report);
    }
    if args.json {
        println!("{}", all.to_json());
    }
    if all.has_errors() { Err(Failure { code: 1, message: String::new() }) } else { Ok(()) }
}

/// Problems and warnings of one path, by what it is.
fn check(path: &str) -> Report {
    let file = Path::new(path);
    let extension = file.extension().and_then(|e| e.to_str()).unwrap_or_default().to_lowercase();
    let outcome = match extension.as_str() {
        "glb" | "gltf" => model::import(file).map(|imported| Report::from(imported.warnings)),
        "toml" if file.file_name().is_some_and(|name| name == exhibit::SIDECAR) => {
            exhibit_report(file.parent().unwrap_or(file))
        }
        _ => exhibit::resolve(path).and_then(|folder| exhibit_report(&folder)),
    };
    outcome.unwrap_or_else(|report| report)
}

fn exhibit_report(folder: &Path) -> Result<Report, Report> {
    exhibit::load(folder).map(|exhibit| exhibit.warning_report())
}

//! `soffio labels`: label texts as a table for translators, and back.

use std::io::Write;
use std::path::{Path, PathBuf};

use super::failure::{Failure, Outcome};
use soffio_exhibit::{self as exhibit, Report, SIDECAR, files, labels};
use soffio_offline::atomic_file::AtomicFile;

/// Largest table, bytes.
const MAX_TABLE: u64 = 16 << 20;

/// Writes all label texts of an exhibit as a table for translators (CSV: a row a text, a column a language), and reads it
/// back into its exhibit.toml.
#[derive(clap::Args, Debug)]
#[command(after_help = "\
Example: soffio labels pendulum --csv words.csv
         soffio labels pendulum --from words.csv

A new column with a language's code adds that language. Comments in exhibit.toml stay; what is the same is not touched.
An empty cell leaves the text that is there.")]
#[command(group = clap::ArgGroup::new("way").required(true))]
pub struct Args {
    /// Exhibit id or folder.
    exhibit: String,
    /// Writes the table.
    #[arg(long, value_name = "FILE", group = "way")]
    csv: Option<PathBuf>,
    /// Reads the table.
    #[arg(long, value_name = "FILE", group = "way")]
    from: Option<PathBuf>,
}

/// Runs the command.
pub fn run(args: Args) -> Outcome {
    let sidecar = exhibit::resolve(&args.exhibit).map_err(Failure::input)?.join(SIDECAR);
    let text = read(&sidecar)?;
    let name = sidecar.display().to_string();
    if let Some(file) = &args.csv {
        let table = labels::to_csv(&name, &text).map_err(Failure::input)?;
        return put(file, &table);
    }
    let Some(file) = &args.from else { return Ok(()) };
    let taken = labels::from_csv(&name, &text, &file.display().to_string(), &read(file)?).map_err(Failure::input)?;
    for remark in &taken.remarks {
        eprintln!("{remark}");
    }
    if taken.changed == 0 {
        eprintln!("{name}: nothing has changed");
        return Ok(());
    }
    put(&sidecar, &taken.sidecar)?;
    eprintln!("{name}: {} texts changed; see `soffio check {}`", taken.changed, args.exhibit);
    Ok(())
}

fn read(path: &Path) -> Result<String, Failure> {
    files::read_text(path, MAX_TABLE).map_err(|problem| Failure::input(Report::single(problem)))
}

fn put(path: &Path, text: &str) -> Outcome {
    let mut file = AtomicFile::create(path).map_err(Failure::input)?;
    file.write_all(text.as_bytes()).map_err(Failure::input)?;
    file.finish().map_err(Failure::input)
}

//! `soffio new`: creates an exhibit from a template.

use std::io::{BufRead, IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use super::failure::{Failure, Outcome};
use super::setup;
use soffio_authoring::drawing::outlines;
use soffio_authoring::notes::{chime, note};
use soffio_authoring::plate_mobile::{Metal, Outline, sized};
use soffio_authoring::template::Template;
use soffio_authoring::{ExhibitFolder, FolderFile, id_problem, starter};
use soffio_exhibit::{self as exhibit, Diagnostic, Exhibit, Report, files};
use soffio_offline::atomic_folder::AtomicFolder;

/// Plates that are proposed at a terminal.
const PLATES: &str = "120x80,100,90x60,70";
/// Notes of the shipped chimes.
const NOTES: &str = "C5,D5,E5,G5,A5,C6";
/// Largest drawing, bytes: outlines of 256 plates of 2000 corners, as text.
const MAX_DRAWING: u64 = 4 << 20;
/// Stack of the thread that reads it, bytes: 64 elements within each other take far less.
const DRAWING_STACK: usize = 8 << 20;

/// Creates an exhibit from a template: a complete folder, with a sidecar whose comments explain it.
#[derive(clap::Args, Debug)]
#[command(after_help = "\
Example: soffio new red-mobile --from mobile --plates 120x80,100,90x60
         soffio new fish --from mobile --outlines fish.svg --thickness 0.8 --material steel
         soffio new my-chimes --from chimes --notes C5,E5,G5,C6

Plates hang in pairs that ring; wires are bent so that everything hangs level. The folder is made in `exhibits/` if there
is one here, else here. Nothing is overwritten.")]
pub struct Args {
    /// Id of the exhibit, lower-case letters, digits and hyphens; or the path of the folder to make, which ends in it.
    id: String,
    /// Template.
    #[arg(long, value_enum)]
    from: Kind,
    /// Mobile: sizes of the plates, mm: 120x80 is width x height with round corners, 100 a disc.
    #[arg(long, value_name = "SIZES", value_delimiter = ',', conflicts_with = "outlines")]
    plates: Vec<String>,
    /// Mobile: a drawing whose closed shapes are the plates.
    #[arg(long, value_name = "SVG")]
    outlines: Option<PathBuf>,
    /// Mobile: thickness of the sheet, mm.
    #[arg(long, value_name = "MM", default_value_t = 0.8)]
    thickness: f64,
    /// Mobile: material of the plates.
    #[arg(long, value_enum, default_value_t)]
    material: Material,
    /// Chimes: the tubes' notes, from C4 to C7; by default C5,D5,E5,G5,A5,C6.
    #[arg(long, value_delimiter = ',')]
    notes: Vec<String>,
}

/// Template of an exhibit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum Kind {
    /// A balanced mobile of your plates.
    Mobile,
    /// Wind chimes of your notes.
    Chimes,
    /// A copy of Eli Terry's clock.
    Clock,
    /// A copy of the pendulum.
    Pendulum,
    /// One body, to begin with.
    Empty,
}

/// What plates are cut from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum)]
enum Material {
    #[default]
    Aluminium,
    Steel,
    Brass,
    Copper,
}

impl From<Material> for Metal {
    fn from(material: Material) -> Self {
        match material {
            Material::Aluminium => Self::Aluminium,
            Material::Steel => Self::Steel,
            Material::Brass => Self::Brass,
            Material::Copper => Self::Copper,
        }
    }
}

/// Runs the command.
pub fn run(args: Args) -> Outcome {
    let (folder, id) = place(&args.id)?;
    let given_plates = !args.plates.is_empty() || args.outlines.is_some();
    for (given, kind, option) in
        [(given_plates, Kind::Mobile, "--plates and --outlines"), (!args.notes.is_empty(), Kind::Chimes, "--notes")]
    {
        if given && args.from != kind {
            let message = format!("{option} say nothing about what is begun here; leave them out");
            return Err(Failure { code: 2, message });
        }
    }
    let made = match args.from {
        Kind::Mobile => {
            let plates = plates(&args)?;
            starter::mobile(&id, &plates, args.thickness * 1e-3, args.material.into()).map_err(Report::from)
        }
        Kind::Chimes => {
            let names = if args.notes.is_empty() { NOTES.split(',').map(str::to_owned).collect() } else { args.notes };
            all(names.iter().map(|name| note(name))).and_then(|notes| chime(&id, &notes).map_err(Report::single))
        }
        Kind::Clock => return copy(Template::Clock, &folder, &id),
        Kind::Pendulum => return copy(Template::Pendulum, &folder, &id),
        Kind::Empty => Ok(starter::empty(&id)),
    };
    create(&made.map_err(Failure::input)?, &folder, &id)
}

fn copy(template: Template, folder: &Path, id: &str) -> Outcome {
    create(&template.copy(id).map_err(Failure::input)?, folder, id)
}

/// All results, or all problems.
fn all<T>(results: impl Iterator<Item = Result<T, Diagnostic>>) -> Result<Vec<T>, Report> {
    let (mut good, mut problems) = (Vec::new(), Vec::new());
    for result in results {
        match result {
            Ok(value) => good.push(value),
            Err(problem) => problems.push(problem),
        }
    }
    if problems.is_empty() { Ok(good) } else { Err(problems.into()) }
}

/// The folder to make, and the id that it ends in.
pub(super) fn place(id: &str) -> Result<(PathBuf, String), Failure> {
    let given = Path::new(id);
    let name = given.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    if let Some(problem) = id_problem(&name) {
        return Err(Failure::input(Report::single(problem)));
    }
    let exhibits = Path::new("exhibits");
    let folder = if id == name && exhibits.is_dir() { exhibits.join(id) } else { given.to_path_buf() };
    let parent = folder.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    if !parent.is_dir() {
        return Err(Failure::input(format!("there is no folder {}; make it first", parent.display())));
    }
    if folder.symlink_metadata().is_ok() {
        let message =
            format!("{} is there already and stays as it is; choose another id, or move it away", folder.display());
        return Err(Failure::input(message));
    }
    Ok((folder, name))
}

/// Writes the folder, loads it as the kiosk would, and only then gives it its name.
fn create(made: &ExhibitFolder, folder: &Path, id: &str) -> Outcome {
    let whole = write(made, folder)?;
    let exhibit = exhibit::load(whole.aside()).map_err(Failure::input)?;
    whole.finish().map_err(Failure::input)?;
    report(made, folder, id, &exhibit);
    Ok(())
}

/// Writes all files of a folder; Ctrl-C leaves nothing of it.
pub(super) fn write(made: &ExhibitFolder, folder: &Path) -> Result<AtomicFolder, Failure> {
    let stop = Arc::new(AtomicBool::new(false));
    setup::stop_on_ctrl_c(&stop);
    let whole = AtomicFolder::create(folder).map_err(Failure::input)?;
    for FolderFile { name, bytes } in &made.files {
        whole.write(name, bytes).map_err(Failure::input)?;
        if stop.load(Ordering::Relaxed) {
            return Err(Failure { code: 130, message: "interrupted; nothing is left".into() });
        }
    }
    Ok(whole)
}

/// Prints the result and the next steps.
pub(super) fn report(made: &ExhibitFolder, folder: &Path, id: &str, exhibit: &Exhibit) {
    for remark in &made.remarks {
        eprintln!("{remark}");
    }
    let shown = folder.display();
    let counted = match exhibit.warnings.len() {
        0 => String::new(),
        n => format!(", {n} warnings"),
    };
    println!("{shown}");
    eprintln!("{} bodies, {} joints{counted}", exhibit.bodies.len(), exhibit.constraints.len());
    eprintln!(
        "Next: write its texts in {shown}/{}, then\n  soffio check {shown}\n  soffio play {shown} --no-wind --seconds 5\n  \
         soffio loudness {shown} --write\n  soffio render {shown} --size 1280x720 -o {shown}/thumbnail.png\n  \
         soffio kiosk --windowed --exhibit {id}",
        exhibit::SIDECAR
    );
}

/// The plates: given, drawn, or asked for.
fn plates(args: &Args) -> Result<Vec<Outline>, Failure> {
    if let Some(path) = &args.outlines {
        let bytes =
            files::read_limited(path, MAX_DRAWING).map_err(|problem| Failure::input(Report::single(problem)))?;
        return drawn(&path.display().to_string(), bytes);
    }
    let sizes = if args.plates.is_empty() { ask()? } else { args.plates.clone() };
    all(sizes.iter().map(|size| sized(size))).map_err(Failure::input)
}

/// The plates of a drawing. The libraries that read SVG have a stack of their own, and what they cannot take ends them alone.
fn drawn(name: &str, bytes: Vec<u8>) -> Result<Vec<Outline>, Failure> {
    let unreadable = |why: &str| Failure::input(format!("{name} cannot be read: {why}"));
    let text = String::from_utf8(bytes).map_err(|_| unreadable("it is not UTF-8 text; save it as plain SVG"))?;
    let file = name.to_owned();
    let default = std::panic::take_hook();
    // The failure says it, in words for a curator.
    std::panic::set_hook(Box::new(|_| {}));
    let reader = std::thread::Builder::new().stack_size(DRAWING_STACK).spawn(move || outlines(&file, &text));
    let read = reader.map(std::thread::JoinHandle::join);
    std::panic::set_hook(default);
    match read {
        Ok(Ok(read)) => read.map_err(Failure::input),
        Ok(Err(_)) => Err(unreadable("its outlines cannot be followed; simplify them, and save it as plain SVG")),
        Err(error) => Err(unreadable(&error.to_string())),
    }
}

/// Asks for sizes at a terminal.
fn ask() -> Result<Vec<String>, Failure> {
    if !std::io::stdin().is_terminal() {
        let message = format!("which plates? Give --plates {PLATES} (mm), or a drawing by --outlines FILE.svg");
        return Err(Failure { code: 2, message });
    }
    eprint!("Plates in mm, width x height or a disc's diameter [{PLATES}]: ");
    std::io::stderr().flush().map_err(Failure::input)?;
    let mut line = String::new();
    std::io::stdin().lock().read_line(&mut line).map_err(Failure::input)?;
    let line = if line.trim().is_empty() { PLATES } else { line.trim() };
    Ok(line.split([',', ' ']).filter(|size| !size.is_empty()).map(str::to_owned).collect())
}

//! `soffio sound`: one sound of one timbre, for listening and for measuring, or a page of pictures of them.

use std::io::Write;
use std::path::{Path, PathBuf};

use super::failure::{Failure, Outcome};
use soffio_offline::audition::TestSound;
use soffio_offline::{sound_page, wav};
use soffio_simulation::SAMPLE_RATE;
use soffio_sound::timbre::{Specimen, SpecimenShape};
use soffio_sound::{Preset, SurfaceLine, TimbreError, timbre};

/// Longest sound, s.
const LONGEST: f64 = 600.0;

/// Renders one sound, dry mono, or makes a page of pictures.
#[derive(clap::Args, Debug, Default)]
#[command(after_help = "\
Example: soffio sound plate --impulse 5e-4 --at 0.8 -o clank.wav
         soffio sound chime-brass --speed 0.6 --seconds 6 -o chime.wav
         soffio sound plate --set radius=0.2 --set thickness=0.001 --set body.detune=0 -o gong.wav
         soffio sound scrape-wood --slip 0.4 --force 5 -o scratch.wav
         soffio sound wind-wire --wind 3 --seconds 10 -o wire.wav
         soffio sound --page out/sounds

TIMBRE may also be a file of your own, such as exhibits/my-mobile/timbres/gong.toml; its name inside is gong.

Without flags a timbre is played as its [specimen] says. --set takes the specimen's dimensions and material
    radius, length, width, thickness (m), mass (kg), youngs_modulus (Pa), poisson, density (kg/m3), loss_factor,
the hit's mass (hit_mass, kg), its place across (at_y, -1 to 1), the seed (seed),
the motion of the body (body_speed in m/s, body_spin in rad/s, joint_force and tension in N, height in m, parameter),
and any number of a node of the timbre (node.key, such as body.partials).")]
pub struct Args {
    /// Name of a timbre, see --list, or a .toml file; with --page, without it all of them.
    #[arg(required_unless_present_any = ["list", "page"])]
    timbre: Option<String>,
    /// Names the timbres, one a line.
    #[arg(long)]
    list: bool,
    /// Makes a folder of pictures and sounds, with an index.html that shows them: waveform, spectrum, decay of partials.
    #[arg(long, value_name = "FOLDER", conflicts_with_all = ["list", "output"])]
    page: Option<PathBuf>,
    /// Impulse of the hit, N s.
    #[arg(long, value_name = "NS")]
    impulse: Option<f64>,
    /// Force, N: of a hit its greatest, instead of its impulse (J = 2 F tau / pi for a half sine of Hertz's duration); of
    /// a slide the one that presses the surfaces together.
    #[arg(long, value_name = "N", conflicts_with = "impulse")]
    force: Option<f64>,
    /// Place of the hit along the body, -1 to 1.
    #[arg(long, value_name = "X", allow_hyphen_values = true)]
    at: Option<f64>,
    /// Approach speed of the hit, m/s.
    #[arg(long, value_name = "V")]
    speed: Option<f64>,
    /// Speed at which surfaces slide over each other, m/s.
    #[arg(long, value_name = "V")]
    slip: Option<f64>,
    /// Speed of the wind, m/s.
    #[arg(long, value_name = "V")]
    wind: Option<f64>,
    /// Where the wind goes, seen from above: 0 away from the listener, positive to the right, degrees.
    #[arg(long, value_name = "DEG", allow_hyphen_values = true, default_value_t = 0.0)]
    direction: f64,
    /// Picture of the surface, for timbres that read one: its middle row is the line that is scraped.
    #[arg(long, value_name = "PNG")]
    surface: Option<PathBuf>,
    /// Length of that row on the body, m.
    #[arg(long, value_name = "M", default_value_t = 0.1)]
    surface_length: f64,
    /// Changes a number; see below.
    #[arg(long, value_name = "K=V")]
    set: Vec<String>,
    /// Length, s.
    #[arg(long, value_name = "S", default_value_t = 3.0)]
    seconds: f64,
    /// The file to write: mono, 48 kHz, 32-bit float.
    #[arg(short, long, value_name = "WAV", required_unless_present_any = ["list", "page"])]
    output: Option<PathBuf>,
}

fn usage(message: impl Into<String>) -> Failure {
    Failure { code: 2, message: message.into() }
}

/// Runs the command.
pub fn run(args: Args) -> Outcome {
    if args.list {
        let names: String = timbre::names().map(|name| format!("{name}\n")).collect();
        // A reader that closed the pipe has read enough.
        let _ = std::io::stdout().write_all(names.as_bytes());
        return Ok(());
    }
    if !(args.seconds > 0.0 && args.seconds <= LONGEST) {
        return Err(usage("--seconds must be above 0 and at most 600"));
    }
    if let Some(folder) = &args.page {
        return page(folder, &args);
    }
    let (Some(name), Some(output)) = (&args.timbre, &args.output) else {
        return Err(usage("say a timbre and -o OUT.wav, or --list, or --page FOLDER"));
    };
    let (preset, specimen, audition) = settings(name, &args)?;
    let mono = audition.render(&preset, &specimen, args.seconds).map_err(Failure::input)?;
    wav::write_float(output, 1, SAMPLE_RATE, &mono).map_err(Failure::input)
}

fn page(folder: &Path, args: &Args) -> Outcome {
    let mut subjects = Vec::new();
    match &args.timbre {
        Some(name) => subjects.push(settings(name, args)?),
        None => {
            for name in timbre::names() {
                subjects.push(settings(name, args)?);
            }
        }
    }
    sound_page::write(folder, &subjects).map_err(Failure::input)
}

/// The preset, the body and how it is played, with everything that the command line changes.
fn settings(given: &str, args: &Args) -> Result<(Preset, Specimen, TestSound), Failure> {
    let (name, text) = source(given)?;
    // A file of one's own is not where the shipped ones are.
    let own = given != name;
    let wrong = |e: TimbreError| Failure::input(if own { TimbreError { file: given.into(), ..e } } else { e });
    let shipped = Preset::parse(&name, &text).map_err(wrong)?;
    let mut table: toml::Table = text.parse().map_err(Failure::input)?;
    let mut specimen = shipped.specimen;
    let mut audition = TestSound { direction: args.direction.to_radians(), seed: 1, ..TestSound::default() };
    for pair in &args.set {
        let (key, text) = pair.split_once('=').ok_or_else(|| usage(format!("--set {pair}: must be key=value")))?;
        let value: f64 = text.parse().map_err(|_| usage(format!("--set {pair}: \"{text}\" is not a number")))?;
        if key == "seed" {
            audition.seed = value as u64;
            continue;
        }
        if set(&mut specimen, key, value) {
            continue;
        }
        let Some((node, field)) = key.split_once('.').filter(|(node, _)| shipped.node.contains_key(*node)) else {
            let nodes: Vec<_> = shipped.node.keys().map(|node| format!("{node}.…")).collect();
            return Err(usage(format!("--set {key}: not a key of the body (see --help), nor of {}", nodes.join(", "))));
        };
        // Whole numbers stay whole: `partials` is one.
        let whole = text.parse::<i64>().map(toml::Value::Integer);
        if let Some(node) = table["node"][node].as_table_mut() {
            node.insert(field.into(), whole.unwrap_or(toml::Value::Float(value)));
        }
    }
    let given = [
        (&mut specimen.impulse, args.impulse),
        (&mut specimen.at, args.at),
        (&mut specimen.speed, args.speed),
        (&mut specimen.slip, args.slip),
        (&mut specimen.wind, args.wind),
    ];
    for (number, value) in given {
        *number = value.unwrap_or(*number);
    }
    match args.force {
        Some(force) if shipped.slides() => specimen.force = force,
        force => audition.peak_force = force,
    }
    if let Some((field, value)) = specimen.problem() {
        return Err(usage(format!("{field} {value}: must be above 0 and finite")));
    }
    if let Some(path) = &args.surface {
        audition.surface = Some(surface(path, args.surface_length)?);
    }
    Ok((Preset::from_table(&name, table).map_err(wrong)?, specimen, audition))
}

/// Name and text of a shipped timbre or of a file.
fn source(name: &str) -> Result<(String, String), Failure> {
    let path = Path::new(name);
    if path.extension().is_some_and(|extension| extension == "toml") {
        let stem = path.file_stem().and_then(|stem| stem.to_str()).unwrap_or_default();
        let text = std::fs::read_to_string(path).map_err(|e| Failure::input(format!("{name}: {e}")))?;
        return Ok((stem.into(), text));
    }
    match timbre::source(name) {
        Some(text) => Ok((name.into(), text.into())),
        None => match Preset::shipped(name) {
            Err(error) => Err(Failure::input(error)),
            Ok(preset) => Ok((preset.name, String::new())),
        },
    }
}

/// Whether the key is one of the specimen's.
fn set(specimen: &mut Specimen, key: &str, value: f64) -> bool {
    let flat = |shape: SpecimenShape| if shape == SpecimenShape::Disc { SpecimenShape::Bar } else { shape };
    match key {
        "radius" => {
            (specimen.length, specimen.width, specimen.shape) = (2.0 * value, 2.0 * value, SpecimenShape::Disc);
        }
        "length" => (specimen.length, specimen.shape) = (value, flat(specimen.shape)),
        "width" => (specimen.width, specimen.shape) = (value, flat(specimen.shape)),
        "thickness" => specimen.thickness = value,
        "mass" => specimen.mass = Some(value),
        "youngs_modulus" => specimen.youngs_modulus = value,
        "poisson" => specimen.poisson = value,
        "density" => specimen.density = value,
        "loss_factor" => specimen.loss_factor = value,
        "hit_mass" => specimen.hit_mass = value,
        "at_y" => specimen.at_y = value,
        "body_speed" => specimen.body_speed = value,
        "body_spin" => specimen.body_spin = value,
        "joint_force" => specimen.joint_force = value,
        "tension" => specimen.tension = value,
        "height" => specimen.height = value,
        "parameter" => specimen.parameter = value,
        _ => return false,
    }
    true
}

/// Brightness along the middle row of a picture.
fn surface(path: &Path, length: f64) -> Result<SurfaceLine, Failure> {
    let picture = image::open(path).map_err(|e| Failure::input(format!("{}: {e}", path.display())))?.into_luma16();
    let row = picture.height() / 2;
    let values: Vec<f32> =
        (0..picture.width()).map(|x| f32::from(picture.get_pixel(x, row).0[0]) / f32::from(u16::MAX)).collect();
    let spacing = length / values.len().max(1) as f64;
    Ok(SurfaceLine { values, spacing })
}

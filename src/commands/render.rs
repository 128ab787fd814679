//! `soffio render`.

use std::path::PathBuf;
use std::sync::Arc;

use super::failure::{Failure, Outcome};
use super::setup::progress_bar;
use soffio_exhibit::{self as exhibit, Exhibit};
use soffio_offline::pictures::{SUPERSAMPLING, write_png};
use soffio_render::reference::{self, Reference};
use soffio_render::scenario::Scenario;
use soffio_render::{FrameInput, ImageRenderer, Lighting, Options, Shaders};
use soffio_simulation::{STEPS_PER_SECOND, Settings, Simulation, Snapshot, StepInput};

/// Picture size without `--size` or a scenario's.
const DEFAULT_SIZE: (u32, u32) = (1280, 720);
/// Longest `--time`, s: a day of the work's life.
const LONGEST: f64 = 86_400.0;
/// Most paths per pixel: beyond it no noise is left in eight bits.
const MOST_SAMPLES: i64 = 65_536;

/// Renders one picture, headless.
#[derive(clap::Args, Debug, Default)]
#[command(after_help = "Example: soffio render steel-fish --time 2 --size 1920x1080 -o fish.png")]
pub struct Args {
    /// Exhibit id, exhibit folder, or a .glb/.gltf model; the scenario's model where left out.
    what: Option<String>,
    /// Scenario file: camera, light and tone curve.
    #[arg(long, value_name = "SCENE.json")]
    scene: Option<PathBuf>,
    /// Pixels.
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    size: Option<(u32, u32)>,
    /// Lets the exhibit move for so many seconds first.
    #[arg(long, value_name = "S", default_value_t = 0.0, allow_negative_numbers = true)]
    time: f64,
    /// Traces paths of light on the processor instead: slow and exact, for posters and for comparison.
    #[arg(long, conflicts_with = "shaders")]
    reference: bool,
    /// Paths per pixel; a power of two is best. Four times as many halve the noise.
    #[arg(long, value_name = "N", requires = "reference", default_value_t = reference::Settings::default().samples)]
    #[arg(value_parser = clap::value_parser!(u32).range(1..=MOST_SAMPLES))]
    samples: u32,
    /// Folder of shaders to draw with instead of the built-in ones.
    #[arg(long, value_name = "DIR", hide_short_help = true)]
    shaders: Option<PathBuf>,
    /// PNG to write.
    #[arg(short, long, value_name = "OUT.png")]
    output: PathBuf,
}

/// Reads `WxH`.
///
/// # Errors
/// The text is not of this form, or a side is 0.
pub fn parse_size(text: &str) -> Result<(u32, u32), String> {
    let size = text.split_once(['x', 'X', '×']).and_then(|(w, h)| Some((w.parse().ok()?, h.parse().ok()?)));
    match size {
        Some((width, height)) if width > 0 && height > 0 => Ok((width, height)),
        _ => Err(format!("`{text}` is not a size; write width x height in pixels, as 1280x720")),
    }
}

/// Runs the command.
pub fn run(args: Args) -> Outcome {
    if !(0.0..=LONGEST).contains(&args.time) {
        return Err(Failure { code: 2, message: format!("--time {} must lie in 0 … {LONGEST} s", args.time) });
    }
    let scenario = match &args.scene {
        Some(path) => Scenario::load(path).map_err(Failure::input)?,
        None => Scenario::default(),
    };
    let exhibit = Arc::new(subject(&args, &scenario)?);
    let mut simulation = Simulation::new(exhibit.clone(), Settings::default());
    let snapshot = at(&mut simulation, args.time * STEPS_PER_SECOND as f64);
    let size =
        args.size.unwrap_or((scenario.width.unwrap_or(DEFAULT_SIZE.0), scenario.height.unwrap_or(DEFAULT_SIZE.1)));
    let look = scenario.lighting().map_err(Failure::input)?;
    let view = scenario.view(exhibit.view(f64::from(size.0) / f64::from(size.1)));
    let exposure = scenario.exposure.unwrap_or(1.0);
    let frame = FrameInput {
        poses: &snapshot.poses,
        dust: &snapshot.dust_particles,
        curves: &snapshot.curves,
        view,
        size,
        exposure,
        time: snapshot.time,
    };
    let picture = if args.reference {
        traced(&exhibit, &look, &frame, args.samples)
    } else {
        drawn(&exhibit, look, &frame, &args)
    }?;
    write_png(&picture, &args.output).map_err(Failure::input)
}

/// The picture by the graphics device.
fn drawn(exhibit: &Exhibit, look: Lighting, frame: &FrameInput, args: &Args) -> Result<image::RgbaImage, Failure> {
    let shaders = args.shaders.as_deref().map(Shaders::load).transpose().map_err(Failure::input)?;
    let adjust = |options: &mut Options| {
        options.lighting = look;
        options.shaders = shaders.map_or(options.shaders.clone(), Arc::new);
    };
    let mut renderer =
        ImageRenderer::new(exhibit, adjust).map_err(Failure::of_picture)?.with_supersampling(SUPERSAMPLING);
    renderer.draw(frame).map_err(Failure::of_picture)
}

/// The picture by paths of light.
fn traced(exhibit: &Exhibit, look: &Lighting, frame: &FrameInput, samples: u32) -> Result<image::RgbaImage, Failure> {
    let settings = reference::Settings { samples, ..Default::default() };
    let progress = progress_bar(u64::from(frame.size.1));
    let mut reference = Reference::new(exhibit, look).map_err(Failure::of_picture)?;
    let picture = reference.picture(frame, settings, &|rows| progress.set_position(u64::from(rows)));
    progress.finish_and_clear();
    picture.map_err(Failure::of_picture)
}

/// The moment after so many steps, between two of them where they are not whole.
fn at(simulation: &mut Simulation, steps: f64) -> Snapshot {
    /// Decimals of a second end somewhere: nearer to a step than this is on it.
    const SAME: f64 = 1e-3;
    let whole = (steps + SAME).floor();
    for _ in 0..whole as u64 {
        simulation.step(&StepInput::default());
    }
    let before = simulation.snapshot();
    if steps - whole < SAME {
        return before;
    }
    simulation.step(&StepInput::default());
    before.interpolate(&simulation.snapshot(), steps - whole)
}

/// The exhibit to draw: by id or folder, or a model alone.
fn subject(args: &Args, scenario: &Scenario) -> Result<Exhibit, Failure> {
    let (name, path) = match (&args.what, &scenario.model) {
        (Some(what), _) => (what.clone(), PathBuf::from(what)),
        (None, Some(model)) => (model.display().to_string(), model.clone()),
        (None, None) => {
            let message = "name an exhibit or a model, or give a --scene that names one; see --help";
            return Err(Failure { code: 2, message: message.into() });
        }
    };
    let extension = path.extension().and_then(|e| e.to_str()).unwrap_or("").to_ascii_lowercase();
    if extension == "glb" || extension == "gltf" {
        return exhibit::load_model(&path).map_err(Failure::input);
    }
    let folder = exhibit::resolve(&name).map_err(Failure::input)?;
    exhibit::load(&folder).map_err(Failure::input)
}

//! Likeness of the live picture to the reference: the mean FLIP of exhibits at rest and in a breath.
//!
//! The live picture is drawn as the kiosk draws it, with four samples a pixel and no supersampling, and without dust, which
//! the reference leaves out.

use std::path::Path;
use std::sync::Arc;

use serde::Serialize;

use crate::commands::failure::{Failure, Outcome};
use crate::commands::setup::open;
use soffio_exhibit::Exhibit;
use soffio_offline::load::HARDEST_BREATH;
use soffio_offline::pictures::write_png;
use soffio_render::reference::{self, Reference};
use soffio_render::{FrameInput, ImageRenderer, Lighting, flip};
use soffio_simulation::{Command, STEPS_PER_SECOND, Settings, Simulation, Snapshot, StepInput};

/// Pixels a degree of vision: a picture of 0.7 m width and 3840 pixels seen from 0.7 m (Andersson et al. 2020).
const PIXELS_PER_DEGREE: f32 = 67.0;
/// Samples of a pixel of the reference: at twice as many FLIP changes by less than 0.002.
const SAMPLES: u32 = 128;
/// Speed of the breath, as a share of the hardest one.
const BREATH: f64 = 0.5;

#[derive(Serialize)]
struct Likeness {
    exhibit: String,
    /// Mean FLIP, 0 (the same) … 1.
    at_rest: f32,
    /// After a breath of the given seconds.
    in_motion: f32,
}

/// Measures and prints; `pictures` is a folder for both pictures of each moment.
pub fn run(names: &[String], size: (u32, u32), seconds: f64, pictures: Option<&Path>, json: bool) -> Outcome {
    let names = if names.is_empty() { soffio_exhibit::ids() } else { names.to_vec() };
    for name in names {
        let exhibit = open(&name)?;
        let mut simulation = Simulation::new(exhibit.clone(), Settings::default());
        let at_rest = compare(&exhibit, &simulation.snapshot(), size, pictures.map(|p| (p, "rest")))?;
        for step in 0..(seconds * STEPS_PER_SECOND as f64) as u64 {
            let blow = [Command::Blow(Some(BREATH * HARDEST_BREATH))];
            let commands = if step == 0 { &blow[..] } else { &[] };
            simulation.step(&StepInput { commands, ..StepInput::default() });
        }
        let in_motion = compare(&exhibit, &simulation.snapshot(), size, pictures.map(|p| (p, "breath")))?;
        let row = Likeness { exhibit: exhibit.id.clone(), at_rest, in_motion };
        if json {
            println!("{}", serde_json::to_string(&row).map_err(Failure::input)?);
        } else {
            println!("{:<20} FLIP at rest {at_rest:.3}, in motion {in_motion:.3}", row.exhibit);
        }
    }
    Ok(())
}

/// Mean FLIP of the two pictures of a moment.
fn compare(
    exhibit: &Arc<Exhibit>,
    moment: &Snapshot,
    size: (u32, u32),
    keep: Option<(&Path, &str)>,
) -> Result<f32, Failure> {
    let view = exhibit.view(f64::from(size.0) / f64::from(size.1));
    let (poses, curves, time) = (&moment.poses, &moment.curves, moment.time);
    let frame = FrameInput { poses, dust: &[], curves, view, size, exposure: 1.0, time };
    let mut live = ImageRenderer::new(exhibit, |_| ()).map_err(Failure::of_picture)?;
    let drawn = live.draw(&frame).map_err(Failure::of_picture)?;
    let settings = reference::Settings { samples: SAMPLES, ..Default::default() };
    let mut reference = Reference::new(exhibit, &Lighting::default()).map_err(Failure::of_picture)?;
    let traced = reference.picture(&frame, settings, &|_| ()).map_err(Failure::of_picture)?;
    if let Some((folder, which)) = keep {
        let path = |kind: &str| folder.join(format!("{}-{which}-{kind}.png", exhibit.id));
        write_png(&drawn, &path("live")).map_err(Failure::input)?;
        write_png(&traced, &path("reference")).map_err(Failure::input)?;
    }
    flip::mean(&traced, &drawn, PIXELS_PER_DEGREE).ok_or_else(|| Failure::input("the pictures differ in size"))
}

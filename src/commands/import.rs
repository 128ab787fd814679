//! `soffio import`: an exhibit folder from any glTF model.

use std::path::PathBuf;

use super::failure::{Failure, Outcome};
use super::new::{place, report, write};
use soffio_authoring::imported;
use soffio_exhibit::{self as exhibit, SIDECAR};

/// Makes an exhibit folder from a glTF model (.glb, or .gltf with its files). Its sidecar proposes bodies, masses, joints.
#[derive(clap::Args, Debug)]
#[command(after_help = "\
Example: soffio import bird.glb
         soffio import scans/bird.gltf --id paper-bird

Physics that the model carries (KHR_physics_rigid_bodies, KHR_implicit_shapes) is taken over: motions, shapes, materials,
joints. What cannot be taken over is reported, node by node. Mistakes are reported with their lines; the folder is made all
the same, to be corrected. The folder is made in `exhibits/` if there is one here, else here.")]
pub struct Args {
    /// The model.
    model: PathBuf,
    /// Id of the exhibit, or the path of the folder to make, which ends in it; by default after the model's file.
    #[arg(long)]
    id: Option<String>,
}

/// Runs the command.
pub fn run(args: Args) -> Outcome {
    let id = args.id.unwrap_or_else(|| id_of(&args.model));
    let (folder, id) = place(&id)?;
    let made = imported::folder(&args.model, &id).map_err(Failure::input)?;
    write(&made, &folder)?.finish().map_err(Failure::input)?;
    let exhibit = exhibit::load(&folder).map_err(|problems| {
        let shown = folder.display();
        Failure::input(format!(
            "{problems}the folder {shown} is there; correct its {SIDECAR} or the model, then: soffio check {shown}"
        ))
    })?;
    report(&made, &folder, &id, &exhibit);
    Ok(())
}

/// `My Bird_2.glb` as an id: `my-bird-2`.
fn id_of(model: &std::path::Path) -> String {
    let stem = model.file_stem().map(|stem| stem.to_string_lossy().to_lowercase()).unwrap_or_default();
    let plain: String = stem.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '-' }).collect();
    let parts: Vec<&str> = plain.split('-').filter(|word| !word.is_empty()).collect();
    parts.join("-")
}

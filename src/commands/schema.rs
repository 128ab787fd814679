//! `soffio schema`: the JSON Schema of a file format, for editors that complete and check while one types.

use super::failure::{Failure, Outcome};
use soffio_config as config;
use soffio_exhibit as exhibit;
use soffio_sound::timbre::Preset;

/// Prints the JSON Schema of a file kind.
///
/// Example: soffio schema exhibit > exhibit.schema.json, and `#:schema exhibit.schema.json` as the first line of the
/// exhibit.toml.
#[derive(clap::Args, Debug, Default)]
pub struct Args {
    /// Which file.
    #[arg(value_enum, default_value_t)]
    kind: Kind,
}

/// Files that have a schema.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum)]
pub enum Kind {
    /// exhibit.toml, format exhibit/1.
    #[default]
    Exhibit,
    /// kiosk-config/kiosk.toml, the site's configuration.
    Kiosk,
    /// audio/timbres/*.toml, a sound as data.
    Timbre,
}

/// Runs the command.
pub fn run(args: Args) -> Outcome {
    let schema = match args.kind {
        Kind::Exhibit => exhibit::schema::schema_with_old_names(),
        Kind::Kiosk => config::schema(),
        Kind::Timbre => schemars::schema_for!(Preset).to_value(),
    };
    println!("{}", serde_json::to_string_pretty(&schema).map_err(Failure::input)?);
    Ok(())
}

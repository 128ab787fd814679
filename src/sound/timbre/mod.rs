//! Timbre presets: a sound as data. A preset names nodes. Each node takes other nodes by name; the whole is an acyclic graph whose
//! output is `out`. Any [`Number`] may be constant or follow the motion.
//!
//! Presets are compiled into the program: the kiosk needs no path. Unknown keys are refused; every error says which
//! file, line and key, what is wrong and what would be right. No text makes this panic.

mod check;
mod error;
mod formula;
mod limits;
mod node;
mod number;
mod preset;
mod read;
mod shipped;
mod source;
mod specimen;

pub use error::TimbreError;
pub(super) use formula::{Formula, MOST_INPUTS};
pub use limits::{LONGEST_DELAY, MAX_NODES, MAX_PARTIALS};
pub use node::{
    Delay, Env, Filter, FilterKind, Fm, Function, Map, Mix, Node, Noise, NoiseKind, Oscillator, Texture, TextureKind,
    Value, Waveform,
};
pub use number::{Binding, Factor, Input, Number, Term};
pub(super) use number::{Inputs, Player};
pub use preset::Preset;
pub use shipped::{names, source};
pub use source::{
    Bar, BeamModel, Common, Drawn, MassSpring, MaterialOverride, Membrane, Mesh, Modal, Plate, Source, Spacing, Strung,
    Table, TablePartial, Tube,
};
pub use specimen::{Shape as SpecimenShape, Specimen};

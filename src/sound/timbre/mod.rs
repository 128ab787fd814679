//! Timbre presets: a sound as data. A preset names nodes; each node takes other nodes by name, so that the whole is a
//! graph without rings, and `out` is what is heard. Any [`Number`] may follow the motion instead of standing still.
//!
//! Presets are compiled into the program: the kiosk needs no path. Unknown keys are refused; every error says which
//! file, line and key, what is wrong and what would be right. No text makes this panic.

mod check;
mod node;
mod number;
mod read;
mod shipped;
mod source;
mod specimen;

use std::collections::BTreeMap;

use schemars::JsonSchema;

pub use node::{Delay, Env, Filter, FilterKind, Map, Mix, Node, Noise, NoiseKind, Texture, TextureKind, Value};
pub use number::{Binding, Factor, Input, Number, Term};
pub(super) use number::{Inputs, Player};
pub use shipped::{names, source};
pub use source::{
    Bar, BeamModel, Common, Drawn, MassSpring, MaterialOverride, Mesh, Modal, Plate, Source, Spacing, Strung, Table,
    TablePartial, Tube,
};
pub use specimen::{Shape as SpecimenShape, Specimen};

/// Version of the format that this program reads.
const VERSION: u32 = 1;
/// Most nodes of one timbre.
pub const MAX_NODES: usize = 16;
/// Most partials of one timbre.
pub const MAX_PARTIALS: usize = 1024;
/// Longest delay of a node, s.
pub const LONGEST_DELAY: f64 = 0.1;

/// What is wrong with a timbre, and where.
#[derive(Clone, Debug, PartialEq)]
pub struct TimbreError {
    /// The preset's file.
    pub file: String,
    /// Its line, from 1, where there is one.
    pub line: Option<usize>,
    /// Path of the key, `node.body.partials`.
    pub key: String,
    /// What is wrong and what would be right.
    pub problem: String,
}

impl std::error::Error for TimbreError {}

impl std::fmt::Display for TimbreError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}", self.file)?;
        if let Some(line) = self.line {
            write!(f, ":{line}")?;
        }
        write!(f, ": {}: {}", self.key, self.problem)
    }
}

impl TimbreError {
    pub(super) fn new(name: &str, key: impl Into<String>, problem: impl Into<String>) -> Self {
        Self { file: format!("audio/timbres/{name}.toml"), line: None, key: key.into(), problem: problem.into() }
    }
}

/// A timbre preset (`audio/timbres/<name>.toml`).
#[derive(Clone, Debug, JsonSchema, PartialEq)]
#[schemars(deny_unknown_fields)]
pub struct Preset {
    /// Version of the format: 1.
    pub timbre: u32,
    /// The file's name without extension.
    pub name: String,
    /// What it sounds like, in a few words.
    pub description: String,
    /// What it is tried on, and how, where there is no exhibit.
    #[schemars(default)]
    pub specimen: Specimen,
    /// Nodes by name; `out` is heard.
    pub node: BTreeMap<String, Node>,
}

impl Preset {
    /// A shipped preset by name.
    pub fn shipped(name: &str) -> Result<Self, TimbreError> {
        match source(name) {
            Some(text) => Self::parse(name, text),
            None => Err(TimbreError::new(name, "timbre", format!("no such timbre{}", read::hint(name, names())))),
        }
    }

    /// A preset from its text; `name` must be the name inside.
    pub fn parse(name: &str, text: &str) -> Result<Self, TimbreError> {
        let table = read::table(name, text)?;
        Self::from_table(name, table).map_err(|e| TimbreError { line: read::line(text, &e.key), ..e })
    }

    /// A preset from a parsed table (with values replaced, say, by a command line).
    pub fn from_table(name: &str, table: toml::Table) -> Result<Self, TimbreError> {
        let preset = read::preset(name, table)?;
        preset.check(name)?;
        Ok(preset)
    }

    /// The modal node and its name.
    pub fn modal(&self) -> Option<(&str, &Modal)> {
        self.node.iter().find_map(|(key, node)| match node {
            Node::Modal(modal) => Some((key.as_str(), modal.as_ref())),
            _ => None,
        })
    }

    /// The wind or a slide plays it all the time; otherwise hits play it, one by one.
    pub fn continuous(&self) -> bool {
        self.player() != Player::Hit
    }

    /// Whether surfaces that slide play it.
    pub fn slides(&self) -> bool {
        self.player() == Player::Slide
    }

    pub(super) fn player(&self) -> Player {
        let mut player = Player::Hit;
        let numbers = self.node.values().flat_map(Node::numbers);
        for input in numbers.flat_map(|(_, number)| number.inputs().collect::<Vec<_>>()) {
            match input.player() {
                Player::Slide => return Player::Slide,
                Player::Wind => player = Player::Wind,
                Player::Hit => {}
            }
        }
        player
    }

    /// Names of the nodes that `out` needs, each after those it takes.
    pub(super) fn order(&self, name: &str) -> Result<Vec<&str>, TimbreError> {
        /// Depth-first; `open` is the path from `out` down to here.
        fn visit<'a>(preset: &'a Preset, key: &'a str, open: &mut Vec<&'a str>, done: &mut Vec<&'a str>) -> bool {
            if done.contains(&key) {
                return true;
            }
            let Some(node) = preset.node.get(key).filter(|_| !open.contains(&key)) else { return false };
            open.push(key);
            let fine = node.inputs().iter().all(|input| visit(preset, input, open, done));
            open.pop();
            done.push(key);
            fine
        }
        let mut done = Vec::new();
        if visit(self, "out", &mut Vec::new(), &mut done) {
            Ok(done)
        } else if self.node.contains_key("out") {
            Err(TimbreError::new(name, "node", "nodes take each other in a ring"))
        } else {
            Err(TimbreError::new(name, "node.out", "missing: the node that is heard"))
        }
    }
}

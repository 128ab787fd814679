//! Presets: a timbre's nodes under their names.

use std::collections::BTreeMap;

use schemars::JsonSchema;

use super::error::TimbreError;
use super::node::Node;
use super::number::Player;
use super::read;
use super::shipped::{names, source};
use super::source::Modal;
use super::specimen::Specimen;

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
    ///
    /// # Errors
    /// There is no shipped preset of this name; the message names similar ones.
    pub fn shipped(name: &str) -> Result<Self, TimbreError> {
        match source(name) {
            Some(text) => Self::parse(name, text),
            None => Err(TimbreError::new(name, "timbre", format!("no such timbre{}", read::hint(name, names())))),
        }
    }

    /// A preset from its text; `name` must be the name inside.
    ///
    /// # Errors
    /// The text is no valid preset; the message says where and why.
    pub fn parse(name: &str, text: &str) -> Result<Self, TimbreError> {
        let table = read::table(name, text)?;
        Self::from_table(name, table).map_err(|e| TimbreError { line: read::line(text, &e.key), ..e })
    }

    /// A preset from a parsed table (with values replaced, say, by a command line).
    ///
    /// # Errors
    /// The table is no valid preset; the message says where and why.
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

    /// Is it a sustained sound, which wind or a slide plays? Otherwise each hit plays it once.
    pub fn continuous(&self) -> bool {
        self.player() != Player::Hit
    }

    /// Whether surfaces that slide play it.
    pub fn slides(&self) -> bool {
        self.player() == Player::Slide
    }

    pub(crate) fn player(&self) -> Player {
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
    pub(crate) fn order(&self, name: &str) -> Result<Vec<&str>, TimbreError> {
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

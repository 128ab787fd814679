//! Presets: a timbre's nodes under their names.

use std::collections::BTreeMap;

use schemars::JsonSchema;

use super::error::TimbreError;
use super::node::Node;
use super::number::{Input, Player};
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

    /// Is it a sustained sound, which wind, a slide or motion plays? Otherwise each hit plays it once.
    pub fn continuous(&self) -> bool {
        self.player() != Player::Hit
    }

    /// Whether surfaces that slide play it.
    pub fn slides(&self) -> bool {
        self.player() == Player::Slide
    }

    /// Whether the motion of its body plays it.
    pub fn moves(&self) -> bool {
        self.player() == Player::Motion
    }

    /// Whether anything of it follows the wind.
    pub fn follows_wind(&self) -> bool {
        self.follows(Player::Wind)
    }

    /// Whether anything of it follows the motion of its body.
    pub fn follows_motion(&self) -> bool {
        self.follows(Player::Motion)
    }

    /// Whether any number or formula of it follows this input.
    pub fn follows_input(&self, input: Input) -> bool {
        self.node.values().any(|node| node.follows().contains(&input))
    }

    /// Line, from 1, of the key of an error in the text of a preset, or of the nearest table around it.
    pub fn line_of(text: &str, key: &str) -> Option<usize> {
        read::line(text, key)
    }

    /// Whether a hit makes something of it ring, whatever else plays it: it has partials that no node drives.
    pub fn rings(&self) -> bool {
        self.modal().is_some_and(|(_, modal)| modal.r#in.is_none())
    }

    fn follows(&self, player: Player) -> bool {
        self.node.values().any(|node| node.is_played_by(player))
    }

    /// How it is played: by a slide if any input of a slide is named, else by wind, else by motion. With an envelope, or with the
    /// strength of a hit as an input, each hit plays it instead of motion. Undriven partials ring at each hit in any case.
    pub(crate) fn player(&self) -> Player {
        let waits = |node: &Node| matches!(node, Node::Modal(modal) if modal.r#in.is_none());
        let begins = |node: &Node| matches!(node, Node::Env(_)) || node.is_played_by(Player::Hit);
        let mut sustained = self.node.values().filter(|node| !waits(node));
        if self.follows(Player::Slide) {
            Player::Slide
        } else if self.follows(Player::Wind) {
            Player::Wind
        } else if sustained.clone().any(|node| node.is_played_by(Player::Motion)) && !sustained.any(begins) {
            Player::Motion
        } else {
            Player::Hit
        }
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

//! Label texts by language, credit, and the attract script.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::Deserialize;

use super::super::quantity::{Angle, Time};

/// The attract script: what the exhibit does when nobody is there.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Attract {
    /// Steps in time order; the script repeats after the last.
    pub step: Vec<AttractStep>,
    /// Length of the script before it repeats; by default 10 s after the last step.
    pub duration: Option<Time>,
}

/// One step of the attract script: one of show, blow, camera, reset.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AttractStep {
    /// Time since the script began, from 0.
    pub at: Time,
    /// Key, in `label.*.text`, of the text to show.
    pub show: Option<String>,
    /// A breath.
    pub blow: Option<Blow>,
    /// Orbits the camera: to the right and up from its own position; [0, 0] returns it.
    pub camera: Option<[Angle; 2]>,
    /// Resets the exhibit to its start. It jumps there: for exhibits whose parts break or roll away.
    #[serde(default)]
    pub reset: bool,
}

/// A breath: a recording, or synthesised from its strength.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Blow {
    /// WAV file inside the exhibit folder.
    pub wav: Option<String>,
    /// Instead of a recording: speed at the lips over that of the hardest blow (17 m/s), 0 … 1. Gentle is 0.22.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub strength: Option<f64>,
    /// With `strength`: time from zero to the full speed; by default 0.12 s.
    pub attack: Option<Time>,
    /// With `strength`: time at full speed; by default 1.2 s.
    pub hold: Option<Time>,
    /// With `strength`: time from full speed to zero; by default 0.3 s.
    pub release: Option<Time>,
    /// Picture coordinates, (0,0) top left, (1,1) bottom right; by default the centre.
    pub aim: Option<[f64; 2]>,
}

/// Label texts by language code.
#[derive(Debug, Default, Deserialize, JsonSchema)]
pub struct Label {
    /// Language shown first.
    pub default_language: Option<String>,
    /// One table per language.
    #[serde(flatten)]
    pub languages: BTreeMap<String, LabelTexts>,
}

/// The label texts of one language.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct LabelTexts {
    /// Title of the exhibit.
    pub title: String,
    /// Maker.
    pub maker: String,
    /// Wall text.
    pub body: String,
    /// Description for visitors who cannot see it.
    pub alt: String,
    /// Texts by key. `invite` invites to blow; `take` invites the hand, where touch is permitted; a step of the attract script
    /// may show any other.
    pub text: BTreeMap<String, String>,
    /// Captions of sounds by key.
    pub caption: BTreeMap<String, String>,
}

/// Author, licence and rights notice.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Credit {
    /// SPDX id of the model's licence.
    pub model_license: String,
    /// Author of the model.
    pub model_author: String,
    /// Rights notice shown with the label.
    pub notice: String,
    /// Sources of facts on the label.
    pub sources: Vec<String>,
}

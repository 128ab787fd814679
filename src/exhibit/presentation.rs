//! Label texts, credit and attract script of an exhibit.

/// The attract script: what the exhibit does when nobody is there.
#[derive(Clone, Debug, Default)]
pub struct Attract {
    /// Steps in time order; the script repeats after the last.
    pub steps: Vec<AttractStep>,
    /// Length of the script before it repeats, s.
    pub duration: f64,
}

/// One step of the attract script.
#[derive(Clone, Debug)]
pub struct AttractStep {
    /// Time since the script began, s.
    pub at: f64,
    /// What the step does.
    pub action: AttractAction,
}

/// What an attract step does.
#[derive(Clone, Debug)]
pub enum AttractAction {
    /// Shows a text of the labels by its key.
    Show(String),
    /// Plays a recorded breath: mono samples and their rate.
    Blow {
        /// Mono samples, full scale ±1.
        samples: std::sync::Arc<[f32]>,
        /// Hz.
        sample_rate: u32,
        /// Pointer in picture coordinates; `None` is the centre.
        aim: Option<[f64; 2]>,
    },
    /// Orbits the camera, rad: to the right and up from its own position.
    Look([f64; 2]),
    /// Resets the exhibit to its start.
    Reset,
}

/// Label texts by language.
#[derive(Clone, Debug, Default)]
pub struct Labels {
    /// Language code shown first.
    pub default_language: String,
    /// In the order of the file.
    pub languages: Vec<(String, Label)>,
}

impl Labels {
    /// The label in `language`, or in the default one.
    pub fn get(&self, language: &str) -> Option<&Label> {
        let find = |code: &str| self.languages.iter().find(|(c, _)| c == code).map(|(_, label)| label);
        find(language).or_else(|| find(&self.default_language)).or_else(|| self.languages.first().map(|(_, l)| l))
    }
}

/// The label texts of one language.
#[derive(Clone, Debug, Default)]
pub struct Label {
    /// Title of the exhibit.
    pub title: String,
    /// Maker.
    pub maker: String,
    /// Wall text.
    pub body: String,
    /// Description for visitors who cannot see it.
    pub alt: String,
    /// Texts by key: `invite` to blow, `take` to use the hand, …
    pub text: Vec<(String, String)>,
    /// Captions of sounds by key.
    pub caption: Vec<(String, String)>,
}

/// Key of the label text that invites the hand.
pub(super) const TAKE: &str = "take";

impl Label {
    /// The text of a key.
    pub fn text(&self, key: &str) -> Option<&str> {
        self.text.iter().find(|(found, _)| found == key).map(|(_, text)| text.as_str())
    }
}

/// Author, licence and rights notice.
#[derive(Clone, Debug, Default)]
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

//! What visitors read and what an exhibit does when nobody is there.

/// What the exhibit does when nobody is there.
#[derive(Clone, Debug, Default)]
pub struct Attract {
    /// Steps in time order; the script repeats after the last.
    pub steps: Vec<AttractStep>,
    /// Length of one round, s.
    pub duration: f64,
}

/// One step of the attract script.
#[derive(Clone, Debug)]
pub struct AttractStep {
    /// Seconds since the script began.
    pub at: f64,
    /// What happens.
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
    /// Leads the camera round the work, to the right and up from where it stands, rad.
    Look([f64; 2]),
    /// Puts everything back to where it started.
    Reset,
}

/// Words by language.
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

/// Words of one language.
#[derive(Clone, Debug, Default)]
pub struct Label {
    /// Title of the work.
    pub title: String,
    /// Maker.
    pub maker: String,
    /// Wall text.
    pub body: String,
    /// What is to be seen, for those who cannot.
    pub alt: String,
    /// Texts by key (`invite`, …).
    pub text: Vec<(String, String)>,
    /// Captions of sounds by key.
    pub caption: Vec<(String, String)>,
}

/// Who made it, and whose rights it carries.
#[derive(Clone, Debug, Default)]
pub struct Credit {
    /// SPDX id of the model's licence.
    pub model_license: String,
    /// Who made the model.
    pub model_author: String,
    /// Rights notice shown with the label.
    pub notice: String,
    /// Sources of facts on the label.
    pub sources: Vec<String>,
}

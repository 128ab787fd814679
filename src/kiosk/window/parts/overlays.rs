//! Overlays of the picture: the label, the page behind "More", the buttons of both, the language, reading aloud.

use crate::pages::languages::{default_language, languages_without_glyphs, offered, staff_texts};
use crate::pages::menu::Menu;
use crate::pages::overlay::Overlay;
use crate::pages::read_aloud::ReadAloud;
use crate::pages::ui_strings::{Translations, UiStrings};
use crate::visitor::input::Request;
use soffio_config::Config;
use soffio_exhibit::Exhibit;

/// Time for which attract mode shows the invitation in one language, s: two readings of a short line.
const INVITES_S: f64 = 6.0;

/// Overlays of the picture.
pub(crate) struct Overlays {
    /// Overlay with its animations.
    pub overlay: Overlay,
    /// The page of visitors.
    pub menu: Menu,
    /// Reading aloud.
    pub read_aloud: ReadAloud,
    /// Languages on offer and on show.
    pub languages: Languages,
    /// The kiosk's own texts.
    pub translations: Translations,
    /// Areas of the buttons, in points, and their requests.
    pub buttons: Vec<(egui::Rect, Request)>,
}

impl Overlays {
    /// No page is open and no language chosen.
    pub fn new(translations: Translations) -> Self {
        Self {
            overlay: Overlay::default(),
            menu: Menu::default(),
            read_aloud: ReadAloud::default(),
            languages: Languages::new(&translations),
            translations,
            buttons: Vec::new(),
        }
    }

    /// Request of the button at a point; `None` where a press is a breath.
    pub fn button_at(&self, at: egui::Pos2) -> Option<Request> {
        self.buttons.iter().find(|(rect, _)| rect.contains(at)).map(|&(_, request)| request)
    }

    /// Request of the focused button.
    pub fn marked(&self) -> Option<Request> {
        self.menu.focused(&self.buttons)
    }

    /// Moves the focus to the next button in a direction, right and down.
    pub fn move_focus(&mut self, direction: [i32; 2]) {
        self.menu.move_focus(direction, &self.buttons);
        self.read_aloud.announce_focus(self.menu.focused(&self.buttons));
    }
}

/// Languages a visitor can choose from, and the one chosen.
pub(crate) struct Languages {
    /// Codes of the languages on offer, in their order.
    pub offered: Vec<String>,
    /// Languages that the fonts of this system cannot write.
    without_glyphs: Vec<String>,
    /// Code of the language on show; empty: none yet.
    pub shown: String,
}

impl Languages {
    /// No language is offered yet.
    fn new(translations: &Translations) -> Self {
        let without_glyphs = languages_without_glyphs(translations);
        Self { offered: Vec::new(), without_glyphs, shown: String::new() }
    }

    /// Offers the languages of the exhibit's labels. If the language on show is not among them, the default one is shown.
    pub fn offer(&mut self, context: &egui::Context, exhibit: &Exhibit, config: &Config, translations: &Translations) {
        self.offered = offered(context, &exhibit.labels, config, translations, &self.without_glyphs);
        if !self.offered.contains(&self.shown) {
            self.shown = default_language(&self.offered, &exhibit.labels, config);
        }
    }

    /// Texts of the staff panel.
    pub fn staff<'a>(&self, config: &Config, translations: &'a Translations) -> &'a UiStrings {
        staff_texts(translations, config, &self.without_glyphs)
    }

    /// Shows the language at this index.
    pub fn choose(&mut self, index: usize) {
        self.shown = self.offered.get(index).cloned().unwrap_or_default();
    }

    /// Shows the next language.
    pub fn next(&mut self) {
        let shown = self.offered.iter().position(|code| *code == self.shown);
        self.choose(shown.map_or(0, |shown| (shown + 1) % self.offered.len()));
    }

    /// Language of the invitation: the one on show, or in attract mode one after another.
    pub fn inviting(&self, attracts: bool, time: f64) -> &str {
        let turn = (time / INVITES_S) as usize % self.offered.len().max(1);
        let inviting = if attracts { self.offered.get(turn) } else { None };
        inviting.unwrap_or(&self.shown)
    }
}

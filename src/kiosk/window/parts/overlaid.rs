//! What lies over the picture: the overlay, the page behind "More", the buttons of both, the language, the voice that reads.

use crate::pages::languages::{default_language, languages_without_glyphs, offered};
use crate::pages::menu::Menu;
use crate::pages::overlay::Overlay;
use crate::pages::read_aloud::ReadAloud;
use crate::pages::ui_strings::Translations;
use crate::visitor::input::Request;
use soffio_config::Config;
use soffio_exhibit::Exhibit;

/// While attract mode plays the invitation goes to the next language after so long, s: two readings of a short line.
const INVITES_S: f64 = 6.0;

/// The pages over the picture.
pub(crate) struct Overlaid {
    pub overlay: Overlay,
    pub menu: Menu,
    pub aloud: ReadAloud,
    pub languages: Languages,
    /// The kiosk's own texts.
    pub translations: Translations,
    /// Where a press is not a breath, in points.
    pub buttons: Vec<(egui::Rect, Request)>,
}

impl Overlaid {
    /// No page is open and no language chosen.
    pub fn new(translations: Translations) -> Self {
        Self {
            overlay: Overlay::default(),
            menu: Menu::default(),
            aloud: ReadAloud::default(),
            languages: Languages::new(&translations),
            translations,
            buttons: Vec::new(),
        }
    }

    /// What a press at a point of the picture asks for, where it is not a breath.
    pub fn button_at(&self, at: egui::Pos2) -> Option<Request> {
        self.buttons.iter().find(|(rect, _)| rect.contains(at)).map(|&(_, request)| request)
    }

    /// What the button asks for that the keys have reached.
    pub fn marked(&self) -> Option<Request> {
        self.menu.focused(&self.buttons)
    }

    /// The keys go on to the next button that way.
    pub fn look(&mut self, way: [i32; 2]) {
        self.menu.move_focus(way, &self.buttons);
        self.aloud.announce_focus(self.menu.focused(&self.buttons));
    }
}

/// Languages a visitor can choose from, and the one chosen.
pub(crate) struct Languages {
    pub offered: Vec<String>,
    /// Those that this system's fonts cannot write.
    without_glyphs: Vec<String>,
    /// Empty: none yet.
    pub shown: String,
}

impl Languages {
    /// None is offered yet.
    fn new(translations: &Translations) -> Self {
        let without_glyphs = languages_without_glyphs(translations);
        Self { offered: Vec::new(), without_glyphs, shown: String::new() }
    }

    /// Offers those of an exhibit; one that it does not have gives way to the first.
    pub fn offer(&mut self, context: &egui::Context, exhibit: &Exhibit, config: &Config, translations: &Translations) {
        self.offered = offered(context, &exhibit.labels, config, translations, &self.without_glyphs);
        if !self.offered.contains(&self.shown) {
            self.shown = default_language(&self.offered, &exhibit.labels, config);
        }
    }

    /// Shows the one at a place among those offered.
    pub fn choose(&mut self, index: usize) {
        self.shown = self.offered.get(index).cloned().unwrap_or_default();
    }

    /// Shows the next one.
    pub fn next(&mut self) {
        let shown = self.offered.iter().position(|code| *code == self.shown);
        self.choose(shown.map_or(0, |shown| (shown + 1) % self.offered.len()));
    }

    /// The one to invite in: the one shown, or, while attract mode plays, one after another.
    pub fn inviting(&self, attracts: bool, time: f64) -> &str {
        let turn = (time / INVITES_S) as usize % self.offered.len().max(1);
        let inviting = if attracts { self.offered.get(turn) } else { None };
        inviting.unwrap_or(&self.shown)
    }
}

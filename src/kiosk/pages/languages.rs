//! Which languages a visitor can choose from, and which one is found.

use crate::pages::fonts;
use crate::pages::words::{WORDS, language_name};
use soffio_config::Config;
use soffio_exhibit::{Label, Labels};

/// The languages a visitor can choose from, in the order they are offered: those of the exhibit that the site wants
/// and the fonts can write, but for those whose words of the kiosk's own they cannot, [`unwritten`].
pub fn offered(context: &egui::Context, labels: &Labels, config: &Config, unwritten: &[&str]) -> Vec<String> {
    let can_write = |(code, label): &&(String, Label)| {
        let title = format!("{}{}", language_name(code), label.title);
        !unwritten.contains(&code.as_str()) && has_glyphs(context, &title)
    };
    let has: Vec<&String> = labels.languages.iter().filter(can_write).map(|(code, _)| code).collect();
    let wanted: Vec<String> = config.languages.offered.iter().filter(|code| has.contains(code)).cloned().collect();
    if wanted.is_empty() { has.into_iter().cloned().collect() } else { wanted }
}

/// The language that a visitor finds: the site's, else the exhibit's, else whatever there is.
pub fn default_language(offered: &[String], labels: &Labels, config: &Config) -> String {
    let wanted = [&config.languages.first, &labels.default_language];
    wanted.into_iter().find(|code| offered.contains(code)).or(offered.first()).cloned().unwrap_or_default()
}

/// Codes of the languages the kiosk speaks that this system's fonts cannot write.
pub fn languages_without_glyphs() -> Vec<&'static str> {
    let context = egui::Context::default();
    context.set_fonts(fonts::definitions());
    let mut unwritten = Vec::new();
    // Fonts are there from the first frame on.
    let mut laid_out = context.run_ui(egui::RawInput::default(), |ui| {
        let words = WORDS.iter().filter(|words| !words.all().iter().all(|text| has_glyphs(ui.ctx(), text)));
        unwritten = words.map(|words| words.code).collect();
    });
    laid_out.textures_delta.clear();
    unwritten
}

fn has_glyphs(context: &egui::Context, text: &str) -> bool {
    context.fonts_mut(|fonts| fonts.has_glyphs(&egui::FontId::default(), text))
}

//! Languages offered to visitors, and the one they find first.

use crate::pages::fonts;
use crate::pages::ui_strings::{Translations, UiStrings};
use soffio_config::Config;
use soffio_exhibit::{Label, Labels};

/// Codes of the languages offered, in order: those of the exhibit's labels that the configuration wants and the fonts can
/// write, without those in `without_glyphs` (see [`languages_without_glyphs`]).
pub fn offered(
    context: &egui::Context,
    labels: &Labels,
    config: &Config,
    translations: &Translations,
    without_glyphs: &[String],
) -> Vec<String> {
    let writable = |(code, label): &&(String, Label)| {
        let title = format!("{}{}", translations.language_name(code), label.title);
        !without_glyphs.contains(code) && has_glyphs(context, &title)
    };
    let has: Vec<&String> = labels.languages.iter().filter(writable).map(|(code, _)| code).collect();
    let wanted: Vec<String> = config.languages.offered.iter().filter(|code| has.contains(code)).cloned().collect();
    if wanted.is_empty() { has.into_iter().cloned().collect() } else { wanted }
}

/// The language that visitors find: the configured one, else the exhibit's, else the first one offered.
pub fn default_language(offered: &[String], labels: &Labels, config: &Config) -> String {
    let wanted = [&config.languages.first, &labels.default_language];
    wanted.into_iter().find(|code| offered.contains(code)).or(offered.first()).cloned().unwrap_or_default()
}

/// The texts of the staff panel: in the configured language, else in the language that visitors find first, else in English.
/// Languages in `without_glyphs` give way to English.
pub fn staff_texts<'a>(translations: &'a Translations, config: &Config, without_glyphs: &[String]) -> &'a UiStrings {
    let configured = [&config.staff.language, &config.languages.first];
    let language = configured.into_iter().find(|code| !code.is_empty()).map_or("en", String::as_str);
    let texts = translations.get(language);
    if without_glyphs.iter().any(|code| code == texts.code()) { translations.get("en") } else { texts }
}

/// Codes of the kiosk's own languages that the fonts of this system cannot write.
pub fn languages_without_glyphs(translations: &Translations) -> Vec<String> {
    let context = egui::Context::default();
    context.set_fonts(fonts::definitions());
    let mut without = Vec::new();
    // Fonts exist from the first frame on.
    let mut laid_out = context.run_ui(egui::RawInput::default(), |ui| {
        let lacks = translations.languages().filter(|texts| !texts.all().all(|text| has_glyphs(ui.ctx(), &text)));
        without = lacks.map(|texts| texts.code().to_owned()).collect();
    });
    laid_out.textures_delta.clear();
    without
}

fn has_glyphs(context: &egui::Context, text: &str) -> bool {
    context.fonts_mut(|fonts| fonts.has_glyphs(&egui::FontId::default(), text))
}

//! Which languages a visitor can choose from, and which one is found.

use super::words::language_name;
use crate::config::Config;
use crate::exhibit::{Label, Labels};

/// The languages a visitor can choose from, in the order they are offered: those of the exhibit that the site wants
/// and the fonts can write.
pub fn offered(context: &egui::Context, labels: &Labels, config: &Config) -> Vec<String> {
    let can_write = |(code, label): &&(String, Label)| {
        let text = format!("{}{}", language_name(code), label.title);
        context.fonts_mut(|fonts| fonts.has_glyphs(&egui::FontId::default(), &text))
    };
    let has: Vec<&String> = labels.languages.iter().filter(can_write).map(|(code, _)| code).collect();
    let wanted: Vec<String> = config.languages.offered.iter().filter(|code| has.contains(code)).cloned().collect();
    if wanted.is_empty() { has.into_iter().cloned().collect() } else { wanted }
}

/// The language that a visitor finds: the site's, else the exhibit's, else whatever there is.
pub fn first(offered: &[String], labels: &Labels, config: &Config) -> String {
    let wanted = [&config.languages.first, &labels.default_language];
    wanted.into_iter().find(|code| offered.contains(code)).or(offered.first()).cloned().unwrap_or_default()
}

//! Texts for reading aloud: the page's contents as sentences in the current language.

use crate::pages::overlay::Scene;
use crate::pages::ui_strings::TextId;
use crate::visitor::input::Request;

/// A text to be read aloud.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SpokenText {
    /// The text, in sentences.
    pub text: String,
    /// Code of its language, such as `de` or `pt-BR`.
    pub language: String,
}

/// The exhibit: title, maker, description, wall text, how to play, and rights.
pub fn exhibit(scene: &Scene) -> Vec<SpokenText> {
    let texts = scene.texts();
    let Some(label) = scene.exhibit.labels.get(scene.language) else { return Vec::new() };
    let invite =
        if scene.breath_input.is_active && scene.breath_input.is_allowed { texts.get(TextId::Invite) } else { "" };
    let hold = texts.get(scene.how_to_blow());
    let sound = if scene.exhibit.sounds.is_empty() { texts.get(TextId::NoSound) } else { "" };
    let privacy = if scene.breath_input.is_active { texts.get(TextId::Privacy) } else { "" };
    let parts = [
        &label.title,
        &label.maker,
        &label.alt,
        &label.body,
        invite,
        texts.get(TextId::Aim),
        hold,
        scene.how_to_take(),
        sound,
        privacy,
        &scene.exhibit.credit.notice,
    ];
    vec![SpokenText { text: sentences(parts), language: scene.language.to_owned() }]
}

/// The name of a button and, for a switch, its state.
pub fn button(request: Request, scene: &Scene) -> Vec<SpokenText> {
    let texts = scene.texts();
    let settings = scene.accessibility;
    let name = |id| texts.get(id).to_owned();
    let switch = |id, on: bool| format!("{}: {}", texts.get(id), texts.get(if on { TextId::On } else { TextId::Off }));
    let text = match request {
        Request::Menu => name(TextId::Back),
        Request::Exhibit(index) => scene.tiles.get(index).map(|tile| tile.title.clone()).unwrap_or_default(),
        Request::Page(by) => name(if by > 0 { TextId::NextPage } else { TextId::PreviousPage }),
        Request::Louder(by) => name(if by > 0 { TextId::Louder } else { TextId::Softer }),
        Request::Large => switch(TextId::LargeText, settings.text.large),
        Request::Contrast => switch(TextId::HighContrast, settings.text.contrast),
        Request::PressOnce => switch(TextId::PressOnce, settings.press_once),
        Request::Dwell => switch(TextId::Dwell, settings.dwell),
        Request::ReducedMotion => switch(TextId::LessMotion, settings.reduced_motion),
        Request::LookAround => switch(TextId::LookRound, settings.look_around),
        Request::ToggleMicrophone => switch(TextId::Microphone, scene.breath_input.microphone_on),
        Request::ReadAloud => name(TextId::ReadAloud),
        // A language is announced by its own name, in its own voice.
        Request::Language(index) => {
            let code = scene.languages.get(index).cloned().unwrap_or_default();
            return vec![SpokenText { text: scene.translations.language_name(&code).to_owned(), language: code }];
        }
        _ => String::new(),
    };
    vec![SpokenText { text, language: scene.language.to_owned() }]
}

/// Joins texts as sentences, so that the voice pauses after each.
fn sentences<'a>(parts: impl IntoIterator<Item = &'a str>) -> String {
    let mut all = String::new();
    for part in parts.into_iter().map(str::trim).filter(|part| !part.is_empty()) {
        all.push_str(part);
        let ends = part.ends_with(['.', '!', '?', '…', '。', '！', '？', ':']);
        all.push_str(if ends { "\n" } else { ".\n" });
    }
    all
}

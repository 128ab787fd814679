//! What is read aloud: all that a visitor would have to see, as sentences in the language shown.

use crate::pages::overlay::Scene;
use crate::pages::words::{language_name, words};
use crate::visitor::input::Request;

/// A text and its language.
pub type Utterance = (String, String);

/// The work, its label and how it is played: title, maker, what is to be seen, the wall text, help and rights.
pub fn exhibit(scene: &Scene) -> Vec<Utterance> {
    let own = words(scene.language);
    let Some(label) = scene.exhibit.labels.get(scene.language) else { return Vec::new() };
    let invite = if scene.breath_input.is_active && scene.breath_input.is_allowed { own.invite } else { "" };
    let hold = own.how(scene.accessibility);
    let sound = if scene.exhibit.sounds.is_empty() { own.no_sound } else { "" };
    let privacy = if scene.breath_input.is_active { own.privacy } else { "" };
    let parts = [
        &label.title,
        &label.maker,
        &label.alt,
        &label.body,
        invite,
        own.aim,
        hold,
        own.take,
        sound,
        privacy,
        &scene.exhibit.credit.notice,
    ];
    vec![(sentences(parts), scene.language.to_owned())]
}

/// A button of the page, as its name and, where it is a switch, how it stands.
pub fn button(request: Request, scene: &Scene) -> Vec<Utterance> {
    let own = words(scene.language);
    let switch = |name: &str, on: bool| format!("{name}: {}", if on { own.on } else { own.off });
    let text = match request {
        Request::Menu => own.back.to_owned(),
        Request::Work(index) => scene.tiles.get(index).map(|tile| tile.title.clone()).unwrap_or_default(),
        Request::Leaf(by) => if by > 0 { own.next } else { own.previous }.to_owned(),
        Request::Louder(by) => if by > 0 { own.louder } else { own.softer }.to_owned(),
        Request::Large => switch(own.large, scene.accessibility.reading.large),
        Request::Contrast => switch(own.contrast, scene.accessibility.reading.contrast),
        Request::PressOnce => switch(own.press_once, scene.accessibility.press_once),
        Request::Dwell => switch(own.dwell, scene.accessibility.dwell),
        Request::Calm => switch(own.calm, scene.accessibility.calm),
        Request::Round => switch(own.round, scene.accessibility.round),
        Request::Listen => switch(own.ear, scene.breath_input.microphone_on),
        Request::Speak => own.speak.to_owned(),
        // Each language by its own name, in its own voice.
        Request::Language(index) => {
            let code = scene.languages.get(index).cloned().unwrap_or_default();
            return vec![(language_name(&code).to_owned(), code)];
        }
        _ => String::new(),
    };
    vec![(text, scene.language.to_owned())]
}

/// Texts as sentences: a voice falls at each one's end.
fn sentences<'a>(parts: impl IntoIterator<Item = &'a str>) -> String {
    let mut all = String::new();
    for part in parts.into_iter().map(str::trim).filter(|part| !part.is_empty()) {
        all.push_str(part);
        let ends = part.ends_with(['.', '!', '?', '…', '。', '！', '？', ':']);
        all.push_str(if ends { "\n" } else { ".\n" });
    }
    all
}

//! Old names in JSON: a walk over its tokens.

use super::{FileKind, Place, Replacement};

/// What the walk is inside of.
#[derive(Clone, Copy, Debug)]
enum Container {
    /// An object whose own path has so many keys.
    Object(usize),
    /// A list: its entries have its own path.
    List,
}

/// All old names in the text, in its order; none in a text that is no JSON.
pub(super) fn replacements(kind: FileKind, text: &str) -> Vec<Replacement> {
    if serde_json::from_str::<serde::de::IgnoredAny>(text).is_err() {
        return Vec::new();
    }
    let mut place = Place::new(kind);
    let mut inside: Vec<Container> = Vec::new();
    let mut at = 0;
    while let Some(next) = text[at..].find(['"', '{', '}', '[', ']', ',']) {
        at += next;
        let end = if text.as_bytes()[at] == b'"' { at + length_of_text(&text[at..]) } else { at + 1 };
        match text.as_bytes()[at] {
            b'{' => inside.push(Container::Object(place.path.len())),
            b'[' => inside.push(Container::List),
            b'}' | b']' => {
                if let Some(Container::Object(keys)) = inside.pop() {
                    place.path.truncate(keys);
                }
            }
            b',' => {
                if let Some(Container::Object(keys)) = inside.last() {
                    place.path.truncate(*keys);
                }
            }
            _ => {
                let content: String = serde_json::from_str(&text[at..end]).unwrap_or_default();
                if text[end..].trim_start().starts_with(':') {
                    place.enter(content, at..end, true);
                } else {
                    place.value(&content, at..end);
                }
            }
        }
        at = end;
    }
    place.found
}

/// Bytes of the text, quotes included, with which this begins.
fn length_of_text(text: &str) -> usize {
    let mut escaped = false;
    let end = text.bytes().enumerate().skip(1).find(|(_, byte)| {
        let ends = *byte == b'"' && !escaped;
        escaped = *byte == b'\\' && !escaped;
        ends
    });
    end.map_or(text.len(), |(end, _)| end + 1)
}

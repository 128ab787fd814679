//! Text of files as it may be shown on a terminal or written to a log.
//!
//! Names in a model or a sidecar may contain any character. Escape sequences could rewrite what a terminal shows, and marks of
//! writing direction could turn a line around; both are shown by their number instead.

use std::borrow::Cow;
use std::fmt::Write;

/// Does a terminal act on this character instead of showing it?
fn acts(c: char) -> bool {
    // Control characters of ASCII and of Latin-1, and the marks of direction of UAX 9.
    c.is_control()
        || matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

/// The text with every character that acts on a terminal as an escape such as `\u{1b}`. A line break stays one where `lines` is set.
pub fn escaped(text: &str, lines: bool) -> Cow<'_, str> {
    let shown = |c: char| !acts(c) || (lines && matches!(c, '\n' | '\t'));
    if text.chars().all(shown) {
        return text.into();
    }
    let mut out = String::with_capacity(text.len() + 16);
    for c in text.chars() {
        if shown(c) {
            out.push(c);
        } else {
            // Writing to a string cannot fail.
            let _ = write!(out, "{}", c.escape_unicode());
        }
    }
    out.into()
}

/// A message of one line.
pub fn line(text: &str) -> Cow<'_, str> {
    escaped(text, false)
}

/// A text of several lines.
pub fn lines(text: &str) -> Cow<'_, str> {
    escaped(text, true)
}

/// JSON text of one line: the same value, with such characters escaped as JSON does it.
pub fn json(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        if acts(c) {
            // All of them are below U+10000. Writing to a string cannot fail.
            let _ = write!(out, "\\u{:04x}", u32::from(c));
        } else {
            out.push(c);
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_acts_on_a_terminal_is_shown_by_its_number() {
        assert_eq!(line("a\x1b[31m\u{9b}2J\u{202e}b\r\n"), r"a\u{1b}[31m\u{9b}2J\u{202e}b\u{d}\u{a}");
        assert_eq!(lines("a\n\tb\x07"), "a\n\tb\\u{7}");
        let value = serde_json::json!({ "a": "\u{9b}2J\u{202e}\n" });
        let json = json(&value.to_string());
        assert!(
            !json.contains(acts) && serde_json::from_str::<serde_json::Value>(&json).is_ok_and(|read| read == value)
        );
        assert!(matches!(line("Größe 12 × 3 שלום 日本語 \"x\\y\""), Cow::Borrowed(_)), "ordinary text stays");
    }
}

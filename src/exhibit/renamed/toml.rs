//! Old names in TOML: a walk over the parser's events, which say where each key and value stands.

use std::ops::Range;

use toml_parser::decoder::ScalarKind;
use toml_parser::parser::{Event, EventKind, RecursionGuard, parse_document};
use toml_parser::{Source, Span};

use super::{FileKind, Place, Replacement};

/// Deepest nesting of inline tables and lists.
const DEEPEST: u32 = 80;

/// What the walk is inside of.
#[derive(Clone, Copy, Debug)]
enum Container {
    /// A table whose own path has so many keys.
    Table(usize),
    /// A list: its entries have its own path.
    List,
}

/// All old names in the text, in its order.
pub(super) fn replacements(kind: FileKind, text: &str) -> Vec<Replacement> {
    let source = Source::new(text);
    let tokens = source.lex().into_vec();
    let mut events: Vec<Event> = Vec::new();
    let mut guard = RecursionGuard::new(&mut events, DEEPEST);
    // Mistakes are the reader's to report.
    parse_document(&tokens, &mut guard, &mut ());
    let mut place = Place::new(kind);
    let mut inside = vec![Container::Table(0)];
    for event in &events {
        let Some(raw) = source.get(event) else { continue };
        match event.kind() {
            EventKind::StdTableOpen | EventKind::ArrayTableOpen => {
                place.path.clear();
                inside = vec![Container::Table(0)];
            }
            EventKind::StdTableClose | EventKind::ArrayTableClose => inside = vec![Container::Table(place.path.len())],
            EventKind::SimpleKey => {
                let mut key = std::borrow::Cow::Borrowed("");
                raw.decode_key(&mut key, &mut ());
                place.enter(key.into_owned(), bytes(event.span()), false);
            }
            EventKind::Scalar => {
                let mut value = std::borrow::Cow::Borrowed("");
                if raw.decode_scalar(&mut value, &mut ()) == ScalarKind::String {
                    place.value(&value, bytes(event.span()));
                }
                end_of_value(&inside, &mut place);
            }
            EventKind::InlineTableOpen => inside.push(Container::Table(place.path.len())),
            EventKind::ArrayOpen => inside.push(Container::List),
            EventKind::InlineTableClose | EventKind::ArrayClose => {
                if let Some(Container::Table(keys)) = inside.pop() {
                    place.path.truncate(keys);
                }
                end_of_value(&inside, &mut place);
            }
            _ => {}
        }
    }
    place.found
}

/// After a value of a table its key is left; the next entry of a list has the same path.
fn end_of_value(inside: &[Container], place: &mut Place) {
    if let Some(Container::Table(keys)) = inside.last() {
        place.path.truncate(*keys);
    }
}

fn bytes(span: Span) -> Range<usize> {
    span.start()..span.end()
}

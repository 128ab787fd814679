//! The sidecar's text, its values as JSON, and the position of each value: JSON pointer → bytes.
//!
//! Both the schema check and the semantic checks name places by JSON pointers (`/body/2/node`). Keys that begin with
//! `x_` belong to other programs and are left out.

use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;

use serde_json::{Map, Number, Value};
use toml_edit::{Document, Item, TableLike};

use super::codes;
use super::diagnostic::{Diagnostic, Location};
use super::renamed::{self, FileKind, Updated};

/// A parsed sidecar.
#[derive(Clone, Debug)]
pub struct SidecarText {
    /// Name of the file for messages.
    pub file: String,
    /// The text of the file, old names included.
    text: Arc<str>,
    /// What is parsed: the text with new names. Spans are those of this text.
    updated: Updated<'static>,
    /// The values without `x_` keys.
    pub value: Value,
    values: BTreeMap<String, Range<usize>>,
    keys: BTreeMap<String, Range<usize>>,
}

impl SidecarText {
    /// Parses the text of a sidecar, TOML. `file` is its name in messages; old names of keys are read as the new ones.
    ///
    /// # Errors
    /// The syntax error, with its position.
    pub fn parse(file: &str, text: &str) -> Result<Self, Diagnostic> {
        let Updated { text: parsed, replacements } = renamed::update(FileKind::Sidecar, text);
        let mut source = Self {
            file: file.to_owned(),
            text: text.into(),
            updated: Updated { text: parsed.clone().into_owned().into(), replacements },
            value: Value::Null,
            values: BTreeMap::new(),
            keys: BTreeMap::new(),
        };
        match Document::parse(&*parsed) {
            Ok(document) => {
                source.value = source.table(document.as_table(), "");
                source.values.insert(String::new(), 0..parsed.lines().next().map_or(0, str::len));
                Ok(source)
            }
            Err(error) => {
                let span = error.span().unwrap_or(0..0);
                let mut diagnostic = match source.updated.duplicate(text, span.clone()) {
                    Some(name) => Diagnostic::new(codes::SYNTAX, name.duplicate_message()).help(name.duplicate_help()),
                    None => Diagnostic::new(codes::SYNTAX, format!("this is not TOML: {}", error.message()))
                        .help("see https://toml.io; a text needs quotes, a table name brackets"),
                };
                diagnostic.location = Some(source.locate(span));
                Err(diagnostic)
            }
        }
    }

    fn table(&mut self, table: &dyn TableLike, path: &str) -> Value {
        let mut map = Map::new();
        for (name, item) in table.iter() {
            if name.starts_with("x_") {
                continue;
            }
            let below = join(path, name);
            if let Some(span) = table.key(name).and_then(toml_edit::Key::span) {
                self.keys.insert(below.clone(), span);
            }
            let value = self.item(item, &below);
            map.insert(name.to_owned(), value);
        }
        Value::Object(map)
    }

    fn item(&mut self, item: &Item, path: &str) -> Value {
        if let Some(span) = item.span() {
            self.values.insert(path.to_owned(), span);
        }
        match item {
            Item::None => Value::Null,
            Item::Value(value) => self.plain(value, path),
            Item::Table(table) => self.table(table, path),
            Item::ArrayOfTables(array) => {
                let items = array.iter().enumerate().map(|(i, table)| {
                    let below = join(path, &i.to_string());
                    if let Some(span) = table.span() {
                        self.values.insert(below.clone(), span);
                    }
                    self.table(table, &below)
                });
                Value::Array(items.collect())
            }
        }
    }

    fn plain(&mut self, value: &toml_edit::Value, path: &str) -> Value {
        if let Some(span) = value.span() {
            self.values.insert(path.to_owned(), span);
        }
        match value {
            toml_edit::Value::String(text) => Value::String(text.value().clone()),
            toml_edit::Value::Integer(number) => Value::Number((*number.value()).into()),
            // JSON cannot hold inf and nan: they become texts, which the schema check refuses in place, or accepts as a
            // time that never comes.
            toml_edit::Value::Float(number) => {
                let number = *number.value();
                Number::from_f64(number).map_or_else(|| Value::String(number.to_string()), Value::Number)
            }
            toml_edit::Value::Boolean(flag) => Value::Bool(*flag.value()),
            toml_edit::Value::Datetime(time) => Value::String(time.value().to_string()),
            toml_edit::Value::Array(array) => {
                let items = array.iter().enumerate().map(|(i, item)| self.plain(item, &join(path, &i.to_string())));
                Value::Array(items.collect())
            }
            toml_edit::Value::InlineTable(table) => self.table(table, path),
        }
    }

    /// Bytes of the value at a pointer, or of the nearest value around it.
    pub fn span(&self, pointer: &str) -> Range<usize> {
        nearest(&self.values, pointer)
    }

    /// Bytes of the key at a pointer, or of its value.
    pub fn key_span(&self, pointer: &str) -> Range<usize> {
        self.keys.get(pointer).cloned().unwrap_or_else(|| self.span(pointer))
    }

    /// Line (from 1) of the value at a pointer.
    pub fn line(&self, pointer: &str) -> usize {
        self.locate(self.span(pointer)).line
    }

    /// Keys of the table at a pointer, in the order of the file.
    pub fn keys_of(&self, pointer: &str) -> Vec<String> {
        let depth = pointer.len() + 1;
        let start = format!("{pointer}/");
        let mut keys: Vec<(usize, String)> = self
            .keys
            .iter()
            .filter(|(path, _)| path.starts_with(&start) && !path[depth..].contains('/'))
            .map(|(path, span)| (span.start, unescape(&path[depth..])))
            .collect();
        keys.sort();
        keys.into_iter().map(|(_, key)| key).collect()
    }

    /// A warning for each old name.
    pub fn old_names(&self) -> impl Iterator<Item = Diagnostic> {
        let file = &self.file;
        self.updated.replacements.iter().map(move |name| {
            let mut diagnostic = Diagnostic::new(codes::OLD_NAME, name.to_string())
                .label("old name")
                .help(format!("`soffio check --fix {file}` rewrites the file"));
            diagnostic.location = Some(self.place(name.span.clone()));
            diagnostic
        })
    }

    /// Line and column of a range of bytes of the parsed text. A range over several lines (a table) is cut after its first.
    pub fn locate(&self, span: Range<usize>) -> Location {
        self.place(self.updated.original(span))
    }

    /// Line and column of bytes of the file.
    fn place(&self, span: Range<usize>) -> Location {
        let start = span.start.min(self.text.len());
        let before = self.text.get(..start).unwrap_or_default();
        let line_start = before.rfind('\n').map_or(0, |i| i + 1);
        let rest = self.text.get(start..).unwrap_or_default();
        let end = span.end.clamp(start, start + rest.find('\n').unwrap_or(rest.len()));
        Location {
            file: self.file.clone(),
            line: before.matches('\n').count() + 1,
            column: before[line_start..].chars().count() + 1,
            span: start..end,
        }
    }
}

fn nearest(map: &BTreeMap<String, Range<usize>>, pointer: &str) -> Range<usize> {
    let mut path = pointer;
    loop {
        if let Some(span) = map.get(path) {
            return span.clone();
        }
        match path.rfind('/') {
            Some(i) => path = &path[..i],
            None => return 0..0,
        }
    }
}

/// Appends a key to a JSON pointer (RFC 6901).
pub fn join(path: &str, key: &str) -> String {
    format!("{path}/{}", key.replace('~', "~0").replace('/', "~1"))
}

/// Sort key for natural order, `Rod.9` before `Rod.10`: texts and the numbers after them, in turn.
pub fn natural_key(name: &str) -> Vec<(&str, u64)> {
    let mut key = Vec::new();
    let mut rest = name;
    while !rest.is_empty() {
        let (text, after) = rest.split_at(rest.find(|c: char| c.is_ascii_digit()).unwrap_or(rest.len()));
        let (digits, after) = after.split_at(after.find(|c: char| !c.is_ascii_digit()).unwrap_or(after.len()));
        let number = digits.bytes().fold(0_u64, |n, b| n.saturating_mul(10).saturating_add(u64::from(b - b'0')));
        key.push((text, number));
        rest = after;
    }
    key
}

fn unescape(key: &str) -> String {
    key.replace("~1", "/").replace("~0", "~")
}

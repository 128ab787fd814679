//! Edits numbers and lists in a curator's files in place: comments, order and units stay.

use std::collections::VecDeque;
use std::path::{Path, PathBuf};

use toml_edit::{Array, DocumentMut, Formatted, Item, Table, TableLike, Value};

use soffio_exhibit::files::{self, MAX_SIDECAR_BYTES};
use soffio_offline::atomic_file::{Readers, replace as replace_file};

/// Tables of a sidecar whose numbers are no parameters of the exhibit: texts and the attract script.
const NOT_OFFERED: [&str; 3] = ["label", "attract", "credit"];
/// Keys whose numbers are names, not quantities.
const NAMES: [&str; 2] = ["seed", "schema"];
/// Number of changes that can be undone.
const REMEMBERED: usize = 50;

/// One step of the path to a value.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Step {
    /// Into a table.
    Key(String),
    /// Into an array of tables.
    Index(usize),
}

/// A number of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Number {
    /// Path to it.
    pub place: Vec<Step>,
    /// Readable name of its table: `material.steel`, `constraint.nail cup-on-point`.
    pub of: String,
    /// Its name there: `friction.coefficient`.
    pub name: String,
    /// Value in the file.
    pub value: f64,
    /// Unit in the file; empty for a bare number.
    pub unit: String,
    /// Is it written as an integer?
    pub whole: bool,
}

/// All numbers of a sidecar, `text` in TOML, that a curator may change, in the order of the file.
///
/// # Errors
/// The text is no TOML; the parser's message.
pub fn numbers(text: &str) -> Result<Vec<Number>, String> {
    let document: DocumentMut = text.parse().map_err(|error: toml_edit::TomlError| error.to_string())?;
    let mut found = Vec::new();
    for (name, item) in document.iter().filter(|(name, _)| !NOT_OFFERED.contains(name)) {
        item_numbers(item, &mut vec![Step::Key(name.to_owned())], &mut found);
    }
    for number in &mut found {
        (number.of, number.name) = called(&document, &number.place);
    }
    Ok(found)
}

fn item_numbers(item: &Item, place: &mut Vec<Step>, found: &mut Vec<Number>) {
    if let Some(table) = item.as_table_like() {
        for (name, item) in table.iter() {
            place.push(Step::Key(name.to_owned()));
            item_numbers(item, place, found);
            place.pop();
        }
    } else if let Some(tables) = item.as_array_of_tables() {
        for (index, table) in tables.iter().enumerate() {
            place.push(Step::Index(index));
            for (name, item) in table.iter() {
                place.push(Step::Key(name.to_owned()));
                item_numbers(item, place, found);
                place.pop();
            }
            place.pop();
        }
    } else if !matches!(place.last(), Some(Step::Key(name)) if NAMES.contains(&name.as_str()))
        && let Some(WrittenNumber { value, unit, whole }) = item.as_value().and_then(number)
    {
        found.push(Number { place: place.clone(), of: String::new(), name: String::new(), value, unit, whole });
    }
}

/// A number as it is written in the file.
struct WrittenNumber {
    value: f64,
    /// Empty for a bare number.
    unit: String,
    /// Is it written as an integer?
    whole: bool,
}

/// The finite number that a value is, with its unit.
fn number(value: &Value) -> Option<WrittenNumber> {
    let bare = |value, whole| WrittenNumber { value, unit: String::new(), whole };
    match value {
        Value::Integer(value) => Some(bare(*value.value() as f64, true)),
        Value::Float(value) => Some(bare(*value.value(), false)).filter(|number| number.value.is_finite()),
        Value::String(text) => {
            let (number, unit) = text.value().trim().split_once(' ')?;
            let value: f64 = number.parse().ok().filter(|value: &f64| value.is_finite())?;
            let known = unit.chars().all(|c| c.is_alphanumeric() || "/% ²³".contains(c));
            known.then(|| WrittenNumber { value, unit: unit.trim().to_owned(), whole: false })
        }
        _ => None,
    }
}

/// Readable names of table and key: tables of an array are named by their `name` or `node`.
fn called(document: &Table, place: &[Step]) -> (String, String) {
    let (mut of, mut table): (String, Option<&dyn TableLike>) = (String::new(), Some(document));
    let mut cut = place.len().min(2);
    let mut tables = None;
    for (depth, step) in place.iter().enumerate() {
        match step {
            Step::Key(key) => {
                let item = table.and_then(|table| table.get(key));
                (table, tables) = (item.and_then(Item::as_table_like), item.and_then(Item::as_array_of_tables));
                if depth < cut && depth + 1 < place.len() {
                    of += if of.is_empty() { "" } else { "." };
                    of += key;
                    // An array of tables belongs to its name.
                    cut += usize::from(tables.is_some() && depth + 1 == cut);
                }
            }
            Step::Index(index) => {
                let own = tables.and_then(|tables| tables.get(*index));
                let name = own.and_then(|own| {
                    ["name", "node", "body"].iter().find_map(|key| own.get(key).and_then(Item::as_str))
                });
                of += &name.map_or_else(|| format!(" {}", index + 1), |name| format!(" {name}"));
                (table, cut) = (own.map(|own| own as &dyn TableLike), depth + 1);
            }
        }
    }
    let rest = place.iter().skip(cut.min(place.len() - 1)).filter_map(|step| match step {
        Step::Key(key) => Some(key.as_str()),
        Step::Index(_) => None,
    });
    (of, rest.collect::<Vec<_>>().join("."))
}

/// The text with `value` at this place, rounded to four digits, in the unit that stands there.
///
/// # Errors
/// The text is no TOML, or has no number at this place.
pub fn with_number(text: &str, place: &[Step], value: f64) -> Result<String, String> {
    let mut document: DocumentMut = text.parse().map_err(|error: toml_edit::TomlError| error.to_string())?;
    let old = value_at(document.as_table_mut(), place).ok_or("the number is not in the file any more")?;
    let Some(WrittenNumber { unit, whole, .. }) = number(old) else {
        return Err("the value is no number any more".into());
    };
    let value = four_digits(value);
    let new = match unit.as_str() {
        "" if whole => Value::Integer(Formatted::new(value.round() as i64)),
        "" => Value::Float(Formatted::new(value)),
        unit => Value::String(Formatted::new(format!("{value} {unit}"))),
    };
    replace(old, new);
    Ok(document.to_string())
}

/// Rounds a number to four digits, more than a slider can set.
pub fn four_digits(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}

/// The text with `value`, rounded to four digits, at a key of a table. A missing table or key is added.
///
/// # Errors
/// The text is no TOML, or `table` is not a table.
pub fn with_key(text: &str, table: &str, key: &str, value: f64) -> Result<String, String> {
    with_value(text, table, key, |_| Value::Float(Formatted::new(four_digits(value))))
}

/// The text with another list of strings at a key of a table. Remaining entries keep their comments.
///
/// # Errors
/// The text is no TOML, or `table` is not a table.
pub fn with_list(text: &str, table: &str, key: &str, entries: &[String]) -> Result<String, String> {
    with_value(text, table, key, |old| {
        let old = old.and_then(Value::as_array).cloned().unwrap_or_default();
        let mut new = Array::new();
        for entry in entries {
            match old.iter().find(|value| value.as_str() == Some(entry)) {
                Some(known) => new.push_formatted(known.clone()),
                None => new.push(entry.as_str()),
            }
        }
        new.set_trailing(old.trailing().clone());
        new.set_trailing_comma(old.trailing_comma());
        tidy(&mut new);
        Value::Array(new)
    })
}

/// Normalises the spaces of a list on one line.
fn tidy(list: &mut Array) {
    let text = |value: &Value| {
        let decor = value.decor();
        [decor.prefix(), decor.suffix()].map(|raw| raw.and_then(|raw| raw.as_str()).unwrap_or_default().to_owned())
    };
    if list.iter().any(|value| text(value).iter().any(|part| part.contains('\n'))) {
        return;
    }
    for (i, value) in list.iter_mut().enumerate() {
        value.decor_mut().set_prefix(if i == 0 { "" } else { " " });
        value.decor_mut().set_suffix("");
    }
}

fn with_value(text: &str, table: &str, key: &str, new: impl Fn(Option<&Value>) -> Value) -> Result<String, String> {
    let mut document: DocumentMut = text.parse().map_err(|error: toml_edit::TomlError| error.to_string())?;
    let table = document.entry(table).or_insert_with(toml_edit::table);
    let Some(table) = table.as_table_like_mut() else { return Err(format!("[{key}] is no table")) };
    match table.get_mut(key).and_then(Item::as_value_mut) {
        Some(old) => {
            let new = new(Some(old));
            replace(old, new);
        }
        None => {
            table.insert(key, Item::Value(new(None)));
        }
    }
    Ok(document.to_string())
}

/// Replaces a value, keeping the comments around it.
fn replace(old: &mut Value, mut new: Value) {
    *new.decor_mut() = old.decor().clone();
    *old = new;
}

fn value_at<'a>(table: &'a mut dyn TableLike, place: &[Step]) -> Option<&'a mut Value> {
    let (Step::Key(key), rest) = place.split_first()? else { return None };
    let item = table.get_mut(key)?;
    match rest {
        [] => item.as_value_mut(),
        [Step::Index(index), rest @ ..] => value_at(item.as_array_of_tables_mut()?.get_mut(*index)?, rest),
        _ => value_at(item.as_table_like_mut()?, rest),
    }
}

/// Undo history of changed files.
#[derive(Debug, Default)]
pub struct Changes {
    /// File, its text before, and after.
    done: VecDeque<(PathBuf, String, String)>,
}

impl Changes {
    /// Changes a file as it stands now and keeps the old text for [`Self::undo`].
    ///
    /// # Errors
    /// The file cannot be read, changed or written; the message names it.
    pub fn make(&mut self, file: &Path, change: impl Fn(&str) -> Result<String, String>) -> Result<(), String> {
        let before = files::read_text(file, MAX_SIDECAR_BYTES).map_err(|problem| problem.message)?;
        self.replace(file, before, change)
    }

    /// As [`Self::make`], and makes a missing file from an empty text. Undone, it is empty.
    ///
    /// # Errors
    /// The file cannot be read, changed or written; the message names it.
    pub fn make_or_create(
        &mut self,
        file: &Path,
        change: impl Fn(&str) -> Result<String, String>,
    ) -> Result<(), String> {
        let before = match file.try_exists() {
            Ok(false) => String::new(),
            _ => files::read_text(file, MAX_SIDECAR_BYTES).map_err(|problem| problem.message)?,
        };
        self.replace(file, before, change)
    }

    fn replace(
        &mut self,
        file: &Path,
        before: String,
        change: impl Fn(&str) -> Result<String, String>,
    ) -> Result<(), String> {
        let after = change(&before).map_err(|why| format!("{}: {why}", file.display()))?;
        if after != before {
            write(file, &after)?;
            self.done.push_back((file.to_path_buf(), before, after));
            if self.done.len() > REMEMBERED {
                self.done.pop_front();
            }
        }
        Ok(())
    }

    /// Number of changes that can be undone.
    pub fn count(&self) -> usize {
        self.done.len()
    }

    /// Undoes the last change.
    ///
    /// # Errors
    /// The file has changed since, or cannot be written.
    pub fn undo(&mut self) -> Result<(), String> {
        let Some((file, before, after)) = self.done.pop_back() else { return Ok(()) };
        let now = files::read_text(&file, MAX_SIDECAR_BYTES).map_err(|problem| problem.message)?;
        if now != after {
            return Err(format!("{}: somebody else has changed this file, so it stays as it is", file.display()));
        }
        write(&file, &before)
    }
}

fn write(path: &Path, text: &str) -> Result<(), String> {
    replace_file(path, text.as_bytes(), Readers::Owner).map_err(|error| error.to_string())
}

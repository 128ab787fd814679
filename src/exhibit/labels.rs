//! Label texts as a table for translators, and back: one row a text, one column a language.
//!
//! ```text
//! key,en,ko,it
//! title,Three plates,세 개의 판,Tre piastre
//! caption.large,[large steel disc rings low],…
//! ```
//!
//! Keys are `title`, `maker`, `body`, `alt`, and `text.` or `caption.` with the key of the sidecar. What is the same is not
//! touched, so that a table read back unchanged leaves the sidecar as it was to the byte; what differs changes the value
//! alone, comments stay. Tables begin with a byte order mark, by which spreadsheets know UTF-8; those that come back may
//! have lost it, and be separated by semicolons or tabs.

use std::sync::Arc;

use toml_edit::{DocumentMut, InlineTable, Item, Table, TableLike, Value};

use super::codes;
use super::diagnostic::{Diagnostic, Location, Report, near, quoted};

/// Keys of a language that are texts themselves.
const PLAIN: [&str; 4] = ["title", "maker", "body", "alt"];
/// Keys that hold texts by keys of their own.
const GROUPS: [&str; 2] = ["text", "caption"];
/// Not a language.
const DEFAULT: &str = "default_language";
/// Tells spreadsheets that a table is UTF-8.
const MARK: &str = "\u{feff}";

/// The table of a sidecar's label texts.
///
/// # Errors
/// Where the sidecar is not TOML, or has no label.
pub fn to_csv(file: &str, sidecar: &str) -> Result<String, Report> {
    let document = parsed(file, sidecar)?;
    let languages = languages(&document);
    if languages.is_empty() {
        let problem = Diagnostic::new(codes::NO_TEXT, format!("{file} has no label"));
        return Err(Report::of(problem.help("write [label.en] with a title, and translate that")));
    }
    let mut writer = csv::WriterBuilder::new().from_writer(Vec::new());
    let head = ["key"].into_iter().chain(languages.iter().map(String::as_str));
    let rows = keys(&document, &languages).into_iter().map(|key| {
        let texts: Vec<String> = languages.iter().map(|l| text(&document, l, &key).unwrap_or_default()).collect();
        [key].into_iter().chain(texts).collect::<Vec<String>>()
    });
    let written = writer.write_record(head).and_then(|()| {
        for row in rows {
            writer.write_record(row)?;
        }
        Ok(())
    });
    // Writing to memory cannot fail, and what was TOML is UTF-8.
    let bytes = written.ok().and_then(|()| writer.into_inner().ok()).unwrap_or_default();
    Ok(format!("{MARK}{}", String::from_utf8_lossy(&bytes)))
}

/// A sidecar with the texts of a table.
#[derive(Clone, Debug)]
pub struct Taken {
    /// The new sidecar.
    pub sidecar: String,
    /// Texts that changed, or are new.
    pub changed: usize,
    /// What the table does not say, a line each: its languages, rows and cells that are missing.
    pub remarks: Vec<String>,
}

/// Takes the texts of a table over into a sidecar.
///
/// # Errors
/// All at once, each with its line: keys that the sidecar does not have, headings that are no language, rows of another
/// length. Nothing is taken over then.
pub fn from_csv(file: &str, sidecar: &str, table_file: &str, table: &str) -> Result<Taken, Report> {
    let mut document = parsed(file, sidecar)?;
    let had = languages(&document);
    let known = keys(&document, &had);
    let rows = rows(table_file, table)?;
    let mut problems = Problems { file: table_file, text: table, list: Vec::new() };
    let mut taken = Taken { sidecar: String::new(), changed: 0, remarks: Vec::new() };
    let Some((_, head)) = rows.first().filter(|(_, head)| head.first().is_some_and(|key| key == "key")) else {
        problems.add(
            1,
            "the table does not begin with \"key\" and languages".into(),
            "write it anew: soffio labels EXHIBIT --csv FILE",
        );
        return Err(problems.report());
    };
    let columns: Vec<&str> = head[1..].iter().map(String::as_str).collect();
    for (i, code) in columns.iter().enumerate() {
        if !is_language(code) {
            problems.add(1, format!("\"{code}\" is no language"), "write its code, such as ko, it or pt-BR");
        } else if columns[..i].contains(code) {
            problems.add(1, format!("\"{code}\" has two columns"), "keep one of them");
        }
    }
    let mut seen: Vec<&str> = Vec::new();
    for (line, row) in &rows[1..] {
        let key = row[0].as_str();
        if !known.iter().any(|k| k == key) {
            let likely = near(key, known.iter().map(String::as_str));
            let help = if likely.is_empty() {
                format!("keys are: {}", known.join(", "))
            } else {
                format!("did you mean {}?", quoted(&likely))
            };
            problems.add(*line, format!("the sidecar has no text \"{key}\""), &help);
        } else if seen.contains(&key) {
            problems.add(*line, format!("\"{key}\" has two rows"), "keep one of them");
        }
        if row.len() != head.len() {
            let message = format!("{} cells, and {} headings", row.len(), head.len());
            problems.add(*line, message, "a text with a comma or a line break stands in quotation marks");
        }
        seen.push(key);
    }
    if !problems.list.is_empty() {
        return Err(problems.report());
    }
    for code in had.iter().filter(|code| !columns.contains(&code.as_str())) {
        taken.remarks.push(format!("\"{code}\" has no column; its texts stay as they are"));
    }
    for key in known.iter().filter(|key| !seen.contains(&key.as_str())) {
        taken.remarks.push(format!("\"{key}\" has no row; its texts stay as they are"));
    }
    for (_, row) in &rows[1..] {
        for (code, cell) in columns.iter().zip(&row[1..]) {
            let old = text(&document, code, &row[0]);
            let new = cell.replace("\r\n", "\n");
            match old {
                Some(old) if old.replace("\r\n", "\n") == new => {}
                Some(old) if new.is_empty() && !old.is_empty() => {
                    taken.remarks.push(format!("\"{}\" is empty in \"{code}\"; its text stays as it is", row[0]));
                }
                None if new.is_empty() => {
                    taken.remarks.push(format!("\"{}\" is missing in \"{code}\"", row[0]));
                }
                _ => {
                    set(&mut document, code, &row[0], &new);
                    taken.changed += 1;
                }
            }
        }
    }
    taken.sidecar = document.to_string();
    Ok(taken)
}

fn parsed(file: &str, sidecar: &str) -> Result<DocumentMut, Report> {
    sidecar.parse::<DocumentMut>().map_err(|_| match super::source::Source::parse(file, sidecar) {
        Err(problem) => Report::in_file(file, Arc::from(sidecar), vec![problem]),
        // The two parsers are one: this is not reached.
        Ok(_) => Report::of(Diagnostic::new(codes::SYNTAX, format!("{file} is not TOML"))),
    })
}

/// Records with the line that each begins in; whatever separates them.
fn rows(file: &str, table: &str) -> Result<Vec<(usize, Vec<String>)>, Report> {
    let text = table.strip_prefix(MARK).unwrap_or(table);
    let head = text.lines().next().unwrap_or_default();
    let delimiter = [',', ';', '\t'].into_iter().find(|d| head.starts_with(&format!("key{d}"))).unwrap_or(',');
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .delimiter(delimiter as u8)
        .from_reader(text.as_bytes());
    let mut rows = Vec::new();
    for record in reader.records() {
        let record = record.map_err(|error| {
            Report::of(
                Diagnostic::new(codes::TABLE, format!("{file} cannot be read: {error}")).help("save it as CSV, UTF-8"),
            )
        })?;
        // A record's position is that of the empty lines before it.
        let from = record.position().map_or(1, |p| p.line() as usize);
        let empty = text.lines().skip(from - 1).take_while(|line| line.is_empty()).count();
        let line = from + empty;
        rows.push((line, record.iter().map(str::to_owned).collect()));
    }
    Ok(rows)
}

/// What is wrong with a table.
struct Problems<'a> {
    file: &'a str,
    text: &'a str,
    list: Vec<Diagnostic>,
}

impl Problems<'_> {
    fn add(&mut self, line: usize, message: String, help: &str) {
        let start: usize = self.text.split_inclusive('\n').take(line - 1).map(str::len).sum();
        let length = self.text[start..].lines().next().map_or(0, str::len);
        let mut problem = Diagnostic::new(codes::TABLE, message).help(help);
        problem.location = Some(Location { file: self.file.to_owned(), line, column: 1, span: start..start + length });
        self.list.push(problem);
    }

    fn report(self) -> Report {
        Report::in_file(self.file, Arc::from(self.text), self.list)
    }
}

/// Is this a language's code (BCP 47, loosely)?
fn is_language(code: &str) -> bool {
    let mut parts = code.split('-');
    let first = parts.next().unwrap_or_default();
    let word = |part: &str, most: usize| {
        !part.is_empty() && part.len() <= most && part.chars().all(|c| c.is_ascii_alphanumeric())
    };
    (2..=3).contains(&first.len()) && first.chars().all(|c| c.is_ascii_lowercase()) && parts.all(|part| word(part, 8))
}

/// Languages in the order of the file.
fn languages(document: &DocumentMut) -> Vec<String> {
    let label = document.get("label").and_then(Item::as_table_like);
    let keys = label.into_iter().flat_map(|label| label.iter());
    keys.filter(|(key, item)| *key != DEFAULT && item.is_table_like()).map(|(key, _)| key.to_owned()).collect()
}

/// Keys of all texts that any language has: those of the first in its order, then what others have besides.
fn keys(document: &DocumentMut, languages: &[String]) -> Vec<String> {
    let mut keys: Vec<String> = Vec::new();
    for language in languages {
        let Some(words) = document["label"][language.as_str()].as_table_like() else { continue };
        for (key, item) in words.iter() {
            let below = item.as_table_like().filter(|_| GROUPS.contains(&key));
            let found: Vec<String> = match below {
                Some(group) => group.iter().map(|(k, _)| format!("{key}.{k}")).collect(),
                None if PLAIN.contains(&key) => vec![key.to_owned()],
                None => Vec::new(),
            };
            for key in found {
                if !keys.contains(&key) {
                    keys.push(key);
                }
            }
        }
    }
    keys
}

/// The text of a key in a language.
fn text(document: &DocumentMut, language: &str, key: &str) -> Option<String> {
    let words = document.get("label")?.as_table_like()?.get(language)?.as_table_like()?;
    let item = match key.split_once('.') {
        Some((group, key)) => words.get(group)?.as_table_like()?.get(key)?,
        None => words.get(key)?,
    };
    item.as_str().map(str::to_owned)
}

/// Writes a text where it belongs; tables that are missing are made.
fn set(document: &mut DocumentMut, language: &str, key: &str, text: &str) {
    let label = document.entry("label").or_insert_with(|| Item::Table(Table::new()));
    let Some(label) = label.as_table_like_mut() else { return };
    let words = label.entry(language).or_insert_with(|| {
        let mut table = Table::new();
        table.decor_mut().set_prefix("\n");
        Item::Table(table)
    });
    let Some(words) = words.as_table_like_mut() else { return };
    let (words, key): (&mut dyn TableLike, &str) = match key.split_once('.') {
        None => (words, key),
        Some((group, key)) => {
            let group = words.entry(group).or_insert_with(|| Item::Value(Value::InlineTable(InlineTable::new())));
            let Some(group) = group.as_table_like_mut() else { return };
            (group, key)
        }
    };
    let mut value = Value::from(text);
    match words.get_mut(key).and_then(Item::as_value_mut) {
        Some(old) => {
            // The comment behind a value is its decor.
            *value.decor_mut() = old.decor().clone();
            *old = value;
        }
        None => {
            words.insert(key, Item::Value(value));
        }
    }
}

//! Label texts as a CSV table for translators, and back: one row for each text, one column for each language.
//!
//! ```text
//! key,en,ko,it
//! title,Three plates,세 개의 판,Tre piastre
//! caption.large,[large steel disc rings low],…
//! ```
//!
//! Keys are `title`, `maker`, `body`, `alt`, and `text.` or `caption.` with the key of the sidecar. Only values that
//! differ are changed: comments stay, and a table read back unchanged leaves the sidecar byte for byte. Tables begin
//! with a byte order mark, so that spreadsheets recognise UTF-8. Tables that come back may lack it, and may be
//! separated by semicolons or tabs.

use std::sync::Arc;

use toml_edit::{DocumentMut, InlineTable, Item, Table, TableLike, Value};

use super::codes;
use super::diagnostic::{Diagnostic, Location, Report, quoted, similar_names};

/// Keys of a language with one text each.
const SINGLE_TEXTS: [&str; 4] = ["title", "maker", "body", "alt"];
/// Keys of a language that are tables of texts.
const TEXT_TABLES: [&str; 2] = ["text", "caption"];
/// Key of the label that is not a language.
const DEFAULT_LANGUAGE: &str = "default_language";
/// Marks a table as UTF-8 for spreadsheets.
const BYTE_ORDER_MARK: &str = "\u{feff}";

/// The table of a sidecar's label texts.
///
/// # Errors
/// Where the sidecar is not TOML, or has no label.
pub fn to_csv(file: &str, sidecar: &str) -> Result<String, Report> {
    let document = parsed(file, sidecar)?;
    let languages = languages(&document);
    if languages.is_empty() {
        let problem = Diagnostic::new(codes::NO_TEXT, format!("{file} has no label"));
        return Err(Report::single(problem.help("write [label.en] with a title, and translate that")));
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
    // Writing to memory cannot fail, and TOML is UTF-8.
    let bytes = written.ok().and_then(|()| writer.into_inner().ok()).unwrap_or_default();
    Ok(format!("{BYTE_ORDER_MARK}{}", String::from_utf8_lossy(&bytes)))
}

/// A sidecar with the texts of a table merged in.
#[derive(Clone, Debug)]
pub struct MergedTexts {
    /// The new sidecar.
    pub sidecar: String,
    /// Number of texts that changed or are new.
    pub changed: usize,
    /// Languages, rows and cells that the table lacks, one line each.
    pub remarks: Vec<String>,
}

/// Merges the texts of a table into a sidecar.
///
/// # Errors
/// All at once, each with its line: keys that the sidecar does not have, headings that are no language, rows of another
/// length. Nothing is merged then.
pub fn from_csv(file: &str, sidecar: &str, table_file: &str, table: &str) -> Result<MergedTexts, Report> {
    let mut document = parsed(file, sidecar)?;
    let had = languages(&document);
    let known = keys(&document, &had);
    let rows = rows(table_file, table)?;
    let mut problems = Problems { file: table_file, text: table, list: Vec::new() };
    let mut taken = MergedTexts { sidecar: String::new(), changed: 0, remarks: Vec::new() };
    let Some((_, head)) = rows.first().filter(|(_, head)| head.first().is_some_and(|key| key == "key")) else {
        problems.add(
            1,
            "the first row of the table must be \"key\" and the languages".into(),
            "create it again: soffio labels EXHIBIT --csv FILE",
        );
        return Err(problems.report());
    };
    let columns: Vec<&str> = head[1..].iter().map(String::as_str).collect();
    for (i, code) in columns.iter().enumerate() {
        if !is_language(code) {
            problems.add(1, format!("\"{code}\" is not a language"), "write its code, such as ko, it or pt-BR");
        } else if columns[..i].contains(code) {
            problems.add(1, format!("\"{code}\" has two columns"), "keep one of them");
        }
    }
    let mut seen: Vec<&str> = Vec::new();
    for (line, row) in &rows[1..] {
        let key = row[0].as_str();
        if !known.iter().any(|k| k == key) {
            let likely = similar_names(key, known.iter().map(String::as_str));
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
    sidecar.parse::<DocumentMut>().map_err(|_| match super::source::SidecarText::parse(file, sidecar) {
        Err(problem) => Report::in_file(file, Arc::from(sidecar), vec![problem]),
        // The two parsers are one: this is not reached.
        Ok(_) => Report::single(Diagnostic::new(codes::SYNTAX, format!("{file} is not TOML"))),
    })
}

/// Records with the line at which each begins, whatever the separator.
fn rows(file: &str, table: &str) -> Result<Vec<(usize, Vec<String>)>, Report> {
    let text = table.strip_prefix(BYTE_ORDER_MARK).unwrap_or(table);
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
            Report::single(
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

/// Collects the problems of a table.
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
    keys.filter(|(key, item)| *key != DEFAULT_LANGUAGE && item.is_table_like()).map(|(key, _)| key.to_owned()).collect()
}

/// Keys of all texts that any language has: those of the first in its order, then further ones of the others.
fn keys(document: &DocumentMut, languages: &[String]) -> Vec<String> {
    let mut keys: Vec<String> = Vec::new();
    for language in languages {
        let Some(words) = document["label"][language.as_str()].as_table_like() else { continue };
        for (key, item) in words.iter() {
            let below = item.as_table_like().filter(|_| TEXT_TABLES.contains(&key));
            let found: Vec<String> = match below {
                Some(group) => group.iter().map(|(k, _)| format!("{key}.{k}")).collect(),
                None if SINGLE_TEXTS.contains(&key) => vec![key.to_owned()],
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

/// Writes a text in its place; missing tables are created.
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

//! Problems of a configuration file: all at once, each with line, column and remedy.
//!
//! Four checks look at the same text. The grammar comes first, then unknown keys and numbers out of range on the syntax
//! tree, which knows the place of each key. Types are checked by serde, and last come keys that contradict each other.
//! Old names of keys are read as the new ones, with a warning (`soffio_exhibit::renamed`).

use std::fmt;
use std::ops::Range;
use std::path::{Path, PathBuf};

use toml_edit::{Document, Item, TableLike};

use super::{Config, LIMITS};
use soffio_exhibit::renamed::{self, FileKind, Updated};
use soffio_sound::BANDS;

/// A configuration that cannot be used.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub struct ConfigError {
    /// The file.
    pub file: PathBuf,
    /// All that is wrong with it, in the order of the file.
    pub problems: Vec<Problem>,
}

/// One thing that is wrong with a configuration.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problem {
    /// From 1; 0 where the problem has no place.
    pub line: usize,
    /// In characters, from 1.
    pub column: usize,
    /// What is wrong.
    pub message: String,
    /// What to do.
    pub help: String,
}

impl ConfigError {
    /// The file is missing or unreadable.
    pub(super) fn unreadable(file: &Path, error: &std::io::Error) -> Self {
        let help = format!("give another file with --config, or start from the shipped {}", super::FILE);
        let problem = Problem { line: 0, column: 0, message: format!("cannot be read: {error}"), help };
        Self { file: file.into(), problems: vec![problem] }
    }
}

impl Problem {
    /// The problem with its file, place and remedy, in two lines.
    pub fn in_file(&self, file: &Path) -> String {
        let Self { line, column, message, help } = self;
        let place = if *line > 0 { format!(":{line}:{column}") } else { String::new() };
        format!("{}{place}: {message}\n  help: {help}", file.display())
    }
}

impl fmt::Display for ConfigError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let problems: Vec<String> = self.problems.iter().map(|problem| problem.in_file(&self.file)).collect();
        f.write_str(&problems.join("\n"))
    }
}

/// What to do where the grammar is broken.
const GRAMMAR: &str = "a line is `key = value`, with words in \"quotes\" and lists in [ ]; a table begins with [name]";

/// Reads the configuration in `text`. Returns it with a warning for each old name.
pub(super) fn parse(text: &str, file: &Path) -> Result<(Config, Vec<Problem>), ConfigError> {
    let fail = |problems| Err(ConfigError { file: file.into(), problems });
    let source = &Source { text, updated: renamed::update(FileKind::Configuration, text) };
    let document = match Document::parse(&*source.updated.text) {
        Ok(document) => document,
        Err(error) => {
            let duplicate = error.span().and_then(|span| source.updated.duplicate(text, span));
            let (message, help) = duplicate.map_or_else(
                || (error.message().to_owned(), GRAMMAR.to_owned()),
                |name| (name.duplicate_message(), name.duplicate_help()),
            );
            return fail(vec![source.located(error.span(), message, help)]);
        }
    };
    let mut check = KeyCheck { source, problems: Vec::new() };
    check.table(document.as_table(), &defaults(), "");
    if !check.problems.is_empty() {
        return fail(check.problems);
    }
    let config: Config = match toml::from_str(&source.updated.text) {
        Ok(config) => config,
        Err(error) => {
            let message = error.message().lines().next().unwrap_or_default().to_owned();
            let key = error.span().and_then(|span| as_in(document.as_table(), &defaults(), span.start));
            let help = key.unwrap_or_else(|| format!("{} shows how it is written", super::FILE));
            return fail(vec![source.located(error.span(), message, help)]);
        }
    };
    let one_end = if config.night.from.is_some() { "from" } else { "to" };
    let together =
        [("audio", "second_microphone_channel", dual_microphone(&config)), ("reverb", "t60_s", reverb(&config))]
            .into_iter()
            .chain([("exhibits", "groups", groups(&config))])
            .chain([("night", one_end, night(&config)), ("staff", "chord", chords(&config))])
            .chain([("mqtt", "broker", config.mqtt.broker_problem()), ("mqtt", "topic", config.mqtt.topic_problem())])
            .chain([("mqtt", "certificate", config.mqtt.certificate_problem())])
            .chain([("mqtt", "password_file", config.mqtt.password_problem())]);
    let problems: Vec<Problem> = together
        .filter_map(|(table, key, problem)| {
            let item = document.get(table).and_then(|table| table.get(key));
            problem.map(|(message, help)| source.located(item.and_then(Item::span), message, help))
        })
        .collect();
    if problems.is_empty() { Ok((config, source.warnings(file))) } else { fail(problems) }
}

/// An exhibit is in one group only, and a group has a heading.
fn groups(config: &Config) -> Option<(String, String)> {
    let groups = &config.exhibits.groups;
    let all: Vec<&String> = groups.iter().flat_map(|group| &group.exhibits).collect();
    if let Some((_, id)) = all.iter().enumerate().find(|(i, id)| all[..*i].contains(id)) {
        return Some((format!("\"{id}\" is twice in exhibits.groups"), "name each exhibit in one group".into()));
    }
    let bare = groups.iter().find(|group| group.heading.values().all(|text| text.trim().is_empty()))?;
    let help = "give it one for each language, as in heading = { en = \"Mobiles\" }";
    Some((format!("a group of {} exhibits has no heading", bare.exhibits.len()), help.into()))
}

/// Seven decays, or none.
fn reverb(config: &Config) -> Option<(String, String)> {
    let given = &config.reverb.t60_s;
    let help = "give seven times, s, for 125, 250, 500, 1000, 2000, 4000 and 8000 Hz, or [] for those of the named reverberation";
    if !given.is_empty() && given.len() != BANDS.len() {
        return Some((format!("{} times for {} octaves", given.len(), BANDS.len()), help.into()));
    }
    config.reverb.spec().and_then(|spec| spec.problem()).map(|problem| (problem, help.into()))
}

/// A night has an end.
fn night(config: &Config) -> Option<(String, String)> {
    let help = "give both `from` and `to`, as in \"22:00\" and \"08:00\", or leave both empty";
    (config.night.from.is_some() != config.night.to.is_some()).then(|| ("a night with one end".into(), help.into()))
}

/// A chord does one thing.
fn chords(config: &Config) -> Option<(String, String)> {
    let staff = &config.staff;
    let all = [&staff.chord, &staff.open, &staff.mute, &staff.night];
    let twice = all.iter().enumerate().find(|(i, chord)| all[..*i].contains(chord));
    twice.map(|(_, chord)| (format!("{chord} has two meanings in [staff]"), "give each its own key".into()))
}

/// Two microphones are two channels. Returns the problem and its remedy.
fn dual_microphone(config: &Config) -> Option<(String, String)> {
    let (first, second) = (config.audio.microphone_channel, config.audio.second_microphone_channel);
    let help = "give the first microphone's channel in `audio.microphone_channel`, from 1, and another one here";
    let message = match first {
        _ if second == 0 => return None,
        0 => "a second microphone beside a mix of all channels".to_owned(),
        _ if first == second => format!("both microphones are channel {first}"),
        _ => return None,
    };
    Some((message, help.into()))
}

/// The default configuration as a table: the list of all keys.
fn defaults() -> toml::Table {
    toml::Table::try_from(Config::default()).unwrap_or_default()
}

/// What to do about the key whose value stands at that byte: its default shows how it is written.
fn as_in(table: &dyn TableLike, known: &toml::Table, at: usize) -> Option<String> {
    /// Longer defaults explain nothing.
    const SHORT: usize = 60;
    table.iter().find_map(|(name, item)| match (known.get(name)?, item.as_table_like()) {
        (toml::Value::Table(known), Some(table)) => as_in(table, known, at),
        (default, _) if item.span().is_some_and(|span| span.contains(&at)) => {
            let default = default.to_string();
            (default.len() <= SHORT).then(|| format!("write it as the default is written: {name} = {default}"))
        }
        _ => None,
    })
}

/// The file, and its text with new names, which is what is parsed.
struct Source<'a> {
    text: &'a str,
    updated: Updated<'a>,
}

impl Source<'_> {
    /// A problem at bytes of the updated text.
    fn located(&self, span: Option<Range<usize>>, message: String, help: String) -> Problem {
        located(self.text, span.map(|span| self.updated.original(span)), message, help)
    }

    /// A warning for each old name.
    fn warnings(&self, file: &Path) -> Vec<Problem> {
        let help = format!("`soffio check --fix {}` rewrites the file", file.display());
        let names = self.updated.replacements.iter();
        names.map(|name| located(self.text, Some(name.span.clone()), name.to_string(), help.clone())).collect()
    }
}

/// Compares the keys of the syntax tree with the table of defaults.
struct KeyCheck<'a> {
    source: &'a Source<'a>,
    problems: Vec<Problem>,
}

impl KeyCheck<'_> {
    /// Compares one table with the defaults' table of the same name (`prefix`, empty or ending in a dot).
    fn table(&mut self, table: &dyn TableLike, known: &toml::Table, prefix: &str) {
        for (name, item) in table.iter() {
            let key = format!("{prefix}{name}");
            let at = table.key(name).and_then(toml_edit::Key::span);
            match (known.get(name), item.as_table_like()) {
                (None, _) => {
                    let help = match nearest(name, known.keys()) {
                        Some(near) => format!("did you mean `{near}`?"),
                        None => format!("known here: {}", known.keys().cloned().collect::<Vec<_>>().join(", ")),
                    };
                    self.problems.push(self.source.located(at, format!("unknown key `{key}`"), help));
                }
                (Some(toml::Value::Table(known)), Some(table)) => self.table(table, known, &format!("{key}.")),
                (Some(toml::Value::Table(_)), None) => {
                    let help = format!("write [{key}] on a line of its own, and the keys under it");
                    self.problems.push(self.source.located(at, format!("`{key}` is a table"), help));
                }
                (Some(default), _) => self.range(&key, item, default),
            }
        }
    }

    /// Is a number inside its range?
    fn range(&mut self, key: &str, item: &Item, default: &toml::Value) {
        let Some(limit) = LIMITS.iter().find(|limit| limit.key == key) else { return };
        let Some(value) = item.as_float().or_else(|| item.as_integer().map(|i| i as f64)) else { return };
        if !(limit.low..=limit.high).contains(&value) {
            let unit = if limit.unit == "1" { String::new() } else { format!(" {}", limit.unit) };
            let message = format!("`{key}` is {value}{unit}, outside {} to {}{unit}", limit.low, limit.high);
            let help = format!("choose a number in between; the default is {default}{unit}");
            self.problems.push(self.source.located(item.span(), message, help));
        }
    }
}

/// The known key most like `name`, if one is like it at all.
fn nearest<'a>(name: &str, known: impl Iterator<Item = &'a String>) -> Option<&'a str> {
    /// Jaro–Winkler similarity from which two words look like one mistyped.
    const ALIKE: f64 = 0.75;
    known
        .map(|key| (strsim::jaro_winkler(name, key), key.as_str()))
        .filter(|(alike, _)| *alike >= ALIKE)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, key)| key)
}

/// A problem at a byte range of the text.
fn located(text: &str, span: Option<Range<usize>>, message: String, help: String) -> Problem {
    let Some(before) = span.and_then(|span| text.get(..span.start)) else {
        return Problem { line: 0, column: 0, message, help };
    };
    let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
    let line = before.matches('\n').count() + 1;
    Problem { line, column: before[line_start..].chars().count() + 1, message, help }
}

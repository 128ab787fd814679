//! A museum's own files of UI strings, and what is wrong with them.
//!
//! Each problem is found in one pass over the syntax tree: syntax errors, unknown and repeated keys, unknown variables, messages
//! that cannot be formatted, and texts that a new language lacks. The rest of the file is used all the same.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::{Arc, LazyLock};

use fluent_bundle::{FluentArgs, FluentResource};
use fluent_syntax::ast::{
    CallArguments, Entry, Expression, InlineExpression, Message, Pattern, PatternElement, VariantKey,
};

use super::{SHIPPED, TextId, bundle, canonical, parents, shipped_text};

/// Folder of the files, beside the configuration file.
pub const FOLDER: &str = "texts";

/// Longest file, bytes: ten times the shipped ones.
const LONGEST: u64 = 256 * 1024;
/// Deepest nesting of braces. The parser calls itself for each level.
const DEEPEST: usize = 20;
/// Most digits of a number in a file: the plural rules take no more.
const MOST_DIGITS: usize = 12;
/// Jaro–Winkler similarity from which an unknown key looks like a misspelt one.
const ALIKE: f64 = 0.85;

/// Texts in one language, from a file that is named after the language.
pub struct TextFile {
    /// Code of the language, such as `nl` or `pt-BR`.
    pub language: String,
    pub(super) resource: Arc<FluentResource>,
}

/// One thing that is wrong with a file of UI strings.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TextProblem {
    /// The file.
    pub file: PathBuf,
    /// Bytes of the file that it is about; `None` where it is about the whole file.
    pub span: Option<Range<usize>>,
    /// Line, from 1; 0 where it is about the whole file.
    pub line: usize,
    /// Column in characters, from 1; 0 where it is about the whole file.
    pub column: usize,
    /// What is wrong.
    pub message: String,
    /// What to do.
    pub help: String,
    /// Is it only to be known? A warning changes no text.
    pub is_warning: bool,
}

impl fmt::Display for TextProblem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.file.display())?;
        if self.line > 0 {
            write!(f, ":{}:{}", self.line, self.column)?;
        }
        write!(f, ": {}\n  help: {}", self.message, self.help)
    }
}

/// The files of a folder in the order of their names; a folder that is missing has none.
pub fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
    let mut files: Vec<PathBuf> = entries.filter(|path| path.extension().is_some_and(|end| end == "ftl")).collect();
    files.sort();
    files
}

/// All that is wrong with a file.
pub fn check(path: &Path) -> Vec<TextProblem> {
    TextFile::read(path).1
}

impl TextFile {
    /// Reads a file. It is `None` where nothing of the file can be used.
    pub fn read(path: &Path) -> (Option<Self>, Vec<TextProblem>) {
        let whole = |message: String, help: &str| {
            let (file, help) = (path.to_path_buf(), help.to_owned());
            (None, vec![TextProblem { file, span: None, line: 0, column: 0, message, help, is_warning: false }])
        };
        let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let Some(language) = canonical(&stem) else {
            let message = format!("`{stem}` is not a language code");
            return whole(message, "name the file after its language, such as nl.ftl or pt-BR.ftl");
        };
        if std::fs::metadata(path).is_ok_and(|data| data.len() > LONGEST) {
            return whole(
                format!("the file is longer than {} KiB", LONGEST / 1024),
                "keep the messages of one language",
            );
        }
        let text = match std::fs::read_to_string(path) {
            Ok(text) => text.trim_start_matches('\u{feff}').to_owned(),
            Err(error) => {
                return whole(format!("cannot be read: {error}"), "check the file's permissions; save it as UTF-8");
            }
        };
        if nesting(&text) > DEEPEST {
            return whole("braces are nested too deeply".into(), "close each { with a }");
        }
        let (resource, errors) = match FluentResource::try_new(text) {
            Ok(resource) => (resource, Vec::new()),
            Err((resource, errors)) => (resource, errors),
        };
        let mut found = Findings { file: path, text: resource.source(), problems: Vec::new() };
        for error in errors {
            let help = "write `key = text`, and the lines after the first with spaces before them";
            found.error(error.pos, format!("syntax error: {}", error.kind), help.into());
        }
        // The plural rules panic at such numbers, wherever in the file they are used.
        let usable = found.numbers(&resource);
        if usable {
            let keys = found.entries(&resource);
            found.missing(&language, &keys);
        }
        let mut problems = found.problems;
        problems.sort_by_key(|problem| (problem.line, problem.column));
        (usable.then(|| Self { language, resource: Arc::new(resource) }), problems)
    }
}

/// The problems of one file as they are found.
struct Findings<'a> {
    file: &'a Path,
    text: &'a str,
    problems: Vec<TextProblem>,
}

impl Findings<'_> {
    fn error(&mut self, span: Range<usize>, message: String, help: String) {
        let (line, column) = line_and_column(self.text, span.start);
        let file = self.file.to_path_buf();
        self.problems.push(TextProblem { file, span: Some(span), line, column, message, help, is_warning: false });
    }

    fn warning(&mut self, span: Range<usize>, message: String, help: String) {
        self.error(span, message, help);
        if let Some(last) = self.problems.last_mut() {
            last.is_warning = true;
        }
    }

    /// Bytes of a part of the text.
    fn span(&self, part: &str) -> Range<usize> {
        let start = (part.as_ptr() as usize).saturating_sub(self.text.as_ptr() as usize);
        start..start + part.len()
    }

    /// Is no number of the file too long?
    fn numbers(&mut self, resource: &FluentResource) -> bool {
        let mut used = Used::default();
        for entry in resource.entries() {
            let (value, attributes) = match entry {
                Entry::Message(message) => (message.value.as_ref(), &message.attributes),
                Entry::Term(term) => (Some(&term.value), &term.attributes),
                _ => continue,
            };
            value.into_iter().chain(attributes.iter().map(|attribute| &attribute.value)).for_each(|p| used.pattern(p));
        }
        let long: Vec<&str> = used.numbers.into_iter().filter(|digits| digits.len() > MOST_DIGITS).collect();
        for digits in &long {
            let help = format!("write at most {MOST_DIGITS} digits; nothing of this file is used");
            self.error(self.span(digits), "the number is too long".into(), help);
        }
        long.is_empty()
    }

    /// Checks all messages; returns their keys.
    fn entries<'r>(&mut self, resource: &'r FluentResource) -> BTreeSet<&'r str> {
        let own = bundle("en", [tolerant(resource.source())]);
        let mut keys = BTreeSet::new();
        for entry in resource.entries() {
            let Entry::Message(message) = entry else { continue };
            let (key, span) = (message.id.name, self.span(message.id.name));
            if !keys.insert(key) {
                self.error(span, format!("`{key}` stands twice"), "keep one of the two; the last one is used".into());
            } else if !TextId::ALL.iter().any(|id| id.key() == key) {
                self.error(span, format!("unknown key `{key}`"), near(key));
            } else {
                self.message(message, span, &own);
            }
        }
        keys
    }

    /// Checks one message with a known key.
    fn message(&mut self, message: &Message<&str>, span: Range<usize>, own: &super::Bundle) {
        let (key, before) = (message.id.name, self.problems.len());
        let Some(pattern) = &message.value else {
            return self.error(span, format!("`{key}` has no text"), format!("write `{key} = text`"));
        };
        let known = english_variables(key);
        let used = Used::of(pattern);
        let listed = known.iter().map(|name| format!("{{ ${name} }}")).collect::<Vec<_>>().join(", ");
        for name in used.variables.iter().filter(|name| !known.iter().any(|known| known == *name)) {
            let help = match known {
                [] => format!("`{key}` has no variables"),
                _ => format!("`{key}` has {listed}"),
            };
            self.error(self.span(name), format!("unknown variable `${name}`"), help);
        }
        if self.problems.len() == before {
            let unused: Vec<&str> =
                known.iter().map(String::as_str).filter(|name| !used.variables.contains(name)).collect();
            if !unused.is_empty() {
                let message = format!("`{key}` leaves out ${}", unused.join(", $"));
                self.warning(span.clone(), message, format!("the shipped text has {listed}"));
            }
            self.trial(key, pattern, span, own);
        }
    }

    /// Formats a message as the kiosk will.
    fn trial(&mut self, key: &str, pattern: &Pattern<&str>, span: Range<usize>, own: &super::Bundle) {
        let mut arguments = FluentArgs::new();
        english_variables(key).iter().for_each(|name| arguments.set(name.as_str(), 2));
        let mut errors = Vec::new();
        // Terms and other messages are looked up in this file alone.
        let _ = own.format_pattern(pattern, Some(&arguments), &mut errors);
        if let Some(error) = errors.first() {
            let help = "a text can use its own variables, and terms and messages of the same file";
            self.error(span, format!("`{key}` cannot be shown: {error}"), help.into());
        }
    }

    /// Says which texts nothing in this language has.
    fn missing(&mut self, language: &str, keys: &BTreeSet<&str>) {
        let chain = parents(language);
        if chain.iter().any(|code| SHIPPED.iter().any(|(shipped, _)| shipped == code)) {
            return;
        }
        // The file of the language without its region stands in too.
        let siblings: Vec<FluentResource> = chain
            .iter()
            .skip(1)
            .filter_map(|code| std::fs::read_to_string(self.file.with_file_name(format!("{code}.ftl"))).ok())
            .filter(|text| nesting(text) <= DEEPEST)
            .map(|text| FluentResource::try_new(text).unwrap_or_else(|(resource, _)| resource))
            .collect();
        let stands = |key: &str| {
            let message = |entry: &Entry<&str>| matches!(entry, Entry::Message(message) if message.id.name == key);
            keys.contains(key) || siblings.iter().any(|resource| resource.entries().any(message))
        };
        let lacks = |staff: bool| -> Vec<&str> {
            let of = TextId::ALL.iter().filter(|id| id.is_staff() == staff);
            of.map(|id| id.key()).filter(|key| !stands(key)).collect()
        };
        for (of, missing) in [("visitors", lacks(false)), ("the staff panel", lacks(true))] {
            if !missing.is_empty() {
                let message = format!("{} texts for {of} are missing: {}", missing.len(), missing.join(", "));
                self.warning(0..0, message, "they appear in English; take the keys from the shipped en.ftl".into());
            }
        }
    }
}

/// What a pattern refers to.
#[derive(Default)]
struct Used<'a> {
    variables: BTreeSet<&'a str>,
    numbers: Vec<&'a str>,
}

impl<'a> Used<'a> {
    fn of(pattern: &Pattern<&'a str>) -> Self {
        let mut used = Self::default();
        used.pattern(pattern);
        used
    }

    fn pattern(&mut self, pattern: &Pattern<&'a str>) {
        for element in &pattern.elements {
            if let PatternElement::Placeable { expression } = element {
                self.expression(expression);
            }
        }
    }

    fn expression(&mut self, expression: &Expression<&'a str>) {
        match expression {
            Expression::Inline(inline) => self.inline(inline),
            Expression::Select { selector, variants } => {
                self.inline(selector);
                for variant in variants {
                    if let VariantKey::NumberLiteral { value } = variant.key {
                        self.numbers.push(value);
                    }
                    self.pattern(&variant.value);
                }
            }
        }
    }

    fn inline(&mut self, inline: &InlineExpression<&'a str>) {
        match inline {
            InlineExpression::VariableReference { id } => drop(self.variables.insert(id.name)),
            InlineExpression::NumberLiteral { value } => self.numbers.push(value),
            InlineExpression::FunctionReference { arguments, .. } => self.arguments(arguments),
            InlineExpression::TermReference { arguments: Some(arguments), .. } => self.arguments(arguments),
            InlineExpression::Placeable { expression } => self.expression(expression),
            _ => {}
        }
    }

    fn arguments(&mut self, arguments: &CallArguments<&'a str>) {
        arguments.positional.iter().for_each(|argument| self.inline(argument));
        arguments.named.iter().for_each(|argument| self.inline(&argument.value));
    }
}

/// Variables of a shipped message in English, in the order of the alphabet.
pub(super) fn english_variables(key: &str) -> &'static [String] {
    static VARIABLES: LazyLock<BTreeMap<String, Vec<String>>> = LazyLock::new(|| variables(shipped_text("en")));
    VARIABLES.get(key).map_or(&[], Vec::as_slice)
}

/// The variables of each message of a text, in the order of the alphabet.
pub fn variables(text: &str) -> BTreeMap<String, Vec<String>> {
    let resource = tolerant(text);
    let of = |entry: &Entry<&str>| match entry {
        Entry::Message(Message { id, value: Some(pattern), .. }) => {
            Some((id.name.to_owned(), Used::of(pattern).variables.into_iter().map(str::to_owned).collect()))
        }
        _ => None,
    };
    resource.entries().filter_map(of).collect()
}

/// Messages of a text, without those that have syntax errors.
pub(super) fn tolerant(text: &str) -> Arc<FluentResource> {
    Arc::new(FluentResource::try_new(text.to_owned()).unwrap_or_else(|(resource, _)| resource))
}

/// How deeply braces are nested.
fn nesting(text: &str) -> usize {
    let mut depth = 0_usize;
    let mut deepest = 0;
    for c in text.bytes() {
        match c {
            b'{' => depth += 1,
            b'}' => depth = depth.saturating_sub(1),
            _ => {}
        }
        deepest = deepest.max(depth);
    }
    deepest
}

/// The known key most like an unknown one.
fn near(key: &str) -> String {
    let alike = TextId::ALL.iter().map(|id| (strsim::jaro_winkler(key, id.key()), id.key()));
    match alike.max_by(|a, b| a.0.total_cmp(&b.0)).filter(|(alike, _)| *alike >= ALIKE) {
        Some((_, known)) => format!("did you mean `{known}`?"),
        None => "take the keys from the shipped en.ftl".into(),
    }
}

/// Line and column (in characters) of a byte, from 1.
fn line_and_column(text: &str, at: usize) -> (usize, usize) {
    let before = text.get(..at).unwrap_or(text);
    let start = before.rfind('\n').map_or(0, |newline| newline + 1);
    (before.matches('\n').count() + 1, before[start..].chars().count() + 1)
}

//! UI strings: the texts of the kiosk itself, for visitors and staff, in all its languages.
//!
//! They are messages of Project Fluent (<https://projectfluent.org>) in `pages/texts`, one file for each language. A museum
//! overrides single messages, or adds a language, with a file `texts/<language>.ftl` beside its `kiosk.toml`. A message that a
//! language lacks comes from the language without its region (`pt-BR`, then `pt`), else from English.
//!
//! Messages without variables are formatted once, at the start. The others are formatted when a variable changes. Numbers are
//! passed as counts, which choose the plural form, or as text that is formatted already: the same values give the same
//! characters on every machine. Variables are not wrapped in marks of bidirectional isolation (U+2068, U+2069):
//! [`bidi`](super::bidi) orders whole lines, and the fonts have no glyphs for the marks.

mod file;
mod text_id;

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};

use fluent_bundle::concurrent::FluentBundle;
use fluent_bundle::{FluentArgs, FluentResource};
use unic_langid::LanguageIdentifier;

use file::tolerant;

pub use file::{FOLDER, TextFile, TextProblem, check, files, variables};
pub use text_id::TextId;

/// The shipped files by language; English comes first and stands in for the others.
pub const SHIPPED: [(&str, &str); 7] = [
    ("en", include_str!("../texts/en.ftl")),
    ("de", include_str!("../texts/de.ftl")),
    ("fr", include_str!("../texts/fr.ftl")),
    ("it", include_str!("../texts/it.ftl")),
    ("es", include_str!("../texts/es.ftl")),
    ("ko", include_str!("../texts/ko.ftl")),
    ("ja", include_str!("../texts/ja.ftl")),
];

/// Names of languages that exhibits may have labels in and the kiosk has no texts in, each in its own language.
const LANGUAGE_NAMES: &str = include_str!("../texts/language-names.ftl");

/// Formatted messages that are remembered for each key: a message that stands in several places has several values.
const REMEMBERED: usize = 4;

/// A variable of a message.
#[derive(Clone, Debug, PartialEq)]
pub enum Variable<'a> {
    /// A whole number, which chooses the plural form.
    Count(u64),
    /// A text, or a number that is formatted already.
    Text(Cow<'a, str>),
}

impl From<u64> for Variable<'_> {
    fn from(count: u64) -> Self {
        Self::Count(count)
    }
}

impl From<u32> for Variable<'_> {
    fn from(count: u32) -> Self {
        Self::Count(count.into())
    }
}

impl From<usize> for Variable<'_> {
    fn from(count: usize) -> Self {
        Self::Count(count as u64)
    }
}

impl<'a> From<&'a str> for Variable<'a> {
    fn from(text: &'a str) -> Self {
        Self::Text(text.into())
    }
}

impl From<Arc<str>> for Variable<'_> {
    fn from(text: Arc<str>) -> Self {
        Self::Text(text.as_ref().to_owned().into())
    }
}

impl From<String> for Variable<'_> {
    fn from(text: String) -> Self {
        Self::Text(text.into())
    }
}

/// Messages of one file.
type Bundle = FluentBundle<Arc<FluentResource>>;

/// Values of a message's variables, and the message with them.
type Remembered = (Vec<Variable<'static>>, Arc<str>);

/// The texts in one language.
pub struct UiStrings {
    code: String,
    /// Its own messages, a museum's before the shipped ones; then those of the languages that stand in for it, English last.
    bundles: Vec<Arc<Bundle>>,
    /// Messages without variables by [`TextId`]; `None` for the others.
    constant: Vec<Option<Box<str>>>,
    /// Lately formatted messages by [`TextId`], the newest last.
    formatted: Vec<Mutex<Vec<Remembered>>>,
    /// The language's name in the language, where one of its own files has it.
    name: Option<String>,
}

impl UiStrings {
    /// Formats all messages without variables. `bundles` end with English; the first `own` of them are the language's own.
    fn new(code: &str, bundles: Vec<Arc<Bundle>>, own: usize) -> Self {
        let name = bundles[..own].iter().find_map(|bundle| resolve(bundle, TextId::LanguageName.key(), None));
        let constant = |id: &TextId| {
            let found = || bundles.iter().find_map(|bundle| resolve(bundle, id.key(), None));
            // English has every message (a test says so); its key is better than a hole in a page.
            let text = || found().unwrap_or_else(|| id.key().to_owned()).into_boxed_str();
            file::english_variables(id.key()).is_empty().then(text)
        };
        Self {
            code: code.into(),
            constant: TextId::ALL.iter().map(constant).collect(),
            formatted: TextId::ALL.iter().map(|_| Mutex::default()).collect(),
            bundles,
            name,
        }
    }

    /// Code of the language, such as `en` or `pt-BR`.
    pub fn code(&self) -> &str {
        &self.code
    }

    /// A message without variables; the key of one that has some.
    pub fn get(&self, id: TextId) -> &str {
        self.constant[id as usize].as_deref().unwrap_or_else(|| id.key())
    }

    /// A message with its variables. Formatted again only where a variable differs from those of the last few calls.
    pub fn format(&self, id: TextId, variables: &[(&str, Variable)]) -> Arc<str> {
        debug_assert!(has_all(id, variables), "{}: {variables:?}", id.key());
        let mut remembered = self.formatted[id as usize].lock().unwrap_or_else(PoisonError::into_inner);
        let same = |values: &[Variable]| values.iter().eq(variables.iter().map(|(_, value)| value));
        if let Some((_, text)) = remembered.iter().find(|(values, _)| same(values)) {
            return text.clone();
        }
        let mut arguments = FluentArgs::new();
        for (name, value) in variables {
            match value {
                Variable::Count(count) => arguments.set(*name, *count),
                Variable::Text(text) => arguments.set(*name, text.as_ref()),
            }
        }
        let found = self.bundles.iter().find_map(|bundle| resolve(bundle, id.key(), Some(&arguments)));
        let text: Arc<str> = found.unwrap_or_else(|| id.key().into()).into();
        if remembered.len() >= REMEMBERED {
            remembered.remove(0);
        }
        let values = variables.iter().map(|(_, value)| match value {
            Variable::Count(count) => Variable::Count(*count),
            Variable::Text(text) => Variable::Text(text.clone().into_owned().into()),
        });
        remembered.push((values.collect(), text.clone()));
        text
    }

    /// All texts, those with variables as the words around the variables: what a font must be able to write.
    pub fn all(&self) -> impl Iterator<Item = String> {
        TextId::ALL.iter().map(|id| match self.constant[*id as usize].as_deref() {
            Some(text) => text.to_owned(),
            None => {
                let names = file::english_variables(id.key());
                let variables: Vec<_> = names.iter().map(|name| (name.as_str(), Variable::Count(2))).collect();
                self.format(*id, &variables).to_string()
            }
        })
    }
}

/// Are these the variables that the message has in English?
fn has_all(id: TextId, variables: &[(&str, Variable)]) -> bool {
    let known = file::english_variables(id.key());
    known.len() == variables.len() && variables.iter().all(|(name, _)| known.iter().any(|known| known == name))
}

/// A message of one file; `None` where the file lacks it or it cannot be formatted.
fn resolve(bundle: &Bundle, key: &str, arguments: Option<&FluentArgs>) -> Option<String> {
    let pattern = bundle.get_message(key)?.value()?;
    let mut errors = Vec::new();
    let text = bundle.format_pattern(pattern, arguments, &mut errors);
    errors.is_empty().then(|| text.into_owned())
}

/// The texts in all languages.
pub struct Translations {
    /// English first, then the other shipped ones, then those that the museum has added.
    languages: Vec<UiStrings>,
    /// Names of languages without texts, by code.
    other_names: BTreeMap<String, String>,
}

impl Default for Translations {
    fn default() -> Self {
        Self::with_files(Vec::new())
    }
}

impl Translations {
    /// The shipped texts and, over them, the files of the folder [`FOLDER`] beside a configuration file. Whatever is wrong with
    /// them is logged; the shipped text stays wherever a message of theirs cannot be used.
    pub fn load(configuration: Option<&Path>) -> Self {
        let folder = configuration.and_then(Path::parent).map(|folder| folder.join(FOLDER));
        let mut read = Vec::new();
        for path in folder.iter().flat_map(|folder| files(folder)) {
            let (file, problems) = TextFile::read(&path);
            problems.iter().for_each(|problem| tracing::warn!("{problem}"));
            read.extend(file);
        }
        Self::with_files(read)
    }

    /// The shipped texts with those of these files over them.
    pub fn with_files(files: Vec<TextFile>) -> Self {
        // By language: the shipped messages, then the museum's.
        let shipped =
            |(code, text): &(&str, &str)| ((*code).to_owned(), vec![Arc::new(bundle(code, [tolerant(text)]))]);
        let mut sources: Vec<(String, Vec<Arc<Bundle>>)> = SHIPPED.iter().map(shipped).collect();
        for TextFile { language, resource } in files {
            let bundle = Arc::new(bundle(&language, [resource]));
            match sources.iter_mut().find(|(code, _)| *code == language) {
                Some((_, bundles)) => bundles.push(bundle),
                None => sources.push((language, vec![bundle])),
            }
        }
        let of = |code: &str| {
            let found = sources.iter().find(|(known, _)| known == code);
            found.into_iter().flat_map(|(_, bundles)| bundles.iter().rev().cloned())
        };
        let strings = |(code, _): &(String, Vec<_>)| {
            let mut bundles: Vec<_> = parents(code).iter().flat_map(|code| of(code)).collect();
            let own = bundles.len();
            bundles.extend(of("en"));
            UiStrings::new(code, bundles, own)
        };
        let languages = sources.iter().map(strings).collect();
        let names = bundle("en", [tolerant(LANGUAGE_NAMES)]);
        let name = |code: String| Some((resolve(&names, &code, None)?, code)).map(|(name, code)| (code, name));
        let other_names = variables(LANGUAGE_NAMES).into_keys().filter_map(name).collect();
        Self { languages, other_names }
    }

    /// The texts in a language: in it, else in the language without its region, else in English.
    pub fn get(&self, language: &str) -> &UiStrings {
        self.known(language).unwrap_or(&self.languages[0])
    }

    /// All languages, English first.
    pub fn languages(&self) -> impl Iterator<Item = &UiStrings> {
        self.languages.iter()
    }

    /// The name of a language in the language; its code where the kiosk does not know the name.
    pub fn language_name<'a>(&'a self, language: &'a str) -> &'a str {
        let own = self.known(language).and_then(|strings| strings.name.as_deref());
        let other = || self.other_names.get(parents(language).last()?).map(String::as_str);
        own.or_else(other).unwrap_or(language)
    }

    /// The texts in a language, or in the language without its region.
    fn known(&self, language: &str) -> Option<&UiStrings> {
        let find = |code: &String| self.languages.iter().find(|strings| strings.code == *code);
        parents(language).iter().find_map(find)
    }
}

/// The shipped file of a language.
fn shipped_text(language: &str) -> &'static str {
    SHIPPED.iter().find(|(code, _)| *code == language).map_or("", |(_, text)| text)
}

/// The messages of files in one language; a later file overrides an earlier one.
fn bundle(code: &str, resources: impl IntoIterator<Item = Arc<FluentResource>>) -> Bundle {
    let language: LanguageIdentifier = code.parse().unwrap_or_default();
    let mut bundle = FluentBundle::new_concurrent(vec![language]);
    bundle.set_use_isolating(false);
    resources.into_iter().for_each(|resource| bundle.add_resource_overriding(resource));
    bundle
}

/// A language code in its canonical form, and the same with fewer and fewer subtags: `pt-BR`, `pt`.
fn parents(language: &str) -> Vec<String> {
    let mut code = canonical(language).unwrap_or_default();
    let mut chain = Vec::new();
    while !code.is_empty() {
        chain.push(code.clone());
        code.truncate(code.rfind('-').unwrap_or(0));
    }
    chain
}

/// A language code as Unicode writes it, such as `pt-BR` for `pt_br`; `None` for anything else.
fn canonical(language: &str) -> Option<String> {
    let parsed: LanguageIdentifier = language.parse().ok()?;
    Some(parsed.to_string()).filter(|code| code != "und")
}

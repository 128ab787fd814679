//! Old names of keys and words in files: one table for reading, for the JSON Schema and for `soffio check --fix`.
//!
//! A file with old names is read as if it had the new ones. [`update`] replaces each old name where it stands, so that
//! comments and layout stay, and says what it replaced. Readers parse the updated text and turn the replacements into
//! warnings; `soffio check --fix` writes the updated text back.
//!
//! An old name is one row of [`OLD_NAMES`]. Nothing else has to know it.

mod json;
mod schema;
mod toml;

use std::borrow::Cow;
use std::fmt;
use std::ops::Range;

pub use schema::add_old_names;

/// Kind of a file whose names have changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileKind {
    /// The site's configuration, `kiosk.toml`.
    Configuration,
    /// An exhibit's sidecar, `exhibit.toml`.
    Sidecar,
    /// A physics scene, JSON.
    Scene,
}

/// What is renamed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Subject {
    /// A key below the path.
    Key,
    /// A word that is the value of the key at the path.
    Word,
}

/// One old name, and the new one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OldName {
    /// Files in which it stands.
    pub file: FileKind,
    /// What is renamed.
    pub subject: Subject,
    /// Keys from the top of the file, by their new names, joined by dots. `*` stands for any key; the entries of a list
    /// have the path of the list.
    pub path: &'static str,
    /// The old name.
    pub old: &'static str,
    /// The new name.
    pub new: &'static str,
}

const fn key(file: FileKind, path: &'static str, old: &'static str, new: &'static str) -> OldName {
    OldName { file, subject: Subject::Key, path, old, new }
}

const fn word(file: FileKind, path: &'static str, old: &'static str, new: &'static str) -> OldName {
    OldName { file, subject: Subject::Word, path, old, new }
}

/// All old names.
pub const OLD_NAMES: &[OldName] = &[
    key(FileKind::Configuration, "", "room", "reverb"),
    key(FileKind::Configuration, "", "care", "maintenance"),
    key(FileKind::Configuration, "maintenance", "chirp_at", "audio_self_test_at"),
    key(FileKind::Configuration, "exhibits.groups", "works", "exhibits"),
    key(FileKind::Configuration, "audio", "loudspeaker", "output"),
    key(FileKind::Configuration, "audio", "second_capsule_channel", "second_microphone_channel"),
    key(FileKind::Configuration, "visit", "calm", "reduced_motion"),
    key(FileKind::Configuration, "visit", "reads_aloud", "read_aloud"),
    word(FileKind::Configuration, "breath.profile", "true", "physical"),
    key(FileKind::Sidecar, "scene", "gathers", "assembly_animation"),
    key(FileKind::Sidecar, "wind", "calm", "idle_damping"),
    key(FileKind::Sidecar, "wind", "room", "ambient"),
    key(FileKind::Sidecar, "clock", "by_blow", "by_strike"),
    key(FileKind::Sidecar, "clock.by_hour", "turn", "angle"),
    key(FileKind::Sidecar, "clock.by_strike", "turn", "angle"),
    key(FileKind::Sidecar, "attract.step", "look", "camera"),
    key(FileKind::Sidecar, "label.*.text", "given", "breath_time"),
    word(FileKind::Scene, "format", "isaac-bench-scene/1", "soffio-scene/1"),
];

/// An old name that was replaced.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Replacement {
    /// Its bytes in the file.
    pub span: Range<usize>,
    /// The row of the table.
    pub name: OldName,
    /// The replacement, quotes included.
    text: String,
}

impl fmt::Display for Replacement {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let OldName { subject, path, old, new, .. } = self.name;
        match (subject, path) {
            (Subject::Key, "") => write!(f, "`{old}` is now called `{new}`"),
            (Subject::Key, path) => write!(f, "`{path}.{old}` is now called `{path}.{new}`"),
            (Subject::Word, path) => write!(f, "\"{old}\" of `{path}` is now called \"{new}\""),
        }
    }
}

/// A file's text with new names.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Updated<'a> {
    /// The text; borrowed where it has no old name.
    pub text: Cow<'a, str>,
    /// What was replaced, in the order of the file.
    pub replacements: Vec<Replacement>,
}

impl Updated<'_> {
    /// Bytes of the file itself for bytes of the updated text. Inside of a new name it is the whole old one.
    pub fn original(&self, span: Range<usize>) -> Range<usize> {
        let place = |offset: usize, end: bool| {
            // Bytes of the updated text are ahead of those of the file by this much.
            let mut ahead = 0_isize;
            for Replacement { span, text, .. } in &self.replacements {
                let start = span.start.saturating_add_signed(ahead);
                if offset < start {
                    break;
                }
                if offset < start + text.len() + usize::from(end) {
                    return if end && offset > start { span.end } else { span.start };
                }
                ahead += text.len() as isize - span.len() as isize;
            }
            offset.saturating_add_signed(-ahead)
        };
        let start = place(span.start, false);
        start..place(span.end, true).max(start)
    }

    /// Explains a syntax error at bytes of the updated text that the file itself, `text`, does not have: one table has
    /// both the old and the new name of a key, so that the new name stands there twice. `None` for any other error.
    pub fn duplicate(&self, text: &str, span: Range<usize>) -> Option<OldName> {
        let name = self.text.get(span.clone())?.trim_matches(['"', '\'']);
        let mut ahead = 0_isize;
        let renamed: Vec<(usize, OldName)> = self
            .replacements
            .iter()
            .map(|Replacement { span, name, text }| {
                let start = span.start.saturating_add_signed(ahead);
                ahead += text.len() as isize - span.len() as isize;
                (start, *name)
            })
            .collect();
        // The old name is the second of the two, where the error is, or the first, before it.
        let (_, found) = *renamed
            .iter()
            .rev()
            .find(|(start, old)| *start <= span.start && old.subject == Subject::Key && old.new == name)?;
        toml_edit::Document::parse(text).is_ok().then_some(found)
    }
}

impl OldName {
    /// What is wrong where a table has both names of a key.
    pub fn duplicate_message(&self) -> String {
        format!("`{}` and `{}` are one key: `{}` is its old name", self.new, self.old, self.old)
    }

    /// What to do where a table has both names of a key.
    pub fn duplicate_help(&self) -> String {
        format!("keep one of the two, `{}`", self.new)
    }
}

/// Replaces the old names in the text of a file. A text with a broken grammar comes back as far as it could be read; its
/// reader says what is wrong with it.
pub fn update(kind: FileKind, text: &str) -> Updated<'_> {
    let replacements = match kind {
        FileKind::Configuration | FileKind::Sidecar => toml::replacements(kind, text),
        FileKind::Scene => json::replacements(kind, text),
    };
    if replacements.is_empty() {
        return Updated { text: Cow::Borrowed(text), replacements };
    }
    let mut updated = String::with_capacity(text.len());
    let mut done = 0;
    for Replacement { span, text: new, .. } in &replacements {
        updated += &text[done..span.start];
        updated += new;
        done = span.end;
    }
    updated += &text[done..];
    Updated { text: Cow::Owned(updated), replacements }
}

/// Where the walk over a file stands: keys from the top, by their new names.
#[derive(Debug)]
struct Place {
    kind: FileKind,
    path: Vec<String>,
    found: Vec<Replacement>,
}

impl Place {
    fn new(kind: FileKind) -> Self {
        Self { kind, path: Vec::new(), found: Vec::new() }
    }

    /// Goes to a key below the present place. `quoted`: the new name needs quotes.
    fn enter(&mut self, key: String, span: Range<usize>, quoted: bool) {
        match self.look_up(Subject::Key, &key) {
            Some(name) => {
                let text = if quoted { format!("\"{}\"", name.new) } else { name.new.to_owned() };
                self.found.push(Replacement { span, name, text });
                self.path.push(name.new.to_owned());
            }
            None => self.path.push(key),
        }
    }

    /// A text is the value at the present place.
    fn value(&mut self, value: &str, span: Range<usize>) {
        if let Some(name) = self.look_up(Subject::Word, value) {
            self.found.push(Replacement { span, name, text: format!("\"{}\"", name.new) });
        }
    }

    fn look_up(&self, subject: Subject, old: &str) -> Option<OldName> {
        OLD_NAMES.iter().copied().find(|name| {
            name.file == self.kind && name.subject == subject && name.old == old && is_at(name.path, &self.path)
        })
    }
}

/// Is this the path of the table?
fn is_at(path: &str, keys: &[String]) -> bool {
    let wanted: Vec<&str> = path.split('.').filter(|key| !key.is_empty()).collect();
    wanted.len() == keys.len() && wanted.iter().zip(keys).all(|(wanted, key)| *wanted == "*" || *wanted == key)
}

//! Faults of a model file: the place as a JSON path (`accessors[3].bufferView`), what is wrong there, and its cause.
//!
//! Each cause has its own remedy, for a curator who has the model's file and the program that wrote it. Only a file that
//! ends too early is said to be cut short.

use std::fmt;

use super::super::budget::Excess;
use super::super::codes::{self, Code};
use super::super::diagnostic::Diagnostic;

/// Most faults of one severity in a report; the rest are counted.
pub const MAX_SHOWN: usize = 20;

/// Why a model is refused, or what a warning is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cause {
    /// The file ends before its own length says.
    Truncated,
    /// Neither JSON nor a GLB.
    NotGltf,
    /// Another version of glTF.
    Version,
    /// The chunks of a GLB contradict each other.
    Container,
    /// Not JSON.
    Json,
    /// A required field is missing.
    Missing,
    /// A value has the wrong JSON type.
    WrongType,
    /// A number or word is not among those allowed.
    Range,
    /// An index is beyond the end of its list.
    Index,
    /// A buffer has fewer bytes than it should.
    ShortBuffer,
    /// An accessor or a view reaches beyond what contains it.
    Outside,
    /// An accessor begins at the wrong multiple of bytes.
    Misaligned,
    /// A number is infinite or not a number.
    NotFinite,
    /// An accessor does not have the format that its use needs.
    Format,
    /// Lists that belong together differ in length.
    Count,
    /// A primitive names a vertex that it does not have.
    Vertex,
    /// A vertex follows a joint that its skin does not have.
    Joint,
    /// Nodes are their own ancestors, or have two parents.
    Tree,
    /// Fields that exclude each other.
    Conflict,
    /// Keys of an animation.
    Keys,
    /// A required extension is not supported.
    Extension,
    /// An image cannot be decoded.
    Image,
    /// A URI cannot be read.
    Uri,
    /// A length, position or scale beyond what a museum can hold.
    Size,
    /// More than this program reads.
    Limit,
    /// More than an exhibit may cost.
    Budget,
    /// Contradicts glTF 2.0 without effect here: a warning.
    Harmless,
    /// Valid, and not shown: a warning.
    Skipped,
}

impl Cause {
    /// Every cause.
    #[cfg(test)]
    pub const ALL: [Self; 28] = [
        Self::Truncated,
        Self::NotGltf,
        Self::Version,
        Self::Container,
        Self::Json,
        Self::Missing,
        Self::WrongType,
        Self::Range,
        Self::Index,
        Self::ShortBuffer,
        Self::Outside,
        Self::Misaligned,
        Self::NotFinite,
        Self::Format,
        Self::Count,
        Self::Vertex,
        Self::Joint,
        Self::Tree,
        Self::Conflict,
        Self::Keys,
        Self::Extension,
        Self::Image,
        Self::Uri,
        Self::Size,
        Self::Limit,
        Self::Budget,
        Self::Harmless,
        Self::Skipped,
    ];

    /// The code in reports.
    pub fn code(self) -> Code {
        match self {
            Self::Truncated => codes::TRUNCATED,
            Self::NotGltf | Self::Version => codes::NOT_GLTF,
            Self::Tree => codes::CYCLE,
            Self::Extension => codes::EXTENSION,
            Self::Image => codes::IMAGE,
            Self::Size => codes::MODEL_SIZE,
            Self::Limit => codes::MODEL_LIMIT,
            Self::Budget => codes::BUDGET,
            Self::Harmless => codes::MODEL_FORM,
            Self::Skipped => codes::SKIPPED,
            _ => codes::BROKEN_MODEL,
        }
    }

    /// Is it a warning?
    pub fn is_warning(self) -> bool {
        matches!(self, Self::Harmless | Self::Skipped)
    }

    /// What to do.
    pub fn help(self) -> &'static str {
        match self {
            Self::Truncated => "copy or download the file again, whole; a copy may have been cut short",
            Self::NotGltf => "a model is a .glb or .gltf file; in Blender: File > Export > glTF 2.0",
            Self::Version => "export it as glTF 2.0",
            Self::Container => "write the file's chunks again: gltf-transform copy in.glb out.glb",
            Self::Json => "correct the JSON at that line in a text editor, or export the model again",
            Self::Missing => "add the field, or export with another version of the program that made the file",
            Self::WrongType => "write a value of that type, or export with another version of the program",
            Self::Range => "set a value in that range in the program that made the model, and export again",
            Self::Index => "counting begins at 0; export again with the object that is named, or without its use",
            Self::ShortBuffer => "export the model and its .bin together, and copy both from the same export",
            Self::Outside => "the lengths contradict each other; export again with another version of the program",
            Self::Misaligned => "align the data: gltf-transform copy in.glb out.glb",
            Self::NotFinite => "look for a scale of zero or a division by zero in the program that made the model",
            Self::Format => "another accessor may be meant; export again with another version of the program",
            Self::Count => "give every list one entry for each; in Blender, apply the modifiers before the export",
            Self::Vertex => "in Blender: Mesh > Clean Up > Merge by Distance, then export again",
            Self::Joint => "in Blender: limit the vertex groups to the bones of the armature, then export again",
            Self::Tree => "give each node one parent and copy it for others, then export again",
            Self::Conflict => "keep one of them, and export again",
            Self::Keys => "in Blender: bake the action to key frames, then export again",
            Self::Extension => "export the model again without it",
            Self::Image => "PNG and JPEG are read; convert others: gltf-transform png in.glb out.glb",
            Self::Uri => "put the file beside the model and give its path from there; or export as one .glb",
            Self::Size => "lengths are in metres: scale the model from millimetres or inches, apply, and export again",
            Self::Limit => "simplify the model: gltf-transform simplify in.glb out.glb",
            Self::Budget => "make the model smaller: gltf-transform optimize in.glb out.glb --texture-size 2048",
            Self::Harmless => "it makes no difference here; other programs may refuse the file",
            Self::Skipped => "change it in the program that made the model if it should be seen",
        }
    }
}

/// One fault.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// Its cause.
    pub cause: Cause,
    /// JSON path; empty where the whole file is meant.
    pub place: String,
    /// What is wrong there.
    pub what: String,
    /// A remedy of its own instead of the cause's.
    pub remedy: Option<String>,
}

impl Fault {
    /// A fault at a place.
    pub fn at(cause: Cause, place: impl fmt::Display, what: impl fmt::Display) -> Self {
        Self { cause, place: place.to_string(), what: what.to_string(), remedy: None }
    }

    /// A fault of the whole file.
    pub fn new(cause: Cause, what: impl fmt::Display) -> Self {
        Self::at(cause, "", what)
    }

    /// What is at a place costs too much.
    pub fn excess(excess: Excess, place: impl fmt::Display) -> Self {
        Self::at(Cause::Budget, place, excess).remedy(excess.help())
    }

    /// Sets a remedy of its own.
    pub fn remedy(mut self, remedy: impl Into<String>) -> Self {
        self.remedy = Some(remedy.into());
        self
    }

    /// Puts a place before its own: `accessors[2]` as what `meshes[0]` reads.
    pub fn within(mut self, place: impl fmt::Display) -> Self {
        self.place = if self.place.is_empty() { place.to_string() } else { format!("{place}: {}", self.place) };
        self
    }

    /// As a diagnostic of the file.
    pub fn diagnostic(&self, file: &str) -> Diagnostic {
        let Self { cause, place, what, remedy } = self;
        let colon = if place.is_empty() { "" } else { ": " };
        Diagnostic::new(cause.code(), format!("{file}: {place}{colon}{what}"))
            .help(remedy.as_deref().unwrap_or_else(|| cause.help()))
    }
}

/// A JSON path in the making; it costs nothing until it is shown.
#[derive(Clone, Copy)]
pub enum Place<'a> {
    /// The document.
    Root,
    /// A field.
    Key(&'a Place<'a>, &'a str),
    /// An entry of a list.
    Item(&'a Place<'a>, usize),
}

impl fmt::Display for Place<'_> {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Root => Ok(()),
            Self::Key(Place::Root, key) => f.write_str(key),
            Self::Key(above, key) => write!(f, "{above}.{key}"),
            Self::Item(above, index) => write!(f, "{above}[{index}]"),
        }
    }
}

/// Faults as they are found: errors and warnings, at most [`MAX_SHOWN`] of each with their texts.
#[derive(Debug, Default)]
pub struct Faults {
    /// Errors.
    pub errors: Vec<Fault>,
    /// Warnings.
    pub warnings: Vec<Fault>,
    /// Errors and warnings beyond the limit.
    pub more: [usize; 2],
}

impl Faults {
    /// Adds a fault.
    pub fn add(&mut self, cause: Cause, place: impl fmt::Display, what: impl fmt::Display) {
        let warning = cause.is_warning();
        let list = if warning { &mut self.warnings } else { &mut self.errors };
        if list.len() < MAX_SHOWN {
            list.push(Fault::at(cause, place, what));
        } else {
            self.more[usize::from(warning)] += 1;
        }
    }

    /// Adds a finished fault.
    pub fn push(&mut self, fault: Fault) {
        let remedy = fault.remedy.clone();
        let before = self.errors.len();
        self.add(fault.cause, fault.place, fault.what);
        if let Some(last) = self.errors.get_mut(before) {
            last.remedy = remedy;
        }
    }

    /// The warnings as diagnostics.
    pub fn warnings(&self, file: &str) -> Vec<Diagnostic> {
        listed(&self.warnings, self.more[1], file)
    }

    /// The errors as diagnostics.
    pub fn errors(&self, file: &str) -> Vec<Diagnostic> {
        listed(&self.errors, self.more[0], file)
    }
}

fn listed(faults: &[Fault], more: usize, file: &str) -> Vec<Diagnostic> {
    let mut all: Vec<Diagnostic> = faults.iter().map(|fault| fault.diagnostic(file)).collect();
    if let Some(last) = faults.last().filter(|_| more > 0) {
        let rest = Fault::new(last.cause, format_args!("and {more} more"));
        all.push(rest.diagnostic(file));
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_cause_has_a_remedy_of_its_own_and_only_a_truncated_file_is_called_cut_short() {
        for (i, cause) in Cause::ALL.iter().enumerate() {
            assert!(Cause::ALL[..i].iter().all(|other| other.help() != cause.help()), "{cause:?}");
            assert_eq!(cause.help().contains("cut short"), *cause == Cause::Truncated, "{cause:?}");
            assert_eq!(cause.code().name.starts_with('W'), cause.is_warning(), "{cause:?}");
        }
    }

    #[test]
    fn a_place_is_shown_as_a_path_and_long_lists_are_counted() {
        let list = Place::Key(&Place::Root, "accessors");
        let item = Place::Item(&list, 3);
        assert_eq!(Place::Key(&item, "bufferView").to_string(), "accessors[3].bufferView");
        let mut faults = Faults::default();
        (0..MAX_SHOWN + 5).for_each(|i| faults.add(Cause::Harmless, Place::Item(&list, i), "is odd"));
        let shown = faults.warnings("a.glb");
        assert_eq!(shown.len(), MAX_SHOWN + 1);
        assert!(shown[MAX_SHOWN].message.contains("and 5 more"));
        assert!(faults.errors.is_empty());
    }
}

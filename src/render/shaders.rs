//! Shader sources: built in, or read from a folder while somebody works on them.
//!
//! Invariant: a [`Shaders`] value is valid; a folder with a mistake gives an error and whoever draws keeps the last good
//! one.

use std::borrow::Cow;
use std::path::Path;

use wgpu::naga;

/// A shader and the files it is put together from.
const PARTS: [(&str, &[&str]); 7] = [
    ("forward", &["common", "lighting", "outline", "forward"]),
    ("room", &["common", "lighting", "room"]),
    ("shadows", &["common", "shadows", "sheets"]),
    ("wires", &["common", "lighting", "wires"]),
    ("motes", &["common", "motes"]),
    ("resolve", &["resolve"]),
    ("stretch", &["stretch"]),
];

/// The files as they were when the program was built.
const BUILT_IN: [(&str, &str); 11] = [
    ("common", include_str!("wgsl/common.wgsl")),
    ("lighting", include_str!("wgsl/lighting.wgsl")),
    ("outline", include_str!("wgsl/outline.wgsl")),
    ("forward", include_str!("wgsl/forward.wgsl")),
    ("room", include_str!("wgsl/room.wgsl")),
    ("shadows", include_str!("wgsl/shadows.wgsl")),
    ("sheets", include_str!("wgsl/sheets.wgsl")),
    ("wires", include_str!("wgsl/wires.wgsl")),
    ("motes", include_str!("wgsl/motes.wgsl")),
    ("resolve", include_str!("wgsl/resolve.wgsl")),
    ("stretch", include_str!("wgsl/stretch.wgsl")),
];

/// What a folder's shaders can be wrong with.
#[derive(Debug, thiserror::Error)]
pub enum ShaderError {
    /// A file could not be read.
    #[error("{0}: {1}")]
    Read(String, std::io::Error),
    /// Not valid WGSL; the place is in the text of all files of this shader, one after the other.
    #[error("shader {0} is not valid: {1}")]
    Invalid(&'static str, String),
}

/// Valid sources of all shaders.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Shaders {
    sources: Vec<(&'static str, String)>,
}

impl Default for Shaders {
    fn default() -> Self {
        let file = |name: &str| BUILT_IN.iter().find(|(n, _)| *n == name).map_or("", |(_, text)| text);
        let sources = PARTS.map(|(name, parts)| (name, parts.iter().map(|part| file(part)).collect()));
        Self { sources: sources.into() }
    }
}

impl Shaders {
    /// Reads and checks the shaders in a folder.
    pub fn load(folder: &Path) -> Result<Self, ShaderError> {
        let mut sources = Vec::new();
        for (name, parts) in PARTS {
            let mut text = String::new();
            for part in parts {
                let path = folder.join(part).with_extension("wgsl");
                let file = std::fs::read_to_string(&path);
                text += &file.map_err(|error| ShaderError::Read(path.display().to_string(), error))?;
            }
            validate(&text).map_err(|error| ShaderError::Invalid(name, error))?;
            sources.push((name, text));
        }
        Ok(Self { sources })
    }

    /// Name and source of each shader.
    pub fn iter(&self) -> impl Iterator<Item = (&'static str, &str)> {
        self.sources.iter().map(|(name, text)| (*name, text.as_str()))
    }

    /// Source of one.
    pub(super) fn source(&self, name: &str) -> Cow<'static, str> {
        Cow::Owned(self.iter().find(|(n, _)| *n == name).map_or(String::new(), |(_, text)| text.to_owned()))
    }
}

/// Does a shader parse and ask for nothing beyond core WebGPU? The answer does not need a driver.
pub fn validate(source: &str) -> Result<naga::Module, String> {
    let module = naga::front::wgsl::parse_str(source).map_err(|error| error.emit_to_string(source))?;
    naga::valid::Validator::new(naga::valid::ValidationFlags::all(), naga::valid::Capabilities::empty())
        .validate(&module)
        .map_err(|error| error.emit_to_string(source))?;
    Ok(module)
}

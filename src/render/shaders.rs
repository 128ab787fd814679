//! Shader sources: built in, or read from a folder during development.
//!
//! Invariant: a [`Shaders`] value is valid; loading a folder with a mistake fails, and the last valid one stays in use.

use std::borrow::Cow;
use std::path::Path;

use wgpu::naga;

/// The files that each shader is concatenated from.
const SOURCES: [(&str, &[&str]); 7] = [
    ("forward", &["common", "lighting", "outline", "forward"]),
    ("gallery", &["common", "lighting", "gallery"]),
    ("shadows", &["common", "shadows", "plate_shadows"]),
    ("wires", &["common", "lighting", "wires"]),
    ("dust", &["common", "dust"]),
    ("resolve", &["resolve"]),
    ("upscale", &["upscale"]),
];

/// The files at the time of the build.
const BUILT_IN: [(&str, &str); 11] = [
    ("common", include_str!("wgsl/common.wgsl")),
    ("lighting", include_str!("wgsl/lighting.wgsl")),
    ("outline", include_str!("wgsl/outline.wgsl")),
    ("forward", include_str!("wgsl/forward.wgsl")),
    ("gallery", include_str!("wgsl/gallery.wgsl")),
    ("shadows", include_str!("wgsl/shadows.wgsl")),
    ("plate_shadows", include_str!("wgsl/plate_shadows.wgsl")),
    ("wires", include_str!("wgsl/wires.wgsl")),
    ("dust", include_str!("wgsl/dust.wgsl")),
    ("resolve", include_str!("wgsl/resolve.wgsl")),
    ("upscale", include_str!("wgsl/upscale.wgsl")),
];

/// Errors of shader folders.
#[derive(Debug, thiserror::Error)]
pub enum ShaderError {
    /// A file could not be read.
    #[error("{0}: {1}")]
    Read(String, std::io::Error),
    /// Not valid WGSL; lines count in the concatenated files of this shader.
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
        let sources = SOURCES.map(|(name, parts)| (name, parts.iter().map(|part| file(part)).collect()));
        Self { sources: sources.into() }
    }
}

impl Shaders {
    /// Reads and validates the shaders in a folder.
    ///
    /// # Errors
    /// The first file that cannot be read, or shader that is not valid.
    pub fn load(folder: &Path) -> Result<Self, ShaderError> {
        let mut sources = Vec::new();
        for (name, parts) in SOURCES {
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

    /// Source of one shader.
    pub(super) fn source(&self, name: &str) -> Cow<'static, str> {
        Cow::Owned(self.iter().find(|(n, _)| *n == name).map_or(String::new(), |(_, text)| text.to_owned()))
    }
}

/// Parses and validates a shader for core WebGPU, without a driver.
///
/// # Errors
/// The message of the parser or validator.
pub fn validate(source: &str) -> Result<naga::Module, String> {
    let module = naga::front::wgsl::parse_str(source).map_err(|error| error.emit_to_string(source))?;
    naga::valid::Validator::new(naga::valid::ValidationFlags::all(), naga::valid::Capabilities::empty())
        .validate(&module)
        .map_err(|error| error.emit_to_string(source))?;
    Ok(module)
}

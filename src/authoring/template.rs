//! New exhibits as copies of a shipped one: its model and its sidecar under another id.

use toml_edit::{DocumentMut, value};

use super::{ExhibitFolder, FolderFile};

/// A shipped exhibit that serves as a template.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Template {
    /// The pendulum of a shelf clock.
    Pendulum,
    /// Eli Terry's clock.
    Clock,
}

impl Template {
    fn sources(self) -> (&'static str, &'static [u8]) {
        match self {
            Self::Pendulum => (
                include_str!("../../exhibits/pendulum/exhibit.toml"),
                include_bytes!("../../exhibits/pendulum/pendulum.glb"),
            ),
            Self::Clock => (
                include_str!("../../exhibits/terry-clock/exhibit.toml"),
                include_bytes!("../../exhibits/terry-clock/terry-clock.glb"),
            ),
        }
    }

    /// Its own timbres, by their paths in the folder.
    fn timbres(self) -> &'static [(&'static str, &'static str)] {
        match self {
            Self::Pendulum => &[("timbres/swing.toml", include_str!("../../exhibits/pendulum/timbres/swing.toml"))],
            Self::Clock => &[],
        }
    }

    /// A copy with another id. Its sidecar keeps the explanatory comments; level, joints and texts are those of the
    /// original.
    ///
    /// # Errors
    /// Where the shipped sidecar is not TOML.
    pub fn copy(self, id: &str) -> Result<ExhibitFolder, toml_edit::TomlError> {
        let (sidecar, model) = self.sources();
        let mut document: DocumentMut = sidecar.parse()?;
        // The first comment describes the shipped model.
        let about = "# Begun as a copy of a shipped exhibit. REPLACE its words ([label], [credit]) by yours; `soffio check`\n\
             # with this folder says what is wrong in this file, where, and what to do.\n";
        if let Some(mut key) = document.key_mut("schema") {
            key.leaf_decor_mut().set_prefix(about);
        }
        for (key, text) in [("model", format!("{id}.glb")), ("id", id.to_owned())] {
            document[key] = value(text);
        }
        let mut files = ExhibitFolder::files_of(id, document.to_string(), model.to_vec());
        files.extend(self.timbres().iter().map(|&(name, text)| FolderFile { name: name.into(), bytes: text.into() }));
        Ok(ExhibitFolder { files, remarks: Vec::new() })
    }
}

//! What staff set in their panel, as a layer over the configuration file.
//!
//! The file of an installed kiosk belongs to its administrator: a program that changed it would stop the package's updates at a
//! question. So the panel writes a file of its own in the folder of the kiosk's state. It has the keys of [`STAFF_KEYS`] and no others:
//! a program that can write there cannot change a PIN.

use std::path::{Path, PathBuf};

use super::diagnose::{self, ConfigError, Problem};
use super::{Config, LoadedConfig};

/// Name of the file with the settings of staff, in the folder of the kiosk's state.
pub const STAFF_FILE: &str = "overrides.toml";

/// Keys that the panel sets: table and key.
pub const STAFF_KEYS: [(&str, &str); 2] = [("exhibits", "show"), ("breath", "sensitivity_db")];

/// The layer of a loaded configuration.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StaffOverrides {
    /// Its file.
    pub file: PathBuf,
    /// Dotted keys that it sets.
    pub keys: Vec<String>,
    /// Why it is left out, if it is.
    pub problem: Option<String>,
}

impl StaffOverrides {
    /// One line for staff: what is set, or why nothing is.
    pub fn summary(&self) -> String {
        match &self.problem {
            Some(problem) => format!("the settings of the staff panel are left out:\n{problem}"),
            None => {
                let (keys, file) = (self.keys.join(", "), self.file.display());
                format!("set in the staff panel, over the configuration: {keys} ({file}; delete it to undo this)")
            }
        }
    }
}

impl LoadedConfig {
    /// The configuration with the settings of staff in `folder` laid over it. A missing or empty file changes nothing; a broken one is
    /// left out as a whole, with its problem in [`LoadedConfig::staff`].
    #[must_use]
    pub fn with_staff_overrides(mut self, folder: &Path) -> Self {
        let file = folder.join(STAFF_FILE);
        let text = match std::fs::read_to_string(&file) {
            Ok(text) => text,
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => return self,
            Err(error) => {
                let problem = Some(ConfigError::unreadable(&file, &error).to_string());
                self.staff = Some(StaffOverrides { file, keys: Vec::new(), problem });
                return self;
            }
        };
        match layer(&self.config, &text, &file) {
            Ok((_, keys)) if keys.is_empty() => {}
            Ok((config, keys)) => {
                self.config = config;
                self.staff = Some(StaffOverrides { file, keys, problem: None });
            }
            Err(error) => {
                self.staff = Some(StaffOverrides { file, keys: Vec::new(), problem: Some(error.to_string()) });
            }
        }
        self
    }
}

/// The configuration with the keys of `text` in their places, and these keys.
fn layer(config: &Config, text: &str, file: &Path) -> Result<(Config, Vec<String>), ConfigError> {
    // Grammar, names and ranges, each with its line.
    diagnose::parse(text, file)?;
    let fail = |message: String| {
        let keys = STAFF_KEYS.map(|(table, key)| format!("{table}.{key}")).join(" and ");
        let help = format!("only {keys} may be set here; put everything else into {}", super::FILE);
        ConfigError { file: file.into(), problems: vec![Problem { line: 0, column: 0, message, help }] }
    };
    let own = |error: &dyn std::fmt::Display| fail(error.to_string());
    let overrides: toml::Table = text.parse().map_err(|error: toml::de::Error| own(&error))?;
    let mut merged = toml::Table::try_from(config).map_err(|error| own(&error))?;
    let mut keys = Vec::new();
    for (name, table) in overrides {
        for (key, value) in table.as_table().cloned().unwrap_or_default() {
            let dotted = format!("{name}.{key}");
            if !STAFF_KEYS.contains(&(name.as_str(), key.as_str())) {
                return Err(fail(format!("`{dotted}` is no setting of the staff panel")));
            }
            if let Some(place) = merged.get_mut(&name).and_then(toml::Value::as_table_mut) {
                place.insert(key, value);
                keys.push(dotted);
            }
        }
    }
    let text = toml::to_string(&merged).map_err(|error| own(&error))?;
    let (config, _) = diagnose::parse(&text, file)?;
    Ok((config, keys))
}

//! The broker's password in a file of its own, which only the kiosk can read.

use std::path::Path;

use super::MqttSettings;
use super::diagnose::Problem;

/// Longest file that is a password, bytes.
const LONGEST: u64 = 1024;

/// Reads the password that `settings` name, relative to the folder of the configuration `file`. Returns a warning where that is
/// impossible: a kiosk without its broker still shows its exhibits.
pub(super) fn read_password(settings: &mut MqttSettings, file: &Path) -> Option<Problem> {
    if settings.password_file.as_os_str().is_empty() {
        return None;
    }
    let path = file.parent().unwrap_or(Path::new("")).join(&settings.password_file);
    let read = std::fs::metadata(&path).and_then(|metadata| match metadata.len() {
        0..=LONGEST => std::fs::read_to_string(&path),
        _ => Err(std::io::Error::other("it is too long for a password")),
    });
    match read {
        Ok(text) => {
            settings.password = text.trim_end_matches(['\r', '\n']).to_owned();
            // The password is now in the configuration, once.
            settings.password_file.clear();
            None
        }
        Err(error) => {
            let message = format!("mqtt.password_file: {} cannot be read: {error}", path.display());
            let help = "make it with the password on one line, mode 0640 and the kiosk's group; until then the broker is asked \
                        without a password";
            Some(Problem { line: 0, column: 0, message, help: help.into() })
        }
    }
}

//! One kiosk for one state folder: an advisory lock on a file in it, which ends with the process, however that ends.
//!
//! Without it a second kiosk would take the state of the running one for that of a run that crashed.

use std::fs::{File, TryLockError};
use std::io::{Read as _, Seek as _, Write as _};
use std::path::Path;

/// Name of the locked file. It holds the process id of its owner.
const FILE: &str = "kiosk.lock";

/// The right of this process to a state folder, for as long as it lives.
#[derive(Debug)]
pub struct InstanceLock(#[expect(dead_code, reason = "the open file is the lock")] File);

impl InstanceLock {
    /// Takes the lock of a folder. `None` where the folder has no lock file, as on a full or read-only disk, or its file system knows no
    /// locks; the reason is logged.
    ///
    /// # Errors
    /// Another kiosk uses the folder; the message names its process and says what to do.
    pub fn take(folder: &Path) -> Result<Option<Self>, String> {
        let path = folder.join(FILE);
        let mut options = File::options();
        options.read(true).write(true).create(true).truncate(false);
        #[cfg(unix)]
        std::os::unix::fs::OpenOptionsExt::mode(&mut options, 0o600);
        let mut file = match options.open(&path) {
            Ok(file) => file,
            Err(error) => {
                tracing::warn!("{} cannot be opened ({error}): a second kiosk would not be noticed", path.display());
                return Ok(None);
            }
        };
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => {
                let mut owner = String::new();
                let process = match file.read_to_string(&mut owner) {
                    Ok(_) if !owner.trim().is_empty() => format!(" (process {})", owner.trim()),
                    _ => String::new(),
                };
                return Err(format!(
                    "another kiosk{process} is running with the state folder {}: end it first, or give this one a folder of its \
                     own with staff.state",
                    folder.display()
                ));
            }
            Err(TryLockError::Error(error)) => {
                tracing::warn!("{} cannot be locked ({error}): a second kiosk would not be noticed", path.display());
                return Ok(None);
            }
        }
        let named = file.set_len(0).and_then(|()| file.rewind()).and_then(|()| write!(file, "{}", std::process::id()));
        if let Err(error) = named {
            tracing::warn!("{} cannot be written ({error}): it names no process", path.display());
        }
        Ok(Some(Self(file)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_is_one_kiosks_until_it_ends() {
        let folder = tempfile::tempdir().expect("a folder");
        let first = InstanceLock::take(folder.path()).expect("nobody else").expect("a lock");
        let refused = InstanceLock::take(folder.path()).expect_err("it is taken");
        assert!(refused.contains(&format!("(process {})", std::process::id())), "{refused}");
        drop(first);
        assert!(InstanceLock::take(folder.path()).expect("free again").is_some());
        assert!(InstanceLock::take(&folder.path().join("missing")).expect("no refusal").is_none());
    }
}

//! Folders that appear under their name only when they are whole: filled beside their place, then moved into it.

use std::io;
use std::path::{Path, PathBuf};

use tempfile::TempDir;

/// A folder on its way. Dropped before [`WholeFolder::finish`], it leaves nothing.
pub struct WholeFolder {
    aside: TempDir,
    path: PathBuf,
}

impl WholeFolder {
    /// Begins a folder beside its final place, which must not exist.
    pub fn create(path: &Path) -> io::Result<Self> {
        let taken = || io::Error::new(io::ErrorKind::AlreadyExists, format!("{} is there already", path.display()));
        if path.symlink_metadata().is_ok() {
            return Err(taken());
        }
        let parent = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let failed = |error: io::Error| {
            io::Error::new(error.kind(), format!("cannot make a folder in {}: {error}", parent.display()))
        };
        let mut builder = tempfile::Builder::new();
        builder.prefix(".soffio-");
        // Temporary folders are private; what a user asked for is an ordinary one, readable as the umask allows.
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o777));
        Ok(Self { aside: builder.tempdir_in(parent).map_err(failed)?, path: path.to_path_buf() })
    }

    /// Where its files are until it is whole.
    pub fn aside(&self) -> &Path {
        self.aside.path()
    }

    /// Writes a file, `name` with forward slashes; folders on its way are made.
    pub fn write(&self, name: &str, bytes: &[u8]) -> io::Result<()> {
        let path = self.aside.path().join(name);
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder)?;
        }
        std::fs::write(&path, bytes).map_err(|error| {
            io::Error::new(error.kind(), format!("cannot write {name}: {error}; is there space left?"))
        })
    }

    /// Puts the folder in its place.
    pub fn finish(self) -> io::Result<()> {
        // An empty folder that somebody has made meanwhile would be replaced silently.
        if self.path.symlink_metadata().is_ok() {
            let message = format!("{} is there already", self.path.display());
            return Err(io::Error::new(io::ErrorKind::AlreadyExists, message));
        }
        std::fs::rename(self.aside.path(), &self.path).map_err(|error| {
            io::Error::new(error.kind(), format!("cannot put {} in its place: {error}", self.path.display()))
        })?;
        // What the guard would remove is no longer there.
        let _gone = self.aside.keep();
        Ok(())
    }
}

//! Atomic folders: filled beside their destination and renamed when complete.

use std::io;
use std::path::{Path, PathBuf};

use tempfile::TempDir;

/// A folder that is not yet complete. Dropped before [`AtomicFolder::finish`], it leaves nothing.
pub struct AtomicFolder {
    aside: TempDir,
    path: PathBuf,
}

impl AtomicFolder {
    /// Creates a temporary folder beside `path`, which must not exist.
    ///
    /// # Errors
    /// `path` exists, or the folder cannot be created.
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
        // Temporary folders are private; the finished folder is an ordinary one, readable as the umask allows.
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o777));
        Ok(Self { aside: builder.tempdir_in(parent).map_err(failed)?, path: path.to_path_buf() })
    }

    /// The temporary folder.
    pub fn aside(&self) -> &Path {
        self.aside.path()
    }

    /// Writes a file, `name` with forward slashes; missing subfolders are created.
    ///
    /// # Errors
    /// The file or a subfolder cannot be written.
    pub fn write(&self, name: &str, bytes: &[u8]) -> io::Result<()> {
        let path = self.aside.path().join(name);
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder)?;
        }
        std::fs::write(&path, bytes).map_err(|error| {
            io::Error::new(error.kind(), format!("cannot write {name}: {error}; is there space left?"))
        })
    }

    /// Renames the folder to its destination.
    ///
    /// # Errors
    /// The folder cannot be renamed.
    pub fn finish(self) -> io::Result<()> {
        // An empty folder created meanwhile would be replaced silently.
        if self.path.symlink_metadata().is_ok() {
            let message = format!("{} is there already", self.path.display());
            return Err(io::Error::new(io::ErrorKind::AlreadyExists, message));
        }
        std::fs::rename(self.aside.path(), &self.path).map_err(|error| {
            io::Error::new(error.kind(), format!("cannot put {} in its place: {error}", self.path.display()))
        })?;
        // The guard's path no longer exists.
        let _gone = self.aside.keep();
        Ok(())
    }
}

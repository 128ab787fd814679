//! Files that appear whole or not at all: written beside their place under a private name, renamed when they are done.
//!
//! Invariant: at every moment the place holds what was there before, or all of the new file.

use std::fmt::Display;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

/// Begins a file that is to stand at `path`; [`put`] ends it.
pub fn begin(path: &Path) -> io::Result<NamedTempFile> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    if !folder.is_dir() {
        let why =
            format!("{} cannot be written: there is no folder {}; make it first", path.display(), folder.display());
        return Err(io::Error::new(io::ErrorKind::NotFound, why));
    }
    let mut builder = tempfile::Builder::new();
    // Temporary files are private; this one becomes an ordinary file, readable as the user's umask allows.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.tempfile_in(folder).map_err(|error| failed(path, &error))
}

/// Puts a finished file in its place.
pub fn put(file: NamedTempFile, path: &Path) -> io::Result<()> {
    file.persist(path).map(drop).map_err(|error| failed(path, &error.error))
}

/// The error of a file that could not be written: which, why, what to look at.
pub fn failed(path: &Path, why: &dyn Display) -> io::Error {
    let help = "check the folder, its permissions and the free space";
    io::Error::other(format!("{} cannot be written: {why}; {help}", path.display()))
}

/// Text or bytes that appear at their place when they are whole.
pub struct WholeFile {
    out: BufWriter<NamedTempFile>,
    path: PathBuf,
}

impl WholeFile {
    /// Begins a file beside its final place.
    pub fn create(path: &Path) -> io::Result<Self> {
        Ok(Self { out: BufWriter::new(begin(path)?), path: path.to_path_buf() })
    }

    /// Puts the file in its place.
    pub fn finish(self) -> io::Result<()> {
        let file = self.out.into_inner().map_err(|error| failed(&self.path, error.error()))?;
        put(file, &self.path)
    }
}

impl Write for WholeFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.out.write(bytes).map_err(|error| failed(&self.path, &error))
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush().map_err(|error| failed(&self.path, &error))
    }
}

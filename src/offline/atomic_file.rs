//! Atomic files: written beside their destination and renamed when complete, so an interrupted run leaves no partial
//! file.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

/// A file that is not yet complete. Dropped before [`AtomicFile::finish`], it leaves nothing.
pub struct AtomicFile {
    out: BufWriter<NamedTempFile>,
    path: PathBuf,
}

impl AtomicFile {
    /// Creates a temporary file beside `path`.
    ///
    /// # Errors
    /// Names the file and the cause.
    pub fn create(path: &Path) -> io::Result<Self> {
        let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
        if !folder.is_dir() {
            let why = format!("there is no folder {}; make it first", folder.display());
            return Err(io::Error::new(io::ErrorKind::NotFound, format!("cannot write {}: {why}", path.display())));
        }
        let mut builder = tempfile::Builder::new();
        // Temporary files are private; the finished file is an ordinary one, readable as the umask allows.
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
        let file = builder.tempfile_in(folder).map_err(|error| failed(path, &error))?;
        Ok(Self { out: BufWriter::new(file), path: path.to_path_buf() })
    }

    /// A second handle to the same file, for writers that take ownership.
    ///
    /// # Errors
    /// The system has no handle left.
    pub fn reopen(&self) -> io::Result<File> {
        self.out.get_ref().reopen()
    }

    /// Destination.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Renames the file to its destination.
    ///
    /// # Errors
    /// The file cannot be flushed or renamed.
    pub fn finish(self) -> io::Result<()> {
        let file = self.out.into_inner().map_err(|e| failed(&self.path, e.error()))?;
        file.persist(&self.path).map_err(|e| failed(&self.path, &e.error))?;
        Ok(())
    }
}

/// The error of a file that could not be written: which, why, what to check.
fn failed(path: &Path, why: &io::Error) -> io::Error {
    let help = "check the folder, its permissions and the free space";
    io::Error::new(why.kind(), format!("cannot write {}: {why}; {help}", path.display()))
}

impl Write for AtomicFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.out.write(bytes).map_err(|error| failed(&self.path, &error))
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush().map_err(|error| failed(&self.path, &error))
    }
}

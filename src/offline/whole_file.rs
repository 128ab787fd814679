//! Files that appear under their name only when they are whole: written beside their place, then moved into it. A run
//! that ends early leaves nothing half-written.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

/// A file on its way.
pub struct WholeFile {
    out: BufWriter<NamedTempFile>,
    path: PathBuf,
}

impl WholeFile {
    /// Begins a file beside its final place. The error names the file and what stands in the way.
    pub fn create(path: &Path) -> io::Result<Self> {
        let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
        if !folder.is_dir() {
            let why = format!("there is no folder {}; make it first", folder.display());
            return Err(io::Error::new(io::ErrorKind::NotFound, format!("cannot write {}: {why}", path.display())));
        }
        let mut builder = tempfile::Builder::new();
        // Temporary files are private; what a user asked for is an ordinary file, readable as the umask allows.
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
        let file = builder.tempfile_in(folder).map_err(|error| failed(path, &error))?;
        Ok(Self { out: BufWriter::new(file), path: path.to_path_buf() })
    }

    /// A second handle on the same bytes, for writers that keep theirs to themselves.
    pub fn reopen(&self) -> io::Result<File> {
        self.out.get_ref().reopen()
    }

    /// Where it will be.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Puts the file in its place.
    pub fn finish(self) -> io::Result<()> {
        let file = self.out.into_inner().map_err(|e| failed(&self.path, e.error()))?;
        file.persist(&self.path).map_err(|e| failed(&self.path, &e.error))?;
        Ok(())
    }
}

/// The error of a file that could not be written: which, why, what to look at.
fn failed(path: &Path, why: &io::Error) -> io::Error {
    let help = "check the folder, its permissions and the free space";
    io::Error::new(why.kind(), format!("cannot write {}: {why}; {help}", path.display()))
}

impl Write for WholeFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.out.write(bytes).map_err(|error| failed(&self.path, &error))
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush().map_err(|error| failed(&self.path, &error))
    }
}

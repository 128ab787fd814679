//! Opens the files of exhibits: regular files only, inside the exhibit's folder, without waiting.
//!
//! A FIFO, a socket or a device would block its reader, or have no end; a link out of the folder would show files of the
//! kiosk's user to the exhibit's author. Links inside the folder are followed.

use std::fs::File;
use std::io::{ErrorKind, Read};
use std::path::Path;

use rustix::fs::{FileType, Mode, OFlags, fstat, open, stat};
use rustix::io::Errno;

use super::diagnostic::Diagnostic;
use super::paths::{folder_or_here, in_its_place, inside};
use super::{codes, paths};

/// An open regular file.
#[derive(Debug)]
pub struct OpenFile {
    file: File,
    size: u64,
    /// Its path, for messages.
    path: String,
}

/// Opens a regular file. It never blocks.
///
/// # Errors
/// The file is missing, may not be read, or is no regular file.
pub fn open_regular(path: &Path) -> Result<OpenFile, Diagnostic> {
    let unreadable = |error: Errno| unreadable(path, &error.into());
    let kind = |mode| match FileType::from_raw_mode(mode) {
        FileType::RegularFile => Ok(()),
        other => Err(not_a_file(path, other)),
    };
    // Asked before it is opened: opening some devices has an effect.
    kind(stat(path).map_err(unreadable)?.st_mode)?;
    let flags = OFlags::RDONLY | OFlags::NONBLOCK | OFlags::NOCTTY | OFlags::CLOEXEC;
    let file = File::from(open(path, flags, Mode::empty()).map_err(unreadable)?);
    // What was opened counts: the path may have changed since.
    let found = fstat(&file).map_err(unreadable)?;
    kind(found.st_mode)?;
    Ok(OpenFile { file, size: u64::try_from(found.st_size).unwrap_or(0), path: path.display().to_string() })
}

/// Opens the regular file `relative` of an exhibit's folder.
///
/// # Errors
/// As of [`open_regular`], and where the path leaves the folder.
pub fn open_inside(folder: &Path, relative: &str) -> Result<OpenFile, Diagnostic> {
    open_regular(&inside(folder, relative)?)
}

/// Reads a regular file of at most `limit` bytes, wherever it is.
///
/// # Errors
/// As of [`open_regular`], and where it is larger.
pub fn read_limited(path: &Path, limit: u64) -> Result<Vec<u8>, Diagnostic> {
    open_regular(path)?.within(limit)?.read()
}

/// Reads a regular file of at most `limit` bytes as text.
///
/// # Errors
/// As of [`read_limited`], and where it is not UTF-8.
pub fn read_text(path: &Path, limit: u64) -> Result<String, Diagnostic> {
    String::from_utf8(read_limited(path, limit)?).map_err(|error| {
        Diagnostic::new(codes::UNREADABLE, format!("{} is not UTF-8: {error}", path.display())).help("save it as UTF-8")
    })
}

/// Reads a regular file of an exhibit's folder of at most `limit` bytes.
///
/// # Errors
/// As of [`open_inside`], and where it is larger.
pub fn read_inside(folder: &Path, relative: &str, limit: u64) -> Result<Vec<u8>, Diagnostic> {
    open_inside(folder, relative)?.within(limit)?.read()
}

/// Reads the sidecar of an exhibit's folder.
///
/// # Errors
/// As of [`read_inside`].
pub fn read_sidecar(folder: &Path) -> Result<Vec<u8>, Diagnostic> {
    read_inside(folder_or_here(folder), paths::SIDECAR, MAX_SIDECAR_BYTES)
}

/// Most bytes of a sidecar. The longest shipped one has 36 KB; a parsed one takes up to 200 times its size.
pub const MAX_SIDECAR_BYTES: u64 = 1 << 20;

impl OpenFile {
    /// Its size, bytes.
    pub fn size(&self) -> u64 {
        self.size
    }

    /// Refuses a file of more than `limit` bytes.
    ///
    /// # Errors
    /// It is larger.
    pub fn within(self, limit: u64) -> Result<Self, Diagnostic> {
        if self.size <= limit {
            return Ok(self);
        }
        let message = format!("{} has {} bytes; the limit is {limit}", self.path, self.size);
        Err(Diagnostic::new(codes::TOO_LARGE, message).help("check that it is the right file, or make it smaller"))
    }

    /// Reads all of it.
    ///
    /// # Errors
    /// The disk fails.
    pub fn read(self) -> Result<Vec<u8>, Diagnostic> {
        let size = self.size;
        self.read_first(size)
    }

    /// Reads at most its first `most` bytes; what is appended to the file meanwhile is left out.
    ///
    /// # Errors
    /// The disk fails.
    pub fn read_first(self, most: u64) -> Result<Vec<u8>, Diagnostic> {
        let most = most.min(self.size);
        let mut bytes = Vec::with_capacity(usize::try_from(most).unwrap_or(0));
        let read = self.file.take(most).read_to_end(&mut bytes);
        read.map_err(|error| unreadable(Path::new(&self.path), &error))?;
        Ok(bytes)
    }
}

fn unreadable(path: &Path, error: &std::io::Error) -> Diagnostic {
    let help = match error.kind() {
        ErrorKind::NotFound => in_its_place(path),
        ErrorKind::PermissionDenied => "let the kiosk's user read it: chmod a+r".to_owned(),
        _ => "check that it is a file and that the disk works".to_owned(),
    };
    Diagnostic::new(codes::UNREADABLE, format!("{} cannot be read: {error}", path.display())).help(help)
}

fn not_a_file(path: &Path, kind: FileType) -> Diagnostic {
    let kind = match kind {
        FileType::Directory => "a folder",
        FileType::Fifo => "a FIFO",
        FileType::Socket => "a socket",
        FileType::CharacterDevice | FileType::BlockDevice => "a device",
        _ => "no regular file",
    };
    let message = format!("{} is {kind}, and is not opened", path.display());
    Diagnostic::new(codes::NOT_A_FILE, message).help("put a regular file in its place")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_and_devices_are_refused_by_kind() {
        for (path, kind) in [(".", "a folder"), ("/dev/zero", "a device")] {
            let problem = open_regular(Path::new(path)).expect_err("no file");
            assert_eq!(problem.code, codes::NOT_A_FILE.name);
            assert!(problem.message.contains(kind), "{}", problem.message);
        }
        let missing = open_regular(Path::new("no/such/file")).expect_err("nothing there");
        assert_eq!(missing.code, codes::UNREADABLE.name);
    }

    #[test]
    fn a_file_is_read_up_to_a_number_of_bytes() {
        let own = || open_regular(&Path::new(env!("CARGO_MANIFEST_DIR")).join("files.rs")).expect("this file");
        assert_eq!(own().read_first(9).expect("readable"), b"//! Opens");
        assert_eq!(own().read().expect("readable").len() as u64, own().size());
        assert_eq!(own().within(10).expect_err("longer").code, codes::TOO_LARGE.name);
    }
}

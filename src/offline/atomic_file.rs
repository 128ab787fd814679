//! Atomic files: written beside their destination and renamed when complete, so an interrupted run leaves no partial
//! file.
//!
//! A file that is replaced keeps its permissions and, where the system allows it, its owner and group. A symbolic link stays: the
//! file that it names is replaced. [`replace`] writes a whole file that also survives a loss of power, and removes what a run
//! that was killed has left.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::time::Duration;

use tempfile::NamedTempFile;

/// End of the name of an unfinished file; it begins with a dot and the name of its destination.
const UNFINISHED: &str = ".unfinished";
/// Age from which an unfinished file that nobody has locked is left over: no file takes so long from its creation to its lock.
const LEFT_OVER: Duration = Duration::from_secs(60);

/// Who may read a file that does not exist yet. An existing one keeps its permissions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Readers {
    /// Its owner alone: it may hold a secret. Mode 0600.
    Owner,
    /// Everybody on the machine, whatever the umask of the service. Mode 0644.
    Everyone,
    /// As the umask of the process allows.
    Umask,
}

/// A file that is not yet complete. Dropped before [`AtomicFile::finish`], it leaves nothing.
pub struct AtomicFile {
    out: BufWriter<NamedTempFile>,
    path: PathBuf,
    /// The file that is replaced: `path`, or the one that it links to.
    target: PathBuf,
}

impl AtomicFile {
    /// Creates a temporary file beside `path`; a new file is readable as the umask allows.
    ///
    /// # Errors
    /// Names the file and the cause.
    pub fn create(path: &Path) -> io::Result<Self> {
        Self::create_for(path, Readers::Umask)
    }

    /// Creates a temporary file beside `path`, or beside the file that it links to.
    ///
    /// # Errors
    /// Names the file and the cause.
    pub fn create_for(path: &Path, readers: Readers) -> io::Result<Self> {
        let target = link_target(path);
        let folder = folder_of(&target);
        if !folder.is_dir() {
            let why = format!("there is no folder {}; make it first", folder.display());
            return Err(io::Error::new(io::ErrorKind::NotFound, format!("cannot write {}: {why}", path.display())));
        }
        let prefix = prefix(&target);
        let mut builder = tempfile::Builder::new();
        builder.prefix(&prefix).suffix(UNFINISHED);
        #[cfg(unix)]
        if readers == Readers::Umask {
            builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
        }
        let file = builder.tempfile_in(folder).map_err(|error| failed(path, &error))?;
        // The lock says that its writer is alive; it ends with the process.
        let _ = file.as_file().try_lock();
        permit(file.as_file(), &target, readers).map_err(|error| failed(path, &error))?;
        Ok(Self { out: BufWriter::new(file), path: path.to_path_buf(), target })
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
        file.persist(&self.target).map_err(|e| failed(&self.path, &e.error))?;
        Ok(())
    }

    /// Renames the file to its destination, so that it survives a loss of power.
    ///
    /// # Errors
    /// The file cannot be written to the disk or renamed.
    pub fn finish_durably(mut self) -> io::Result<()> {
        let durable = self.out.flush().and_then(|()| self.out.get_ref().as_file().sync_all());
        durable.map_err(|error| failed(&self.path, &error))?;
        let (path, folder) = (self.path.clone(), folder_of(&self.target).to_path_buf());
        self.finish()?;
        // The new name is part of the folder.
        File::open(folder).and_then(|folder| folder.sync_all()).map_err(|error| failed(&path, &error))
    }
}

/// Replaces the whole file at `path`, or makes it for these readers. It survives a loss of power. Unfinished files that an earlier
/// run left beside it are removed.
///
/// # Errors
/// The file cannot be written; the old one stays.
pub fn replace(path: &Path, bytes: &[u8], readers: Readers) -> io::Result<()> {
    remove_left_over(&link_target(path));
    let mut file = AtomicFile::create_for(path, readers)?;
    file.write_all(bytes)?;
    file.finish_durably()
}

/// The file that a symbolic link names; another path stays as it is.
fn link_target(path: &Path) -> PathBuf {
    if !path.is_symlink() {
        return path.to_path_buf();
    }
    // A link to a file that is still missing cannot be resolved as a whole.
    let named = || std::fs::read_link(path).map(|link| folder_of(path).join(link));
    std::fs::canonicalize(path).or_else(|_| named()).unwrap_or_else(|_| path.to_path_buf())
}

fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Beginning of the names of unfinished files of a destination.
fn prefix(target: &Path) -> String {
    format!(".{}.", target.file_name().unwrap_or_default().to_string_lossy())
}

/// Gives a new file the permissions and the owner of the one that it replaces, or those for its readers.
#[cfg(unix)]
fn permit(file: &File, target: &Path, readers: Readers) -> io::Result<()> {
    use std::os::unix::fs::{MetadataExt, PermissionsExt, fchown};
    let mode = match (std::fs::metadata(target), readers) {
        (Ok(old), _) => {
            let new = file.metadata()?;
            if (old.uid(), old.gid()) != (new.uid(), new.gid()) {
                // Only root may give a file away; a member of the group may give it to the group.
                let _ = fchown(file, Some(old.uid()), Some(old.gid())).or_else(|_| fchown(file, None, Some(old.gid())));
            }
            old.mode() & 0o777
        }
        (Err(_), Readers::Owner) => 0o600,
        (Err(_), Readers::Everyone) => 0o644,
        (Err(_), Readers::Umask) => return Ok(()),
    };
    file.set_permissions(PermissionsExt::from_mode(mode))
}

#[cfg(not(unix))]
fn permit(_: &File, _: &Path, _: Readers) -> io::Result<()> {
    Ok(())
}

/// Removes unfinished files of a destination whose writer is gone.
fn remove_left_over(target: &Path) {
    let prefix = prefix(target);
    let Ok(entries) = std::fs::read_dir(folder_of(target)) else { return };
    for entry in entries.flatten() {
        let name = entry.file_name();
        let unfinished = name.to_str().is_some_and(|name| name.starts_with(&prefix) && name.ends_with(UNFINISHED));
        if unfinished && is_left_over(&entry) {
            // One that cannot be removed is met again at the next write.
            let _ = std::fs::remove_file(entry.path());
        }
    }
}

fn is_left_over(entry: &std::fs::DirEntry) -> bool {
    let changed = entry.metadata().and_then(|metadata| metadata.modified());
    let is_old = changed.is_ok_and(|at| at.elapsed().is_ok_and(|age| age >= LEFT_OVER));
    is_old && File::open(entry.path()).is_ok_and(|file| file.try_lock().is_ok())
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

#[cfg(all(test, unix))]
mod tests {
    use std::os::unix::fs::{MetadataExt, PermissionsExt, chown, symlink};
    use std::time::SystemTime;

    use super::*;

    fn mode(path: &Path) -> u32 {
        std::fs::metadata(path).expect("it is there").mode() & 0o777
    }

    #[test]
    fn a_replaced_file_keeps_its_mode_and_its_owner_and_a_new_one_has_that_of_its_readers() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("kiosk.toml");
        for (readers, expected) in [(Readers::Owner, 0o600), (Readers::Everyone, 0o644)] {
            let _ = std::fs::remove_file(&file);
            replace(&file, b"new", readers).expect("writable");
            assert_eq!(mode(&file), expected, "{readers:?}");
        }
        for kept in [0o600, 0o640, 0o664] {
            std::fs::set_permissions(&file, PermissionsExt::from_mode(kept)).expect("its own");
            replace(&file, b"secret", Readers::Everyone).expect("writable");
            assert_eq!((mode(&file), std::fs::read(&file).expect("there")), (kept, b"secret".to_vec()));
        }
        // Only root can give a file to somebody else.
        if chown(&file, Some(1), Some(2)).is_ok() {
            replace(&file, b"theirs", Readers::Owner).expect("writable");
            let owner = std::fs::metadata(&file).expect("there");
            assert_eq!((owner.uid(), owner.gid(), mode(&file)), (1, 2, 0o664));
        }
    }

    #[test]
    fn a_link_stays_a_link_and_the_file_that_it_names_is_replaced() {
        let folder = tempfile::tempdir().expect("a folder");
        let (real, link) = (folder.path().join("real/kiosk.toml"), folder.path().join("kiosk.toml"));
        std::fs::create_dir(folder.path().join("real")).expect("a folder");
        symlink("real/kiosk.toml", &link).expect("a link");
        for text in ["made through a link", "replaced through a link"] {
            replace(&link, text.as_bytes(), Readers::Owner).expect("writable");
            assert!(link.is_symlink() && !real.is_symlink());
            assert_eq!(std::fs::read_to_string(&real).expect("there"), text);
        }
    }

    #[test]
    fn what_a_killed_run_left_is_removed_and_what_another_writes_stays() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("state.json");
        let age = |file: &File| file.set_modified(SystemTime::now() - 2 * LEFT_OVER).expect("its own");
        let left = folder.path().join(".state.json.abcdef.unfinished");
        age(&File::create(&left).expect("writable"));
        let fresh = folder.path().join(".state.json.ghijkl.unfinished");
        File::create(&fresh).expect("writable");
        let mine = folder.path().join(".state.json.mine");
        age(&File::create(&mine).expect("writable"));
        let other = AtomicFile::create(&file).expect("writable");
        age(other.out.get_ref().as_file());
        let unfinished = other.out.get_ref().path().to_path_buf();
        replace(&file, b"{}", Readers::Owner).expect("writable");
        assert!(!left.exists(), "nobody writes it any more");
        assert!(fresh.exists() && unfinished.exists(), "another run may still write these");
        assert!(mine.exists(), "not one of these files");
        other.finish().expect("writable");
    }

    #[test]
    fn a_file_that_cannot_be_written_stays_as_it_was_and_leaves_nothing_beside_it() {
        let folder = tempfile::tempdir().expect("a folder");
        let taken = folder.path().join("taken");
        std::fs::create_dir(&taken).expect("a folder");
        let error = replace(&taken, b"text", Readers::Owner).expect_err("a folder is no file");
        assert!(error.to_string().contains("taken"), "{error}");
        assert_eq!(std::fs::read_dir(folder.path()).expect("readable").count(), 1);
    }
}

//! A trial of an exhibit in a process of its own, before the kiosk loads it for the first time or after its files changed.
//!
//! The loader counts what an exhibit costs, but what a library takes by mistake can only be stopped from outside. The trial runs under
//! limits of address space and processor time. If it dies, the kiosk goes on without that exhibit. An exhibit with mistakes passes,
//! since loading it says what they are. What has passed is not tried again until a file of it changes.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::OnceLock;
use std::time::{Duration, Instant, SystemTime};

use soffio_exhibit::budget::{MAX_MEMORY, MAX_TIME};
use soffio_exhibit::{Diagnostic, Report, codes};

/// Address space beyond the exhibit's budget, bytes: the program, its libraries, and the first steps of the simulation.
const OWN_MEMORY: u64 = 512 << 20;
/// Processor time beyond the exhibit's budget: the start, and the first steps.
const OWN_TIME: Duration = Duration::from_secs(5);
/// Longest trial: with idle priority beside a busy kiosk it takes several times its processor time.
const LONGEST: Duration = Duration::from_secs(90);
/// How often its end is looked for.
const LOOK: Duration = Duration::from_millis(10);
/// Most folders within each other that are looked at for changes.
const DEPTH: usize = 4;
/// Exit status of a trial that found mistakes.
const MISTAKES: i32 = 1;

/// The program that runs trials; without one there are none.
static PROGRAM: OnceLock<PathBuf> = OnceLock::new();

/// Has all trials run by this program, as `PROGRAM check --trial FOLDER`. Only the first call counts.
pub fn enable(program: PathBuf) {
    let _ = PROGRAM.set(program);
}

/// The exhibits that have passed.
#[derive(Debug, Default)]
pub(super) struct Trials {
    passed: BTreeMap<PathBuf, FolderStamp>,
}

/// Newest change, number and size of the files of a folder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct FolderStamp {
    newest: SystemTime,
    files: u64,
    bytes: u64,
}

impl Trials {
    /// Tries the exhibit of a folder unless it has passed as it is now.
    ///
    /// # Errors
    /// The trial died, or took too long.
    pub(super) fn pass(&mut self, folder: &Path) -> Result<(), Report> {
        let Some(program) = PROGRAM.get() else { return Ok(()) };
        let stamp = FolderStamp::of(folder);
        if self.passed.get(folder) == Some(&stamp) {
            return Ok(());
        }
        match try_by(program, folder) {
            Ok(()) => {
                self.passed.insert(folder.to_path_buf(), stamp);
                Ok(())
            }
            Err(why) => {
                let message = format!("{}: a trial {why}, so it is set aside until it changes", folder.display());
                let help =
                    "run `soffio check` on it on another machine, and make its images, meshes and drawings smaller";
                Err(Report::single(Diagnostic::new(codes::BUDGET, message).help(help)))
            }
        }
    }
}

/// Runs a trial; the reason where it did not come to its end.
fn try_by(program: &Path, folder: &Path) -> Result<(), String> {
    let memory_kb = (MAX_MEMORY + OWN_MEMORY) >> 10;
    let seconds = (MAX_TIME + OWN_TIME).as_secs();
    // The shell sets the limits: a process of ours would have to do it between fork and exec.
    let script = format!("ulimit -v {memory_kb}; ulimit -t {seconds}; exec nice \"$0\" check --trial \"$1\"");
    let silent = || Stdio::null();
    let child = Command::new("sh")
        .args(["-c", &script])
        .args([program, folder])
        .stdin(silent())
        .stdout(silent())
        .stderr(silent())
        .spawn();
    let mut child = match child {
        Ok(child) => child,
        Err(error) => {
            tracing::warn!("exhibits are loaded without a trial: {error}");
            return Ok(());
        }
    };
    let began = Instant::now();
    loop {
        match child.try_wait() {
            Ok(Some(status)) if status.success() || status.code() == Some(MISTAKES) => return Ok(()),
            Ok(Some(status)) => return Err(format!("ended with {status}")),
            Ok(None) if began.elapsed() < LONGEST => std::thread::sleep(LOOK),
            Ok(None) => {
                // It may have ended meanwhile; either way it is waited for.
                let _ = child.kill();
                let _ = child.wait();
                return Err(format!("took longer than {} s", LONGEST.as_secs()));
            }
            Err(error) => return Err(format!("cannot be waited for: {error}")),
        }
    }
}

impl FolderStamp {
    fn of(folder: &Path) -> Self {
        let mut stamp = Self { newest: SystemTime::UNIX_EPOCH, files: 0, bytes: 0 };
        stamp.add(folder, DEPTH);
        stamp
    }

    fn add(&mut self, folder: &Path, depth: usize) {
        for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
            // Links are followed: what they lead to counts.
            let Ok(data) = std::fs::metadata(entry.path()) else { continue };
            if data.is_dir() && depth > 0 {
                self.add(&entry.path(), depth - 1);
            }
            self.newest = self.newest.max(data.modified().unwrap_or(SystemTime::UNIX_EPOCH));
            (self.files, self.bytes) = (self.files + 1, self.bytes.wrapping_add(data.len()));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A program that does what a script says instead of a trial.
    fn program(folder: &Path, script: &str) -> PathBuf {
        use std::os::unix::fs::PermissionsExt;
        let path = folder.join("program");
        std::fs::write(&path, format!("#!/bin/sh\n{script}\n")).expect("a writable folder");
        std::fs::set_permissions(&path, std::fs::Permissions::from_mode(0o755)).expect("its own file");
        path
    }

    #[test]
    fn a_trial_that_dies_is_not_one_that_finds_mistakes() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let tried = |script: &str| try_by(&program(folder.path(), script), folder.path());
        assert_eq!(tried("exit 0"), Ok(()));
        assert_eq!(tried("exit 1"), Ok(()), "loading it says what they are");
        assert!(tried("exit 101").is_err_and(|why| why.contains("101")), "a panic");
        assert!(tried("kill -9 $$").is_err_and(|why| why.contains("signal")), "the system ended it");
        assert_eq!(tried("test $(ulimit -v) = 1048576 && test $(ulimit -t) = 15"), Ok(()));
        assert_eq!(tried("test \"$1 $2\" = 'check --trial'"), Ok(()));
    }

    #[test]
    fn a_changed_file_is_seen() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        std::fs::write(folder.path().join("a"), "1").expect("writable");
        let before = FolderStamp::of(folder.path());
        assert_eq!(before, FolderStamp::of(folder.path()));
        std::fs::write(folder.path().join("a"), "12").expect("writable");
        assert_ne!(before, FolderStamp::of(folder.path()));
    }
}

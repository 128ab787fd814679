//! A file that is written again and again, whole each time, on a thread of its own: a slow or full disk makes nothing
//! late, and is said once.

use std::io::{self, Write as _};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{SyncSender, sync_channel};
use std::thread::JoinHandle;

use soffio_offline::atomic_file::AtomicFile;

/// Writes one file.
#[derive(Debug)]
pub struct Writer {
    to: Option<SyncSender<String>>,
    thread: Option<JoinHandle<()>>,
}

impl Writer {
    /// Of the file at `path`; `name` is what the log calls it.
    pub fn start(name: &'static str, path: PathBuf) -> Self {
        // One text waits at most: what comes while the disk is slow is outdated when the disk is ready.
        let (to, from) = sync_channel::<String>(1);
        let write = move || {
            let mut failed = false;
            for text in from {
                let result = write(&path, &text);
                match &result {
                    Ok(()) if failed => tracing::info!("{name}: {} is written again", path.display()),
                    // Once for all that follow alike.
                    Err(error) if !failed => tracing::warn!("{name}: {error}. The kiosk goes on without it."),
                    _ => {}
                }
                failed = result.is_err();
            }
        };
        match std::thread::Builder::new().name(format!("soffio-{name}")).spawn(write) {
            Ok(thread) => Self { to: Some(to), thread: Some(thread) },
            Err(error) => {
                tracing::warn!("{name}: {error}");
                Self { to: None, thread: None }
            }
        }
    }

    /// Hands over the file's whole text; says whether it was taken. It is not while the disk has not even begun the
    /// text before this one.
    pub fn write(&self, text: String) -> bool {
        self.to.as_ref().is_some_and(|to| to.try_send(text).is_ok())
    }

    /// Writes a last text and waits until it is there.
    pub fn finish(mut self, text: String) {
        if let Some(to) = self.to.take() {
            // Fails only when the thread died, which nobody can mend now.
            let _ = to.send(text);
        }
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

/// Writes a file that survives a loss of power.
pub fn write(path: &Path, text: &str) -> io::Result<()> {
    let mut file = AtomicFile::create(path)?;
    file.write_all(text.as_bytes())?;
    file.flush()?;
    file.reopen()?.sync_all()?;
    file.finish()
}

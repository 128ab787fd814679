//! Rewrites a file as a whole, again and again, on a thread of its own: a slow or full disk delays nothing, and is logged
//! once.

use std::path::PathBuf;
use std::sync::mpsc::{SyncSender, sync_channel};
use std::thread::JoinHandle;

use soffio_offline::atomic_file::{Readers, replace};

/// Writer of one file.
#[derive(Debug)]
pub struct Writer {
    to: Option<SyncSender<String>>,
    thread: Option<JoinHandle<()>>,
}

impl Writer {
    /// For the file at `path`, which these readers may read; `name` is its name in the log.
    pub fn start(name: &'static str, path: PathBuf, readers: Readers) -> Self {
        // At most one text waits: later ones would be outdated when a slow disk is ready.
        let (to, from) = sync_channel::<String>(1);
        let write = move || {
            let mut failed = false;
            for text in from {
                let result = replace(&path, text.as_bytes(), readers);
                match &result {
                    Ok(()) if failed => tracing::info!("{name}: {} is written again", path.display()),
                    // Logged once for all failures in a row.
                    Err(error) if !failed => tracing::warn!("{name}: {error}. The kiosk continues without it."),
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

    /// Hands over the file's whole text. Returns `false` if the text before is still waiting for the disk.
    pub fn write(&self, text: String) -> bool {
        self.to.as_ref().is_some_and(|to| to.try_send(text).is_ok())
    }

    /// Writes a last text and waits until it is there.
    pub fn finish(mut self, text: String) {
        if let Some(to) = self.to.take() {
            // Fails only when the thread has panicked.
            let _ = to.send(text);
        }
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

//! Hot reload: a curator saves a file, the exhibit on show becomes the new one.
//!
//! The folder is watched; after 300 ms of silence (editors write in several steps) a worker loads the exhibit. What
//! loads is handed on; what does not is reported and changes nothing, so the last good exhibit stays on show.

use std::path::Path;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::time::Duration;

use notify_debouncer_full::notify::{EventKind, RecommendedWatcher, RecursiveMode};
use notify_debouncer_full::{DebounceEventResult, Debouncer, RecommendedCache, new_debouncer};

use crate::exhibit::{self, Exhibit};

/// Silence after the last change before the exhibit is loaded.
pub const QUIET: Duration = Duration::from_millis(300);

/// What became of a change: the new exhibit, or the whole report of what is wrong with it.
pub type Reloaded = Result<Arc<Exhibit>, String>;

/// Watches an exhibit's folder for as long as it lives.
pub struct Reload {
    results: Receiver<Reloaded>,
    asks: Sender<()>,
    /// Ends the watching when dropped.
    _watcher: Option<Debouncer<RecommendedWatcher, RecommendedCache>>,
}

impl Reload {
    /// Loads the exhibit in `folder` when asked, and, if `watched`, when a file in it changes. Where watching is
    /// impossible the reason is logged and asking remains.
    pub fn new(folder: &Path, watched: bool) -> Self {
        let (asks, asked) = channel::<()>();
        let (answers, results) = channel();
        let theirs = folder.to_path_buf();
        // The worker ends when every asker is gone. Changes that came while it was loading are one change.
        std::thread::spawn(move || {
            while asked.recv().is_ok() {
                while asked.try_recv().is_ok() {}
                if answers.send(load(&theirs)).is_err() {
                    return;
                }
            }
        });
        let watcher = watched.then(|| watcher(folder, asks.clone()));
        if let Some(Err(error)) = &watcher {
            tracing::warn!("{} is not watched for changes: {error}", folder.display());
        }
        Self { results, asks, _watcher: watcher.and_then(Result::ok) }
    }

    /// Loads the exhibit as if a file had changed.
    pub fn ask(&self) {
        // The worker lives as long as this value does; if it died, the picture stays as it is.
        let _ = self.asks.send(());
    }

    /// What became of the last change, once.
    pub fn result(&self) -> Option<Reloaded> {
        self.results.try_iter().last()
    }

    /// Waits for what becomes of a change.
    pub fn wait(&self, longest: Duration) -> Option<Reloaded> {
        self.results.recv_timeout(longest).ok()
    }
}

/// Does this kind of event change what an exhibit is? (Reading it does not.)
pub fn is_change(kind: &EventKind) -> bool {
    matches!(kind, EventKind::Create(_) | EventKind::Modify(_) | EventKind::Remove(_) | EventKind::Any)
}

fn watcher(
    folder: &Path,
    asks: Sender<()>,
) -> Result<Debouncer<RecommendedWatcher, RecommendedCache>, notify_debouncer_full::notify::Error> {
    let mut debouncer = new_debouncer(QUIET, None, move |result: DebounceEventResult| match result {
        Ok(events) if events.iter().any(|event| is_change(&event.kind)) => {
            let _ = asks.send(());
        }
        Ok(_) => {}
        Err(errors) => errors.iter().for_each(|error| tracing::warn!("watching the exhibit: {error}")),
    })?;
    debouncer.watch(folder, RecursiveMode::Recursive)?;
    Ok(debouncer)
}

fn load(folder: &Path) -> Reloaded {
    exhibit::load(folder).map(Arc::new).map_err(|report| report.to_string())
}

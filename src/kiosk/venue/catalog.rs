//! The catalog: the exhibits that a visitor can choose from. It follows changes that curators make while the kiosk runs.
//!
//! One worker thread loads. After the first frame it loads every exhibit once, in order: valid ones are listed with their labels and
//! picture, others are reported and left out. Folders are watched. 300 ms after the last change (editors write in several
//! steps) the worker loads the folder again. So a new folder appears, a removed one disappears, and saved changes are shown.
//! The exhibit on show is replaced only by one that has loaded; else the last valid one stays.

use std::collections::VecDeque;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, Sender, TryRecvError, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use notify_debouncer_full::notify::{EventKind, RecommendedWatcher, RecursiveMode};
use notify_debouncer_full::{DebounceEventResult, Debouncer, RecommendedCache, new_debouncer};

use super::quarantine::{LoadMarker, Quarantine};
use super::trial::Trials;
use soffio_config::OTHERS;
use soffio_exhibit::{self as exhibit, Budget, Exhibit, Labels, Report, thumbnail};
use soffio_render::{Baked, Lighting};

/// Quiet time after the last change before an exhibit is loaded.
pub const QUIET: Duration = Duration::from_millis(300);
/// After this time at one exhibit the worker counts as stuck: a trial takes at most 90 s, and loading 10 s of processor time.
pub const STUCK: Duration = Duration::from_secs(150);
/// Size of the stored picture, pixels: a tile is no larger on the screen.
const THUMBNAIL_SIZE: [u32; 2] = [480, 270];

/// Where the exhibits come from.
#[derive(Clone, Debug)]
pub enum ExhibitSource {
    /// One exhibit in this folder.
    One(PathBuf),
    /// The exhibits in the folders of a folder.
    All {
        /// The folder.
        folder: PathBuf,
        /// Ids in the order in which they are offered; [`OTHERS`] stands for all others.
        show: Vec<String>,
    },
}

/// An exhibit in the catalog.
#[derive(Clone, Debug)]
pub struct CatalogEntry {
    /// Name of its folder.
    pub id: String,
    /// Its folder.
    pub folder: PathBuf,
    /// Its labels.
    pub labels: Labels,
    /// Its picture.
    pub thumbnail: Option<image::RgbaImage>,
}

/// Event of the worker.
pub enum CatalogEvent {
    /// Show this exhibit with its light: it was requested, or is on show and has changed.
    Show(Arc<Exhibit>, Box<Baked>),
    /// The requested exhibit does not load; the report.
    Failed(String),
    /// A new or changed entry.
    Listed(Box<CatalogEntry>),
    /// An exhibit does not load: its id, and the report.
    Rejected(String, String),
    /// The folder of this exhibit was removed.
    Removed(String),
}

enum CatalogRequest {
    /// List these exhibits.
    List(Vec<PathBuf>),
    Show(PathBuf),
    Load(PathBuf),
}

/// Loads exhibits on a worker thread, and watches their folders for as long as it lives.
pub struct CatalogLoader {
    events: Receiver<CatalogEvent>,
    requests: Sender<CatalogRequest>,
    /// Folders that are not listed yet.
    unlisted: Vec<PathBuf>,
    /// Since when the worker is at what it does now.
    busy: Arc<Mutex<Option<Instant>>>,
    /// Ends the watching when dropped.
    _watcher: Option<Debouncer<RecommendedWatcher, RecommendedCache>>,
}

impl CatalogLoader {
    /// Offers the exhibits there when [`Self::list`] is called, and reloads changed ones if `watched`; `shown` is the folder on show. Where watching is
    /// impossible the reason is logged, and requests still work. Exhibits of `quarantine` are loaded only when they have changed.
    pub fn new(
        places: &ExhibitSource,
        shown: &Path,
        watched: bool,
        quarantine: &Quarantine,
        marker: LoadMarker,
    ) -> Self {
        let (requests, incoming) = channel::<CatalogRequest>();
        let (sender, events) = channel();
        let busy = Arc::new(Mutex::new(None));
        let mut worker = Worker {
            events: sender,
            queue: VecDeque::new(),
            shown: shown.to_path_buf(),
            marker,
            trials: Trials::default(),
            busy: busy.clone(),
        };
        let thread = std::thread::Builder::new().name("soffio-exhibits".into()).spawn(move || worker.run(&incoming));
        if let Err(error) = thread {
            tracing::error!("no other exhibit can be loaded: {error}");
        }
        let (watch, one) = match places {
            ExhibitSource::One(folder) => (folder, true),
            ExhibitSource::All { folder, .. } => (folder, false),
        };
        let watcher = watched.then(|| watcher(watch, one, requests.clone()));
        if let Some(Err(error)) = &watcher {
            tracing::warn!("{} is not watched for changes: {error}", watch.display());
        }
        let mut unlisted = folders(places);
        unlisted.retain(|folder| !quarantine.contains(&id(folder)));
        Self { events, requests, unlisted, busy, _watcher: watcher.and_then(Result::ok) }
    }

    /// Folders that are not listed yet, in order.
    pub fn unlisted(&self) -> &[PathBuf] {
        &self.unlisted
    }

    /// Begins to list the exhibits, once. Before the first frame that would only delay it.
    pub fn list(&mut self) {
        if !self.unlisted.is_empty() {
            let _ = self.requests.send(CatalogRequest::List(std::mem::take(&mut self.unlisted)));
        }
    }

    /// How long the worker has been at what it does now; `None` where it waits.
    pub fn busy_for(&self) -> Option<Duration> {
        self.busy.lock().unwrap_or_else(PoisonError::into_inner).map(|since| since.elapsed())
    }

    /// Requests that the exhibit of a folder is loaded and shown. It returns at once; [`CatalogEvent::Show`] or
    /// [`CatalogEvent::Failed`] follows.
    pub fn show(&self, folder: &Path) {
        // The worker lives as long as this value does; if it died, the picture stays as it is.
        let _ = self.requests.send(CatalogRequest::Show(folder.to_path_buf()));
    }

    /// Loads a folder that was not offered before: [`CatalogEvent::Listed`] or [`CatalogEvent::Rejected`] follows.
    pub fn load(&self, folder: &Path) {
        let _ = self.requests.send(CatalogRequest::Load(folder.to_path_buf()));
    }

    /// The next event, the oldest first; `None` where there is none.
    pub fn next_event(&self) -> Option<CatalogEvent> {
        self.events.try_recv().ok()
    }

    /// Waits for the next event, at most so long.
    pub fn wait(&self, longest: Duration) -> Option<CatalogEvent> {
        self.events.recv_timeout(longest).ok()
    }
}

/// State of the worker thread.
struct Worker {
    events: Sender<CatalogEvent>,
    /// Folders to load, and whether they have changed.
    queue: VecDeque<(PathBuf, bool)>,
    shown: PathBuf,
    /// Names the exhibit that is about to be shown, for a run after a crash. Those that are only listed have passed a trial.
    marker: LoadMarker,
    trials: Trials,
    busy: Arc<Mutex<Option<Instant>>>,
}

impl Worker {
    /// Runs until all senders or the receiver are dropped.
    fn run(&mut self, requests: &Receiver<CatalogRequest>) {
        loop {
            let request = match requests.try_recv() {
                Err(TryRecvError::Empty) if self.queue.is_empty() => match requests.recv() {
                    Ok(request) => Some(request),
                    Err(_) => return,
                },
                Err(TryRecvError::Disconnected) => return,
                Err(TryRecvError::Empty) => None,
                Ok(request) => Some(request),
            };
            self.mark(Some(Instant::now()));
            let sent = match request {
                Some(CatalogRequest::Show(folder)) => {
                    let newest = self.newest(folder, requests);
                    self.show(newest)
                }
                Some(request) => {
                    self.enqueue(request);
                    Ok(())
                }
                None => self.queue.pop_front().map_or(Ok(()), |(folder, changed)| self.look(&folder, changed)),
            };
            self.mark(None);
            if sent.is_err() {
                return;
            }
        }
    }

    fn mark(&self, since: Option<Instant>) {
        *self.busy.lock().unwrap_or_else(PoisonError::into_inner) = since;
    }

    /// Loads an exhibit that passes its trial, within the budget of memory and processor time.
    fn load(&mut self, folder: &Path) -> Result<Exhibit, Report> {
        self.trials.pass(folder)?;
        exhibit::load_within(folder, &Budget::timed(|| cpu_time::ThreadTime::now().as_duration()))
    }

    /// The exhibit that was requested last: `folder`, or a later request that waits already. Nobody wants to see those in between.
    fn newest(&mut self, mut folder: PathBuf, requests: &Receiver<CatalogRequest>) -> PathBuf {
        while let Ok(request) = requests.try_recv() {
            match request {
                CatalogRequest::Show(later) => folder = later,
                other => self.enqueue(other),
            }
        }
        folder
    }

    /// Takes a request that can wait. Several changes of a folder during a load count as one.
    fn enqueue(&mut self, request: CatalogRequest) {
        match request {
            CatalogRequest::List(folders) => self.queue.extend(folders.into_iter().map(|folder| (folder, false))),
            CatalogRequest::Show(folder) | CatalogRequest::Load(folder) => {
                self.queue.retain(|(other, _)| *other != folder);
                self.queue.push_front((folder, true));
            }
        }
    }

    fn show(&mut self, folder: PathBuf) -> Result<(), ()> {
        let marker = self.marker.clone();
        let event = marker.during(&id(&folder), || match self.load(&folder) {
            Ok(exhibit) => lit(exhibit),
            Err(report) => CatalogEvent::Failed(report.to_string()),
        });
        if let CatalogEvent::Show(..) = event {
            self.shown = folder;
        }
        self.events.send(event).map_err(drop)
    }

    fn look(&mut self, folder: &Path, changed: bool) -> Result<(), ()> {
        let id = id(folder);
        if !is_exhibit(folder) {
            return self.events.send(CatalogEvent::Removed(id)).map_err(drop);
        }
        let events = match self.load(folder) {
            Ok(exhibit) => {
                let entry = CatalogEntry {
                    id,
                    folder: folder.to_path_buf(),
                    labels: exhibit.labels.clone(),
                    thumbnail: thumbnail::read(folder, THUMBNAIL_SIZE),
                };
                if changed && folder == self.shown {
                    self.events.send(lit(exhibit)).map_err(drop)?;
                }
                CatalogEvent::Listed(Box::new(entry))
            }
            Err(report) => CatalogEvent::Rejected(id, report.to_string()),
        };
        self.events.send(events).map_err(drop)
    }
}

/// The event that shows an exhibit, with its light; or why it cannot be drawn.
fn lit(exhibit: Exhibit) -> CatalogEvent {
    match Baked::new(&exhibit, &Lighting::default()) {
        Ok(baked) => CatalogEvent::Show(Arc::new(exhibit), Box::new(baked)),
        Err(error) => CatalogEvent::Failed(format!("{} cannot be drawn: {error}", exhibit.id)),
    }
}

/// The exhibits that a visitor can choose from, as far as they have loaded, in order.
#[derive(Debug, Default)]
pub struct Catalog {
    show: Vec<String>,
    entries: Vec<CatalogEntry>,
    /// Folders that are not loaded yet. They can be requested, but are not listed.
    expected: Vec<PathBuf>,
}

impl Catalog {
    /// An empty catalog for the ids of this source, in its order.
    pub fn new(places: &ExhibitSource) -> Self {
        let show = match places {
            ExhibitSource::One(folder) => vec![id(folder)],
            ExhibitSource::All { show, .. } => show.clone(),
        };
        Self { show, entries: Vec::new(), expected: Vec::new() }
    }

    /// Expects the exhibits of these folders, until they are inserted or removed.
    pub fn expect(&mut self, folders: Vec<PathBuf>) {
        self.expected = folders;
    }

    /// Folders of the exhibits that can be requested, in order: the entries, and those that are not loaded yet.
    fn folders(&self) -> Vec<&Path> {
        let entries = self.entries.iter().map(|entry| entry.folder.as_path());
        let mut all: Vec<&Path> = entries.chain(self.expected.iter().map(PathBuf::as_path)).collect();
        all.sort_by_key(|folder| (self.rank(&id(folder)), id(folder)));
        all
    }

    /// Folder of the exhibit with this id, where it can be requested.
    pub fn folder(&self, wanted: &str) -> Option<&Path> {
        self.folders().into_iter().find(|folder| id(folder) == wanted)
    }

    /// The entries in order.
    pub fn entries(&self) -> &[CatalogEntry] {
        &self.entries
    }

    /// Inserts an entry, or replaces its older version; one that is not offered is left out.
    pub fn insert(&mut self, entry: CatalogEntry) {
        self.remove(&entry.id);
        if let Some(rank) = self.rank(&entry.id) {
            let key = |other: &CatalogEntry| (self.rank(&other.id), other.id.clone());
            let at = self.entries.partition_point(|other| key(other) < (Some(rank), entry.id.clone()));
            self.entries.insert(at, entry);
        }
    }

    /// Offers these ids in this order. Newly offered ones must be inserted.
    pub fn reorder(&mut self, show: &[String]) {
        self.show = show.to_vec();
        let entries = std::mem::take(&mut self.entries);
        entries.into_iter().for_each(|entry| self.insert(entry));
    }

    /// Removes an entry.
    pub fn remove(&mut self, id: &str) {
        self.entries.retain(|entry| entry.id != id);
        self.expected.retain(|folder| self::id(folder) != id);
    }

    /// Folder of the exhibit `by` places after the one with this id, cyclically; `None` where there is no other.
    pub fn neighbour(&self, id: &str, by: isize) -> Option<&Path> {
        let all = self.folders();
        let next = match all.iter().position(|folder| self::id(folder) == id) {
            Some(at) => (at as isize + by).rem_euclid(all.len() as isize),
            None => 0,
        };
        all.get(next as usize).copied().filter(|folder| self::id(folder) != id)
    }

    fn rank(&self, id: &str) -> Option<usize> {
        let of = |name: &str| self.show.iter().position(|other| other == name);
        of(id).or_else(|| of(OTHERS))
    }
}

/// The folders of the offered exhibits, in order.
pub fn folders(places: &ExhibitSource) -> Vec<PathBuf> {
    let ExhibitSource::All { folder, .. } = places else {
        let ExhibitSource::One(folder) = places else { return Vec::new() };
        return vec![folder.clone()];
    };
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
    let mut all: Vec<PathBuf> = entries.filter(|path| is_exhibit(path)).collect();
    let offer = Catalog::new(places);
    all.retain(|path| offer.rank(&id(path)).is_some());
    all.sort_by_key(|path| (offer.rank(&id(path)), id(path)));
    all
}

/// Does this kind of event change what an exhibit is? (Reading it does not.)
pub fn is_change(kind: &EventKind) -> bool {
    matches!(kind, EventKind::Create(_) | EventKind::Modify(_) | EventKind::Remove(_) | EventKind::Any)
}

/// Is this the folder of an exhibit? Hidden folders are not: they may be incomplete.
fn is_exhibit(folder: &Path) -> bool {
    !id(folder).starts_with('.') && folder.join(exhibit::SIDECAR).is_file()
}

/// The id of an exhibit: the name of its folder.
pub fn id(folder: &Path) -> String {
    folder.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

fn watcher(
    folder: &Path,
    one: bool,
    requests: Sender<CatalogRequest>,
) -> Result<Debouncer<RecommendedWatcher, RecommendedCache>, notify_debouncer_full::notify::Error> {
    // The system reports absolute paths; requests use the path as it was given.
    let (real, given) = (folder.canonicalize().unwrap_or_else(|_| folder.to_path_buf()), folder.to_path_buf());
    let whose = move |path: &PathBuf| match one {
        true => Some(given.clone()),
        false => {
            let inside = path.strip_prefix(&real).or_else(|_| path.strip_prefix(&given)).ok()?;
            Some(given.join(inside.components().next()?))
        }
    };
    let mut debouncer = new_debouncer(QUIET, None, move |result: DebounceEventResult| match result {
        Ok(events) => {
            let changes = events.iter().filter(|event| is_change(&event.kind));
            let mut folders: Vec<PathBuf> = changes.flat_map(|event| event.paths.iter().filter_map(&whose)).collect();
            folders.sort();
            folders.dedup();
            folders.into_iter().for_each(|folder| drop(requests.send(CatalogRequest::Load(folder))));
        }
        Err(errors) => errors.iter().for_each(|error| tracing::warn!("watching the exhibits: {error}")),
    })?;
    debouncer.watch(folder, RecursiveMode::Recursive)?;
    Ok(debouncer)
}

//! The shelf: the exhibits that a visitor can choose from, and what curators do to them while the kiosk runs.
//!
//! One worker loads. At first it looks at every exhibit once, in their order: what loads stands on the shelf with its
//! labels and its picture, what does not is reported and left out. Folders are watched; after 300 ms of silence (editors
//! write in several steps) the worker looks again, so a folder that is dropped appears, one that is taken away goes, and
//! what a curator saves is what is shown. The one on show changes only to what has loaded: the last good one stays.

use std::collections::VecDeque;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, TryRecvError, channel};
use std::time::Duration;

use notify_debouncer_full::notify::{EventKind, RecommendedWatcher, RecursiveMode};
use notify_debouncer_full::{DebounceEventResult, Debouncer, RecommendedCache, new_debouncer};

use soffio_config::OTHERS;
use soffio_exhibit::{self as exhibit, Exhibit, Labels};

/// Silence after the last change before an exhibit is loaded.
pub const QUIET: Duration = Duration::from_millis(300);
/// The picture of an exhibit, in its folder.
pub const THUMBNAIL: &str = "thumbnail.png";
/// Pixels of it that are kept: a tile is no larger on the glass.
const THUMBNAIL_SIZE: (u32, u32) = (480, 270);

/// Where exhibits come from.
#[derive(Clone, Debug)]
pub enum Places {
    /// One folder, one exhibit.
    One(PathBuf),
    /// The folders in a folder.
    All {
        /// The folder.
        folder: PathBuf,
        /// Ids in the order in which they are offered; [`OTHERS`] are the rest.
        show: Vec<String>,
    },
}

/// An exhibit as it stands on the shelf.
#[derive(Clone, Debug)]
pub struct Work {
    /// Name of its folder.
    pub id: String,
    /// Its folder.
    pub folder: PathBuf,
    /// What is written beside it.
    pub labels: Labels,
    /// Its picture.
    pub thumbnail: Option<image::RgbaImage>,
}

/// What the worker has to say.
pub enum News {
    /// What was asked to be shown, or is shown and has changed.
    Show(Arc<Exhibit>),
    /// That one does not load; the report.
    Failed(String),
    /// It stands on the shelf, or stands there anew.
    Stands(Box<Work>),
    /// It does not load any more or never did; the report.
    Falls(String, String),
    /// Its folder is gone.
    Gone(String),
}

enum Ask {
    Show(PathBuf),
    Look(PathBuf),
}

/// Loads and watches for as long as it lives.
pub struct Shelf {
    news: Receiver<News>,
    asks: Sender<Ask>,
    /// Ends the watching when dropped.
    _watcher: Option<Debouncer<RecommendedWatcher, RecommendedCache>>,
}

impl Shelf {
    /// Looks at the exhibits there, `shown` being on show, and at every change if `watched`. Where watching is
    /// impossible the reason is logged and asking remains.
    pub fn new(places: &Places, shown: &Path, watched: bool) -> Self {
        let (asks, asked) = channel::<Ask>();
        let (answers, news) = channel();
        let mut worker = Worker {
            answers,
            looks: folders(places).into_iter().map(|folder| (folder, false)).collect(),
            shown: shown.to_path_buf(),
        };
        let thread = std::thread::Builder::new().name("soffio-exhibits".into()).spawn(move || worker.run(&asked));
        if let Err(error) = thread {
            tracing::error!("no other exhibit can be loaded: {error}");
        }
        let (watch, one) = match places {
            Places::One(folder) => (folder, true),
            Places::All { folder, .. } => (folder, false),
        };
        let watcher = watched.then(|| watcher(watch, one, asks.clone()));
        if let Some(Err(error)) = &watcher {
            tracing::warn!("{} is not watched for changes: {error}", watch.display());
        }
        Self { news, asks, _watcher: watcher.and_then(Result::ok) }
    }

    /// Asks for the exhibit of a folder, to be shown: [`News::Show`] or [`News::Failed`] follows.
    pub fn show(&self, folder: &Path) {
        // The worker lives as long as this value does; if it died, the picture stays as it is.
        let _ = self.asks.send(Ask::Show(folder.to_path_buf()));
    }

    /// Looks at a folder that was not offered before: [`News::Stands`] or [`News::Falls`] follows.
    pub fn look(&self, folder: &Path) {
        let _ = self.asks.send(Ask::Look(folder.to_path_buf()));
    }

    /// What has happened, the oldest first.
    pub fn news(&self) -> Option<News> {
        self.news.try_recv().ok()
    }

    /// Waits for what happens next.
    pub fn wait(&self, longest: Duration) -> Option<News> {
        self.news.recv_timeout(longest).ok()
    }
}

/// What lives on the worker's thread.
struct Worker {
    answers: Sender<News>,
    /// What is to be looked at, and whether it has changed.
    looks: VecDeque<(PathBuf, bool)>,
    shown: PathBuf,
}

impl Worker {
    /// Ends when every asker is gone, or nobody listens.
    fn run(&mut self, asked: &Receiver<Ask>) {
        loop {
            let ask = match asked.try_recv() {
                Err(TryRecvError::Empty) if self.looks.is_empty() => match asked.recv() {
                    Ok(ask) => Some(ask),
                    Err(_) => return,
                },
                Err(TryRecvError::Disconnected) => return,
                Err(TryRecvError::Empty) => None,
                Ok(ask) => Some(ask),
            };
            let told = match ask {
                Some(Ask::Show(folder)) => self.show(folder),
                // Changes that came while something was loading are one change.
                Some(Ask::Look(folder)) => {
                    self.looks.retain(|(other, _)| *other != folder);
                    self.looks.push_front((folder, true));
                    Ok(())
                }
                None => self.looks.pop_front().map_or(Ok(()), |(folder, changed)| self.look(&folder, changed)),
            };
            if told.is_err() {
                return;
            }
        }
    }

    fn show(&mut self, folder: PathBuf) -> Result<(), ()> {
        let news = match exhibit::load(&folder) {
            Ok(exhibit) => {
                self.shown = folder;
                News::Show(Arc::new(exhibit))
            }
            Err(report) => News::Failed(report.to_string()),
        };
        self.answers.send(news).map_err(drop)
    }

    fn look(&mut self, folder: &Path, changed: bool) -> Result<(), ()> {
        let id = id(folder);
        if !is_exhibit(folder) {
            return self.answers.send(News::Gone(id)).map_err(drop);
        }
        let news = match exhibit::load(folder) {
            Ok(exhibit) => {
                let work = Work {
                    id,
                    folder: folder.to_path_buf(),
                    labels: exhibit.labels.clone(),
                    thumbnail: thumbnail(folder),
                };
                if changed && folder == self.shown {
                    self.answers.send(News::Show(Arc::new(exhibit))).map_err(drop)?;
                }
                News::Stands(Box::new(work))
            }
            Err(report) => News::Falls(id, report.to_string()),
        };
        self.answers.send(news).map_err(drop)
    }
}

/// The exhibits a visitor can choose from, as far as they are known, in their order.
#[derive(Debug, Default)]
pub struct Offer {
    show: Vec<String>,
    works: Vec<Work>,
}

impl Offer {
    /// Nothing yet; of what comes, these ids in this order.
    pub fn new(places: &Places) -> Self {
        let show = match places {
            Places::One(folder) => vec![id(folder)],
            Places::All { show, .. } => show.clone(),
        };
        Self { show, works: Vec::new() }
    }

    /// The works, in their order.
    pub fn works(&self) -> &[Work] {
        &self.works
    }

    /// Takes one up, or its newer form; one that is not offered is left out.
    pub fn put(&mut self, work: Work) {
        self.remove(&work.id);
        if let Some(rank) = self.rank(&work.id) {
            let key = |other: &Work| (self.rank(&other.id), other.id.clone());
            let at = self.works.partition_point(|other| key(other) < (Some(rank), work.id.clone()));
            self.works.insert(at, work);
        }
    }

    /// These ids in this order from now on. What is newly wanted is not there yet: put it.
    pub fn reorder(&mut self, show: &[String]) {
        self.show = show.to_vec();
        let works = std::mem::take(&mut self.works);
        works.into_iter().for_each(|work| self.put(work));
    }

    /// Takes one away.
    pub fn remove(&mut self, id: &str) {
        self.works.retain(|work| work.id != id);
    }

    /// The one so many places after the one with this id, round and round.
    pub fn beside(&self, id: &str, by: isize) -> Option<&Work> {
        let at = self.works.iter().position(|work| work.id == id);
        let count = self.works.len() as isize;
        let next = match at {
            Some(at) => (at as isize + by).rem_euclid(count.max(1)),
            None => 0,
        };
        self.works.get(next as usize).filter(|work| work.id != id)
    }

    fn rank(&self, id: &str) -> Option<usize> {
        let of = |name: &str| self.show.iter().position(|other| other == name);
        of(id).or_else(|| of(OTHERS))
    }
}

/// The folders there, in the order in which they are offered.
pub fn folders(places: &Places) -> Vec<PathBuf> {
    let Places::All { folder, show } = places else {
        let Places::One(folder) = places else { return Vec::new() };
        return vec![folder.clone()];
    };
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
    let mut all: Vec<PathBuf> = entries.filter(|path| is_exhibit(path)).collect();
    let offer = Offer { show: show.clone(), works: Vec::new() };
    all.retain(|path| offer.rank(&id(path)).is_some());
    all.sort_by_key(|path| (offer.rank(&id(path)), id(path)));
    all
}

/// Does this kind of event change what an exhibit is? (Reading it does not.)
pub fn is_change(kind: &EventKind) -> bool {
    matches!(kind, EventKind::Create(_) | EventKind::Modify(_) | EventKind::Remove(_) | EventKind::Any)
}

/// A folder whose name begins with a dot is on its way, or nobody's business.
fn is_exhibit(folder: &Path) -> bool {
    !id(folder).starts_with('.') && folder.join(exhibit::SIDECAR).is_file()
}

/// The id of an exhibit: the name of its folder.
pub fn id(folder: &Path) -> String {
    folder.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

/// The exhibit's own picture, small; none where there is none that can be read.
fn thumbnail(folder: &Path) -> Option<image::RgbaImage> {
    let picture = image::open(folder.join(THUMBNAIL)).ok()?;
    let (width, height) = THUMBNAIL_SIZE;
    Some(picture.resize_to_fill(width, height, image::imageops::FilterType::Triangle).to_rgba8())
}

fn watcher(
    folder: &Path,
    one: bool,
    asks: Sender<Ask>,
) -> Result<Debouncer<RecommendedWatcher, RecommendedCache>, notify_debouncer_full::notify::Error> {
    // The system says absolute paths; what is asked for is said as it was given.
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
            folders.into_iter().for_each(|folder| drop(asks.send(Ask::Look(folder))));
        }
        Err(errors) => errors.iter().for_each(|error| tracing::warn!("watching the exhibits: {error}")),
    })?;
    debouncer.watch(folder, RecursiveMode::Recursive)?;
    Ok(debouncer)
}

//! Exhibits that visitors can choose from, their pictures, and the next one.

use std::path::Path;

use crate::fleet::Fleet;
use crate::venue::catalog::{Catalog, CatalogLoader, ExhibitSource, folders, id};
use crate::venue::quarantine::Quarantine;
use soffio_config::Config;

/// Exhibits that visitors can choose from.
pub(crate) struct ExhibitSelection {
    /// Loads exhibits on a thread of its own.
    pub loader: CatalogLoader,
    /// The exhibits on offer, in their order.
    pub offer: Catalog,
    /// Pictures of the exhibits, by id.
    pub thumbnails: Vec<(String, egui::TextureHandle)>,
    /// Id of the exhibit that was requested last, until a frame shows it or it fails.
    pending: Option<String>,
    /// Count of handled swipes.
    swipes: i64,
    /// Why the files of the exhibit on show do not load.
    pub problem: Option<String>,
}

impl ExhibitSelection {
    /// The exhibits of `places`; `shown` is the folder on show.
    pub fn new(places: &ExhibitSource, shown: &Path, hot_reload: bool, fleet: &Fleet) -> Self {
        let quarantine = &fleet.persisted().quarantine;
        let loader = CatalogLoader::new(places, shown, hot_reload, quarantine, fleet.load_marker());
        let mut offer = Catalog::new(places);
        offer.expect(loader.unlisted().to_vec());
        Self { loader, offer, thumbnails: Vec::new(), pending: None, swipes: 0, problem: None }
    }

    /// Requests the exhibit in a folder again, or for the first time.
    pub fn request(&mut self, folder: &Path) {
        self.pending = Some(id(folder));
        self.loader.show(folder);
    }

    /// Requests the exhibit `by` places after the one that was requested last, else after the one in the folder `shown`; returns
    /// whether there is another.
    pub fn show_neighbour(&mut self, shown: &Path, by: i32) -> bool {
        let from = self.pending.clone().unwrap_or_else(|| id(shown));
        let next = self.offer.neighbour(&from, by as isize).map(Path::to_path_buf);
        next.inspect(|folder| self.request(folder)).is_some()
    }

    /// Requests the exhibit at this index.
    pub fn show_at(&mut self, index: usize) {
        let exhibit = self.offer.entries().get(index).map(|exhibit| exhibit.folder.clone());
        exhibit.inspect(|folder| self.request(folder));
    }

    /// Requests an exhibit by its id; returns whether it is offered.
    pub fn show(&mut self, id: &str) -> bool {
        let folder = self.offer.folder(id).map(Path::to_path_buf);
        folder.inspect(|folder| self.request(folder)).is_some()
    }

    /// Is a requested exhibit not on show yet?
    pub fn is_changing(&self) -> bool {
        self.pending.is_some()
    }

    /// A frame shows the exhibit with this id.
    pub fn record_shown(&mut self, id: &str) {
        self.pending.take_if(|pending| pending == id);
    }

    /// The exhibit that was requested last does not load: it is offered again when its files have changed.
    pub fn record_failed(&mut self) {
        if let Some(id) = self.pending.take() {
            self.offer.remove(&id);
        }
    }

    /// New swipes since the last call; `swipes` is the count so far.
    pub fn swiped(&mut self, swipes: i64) -> i32 {
        (swipes - std::mem::replace(&mut self.swipes, swipes)) as i32
    }

    /// Offers the exhibits in the configuration's order, and loads those that were not offered before and are not set aside.
    pub fn reorder(&mut self, config: &Config, quarantine: &Quarantine) {
        let site = &config.exhibits;
        self.offer.reorder(&site.show);
        let places = ExhibitSource::All { folder: site.folder.clone(), show: site.show.clone() };
        for folder in folders(&places).into_iter().filter(|folder| !quarantine.contains(&id(folder))) {
            if !self.offer.entries().iter().any(|exhibit| exhibit.id == id(&folder)) {
                self.loader.load(&folder);
            }
        }
    }
}

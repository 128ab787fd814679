//! Exhibits that visitors can choose from, their pictures, and the next one.

use std::path::Path;

use crate::venue::catalog::{Catalog, CatalogLoader, ExhibitSource, folders, id};
use soffio_config::Config;

/// Exhibits that visitors can choose from.
pub(crate) struct ExhibitSelection {
    /// Loads exhibits on a thread of its own.
    pub loader: CatalogLoader,
    /// The exhibits on offer, in their order.
    pub offer: Catalog,
    /// Pictures of the exhibits, by id.
    pub thumbnails: Vec<(String, egui::TextureHandle)>,
    /// Is the next exhibit of attract mode being loaded?
    pub changing: bool,
    /// Count of handled swipes.
    swipes: i64,
    /// Why the files of the exhibit on show do not load.
    pub problem: Option<String>,
}

impl ExhibitSelection {
    /// The exhibits of `places`; `shown` is the folder on show.
    pub fn new(places: &ExhibitSource, shown: &Path, hot_reload: bool) -> Self {
        Self {
            loader: CatalogLoader::new(places, shown, hot_reload),
            offer: Catalog::new(places),
            thumbnails: Vec::new(),
            changing: false,
            swipes: 0,
            problem: None,
        }
    }

    /// Requests the exhibit `by` places after the one in the folder `shown`; returns whether there is another.
    pub fn show_neighbour(&self, shown: &Path, by: i32) -> bool {
        let next = self.offer.neighbour(&id(shown), by as isize);
        next.inspect(|exhibit| self.loader.show(&exhibit.folder)).is_some()
    }

    /// Requests the exhibit at this index.
    pub fn show_at(&self, index: usize) {
        if let Some(exhibit) = self.offer.entries().get(index) {
            self.loader.show(&exhibit.folder);
        }
    }

    /// Requests an exhibit by its id; returns whether it is offered.
    pub fn show(&self, id: &str) -> bool {
        let exhibit = self.offer.entries().iter().find(|exhibit| exhibit.id == id);
        exhibit.inspect(|exhibit| self.loader.show(&exhibit.folder)).is_some()
    }

    /// New swipes since the last call; `swipes` is the count so far.
    pub fn swiped(&mut self, swipes: i64) -> i32 {
        (swipes - std::mem::replace(&mut self.swipes, swipes)) as i32
    }

    /// Offers the exhibits in the configuration's order, and loads those that were not offered before.
    pub fn reorder(&mut self, config: &Config) {
        let site = &config.exhibits;
        self.offer.reorder(&site.show);
        let places = ExhibitSource::All { folder: site.folder.clone(), show: site.show.clone() };
        for folder in folders(&places) {
            if !self.offer.entries().iter().any(|exhibit| exhibit.id == id(&folder)) {
                self.loader.load(&folder);
            }
        }
    }
}

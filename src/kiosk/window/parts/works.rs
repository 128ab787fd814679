//! The works that visitors can choose from, their pictures, and which one comes next.

use std::path::Path;

use crate::venue::shelf::{Offer, Places, Shelf, folders, id};
use soffio_config::Config;

/// The works on offer.
pub(crate) struct Works {
    pub shelf: Shelf,
    pub offer: Offer,
    /// Pictures of the works, by id.
    pub thumbnails: Vec<(String, egui::TextureHandle)>,
    /// Is attract mode's next work being fetched?
    pub turning: bool,
    /// Works swiped on so far that were heeded.
    turned: i64,
    /// Why the work on show does not load as its files stand.
    pub says: Option<String>,
}

impl Works {
    /// Those of `places`, the one of a folder on show first.
    pub fn new(places: &Places, shown: &Path, hot_reload: bool) -> Self {
        Self {
            shelf: Shelf::new(places, shown, hot_reload),
            offer: Offer::new(places),
            thumbnails: Vec::new(),
            turning: false,
            turned: 0,
            says: None,
        }
    }

    /// Asks for the work so many places after the one in the folder `shown`; says whether there is another.
    pub fn leaf(&self, shown: &Path, by: i32) -> bool {
        let next = self.offer.beside(&id(shown), by as isize);
        next.inspect(|work| self.shelf.show(&work.folder)).is_some()
    }

    /// Asks for the work at a place among those offered.
    pub fn show_at(&self, index: usize) {
        if let Some(work) = self.offer.works().get(index) {
            self.shelf.show(&work.folder);
        }
    }

    /// Asks for a work by its id; says whether it is offered.
    pub fn show(&self, id: &str) -> bool {
        let work = self.offer.works().iter().find(|work| work.id == id);
        work.inspect(|work| self.shelf.show(&work.folder)).is_some()
    }

    /// Works that visitors have swiped on since this was asked last, `turned` being all so far.
    pub fn swiped(&mut self, turned: i64) -> i32 {
        (turned - std::mem::replace(&mut self.turned, turned)) as i32
    }

    /// Offers the works in the configuration's order; those that were not offered are looked at.
    pub fn reorder(&mut self, config: &Config) {
        let site = &config.exhibits;
        self.offer.reorder(&site.show);
        let places = Places::All { folder: site.folder.clone(), show: site.show.clone() };
        for folder in folders(&places) {
            if !self.offer.works().iter().any(|work| work.id == id(&folder)) {
                self.shelf.look(&folder);
            }
        }
    }
}

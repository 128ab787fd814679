//! What is rehearsed, and the house that it is rehearsed in.

use std::sync::Arc;

use super::house::{Crowd, House};
use super::room::{Echo, ROOMS, room};
use soffio_config::{Config, OTHERS};
use soffio_exhibit::{self as exhibit, Diagnostic, Exhibit, Report};
use soffio_kiosk::venue::site::Site;
use soffio_math::noise::{Random, hash_words};
use soffio_render::RenderError;
use soffio_soundscape::EXAM;
use soffio_soundscape::scenes::World;

/// Exhibits that visitors choose from: the first ones of the site.
const FEATURED: usize = 3;

/// What is rehearsed.
pub struct Rehearsal {
    /// Works that visitors choose from; the first is on show when the day begins.
    pub works: Vec<Arc<Exhibit>>,
    /// The site's settings.
    pub site: Site,
    /// Name of the room, one of [`ROOMS`].
    pub room: String,
    /// Capsules of the microphone, 1 or 2.
    pub capsules: usize,
    /// Who is in it.
    pub crowd: Crowd,
    /// Length of the day, h.
    pub hours: f64,
    /// Of the day, its people and its sounds.
    pub seed: u64,
}

/// Why there is no report.
#[derive(Debug, thiserror::Error)]
pub enum RehearsalError {
    /// There is no such room.
    #[error("there is no room \"{name}\"; there are: {}", ROOMS.map(|(name, ..)| name).join(", "))]
    Room {
        /// The name.
        name: String,
    },
    /// No pictures.
    #[error("{0}")]
    Pictures(#[from] RenderError),
    /// Ctrl-C.
    #[error("interrupted")]
    Interrupted,
}

/// The exhibits of a rehearsed day: the first ones that the site shows.
///
/// # Errors
/// There is no exhibit, or one of them cannot be loaded.
pub fn featured_exhibits(config: &Config) -> Result<Vec<Arc<Exhibit>>, Report> {
    let named = config.exhibits.show.iter().filter(|id| *id != OTHERS).cloned();
    let ids: Vec<String> = named.chain(exhibit::ids()).take(FEATURED).collect();
    if ids.is_empty() {
        let none = Diagnostic::new(exhibit::codes::NO_EXHIBIT, "there is no exhibit here");
        return Err(Report::single(none.help("run this where the folder `exhibits` is")));
    }
    let folder = |id: &String| {
        let folder = config.exhibits.folder.join(id);
        if folder.is_dir() { folder.to_string_lossy().into_owned() } else { id.clone() }
    };
    ids.iter().map(|id| exhibit::load(&exhibit::resolve(&folder(id))?).map(Arc::new)).collect()
}

/// The house of a day, and its way from loudspeaker to microphone.
pub(super) fn open_house(rehearsal: &mut Rehearsal) -> Result<House, RehearsalError> {
    let mut random = Random::new(hash_words(&[rehearsal.seed, 0x726f_6f6d]));
    let unknown = || RehearsalError::Room { name: rehearsal.room.clone() };
    let gallery = room(&rehearsal.room, &mut random).ok_or_else(unknown)?;
    let echo = Echo::new(&gallery, rehearsal.capsules, &mut random);
    let world = World::in_room(EXAM + hash_words(&[rehearsal.seed, 0x7669_7369]) % EXAM, gallery);
    let crowd = std::mem::replace(&mut rehearsal.crowd, Crowd::Made);
    Ok(House::new(world, echo, crowd, rehearsal.seed, (3600.0 * rehearsal.hours, rehearsal.capsules)))
}

//! Settings of a rehearsal, and its venue.

use std::sync::Arc;

use super::echo_path::{EchoPath, ROOMS, room};
use super::venue::{Crowd, Venue, VenueSettings};
use soffio_config::{Config, OTHERS};
use soffio_exhibit::{self as exhibit, Diagnostic, Exhibit, Report};
use soffio_kiosk::venue::site::Site;
use soffio_math::noise::{Random, hash_words};
use soffio_render::RenderError;
use soffio_soundscape::FIRST_VALIDATION_SEED;
use soffio_soundscape::scenes::Scenario;

/// Number of exhibits that visitors choose from: the first ones of the site.
const FEATURED: usize = 3;

/// Settings of a rehearsal.
pub struct Rehearsal {
    /// Exhibits that visitors choose from; the first is on show when the day begins.
    pub exhibits: Vec<Arc<Exhibit>>,
    /// The site's settings.
    pub site: Site,
    /// Name of the room, one of [`ROOMS`].
    pub room: String,
    /// Capsules of the microphone, 1 or 2.
    pub capsules: usize,
    /// Source of the crowd's sound.
    pub crowd: Crowd,
    /// Length of the day, h.
    pub hours: f64,
    /// Seed of visitors and sounds.
    pub seed: u64,
}

/// Reason why there is no report.
#[derive(Debug, thiserror::Error)]
pub enum RehearsalError {
    /// There is no room of this name.
    #[error("there is no room \"{name}\"; there are: {}", ROOMS.map(|(name, ..)| name).join(", "))]
    Room {
        /// The given name.
        name: String,
    },
    /// A picture could not be drawn.
    #[error("{0}")]
    Pictures(#[from] RenderError),
    /// The run was interrupted by Ctrl-C.
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

/// The venue of a rehearsal, with its room and its echo path.
pub(super) fn open_venue(rehearsal: &mut Rehearsal) -> Result<Venue, RehearsalError> {
    let mut random = Random::new(hash_words(&[rehearsal.seed, 0x726f_6f6d]));
    let unknown = || RehearsalError::Room { name: rehearsal.room.clone() };
    let gallery = room(&rehearsal.room, &mut random).ok_or_else(unknown)?;
    let echo = EchoPath::new(&gallery, rehearsal.capsules, &mut random);
    let scenario = Scenario::in_room(
        FIRST_VALIDATION_SEED + hash_words(&[rehearsal.seed, 0x7669_7369]) % FIRST_VALIDATION_SEED,
        gallery,
    );
    let crowd = std::mem::replace(&mut rehearsal.crowd, Crowd::Made);
    let draught_m_s = ROOMS.iter().find(|(name, ..)| *name == rehearsal.room).map_or(0.0, |(.., speed)| *speed);
    let (seed, day_s, capsules) = (rehearsal.seed, 3600.0 * rehearsal.hours, rehearsal.capsules);
    let settings = VenueSettings { seed, day_s, capsules, draught_m_s };
    Ok(Venue::new(scenario, echo, crowd, &settings))
}

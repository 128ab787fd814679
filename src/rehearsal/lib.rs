//! A synthetic gallery day: visitors, a crowd, staff and the kiosk's own loudspeaker around the whole pipeline, in a closed
//! loop, judged by what leaves the kiosk.
//!
//! ```text
//! day (who comes, when) → visitor ─┐
//!                  crowd, air ─────┤ house → microphone → machine (all that runs live) ─┬→ eyes → pictures ──┐
//!          room ← loudspeaker ─────┘                                                   └→ ears → loudspeaker ┴→ judge → report
//!            ↑                                                                                   │
//!            └───────────────────────────────────────────────────────────────────────────────────┘
//! ```
//!
//! Speakers, rooms and breaths come from seeds that no training of the ear uses ([`EXAM`]). The same seed gives the same
//! day and, on one machine, the same report; nothing here asks what time it is.
//!
//! It never opens a device: microphone and loudspeaker are computed, and so is the time of day. It writes no file; the
//! program prints its [`report`]. It draws pictures, so it needs a Vulkan driver, software or not.
//!
//! The main types are [`Rehearsal`] (what is rehearsed), [`day::Day`] (who comes when, and what staff do),
//! [`visitor::Visit`] (one visitor) and [`judge`] (whether a visitor was answered). [`run()`] rehearses with pictures;
//! [`listen()`] lets the detector alone hear the same day.
//!
//! ```
//! use soffio_rehearsal::day::Day;
//!
//! // The programme of one hour with three exhibits; attract mode begins after two minutes.
//! let day = |seed| Day::new(seed, 3600.0, 3, Some(120.0));
//! assert!(!day(1).entries.is_empty());
//! let begins = |seed| day(seed).entries.iter().map(|entry| entry.visit.arrives).collect::<Vec<f64>>();
//! assert_eq!(begins(1), begins(1), "the same seed gives the same day");
//! assert_ne!(begins(1), begins(2));
//! ```

pub mod day;
mod ears;
mod eyes;
mod house;
pub mod judge;
pub mod listening;
mod machine;
mod rate;
pub mod report;
mod room;
mod run;
mod standing;
mod twin;
pub mod visitor;

use std::sync::Arc;

use soffio_config::{Config, OTHERS};
use soffio_exhibit::{self as exhibit, Diagnostic, Exhibit, Report};
use soffio_kiosk::venue::site::Site;
use soffio_math::noise::{Random, hash_words};
use soffio_render::RenderError;
use soffio_soundscape::EXAM;
use soffio_soundscape::RATE;
use soffio_soundscape::scenes::World;

pub use house::{Crowd, recorded};
pub use listening::listen;
pub use room::ROOMS;
pub use run::run;

/// Samples a second of sound card and pipeline.
const SAMPLE_RATE_HZ: u32 = 48_000;
/// Length of a sound card's block: 10 ms, at 48 kHz and at the 16 kHz of what is made.
const FRAMES: usize = 480;
const BLOCK: usize = FRAMES * RATE as usize / SAMPLE_RATE_HZ as usize;

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
        return Err(Report::of(none.help("run this where the folder `exhibits` is")));
    }
    let folder = |id: &String| {
        let folder = config.exhibits.folder.join(id);
        if folder.is_dir() { folder.to_string_lossy().into_owned() } else { id.clone() }
    };
    ids.iter().map(|id| exhibit::load(&exhibit::resolve(&folder(id))?).map(Arc::new)).collect()
}

/// The house of a day, and its way from loudspeaker to microphone.
fn open_house(rehearsal: &mut Rehearsal) -> Result<house::House, RehearsalError> {
    let mut random = Random::new(hash_words(&[rehearsal.seed, 0x726f_6f6d]));
    let unknown = || RehearsalError::Room { name: rehearsal.room.clone() };
    let room = room::room(&rehearsal.room, &mut random).ok_or_else(unknown)?;
    let echo = room::Echo::new(&room, rehearsal.capsules, &mut random);
    let world = World::in_room(EXAM + hash_words(&[rehearsal.seed, 0x7669_7369]) % EXAM, room);
    let crowd = std::mem::replace(&mut rehearsal.crowd, Crowd::Made);
    Ok(house::House::new(world, echo, crowd, rehearsal.seed, (3600.0 * rehearsal.hours, rehearsal.capsules)))
}

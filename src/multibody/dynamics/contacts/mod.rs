//! Contacts of a figure in motion: hits at their own time, and rest without jitter, creep or sinking.
//!
//! A pair of colliders, or a bound of a limit, is *apart* until it is reached inside a substep; the substep is cut
//! there and the hit resolved with the joints' own factor, so that it travels through the whole figure (`hit`). What
//! meets slower than `REST_SPEED`, or slowly and again within `CHATTER_TIME`, *rests*: from then on it is held by
//! forces over the whole substep (`rest`) until it has opened by more than `RELEASE_GAP`.
//!
//! Impacts of several points and resting contact are one problem (`problem`): reduced coordinates of what moves (`coordinates`), islands
//! of it (`islands`), the laws of each touch (`law`), and the solver (`newton`, `leap`, `envelope`). Where a step has no time to follow
//! impacts one by one, its rest is a single substep that solves all of them with the resting contacts (`together`).

mod asleep;
mod coordinates;
mod envelope;
mod held;
mod hit;
mod impact;
mod islands;
mod law;
mod leap;
mod met;
mod near;
mod newton;
mod open;
mod problem;
mod rest;
mod resting;
mod row;
mod sleepers;
mod state;
mod surfaces;
mod sweep;
mod together;
mod touch;
mod touching;
mod twist;

pub use hit::{Strike, Struck, strike};
pub use impact::{Impact, ImpactKind, SurfacePair};
pub use met::{ENDS, Met, couple_rows};
pub(super) use rest::{LAST_PASS, Verdict};
pub(super) use row::Row;
pub use state::Contacts;
pub(super) use sweep::Hit;
pub use touch::Resistance;
pub use touching::Touching;

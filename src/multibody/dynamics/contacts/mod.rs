//! Contacts of a figure in motion: hits at their own time, and rest without jitter, creep or sinking.
//!
//! A pair of colliders, or a bound of a limit, is *apart* until it is reached inside a substep; the substep is cut
//! there and the hit resolved with the joints' own factor, so that it travels through the whole figure (`hit`). What
//! meets slower than `REST_SPEED`, or slowly and again within `CHATTER_TIME`, *rests*: from then on it is held by
//! forces over the whole substep (`rest`) until it has opened by more than `RELEASE_GAP`.

mod asleep;
mod grip;
mod held;
mod hit;
mod impact;
mod leap;
mod met;
mod near;
mod open;
mod problem;
mod rest;
mod resting;
mod row;
mod sleepers;
mod state;
mod surfaces;
mod sweep;
mod touch;
mod touching;
mod twist;

pub use hit::{Strike, Struck, strike};
pub use impact::{Impact, ImpactKind, SurfacePair};
pub use met::{ENDS, Met, couple_rows};
pub(super) use rest::Verdict;
pub(super) use row::Row;
pub use state::Contacts;
pub(super) use sweep::Hit;
pub use touch::Resistance;
pub use touching::Touching;

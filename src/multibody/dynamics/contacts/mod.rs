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

mod active_set_step;
mod contact;
mod contact_forces;
mod contact_law;
mod contact_problem;
mod contact_report;
mod contact_solver;
mod earliest_impact;
mod envelope;
mod impact;
mod impact_solver;
mod islands;
mod jacobian_row;
mod nearby_pairs;
mod open_joints;
mod reduced_coordinates;
mod resting_contact;
mod resting_pairs;
mod rolling_resistance;
mod sleep;
mod sleeping_bodies;
mod state;
mod surfaces;
mod swept_contact;
mod time_stepping;

pub use contact::RollingResistance;
pub use contact_report::ContactReport;
pub(super) use earliest_impact::EarliestImpact;
pub use impact::{Impact, ImpactKind, SurfacePair};
pub use impact_solver::{PointImpact, PointImpactResult, resolve_point_impact};
pub(super) use jacobian_row::JacobianRow;
pub use jacobian_row::MAX_ROW_BODIES;
pub(super) use resting_contact::{LAST_PASS, PassOutcome};
pub use state::Contacts;
pub use swept_contact::{SweptContact, rolling_rows};

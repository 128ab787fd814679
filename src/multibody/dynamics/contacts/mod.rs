//! Contact dynamics: event-driven impacts, resting contacts without jitter, creep or sinking, and Moreau's time stepping.
//!
//! A pair of colliders, or a bound of a limit, is *apart* until the bodies reach it inside a substep. The substep is cut there
//! and the impact resolved with the joints' own factor, so that it acts on the whole articulation (`impact_solver`). A pair that
//! approaches slower than `REST_SPEED`, or slowly and again within `CHATTER_TIME`, is in *resting contact*: from then on forces
//! act on it over whole substeps (`resting_contact`) until it has opened by more than `RELEASE_GAP`.
//!
//! Impacts at several points and resting contacts are one problem (`contact_problem`): reduced coordinates (`reduced_coordinates`),
//! islands (`islands`), contact laws (`contact_law`) and the solver (`contact_solver`, `active_set_step`, `envelope`). Where a step
//! has no time to resolve impacts one by one, it solves them together with the resting contacts (`time_stepping`).

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
mod tyre;

pub use contact::RollingResistance;
pub use contact_report::ContactReport;
pub(super) use earliest_impact::EarliestImpact;
pub use impact::{Impact, ImpactKind, SurfacePair};
pub use impact_solver::{PointImpact, PointImpactResult, resolve_point_impact};
pub(super) use jacobian_row::JacobianRow;
pub use jacobian_row::MAX_ROW_BODIES;
pub(super) use open_joints::Stabilization;
pub(super) use resting_contact::{Pass, PassOutcome};
pub(super) use state::ContactSetup;
pub use state::Contacts;
pub use swept_contact::{SweptContact, rolling_rows};

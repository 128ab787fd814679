//! Where bodies touch: convex colliders, the pairs that can meet, when they do, and at which points.

mod advance;
mod broad;
mod manifold;
mod nearby;
mod pairs;
mod proximity;
pub mod reach;
mod shape;

pub use advance::{Sweep, TOUCH, TimeOfImpact, time_of_impact};
pub use broad::BroadPhase;
pub use manifold::{Corners, MANIFOLD_POINTS, Manifold, ManifoldPoint};
pub use pairs::{Excluded, Exclusion, Pair, Pairs, Reason, pairs};
pub use proximity::{Proximity, proximity};
pub use reach::Reach;
pub use shape::{Collider, Shape};

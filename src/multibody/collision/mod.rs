//! Collision detection: convex colliders, broad phase, distance queries, contact manifolds, swept tests.

mod broad_phase;
mod conservative_advancement;
mod manifold;
mod pair_cache;
mod pairs;
mod proximity;
pub mod reachable_volume;
mod shape;

pub use broad_phase::BroadPhase;
pub use conservative_advancement::{CONTACT_MARGIN, MovingCollider, Sweep, TimeOfImpact, time_of_impact};
pub use manifold::{MANIFOLD_POINTS, Manifold, ManifoldBuilder, ManifoldPoint};
pub use pairs::{ColliderPair, ColliderPairs, Excluded, Exclusion, PairExclusion, pairs};
pub use proximity::{Proximity, proximity};
pub use reachable_volume::ReachableVolumes;
pub use shape::{Collider, Shape};

//! Which colliders can meet at all, in a stable order, and why the others cannot.

use std::fmt;

use super::reachable_volume::ReachableVolumes;
use super::shape::Collider;

/// Two colliders of different bodies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ColliderPair {
    /// Index of the first collider; it belongs to a moving body.
    pub a: usize,
    /// Index of the second collider.
    pub b: usize,
}

/// Two bodies that never collide; `None` is the world.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Exclusion {
    /// The bodies.
    pub bodies: (Option<usize>, Option<usize>),
    /// Who says so.
    pub why: Excluded,
}

/// Who says that two bodies never collide.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Excluded {
    /// A constraint joins them.
    Joined,
    /// The exhibit's sidecar.
    ByCurator,
    /// Different kinds of motion move them.
    OtherKind,
}

/// Why two colliders are not a pair.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PairExclusion {
    /// They belong to one body.
    SameBody,
    /// Neither moves.
    BothStill,
    /// Their bodies are excluded.
    Excluded(Excluded),
    /// Their joints keep them at least so far apart, m.
    Unreachable(f64),
}

impl fmt::Display for PairExclusion {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::SameBody => write!(f, "parts of one body"),
            Self::BothStill => write!(f, "both stand still"),
            Self::Excluded(Excluded::Joined) => write!(f, "joined by a constraint"),
            Self::Excluded(Excluded::ByCurator) => write!(f, "excluded by the curator"),
            Self::Excluded(Excluded::OtherKind) => write!(f, "moved by different kinds of motion"),
            Self::Unreachable(apart) => write!(f, "out of reach by {:.1} mm", apart * 1e3),
        }
    }
}

/// All pairs of colliders.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ColliderPairs {
    /// Those that may meet. Pairs of the same two bodies stand together.
    pub meet: Vec<ColliderPair>,
    /// The others (the first index is the lesser), and why they cannot.
    pub left_out: Vec<(ColliderPair, PairExclusion)>,
}

/// Sorts all pairs of colliders into those that may meet and those that cannot.
pub fn pairs(colliders: &[Collider], excluded: &[Exclusion], volumes: &ReachableVolumes) -> ColliderPairs {
    let mut out = ColliderPairs::default();
    for i in 0..colliders.len() {
        for j in i + 1..colliders.len() {
            let (x, y) = (colliders[i].body, colliders[j].body);
            let between = |e: &&Exclusion| e.bodies == (x, y) || e.bodies == (y, x);
            let reason = if x.is_none() && y.is_none() {
                Some(PairExclusion::BothStill)
            } else if x == y {
                Some(PairExclusion::SameBody)
            } else if let Some(exclusion) = excluded.iter().find(between) {
                Some(PairExclusion::Excluded(exclusion.why))
            } else {
                let apart = volumes.clearance(i, j);
                (apart > 0.0).then_some(PairExclusion::Unreachable(apart))
            };
            match reason {
                Some(reason) => out.left_out.push((ColliderPair { a: i, b: j }, reason)),
                None => {
                    out.meet.push(if x.is_some() { ColliderPair { a: i, b: j } } else { ColliderPair { a: j, b: i } })
                }
            }
        }
    }
    out.meet.sort_by_key(|pair: &ColliderPair| (colliders[pair.a].body, colliders[pair.b].body));
    out
}

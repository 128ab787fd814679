//! What rests, and how long ago it was hit.

use super::contact::{Contact, Source};
use super::sleeping_bodies::SleepingBodies;
use super::surfaces::Surfaces;
use crate::dynamics::limits::Limits;

/// What rests among the pairs of a figure, and how many bounds do.
#[derive(Clone, Debug)]
pub(super) struct RestingSet {
    /// Whether each pair rests, the pairs that do, ascending, and how many bounds do.
    pub pairs: Vec<bool>,
    pub at_rest: Vec<usize>,
    pub bounds: usize,
    /// Each pair's last hit, s.
    pub last_hit: Vec<f64>,
    /// How deep each resting pair had sunk in at the last substep's end, m; not above 0.
    pub depth: Vec<f64>,
}

impl RestingSet {
    /// Nothing rests yet among so many pairs.
    pub fn new(pairs: usize) -> Self {
        Self {
            pairs: vec![false; pairs],
            at_rest: Vec::with_capacity(pairs),
            bounds: 0,
            last_hit: vec![f64::NEG_INFINITY; pairs],
            depth: vec![0.0; pairs],
        }
    }

    /// How many pairs and bounds rest.
    pub fn count(&self) -> usize {
        self.at_rest.len() + self.bounds
    }

    /// Forgets all rest, but for what the limits know of it.
    pub fn forget(&mut self) {
        self.pairs.fill(false);
        self.depth.fill(0.0);
        self.at_rest.clear();
        self.bounds = 0;
    }

    /// Sets whether a pair rests.
    pub fn set(&mut self, pair: usize, rests: bool) {
        if self.pairs[pair] == rests {
            return;
        }
        self.pairs[pair] = rests;
        self.depth[pair] = 0.0;
        match self.at_rest.binary_search(&pair) {
            Ok(at) => {
                self.at_rest.remove(at);
            }
            Err(at) => self.at_rest.insert(at, pair),
        }
    }

    /// Sets whether a bound rests.
    pub fn set_bound(&mut self, bound: usize, rests: bool, limits: &mut Limits) {
        self.bounds = self.bounds + usize::from(rests) - usize::from(limits.resting(bound));
        limits.set_resting(bound, rests);
    }

    /// Sets whether a pair or a bound rests.
    pub fn set_source(&mut self, source: Source, rests: bool, limits: &mut Limits) {
        match source {
            Source::Pair(pair) => self.set(pair, rests),
            Source::Bound(bound) => self.set_bound(bound, rests, limits),
        }
    }

    /// Notes how deep these touches of what rests and is awake have sunk in by the end of a substep.
    pub fn record_depths(&mut self, contacts: &[Contact], surfaces: &Surfaces, sleeping: &SleepingBodies) {
        for &pair in &self.at_rest {
            if !sleeping.sleep(surfaces.bodies_of(pair)) {
                self.depth[pair] = 0.0;
            }
        }
        for contact in contacts {
            if let Source::Pair(pair) = contact.source {
                self.depth[pair] = self.depth[pair].min(contact.gap);
            }
        }
    }
}

//! Which pairs and bounds are in resting contact.

use super::contact::{Contact, ContactSource};
use super::sleeping_bodies::SleepingBodies;
use super::surfaces::Surfaces;
use crate::dynamics::limits::Limits;

/// The pairs in resting contact, and how many bounds are. The limits themselves know which bounds.
#[derive(Clone, Debug)]
pub(super) struct RestingSet {
    /// Whether each pair is in resting contact.
    pub is_resting: Vec<bool>,
    /// The pairs that are, ascending.
    pub pairs: Vec<usize>,
    /// Number of bounds that are.
    pub bounds: usize,
    /// Time of each pair's last impact, s.
    pub last_impact: Vec<f64>,
    /// Largest penetration of each resting pair at the end of the last substep, m; not above 0.
    pub depth: Vec<f64>,
}

impl RestingSet {
    /// None of so many pairs rests.
    pub fn new(pairs: usize) -> Self {
        Self {
            is_resting: vec![false; pairs],
            pairs: Vec::with_capacity(pairs),
            bounds: 0,
            last_impact: vec![f64::NEG_INFINITY; pairs],
            depth: vec![0.0; pairs],
        }
    }

    /// Number of resting pairs and bounds.
    pub fn count(&self) -> usize {
        self.pairs.len() + self.bounds
    }

    /// Ends all resting contact, except in the limits.
    pub fn clear(&mut self) {
        self.is_resting.fill(false);
        self.depth.fill(0.0);
        self.pairs.clear();
        self.bounds = 0;
    }

    /// Sets whether a pair rests.
    pub fn set_pair(&mut self, pair: usize, is_resting: bool) {
        if self.is_resting[pair] == is_resting {
            return;
        }
        self.is_resting[pair] = is_resting;
        self.depth[pair] = 0.0;
        match self.pairs.binary_search(&pair) {
            Ok(at) => {
                self.pairs.remove(at);
            }
            Err(at) => self.pairs.insert(at, pair),
        }
    }

    /// Sets whether a bound rests.
    pub fn set_bound(&mut self, bound: usize, is_resting: bool, limits: &mut Limits) {
        self.bounds = self.bounds + usize::from(is_resting) - usize::from(limits.is_resting(bound));
        limits.set_resting(bound, is_resting);
    }

    /// Sets whether a pair or a bound rests.
    pub fn set(&mut self, source: ContactSource, is_resting: bool, limits: &mut Limits) {
        match source {
            ContactSource::Surfaces(pair) => self.set_pair(pair, is_resting),
            ContactSource::Limit(bound) => self.set_bound(bound, is_resting, limits),
        }
    }

    /// Records the penetration of these contacts, of the resting pairs that are awake, at the end of a substep.
    pub fn record_depths(&mut self, contacts: &[Contact], surfaces: &Surfaces, sleeping: &SleepingBodies) {
        for &pair in &self.pairs {
            if !sleeping.both(surfaces.bodies_of(pair)) {
                self.depth[pair] = 0.0;
            }
        }
        for contact in contacts {
            if let Some(pair) = contact.point_pair() {
                self.depth[pair] = self.depth[pair].min(contact.gap);
            }
        }
    }
}

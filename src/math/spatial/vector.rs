//! Spatial vectors for one body or for four lanes.

use super::Vec6;
use crate::lanes::{Four, Lanes, Real, V3};

/// Force and torque, or the linear and angular parts of an acceleration.
#[derive(Clone, Copy, Debug, Default)]
pub struct SpatialVector<T> {
    /// Linear part.
    pub linear: V3<T>,
    /// Angular part.
    pub angular: V3<T>,
}

impl<T: Real> SpatialVector<T> {
    /// Of each body.
    #[inline(always)]
    pub fn gather<'a, L: Lanes<T = T>>(lanes: L, of: impl Fn(usize) -> &'a Vec6) -> Self {
        let [x, y, z, a, b, c] = lanes.rows(of);
        Self { linear: V3 { x, y, z }, angular: V3 { x: a, y: b, z: c } }
    }

    /// The six numbers.
    #[inline(always)]
    pub fn numbers(&self) -> [T; 6] {
        let (l, a) = (&self.linear, &self.angular);
        [l.x, l.y, l.z, a.x, a.y, a.z]
    }
}

impl SpatialVector<Four> {
    /// Reads.
    #[inline(always)]
    pub fn get<L: Lanes>(&self, lanes: L) -> SpatialVector<L::T> {
        SpatialVector { linear: self.linear.get(lanes), angular: self.angular.get(lanes) }
    }

    /// Writes.
    #[inline(always)]
    pub fn put<L: Lanes>(&mut self, lanes: L, vector: &SpatialVector<L::T>) {
        self.linear.put(lanes, vector.linear);
        self.angular.put(lanes, vector.angular);
    }
}

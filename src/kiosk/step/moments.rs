//! The last moments of the simulation, a step apart: what a picture shows lies between two of them.
//!
//! Never beyond the newest: what has not happened is not drawn. So pictures stay a little behind, by as much as a step may be
//! published late and a picture be begun early.

use std::sync::Arc;

use soffio_simulation::Snapshot;

/// Moments that are kept.
const KEPT: usize = 4;
/// How far behind the clock pictures are, steps: one, because the step that is under way has not happened; one more for
/// what comes late or early (4 ms).
pub const BEHIND: f64 = 2.0;

/// The last moments, the oldest first.
#[derive(Clone, Debug)]
pub struct Moments([Arc<Snapshot>; KEPT]);

impl Moments {
    /// There was nothing before this one.
    pub fn new(snapshot: &Snapshot) -> Self {
        let only = Arc::new(snapshot.clone());
        Self(std::array::from_fn(|_| only.clone()))
    }

    /// The next step's. After another exhibit there was nothing before.
    pub fn push(&mut self, snapshot: &Snapshot) {
        if self.newest().poses.len() != snapshot.poses.len() {
            *self = Self::new(snapshot);
            return;
        }
        self.0.rotate_left(1);
        self.0[KEPT - 1] = Arc::new(snapshot.clone());
    }

    /// The last of all.
    pub fn newest(&self) -> &Arc<Snapshot> {
        &self.0[KEPT - 1]
    }

    /// Sets `moment` to the one so many steps before the newest, between the two around it: positions along a line, rotations
    /// along the shorter arc. What is older than all is the oldest, what is yet to come the newest.
    pub fn before(&self, steps: f64, moment: &mut Snapshot) {
        let place = ((KEPT - 1) as f64 - steps).clamp(0.0, (KEPT - 1) as f64);
        let first = (place as usize).min(KEPT - 2);
        moment.set_between(&self.0[first], &self.0[first + 1], place - first as f64);
    }
}

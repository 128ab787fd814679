//! Frame interpolation: a frame shows a state between two of the last simulation steps.
//!
//! It never extrapolates beyond the newest step. So frames are delayed by as much as a step may be published late and a frame
//! begun early.

use std::sync::Arc;

use soffio_simulation::Snapshot;

/// Snapshots in the history.
const CAPACITY: usize = 4;
/// Delay of the frames behind the clock, steps: one because the present step is not finished, and one for jitter (4 ms).
pub const DELAY_STEPS: f64 = 2.0;

/// The last snapshots, the oldest first.
#[derive(Clone, Debug)]
pub struct SnapshotHistory([Arc<Snapshot>; CAPACITY]);

impl SnapshotHistory {
    /// A history that begins with this snapshot.
    pub fn new(snapshot: &Snapshot) -> Self {
        let only = Arc::new(snapshot.clone());
        Self(std::array::from_fn(|_| only.clone()))
    }

    /// Adds the snapshot of the next step. Another exhibit starts a new history.
    pub fn push(&mut self, snapshot: &Snapshot) {
        if self.newest().poses.len() != snapshot.poses.len() {
            *self = Self::new(snapshot);
            return;
        }
        self.0.rotate_left(1);
        self.0[CAPACITY - 1] = Arc::new(snapshot.clone());
    }

    /// The newest snapshot.
    pub fn newest(&self) -> &Arc<Snapshot> {
        &self.0[CAPACITY - 1]
    }

    /// Sets `moment` to the state `steps` before the newest, interpolated between two snapshots: positions linearly, rotations
    /// along the shorter arc. It is clamped to the oldest and the newest snapshot.
    pub fn interpolate(&self, steps: f64, moment: &mut Snapshot) {
        let place = ((CAPACITY - 1) as f64 - steps).clamp(0.0, (CAPACITY - 1) as f64);
        let first = (place as usize).min(CAPACITY - 2);
        moment.set_between(&self.0[first], &self.0[first + 1], place - first as f64);
    }
}

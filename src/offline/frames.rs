//! Frame sampling: frame k is at t = k / fps, which is step 240 k / fps.
//!
//! Frames between two steps are interpolated, never extrapolated.

use soffio_math::Pose;
use soffio_simulation::{STEPS_PER_SECOND, Snapshot};

/// States that can be interpolated.
pub trait Blend {
    /// The state between `self` (0) and `next` (1).
    fn blend(&self, next: &Self, alpha: f64) -> Self;
}

impl Blend for Snapshot {
    fn blend(&self, next: &Self, alpha: f64) -> Self {
        self.interpolate(next, alpha)
    }
}

impl Blend for Vec<Pose> {
    fn blend(&self, next: &Self, alpha: f64) -> Self {
        self.iter().zip(next).map(|(from, to)| from.interpolate(to, alpha)).collect()
    }
}

/// Samples the frames of a run as it proceeds.
pub struct Frames<T> {
    fps: u64,
    next: u64,
    before: Option<(u64, T)>,
}

impl<T: Blend> Frames<T> {
    /// Frames from t = 0 on, `fps` a second (at least one).
    pub fn new(fps: u32) -> Self {
        Self { fps: u64::from(fps.max(1)), next: 0, before: None }
    }

    /// Takes a step and the state after it. `each` receives the number and the interpolated state of every frame that
    /// is due. Steps come in order, each once, from the start.
    ///
    /// # Errors
    /// An error of `each`.
    pub fn push<E>(
        &mut self,
        step: u64,
        now: impl FnOnce() -> T,
        mut each: impl FnMut(u64, &T) -> Result<(), E>,
    ) -> Result<(), E> {
        let due = |frame: u64, step: u64| frame * STEPS_PER_SECOND <= step * self.fps;
        // Only the neighbours of a frame matter.
        if !due(self.next, step + 1) {
            return Ok(());
        }
        let now = now();
        while due(self.next, step) {
            let at = self.next as f64 * STEPS_PER_SECOND as f64 / self.fps as f64;
            match &self.before {
                Some((earlier, before)) if *earlier < step && at < step as f64 => {
                    let alpha = (at - *earlier as f64) / (step - earlier) as f64;
                    each(self.next, &before.blend(&now, alpha))?;
                }
                _ => each(self.next, &now)?,
            }
            self.next += 1;
        }
        self.before = Some((step, now));
        Ok(())
    }
}

//! Onset compensation: extra impulse in the first moments of a breath, in the gallery profile.
//!
//! A breath is detected a tenth of a second or more after it begins, and a finger is known to blow, not to drag, as late.
//! The visitor expects the effect of the air that left the lips before. So the first moments after the detection add the
//! impulse of the lost time:
//!
//! ```text
//! gain = 1 + 2 L/T · max(0, 1 − t/T)      ∫ (gain − 1) dt = L      t: since the detection, L: detection delay, s
//! ```
//!
//! The start of a breath is found from the speed alone, so that a record of speeds replays to the bit. A visitor who
//! blows into the soft breath of a demonstration starts a new breath: it is several times as fast at once, as no breath
//! becomes by itself. A breath that swells from nothing gains little: it is slow during the compensation. The *physical*
//! profile compensates for nothing.

/// L: delay of the detection, sound travel included, s.
const DETECTION_DELAY: f64 = 0.15;
/// T: duration of the compensation, s: three frames of a 60 Hz display.
const COMPENSATION_TIME: f64 = 0.05;
/// Least pause between two breaths, s; shorter pauses belong to a faltering breath.
const LEAST_PAUSE: f64 = 0.5;
/// Least ratio of the speeds of two successive steps at which a new breath begins.
const NEW_BREATH_RATIO: f64 = 3.0;

/// Time course of the present breath.
#[derive(Clone, Copy, Debug)]
pub struct OnsetCompensation {
    /// Since the detection, s.
    age: f64,
    /// Since the speed was last above 0, s.
    pause: f64,
    /// Last speed above 0, m/s.
    speed: f64,
}

impl Default for OnsetCompensation {
    fn default() -> Self {
        Self { age: 0.0, pause: LEAST_PAUSE, speed: 0.0 }
    }
}

impl OnsetCompensation {
    /// Advances by `dt` seconds with this source speed, m/s; 0 without a breath.
    pub fn advance(&mut self, speed: f64, dt: f64) {
        if speed > 0.0 {
            let faster = self.pause == 0.0 && speed > NEW_BREATH_RATIO * self.speed;
            self.age = if self.pause >= LEAST_PAUSE || faster { 0.0 } else { self.age + dt };
            (self.pause, self.speed) = (0.0, speed);
        } else {
            self.pause += dt;
        }
    }

    /// Whether a breath began in this step.
    pub fn begins(&self) -> bool {
        self.pause == 0.0 && self.age == 0.0
    }

    /// Whether the present breath is still being compensated.
    pub fn is_compensating(&self) -> bool {
        self.pause == 0.0 && self.age < COMPENSATION_TIME
    }

    /// Factor of the breath's force.
    pub fn gain(&self) -> f64 {
        1.0 + 2.0 * DETECTION_DELAY / COMPENSATION_TIME * (1.0 - self.age / COMPENSATION_TIME).max(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DT: f64 = 1.0 / 240.0;

    /// Impulse that the compensation adds to a breath of one second, over its speed, s.
    fn added(onset: &mut OnsetCompensation, speed: f64) -> f64 {
        let step = |_| {
            onset.advance(speed, DT);
            (onset.gain() - 1.0) * DT
        };
        (0..240).map(step).sum()
    }

    fn pause(onset: &mut OnsetCompensation, seconds: f64) {
        (0..(seconds / DT) as usize).for_each(|_| onset.advance(0.0, DT));
    }

    #[test]
    fn a_breath_is_compensated_once() {
        // Sum of a falling line over 12 steps, each at its start: half a step of six too much.
        const STEPS: f64 = 0.09;
        let mut onset = OnsetCompensation::default();
        assert!((added(&mut onset, 5.0) / DETECTION_DELAY - 1.0).abs() < STEPS);
        pause(&mut onset, 0.3);
        assert_eq!(added(&mut onset, 5.0), 0.0, "it falters");
        pause(&mut onset, 0.6);
        assert!((added(&mut onset, 5.0) / DETECTION_DELAY - 1.0).abs() < STEPS, "another breath");
    }

    #[test]
    fn a_breath_into_a_demonstration_begins() {
        let mut onset = OnsetCompensation::default();
        added(&mut onset, 0.6);
        assert!(!onset.begins());
        assert_eq!(added(&mut onset, 1.5), 0.0, "it swells");
        onset.advance(5.0, DT);
        assert!(onset.begins(), "another breath");
        assert!(onset.gain() > 2.0);
    }
}

//! Colour of a breath: each combination of lips and capsule has its own spectrum.

use soffio_detector::generate::filter::{high_passed, low_passed};
use soffio_math::db_to_amplitude;
use soffio_math::noise::Random;

use super::R;

/// Gains of rumble and hiss relative to the formula of [`generate`](soffio_detector::generate).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lips {
    /// Factor below 350 Hz.
    rumble: f64,
    /// Factor above 350 Hz.
    hiss: f64,
    /// Additional share of 160–350 Hz.
    tilt: f64,
}

impl Lips {
    /// Random lips in front of a random capsule, off its axis by this many degrees.
    pub fn random(angle_deg: f64, random: &mut Random) -> Self {
        // Straight at a capsule behind a thick grille, there may be hardly any hiss.
        let least = if angle_deg < 15.0 && random.unit() < 0.3 { -25.0 } else { -4.0 };
        let (rumble, hiss) = (random.range(-3.0, 3.0), random.range(least, 6.0));
        let tilt = if random.unit() < 0.4 { random.range(-0.4, 2.5) } else { 0.0 };
        Self { rumble: db_to_amplitude(rumble), hiss: db_to_amplitude(hiss), tilt }
    }

    /// Applies the gains to a stream of the formula.
    pub fn filtered(&self, air: Vec<f64>) -> Vec<f64> {
        let low = low_passed(air.clone(), R, 350.0, 2);
        let upper = high_passed(low.clone(), R, 160.0, 1);
        let parts = air.iter().zip(low.iter().zip(&upper));
        parts.map(|(x, (l, u))| self.rumble * (l + self.tilt * u) + self.hiss * (x - l)).collect()
    }
}

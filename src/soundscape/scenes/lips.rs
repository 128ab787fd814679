//! How lips and capsule sound together: each pair colours a breath in its own way.

use soffio_detector::generate::filter::{high_passed, low_passed};
use soffio_math::from_decibels;
use soffio_math::noise::Random;

use super::R;

/// Rumble and hiss each louder or softer than the formula of [`generate`](soffio_detector::generate).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lips {
    /// Factors of what lies below and above 350 Hz.
    rumble: f64,
    hiss: f64,
    /// Share of 160–350 Hz that comes on top.
    tilt: f64,
}

impl Lips {
    /// Somebody's, before some capsule, beside its axis by so many degrees.
    pub fn random(angle_deg: f64, random: &mut Random) -> Self {
        // Straight at a capsule behind a thick grille, there may be hardly any hiss.
        let least = if angle_deg < 15.0 && random.unit() < 0.3 { -25.0 } else { -4.0 };
        let (rumble, hiss) = (random.range(-3.0, 3.0), random.range(least, 6.0));
        let tilt = if random.unit() < 0.4 { random.range(-0.4, 2.5) } else { 0.0 };
        Self { rumble: from_decibels(rumble), hiss: from_decibels(hiss), tilt }
    }

    /// What arrives of `air`, a stream by the formula.
    pub fn heard(&self, air: Vec<f64>) -> Vec<f64> {
        let low = low_passed(air.clone(), R, 350.0, 2);
        let upper = high_passed(low.clone(), R, 160.0, 1);
        let parts = air.iter().zip(low.iter().zip(&upper));
        parts.map(|(x, (l, u))| self.rumble * (l + self.tilt * u) + self.hiss * (x - l)).collect()
    }
}

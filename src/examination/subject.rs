//! What is examined: anything that takes samples and reports a speed.

use soffio_detector::BlowDetector;

/// A detector under examination.
pub trait Detector {
    /// Takes samples of one or two capsules (full scale ±1), and what the loudspeaker played meanwhile (empty for nothing).
    fn push(&mut self, left: &[f32], right: Option<&[f32]>, played: &[f32]);

    /// Speed that it reports now, m/s; 0 without a breath.
    fn speed(&self) -> f64;
}

/// Makes a detector for a sample rate, Hz.
pub type Make<'a> = dyn Fn(u32) -> Box<dyn Detector> + Sync + 'a;

/// The detector of the kiosk.
#[derive(Clone, Debug)]
pub struct Today(BlowDetector);

impl Today {
    /// A new detector for a sample rate, Hz.
    pub fn new(rate: u32) -> Self {
        Self(BlowDetector::new(rate))
    }
}

impl Detector for Today {
    fn push(&mut self, left: &[f32], right: Option<&[f32]>, played: &[f32]) {
        match right {
            Some(right) => self.0.push_stereo(left, right, played),
            None => self.0.push(left, played),
        }
    }

    fn speed(&self) -> f64 {
        self.0.estimate().speed
    }
}

//! Where the breath comes from: microphone, hold-to-blow, a script; joined into one source speed.

use super::Microphone;
use crate::math::exp;
use crate::wind::blow::{BlowDetector, BlowEstimate};

/// Speed at the lips of a held key or touch, m/s: a normal breath, 42 L/min through lips of 10 mm.
const HELD_SPEED: f64 = 9.0;
/// A held breath swells and fades with these times, s.
const ATTACK: f64 = 0.10;
const RELEASE: f64 = 0.12;
/// The lungs are empty after this long a hold, s; letting go fills them.
const LUNGS: f64 = 6.0;
/// Slower than this is no breath, m/s.
const STILL: f64 = 0.05;

/// All sources of breath of one kiosk.
#[derive(Default)]
pub struct BreathSource {
    detector: Option<(u32, BlowDetector)>,
    held: f64,
    held_for: f64,
    commanded: Option<f64>,
}

impl BreathSource {
    /// Sets or releases the commanded speed, m/s.
    pub fn command(&mut self, speed: Option<f64>) {
        self.commanded = speed.filter(|s| s.is_finite()).map(|s| s.max(0.0));
    }

    /// Hears one step of `dt` seconds. Returns the source speed (m/s, exactly 0 when nobody blows) and what the
    /// detector says.
    pub fn advance(&mut self, microphone: Option<Microphone>, hold: bool, dt: f64) -> (f64, BlowEstimate) {
        let estimate = match microphone {
            Some(heard) => {
                if self.detector.as_ref().is_none_or(|(rate, _)| *rate != heard.sample_rate) {
                    self.detector = Some((heard.sample_rate, BlowDetector::new(heard.sample_rate)));
                }
                self.detector.as_mut().map_or_else(BlowEstimate::default, |(_, detector)| {
                    detector.push(heard.samples, heard.reference);
                    detector.estimate()
                })
            }
            // Gone: the room is learnt anew when it comes back.
            None => {
                self.detector = None;
                BlowEstimate::default()
            }
        };
        self.held_for = if hold { self.held_for + dt } else { 0.0 };
        let (goal, time) = if hold && self.held_for < LUNGS { (HELD_SPEED, ATTACK) } else { (0.0, RELEASE) };
        self.held = goal + (self.held - goal) * exp(-dt / time);
        if goal == 0.0 && self.held < STILL {
            self.held = 0.0;
        }
        (estimate.speed.max(self.held).max(self.commanded.unwrap_or(0.0)), estimate)
    }
}

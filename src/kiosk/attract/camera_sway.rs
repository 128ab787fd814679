//! Camera sway in attract mode: the parallax separates wires and plates from the wall behind them.
//!
//! The camera orbits its target at constant distance, to the side by A sin(2πt/P), and up and down by a third of that. The
//! vertical period differs, so that the path does not repeat. The sway grows over half a minute. When somebody comes it is
//! gone within a second, because a breath is aimed through the exhibit's own camera. With reduced motion there is none.

use soffio_exhibit::View;
use soffio_math::{PI, sin};

/// Largest angles, rad: to the side (3.5°), and up or down.
const ASIDE: f64 = 0.061;
const TILT: f64 = 0.02;
/// Periods, horizontal and vertical, s.
const PERIODS: [f64; 2] = [52.0, 37.0];
/// Times in which the sway grows, and fades, s.
const GROWS_S: f64 = 30.0;
const GOES_S: f64 = 1.0;
/// Longest counted time between two frames, s.
const PAUSE: f64 = 0.1;

/// State of the sway.
#[derive(Clone, Copy, Debug, Default)]
pub struct CameraSway {
    /// Amplitude before smoothing, 0 … 1.
    grown: f64,
    last: f64,
}

impl CameraSway {
    /// The camera at `time`, s. `sways`: attract mode plays, without reduced motion.
    pub fn view(&mut self, rest: View, time: f64, sways: bool) -> View {
        let passed = (time - self.last).clamp(0.0, PAUSE);
        self.last = time;
        self.grown = (self.grown + if sways { passed / GROWS_S } else { -passed / GOES_S }).clamp(0.0, 1.0);
        if self.grown == 0.0 {
            return rest;
        }
        let share = self.grown * self.grown * (3.0 - 2.0 * self.grown);
        let [aside, tilt] = PERIODS.map(|period| share * sin(2.0 * PI * time / period));
        rest.orbited([ASIDE * aside, -TILT * tilt])
    }
}

//! The camera in attract mode: it sways slowly about the work, so that wires and plates part from the wall behind them.
//!
//! The eye goes round the point that it looks at, at the distance of the exhibit's own camera: aside by A sin(2πt/P) and up and
//! down by a third of that, with another period so that the way does not repeat. The sway grows over half a minute; when
//! somebody comes it is gone within one, because a breath is aimed by the exhibit's own camera. Where less motion is wanted
//! there is none.

use soffio_exhibit::View;
use soffio_math::{PI, sin};

/// Largest angles, rad: aside (3.5°), and up or down.
const ASIDE: f64 = 0.061;
const TILT: f64 = 0.02;
/// From one end to the other and back, s.
const PERIODS: [f64; 2] = [52.0, 37.0];
/// How long the sway grows, and how long it takes to go, s.
const GROWS_S: f64 = 30.0;
const GOES_S: f64 = 1.0;
/// Longest time between two pictures that counts, s.
const PAUSE: f64 = 0.1;

/// Where the sway stands.
#[derive(Clone, Copy, Debug, Default)]
pub struct Drift {
    /// 0 none … 1 all of it, before it is smoothed.
    grown: f64,
    last: f64,
}

impl Drift {
    /// The camera at `time`, s. `sways`: attract mode plays, and nobody wants less motion.
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

//! Dwell clicking, for visitors who point with an eye tracker, a head mouse or a stick and cannot press: a pointer that rests
//! for a while presses. A ring around it fills meanwhile.
//!
//! The pointer may tremble within a button, and on the picture within [`RADIUS`]. After a press the pointer must leave its
//! place before it can press again, even if something else has appeared below it.

use crate::visitor::input::Request;

/// Distance from which the pointer has left its place, picture heights.
pub const RADIUS: f64 = 0.04;
/// Time before the ring appears, s: a passing pointer shows none.
const PASSING_S: f64 = 0.25;

/// Target below the pointer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Target {
    /// A button.
    Button(Request),
    /// The exhibit: a press there begins a breath or ends it.
    Exhibit,
}

/// State of dwell clicking.
#[derive(Clone, Debug, Default)]
pub struct Dwell {
    resting: Option<Resting>,
}

#[derive(Clone, Copy, Debug)]
struct Resting {
    from: [f64; 2],
    since: f64,
    on: Option<Target>,
    /// Has this rest pressed already?
    spent: bool,
}

impl Dwell {
    /// Takes the pointer at `time`, s: its place in picture coordinates and its target; `None` where there is no free pointer.
    /// It presses after `seconds`. Returns the target that is pressed now. `aspect` is the picture's width over its height.
    pub fn update(
        &mut self,
        time: f64,
        pointer: Option<([f64; 2], Option<Target>)>,
        seconds: f64,
        aspect: f64,
    ) -> Option<Target> {
        let Some((at, on)) = pointer else {
            self.resting = None;
            return None;
        };
        let fresh = Resting { from: at, since: time, on, spent: false };
        let resting = self.resting.get_or_insert(fresh);
        let away = f64::hypot(aspect * (at[0] - resting.from[0]), at[1] - resting.from[1]) > RADIUS;
        let left = match (resting.spent, on) {
            (true, _) | (false, Some(Target::Exhibit) | None) => away,
            // On a button the place does not matter.
            (false, Some(Target::Button(_))) => false,
        };
        if left || !resting.spent && resting.on != on {
            *resting = fresh;
        }
        if resting.spent || resting.on.is_none() || time - resting.since < seconds {
            return None;
        }
        // The pointer must leave this place before the next press.
        (resting.spent, resting.from) = (true, at);
        resting.on
    }

    /// Share of the ring that is filled, 0 … 1; `None` where no ring is shown.
    pub fn progress(&self, time: f64, seconds: f64) -> Option<f64> {
        let resting = self.resting.filter(|resting| !resting.spent && resting.on.is_some())?;
        let rested = time - resting.since - PASSING_S;
        (rested > 0.0).then(|| (rested / (seconds - PASSING_S)).clamp(0.0, 1.0))
    }
}

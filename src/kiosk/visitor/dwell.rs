//! For whoever points and cannot press, with an eye tracker, a head mouse or a stick: where the pointer rests for a while
//! it presses. A ring about it fills meanwhile, so that nothing comes as a surprise.
//!
//! On a button it may tremble as far as the button goes, on the picture by [`RADIUS`]. After a press nothing more comes of
//! the same rest: the pointer must leave its place first, whatever has appeared below it.

use crate::visitor::input::Request;

/// Farther than this the pointer has left its place, picture heights.
pub const RADIUS: f64 = 0.04;
/// Whoever passes by is shown no ring, s.
const PASSING_S: f64 = 0.25;

/// What lies below the pointer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Target {
    /// A button.
    Button(Request),
    /// The work: a press there begins a breath or ends it.
    Work,
}

/// A pointer that rests, or does not.
#[derive(Clone, Debug, Default)]
pub struct Dwell {
    rest: Option<Rest>,
}

#[derive(Clone, Copy, Debug)]
struct Rest {
    from: [f64; 2],
    since: f64,
    on: Option<Target>,
    /// Has it pressed already?
    spent: bool,
}

impl Dwell {
    /// At `time`, s, the pointer is there (picture coordinates; `None` where there is none, or it is busy), on this; it
    /// presses after `seconds`. Says what is pressed now. `aspect` is the picture's width over its height.
    pub fn tend(
        &mut self,
        time: f64,
        pointer: Option<([f64; 2], Option<Target>)>,
        seconds: f64,
        aspect: f64,
    ) -> Option<Target> {
        let Some((at, on)) = pointer else {
            self.rest = None;
            return None;
        };
        let fresh = Rest { from: at, since: time, on, spent: false };
        let rest = self.rest.get_or_insert(fresh);
        let away = f64::hypot(aspect * (at[0] - rest.from[0]), at[1] - rest.from[1]) > RADIUS;
        let left = match (rest.spent, on) {
            (true, _) | (false, Some(Target::Work) | None) => away,
            // However large the button is.
            (false, Some(Target::Button(_))) => false,
        };
        if left || !rest.spent && rest.on != on {
            *rest = fresh;
        }
        if rest.spent || rest.on.is_none() || time - rest.since < seconds {
            return None;
        }
        // From here the pointer must leave.
        (rest.spent, rest.from) = (true, at);
        rest.on
    }

    /// How far the ring is filled, 0 … 1; `None` where there is nothing to show.
    pub fn share(&self, time: f64, seconds: f64) -> Option<f64> {
        let rest = self.rest.filter(|rest| !rest.spent && rest.on.is_some())?;
        let rested = time - rest.since - PASSING_S;
        (rested > 0.0).then(|| (rested / (seconds - PASSING_S)).clamp(0.0, 1.0))
    }
}

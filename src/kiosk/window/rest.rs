//! Fewer pictures while nothing in them changes, and all of them again with the first breath, touch or motion.
//!
//! Two look on: the simulation's [`Stillness`](crate::step::stillness::Stillness), and [`Rest`], which adds what the window
//! alone knows: that nobody touches anything and nothing on the page fades, fills or closes. Only where both are at rest the
//! next picture may wait for [`PICTURE_S`](crate::step::stillness::PICTURE_S); the step in which the first ends wakes the
//! window from that wait.

use crate::step::stillness::QUIET_S;

/// What the window knows when it draws a picture.
#[derive(Clone, Copy, Debug, Default)]
pub struct Signs {
    /// Does the exhibit stand still?
    pub still: bool,
    /// Does something on the page fade, fill or close, or is a panel open?
    pub page_moves: bool,
    /// Inputs so far, of any kind.
    pub inputs: u64,
}

/// Whether pictures may wait.
#[derive(Clone, Copy, Debug, Default)]
pub struct Rest {
    inputs: u64,
    /// When something was last seen to happen, s.
    busy: f64,
    rests: bool,
}

impl Rest {
    /// Takes notice of a picture at `time`, s; says whether the next one may wait.
    pub fn note(&mut self, time: f64, signs: Signs) -> bool {
        if !signs.still || signs.page_moves || signs.inputs != self.inputs {
            (self.busy, self.inputs) = (time, signs.inputs);
        }
        // The exhibit has been quiet for its own while already.
        self.rests = signs.still && time - self.busy >= QUIET_S;
        self.rests
    }

    /// Does the next picture wait?
    pub fn rests(&self) -> bool {
        self.rests
    }
}

//! Where the visitor looks from: the exhibit's own camera, or elsewhere on the sphere about its target.
//!
//! A breath is aimed and a hand takes along sight lines of this very eye, so that they hit what is seen there.

use soffio_exhibit::{Exhibit, View};

/// Width over height of a picture nobody described.
pub(crate) const DEFAULT_ASPECT: f64 = 16.0 / 9.0;

/// The eye of the step.
#[derive(Clone, Copy, Debug)]
pub struct Eye {
    /// Width over height of the picture.
    pub aspect: f64,
    /// How far it is turned from the exhibit's own view: to the right and up, rad.
    pub turn: [f64; 2],
    /// What it sees.
    pub view: View,
    /// The exhibit's own view at this aspect: to find it costs a look at every vertex.
    own: View,
}

impl Eye {
    /// The exhibit's own view.
    pub fn new(exhibit: &Exhibit) -> Self {
        let own = exhibit.view(DEFAULT_ASPECT);
        Self { aspect: DEFAULT_ASPECT, turn: [0.0; 2], view: own, own }
    }

    /// Looks as a step is told; an aspect that is no number is the usual one, a turn that is none is not taken.
    pub fn look(&mut self, exhibit: &Exhibit, aspect: f64, turn: [f64; 2]) {
        let aspect = if aspect > 0.0 { aspect } else { DEFAULT_ASPECT };
        let turn = if turn.iter().all(|angle| angle.is_finite()) { turn } else { self.turn };
        if aspect != self.aspect {
            (self.aspect, self.own) = (aspect, exhibit.view(aspect));
        } else if turn == self.turn {
            return;
        }
        (self.turn, self.view) = (turn, self.own.turned(turn));
    }
}

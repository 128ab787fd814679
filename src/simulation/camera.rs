//! Camera of the visitor: the exhibit's own view, or one turned about its target.
//!
//! The breath is aimed and pointers grab along rays of this camera, so that they act on what the picture shows there.

use soffio_exhibit::{Exhibit, View};

/// Width over height of the picture where none is given.
pub(crate) const DEFAULT_ASPECT: f64 = 16.0 / 9.0;

/// The camera of a step.
#[derive(Clone, Copy, Debug)]
pub struct Camera {
    /// Width over height of the picture.
    pub aspect: f64,
    /// Turn about the target from the exhibit's own view: to the right and up, rad.
    pub turn: [f64; 2],
    /// The view from there.
    pub view: View,
    /// The exhibit's own view at this aspect, kept because it depends on every vertex.
    own: View,
}

impl Camera {
    /// The exhibit's own view.
    pub fn new(exhibit: &Exhibit) -> Self {
        let own = exhibit.view(DEFAULT_ASPECT);
        Self { aspect: DEFAULT_ASPECT, turn: [0.0; 2], view: own, own }
    }

    /// Sets aspect and turn. An aspect that is not positive becomes 16:9; a turn that is not finite is ignored.
    pub fn update(&mut self, exhibit: &Exhibit, aspect: f64, turn: [f64; 2]) {
        let aspect = if aspect > 0.0 { aspect } else { DEFAULT_ASPECT };
        let turn = if turn.iter().all(|angle| angle.is_finite()) { turn } else { self.turn };
        if aspect != self.aspect {
            (self.aspect, self.own) = (aspect, exhibit.view(aspect));
        } else if turn == self.turn {
            return;
        }
        (self.turn, self.view) = (turn, self.own.orbited(turn));
    }
}

//! Which patches of a surface see where a wind comes from.
//!
//! A patch that faces away from the wind sees nothing of it. The others look along one line each, past every shelter; the
//! lines of one surface to one wind lie side by side and go together. What hid a patch from a wind is remembered.

use std::cell::Cell;

use super::feeler::Feeler;
use super::patches::{Face, Patch};
use super::weather::Upwind;
use soffio_geometry::rays::{Hint, Line, Occluders};
use soffio_math::DVec3;

/// Lines start this far off their own face, m.
const LINE_START: f64 = 1e-4;
/// What of its own body rises less before a patch is not in its way, m: it is passed by more than single precision rounds.
const PASSED: f64 = 0.5 * LINE_START;
/// What stands farther off than this shelters from no wind, m.
const FAR: f64 = 50.0;

/// Does a patch have nothing of its own body before its front, and before its back?
pub(crate) fn overlooks(occluders: &Occluders, body: usize, patch: &Patch) -> [bool; 2] {
    let height = patch.point.dot(patch.axis);
    let (low, high) = occluders.extent(body, patch.axis);
    [high - height, height - low].map(|rises| patch.face != Face::Wire && rises < PASSED)
}

/// A patch that faces where a wind comes from.
pub(crate) struct Facing {
    /// Where its line of sight starts, world, m.
    start: DVec3,
    from: Upwind,
    /// The patch's body, if nothing of it can be in the way.
    past: Option<usize>,
}

impl Feeler {
    /// A patch that stands like this (point and axis, world); `None` where it faces away.
    #[inline(always)]
    pub fn facing(&self, index: usize, (point, axis): (DVec3, DVec3), from: Upwind) -> Option<Facing> {
        let toward = match from {
            Upwind::Place(place) => place - point,
            Upwind::Afar(direction) => direction,
        };
        let facing = axis.dot(toward);
        let lift = match self.patches[index].face {
            Face::Side if facing <= 0.0 => return None,
            Face::Side | Face::Sheet => axis * (LINE_START * facing.signum()),
            Face::Wire => DVec3::ZERO,
        };
        // A line that does not sink passes over whatever is lower than its start.
        let over = facing.abs() >= LINE_START && self.overlooks[index][usize::from(facing < 0.0)];
        Some(Facing { start: point + lift, from, past: over.then_some(self.body) })
    }
}

impl Facing {
    /// Its line of sight.
    #[inline(always)]
    pub fn line(self) -> Line {
        let Self { start, from, past } = self;
        let (direction, far) = match from {
            Upwind::Place(place) => {
                let way = place - start;
                let far = way.length();
                // Where the wind comes from itself there is no way, and nothing on it.
                (if far > 0.0 { way / far } else { DVec3::ZERO }, far)
            }
            Upwind::Afar(direction) => (direction, FAR),
        };
        Line { origin: start, direction, far, past, hint: Hint::default() }
    }
}

/// Lines of sight of one surface's patches to where one wind comes from.
#[derive(Clone, Default)]
pub(crate) struct Sight {
    lines: Vec<Line>,
    /// Whose line each is.
    patches: Vec<usize>,
}

impl Sight {
    /// Room for as many patches.
    pub fn with_capacity(patches: usize) -> Self {
        Self { lines: Vec::with_capacity(patches), patches: Vec::with_capacity(patches) }
    }

    /// Takes the lines of patches, in place of all that were there.
    #[inline(always)]
    pub fn take(&mut self, lines: impl Iterator<Item = (usize, Line)>) {
        self.lines.clear();
        self.patches.clear();
        for (patch, line) in lines {
            self.lines.push(line);
            self.patches.push(patch);
        }
    }

    /// Says whose lines are open. `hints` knows what hid each patch of the surface the last time, and learns what does now.
    #[inline(always)]
    pub fn open(&mut self, occluders: &Occluders, hints: &[Cell<Hint>]) -> impl Iterator<Item = usize> {
        for (&patch, line) in self.patches.iter().zip(&mut self.lines) {
            line.hint = hints[patch].get();
        }
        occluders.look(&mut self.lines);
        self.patches.iter().zip(&self.lines).filter_map(|(&patch, line)| {
            hints[patch].set(line.hint);
            line.hint.is_open().then_some(patch)
        })
    }
}

//! When pictures are drawn, how finely, and how many there have been.

use std::time::Instant;

use crate::live::Frame;
use crate::step::stillness::PICTURE_S;
use crate::window::rest::{Rest, Signs};
use crate::window::screen::Drawn;
use crate::window::tiers::{Tier, Tiers};
use crate::window::timing::{Clock, FirstSight};
use soffio_simulation::Snapshot;

/// Refresh of a display that does not say it, s.
const COMMON_REFRESH: f64 = 1.0 / 60.0;

/// The rhythm of the pictures.
#[derive(Default)]
pub(crate) struct Pacing {
    pub clock: Clock,
    pub sight: FirstSight,
    pub tiers: Tiers,
    rest: Rest,
    /// Events of the window so far, but for its own pictures.
    inputs: u64,
    counts: Counts,
}

/// Pictures so far.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Counts {
    pub shown: u64,
    /// Those of them after which the next one waited because nothing moved.
    pub at_rest: u64,
    /// For which the display was off.
    pub dark: u64,
}

/// The picture that is begun.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Begun {
    /// When it was begun, and the one before it.
    pub now: Instant,
    pub last: Instant,
    /// Did it wait because nothing moved?
    pub rested: bool,
    /// Does the next one?
    pub rests: bool,
    /// The time that it shows.
    pub shown: Instant,
}

impl Pacing {
    /// Seconds since the kiosk began.
    pub fn time(&self) -> f64 {
        self.clock.seconds(Instant::now())
    }

    /// Something happened: the picture that waits because nothing moved is due at once.
    pub fn wake(&mut self) {
        if self.rest.rests() {
            self.clock.next = Instant::now();
        }
    }

    /// An event of the window.
    pub fn note_input(&mut self) {
        self.inputs += 1;
        self.wake();
    }

    /// Another tier, where the machine keeps up with it better; `least` is the shortest time between two pictures, s, and
    /// `refresh` that of the display. Nothing is learnt while the picture is black.
    pub fn keep_up(&mut self, now: Instant, open: bool, least: f64, refresh: Option<f64>) -> Option<Tier> {
        let asked = least.max(refresh.unwrap_or(COMMON_REFRESH));
        let passed = now.duration_since(self.clock.last).as_secs_f64();
        // The way to a picture that had time says nothing of the machine.
        let changed = open && !self.rest.rests() && self.tiers.note(passed, asked);
        changed.then(|| self.tiers.tier())
    }

    /// Begins a picture; the next one comes not before `least` seconds.
    pub fn begin(&mut self, now: Instant, still: bool, page_moves: bool, least: f64) -> Begun {
        let (last, rested) = (self.clock.last, self.rest.rests());
        let rests = self.rest.note(self.clock.seconds(now), Signs { still, page_moves, inputs: self.inputs });
        let shown = self.clock.tick(now, if rests { least.max(PICTURE_S) } else { least });
        Begun { now, last, rested, rests, shown }
    }

    /// Counts a picture of `moment`.
    pub fn note(&mut self, drawn: Drawn, picture: &Begun, frame: &Frame, moment: &Snapshot) {
        if drawn == Drawn::Shown {
            self.sight.note(frame, moment, picture.now);
            self.counts.shown += 1;
            self.counts.at_rest += u64::from(picture.rests);
        }
        self.counts.dark += u64::from(drawn == Drawn::Dark);
    }

    /// Pictures so far.
    pub fn counts(&self) -> Counts {
        self.counts
    }
}

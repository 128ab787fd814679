//! Whether anybody may use the kiosk now: the house's opening hours, and the time in which the glass is cleaned.
//!
//! While the house is closed the picture is black, nothing sounds and the microphone is closed; only the staff's chords
//! are heard. While the glass is cleaned nothing at all is heard, whoever presses.

use crate::visitor::input::{Keys, Phase, Request, Signal, Visitor};
use soffio_config::{Day, Opening, TimeOfDay};

/// What a panel above the work takes for itself.
#[derive(Clone, Copy, Debug, Default)]
pub struct Above {
    /// Keys, but for the staff's chords.
    pub keys: bool,
    /// Pointer and fingers.
    pub pointer: bool,
}

/// The house as it is now.
#[derive(Clone, Debug)]
pub struct House {
    /// By the hours.
    scheduled: bool,
    /// Staff opened it before its time.
    early: bool,
    /// Made black from afar, whatever the hours say.
    blank: bool,
    cleaned_until: f64,
}

impl Default for House {
    fn default() -> Self {
        Self { scheduled: true, early: false, blank: false, cleaned_until: f64::NEG_INFINITY }
    }
}

impl House {
    /// Looks at the hours. Whoever opened early has opened once: the hours close it again.
    pub fn look(&mut self, opening: &Opening, today: Day, yesterday: Day, time: TimeOfDay) {
        self.scheduled = opening.contains(today, yesterday, time);
        self.early &= !self.scheduled;
    }

    /// Staff open it before its time, or close it again; whatever was made black is seen again. While it is open by the
    /// hours this does nothing.
    pub fn open_early(&mut self) {
        self.early = !self.is_open() && !self.scheduled;
        self.blank = false;
    }

    /// Makes it black from afar, until it is woken.
    pub fn make_blank(&mut self, blank: bool) {
        self.blank = blank;
    }

    /// Was it made black from afar?
    pub fn is_blank(&self) -> bool {
        self.blank
    }

    /// Is it open?
    pub fn is_open(&self) -> bool {
        (self.scheduled || self.early) && !self.blank
    }

    /// Was it opened before its time?
    pub fn is_early(&self) -> bool {
        self.early
    }

    /// Cleaning begins, at `time`, and lasts for `seconds`, s.
    pub fn clean(&mut self, time: f64, seconds: f64) {
        self.cleaned_until = time + seconds;
    }

    /// What is left of it, s.
    pub fn cleans(&self, time: f64) -> Option<f64> {
        Some(self.cleaned_until - time).filter(|left| *left > 0.0)
    }

    /// Is anything but the staff's keys heard?
    pub fn hears(&self, time: f64) -> bool {
        self.is_open() && self.cleans(time).is_none()
    }

    /// What a signal asks for, where it is heard: by day all that nothing above the work takes, while the house is closed
    /// the staff's chords, while the glass is cleaned nothing.
    pub fn signal(
        &self,
        time: f64,
        visitor: &mut Visitor,
        signal: &Signal,
        (keys, above): (Keys, Above),
        windowed: bool,
    ) -> Option<Request> {
        if self.cleans(time).is_some() {
            return None;
        }
        let taken = match signal {
            Signal::Key(_) => above.keys,
            Signal::Pointer(_) | Signal::Button(true) | Signal::Touch { phase: Phase::Down | Phase::Move, .. } => {
                above.pointer
            }
            // What comes up is let go, whatever has opened above it.
            Signal::Button(false) | Signal::Touch { phase: Phase::Up, .. } | Signal::Deserted => {
                return visitor.signal(signal, keys, windowed);
            }
        };
        if self.is_open() && !taken {
            return visitor.signal(signal, keys, windowed);
        }
        visitor.note();
        match signal {
            Signal::Key(key) => keys.chord(key),
            _ => None,
        }
    }
}

//! State of the venue: whether visitors may use the kiosk now, by opening hours, staff, remote commands and cleaning.
//!
//! While the venue is closed the screen is black, nothing sounds and the microphone is off; only the staff's chords work.
//! While the screen is cleaned every input is ignored.

use crate::visitor::input::{Keys, Phase, Request, Signal, Visitor};
use soffio_config::{Day, Opening, TimeOfDay};

/// Inputs that a panel above the exhibit takes for itself.
#[derive(Clone, Copy, Debug, Default)]
pub struct OverlayCapture {
    /// Keys, except the staff's chords.
    pub keys: bool,
    /// Pointer and fingers.
    pub pointer: bool,
}

/// Where a signal goes besides the visitor.
#[derive(Clone, Copy, Debug)]
pub struct SignalContext<'a> {
    /// Keys of the site's configuration.
    pub keys: Keys<'a>,
    /// What an open panel takes.
    pub captured: OverlayCapture,
}

/// State of the venue.
#[derive(Clone, Debug)]
pub struct VenueState {
    /// Open by the hours?
    scheduled: bool,
    /// Opened by staff outside the hours?
    early: bool,
    /// Blanked by a remote command, whatever the hours say?
    blank: bool,
    cleaned_until: f64,
}

impl Default for VenueState {
    fn default() -> Self {
        Self { scheduled: true, early: false, blank: false, cleaned_until: f64::NEG_INFINITY }
    }
}

impl VenueState {
    /// Applies the opening hours. An early opening ends when the hours begin.
    pub fn update_schedule(&mut self, opening: &Opening, today: Day, yesterday: Day, time: TimeOfDay) {
        self.scheduled = opening.contains(today, yesterday, time);
        self.early &= !self.scheduled;
    }

    /// Staff open the kiosk outside the hours, or close it again. It also ends a remote blank; during opening hours it does
    /// nothing else.
    pub fn open_early(&mut self) {
        self.early = !self.is_open() && !self.scheduled;
        self.blank = false;
    }

    /// Blanks the kiosk by a remote command, or wakes it.
    pub fn set_blank(&mut self, blank: bool) {
        self.blank = blank;
    }

    /// Is it blanked by a remote command?
    pub fn is_blank(&self) -> bool {
        self.blank
    }

    /// Is it open?
    pub fn is_open(&self) -> bool {
        (self.scheduled || self.early) && !self.blank
    }

    /// Was it opened outside the hours?
    pub fn is_early(&self) -> bool {
        self.early
    }

    /// Starts a cleaning at `time` that lasts for `seconds`, s.
    pub fn start_cleaning(&mut self, time: f64, seconds: f64) {
        self.cleaned_until = time + seconds;
    }

    /// Time left of the cleaning, s; `None` where there is none.
    pub fn cleaning_left(&self, time: f64) -> Option<f64> {
        Some(self.cleaned_until - time).filter(|left| *left > 0.0)
    }

    /// Are inputs of visitors accepted?
    pub fn accepts_input(&self, time: f64) -> bool {
        self.is_open() && self.cleaning_left(time).is_none()
    }

    /// Request of a signal. While open: every signal that no panel captures. While closed: the staff's chords only. During
    /// a cleaning: none.
    pub fn signal(
        &self,
        time: f64,
        visitor: &mut Visitor,
        signal: &Signal,
        context: SignalContext,
        windowed: bool,
    ) -> Option<Request> {
        let SignalContext { keys, captured } = context;
        if self.cleaning_left(time).is_some() {
            return None;
        }
        let taken = match signal {
            Signal::Key(_) => captured.keys,
            Signal::Pointer(_) | Signal::Button(true) | Signal::Touch { phase: Phase::Down | Phase::Move, .. } => {
                captured.pointer
            }
            // A release always counts, even where a panel has opened meanwhile.
            Signal::Button(false) | Signal::Touch { phase: Phase::Up, .. } | Signal::FocusLost => {
                return visitor.signal(signal, keys, windowed);
            }
        };
        if self.is_open() && !taken {
            return visitor.signal(signal, keys, windowed);
        }
        visitor.count_input();
        match signal {
            Signal::Key(key) => keys.chord(key),
            _ => None,
        }
    }
}

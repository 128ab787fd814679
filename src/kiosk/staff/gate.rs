//! PIN gate of the staff panel. The PIN is checked on a thread of its own, so that no frame waits for its hash.
//!
//! After the n-th wrong PIN in a row no other is accepted for 2ⁿ s, at most [`LONGEST_S`]: trying all PINs of six digits takes
//! thirty years. The count is kept while the panel is closed and when the configuration is reloaded; a right PIN resets it.

use std::sync::mpsc::{Receiver, TryRecvError, channel};

use crate::visitor::input::Request;
use soffio_config::{DIGITS, Pin, Staff};

/// Longest pause after a wrong PIN, s.
pub const LONGEST_S: f64 = 1024.0;

/// State of the gate.
#[derive(Debug, Default)]
pub struct Gate {
    pin: Pin,
    entered: String,
    wrong: i32,
    /// No PIN is accepted before this time, s.
    shut_until: f64,
    /// Pending result of a check.
    answer: Option<Receiver<bool>>,
    open: bool,
}

impl Gate {
    /// Sets the PIN; a changed one shuts the gate.
    pub fn set(&mut self, pin: &Pin) {
        if *pin != self.pin {
            self.pin = pin.clone();
            self.shut();
        }
    }

    /// Is a PIN set?
    pub fn has_pin(&self) -> bool {
        self.pin.is_set()
    }

    /// Was the right PIN entered since the gate was shut?
    pub fn is_open(&self) -> bool {
        self.open
    }

    /// Does a request of a key or button pass? With a PIN set, the staff's chords pass only while the gate is open, except the
    /// panel's own, and mute where the site frees it.
    pub fn admits(&self, request: Request, staff: &Staff) -> bool {
        match request {
            Request::Mute if staff.mute_without_pin => true,
            Request::Mute | Request::Night | Request::Open => !self.has_pin() || self.is_open(),
            _ => true,
        }
    }

    /// Shuts the gate: the PIN is needed again.
    pub fn shut(&mut self) {
        self.open = false;
        self.entered.clear();
        self.answer = None;
    }

    /// Digits entered so far.
    pub fn entered(&self) -> usize {
        self.entered.len()
    }

    /// Is a PIN being checked?
    pub fn checks(&self) -> bool {
        self.answer.is_some()
    }

    /// Wrong PINs in a row.
    pub fn wrong(&self) -> i32 {
        self.wrong
    }

    /// Restores the count of wrong PINs after a restart; their last pause begins again at `time`, s.
    pub fn remember(&mut self, wrong: i32, time: f64) {
        if wrong > 0 {
            self.wrong = wrong;
            self.shut_until = time + pause(wrong);
        }
    }

    /// Time left of the pause at `time`, s; `None` where a PIN is accepted.
    pub fn pause(&self, time: f64) -> Option<f64> {
        Some(self.shut_until - time).filter(|left| *left > 0.0)
    }

    /// Enters a digit; other characters are ignored.
    pub fn digit(&mut self, digit: char) {
        if digit.is_ascii_digit() && self.entered.len() < *DIGITS.end() {
            self.entered.push(digit);
        }
    }

    /// Deletes the last digit.
    pub fn back(&mut self) {
        self.entered.pop();
    }

    /// Checks the entered PIN at `time`, s. Nothing happens during a pause or another check.
    pub fn enter(&mut self, time: f64) {
        if self.pause(time).is_some() || self.checks() || self.entered.is_empty() || !self.has_pin() {
            return;
        }
        let (sender, answer) = channel();
        let (pin, entered) = (self.pin.clone(), std::mem::take(&mut self.entered));
        let check = move || {
            // If the gate was shut meanwhile, the result is not needed.
            let _ = sender.send(pin.matches(&entered));
        };
        match std::thread::Builder::new().name("soffio-pin".into()).spawn(check) {
            Ok(_) => self.answer = Some(answer),
            Err(error) => tracing::error!("the PIN cannot be checked: {error}"),
        }
    }

    /// Takes the result of a finished check.
    pub fn poll(&mut self, time: f64) {
        let Some(answer) = &self.answer else { return };
        let right = match answer.try_recv() {
            Ok(right) => right,
            Err(TryRecvError::Empty) => return,
            // A crashed thread counts as a wrong PIN.
            Err(TryRecvError::Disconnected) => false,
        };
        self.answer = None;
        self.record_answer(right, time);
    }

    /// Applies the result of a check at `time`, s.
    fn record_answer(&mut self, right: bool, time: f64) {
        self.open = right;
        self.wrong = if right { 0 } else { self.wrong.saturating_add(1) };
        if !right {
            let pause = pause(self.wrong);
            self.shut_until = time + pause;
            tracing::warn!("a wrong PIN, {} in a row; the next is accepted in {pause} s", self.wrong);
        }
    }
}

/// Pause after so many wrong PINs in a row, s.
fn pause(wrong: i32) -> f64 {
    f64::from(1 << wrong.clamp(0, 20)).min(LONGEST_S)
}

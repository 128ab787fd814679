//! The way into what changes things: a PIN, tried on a thread of its own so that no picture waits for its hash.
//!
//! After the n-th wrong PIN in a row no other is taken for 2ⁿ s, at most [`LONGEST_S`]: ten thousand PINs of four digits
//! take four months. The count is kept while the panel is closed and while the configuration is read anew; a right PIN
//! ends it.

use std::sync::mpsc::{Receiver, TryRecvError, channel};

use soffio_config::{DIGITS, Pin};

/// Longest pause after a wrong PIN, s.
pub const LONGEST_S: f64 = 1024.0;

/// A PIN's hash and how often others were tried.
#[derive(Debug, Default)]
pub struct Gate {
    pin: Pin,
    entered: String,
    wrong: i32,
    /// No PIN is taken before this time, s.
    shut_until: f64,
    /// The answer that is being worked out.
    answer: Option<Receiver<bool>>,
    open: bool,
}

impl Gate {
    /// With this PIN; another one than before shuts it.
    pub fn set(&mut self, pin: &Pin) {
        if *pin != self.pin {
            self.pin = pin.clone();
            self.shut();
        }
    }

    /// Is there a PIN to ask for?
    pub fn has_pin(&self) -> bool {
        self.pin.is_set()
    }

    /// Was the right one given since it was shut?
    pub fn is_open(&self) -> bool {
        self.open
    }

    /// Asks for the PIN again, the next time.
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

    /// Wrong PINs from before a restart are not forgotten: their last pause begins again, whole, at `time`, s.
    pub fn remember(&mut self, wrong: i32, time: f64) {
        if wrong > 0 {
            self.wrong = wrong;
            self.shut_until = time + pause(wrong);
        }
    }

    /// What is left of the pause at `time`, s; `None` where a PIN is taken.
    pub fn pause(&self, time: f64) -> Option<f64> {
        Some(self.shut_until - time).filter(|left| *left > 0.0)
    }

    /// One more digit; other characters are none.
    pub fn digit(&mut self, digit: char) {
        if digit.is_ascii_digit() && self.entered.len() < *DIGITS.end() {
            self.entered.push(digit);
        }
    }

    /// Takes the last digit back.
    pub fn back(&mut self) {
        self.entered.pop();
    }

    /// Tries what was entered, at `time`, s. Nothing is tried during a pause or while another one is checked.
    pub fn enter(&mut self, time: f64) {
        if self.pause(time).is_some() || self.checks() || self.entered.is_empty() || !self.has_pin() {
            return;
        }
        let (tell, answer) = channel();
        let (pin, entered) = (self.pin.clone(), std::mem::take(&mut self.entered));
        let check = move || {
            // Whoever shut the gate meanwhile does not wait for the answer.
            let _ = tell.send(pin.matches(&entered));
        };
        match std::thread::Builder::new().name("soffio-pin".into()).spawn(check) {
            Ok(_) => self.answer = Some(answer),
            Err(error) => tracing::error!("the PIN cannot be checked: {error}"),
        }
    }

    /// Takes in the answer when it has come.
    pub fn tend(&mut self, time: f64) {
        let Some(answer) = &self.answer else { return };
        let right = match answer.try_recv() {
            Ok(right) => right,
            Err(TryRecvError::Empty) => return,
            // The thread died: nobody gets in by that.
            Err(TryRecvError::Disconnected) => false,
        };
        self.answer = None;
        self.judge(right, time);
    }

    /// What an answer means, at `time`, s.
    fn judge(&mut self, right: bool, time: f64) {
        self.open = right;
        self.wrong = if right { 0 } else { self.wrong.saturating_add(1) };
        if !right {
            let pause = pause(self.wrong);
            self.shut_until = time + pause;
            tracing::warn!("a wrong PIN, {} in a row; the next is taken in {pause} s", self.wrong);
        }
    }
}

/// Pause after so many wrong PINs in a row, s.
fn pause(wrong: i32) -> f64 {
    f64::from(1 << wrong.clamp(0, 20)).min(LONGEST_S)
}

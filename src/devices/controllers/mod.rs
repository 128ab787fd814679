//! Controllers beside microphone and touchscreen: gamepads, MIDI breath controllers, OSC, a serial line.
//!
//! ```text
//! one thread a driver:  open → listen → (lost) → wait 1, 2, 4, 8, 10, 10, … s → open …
//!                               └→ its slot ─┐
//! kiosk thread                  Controllers::reading() joins all slots: the strongest breath, every stick, any button
//! ```
//!
//! Invariant: the slot of a lost driver is emptied before it is opened again. A missing device is not an error: it may be
//! plugged in later.

mod driver;
mod gamepad;
mod midi;
mod osc;
mod serial;

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::Duration;

pub use driver::Reading;
use driver::{Driver, Slot};
pub use osc::enter_packet;
pub use serial::Lines;
pub use soffio_config::{ControllerKind, ControllerSettings};

/// The first pause before a driver is opened again, and the longest, s.
const BACK_OFF: (Duration, Duration) = (Duration::from_secs(1), Duration::from_secs(10));
/// Longest wait of a driver for messages before it checks whether the kiosk ends.
const LOOK: Duration = Duration::from_millis(100);

/// All controllers of a kiosk.
pub struct Controllers {
    slots: Vec<Slot>,
    states: Vec<(ControllerKind, Arc<Mutex<State>>)>,
    stop: Arc<AtomicBool>,
    threads: Vec<JoinHandle<()>>,
}

/// State of one driver.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum State {
    /// Listens to this device.
    Listening(String),
    /// There is no device for this reason; opening is retried.
    Waiting(String),
}

impl Controllers {
    /// Starts the drivers of all configured controllers and returns at once.
    pub fn start(settings: &ControllerSettings) -> Self {
        let stop = Arc::new(AtomicBool::new(false));
        let (mut slots, mut states, mut threads) = (Vec::new(), Vec::new(), Vec::new());
        for &kind in &settings.listen {
            let (slot, state) = (Slot::default(), Arc::new(Mutex::new(State::Waiting("starting".into()))));
            let theirs = (settings.clone(), slot.clone(), state.clone(), stop.clone());
            let thread = std::thread::Builder::new().name(format!("soffio-{}", kind.name())).spawn(move || {
                let (settings, slot, state, stop) = theirs;
                run_driver(kind, driver(kind, &settings).as_mut(), &slot, &state, &stop);
            });
            match thread {
                Ok(thread) => threads.push(thread),
                Err(error) => tracing::error!("{}: no thread for it: {error}", kind.name()),
            }
            slots.push(slot);
            states.push((kind, state));
        }
        Self { slots, states, stop, threads }
    }

    /// Present reading of all controllers together, as if they were one.
    pub fn reading(&self) -> Reading {
        self.slots.iter().map(Slot::read).fold(Reading::default(), Reading::join)
    }

    /// State of each driver.
    pub fn states(&self) -> impl Iterator<Item = (ControllerKind, State)> {
        self.states.iter().map(|(kind, state)| (*kind, state.lock().unwrap_or_else(PoisonError::into_inner).clone()))
    }
}

impl Drop for Controllers {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
        for thread in self.threads.drain(..) {
            // It has nothing to say; a panic of it was printed when it happened.
            let _ = thread.join();
        }
    }
}

fn driver(kind: ControllerKind, settings: &ControllerSettings) -> Box<dyn Driver> {
    match kind {
        ControllerKind::Gamepad => Box::new(gamepad::Gamepads::default()),
        ControllerKind::Midi => Box::new(midi::Midi::new(&settings.midi, settings.midi_controller)),
        ControllerKind::Osc => Box::new(osc::Osc::new(&settings.osc)),
        ControllerKind::Serial => Box::new(serial::Serial::new(&settings.serial, settings.serial_baud)),
    }
}

/// Runs a driver: opens it, listens, and opens it again after a loss.
fn run_driver(kind: ControllerKind, driver: &mut dyn Driver, slot: &Slot, state: &Mutex<State>, stop: &AtomicBool) {
    let report = |new: State| {
        let mut state = state.lock().unwrap_or_else(PoisonError::into_inner);
        if *state != new {
            match &new {
                State::Listening(to) => tracing::info!("{}: listens to {to}", kind.name()),
                State::Waiting(reason) => tracing::info!("{}: {reason}", kind.name()),
            }
            *state = new;
        }
    };
    let mut pause = BACK_OFF.0;
    while !stop.load(Ordering::Relaxed) {
        match driver.open(slot) {
            Ok(name) => {
                report(State::Listening(name));
                pause = BACK_OFF.0;
                let lost = loop {
                    if stop.load(Ordering::Relaxed) {
                        return;
                    }
                    if let Err(reason) = driver.listen(slot, LOOK) {
                        break reason;
                    }
                };
                slot.update(Reading::let_go);
                report(State::Waiting(lost));
            }
            Err(reason) => report(State::Waiting(reason)),
        }
        let mut waited = Duration::ZERO;
        while waited < pause && !stop.load(Ordering::Relaxed) {
            std::thread::sleep(LOOK);
            waited += LOOK;
        }
        pause = (pause * 2).min(BACK_OFF.1);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_devices_are_one_visitor() {
        let (mut pad, mut pipe) = (Reading::default(), Reading::default());
        pad.tilt(0, 0.8);
        pad.press(true);
        pipe.blow(0.4);
        pipe.point([0.2, 3.0]);
        let both = pad.join(pipe);
        let expected =
            Reading { strength: 0.4, hold: true, stick: [0.8, 0.0], aim: Some(([0.2, 1.0], 1)), activity: 4 };
        assert_eq!(both, expected);
        pad.let_go();
        assert_eq!((pad.hold, pad.stick, pad.activity), (false, [0.0; 2], 2), "a lost pad holds nothing");
        pipe.blow(f64::NAN);
        pipe.point([f64::NAN, 0.0]);
        assert_eq!((pipe.strength, pipe.aim), (0.0, Some(([0.2, 1.0], 1))));
    }
}

//! Interface of a driver, and the slot of its readings.

use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// Least strength of a breath.
const FAINTEST: f64 = 0.02;
/// Present reading of one or all controllers.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Reading {
    /// Breath strength, 0 … 1.
    pub strength: f64,
    /// Whether a blow button is held.
    pub hold: bool,
    /// Deflection of a stick to the right and down, −1 … 1 each; it moves the aim.
    pub stick: [f64; 2],
    /// Last absolute aim, picture coordinates, and the number of them so far.
    pub aim: Option<([f64; 2], u64)>,
    /// Number of inputs so far; it grows while somebody uses the controller.
    pub activity: u64,
}

impl Reading {
    /// Sets the strength, if it is finite. A change counts as input, except the noise of a sensor at rest.
    pub(super) fn blow(&mut self, strength: f64) {
        let strength = if strength >= FAINTEST { strength.min(1.0) } else { 0.0 };
        self.activity += u64::from(strength != self.strength);
        self.strength = strength;
    }

    /// Sets the blow button.
    pub(super) fn press(&mut self, down: bool) {
        self.activity += u64::from(down != self.hold);
        self.hold = down;
    }

    /// Sets one axis of the stick (0 right, 1 down).
    pub(super) fn tilt(&mut self, axis: usize, value: f64) {
        let value = if value.is_finite() { value.clamp(-1.0, 1.0) } else { 0.0 };
        self.activity += u64::from(value != self.stick[axis]);
        self.stick[axis] = value;
    }

    /// Sets an absolute aim, picture coordinates.
    pub(super) fn point(&mut self, at: [f64; 2]) {
        if at.iter().all(|x| x.is_finite()) {
            let count = self.aim.map_or(0, |(_, count)| count) + 1;
            self.aim = Some((at.map(|x| x.clamp(0.0, 1.0)), count));
            self.activity += 1;
        }
    }

    /// Releases everything after the loss of a device.
    pub(super) fn let_go(&mut self) {
        *self = Self { activity: self.activity, aim: self.aim, ..Self::default() };
    }

    /// Joins two readings.
    pub(super) fn join(self, other: Self) -> Self {
        let count = |reading: &Self| reading.aim.map_or(0, |(_, count)| count);
        Self {
            strength: self.strength.max(other.strength),
            hold: self.hold || other.hold,
            stick: std::array::from_fn(|i| (self.stick[i] + other.stick[i]).clamp(-1.0, 1.0)),
            aim: if count(&other) > count(&self) { other.aim } else { self.aim },
            activity: self.activity + other.activity,
        }
    }
}

/// Shared reading of a driver.
#[derive(Clone, Default)]
pub(super) struct Slot(Arc<Mutex<Reading>>);

impl Slot {
    pub(super) fn update(&self, change: impl FnOnce(&mut Reading)) {
        change(&mut self.0.lock().unwrap_or_else(PoisonError::into_inner));
    }

    pub(super) fn read(&self) -> Reading {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Driver of one kind of controller, on its own thread.
pub(super) trait Driver {
    /// Opens the device. Returns its name, or the reason why there is none.
    fn open(&mut self, slot: &Slot) -> Result<String, String>;

    /// Waits up to `wait` for messages and enters them. Returns an error with the reason if the device is lost.
    fn listen(&mut self, slot: &Slot, wait: Duration) -> Result<(), String>;
}

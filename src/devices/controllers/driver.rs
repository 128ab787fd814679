//! What a driver is asked, and where it leaves its readings.

use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// Weaker than this a controller is at rest.
const FAINTEST: f64 = 0.02;
/// What the controllers say now.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Reading {
    /// How hard is blown, 0 … 1.
    pub strength: f64,
    /// Is a button held that blows?
    pub hold: bool,
    /// Where a stick points, right and down, −1 … 1 each: the aim moves that way.
    pub stick: [f64; 2],
    /// A place that was named, picture coordinates, and how many were named so far.
    pub aim: Option<([f64; 2], u64)>,
    /// Inputs so far: whoever sees it grow knows that somebody is there.
    pub activity: u64,
}

impl Reading {
    /// A strength, if it is a number; its change is an input. A sensor at rest trembles: that is nobody.
    pub(super) fn blow(&mut self, strength: f64) {
        let strength = if strength >= FAINTEST { strength.min(1.0) } else { 0.0 };
        self.activity += u64::from(strength != self.strength);
        self.strength = strength;
    }

    /// A button that blows.
    pub(super) fn press(&mut self, down: bool) {
        self.activity += u64::from(down != self.hold);
        self.hold = down;
    }

    /// One axis of a stick (0 right, 1 down).
    pub(super) fn tilt(&mut self, axis: usize, value: f64) {
        let value = if value.is_finite() { value.clamp(-1.0, 1.0) } else { 0.0 };
        self.activity += u64::from(value != self.stick[axis]);
        self.stick[axis] = value;
    }

    /// A place on the picture.
    pub(super) fn point(&mut self, at: [f64; 2]) {
        if at.iter().all(|x| x.is_finite()) {
            let count = self.aim.map_or(0, |(_, count)| count) + 1;
            self.aim = Some((at.map(|x| x.clamp(0.0, 1.0)), count));
            self.activity += 1;
        }
    }

    /// The device is gone: what it held is let go of.
    pub(super) fn let_go(&mut self) {
        *self = Self { activity: self.activity, aim: self.aim, ..Self::default() };
    }

    /// Two devices as one.
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

/// A driver's place among the readings.
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

/// One kind of controller, on a thread of its own.
pub(super) trait Driver {
    /// Opens what there is; what it listens to, or why it does not.
    fn open(&mut self, slot: &Slot) -> Result<String, String>;

    /// Waits up to `wait` for news and enters them. An error: it is lost, and this is why.
    fn listen(&mut self, slot: &Slot, wait: Duration) -> Result<(), String>;
}

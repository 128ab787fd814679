//! Real-time parameters and meters shared with the output's callback; they outlive an output device.
//!
//! Each is one atomic number, so the callback never waits.

use std::sync::atomic::{AtomicBool, AtomicU32, AtomicU64, Ordering};

/// Volume and night mode to the callback, A-weighted energy of the output from it.
#[derive(Debug)]
pub struct Knobs {
    /// Linear, bits of an f32.
    volume: AtomicU32,
    night: AtomicBool,
    /// Sum of power times time, bits of an f64; written by the one loudspeaker that plays.
    energy: AtomicU64,
    /// Time of it, s, bits of an f64.
    seconds: AtomicU64,
}

/// Sound energy that an output has played, and for how long.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PlayedEnergy {
    /// A-weighted power ([`soffio_sound::AWeighting::power`], ½ for a full-scale sine of 1 kHz) times time, s.
    pub energy: f64,
    /// Time, s.
    pub seconds: f64,
}

impl Knobs {
    /// At this volume, linear, by day.
    pub fn new(volume: f32) -> Self {
        let knobs = Self {
            volume: AtomicU32::new(0),
            night: AtomicBool::new(false),
            energy: AtomicU64::new(0f64.to_bits()),
            seconds: AtomicU64::new(0f64.to_bits()),
        };
        knobs.set_volume(volume);
        knobs
    }

    /// Linear, 0 to 1; the output fades to it.
    pub fn set_volume(&self, volume: f32) {
        self.volume.store(volume.clamp(0.0, 1.0).to_bits(), Ordering::Relaxed);
    }

    /// Turns night mode on or off.
    pub fn set_night(&self, night: bool) {
        self.night.store(night, Ordering::Relaxed);
    }

    /// All that was played since the output began to count.
    pub fn played(&self) -> PlayedEnergy {
        // Read apart they may differ by one block, which no mean over a second shows.
        let read = |number: &AtomicU64| f64::from_bits(number.load(Ordering::Relaxed));
        PlayedEnergy { energy: read(&self.energy), seconds: read(&self.seconds) }
    }

    pub(super) fn volume(&self) -> f32 {
        f32::from_bits(self.volume.load(Ordering::Relaxed))
    }

    pub(super) fn night(&self) -> bool {
        self.night.load(Ordering::Relaxed)
    }

    /// A block was played.
    pub(super) fn note(&self, energy: f64, seconds: f64) {
        for (number, more) in [(&self.energy, energy), (&self.seconds, seconds)] {
            let sum = f64::from_bits(number.load(Ordering::Relaxed)) + more;
            number.store(sum.to_bits(), Ordering::Relaxed);
        }
    }
}

//! Night mode: a downward compressor and a treble shelf for nights and quiet galleries.
//!
//! ```text
//! L = mean square, 5 ms up and 150 ms down        G = LEVEL − (1 − 1/RATIO) max(0, L − THRESHOLD)   dB
//! y = 10^(G/20) · shelf(x)                         shelf: first order, SHELF_DB above SHELF_CORNER
//! ```
//!
//! Sudden and high sounds draw attention in a quiet building, so the dynamic range and the treble are reduced. By day the
//! signal passes unchanged, to the bit. The transition takes [`GLIDE`].
//!
//! Gains are computed once in [`STRIDE`] frames of the signal and interpolated linearly, so that blocks do not matter.

use soffio_math::{PI, amplitude_to_db, db_to_amplitude, exp, sincos};

/// Gain of soft sounds, dB. Chosen by ear: about half as loud.
pub const LEVEL: f64 = -8.0;
/// Threshold of the compressor, dB of full scale (root mean square). Chosen by ear: below a light hit.
pub const THRESHOLD: f64 = -36.0;
/// Compression ratio above the threshold: 3 dB more in, 1 dB more out. Chosen by ear.
pub const RATIO: f64 = 3.0;
/// Corner of the shelf, Hz, above which the level changes by [`SHELF_DB`]: high sounds draw attention in a quiet
/// building.
pub const SHELF_CORNER: f64 = 2500.0;
/// Gain of the shelf, dB. Chosen by ear: bells stay bells.
pub const SHELF_DB: f64 = -9.0;
/// Duration of a transition, s: slow enough not to be noticed.
pub const GLIDE: f64 = 2.0;
/// Attack and release time constants of the level, s: an onset is caught within 5 ms, and a decay is not pumped up.
const ATTACK_RELEASE: (f64, f64) = (0.005, 0.15);
/// Frames from one computed gain to the next: 0.7 ms at 48 kHz, far below the attack.
const STRIDE: u32 = 32;

/// How night mode is turned on or off.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Transition {
    /// Over [`GLIDE`].
    Fade,
    /// At once: nothing has been played yet.
    Immediate,
}

pub(super) struct NightMode {
    enabled: bool,
    /// 0 day … 1 night.
    amount: f64,
    /// Of the amount, once a stride.
    glide: f64,
    /// First-order shelf b0, b1, a1, and its state on either side.
    shelf: [f64; 3],
    states: [f64; 2],
    attack_release: (f64, f64),
    square: f64,
    gain: f64,
    step: f64,
    frame: u32,
}

impl NightMode {
    /// Night mode that is off, for this sample rate, Hz.
    pub fn new(sample_rate: f64) -> Self {
        let rise = db_to_amplitude(SHELF_DB);
        let (s, c) = sincos(PI * SHELF_CORNER / sample_rate);
        // As in `reverb/absorption.rs`, of first order: (h s + √h w)/(s + √h w).
        let w = s / c * rise.sqrt();
        let norm = 1.0 / (1.0 + w);
        let share = |time: f64| 1.0 - exp(-1.0 / (time * sample_rate));
        Self {
            enabled: false,
            amount: 0.0,
            glide: f64::from(STRIDE) / (GLIDE * sample_rate),
            shelf: [(rise + w) * norm, (w - rise) * norm, (w - 1.0) * norm],
            states: [0.0; 2],
            attack_release: (share(ATTACK_RELEASE.0), share(ATTACK_RELEASE.1)),
            square: 0.0,
            gain: 1.0,
            step: 0.0,
            frame: 0,
        }
    }

    /// Turns night mode on or off.
    pub fn set(&mut self, night: bool, transition: Transition) {
        self.enabled = night;
        if transition == Transition::Immediate {
            self.amount = f64::from(u8::from(night));
            self.gain = db_to_amplitude(self.amount * LEVEL);
        }
    }

    /// In their place.
    pub fn process(&mut self, frames: &mut [[f32; 2]]) {
        for frame in frames {
            // By day for as long as nobody asks: all frames are what they are.
            if self.amount == 0.0 && !self.enabled {
                return;
            }
            *frame = self.process_one(*frame);
        }
    }

    fn process_one(&mut self, frame: [f32; 2]) -> [f32; 2] {
        let [l, r] = frame.map(f64::from);
        let square = 0.5 * (l * l + r * r);
        let (up, down) = self.attack_release;
        self.square += (square - self.square) * if square > self.square { up } else { down };
        if self.frame == 0 {
            let step = if self.enabled { self.glide } else { -self.glide };
            self.amount = (self.amount + step).clamp(0.0, 1.0);
            let above = (0.5 * amplitude_to_db(self.square.max(1e-20)) - THRESHOLD).max(0.0);
            let target = db_to_amplitude(self.amount * (LEVEL - (1.0 - 1.0 / RATIO) * above));
            self.step = (target - self.gain) / f64::from(STRIDE);
        }
        self.frame = (self.frame + 1) % STRIDE;
        self.gain += self.step;
        let [b0, b1, a1] = self.shelf;
        let mut out = [l, r];
        for (x, state) in out.iter_mut().zip(&mut self.states) {
            let y = b0 * *x + *state;
            *state = b1 * *x - a1 * y;
            // Far inaudible: denormal numbers make processors slow.
            if state.abs() < 1e-20 {
                *state = 0.0;
            }
            *x = (*x + self.amount * (y - *x)) * self.gain;
        }
        if self.amount == 0.0 {
            (self.states, self.square, self.gain, self.frame) = ([0.0; 2], 0.0, 1.0, 0);
        }
        out.map(|y| y as f32)
    }
}

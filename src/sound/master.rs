//! Master bus: reverb, night mode and limiter between the sum of all sounds and the output.
//!
//! ```text
//! mix ─┬────────────→ (+) ─→ night mode ─→ limiter ─→ out
//!      └─→ reverb ────┘
//! ```
//!
//! The volume follows in the callback, so the output stays below the limiter's ceiling at any volume up to 0 dB.

use super::limiter::Limiter;
use super::night_mode::{NightMode, Transition};
use super::reverb::{Reverb, ReverbSpec};

/// Frames of reverb computed at once: buffers of 2 KiB on the stack.
const CHUNK: usize = 256;

/// The master bus of a synth.
pub(super) struct Master {
    sample_rate: f64,
    reverb: Option<Box<Reverb>>,
    night_mode: NightMode,
    limiter: Limiter,
    started: bool,
}

impl Master {
    /// A master bus at rest for this sample rate, Hz, without reverb and night mode.
    pub fn new(sample_rate: f64) -> Self {
        Self {
            sample_rate,
            reverb: None,
            night_mode: NightMode::new(sample_rate),
            limiter: Limiter::new(sample_rate),
            started: false,
        }
    }

    /// Latency from input to output, frames.
    pub fn latency(&self) -> usize {
        self.limiter.latency()
    }

    /// Sets the reverb; `None` and invalid specifications turn it off.
    pub fn set_reverb(&mut self, spec: Option<&ReverbSpec>) {
        self.reverb = spec.and_then(|spec| Reverb::new(spec, self.sample_rate)).map(Box::new);
    }

    /// Turns night mode on or off: with a fade once frames were processed, at once before. Real-time.
    pub fn set_night(&mut self, night_mode: bool) {
        let transition = if self.started { Transition::Fade } else { Transition::Immediate };
        self.night_mode.set(night_mode, transition);
    }

    /// Processes frames in place, with [`Self::latency`]; how they are cut into calls does not matter. Real-time.
    pub fn process(&mut self, frames: &mut [[f32; 2]]) {
        self.started = true;
        if let Some(reverb) = &mut self.reverb {
            for frames in frames.chunks_mut(CHUNK) {
                let mut wet = [[0.0; 2]; CHUNK];
                let wet = &mut wet[..frames.len()];
                wet.copy_from_slice(frames);
                reverb.process(wet);
                frames.as_flattened_mut().iter_mut().zip(wet.as_flattened()).for_each(|(x, y)| *x += y);
            }
        }
        self.night_mode.process(frames);
        self.limiter.process(frames);
    }
}

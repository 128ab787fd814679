//! Continuous inputs of a step: the newest value counts.

use crate::visitor::gesture::Press;
use soffio_simulation::{InspectionScope, MotionMode};

/// Continuous inputs of visitor and window: each value holds until a newer one overwrites it. Events are
/// [`KioskCommand`](super::command::KioskCommand)s.
#[derive(Clone, Debug, Default)]
pub struct Controls {
    /// Aim of the breath, picture coordinates; `None` is the centre.
    pub aim: Option<[f64; 2]>,
    /// The last aim set by a controller (OSC), and how many were set so far.
    pub named: Option<([f64; 2], u64)>,
    /// Deflection of stick or arrow keys, right and down, −1 … 1 each, times their speed, picture heights/s.
    pub stick: [f64; 2],
    /// Is a blow held by a key, a switch or a controller?
    pub hold: bool,
    /// The pointer's button and the fingers that are down: each of them blows or grabs the sculpture.
    pub presses: Vec<Press>,
    /// Number of presses of the key that blows.
    pub keyed: u64,
    /// Does a press begin the breath and the next one end it?
    pub press_once: bool,
    /// Does the visitor look around the exhibit? Then presses beside it, sticks and arrow keys turn the camera.
    pub look_around: bool,
    /// Reduced motion: no assembly animation, gentler attract mode.
    pub reduced_motion: bool,
    /// Strength of a breath controller, 0 … 1.
    pub strength: f64,
    /// Has the visitor switched the microphone off?
    pub ignore_microphone: bool,
    /// Width over height of the picture.
    pub aspect: f64,
    /// Inputs so far.
    pub activity: u64,
    /// Solver of the exhibit's motion; `None` is its own choice.
    pub mode: Option<MotionMode>,
    /// All input is ignored: the venue is closed, or the screen is cleaned.
    pub inert: bool,
    /// The venue is closed: no sound, and no microphone.
    pub closed: bool,
    /// Inspection that staff look at.
    pub look: InspectionScope,
}

impl Controls {
    /// The same without any input of a visitor.
    pub fn without_visitor(&self) -> Self {
        let Self { aspect, activity, mode, inert, reduced_motion, keyed, .. } = *self;
        Self { aspect, activity, mode, inert, reduced_motion, keyed, ..Self::default() }
    }
}

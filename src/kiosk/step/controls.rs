//! What a step is told as levels: the newest value counts.

use crate::visitor::gesture::Press;
use soffio_simulation::{InspectionScope, MotionMode};

/// What the visitor does and how the window stands, as levels: each value holds until a newer one overwrites it, and reading
/// it twice means nothing more than reading it once. What happens once is a [`KioskCommand`](super::command::KioskCommand).
#[derive(Clone, Debug, Default)]
pub struct Controls {
    /// Where the breath is aimed, picture coordinates; `None` is the centre.
    pub aim: Option<[f64; 2]>,
    /// The last place that was named instead of pointed at, and how many were named so far.
    pub named: Option<([f64; 2], u64)>,
    /// Where a stick or the arrow keys point, right and down, −1 … 1 each, times their speed, picture heights/s.
    pub stick: [f64; 2],
    /// Is a blow held by a key, a switch or a controller?
    pub hold: bool,
    /// The pointer's button and the fingers that are down: each of them blows, or takes the sculpture by the hand.
    pub presses: Vec<Press>,
    /// Times that the key that blows went down.
    pub keyed: u64,
    /// Does a press begin the breath and the next one end it?
    pub press_once: bool,
    /// Does the visitor look round the work? Then presses beside it, sticks and arrow keys turn the camera.
    pub round: bool,
    /// Less motion: no change of scene in which parts fly together, gentler attract mode.
    pub calm: bool,
    /// How hard a breath controller is blown, 0 … 1.
    pub strength: f64,
    /// Has the visitor switched the microphone off?
    pub deaf: bool,
    /// Width over height of the picture.
    pub aspect: f64,
    /// Inputs so far.
    pub activity: u64,
    /// What moves the exhibit; `None` is its own choice.
    pub mode: Option<MotionMode>,
    /// Nobody is heard, whatever they do: the house is closed, or the glass is cleaned.
    pub inert: bool,
    /// The house is closed: no sound, and no microphone.
    pub closed: bool,
    /// What staff look at.
    pub look: InspectionScope,
}

impl Controls {
    /// The same with nobody there.
    pub fn without_visitor(&self) -> Self {
        let Self { aspect, activity, mode, inert, calm, keyed, .. } = *self;
        Self { aspect, activity, mode, inert, calm, keyed, ..Self::default() }
    }
}

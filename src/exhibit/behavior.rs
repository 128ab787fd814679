//! How an exhibit moves, answers a breath and a hand, and sounds.

use soffio_math::DVec3;
use soffio_multibody::procedural::Method;
use soffio_wind::breath::SpreadLaw;

/// What moves an exhibit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Motion {
    /// The laws, and places where a step would take longer than this, s.
    Auto {
        /// s of processor time.
        budget: f64,
    },
    /// The laws always.
    Laws,
    /// Places always.
    Places(Method),
}

/// What hands may do to an exhibit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touch {
    /// May visitors take it by the hand?
    pub permitted: bool,
    /// How strong a hand is, N.
    pub force: f64,
}

/// What a breath is to an exhibit, besides what the site's configuration says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BreathTuning {
    /// How it spreads.
    pub law: SpreadLaw,
    /// Multiplies its force on top of the site's and the profile's gain.
    pub gain: f64,
    /// Diameter of the lips, m, where it is not the site's.
    pub lip_diameter: Option<f64>,
}

impl Default for BreathTuning {
    fn default() -> Self {
        Self { law: SpreadLaw::default(), gain: 1.0, lip_diameter: None }
    }
}

/// How the gallery calms an exhibit that nobody blows at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Calm {
    /// So long after the last breath or hand it begins, s.
    pub after: f64,
    /// Time constant with which free motion fades at first, s; a swing takes twice as long, and the calm grows firmer.
    pub time: f64,
}

/// Which motion of which body plays which instrument.
#[derive(Clone, Debug)]
pub struct SoundBinding {
    /// Unique in the exhibit.
    pub name: String,
    /// Index of the body.
    pub body: usize,
    /// What sets it off.
    pub on: SoundTrigger,
    /// Index into [`Exhibit::instruments`](super::Exhibit::instruments).
    pub instrument: usize,
    /// Node-frame axes of the two largest half extents and the centre, to place a hit on the body.
    pub frame: (DVec3, DVec3, DVec3),
    /// Index of the wire that the wind plays, where it is one: it hears only what blows across it.
    pub wire: Option<usize>,
    /// Key of the caption in the labels.
    pub caption: Option<String>,
}

/// What sets a sound off.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SoundTrigger {
    /// A hit on the body.
    Impact,
    /// What slides or rolls over the body.
    Slide,
    /// The wind at the body.
    Wind,
}

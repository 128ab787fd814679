//! What a simulation is given: what is constant over a run ([`Settings`]), and all that varies from step to step
//! ([`StepInput`]). Whoever knows both knows the run.

use serde::{Deserialize, Serialize};

use super::hands::Hand;
use soffio_exhibit::{Exhibit, Motion};
use soffio_multibody::procedural::Method;

/// How a breath becomes wind.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Profile {
    /// No travelling front; gain such that a child's gentle breath visibly moves a sculpture within a second.
    #[default]
    Gallery,
    /// Gain 1, the front travels as a real jet's does.
    True,
}

/// The gallery's gain is this speed over the breath's own, so that its force grows with the speed and not with its square: a
/// hard 17 m/s counts twice. Of a breath that is softer than a grown-up's it grows with the root of the speed, or a child's
/// would be lost in what still swings from the breath before: a gentle 3.8 m/s counts twelve times. A child's 0.3 L/s from half
/// a metre (1.4 mN at the most) so pushes with 17 mN at the most, and moves a plate of *Steel Fish* by 17 mm and more on a
/// 55-inch picture within a second.
const GALLERY_SPEED: f64 = 36.0;
/// Below this speed at the lips a breath is soft, m/s.
const SOFT_SPEED: f64 = 6.5;
/// Bounds of that gain: no breath is ever weakened, and what is hardly heard is not made a gale of. (A breath from afar, or one
/// that has only just begun, is heard as 1 to 2 m/s.)
const GALLERY_GAIN: (f64, f64) = (1.0, GALLERY_SPEED);

impl Profile {
    /// Force gain at a source speed (m/s).
    pub fn gain(self, speed: f64) -> f64 {
        match self {
            Self::Gallery => {
                let speed = speed.max(1e-9);
                let soft = (SOFT_SPEED / speed).max(1.0).sqrt();
                (soft * GALLERY_SPEED / speed).clamp(GALLERY_GAIN.0, GALLERY_GAIN.1)
            }
            Self::True => 1.0,
        }
    }

    /// Its name on the command line and in summaries.
    pub fn name(self) -> &'static str {
        match self {
            Self::Gallery => "gallery",
            Self::True => "true",
        }
    }
}

/// What is constant over a run, besides the exhibit.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Settings {
    /// How a breath becomes wind.
    pub profile: Profile,
    /// Added to the microphone's level before it becomes a speed, dB.
    pub sensitivity_db: f64,
    /// Multiplies the force of the breath on top of the profile's own gain.
    pub breath_gain: f64,
    /// Distance of the lips before the target, m.
    pub distance: f64,
    /// Lip diameter d = 2 r₀, m.
    pub lip_diameter: f64,
    /// Seed of all that is random.
    pub seed: u64,
    /// false: no wind of any kind, not even still air's drag.
    pub wind: bool,
    /// false: pivots without friction and bodies without damping.
    pub friction: bool,
    /// The time of day when the run begins, s after midnight, to which the hands of a clock are set; `None` leaves them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub clock: Option<f64>,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            profile: Profile::Gallery,
            sensitivity_db: 0.0,
            breath_gain: 1.0,
            distance: 0.5,
            lip_diameter: 0.01,
            seed: 1,
            wind: true,
            friction: true,
            clock: None,
        }
    }
}

/// Microphone samples of one step.
#[derive(Clone, Copy, Debug)]
pub struct Microphone<'a> {
    /// One capsule, full scale ±1.
    pub samples: &'a [f32],
    /// A second capsule beside it (same rate and length), where there is one.
    pub second: Option<&'a [f32]>,
    /// Hz.
    pub sample_rate: u32,
    /// What the loudspeaker played meanwhile (mono, same rate and length); empty where it cannot be heard.
    pub reference: &'a [f32],
}

/// A command of a visitor, a script, or staff.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Command {
    /// Puts everything back to where it started.
    Reset,
    /// The same, but from scattered parts, which gather themselves before the exhibit begins; the seed says where they
    /// begin. Where the exhibit does not gather it is a reset.
    Gather(u64),
    /// Says that what still moves is the doing of nobody who is here: where the exhibit asks for calm, it comes at once.
    Calm,
    /// Sets the source speed of the breath directly, m/s (scripts, replay); `None` gives it back.
    Blow(Option<f64>),
}

/// The middle of the picture.
pub const CENTRE: [f64; 2] = [0.5, 0.5];

/// Everything that varies: the whole input of one step.
#[derive(Clone, Copy, Debug, Default)]
pub struct StepInput<'a> {
    /// `None`: no microphone, wind from it is exactly 0.
    pub microphone: Option<Microphone<'a>>,
    /// Nobody's breath counts now, and wind from it is exactly 0; but the ear goes on to learn the room.
    pub deaf: bool,
    /// Hold-to-blow (pointer, touch, key, switch).
    pub hold: bool,
    /// How hard a breath controller is blown (gamepad trigger, MIDI, OSC, serial line), 0 … 1.
    pub strength: f64,
    /// Pointer in picture coordinates, (0,0) top left, (1,1) bottom right; `None` is the centre.
    pub pointer: Option<[f64; 2]>,
    /// Width over height of the picture; 0 is 16:9.
    pub aspect: f64,
    /// How far the camera is turned about its target from the exhibit's own view: to the right and up, rad.
    pub turn: [f64; 2],
    /// Commands, carried out in order before the step.
    pub commands: &'a [Command],
    /// What moves the figure in this step; `None` is the exhibit's own choice.
    pub mode: Option<MotionMode>,
    /// Pointers and fingers that are down on the sculpture.
    pub hands: &'a [Hand],
}

/// What moves the figure.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MotionMode {
    /// The laws: constrained dynamics.
    #[default]
    Dynamic,
    /// The source's procedural motion.
    Procedural,
    /// Places, all joints at once.
    PositionBased,
}

impl MotionMode {
    /// What an exhibit is moved by where nothing presses.
    pub fn of(exhibit: &Exhibit) -> Self {
        match exhibit.motion {
            Motion::Laws | Motion::Auto { .. } => Self::Dynamic,
            Motion::Places(Method::Compulsive) => Self::Procedural,
            Motion::Places(Method::TreeSolve) => Self::PositionBased,
        }
    }

    /// Its name on the command line and in scripts.
    pub fn name(self) -> &'static str {
        match self {
            Self::Dynamic => "dynamics",
            Self::Procedural => "procedural",
            Self::PositionBased => "position-based",
        }
    }
}

impl std::str::FromStr for MotionMode {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let all = [Self::Dynamic, Self::Procedural, Self::PositionBased];
        let wrong = || format!("solver \"{name}\" is not one of: {}", all.map(Self::name).join(", "));
        all.into_iter().find(|mode| mode.name() == name).ok_or_else(wrong)
    }
}

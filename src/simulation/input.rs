//! Inputs of a simulation: constants of a run ([`Settings`]) and inputs of each step ([`StepInput`]). Both together determine
//! the run.

use serde::{Deserialize, Serialize};

use super::pointer_grabs::PointerGrab;
use soffio_detector::BlowSettings;
use soffio_exhibit::{Exhibit, Motion};
use soffio_multibody::procedural::PositionSolver;

/// Breath profile: how a breath becomes wind.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Profile {
    /// No travelling front; gain such that a child's gentle breath visibly moves a sculpture within a second.
    #[default]
    Gallery,
    /// Gain 1; the travelling front arrives with the delay of a real jet.
    #[serde(alias = "true")]
    Physical,
}

/// Gain of the gallery profile.
///
/// The gain falls as 1/speed, so that the force grows with the speed instead of its square: a hard breath of 17 m/s counts
/// twice. Below the soft speed it rises faster, so that the force grows with the root of the speed, and a child's breath is not
/// lost in the swing from the one before: a gentle 3.8 m/s counts twelve times. A child's 0.3 L/s from half a metre (1.4 mN at
/// most) thus exerts up to 17 mN. It moves a plate of *Steel Fish* by at least 17 mm on a 55-inch picture within a second.
struct GalleryGain {
    /// Speed of gain 1, m/s.
    unit_speed: f64,
    /// Slower breaths are soft, m/s.
    soft_speed: f64,
    /// Least gain: no breath is weakened.
    least: f64,
    /// Greatest gain, for breaths that are barely detected (1 to 2 m/s, from afar or just begun).
    most: f64,
}

const GALLERY_GAIN: GalleryGain = GalleryGain { unit_speed: 36.0, soft_speed: 6.5, least: 1.0, most: 36.0 };

impl Profile {
    /// Force gain at a source speed (m/s).
    pub fn gain(self, speed: f64) -> f64 {
        match self {
            Self::Gallery => {
                let speed = speed.max(1e-9);
                let soft = (GALLERY_GAIN.soft_speed / speed).max(1.0).sqrt();
                (soft * GALLERY_GAIN.unit_speed / speed).clamp(GALLERY_GAIN.least, GALLERY_GAIN.most)
            }
            Self::Physical => 1.0,
        }
    }

    /// Its name on the command line and in summaries.
    pub fn name(self) -> &'static str {
        match self {
            Self::Gallery => "gallery",
            Self::Physical => "physical",
        }
    }
}

/// Constants of a run, beside the exhibit.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Settings {
    /// Breath profile.
    pub profile: Profile,
    /// Added to the microphone's level before it becomes a speed, dB.
    pub sensitivity_db: f64,
    /// How much surer than usual the detector must be of a breath, nats.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub threshold: f64,
    /// Multiplies the force of the breath on top of the profile's own gain.
    pub breath_gain: f64,
    /// Distance of the lips from the target plane, m.
    pub distance: f64,
    /// Lip diameter d = 2 r₀, m.
    pub lip_diameter: f64,
    /// Seed of all random numbers.
    pub seed: u64,
    /// false: no wind forces at all, nor drag in still air.
    pub wind: bool,
    /// false: no pivot friction and no damping.
    pub friction: bool,
    /// Time of day at the start of the run, s after midnight, to which clocks are set; `None`: they are not set.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub clock: Option<f64>,
}

impl Settings {
    /// Settings of the breath detector.
    pub fn detector(&self) -> BlowSettings {
        BlowSettings { sensitivity_db: self.sensitivity_db, threshold: self.threshold, ..BlowSettings::default() }
    }
}

/// For settings that a recorded run leaves out where they are 0.
fn is_zero(x: &f64) -> bool {
    *x == 0.0
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            profile: Profile::Gallery,
            sensitivity_db: 0.0,
            threshold: 0.0,
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
    /// Sample rate, Hz.
    pub sample_rate: u32,
    /// Output signal of the same time (mono, same rate and length); empty if the microphone does not pick it up.
    pub reference: &'a [f32],
}

/// A command of a visitor, a script, or staff.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Command {
    /// Restarts the exhibit.
    Reset,
    /// Restarts the exhibit with its assembly animation from parts scattered by this seed; without one, as [`Self::Reset`].
    #[serde(rename = "gather")]
    Assemble(u64),
    /// Applies the exhibit's idle damping, if any, at once: no present visitor has caused the remaining motion.
    #[serde(rename = "calm")]
    Settle,
    /// Sets the source speed of the breath, m/s (scripts, replay); `None` releases it.
    Blow(Option<f64>),
}

/// Centre of the picture, picture coordinates.
pub const CENTRE: [f64; 2] = [0.5, 0.5];

/// The whole input of one step.
#[derive(Clone, Copy, Debug, Default)]
pub struct StepInput<'a> {
    /// `None`: no microphone, wind from it is exactly 0.
    pub microphone: Option<Microphone<'a>>,
    /// Ignores breath from the microphone, so that wind from it is exactly 0. The detector still adapts to the noise floor.
    pub ignore_microphone: bool,
    /// Hold-to-blow (pointer, touch, key, switch).
    pub hold: bool,
    /// Strength of a breath controller (gamepad trigger, MIDI, OSC, serial line), 0 … 1.
    pub strength: f64,
    /// Pointer in picture coordinates, (0,0) top left, (1,1) bottom right; `None` is the centre.
    pub pointer: Option<[f64; 2]>,
    /// Width over height of the picture; 0 is 16:9.
    pub aspect: f64,
    /// Turn of the camera about its target from the exhibit's own view: to the right and up, rad.
    pub turn: [f64; 2],
    /// Commands, executed in order before the step.
    pub commands: &'a [Command],
    /// Solver of this step; `None`: the exhibit's own.
    pub mode: Option<MotionMode>,
    /// Pointers and fingers that are down on the sculpture.
    pub pointer_grabs: &'a [PointerGrab],
}

/// Solver that moves the bodies.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MotionMode {
    /// Constrained dynamics.
    #[default]
    Dynamic,
    /// Procedural motion of the source.
    Procedural,
    /// Position-based motion, all joints at once.
    PositionBased,
}

impl MotionMode {
    /// Solver of an exhibit while the time budget allows it.
    pub fn of(exhibit: &Exhibit) -> Self {
        Self::by(exhibit.motion)
    }

    /// Solver of a kind of motion while the time budget allows it.
    pub(crate) fn by(motion: Motion) -> Self {
        match motion {
            Motion::Dynamics | Motion::Auto { .. } => Self::Dynamic,
            Motion::PositionBased(PositionSolver::Relaxation) => Self::Procedural,
            Motion::PositionBased(PositionSolver::TreeSolve) => Self::PositionBased,
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

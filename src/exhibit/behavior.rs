//! How an exhibit moves, responds to breath and touch, and sounds.

use super::bodies::Material;
use soffio_math::{DVec3, Function};
use soffio_multibody::articulation::{Constraint, ConstraintKind, Measure, Spring, SpringKind};
use soffio_multibody::procedural::PositionSolver;
use soffio_wind::breath::SpreadLaw;
use soffio_wind::force::TURBULENCE;

/// How the motion of an exhibit is computed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Motion {
    /// Constrained dynamics; position-based motion where a step would take longer than the budget.
    Auto {
        /// Processor time a step may take, s.
        budget: f64,
    },
    /// Always constrained dynamics.
    Dynamics,
    /// Always position-based motion.
    PositionBased(PositionSolver),
}

impl Motion {
    /// Why constraints, springs and surfaces of such materials move by dynamics alone, and not by positions; `None` where they move
    /// by both.
    pub fn refusal<'a>(
        constraints: impl IntoIterator<Item = &'a Constraint> + Clone,
        springs: impl IntoIterator<Item = &'a Spring>,
        materials: &[Material],
    ) -> Option<&'static str> {
        if materials.iter().any(|material| material.full_slip > 0.0) {
            return Some("its tyres grip by forces that grow with the slip, which position-based motion does not know");
        }
        let mut all = constraints.clone().into_iter();
        if all.any(|constraint| matches!(constraint.kind, ConstraintKind::Coupling { .. })) {
            return Some("its gears pass on forces, which position-based motion does not know");
        }
        let seam =
            |spring: &Spring| matches!(spring.kind, SpringKind::Angular { measure: Measure::Displacement { .. } });
        if springs.into_iter().any(seam) {
            return Some("the seams of its sheets swing faster than a position-based step can follow");
        }
        let breaks = constraints.into_iter().any(|constraint| constraint.breaking.is_some());
        breaks.then_some("it breaks under load, which position-based motion does not know")
    }
}

/// What visitors may do to an exhibit by touch or mouse.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TouchPermission {
    /// May visitors grab and drag bodies?
    pub permitted: bool,
    /// Largest force of a pointer grab, N.
    pub force: f64,
    /// Bodies of which a grab drags all, each at the same point of its own, by the same way.
    pub together: Vec<Vec<usize>>,
}

/// How a breath acts on an exhibit, besides what the site's configuration sets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BreathTuning {
    /// How the breath jet spreads.
    pub law: SpreadLaw,
    /// Multiplies the force, on top of the gains of the site and of the breath profile; dimensionless.
    pub gain: f64,
    /// Diameter of the blowing lips, m; `None` takes the site's.
    pub lip_diameter: Option<f64>,
    /// β: upper bound of the random part of its force, as a share of it, 0 … 1.
    pub turbulence: f64,
}

impl Default for BreathTuning {
    fn default() -> Self {
        Self { law: SpreadLaw::default(), gain: 1.0, lip_diameter: None, turbulence: TURBULENCE }
    }
}

/// Idle damping: brings an exhibit to rest when nobody blows, so that the next breath is visible.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IdleDampingSpec {
    /// Delay after the last breath or grab until the damping begins, s.
    pub after: f64,
    /// Time constant of free motion at first, s. Oscillations decay half as fast, and the damping grows stronger with
    /// time.
    pub time: f64,
}

/// Where a sounding body is hit: axes and centre in the frame of its node.
#[derive(Clone, Copy, Debug)]
pub struct ImpactFrame {
    /// Axis of the largest half extent.
    pub longest: DVec3,
    /// Axis of the second half extent.
    pub middle: DVec3,
    /// Centre of the extents, m.
    pub center: DVec3,
}

/// Which motion of which body plays which instrument.
#[derive(Clone, Debug)]
pub struct SoundBinding {
    /// Name, unique in the exhibit.
    pub name: String,
    /// Index of the sounding body.
    pub body: usize,
    /// The motion that triggers the sound.
    pub on: SoundTrigger,
    /// Whether impacts ring it, whatever else plays it.
    pub is_struck: bool,
    /// Index into [`Exhibit::instruments`](super::Exhibit::instruments).
    pub instrument: usize,
    /// Locates an impact on the body.
    pub frame: ImpactFrame,
    /// What its timbre follows beside contacts.
    pub follows: Follows,
    /// Key of the caption in the labels.
    pub caption: Option<String>,
}

/// The motion that triggers a sound.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SoundTrigger {
    /// An impact on the body.
    Impact,
    /// A contact that slides or rolls over the body.
    Slide,
    /// Wind at the body.
    Wind,
    /// Motion of the body.
    Motion,
}

/// What a timbre follows beside contacts.
#[derive(Clone, Debug, Default)]
pub struct Follows {
    /// The air that it follows, if any.
    pub air: Option<AirAt>,
    /// Whether it follows the motion of its body.
    pub motion: bool,
    /// Whose force it follows.
    pub force: Option<ForceOf>,
    /// Its own number, which may change with time.
    pub parameter: Function,
}

/// Where the air is that a sound follows.
#[derive(Clone, Debug, PartialEq)]
pub enum AirAt {
    /// At these wind surfaces, by index.
    Surfaces(Vec<usize>),
    /// Across the wire of this index.
    Wire(usize),
}

/// Whose force a sound follows, by index.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ForceOf {
    /// A constraint's joint.
    Constraint(usize),
    /// A spring.
    Spring(usize),
}

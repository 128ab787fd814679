//! A closer look at one moment, for whoever mends an exhibit: each joint, each body, each patch that feels the wind.
//! A step asks for none of it.

use super::air::Pointed;
use super::step::Simulation;
use soffio_math::DVec3;
use soffio_multibody::articulation::ConstraintKind;

/// What is looked at.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Look {
    /// Nothing.
    #[default]
    Nothing,
    /// Bodies and joints.
    Bodies,
    /// Patches that feel the wind.
    Wind,
}

/// What was seen; of what was not looked at, nothing.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Inspection {
    /// Steps done.
    pub step: u64,
    /// In the order of the exhibit's constraints.
    pub joints: Vec<JointState>,
    /// In the order of the exhibit's bodies.
    pub bodies: Vec<BodyState>,
    /// Every patch.
    pub wind: Vec<WindSample>,
}

/// How a constraint is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointState {
    /// How far it is from what it holds: m, of an angle rad.
    pub error: f64,
    /// Does it hold an angle?
    pub angle: bool,
    /// The force that its joint carried in the last step, all lengths between the two bodies together, N; `None` for
    /// angles and couplings.
    pub load: Option<f64>,
}

/// How a body is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyState {
    /// m/s.
    pub speed: f64,
    /// rad/s.
    pub spin: f64,
    /// Height of its centre of mass, world, m.
    pub height: f64,
}

/// A patch in the wind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WindSample {
    /// Index of its surface among the exhibit's.
    pub surface: usize,
    /// World, m.
    pub point: DVec3,
    /// Does it lie in the cone of the breath as it is aimed now, and see the lips?
    pub hit: bool,
    /// Speed of the air there, m/s: what breath and all winds do to a patch that they reach.
    pub speed: f64,
}

impl Simulation {
    /// Looks closer at the present moment. Changes nothing of the run.
    pub fn inspect(&mut self, look: Look) -> Inspection {
        let seen = Inspection { step: self.clock.step, ..Inspection::default() };
        match look {
            Look::Nothing => seen,
            Look::Bodies => Inspection { joints: self.joint_states(), bodies: self.body_states(), ..seen },
            Look::Wind => Inspection { wind: self.wind_samples(), ..seen },
        }
    }

    fn joint_states(&self) -> Vec<JointState> {
        let gaps = self.motion.dynamics.system().gaps(&self.motion.dynamics.bodies);
        let states =
            self.motion.dynamics.joint_loads().into_iter().zip(gaps).zip(self.motion.dynamics.system().constraints());
        states
            .map(|((load, error), constraint)| {
                let angle = matches!(constraint.kind, ConstraintKind::Orientation { .. });
                JointState { error, angle, load: load.filter(|_| !angle) }
            })
            .collect()
    }

    fn body_states(&self) -> Vec<BodyState> {
        let state = |body: &soffio_geometry::bodies::RigidBody| BodyState {
            speed: body.velocity.length(),
            spin: body.angular_velocity.length(),
            height: body.position.y,
        };
        self.motion.dynamics.bodies.iter().map(state).collect()
    }

    fn wind_samples(&mut self) -> Vec<WindSample> {
        let Self { exhibit, settings, breathing, aiming, air, motion, .. } = self;
        let pointed = Pointed { exhibit, settings, aim: &aiming.aim, speed: breathing.speed };
        let aimed = pointed.breath();
        let samples = air.wind.samples(&motion.dynamics.bodies, &aimed);
        let blown = pointed.blown(&air.front);
        let sample = |sample: soffio_wind::force::Sample| {
            let reached = blown.as_ref().filter(|_| sample.seen);
            let air = air.wind.streams(reached, sample.point) + air.wind.stirs(sample.point);
            let hit = sample.seen && aimed.share(sample.point).is_some();
            WindSample { surface: sample.surface, point: sample.point, hit, speed: air.length() }
        };
        samples.into_iter().map(sample).collect()
    }
}
